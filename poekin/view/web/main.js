// The page's state, and `window.poekin`, by which tests and other scripts reach it.

import { Drawing } from "./drawing.js";
import { button, element } from "./panel/elements.js";
import { Labels } from "./labels.js";
import { defaultPart, largestRank, product, spread } from "./mathematics.js";
import { numbersOf } from "./panel/numbers.js";
import { Panel } from "./panel/panel.js";
import { drag, enableHandle } from "./drag.js";
import { enablePlay } from "./panel/play.js";

const SAMPLES = 16; // configurations by which the rank of a tip's Jacobian is found

// State of a scene, by itself: no document, no canvas.
export class State {
    constructor(scene, kinematics) {
        this.scene = scene;
        this.kinematics = kinematics;
        this.coordinates = scene.arms.length > 0 ? scene.arms[0].coordinates : [];
        this.q = Float64Array.from(scene.q);
        this.shown = new Set(scene.shown);
        this.selectedTip = 0;
        const here = scene.choices.findIndex(({ q }) => q.every((x, k) => x === scene.q[k]));
        this.choice = here < 0 ? null : here;
        this.k = scene.exaggerated > 1 ? scene.arms[1].shift.at(-1) : 1; // of the second arm's differences
        this.listeners = {};
        this.parts = [];
        this.forget();
    }

    forget() {
        this.linksOf = [];
        this.posesOf = [];
        this.tips = [];
    }

    on(name, listener) {
        (this.listeners[name] ??= []).push(listener);
    }

    tell(name) {
        (this.listeners[name] ?? []).forEach((listener) => listener(this));
    }

    // Moves the arm; what is beyond a limit goes to the limit, what is no number stays.
    set(q) {
        this.coordinates.forEach(({ lower, upper }, k) => {
            const x = Math.min(Math.max(q[k], lower ?? -Infinity), upper ?? Infinity);
            this.q[k] = Number.isFinite(x) ? x : this.q[k];
        });
        this.forget();
        this.tell("change");
    }

    show(layer, on) {
        this.shown[on ? "add" : "delete"](layer);
        this.tell("layer");
    }

    select(tip) {
        this.selectedTip = tip;
        this.tell("tip");
    }

    choose(k) {
        this.choice = k;
        this.set(this.scene.choices[k].q);
        this.tell("choice");
    }

    // The coordinates of an arm where the sliders are at q; the last one of a second arm that can be
    // exaggerated is the factor k.
    ownCoordinates(a, q = this.q) {
        const { factors, shift } = this.scene.arms[a];
        const own = Float64Array.from(factors, (row, k) => row.reduce((sum, x, i) => sum + x * q[i], shift[k]));
        if (a === 1 && this.scene.exaggerated > 1) {
            own[own.length - 1] = this.k;
        }
        return own;
    }

    // Poses of an arm's links in its base, 16 numbers each.
    links(a) {
        return (this.linksOf[a] ??= this.kinematics[a].links(this.ownCoordinates(a)));
    }

    // {T, J} of a tip of the first arm, with the part and the rank by which it is judged.
    tip(t) {
        return (this.tips[t] ??= this.tipNow(t));
    }

    tipNow(t) {
        const { T, J } = this.kinematics[0].tips[t].fk_jacobian(this.q);
        this.parts[t] ??= this.partOf(t);
        const { coordinates, reach } = this.scene.arms[0].tips[t];
        return { T, J, coordinates, reach, ...this.parts[t] };
    }

    partOf(t) {
        const jacobians = Array.from({ length: SAMPLES }, (_, k) =>
            this.kinematics[0].tips[t].fk_jacobian(Float64Array.from(spread(this.coordinates, k))).J,
        );
        const part = defaultPart(jacobians);
        return { part, rank: largestRank(jacobians, part) };
    }

    // Pose of a link in the world, now or at a choice.
    linkPose(a, link, choice) {
        if (choice !== null) {
            return this.linkPoseAt(a, link, choice);
        }
        const poses = (this.posesOf[a] ??= []);
        return (poses[link] ??= this.linkPoseAt(a, link, null));
    }

    linkPoseAt(a, link, choice) {
        const all = choice === null ? this.links(a) : this.choiceLinks(a, choice);
        return product(this.scene.arms[a].base, all.subarray(16 * link, 16 * link + 16));
    }

    choiceLinks(a, choice) {
        this.choiceCache ??= {};
        const { q } = this.scene.choices[choice];
        return (this.choiceCache[`${a} ${choice}`] ??= this.kinematics[a].links(this.ownCoordinates(a, q)));
    }

    numbers() {
        return numbersOf(this.scene, this.q, this.tip(this.selectedTip));
    }
}

