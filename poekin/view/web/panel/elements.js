// Elements of the page. Words go in as text, never as HTML: names come out of files.

export function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (name === "text") {
            made.textContent = value;
        } else if (name.startsWith("on")) {
            made.addEventListener(name.slice(2), value);
        } else if (value !== false) {
            made.setAttribute(name, value === true ? "" : value);
        }
    }
    made.append(...children);
    return made;
}

// Words that may go on in the next line after each "_".
export function breakable(text) {
    return text.split(/(?<=_)/).flatMap((part, k) => (k > 0 ? [element("wbr"), part] : [part]));
}

export function section(title, open, ...children) {
    return element("details", { class: "section", open }, element("summary", { text: title }), ...children);
}

export function button(text, title, onclick, attributes = {}) {
    return element("button", { type: "button", text, title, "aria-label": title, onclick, ...attributes });
}

// A number to so many places, without a negative zero, its sign as wide as a digit.
export function fixed(x, places) {
    if (!Number.isFinite(x)) {
        return Number.isNaN(x) ? "–" : `${x < 0 ? "−" : ""}∞`;
    }
    return unsigned(x.toFixed(places)).replace("-", "−");
}

// The text of a number, a zero without its sign.
export function unsigned(text) {
    return Number(text) === 0 ? text.replace("-", "") : text;
}

// A number to so many figures; powers of ten beyond 10^±4.
export function figures(x, count) {
    if (x === 0 || !Number.isFinite(x)) {
        return fixed(x, 0);
    }
    const size = Math.abs(x);
    const text = size < 1e-3 || size >= 1e5 ? x.toExponential(count - 1) : x.toPrecision(count);
    return text.replace(/-/g, "−");
}
