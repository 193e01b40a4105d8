// Inverse kinematics in the page, and the handle by which a reader drags the tool.
//
// A tip is {fk_jacobian}, as the kinematics module gives it; `moved` are the numbers of the coordinates
// that move it, in the order of J's columns. A target is a pose (16 numbers) or, for the position
// alone, a point (3). Accuracy: tests/view/web/test_drag.py.
import { axisAngle, between, dampedStep, inverse, limitsOf, poseError, positionOf, product, spread, withPosition } from "./mathematics.js";

export const REACHED = 1e-6; // m and rad
const SETTLED = 1e-10; // m and rad, at which a solution is not made better
const STARTS = 100; // other configurations from which a target is tried
const STEPS = 60;
const LONGEST_TURN = 0.15; // rad, longest turn of one step of the way to a target
const LONGEST_STEP = 0.05; // of the scene's size, longest step of it

// Coordinates near q at which the tip is at the target, by damped least squares (Levenberg and
// Marquardt): {q, reached, error: {position, rotation}}. The damping falls with the error, as Chan
// and Lawrence 1988 have it. A coordinate at a limit stays where the step would lead out.
export function solve(tip, q, target, moved, { low, high, steps = STEPS }) {
    let now = stateAt(tip, Float64Array.from(q), target);
    let care = 1;
    for (let step = 0; step < steps && !isWithin(now.error, SETTLED) && care < 1e12; step++) {
        const free = moved.map((k, i) => {
            const slope = downhill(now, i);
            return !((now.q[k] <= low[k] && slope <= 0) || (now.q[k] >= high[k] && slope >= 0));
        });
        const dq = dampedStep(now.J, now.e, 0.1 * care * now.E, free, now.first);
        const trial = Float64Array.from(now.q);
        moved.forEach((k, i) => {
            trial[k] = Math.min(Math.max(trial[k] + dq[i], low[k]), high[k]);
        });
        const next = stateAt(tip, trial, target);
        const better = next.E < now.E;
        care = better ? Math.max(care / 4, 1e-4) : Math.max(10 * care, 1);
        now = better ? next : now;
    }
    return { q: Array.from(now.q), reached: isWithin(now.error, REACHED), error: now.error };
}

function stateAt(tip, q, target) {
    const { T, J } = tip.fk_jacobian(q);
    const pointed = target.length === 3;
    const e = poseError(T, pointed ? withPosition(T, target) : target);
    const rotation = Math.hypot(e[0], e[1], e[2]);
    const position = Math.hypot(e[3], e[4], e[5]);
    const E = 0.5 * (rotation * rotation + position * position);
    return { q, J, e, E, first: pointed ? 3 : 0, error: { position, rotation } };
}

// J_i^T e: positive where a larger coordinate makes the error smaller.
function downhill({ J, e, first }, i) {
    const m = J.length / 6;
    let total = 0;
    for (let r = first; r < 6; r++) {
        total += J[r * m + i] * e[r];
    }
    return total;
}

function isWithin({ position, rotation }, tolerance) {
    return position <= tolerance && rotation <= tolerance;
}

// As `solve`, by a way of short steps from where the tip is: its position on a line, its rotation on a
// geodesic. So q goes on without a jump where it can.
export function follow(tip, q, target, moved, { size = 1, ...limits }) {
    const from = tip.fk_jacobian(q).T;
    const to = target.length === 3 ? withPosition(from, target) : target;
    const [dx, dy, dz] = positionOf(to).map((x, r) => x - positionOf(from)[r]);
    const { angle } = axisAngle(product(to, inverse(from)));
    const count = Math.ceil(Math.min(Math.max(Math.hypot(dx, dy, dz) / (LONGEST_STEP * size), angle / LONGEST_TURN), 200));
    let at = Array.from(q);
    for (let k = 1; k < count; k++) {
        const pose = between(from, to, k / count);
        at = solve(tip, at, target.length === 3 ? positionOf(pose) : pose, moved, { ...limits, steps: 4 }).q;
    }
    return solve(tip, at, target, moved, limits);
}

// As `follow`; where the way ends before the target, from q at once, and from other configurations
// within the limits, always the same. What is not reached is the nearest of all that was found.
export function reach(tip, q, target, moved, coordinates, size) {
    const limits = limitsOf(coordinates);
    let best = follow(tip, q, target, moved, { ...limits, size });
    const own = moved.map((k) => coordinates[k]);
    for (let k = -1; k < STARTS && !best.reached; k++) {
        const start = Array.from(q);
        if (k >= 0) {
            spread(own, k).forEach((x, i) => {
                start[moved[i]] = x;
            });
        }
        const found = solve(tip, start, target, moved, limits);
        const nearer = errorSize(found.error) < errorSize(best.error);
        best = found.reached || nearer ? found : best;
    }
    return best;
}