// q of a link's hash, "#q=0.1,0.2&tip=1", or null.
export function fromHash(hash, count) {
    const values = new URLSearchParams(hash.replace(/^#/, ""));
    const q = (values.get("q") ?? "").split(",").map((x) => (x.trim() === "" ? NaN : Number(x)));
    const tip = Number(values.get("tip") ?? 0);
    return { q: q.length === count && q.every(Number.isFinite) ? q : null, tip };
}

export function toHash({ q, selectedTip }) {
    const tip = selectedTip > 0 ? `&tip=${selectedTip}` : "";
    const words = Array.from(q).join(",").replaceAll("+", ""); // a link reads 1e+9 as 1e 9
    return `#q=${words}${tip}`;
}

function readHash(poekin) {
    const { q, tip } = fromHash(location.hash, poekin.q.length);
    const tips = poekin.scene.arms[0]?.tips ?? [];
    if (tips[tip] !== undefined && tip !== poekin.selectedTip) {
        poekin.select(tip);
    }
    if (q !== null) {
        poekin.set(q);
    }
}

function followHash(poekin) {
    readHash(poekin);
    addEventListener("hashchange", () => readHash(poekin));
}

async function copyLink(poekin, pressed) {
    try {
        history.replaceState(null, "", toHash(poekin));
    } catch {
        // A page inside a notebook's frame has no address of its own.
    }
    const link = location.href.split("#")[0] + toHash(poekin);
    try {
        await navigator.clipboard.writeText(link);
        pressed.textContent = "Copied";
    } catch {
        pressed.textContent = "In the address bar";
    }
    setTimeout(() => {
        pressed.textContent = "Copy link";
    }, 1500);
}

function isDark() {
    const chosen = document.documentElement.dataset.theme;
    return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

function toolbar(poekin, drawing) {
    const theme = button("Dark", "Light or dark", () => {
        document.documentElement.dataset.theme = isDark() ? "light" : "dark";
        retheme();
    });
    const retheme = () => {
        theme.textContent = isDark() ? "Light" : "Dark";
        drawing.setTheme(isDark());
    };
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", retheme);
    const fit = button("Fit", "See the whole", () => drawing.fit());
    const link = button("Copy link", "Copy a link to this configuration", () => copyLink(poekin, link));
    const bar = element("div", { id: "poekin-toolbar", role: "toolbar", "aria-label": "View" }, fit, theme, link);
    document.body.append(bar);
    retheme();
}

// Where the browser cannot draw: words in the picture's place, and sliders with their numbers.
function showNumbersAlone(poekin, panel) {
    const text = "The arm cannot be drawn: this browser has no WebGL 2, or it is switched off. "
        + "Sliders and numbers work without it.";
    document.getElementById("canvasTarget").append(element("p", { class: "no-picture", role: "alert", text }));
    document.querySelector(".layers").closest(".section").hidden = true;
    poekin.on("change", () => panel.update());
    poekin.on("tip", () => panel.retip());
    followHash(poekin);
}

async function open() {
    const scene = JSON.parse(document.getElementById("poekin-scene").textContent);
    const poekin = new State(scene, globalThis.poekinKinematics);
    let opened;
    poekin.ready = new Promise((done) => {
        opened = done;
    });
    window.poekin = poekin;
    const panel = new Panel(poekin);
    panel.update();
    if (document.createElement("canvas").getContext("webgl2") === null) {
        showNumbersAlone(poekin, panel);
        opened(poekin);
        return;
    }
    poekin.K = await window.poekinPlot;
    const drawing = new Drawing(poekin.K, poekin);
    const labels = new Labels(poekin.K, poekin, drawing);
    Object.assign(poekin, { panel, drawing, labels });
    poekin.drag = (target) => drag(poekin, target);
    enablePlay(poekin, panel.place, document.getElementById("canvasTarget"));
    let waiting = false;
    const draw = () => {
        waiting = false;
        const start = performance.now();
        panel.update();
        drawing.update();
        poekin.frame = performance.now() - start; // ms of script, without the renderer's
        poekin.K.render();
    };
    const later = () => {
        if (!waiting) {
            waiting = true;
            requestAnimationFrame(draw);
        }
    };
    poekin.on("change", later);
    poekin.on("layer", later);
    poekin.on("choice", later);
    poekin.on("tip", () => {
        panel.retip();
        later();
    });
    followHash(poekin);
    draw();
    toolbar(poekin, drawing);
    drawing.fit();
    poekin.K.on(poekin.K.events.RESIZED, () => drawing.refit());
    if (panel.hasTip()) {
        enableHandle(poekin);
    }
    opened(poekin);
}

if (typeof document !== "undefined") {
    open();
}
