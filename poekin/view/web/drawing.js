// What the canvas shows: k3d's objects, each with the matrix of its link or its rule, and the camera.
//
// `state` is what main.js knows: scene, q, selectedTip, shown (layers), choice, and the functions
// linkPose(arm, link, choice) and tip(t), poses in the world and in the first arm's base.

import { ellipsoid, product, singularDirection } from "./mathematics.js";

const HIDDEN = Float64Array.of(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1);
const UNIT = Float64Array.of(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
const THIN = 5e-5; // of the scene: an ellipsoid that is flat keeps a thickness, and its light
const ARROW_V = 0.35; // length of an arrow of 1 m/rad, m, and of half an axis
const ARROW_W = 0.2; // of the scene: length of an arrow of 1 rad/rad
const MOST = 0.25; // of the scene: longest half axis of an ellipsoid
const SPIN = 0.25; // of an arrow: half axis of the angular ellipsoid, which is inside the linear one as a rule
const BAR = 12; // pixels below the buttons, and at the lower edge
const MARGIN = 44; // pixels at each side
const FROM = [1, -1.25, 0.65]; // from the arm to the camera
const GLOW = 0.5; // of its colour, that a dark object has in the dark without any light
const DIM = 0.02; // of white, likewise
const CLEAR = 0.3; // opacity of meshes that are looked through

// Lengths at which velocities of a tip are drawn: m per m/s at one rad/s or m/s, and per rad/s.
export function arrowScales(scene, tip) {
    const arm = scene.arms[0];
    const slides = arm?.tips[tip]?.coordinates.some((k) => arm.coordinates[k].unit === "m");
    return { v: slides ? Math.min(ARROW_V, ARROW_W * scene.size) : ARROW_V, w: ARROW_W * scene.size };
}

// The matrix that takes the unit arrow along z to the vector d at the point p of T.
export function arrowMatrix(T, d, scale) {
    const length = Math.hypot(d[0], d[1], d[2]);
    if (!(length * scale > 0)) {
        return HIDDEN;
    }
    const z = [d[0] / length, d[1] / length, d[2] / length];
    const aside = Math.abs(z[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
    const y = unitVector([
        z[1] * aside[2] - z[2] * aside[1],
        z[2] * aside[0] - z[0] * aside[2],
        z[0] * aside[1] - z[1] * aside[0],
    ]);
    const x = [y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0]];
    const s = length * scale;
    return Float64Array.of(
        s * x[0], s * y[0], s * z[0], T[3],
        s * x[1], s * y[1], s * z[1], T[7],
        s * x[2], s * y[2], s * z[2], T[11],
        0, 0, 0, 1,
    );
}

function unitVector([x, y, z]) {
    const length = Math.hypot(x, y, z);
    return [x / length, y / length, z / length];
}

// An ellipsoid's matrix with each half axis between a least and a largest length.
function thickened(M, least, most) {
    const lengths = [0, 1, 2].map((k) => Math.hypot(M[k], M[4 + k], M[8 + k]));
    const largest = Math.max(...lengths);
    const shrink = largest > most ? most / largest : 1;
    for (let k = 0; k < 3; k++) {
        const wanted = Math.max(lengths[k] * shrink, least);
        for (let r = 0; r < 3; r++) {
            const e = 4 * r + k;
            M[e] = lengths[k] > 0 ? (M[e] * wanted) / lengths[k] : wanted * (r === k ? 1 : 0);
        }
    }
    return M;
}

// Pose of a node that follows a rule, in the first arm's base.
export function rulePose(node, tip, scene, scales) {
    const { T, J } = tip;
    const m = J.length / 6;
    const column = (first) => [J[first * m + node.index], J[(first + 1) * m + node.index], J[(first + 2) * m + node.index]];
    switch (node.rule) {
        case "column_v":
            return node.index < m ? arrowMatrix(T, column(3), scales.v) : HIDDEN;
        case "column_w":
            return node.index < m ? arrowMatrix(T, column(0), scales.w) : HIDDEN;
        case "ellipsoid_v":
            return thickened(ellipsoid(T, J, "translation", scales.v), THIN * scene.size, MOST * scene.size);
        case "ellipsoid_w":
            return thickened(ellipsoid(T, J, "rotation", SPIN * scales.w), THIN * scene.size, MOST * scene.size);
        case "singular":
            return arrowMatrix(T, singularVector(J, tip), 1.5 * scales.w);
        default:
            return T; // "tip" and "target"
    }
}

// The direction that the tip moves worst: the translation of the twist, or its rotation, whichever
// is larger at the tip's reach.
function singularVector(J, { part, rank, reach }) {
    const { twist } = singularDirection(J, part, rank, reach);
    const w = twist.slice(0, 3);
    const v = twist.slice(3).map((x) => x / reach);
    return unitVector(Math.hypot(...v) >= Math.hypot(...w) ? v : w);
}

// The objects of the scene in the canvas of k3d.
export class Drawing {
    constructor(K, state) {
        this.K = K;
        this.state = state;
        this.scales = arrowScales(state.scene, state.selectedTip);
        this.three = state.scene.objects.map((node) => K.getObjectById(node.id));
        this.three.forEach((object) => {
            object.matrixAutoUpdate = false;
        });
        this.ground = null;
        this.fitted = null; // where `fit` put the camera
    }

    // Moves all objects to where they are, for the renderer to draw.
    update() {
        const { scene, selectedTip } = this.state;
        this.scales = arrowScales(scene, selectedTip);
        scene.objects.forEach((node, k) => {
            const object = this.three[k];
            object.visible = this.isShown(node);
            if (object.visible) {
                setMatrix(object, this.poseOf(node));
            }
        });
    }

    isShown(node) {
        const { shown, choice } = this.state;
        return (shown.has(node.layer) || node.rule === "target") && (node.choice === null || node.choice !== choice);
    }

    poseOf(node) {
        const { state } = this;
        if (node.rule !== null) {
            if (state.scene.arms[0].tips.length === 0) {
                return HIDDEN;
            }
            const tip = state.tip(state.selectedTip);
            return product(state.scene.arms[0].base, rulePose(node, tip, state.scene, this.scales));
        }
        if (node.link === null) {
            return UNIT;
        }
        return state.linkPose(node.arm, node.link, node.choice);
    }

    // Makes meshes such that what is inside them is seen, or as they were.
    seeThrough(on) {
        this.state.scene.objects.forEach((node, k) => {
            if (node.layer === "meshes") {
                const { material } = this.three[k];
                material.opacity = on ? Math.min(CLEAR, node.opacity) : node.opacity;
                material.transparent = material.opacity < 1;
                material.depthWrite = !material.transparent;
                material.needsUpdate = true;
            }
        });
        this.K.render();
    }

    // Shows of the clouds only what lies below a plane across an axis of the world, 0, 1 or 2, a share
    // of their extent from its lower end; all of them where axis is null.
    cut(axis, share) {
        const { THREE } = this.K.Provider;
        const clouds = this.three.filter((_, k) => this.state.scene.objects[k].kind === "cloud");
        const box = new THREE.Box3();
        clouds.forEach((cloud) => box.expandByObject(cloud));
        const low = box.min.getComponent(axis ?? 0);
        const at = low + share * (box.max.getComponent(axis ?? 0) - low);
        const normal = new THREE.Vector3().setComponent(axis ?? 0, -1);
        const planes = axis === null ? [] : [new THREE.Plane(normal, at)];
        this.K.getWorld().renderer.localClippingEnabled = true;
        clouds.forEach((cloud) => cloud.traverse(({ material }) => {
            if (material) {
                Object.assign(material, { clipping: true, clippingPlanes: planes, needsUpdate: true });
            }
        }));
        this.K.render();
    }

    // A camera as near as it can be to see all that is shown below the buttons, from the front, a
    // little from above.
    fit() {
        const { THREE } = this.K.Provider;
        const { camera, width, height } = this.K.getWorld();
        const back = new THREE.Vector3(...unitVector(FROM));
        const right = new THREE.Vector3(0, 0, 1).cross(back).normalize();
        const up = new THREE.Vector3().crossVectors(back, right);
        const seen = this.outline(THREE).map((p) => [p.dot(right), p.dot(up), p.dot(back)]);
        const half = Math.tan((camera.fov * Math.PI) / 360);
        const bar = (document.getElementById("poekin-toolbar")?.offsetHeight ?? 0) + BAR;
        const aside = half * camera.aspect * (1 - (2 * Math.min(MARGIN, 0.1 * width)) / width);
        const slopes = { right: aside, left: aside, above: half * (1 - (2 * bar) / height), below: half * (1 - (2 * BAR) / height) };
        const [x, y, z] = framed(seen, slopes, 0.1 * this.state.scene.size);
        const eye = back.clone().multiplyScalar(z).addScaledVector(right, x).addScaledVector(up, y);
        const middle = seen.reduce((sum, p) => sum + p[2], 0) / seen.length;
        const at = eye.clone().addScaledVector(back, middle - z);
        this.K.setCamera([...eye.toArray(), ...at.toArray(), 0, 0, 1]);
        this.fitted = camera.position.clone();
        this.K.render();
    }

    // Points in the world whose hull holds all that is shown: corners of the boxes around objects, each
    // in the object's own axes, all points of clouds, and the points of labels.
    outline(THREE) {
        const { objects, labels } = this.state.scene;
        const points = [];
        objects.forEach((node, k) => {
            const object = this.three[k];
            if (!object.visible || object.matrix.determinant() === 0) {
                return;
            }
            object.updateWorldMatrix(true, true);
            object.traverse((part) => {
                if (part.geometry !== undefined) {
                    const own = node.kind === "cloud" ? vertices(part.geometry, THREE) : boxCorners(part.geometry, THREE);
                    points.push(...own.map((p) => p.applyMatrix4(part.matrixWorld)));
                }
            });
        });
        labels.filter((label) => this.isShown(label)).forEach((label) => {
            points.push(new THREE.Vector3(...moved(this.poseOf(label), label.point)));
        });
        return points.length > 0 ? points : corners(this.bounds(THREE), THREE);
    }

    // Sees the whole in a window of another size, where the reader has not moved the camera.
    refit() {
        const { position } = this.K.getWorld().camera;
        if (this.fitted?.distanceTo(position) < 1e-6 * this.state.scene.size) {
            this.fit();
        }
    }

    // The box around all that is shown; around what follows the Jacobian only where it is asked for.
    bounds(THREE, whole = false) {
        const box = new THREE.Box3();
        this.state.scene.objects.forEach((node, k) => {
            const object = this.three[k];
            if (object.visible && (node.rule === null || (whole && object.matrix.determinant() !== 0))) {
                object.updateWorldMatrix(true, false);
                box.expandByObject(object);
            }
        });
        if (box.isEmpty()) {
            const half = this.state.scene.size / 2;
            box.set(new THREE.Vector3(-half, -half, -half), new THREE.Vector3(half, half, half));
        }
        return box;
    }

    // The floor: lines a round length apart, at z = 0 or below what reaches under it.
    setTheme(dark) {
        const { THREE } = this.K.Provider;
        const world = this.K.getWorld();
        this.K.setClearColor(dark ? 0x16191d : 0xf4f6f8);
        this.three.forEach((object) => glow(object, dark));
        if (this.ground !== null) {
            world.scene.remove(this.ground);
        }
        const step = roundLength(this.state.scene.size / 8);
        const count = 2 * Math.ceil((1.25 * this.state.scene.size) / step);
        const color = dark ? 0x353b43 : 0xd3d9df;
        this.ground = new THREE.GridHelper(count * step, count, color, color);
        this.ground.rotation.x = Math.PI / 2;
        const low = this.bounds(THREE).min.z;
        this.ground.position.z = low < -0.02 * this.state.scene.size ? low : 0;
        this.ground.updateMatrix();
        world.scene.add(this.ground);
        this.K.render();
    }
}

// Where a camera that looks along -z has to be, [x, y, z], to see points [x, y, z] in its own axes as
// large as it can between the planes of slopes {right, left, above, below}, none nearer than `near`:
// a point is seen where its distance to the view's axis is at most slope times its depth.
export function framed(points, { right, left, above, below }, near) {
    const most = [-Infinity, -Infinity, -Infinity, -Infinity, -Infinity];
    for (const [x, y, z] of points) {
        [x + right * z, left * z - x, y + above * z, below * z - y, z].forEach((value, k) => {
            most[k] = Math.max(most[k], value);
        });
    }
    const [a, b, c, d, front] = most;
    const z = Math.max((a + b) / (right + left), (c + d) / (above + below), front + near);
    return [(a - b + (left - right) * z) / 2, (c - d + (below - above) * z) / 2, z];
}

function vertices({ attributes }, THREE) {
    const { position } = attributes;
    return Array.from({ length: position.count }, (_, k) => new THREE.Vector3().fromBufferAttribute(position, k));
}

function boxCorners(geometry, THREE) {
    if (geometry.boundingBox === null) {
        geometry.computeBoundingBox();
    }
    return corners(geometry.boundingBox, THREE);
}

function corners({ min, max }, THREE) {
    return [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => new THREE.Vector3(x, y, z))));
}

