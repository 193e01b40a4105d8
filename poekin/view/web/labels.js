// Words over the canvas: each label follows its point, and one that would cover another is not shown.

const GAP = 3; // pixels between two labels
const FIRST = { differs: 0, marked: 1 }; // roles whose labels are placed before all others

// The boxes, as places in the list, that can be shown together: each is taken unless it meets one
// that was taken before. A box is {left, top, right, bottom}.
export function apart(boxes, gap = GAP) {
    const taken = [];
    boxes.forEach((box, k) => {
        const meets = (j) => {
            const other = boxes[j];
            return (
                box.left < other.right + gap && other.left < box.right + gap &&
                box.top < other.bottom + gap && other.top < box.bottom + gap
            );
        };
        if (!taken.some(meets)) {
            taken.push(k);
        }
    });
    return taken;
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
        const placed = [];
        for (const one of this.all) {
            one.element.style.visibility = "hidden";
            if (this.drawing.isShown(one.label)) {
                this.place(one, placed);
            }
        }
        placed.sort((a, b) => a.one.order - b.one.order || a.depth - b.depth);
        const all = [...this.kept, ...placed];
        for (const k of apart(all).slice(this.kept.length)) {
            const { one, left, top } = all[k];
            one.element.style.visibility = "visible";
            one.element.style.transform = `translate(${left}px, ${top}px)`;
        }
    }

    place(one, placed) {
        const { width, height } = this;
        const T = this.drawing.poseOf(one.label);
        const [x, y, z] = one.label.point;
        this.point.set(
            T[0] * x + T[1] * y + T[2] * z + T[3],
            T[4] * x + T[5] * y + T[6] * z + T[7],
            T[8] * x + T[9] * y + T[10] * z + T[11],
        );
        const p = this.point.project(this.K.getWorld().camera);
        const left = Math.round((0.5 + p.x / 2) * width + 8);
        const top = Math.round((0.5 - p.y / 2) * height - one.height / 2);
        const right = left + one.width;
        const bottom = top + one.height;
        if (p.z < 1 && left >= 0 && top >= 0 && right <= width && bottom <= height) {
            placed.push({ one, depth: p.z, left, top, right, bottom });
        }
    }
}
