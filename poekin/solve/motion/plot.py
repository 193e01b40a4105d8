"""A picture of joints over time, as SVG text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ... import svg
from ...formats.text.atomic_write import FilePath, write_whole
from ...model.chain import Chain
from .csv_io import joints_over_time


def plot_joints(
    q: ArrayLike,
    chain: Chain,
    *,
    times: ArrayLike | None = None,
    breaks: Sequence[int] = (),
    path: FilePath | None = None,
) -> str:
    """Plot of each coordinate over time, or over the number of the point, one below the other.

    The shaded part of a plot is within the coordinate's limits, where they are not far off. The
    same numbers give the same text.

    Parameters
    ----------
    q : (N, m) array_like
        Coordinates, rad or m.
    chain : Chain
        The arm, for names and limits.
    times : (N,) array_like, optional
        Times, s.
    breaks : sequence of int, optional
        Numbers of points before which the path is broken (`PathResult.branch_switches`): there
        dotted lines stand.
    path : path_like, optional
        File that it is written to, whole or not at all.

    Returns
    -------
    svg : str
        The plot as SVG text.

    Raises
    ------
    MissingExtra
        If Matplotlib (extra `report`) is not installed.
    ShapeError
        If q or `times` has another shape.
    InputError
        If an argument is no array of numbers.
    FileError
        If the file cannot be written.

    Notes
    -----
    Source: none, a drawing.
    """
    joints, t = joints_over_time(q, times, chain.dof)
    unit = "time (s)"
    if t is None:
        unit = "point"
        t = np.arange(len(joints), dtype=float)

    def draw(figure: Any) -> None:
        rows: Any = figure.subplots(max(chain.dof, 1), sharex=True, squeeze=False)[:, 0]
        inside = [b for b in breaks if 0 < b < len(t)]
        for k, name in enumerate(chain.q_names):
            _one(rows[k], t, joints[:, k], chain.limits[k], inside)
            rows[k].set_title(
                f"{svg.label(name)} ({'rad' if chain.is_angle(k) else 'm'})",
                loc="left",
                fontsize=9,
            )
        rows[-1].set_xlabel(unit)

    text = svg.svg(7.2, 0.5 + 1.1 * max(chain.dof, 1), "a plot of joints", draw)
    if path is not None:
        write_whole(path, text.encode())
    return svg.inline(text)


def _one(
    axes: Any,
    t: np.ndarray,
    x: np.ndarray,
    limits: np.ndarray,
    breaks: Sequence[int],
) -> None:
    """One coordinate; it is not joined across a break."""
    for part in np.split(np.arange(len(t)), breaks):
        axes.plot(t[part], x[part], color=svg.INK, linewidth=1.1)
    for b in breaks:
        axes.axvline(0.5 * (t[b - 1] + t[b]), color=svg.PALE, linewidth=0.8, linestyle=":")
    low, high = axes.get_ylim()
    axes.axhspan(
        max(limits[0], low - (high - low)),
        min(limits[1], high + (high - low)),
        color="#f0f0f0",
        zorder=0,
    )
    axes.set_ylim(low, high)
    svg.plain(axes)
