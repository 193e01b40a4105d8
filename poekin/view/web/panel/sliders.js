// A slider and a number box for each coordinate of the first arm, in the units that the reader chose.

import { breakable, element, unsigned } from "./elements.js";
import { rangeOf } from "../mathematics.js";

const UNITS = {
    rad: { "°": 180 / Math.PI, rad: 1 },
    m: { mm: 1000, m: 1 },
};
const PLACES = { "°": 2, rad: 4, mm: 1, m: 4 };

export class Sliders {
    constructor(poekin) {
        this.poekin = poekin;
        this.coordinates = poekin.scene.arms[0]?.coordinates ?? [];
        this.chosen = { rad: "°", m: "m" };
        this.box = element("div", { class: "sliders" });
        this.rows = this.coordinates.map((coordinate, k) => this.row(coordinate, k));
        this.box.append(...this.rows.map((row) => row.element));
        this.relabel();
    }

    row(coordinate, k) {
        const [low, high] = rangeOf(coordinate);
        const slider = element("input", { type: "range", "aria-label": coordinate.name });
        slider.min = low;
        slider.max = high;
        slider.step = "any";
        slider.addEventListener("input", () => this.moved(k, Number(slider.value)));
        slider.addEventListener("keydown", (event) => this.stepped(event, k, (high - low) / 100));
        const number = element("input", { type: "number", step: "any", "aria-label": `${coordinate.name}, value` });
        number.addEventListener("change", () => this.typed(k, number));
        const unit = element("span", { class: "unit" });
        const name = element("label", { title: coordinate.name }, ...breakable(coordinate.name));
        const made = element("div", { class: "slider" }, name, slider, number, unit);
        return { element: made, slider, number, unit, low, high };
    }

    moved(k, value) {
        const q = Array.from(this.poekin.q);
        q[k] = value;
        this.poekin.set(q);
    }

    // The browsers' own step of a slider without steps is too fine or too coarse.
    stepped(event, k, step) {
        const ways = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 };
        const way = ways[event.key];
        if (way !== undefined) {
            event.preventDefault();
            const { low, high } = this.rows[k];
            const to = this.poekin.q[k] + way * step * (event.shiftKey ? 0.1 : 1);
            this.moved(k, Math.min(Math.max(to, low), high));
        }
    }

    typed(k, number) {
        const value = Number(number.value.trim() === "" ? NaN : number.value);
        if (Number.isFinite(value)) {
            this.moved(k, value / this.factor(k));
        }
        this.write(k);
    }

    // The value in the box, whatever was typed there.
    write(k) {
        const places = PLACES[this.chosen[this.coordinates[k].unit]];
        this.rows[k].number.value = unsigned((this.poekin.q[k] * this.factor(k)).toFixed(places));
    }

    factor(k) {
        const { unit } = this.coordinates[k];
        return UNITS[unit][this.chosen[unit]];
    }

    // The kinds of coordinates that there are, "rad" and "m".
    kinds() {
        return Object.keys(UNITS).filter((unit) => this.coordinates.some((x) => x.unit === unit));
    }

    // Shows coordinates of a kind in the next of its units.
    switchUnit(kind) {
        const names = Object.keys(UNITS[kind]);
        this.chosen[kind] = names[(names.indexOf(this.chosen[kind]) + 1) % names.length];
        this.relabel();
        this.update();
    }

    relabel() {
        this.rows.forEach((row, k) => {
            row.unit.textContent = this.chosen[this.coordinates[k].unit];
        });
    }

    update() {
        this.rows.forEach((row, k) => {
            const value = this.poekin.q[k];
            row.slider.value = value;
            const share = (100 * (value - row.low)) / (row.high - row.low);
            row.slider.style.setProperty("--share", `${Math.min(Math.max(share, 0), 100)}%`);
            if (document.activeElement !== row.number) {
                this.write(k);
            }
        });
    }
}
