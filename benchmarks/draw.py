"""Drawings for the page, as SVG text: legible in black and white, nothing fetched, no fonts but the
reader's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from poekin import svg
from poekin.svg import GRID, INK, PALE

from .page import plain
from .report import Picture


class Panel(NamedTuple):
    """One of several plots with a common y axis, both axes logarithmic: curves over x; falling: x
    runs downwards.
    """

    x_label: str
    x: Sequence[float]
    curves: Mapping[str, Sequence[float]]
    falling: bool = False


def _picture(caption: str, width: float, height: float, draw: Callable[[Any], None]) -> Picture:
    """The picture that draw(figure) makes, of this size in inches."""
    return Picture(caption, svg.inline(svg.svg(width, height, "the report's pictures", draw, 10)))


def _logarithmic(axis: Any) -> None:
    """A logarithmic scale with its numbers as plain text: Matplotlib's powers of ten, which are
    formulas, would take most of the time of a picture.
    """
    from matplotlib.ticker import LogFormatter

    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    axis.set_major_formatter(LogFormatter())
    axis.set_minor_formatter(LogFormatter())


def _plain(axes: Any) -> Any:
    """Axes in the house's look, with a grid behind the curves."""
    svg.plain(axes)
    axes.grid(axis="y", color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    return axes


def lines(
    caption: str,
    x: Sequence[float],
    curves: Mapping[str, Sequence[float]],
    *,
    x_label: str,
    y_label: str,
    log: bool = False,
) -> Picture:
    """Curves over x; each has its own line style and marker, as colour alone may not be seen. log:
    on both axes.
    """

    def draw(figure: Any) -> None:
        axes = _plain(figure.subplots())
        styles = [("-", "o"), ("--", "s"), (":", "^"), ("-.", "D"), ("-", "v"), ("--", "x")]
        for (label, y), (line, marker) in zip(curves.items(), styles, strict=False):
            axes.plot(
                x,
                y,
                line + marker,
                markersize=4,
                color=INK,
                linewidth=1.1,
                markerfacecolor="white",
                label=label,
            )
        axes.set_xlabel(x_label)
        axes.set_ylabel(y_label)
        if log:
            _logarithmic(axes.xaxis)
            _logarithmic(axes.yaxis)
        else:
            axes.set_xticks(list(x))
        if log:
            figure.legend(loc="outside upper center", ncols=3, frameon=False)
        else:
            axes.legend(frameon=False)

    return _picture(caption, 7.2, 3.4, draw)


def dots(
    caption: str, values: Sequence[float], bar: float, *, x_label: str, y_label: str
) -> Picture:
    """Values in ascending order on a logarithmic scale, with the bar as a line; a zero stands at
    the lower edge.
    """

    def draw(figure: Any) -> None:
        axes = _plain(figure.subplots())
        floor = bar / 1e4
        axes.plot(
            range(1, len(values) + 1),
            [max(v, floor) for v in sorted(values)],
            ".",
            color=INK,
            markersize=4,
        )
        axes.axhline(bar, color=INK, linewidth=1, linestyle="--")
        axes.annotate("bar", (1, bar), xytext=(0, 3), textcoords="offset points")
        _logarithmic(axes.yaxis)
        axes.set_ylim(floor / 1.5, bar * 3)
        axes.set_xlabel(x_label)
        axes.set_ylabel(y_label)

    return _picture(caption, 7.2, 3.0, draw)


def bars(caption: str, rows: Mapping[str, Mapping[str, float | None]], *, x_label: str) -> Picture:
    """Horizontal bars on a logarithmic scale: rows {label: {series: value}}, None for a bar that
    there is not.

    A series is known by its hatching, and each value stands at the end of its bar.
    """
    series = list(dict.fromkeys(name for row in rows.values() for name in row))

    def draw(figure: Any) -> None:
        axes = _plain(figure.subplots())
        looks: list[dict[str, Any]] = [
            {"color": INK},
            {"facecolor": "white", "edgecolor": INK, "hatch": "////"},
            {"color": PALE},
        ]
        thickness = 0.8 / max(len(series), 1)
        values = [value for row in rows.values() for value in row.values() if value]
        least, most = min(values, default=1.0), max(values, default=1.0)
        for number, name in enumerate(series):
            there, places = [], []
            for k, row in enumerate(rows.values()):
                if value := row.get(name):
                    mates = [other for other in series if row.get(other)]
                    there.append((k, value))
                    places.append(k + (mates.index(name) - (len(mates) - 1) / 2) * thickness)
            lengths = [value for _, value in there]
            axes.barh(
                places,
                lengths,
                0.85 * thickness,
                label=name,
                linewidth=0.8,
                **looks[number % len(looks)],
            )
            for place, value in zip(places, lengths, strict=True):
                axes.annotate(f"{value:.3g}", (value, place), xytext=(3, 0), textcoords="offset points", va="center",
                              fontsize=8.5)  # fmt: skip
        # A label is data: a dollar sign in it is no formula.
        axes.set_yticks(
            range(len(rows)), [" ".join(plain(label).split()) for label in rows], parse_math=False
        )
        axes.invert_yaxis()
        _logarithmic(axes.xaxis)
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.set_xlim(least / 2, most * 3)
        axes.set_xlabel(x_label)
        axes.grid(axis="y", visible=False)
        axes.grid(axis="x", color=GRID, linewidth=0.6)
        figure.legend(loc="outside upper right", ncols=len(series), frameon=False)

    return _picture(caption, 7.2, 0.9 + 0.27 * sum(len(row) for row in rows.values()), draw)


def panels(
    caption: str, parts: Sequence[Panel], *, y_label: str, bar: float, off_scale: str
) -> Picture:
    """Plots beside each other with the bar across; the first curve is bold.

    An infinite value is its curve's marker at the top edge, where off_scale says what it means; a
    NaN is a gap; what is below bar ÷ 300 is left out.
    """

    def draw(figure: Any) -> None:
        plots = figure.subplots(1, len(parts), sharey=True, squeeze=False)[0]
        values = [
            y for part in parts for curve in part.curves.values() for y in curve if math.isfinite(y)
        ]
        floor, top = max(min(values) / 3, bar / 300), max([*values, bar]) * 30
        styles = [
            ("-", ""),
            ("--", "s"),
            (":", "^"),
            ("-.", "D"),
            ("-", "v"),
            ("--", "x"),
            (":", "o"),
            ("-.", "+"),
        ]
        for axes, part in zip(plots, parts, strict=True):
            for number, (label, curve) in enumerate(part.curves.items()):
                line, marker = styles[number % len(styles)]
                finite = [y if math.isfinite(y) else math.nan for y in curve]
                lost = [x for x, y in zip(part.x, curve, strict=True) if math.isinf(y)]
                every = (number % 4, 4)
                axes.plot(part.x, finite, line, marker=marker or None, markevery=every, markersize=4.5, color=INK,
                          linewidth=1.0 if number else 2.6, markerfacecolor="white", label=label)  # fmt: skip
                axes.plot(
                    lost,
                    [top] * len(lost),
                    marker=marker or "o",
                    linestyle="",
                    color=INK,
                    markersize=5,
                )
            axes.axhline(bar, color=PALE, linewidth=1.2)
            _logarithmic(axes.xaxis)
            _logarithmic(axes.yaxis)
            axes.set(xlabel=part.x_label, ylim=(floor, top * 3))
            _plain(axes)
            if part.falling:
                axes.invert_xaxis()
            if any(math.isinf(y) for curve in part.curves.values() for y in curve):
                axes.axhline(top / 3, color=PALE, linewidth=0.8, linestyle=":")
                axes.annotate(
                    off_scale,
                    (0.02, 1.0),
                    xycoords="axes fraction",
                    va="bottom",
                    fontsize=9,
                    color="#444444",
                )
        plots[0].set_ylabel(y_label)
        plots[0].annotate(f"bar {bar:g}", (0.01, bar), xycoords=("axes fraction", "data"), xytext=(0, 3),
                          textcoords="offset points", fontsize=9)  # fmt: skip
        figure.legend(
            *plots[0].get_legend_handles_labels(),
            loc="outside upper center",
            ncols=6,
            frameon=False,
        )

    return _picture(caption, 9.0, 3.9, draw)
