// The numbers of a configuration: pose of the tip, Jacobian, manipulability, limits, screws.

import { element, figures, fixed, section } from "./elements.js";
import { cross3, limitDistances, manipulability, positionOf, quaternionOf, rollPitchYaw, singularDirection } from "../mathematics.js";

// All numbers of the selected tip, SI; J row by row (ω; v), columns of `coordinates`.
export function numbersOf(scene, q, tip) {
    const { T, J, part, rank, coordinates, reach } = tip;
    const sliders = coordinates.map((k) => scene.arms[0].coordinates[k]);
    const own = coordinates.map((k) => q[k]);
    const { distances } = limitDistances(own, sliders);
    return {
        position: positionOf(T),
        quaternion: quaternionOf(T),
        rpy: rollPitchYaw(T),
        matrix: Array.from(T),
        J: Array.from(J),
        part,
        manipulability: manipulability(J, part, rank),
        singular: singularDirection(J, part, rank, reach),
        limits: distances,
        screws: screwsOf(T, J),
    };
}

// Screw axes of the moved joints in the base frame, (ω; v at the base's origin), point and pitch.
export function screwsOf(T, J) {
    const m = J.length / 6;
    return Array.from({ length: m }, (_, i) => {
        const w = [J[i], J[m + i], J[2 * m + i]];
        const at = [J[3 * m + i], J[4 * m + i], J[5 * m + i]];
        const moment = cross3(positionOf(T), w);
        const v = at.map((x, r) => x + moment[r]);
        const square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
        const pitch = square > 0 ? (w[0] * v[0] + w[1] * v[1] + w[2] * v[2]) / square : Infinity;
        const point = square > 0 ? cross3(w, v).map((x) => x / square) : [NaN, NaN, NaN];
        return { w, v, pitch, point };
    });
}

// The motion of a unit twist (ω; v) in words: a translation where v / length is the larger part.
export function directionWords(twist, length) {
    const w = twist.slice(0, 3);
    const v = twist.slice(3).map((x) => x / length);
    const moves = Math.hypot(...v) >= Math.hypot(...w);
    const part = moves ? v : w;
    const size = Math.hypot(...part);
    return `${moves ? "along" : "turning about"} (${part.map((x) => fixed(x / size, 2)).join(", ")})`;
}

const MEASURES = ["manipulability", "smallest singular value", "condition", "moves worst", "nearest limit"];
const ROWS = ["ωx", "ωy", "ωz", "vx", "vy", "vz"];

// Tables of the numbers, which are written again at each change where they can be seen.
export class Numbers {
    constructor(poekin) {
        this.poekin = poekin;
        this.box = element("div", { class: "numbers" });
        this.writers = [];
        this.build();
    }

    build() {
        this.writers = [];
        this.box.replaceChildren();
        const { poekin } = this;
        const arm = poekin.scene.arms[0];
        const names = arm.tips[poekin.selectedTip].coordinates.map((k) => arm.coordinates[k].name);
        const m = names.length;
        this.table("Pose of the tip", true, ["", "x", "y", "z", "w"], ["p (m)", "quaternion", "rpy (rad)"], (n) => [
            [...n.position, null], n.quaternion, [...n.rpy, null],
        ]);
        this.table("Matrix of the pose", false, ["", "x", "y", "z", "p (m)"], ["", "", ""], (n) => rowsOf(n.matrix.slice(0, 12), 4));
        this.table("How well it moves", true, ["", ""], MEASURES, (n) => {
            const { yoshikawa, smallest, condition } = n.manipulability;
            const least = Math.min(...n.limits);
            const figured = [yoshikawa, smallest, condition].map((x) => [figures(x, 4)]);
            return [...figured, [directionWords(n.singular.twist, arm.tips[poekin.selectedTip].reach)], [this.limit(least, n, names, arm)]];
        });
        this.table("Jacobian (ω; v) at the tip", false, ["", ...names], ROWS, (n) => rowsOf(n.J, m));
        this.table("Screw axes now", false, ["", "ωx", "ωy", "ωz", "vx", "vy", "vz", "pitch"], names, (n) =>
            n.screws.map((s) => [...s.w, ...s.v, s.pitch]),
        );
        this.table("Distance to the limits", false, ["", "rad or m"], names, (n) => n.limits.map((x) => [x]));
    }

    limit(least, n, names, arm) {
        if (least === Infinity) {
            return "none";
        }
        const k = n.limits.indexOf(least);
        const coordinate = arm.coordinates[arm.tips[this.poekin.selectedTip].coordinates[k]];
        const shown = coordinate.unit === "rad" ? `${fixed((least * 180) / Math.PI, 1)}°` : `${fixed(least, 4)} m`;
        return `${shown} (${names[k]})`;
    }

    // A folded table whose cells are what rows(numbers) gives: numbers or words.
    table(title, open, heads, names, rows) {
        const head = element("tr", {}, ...heads.map((text) => element("th", { text, title: text, scope: "col" })));
        const cells = names.map(() => []);
        const lines = names.map((name, r) => {
            const line = element("tr", {}, element("th", { text: name, title: name, scope: "row" }));
            for (let c = 1; c < heads.length; c++) {
                const text = document.createTextNode("");
                cells[r].push(text);
                line.append(element("td", {}, text));
            }
            return line;
        });
        const wordy = heads.every((text) => text === "");
        const grid = element("table", { class: wordy ? "wordy" : "" }, ...(wordy ? [] : [head]), ...lines);
        const made = section(title, open, element("div", { class: "wide" }, grid));
        made.addEventListener("toggle", () => this.update());
        this.box.append(made);
        this.writers.push({ made, cells, rows });
    }

    update() {
        let numbers = null;
        for (const { made, cells, rows } of this.writers) {
            if (made.open) {
                numbers ??= this.poekin.numbers();
                write(cells, rows(numbers));
            }
        }
    }
}

function write(cells, values) {
    values.forEach((row, r) => {
        row.forEach((value, c) => {
            const text = typeof value === "number" ? fixed(value, 4) : (value ?? "");
            if (cells[r][c].data !== text) {
                cells[r][c].data = text;
            }
        });
    });
}

function rowsOf(values, width) {
    const rows = [];
    for (let k = 0; k < values.length; k += width) {
        rows.push(values.slice(k, k + width));
    }
    return rows;
}
