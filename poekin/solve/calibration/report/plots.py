"""Pictures of a calibration, as SVG: legible in black and white."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ....groups.arrays import Array
from ... import svg
from ...svg import INK, PALE
from ..fit.minimise import Step
from ..model.residuals import Residuals
from .changes import Joint

PURPOSE = "a report of a calibration"
MOST_DOTS = 400  # of a curve: what more of them show cannot be seen
_LEAST = 1e-12  # mm and mrad: less is rounding, and a logarithmic axis has to end somewhere
_STYLES: tuple[dict[str, Any], ...] = (
    {"marker": "o", "markersize": 4, "linestyle": "", "markerfacecolor": "white", "color": PALE},
    {"marker": "o", "markersize": 3.5, "linestyle": "", "color": INK},
    {"linestyle": ":", "linewidth": 1.3, "color": INK},
)


class Curve(NamedTuple):
    """Residuals, and what they are of."""

    name: str
    residuals: Residuals


def residuals(curves: Sequence[Curve]) -> str:
    """The share of measurements below each residual: the more to the left, the better. At most
    three curves.
    """
    parts = [("position error (mm)", [1e3 * c.residuals.length for c in curves])]
    if not all(np.isnan(c.residuals.angle).all() for c in curves):
        parts.append(("rotation error (mrad)", [1e3 * c.residuals.angle for c in curves]))

    def draw(figure: Any) -> None:
        panels = figure.subplots(1, len(parts), sharey=True, squeeze=False)[0]
        for axes, (label, series) in zip(panels, parts, strict=True):
            for curve, values, style in zip(curves, series, _STYLES, strict=False):
                x, share = _shares(values)
                axes.plot(np.maximum(x, _LEAST), share, label=curve.name, **style)
            axes.set(xscale="log", xlabel=label)
            axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
            axes.grid(color="#dddddd", linewidth=0.6)
            axes.axhline(50, color=PALE, linewidth=0.8)
            svg.plain(axes)
        panels[0].set(ylabel="share of measurements (%)", ylim=(0, 103))
        figure.legend(
            *panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=3, frameon=False
        )

    return _inline(9.0, 3.5, draw)


def _shares(values: Array) -> tuple[Array, Array]:
    """Values in ascending order, and how many per cent are no larger; many are thinned out evenly."""
    x = np.sort(values[~np.isnan(values)])
    kept = (
        np.unique(np.linspace(0, len(x) - 1, MOST_DOTS).round().astype(int))
        if len(x)
        else np.empty(0, int)
    )
    return x[kept], 100.0 * (kept + 1) / max(len(x), 1)


def joints(found: Sequence[Joint]) -> str:
    """Tilt and shift of each joint's axis in its two directions, with 95 % intervals."""
    panels_of = [("tilt (mrad)", [j.tilt for j in found]), ("shift (mm)", [j.shift for j in found])]

    def draw(figure: Any) -> None:
        panels = figure.subplots(1, 2, sharey=True)
        for axes, (label, changes) in zip(panels, panels_of, strict=True):
            axes.axvline(0, color=PALE, linewidth=0.8)
            for k, name in ((0, "first direction"), (1, "second direction")):
                rows = [i for i, change in enumerate(changes) if len(change.values) > k]
                axes.errorbar(
                    [1e3 * changes[i].values[k] for i in rows], [i + (k - 0.5) * 0.3 for i in rows],
                    xerr=[1e3 * changes[i].margins[k] for i in rows], fmt="s" if k else "o", color=INK, markersize=4.5,
                    markerfacecolor="white" if k else INK, elinewidth=1, capsize=2.5, label=name,
                )  # fmt: skip
            axes.set_xlabel(label)
            axes.grid(axis="x", color="#dddddd", linewidth=0.6)
            svg.plain(axes)
        panels[0].set_yticks(range(len(found)), [svg.label(j.name, 28) for j in found])
        panels[0].set_ylim(len(found) - 0.5, -0.5)
        figure.legend(
            *panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=2, frameon=False
        )

    return _inline(9.0, 1.3 + 0.36 * len(found), draw)


def uncertainty(length: Array, angle: Array) -> str:
    """How many configurations have which standard deviation of position (m) and rotation (rad)."""

    def draw(figure: Any) -> None:
        panels = figure.subplots(1, 2, sharey=True)
        for axes, values, label in (
            (panels[0], length, "position (mm)"),
            (panels[1], angle, "rotation (mrad)"),
        ):
            values = 1e3 * values
            top = float(values.max(initial=0.0)) or 1.0
            axes.hist(values, bins=30, range=(0.0, 1.02 * top), weights=np.full(len(values), 100.0 / len(values)),
                      color=PALE, edgecolor=INK, linewidth=0.7)  # fmt: skip
            axes.axvline(
                np.median(values), color=INK, linewidth=1.2, linestyle="--", label="median"
            )
            axes.set(xlabel=f"standard deviation of the {label}", xlim=(0.0, 1.05 * top))
            svg.plain(axes)
        panels[0].set_ylabel("share of configurations (%)")
        panels[0].legend(frameon=False)

    return _inline(9.0, 2.9, draw)


def steps(found: Sequence[Step]) -> str:
    """Cost and length of each step of the search; hollow dots are steps that had to be damped."""
    number = np.arange(1, len(found) + 1)
    damped = np.array([s.damping > 0 for s in found], bool)

    def draw(figure: Any) -> None:
        panels = figure.subplots(1, 2)
        for axes, values, label in (
            (panels[0], [s.cost for s in found], "cost before the step"),
            (panels[1], [s.step for s in found], "length of the step (rad, reaches)"),
        ):
            y = np.array(values, float)
            y[y <= 0] = np.nan
            axes.plot(number, y, color=PALE, linewidth=0.8)
            axes.plot(number[~damped], y[~damped], ".", color=INK, markersize=5)
            axes.plot(
                number[damped], y[damped], "o", color=INK, markersize=4, markerfacecolor="white"
            )
            if np.isfinite(y).any():
                axes.set_yscale("log")
            axes.set(xlabel="step", ylabel=label)
            axes.xaxis.get_major_locator().set_params(integer=True)
            axes.grid(axis="y", color="#dddddd", linewidth=0.6)
            svg.plain(axes)

    return _inline(9.0, 2.7, draw)


def _inline(width: float, height: float, draw: Callable[[Any], None]) -> str:
    return svg.inline(svg.svg(width, height, PURPOSE, draw))
