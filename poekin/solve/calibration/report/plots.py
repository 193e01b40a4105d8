"""Pictures of a calibration, as SVG: legible in black and white."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .... import svg
from ....groups.arrays import Array
from ....svg import GRID, INK, PALE
from ..fit.minimise import Step
from .changes import NamedResiduals

PURPOSE = "a report of a calibration"
WIDTH = 9.0
MOST_DOTS = 400  # of a curve: what more of them show cannot be seen
_LEAST = 1e-12  # mm and mrad: less is rounding, and a logarithmic axis has to end somewhere
_STYLES: tuple[dict[str, Any], ...] = (
    {
        "marker": "o",
        "markersize": 4,
        "linestyle": "",
        "markerfacecolor": "white",
        "color": PALE,
    },
    {
        "marker": "o",
        "markersize": 3.5,
        "linestyle": "",
        "color": INK,
    },
    {
        "linestyle": ":",
        "linewidth": 1.3,
        "color": INK,
    },
)


def residuals(curves: Sequence[NamedResiduals]) -> str:
    """The share of measurements below each residual: the more to the left, the better. At most
    three curves.
    """
    names = [c.name for c in curves]
    angles = [1e3 * c.residuals.angle for c in curves]
    panels = {"position error (mm)": [1e3 * c.residuals.length for c in curves]}
    if not all(np.isnan(angle).all() for angle in angles):
        panels["rotation error (mrad)"] = angles

    def draw(figure: Any) -> None:
        every = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
        for axes, label in zip(every, panels, strict=True):
            _distributions(axes, label, names, panels[label])
        every[0].set(ylabel="share of measurements (%)", ylim=(0, 103))
        _legend(figure, every[0], 3)

    return inline(3.5, draw)


def _distributions(
    axes: Any,
    label: str,
    names: Sequence[str],
    series: Sequence[Array],
) -> None:
    for name, values, style in zip(names, series, _STYLES, strict=False):
        x, share = _shares(values)
        axes.plot(np.maximum(x, _LEAST), share, label=name, **style)
    axes.set(xscale="log", xlabel=label)
    axes.xaxis.set_major_formatter(_figure)
    axes.axhline(50, color=PALE, linewidth=0.8)
    plain(axes, "both")


def _shares(values: Array) -> tuple[Array, Array]:
    """Values in ascending order, thinned out, and the share of all (%) up to each."""
    x = np.sort(values[~np.isnan(values)])
    if not len(x):
        return x, x
    even = np.linspace(0, len(x) - 1, MOST_DOTS)
    kept = np.unique(even.round().astype(int))
    return x[kept], 100.0 * (kept + 1) / len(x)


def uncertainty(length: Array, angle: Array) -> str:
    """Histograms of the standard deviation of position (m) and rotation (rad) over configurations."""

    def draw(figure: Any) -> None:
        panels = figure.subplots(1, 2, sharey=True)
        _histogram(panels[0], "position (mm)", 1e3 * length)
        _histogram(panels[1], "rotation (mrad)", 1e3 * angle)
        panels[0].set_ylabel("share of configurations (%)")
        panels[0].legend(frameon=False)

    return inline(2.9, draw)


def _histogram(axes: Any, label: str, values: Array) -> None:
    top = float(values.max()) or 1.0
    axes.hist(
        values,
        bins=30,
        range=(0.0, 1.02 * top),
        weights=np.full(len(values), 100.0 / len(values)),
        color=PALE,
        edgecolor=INK,
        linewidth=0.7,
    )
    axes.axvline(
        np.median(values),
        color=INK,
        linewidth=1.2,
        linestyle="--",
        label="median",
    )
    axes.set(xlabel=f"standard deviation of the {label}", xlim=(0.0, 1.05 * top))
    svg.plain(axes)


def steps(found: Sequence[Step]) -> str:
    """Cost and length of each step of the search; hollow dots are steps that had to be damped."""
    damped = np.array([s.damping > 0 for s in found], bool)

    def draw(figure: Any) -> None:
        panels = figure.subplots(1, 2)
        _course(panels[0], "cost before the step", [s.cost for s in found], damped)
        _course(panels[1], "length of the step (rad, reaches)", [s.step for s in found], damped)

    return inline(2.7, draw)


def _course(
    axes: Any,
    label: str,
    values: Sequence[float],
    damped: NDArray[np.bool_],
) -> None:
    """One number of each step, on a logarithmic axis."""
    number = np.arange(1, len(values) + 1)
    y = np.array(values, float)
    y[y <= 0] = np.nan
    axes.plot(number, y, color=PALE, linewidth=0.8)
    for chosen, face in ((~damped, INK), (damped, "white")):
        axes.plot(
            number[chosen],
            y[chosen],
            "o",
            color=INK,
            markersize=4,
            markerfacecolor=face,
        )
    if np.isfinite(y).any():
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter(_figure)
    axes.set(xlabel="step", ylabel=label)
    axes.xaxis.get_major_locator().set_params(integer=True)
    plain(axes, "y")


def _figure(value: float, _: int) -> str:
    """A tick's label: ten times as fast as Matplotlib's powers of ten, which are formulas."""
    return f"{value:g}"


def _legend(figure: Any, axes: Any, columns: int) -> None:
    """Legend of one panel above all."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(
        handles,
        labels,
        loc="outside upper left",
        ncols=columns,
        frameon=False,
    )


def plain(axes: Any, grid: str) -> None:
    """The house's look, with lines at the ticks of the axis `grid`."""
    axes.grid(axis=grid, color=GRID, linewidth=0.6)
    svg.plain(axes)


def inline(height: float, draw: Callable[[Any], None]) -> str:
    """A picture as wide as the page, to be put into it."""
    return svg.inline(svg.svg(WIDTH, height, PURPOSE, draw))
