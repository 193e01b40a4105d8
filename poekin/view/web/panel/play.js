// A path that plays, the factor by which differences are enlarged, and how the tool is dragged.
//
// Each class builds its part of the panel, `box`, from the scene; a page has those it has data for.
import { button, element, fixed, section } from "./elements.js";
import { alongPath } from "../mathematics.js";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5];
const MARK_WORDS = {
    missed: "not reached",
    switch: "branch switch",
    limit: "at a limit",
    speed: "too fast",
    acceleration: "too sudden",
    singular: "near singular",
};

// Puts into a place of the panel what the scene has; the badge of the factor goes over the canvas.
export function enablePlay(poekin, place, canvas) {
    const { scene } = poekin;
    if (scene.motion !== null) {
        poekin.player = new Player(poekin);
        place.append(poekin.player.box);
    }
    if (scene.exaggerated > 1) {
        const exaggeration = new Exaggeration(poekin);
        place.append(exaggeration.box);
        canvas.append(exaggeration.badge);
    }
    if (scene.arms.length > 0 && scene.arms[0].tips.length > 0) {
        (place.nextElementSibling ?? place).after(dragWords(poekin)); // below the sliders
    }
    poekin.on("change", () => leaveChoice(poekin));
}

// How to drag the tool, and the switch `poekin.freeOrientation`.
function dragWords(poekin) {
    const input = element("input", { type: "checkbox" });
    input.addEventListener("change", () => {
        poekin.freeOrientation = input.checked;
    });
    const label = element("label", { class: "layer" }, input, element("span", { text: "Leave its rotation free (or hold Shift)" }));
    return section("Drag the tool", true, element("p", { class: "now", text: "Pull the end of the tool in the picture." }), label);
}

// Plays `scene.motion`. A reader who moves a slider stops it; the space bar starts and stops it.
export class Player {
    constructor(poekin) {
        this.poekin = poekin;
        const { times, marks } = poekin.scene.motion;
        this.first = times[0];
        this.last = times[times.length - 1];
        this.time = this.first;
        this.speed = 1;
        this.drawn = null; // time of the last frame, ms, while it plays
        this.shown = null; // q that the player set last
        this.start = button("Play", "Play or pause (space)", () => this.toggle(), { class: "play" });
        this.line = element("input", { type: "range", "aria-label": "Time, s", min: this.first, max: this.last, step: "any" });
        this.line.addEventListener("input", () => this.scrub(Number(this.line.value)));
        this.clock = element("output", { class: "clock" });
        this.now = element("p", { class: "now", "aria-live": "polite" });
        const bands = marks.map((mark) => this.band(mark));
        const timeline = element("div", { class: "timeline" }, element("div", { class: "bands" }, ...bands), this.line);
        const controls = element("div", { class: "row" }, this.start, this.speeds(), this.clock);
        this.box = section("Path", true, timeline, controls, this.now, this.legend());
        poekin.on("change", () => this.leave());
        document.addEventListener("keydown", (event) => this.pressed(event));
        this.tell();
    }

    get playing() {
        return this.drawn !== null;
    }

    // Shows the configuration of a time; the clock stays within the path.
    seek(time) {
        this.time = Math.min(Math.max(time, this.first), this.last);
        const { q, times } = this.poekin.scene.motion;
        this.shown = null;
        this.poekin.set(alongPath(times, q, this.time).q);
        this.shown = Array.from(this.poekin.q); // within the limits
        this.tell();
    }

    play() {
        if (this.playing) {
            return;
        }
        if (this.time >= this.last) {
            this.time = this.first;
        }
        this.drawn = performance.now();
        requestAnimationFrame((now) => this.frame(now));
        this.tell();
    }

    pause() {
        this.drawn = null;
        this.tell();
    }

    toggle() {
        if (this.playing) {
            this.pause();
        } else {
            this.play();
        }
    }

    frame(now) {
        if (!this.playing) {
            return;
        }
        const passed = Math.min(Math.max(now - this.drawn, 0), 100); // a page that slept goes on, without a leap
        this.drawn = now;
        this.seek(this.time + (this.speed * passed) / 1000);
        if (this.time >= this.last) {
            this.pause();
        } else {
            requestAnimationFrame((next) => this.frame(next));
        }
    }

