"""Drawings for the page, as SVG text: legible in black and white, nothing fetched, no fonts but the reader's."""

from __future__ import annotations

import io
from collections.abc import Sequence

from poekin.errors import MissingExtra

from .report import Picture

INK, PALE = "#222222", "#9a9a9a"


def _axes(width: float, height: float):  # type: ignore[no-untyped-def]
    try:
        import matplotlib
    except ModuleNotFoundError as missing:
        raise MissingExtra("matplotlib", "report", "the report's pictures") from missing
    from matplotlib.figure import Figure

    # The same numbers give the same file: no random identifiers.
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "poekin", "font.size": 10})
    figure = Figure((width, height), layout="constrained")
    axes = figure.subplots()
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(axis="y", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    return figure, axes


def _svg(figure) -> str:  # type: ignore[no-untyped-def]
    out = io.StringIO()
    figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    text = out.getvalue()
    return text[text.index("<svg") :]


def lines(
    caption: str, x: Sequence[float], curves: dict[str, Sequence[float]], *, x_label: str, y_label: str
) -> Picture:
    """Curves over x; each has its own line style and marker, as colour alone may not be seen."""
    figure, axes = _axes(7.2, 3.4)
    styles = [("-", "o"), ("--", "s"), (":", "^"), ("-.", "D"), ("-", "v"), ("--", "x")]
    for (label, y), (line, marker) in zip(curves.items(), styles, strict=False):
        axes.plot(x, y, line + marker, markersize=4, color=INK, linewidth=1.1, markerfacecolor="white", label=label)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.set_xticks(list(x))
    axes.legend(frameon=False)
    return Picture(caption, _svg(figure))


def dots(caption: str, values: Sequence[float], bar: float, *, x_label: str, y_label: str) -> Picture:
    """Values in ascending order on a logarithmic scale, with the bar as a line; a zero stands at the lower edge."""
    figure, axes = _axes(7.2, 3.0)
    floor = bar / 1e4
    axes.plot(range(1, len(values) + 1), [max(v, floor) for v in sorted(values)], ".", color=INK, markersize=4)
    axes.axhline(bar, color=INK, linewidth=1, linestyle="--")
    axes.annotate("bar", (1, bar), xytext=(0, 3), textcoords="offset points")
    axes.set_yscale("log")
    axes.set_ylim(floor / 1.5, bar * 3)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    return Picture(caption, _svg(figure))