function errorSize({ position, rotation }) {
    return Math.hypot(position, rotation);
}

// The selected tip of the page's first arm: {tip, moved}.
function grasped(poekin) {
    const index = poekin.selectedTip;
    const moved = poekin.scene.arms[0].tips[index].coordinates;
    return { tip: globalThis.poekinKinematics[0].tips[index], moved };
}

// Moves the tool of a page to a target, a pose or a point in the arm's base frame, in steps, and sets
// q to what was found, the target reached or not: {q, reached, error}.
export function drag(poekin, target) {
    const { tip, moved } = grasped(poekin);
    const { coordinates } = poekin.scene.arms[0];
    const found = reach(tip, poekin.q, target, moved, coordinates, poekin.scene.size);
    poekin.set(found.q);
    return found;
}

// Lets the pointer take the tool by its handle and move it in the plane of the screen. With Shift, or
// `poekin.freeOrientation`, the rotation is left free. While it is held `poekin.target` is the pose
// asked for, in the arm's base frame, else null.
export function enableHandle(poekin) {
    const { targetDOMNode: place, renderer } = poekin.K.getWorld();
    const canvas = renderer.domElement;
    let held = null;
    let asked = null; // the last event that is not drawn yet
    poekin.target = null;
    poekin.freeOrientation ??= false;

    const end = (event) => {
        if (held && event.pointerId === held.pointer) {
            poekin.K.getWorld().controls.enabled = true;
            held = null;
            poekin.target = null;
            canvas.style.cursor = "";
            poekin.set(poekin.q);
        }
    };
    const move = () => {
        const event = asked;
        asked = null;
        if (held && event) {
            followPointer(poekin, held, event);
        }
    };
    place.addEventListener("pointerdown", (event) => {
        const seen = handleOnScreen(poekin, canvas);
        const reachable = event.pointerType === "touch" ? 28 : 14; // px
        const off = [event.clientX - seen.x, event.clientY - seen.y];
        if (held || event.target !== canvas || event.button !== 0 || !(Math.hypot(...off) <= reachable)) {
            return;
        }
        event.stopPropagation(); // the camera stays: its controls listen on the canvas, below
        event.preventDefault();
        canvas.setPointerCapture(event.pointerId);
        held = { pointer: event.pointerId, off, depth: seen.depth, from: poekin.tip(poekin.selectedTip).T };
        canvas.style.cursor = "grabbing";
    }, { capture: true });
    canvas.addEventListener("pointermove", (event) => {
        if (held && event.pointerId === held.pointer) {
            poekin.K.getWorld().controls.enabled = false;
            asked ?? requestAnimationFrame(move);
            asked = event;
        } else if (!held && event.pointerType === "mouse") {
            const { x, y } = handleOnScreen(poekin, canvas);
            canvas.style.cursor = Math.hypot(event.clientX - x, event.clientY - y) <= 14 ? "grab" : "";
        }
    });
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
}

function followPointer(poekin, held, event) {
    const { tip, moved } = grasped(poekin);
    const point = pointAt(poekin, poekin.K.getWorld().renderer.domElement, event, held);
    const free = event.shiftKey || Boolean(poekin.freeOrientation);
    const limits = limitsOf(poekin.scene.arms[0].coordinates);
    const target = free ? point : withPosition(held.from, point);
    const options = { ...limits, size: poekin.scene.size, steps: 12 };
    const found = follow(tip, poekin.q, target, moved, options);
    poekin.target = withPosition(free ? tip.fk_jacobian(found.q).T : held.from, point);
    poekin.set(found.q);
}

// The tool's origin on the screen, px, and its depth for the camera.
function handleOnScreen(poekin, canvas) {
    const { Vector3 } = poekin.K.Provider.THREE;
    const pose = product(poekin.scene.arms[0].base, poekin.tip(poekin.selectedTip).T);
    const seen = new Vector3(...positionOf(pose)).project(poekin.K.getWorld().camera);
    const box = canvas.getBoundingClientRect();
    const x = box.left + (0.5 + 0.5 * seen.x) * box.width;
    const y = box.top + (0.5 - 0.5 * seen.y) * box.height;
    return { x, y, depth: seen.z };
}

// The point under the pointer, less where it took hold, in the plane of equal depth; base frame, m.
function pointAt(poekin, canvas, event, { off, depth }) {
    const { Vector3 } = poekin.K.Provider.THREE;
    const box = canvas.getBoundingClientRect();
    const x = (2 * (event.clientX - off[0] - box.left)) / box.width - 1;
    const y = 1 - (2 * (event.clientY - off[1] - box.top)) / box.height;
    const world = new Vector3(x, y, depth).unproject(poekin.K.getWorld().camera);
    const base = inverse(poekin.scene.arms[0].base);
    return positionOf(product(base, withPosition(base, world.toArray())));
}