    scrub(time) {
        this.pause();
        this.seek(time);
    }

    // Stops where something else than the player moved the arm.
    leave() {
        if (this.playing && this.shown !== null && !isNear(this.poekin.q, this.shown)) {
            this.pause();
        }
    }

    pressed(event) {
        const typing = "button, select, textarea, summary, a, label, input:not([type=range])";
        if (event.code === "Space" && !event.target.closest?.(typing)) {
            event.preventDefault();
            this.toggle();
        }
    }

    speeds() {
        const options = SPEEDS.map((x) => element("option", { value: x, text: `${x} ×`, selected: x === 1 }));
        const chosen = element("select", { "aria-label": "Speed" }, ...options);
        chosen.addEventListener("change", () => {
            this.speed = Number(chosen.value);
        });
        return chosen;
    }

    // A mark as a coloured band of the timeline; one row is a thin one.
    band({ first, last, kind, text }) {
        const { times } = this.poekin.scene.motion;
        const length = this.last - this.first || 1;
        const made = element("span", { class: `band ${kind}`, title: text });
        made.style.left = `${(100 * (times[first] - this.first)) / length}%`;
        made.style.width = `${(100 * (times[last] - times[first])) / length}%`;
        return made;
    }

    // Sentences of the marks, each a button that goes to where it begins.
    legend() {
        const { times, marks } = this.poekin.scene.motion;
        const items = marks.map(({ first, kind, text }) => {
            const go = button(text, `${MARK_WORDS[kind]}: go there`, () => this.scrub(times[first]), { class: `mark ${kind}` });
            return element("li", {}, go);
        });
        return element("ul", { class: "marks", hidden: marks.length === 0 }, ...items);
    }

    tell() {
        const { times, marks } = this.poekin.scene.motion;
        this.start.textContent = this.playing ? "Pause" : "Play";
        this.line.value = this.time;
        this.clock.textContent = `${fixed(this.time, 2)} of ${fixed(this.last, 2)} s`;
        const here = marks.filter(({ first, last }) => times[first] <= this.time && this.time <= times[last]);
        const words = here.map(({ text }) => text).join(" ");
        if (this.now.textContent !== words) {
            this.now.textContent = words;
        }
    }
}

// Lets go of the choice of `scene.choices` once the arm is moved away from it: its ghost comes back.
function leaveChoice(poekin) {
    const { choice, q, scene } = poekin;
    if (choice !== null && !isNear(q, scene.choices[choice].q)) {
        poekin.choice = null;
        poekin.tell("choice");
    }
}

// The factor `poekin.k`, from 1 to `scene.exaggerated`, by which the differences of two arms are
// drawn larger than they are, and a badge on the canvas that says so.
export class Exaggeration {
    constructor(poekin) {
        this.poekin = poekin;
        const most = Math.log10(poekin.scene.exaggerated);
        this.slider = element("input", { type: "range", "aria-label": "Differences enlarged by", min: 0, max: most, step: "any" });
        this.slider.addEventListener("input", () => this.enlarge(rounded(10 ** Number(this.slider.value))));
        this.said = element("output", { class: "factor" });
        this.badge = element("div", { class: "badge", role: "status" });
        this.box = section("Differences × k", true, element("div", { class: "row" }, this.slider, this.said));
        this.update();
    }

    enlarge(k) {
        const { exaggerated } = this.poekin.scene;
        this.poekin.k = Math.min(Math.max(k, 1), exaggerated);
        this.update();
        this.poekin.set(this.poekin.q);
    }

    update() {
        const { k } = this.poekin;
        this.slider.value = Math.log10(k);
        this.said.textContent = `× ${k}`;
        this.badge.textContent = `differences × ${k}`;
        this.badge.hidden = k === 1;
    }
}

// A factor to two figures.
function rounded(x) {
    return Number(x.toPrecision(2));
}

function isNear(q, other) {
    return q.every((x, k) => Math.abs(x - other[k]) <= 1e-9);
}
