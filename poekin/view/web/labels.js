// Words over the canvas: each label follows its point, and one that would cover another is not shown.

import { moved } from "./drawing.js";

const GAP = 3; // pixels between two labels
const ASIDE = 8; // pixels between a label and its point
const FIRST = { differs: 0, marked: 1 }; // roles whose labels are placed before all others

// For each list of boxes, best first, the first of them that meets none that is taken already, kept
// ones or those of lists before it; null where there is none. A box is {left, top, right, bottom}.
export function apart(lists, kept = [], gap = GAP) {
    const taken = [...kept];
    return lists.map((boxes) => {
        const found = boxes.find((box) => !taken.some((other) => meet(box, other, gap))) ?? null;
        if (found !== null) {
            taken.push(found);
        }
        return found;
    });
}

function meet(a, b, gap) {
    return a.left < b.right + gap && b.left < a.right + gap && a.top < b.bottom + gap && b.top < a.bottom + gap;
}

export class Labels {
    constructor(K, state, drawing) {
        this.K = K;
        this.state = state;
        this.drawing = drawing;
        this.box = document.createElement("div");
        this.box.className = "labels";
        this.all = state.scene.labels.map((label) => {
            const element = document.createElement("span");
            element.textContent = label.text;
            element.style.setProperty("--color", label.color);
            element.className = `label ${label.role}`;
            this.box.append(element);
            return { label, element, order: FIRST[label.role] ?? 2, width: 0, height: 0 };
        });
        document.getElementById("canvasTarget").append(this.box);
        for (const one of this.all) {
            one.width = one.element.offsetWidth;
            one.height = one.element.offsetHeight;
        }
        this.width = 0;
        this.height = 0;
        this.kept = []; // boxes that the buttons over the canvas take
        new ResizeObserver(() => {
            this.width = this.box.clientWidth;
            this.height = this.box.clientHeight;
            this.kept = this.buttons();
            this.update();
        }).observe(this.box);
        this.point = new K.Provider.THREE.Vector3();
        K.on(K.events.BEFORE_RENDER, () => this.update());
    }

    buttons() {
        const { left, top } = this.box.getBoundingClientRect();
        return [...document.querySelectorAll("#poekin-toolbar, .badge")].map((over) => {
            const box = over.getBoundingClientRect();
            return { left: box.left - left, right: box.right - left, top: box.top - top, bottom: box.bottom - top };
        });
    }

    update() {
        const all = this.all.filter((one) => this.drawing.isShown(one.label)).map((one) => ({ one, ...this.places(one) }));
        all.sort((a, b) => a.one.order - b.one.order || a.depth - b.depth);
        this.all.forEach(({ element }) => {
            element.style.visibility = "hidden";
        });
        apart(all.map(({ boxes }) => boxes), this.kept).forEach((box, k) => {
            if (box !== null) {
                const { style } = all[k].one.element;
                style.visibility = "visible";
                style.transform = `translate(${box.left}px, ${box.top}px)`;
            }
        });
    }

    // Boxes that a label may take: right of its point, left of it, above and below; those in the canvas.
    places(one) {
        const { width, height } = this;
        this.point.set(...moved(this.drawing.poseOf(one.label), one.label.point));
        const p = this.point.project(this.K.getWorld().camera);
        const x = (0.5 + p.x / 2) * width;
        const y = (0.5 - p.y / 2) * height;
        const [w, h] = [one.width, one.height];
        const boxes = [[x + ASIDE, y - h / 2], [x - ASIDE - w, y - h / 2], [x - w / 2, y - ASIDE - h], [x - w / 2, y + ASIDE]]
            .map(([left, top]) => [Math.round(left), Math.round(top)])
            .map(([left, top]) => ({ left, top, right: left + w, bottom: top + h }))
            .filter(({ left, top, right, bottom }) => p.z < 1 && left >= 0 && top >= 0 && right <= width && bottom <= height);
        return { boxes, depth: p.z };
    }
}
