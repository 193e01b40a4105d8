// The panel beside the canvas: words, sliders, layers, choices, numbers, tables.

import { breakable, button, element, section } from "./elements.js";
import { Numbers } from "./numbers.js";
import { Sliders } from "./sliders.js";

const LAYERS = {
    meshes: "Meshes", skeleton: "Skeleton", axes: "Screw axes", frames: "Frames", labels: "Labels",
    jacobian: "Jacobian columns", ellipsoids: "Ellipsoids", singular: "Worst direction", path: "Path",
    solutions: "Solutions", differences: "Differences", cloud: "Cloud",
};

export class Panel {
    constructor(poekin) {
        this.poekin = poekin;
        this.sliders = new Sliders(poekin);
        this.numbers = this.hasTip() ? new Numbers(poekin) : null;
        this.choices = [];
        this.switches = {};
        this.place = element("div", { id: "poekin-play" }); // for the way along a path
        this.box = element("aside", { id: "poekin-panel", "aria-label": "Controls and numbers" },
            this.head(), ...this.parts());
        document.body.append(this.box);
    }

    hasTip() {
        const { arms } = this.poekin.scene;
        return arms.length > 0 && arms[0].tips.length > 0;
    }

    head() {
        const { title, words } = this.poekin.scene;
        return element("header", {}, element("h1", { text: title }), ...words.map((text) => element("p", { text })));
    }

    parts() {
        const parts = [];
        if (this.poekin.scene.choices.length > 0) {
            parts.push(section("Solutions", true, this.choiceList()));
        }
        parts.push(this.place);
        if (this.sliders.rows.length > 0) {
            parts.push(section("Joints", true, this.tools(), this.sliders.box));
        }
        parts.push(section("Show", true, this.layers()));
        if (this.numbers !== null) {
            parts.push(...this.tipSelector(), this.numbers.box);
        }
        parts.push(...this.poekin.scene.tables.map(tableOf));
        return parts;
    }

    tools() {
        const units = this.sliders.kinds().map((kind) => {
            const text = kind === "rad" ? "° / rad" : "m / mm";
            return button(text, `Switch the unit: ${text}`, () => this.sliders.switchUnit(kind));
        });
        const { poekin } = this;
        const back = button("Reset", "Back to the first configuration", () => poekin.set(poekin.scene.q));
        return element("div", { class: "tools" }, ...units, back);
    }

    layers() {
        const { scene, shown } = this.poekin;
        const nodes = [...scene.objects, ...scene.labels];
        const boxes = Object.keys(LAYERS).filter((layer) => nodes.some((node) => node.layer === layer)).map((layer) => {
            const input = element("input", { type: "checkbox", checked: shown.has(layer), "data-layer": layer });
            input.addEventListener("change", () => this.poekin.show(layer, input.checked));
            this.switches[layer] = input;
            const color = nodes.find((node) => node.layer === layer).color;
            const swatch = element("span", { class: "swatch", style: `--color: ${color}` });
            return element("label", { class: "layer" }, input, swatch, element("span", { text: LAYERS[layer] }));
        });
        return element("div", { class: "layers" }, ...boxes, ...this.clearSwitch(), ...this.cutter());
    }

    // The switch that lets a reader look into meshes.
    clearSwitch() {
        if (this.switches.meshes === undefined) {
            return [];
        }
        const input = element("input", { type: "checkbox" });
        input.addEventListener("change", () => this.poekin.drawing.seeThrough(input.checked));
        const swatch = element("span", { class: "swatch clear" });
        return [element("label", { class: "layer" }, input, swatch, element("span", { text: "See through" }))];
    }

    // A plane that cuts clouds, so that a reader looks into them.
    cutter() {
        if (!this.poekin.scene.objects.some((node) => node.kind === "cloud")) {
            return [];
        }
        const texts = ["no cut", "cut across x", "cut across y", "cut across z"];
        const options = texts.map((text, k) => element("option", { value: k, text }));
        const axis = element("select", { "aria-label": "Cut the cloud" }, ...options);
        const share = element("input", { type: "range", min: 0, max: 1, step: "any", value: 0.5, "aria-label": "Where the cloud is cut" });
        const cut = () => {
            const across = Number(axis.value) - 1;
            this.poekin.drawing.cut(across < 0 ? null : across, Number(share.value));
        };
        axis.addEventListener("change", cut);
        share.addEventListener("input", cut);
        return [element("div", { class: "row cutter" }, axis, share)];
    }

    choiceList() {
        this.choices = this.poekin.scene.choices.map((choice, k) =>
            button(choice.text, choice.text, () => this.poekin.choose(k), { class: "choice", "aria-pressed": "false" }),
        );
        return element("div", { class: "choices" }, ...this.choices);
    }

    tipSelector() {
        const { tips } = this.poekin.scene.arms[0];
        if (tips.length < 2) {
            return [];
        }
        const select = element("select", { id: "poekin-tip" },
            ...tips.map((tip, k) => element("option", { value: k, text: tip.name })));
        select.value = this.poekin.selectedTip;
        select.addEventListener("change", () => this.poekin.select(Number(select.value)));
        return [element("label", { class: "tip" }, element("span", { text: "Tip" }), select)];
    }

    // Shows what the reader has moved, switched or chosen.
    update() {
        this.sliders.update();
        for (const [layer, input] of Object.entries(this.switches)) {
            input.checked = this.poekin.shown.has(layer);
        }
        this.choices.forEach((choice, k) => choice.setAttribute("aria-pressed", String(k === this.poekin.choice)));
        if (this.numbers !== null) {
            this.numbers.update();
        }
    }

    // The tables of another tip.
    retip() {
        this.numbers.build();
        this.numbers.update();
        const select = document.getElementById("poekin-tip");
        if (select !== null) {
            select.value = this.poekin.selectedTip;
        }
    }
}

function tableOf({ title, heads, rows }) {
    const head = element("tr", {}, ...heads.map((text) => element("th", { text, scope: "col" })));
    const lines = rows.map((row) => element("tr", {}, ...row.map(cell)));
    const grid = element("table", { class: "words" }, head, ...lines);
    return section(title, true, element("div", { class: "wide" }, grid));
}

// A cell whose name may be broken, and whose short vector may not.
function cell(text) {
    const short = text.length < 9 ? "short" : "";
    const long = text.split(" ").some((word) => word.length > 10) ? "long" : "";
    return element("td", { class: short || long || false }, ...breakable(text));
}