// A point moved by a pose.
export function moved(T, [x, y, z]) {
    return [
        T[0] * x + T[1] * y + T[2] * z + T[3],
        T[4] * x + T[5] * y + T[6] * z + T[7],
        T[8] * x + T[9] * y + T[10] * z + T[11],
    ];
}

// The largest of 1, 2, 5, times a power of ten, that is not above x.
export function roundLength(x) {
    const power = 10 ** Math.floor(Math.log10(x));
    return ([5, 2].find((k) => k * power <= x) ?? 1) * power;
}

// Lets an object shine a little in the dark, where what is black or blue could not be seen.
function glow(object, dark) {
    object.traverse(({ material }) => {
        if (material?.emissive !== undefined) {
            const { r, g, b } = material.color;
            const share = GLOW * (1 - Math.max(r, g, b)); // white is bright enough
            const [R, G, B] = [r, g, b].map((x) => (dark ? share * x + DIM : 0));
            material.emissive.setRGB(R, G, B);
        }
    });
}

function setMatrix(object, M) {
    const e = object.matrix.elements;
    for (let r = 0; r < 4; r++) {
        for (let c = 0; c < 4; c++) {
            e[4 * c + r] = M[4 * r + c];
        }
    }
    object.matrixWorldNeedsUpdate = true;
}
