"""A picture of joints over time, as SVG text; the one file of the package that imports Matplotlib."""

from __future__ import annotations

import io
import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...errors import MissingExtra, ShapeError, harmless
from ...formats.whole import write_whole
from ...groups.arrays import numbers
from ...model.chain import Chain

PALE = "#9a9a9a"


def plot_joints(
    q: ArrayLike,
    arm: Chain,
    *,
    times: ArrayLike | None = None,
    breaks: Sequence[int] = (),
    path: str | os.PathLike[str] | None = None,
) -> str:
    """Each coordinate over time, or over the number of the point, one below the other, as the text of an SVG.

    The shaded part of a plot is within the coordinate's limits, where they are not far off; dotted lines stand at
    `breaks`, numbers of points before which the path is broken (`Followed.changes`). q (N, m); times (N,), s; path: a
    file that it is written to, whole or not at all. The same numbers give the same text.
    Raises: MissingExtra without Matplotlib (extra `report`); ShapeError, InputError, FileError.
    """
    try:
        import matplotlib
    except ModuleNotFoundError as missing:
        raise MissingExtra("matplotlib", "report", "a plot of joints") from missing
    from matplotlib.figure import Figure

    q = numbers(q, "q")
    if q.ndim != 2 or q.shape[1] != arm.dof:
        raise ShapeError(f"q: expected shape (N, {arm.dof}), got {q.shape}")
    t = np.arange(len(q), dtype=float) if times is None else numbers(times, "times")
    if t.shape != q.shape[:1]:
        raise ShapeError(f"times: expected shape ({len(q)},), got {t.shape}")
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "poekin", "font.size": 9}):
        figure = Figure((7.2, 0.5 + 1.1 * max(arm.dof, 1)), layout="constrained")
        rows: Any = figure.subplots(max(arm.dof, 1), sharex=True, squeeze=False)[:, 0]
        for k, name in enumerate(arm.q_names):
            _one(rows[k], t, q[:, k], arm.limits[k], [b for b in breaks if 0 < b < len(t)])
            # a dollar sign would begin a formula
            label = harmless(name, 40).replace("$", r"\$")
            rows[k].set_title(f"{label} ({'rad' if arm._turns(k) else 'm'})", loc="left", fontsize=9)
        rows[-1].set_xlabel("point" if times is None else "time (s)")
        out = io.StringIO()
        figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    text = out.getvalue()
    if path is not None:
        write_whole(path, text.encode())
    return text[text.index("<svg") :]


def _one(axes: Any, t: np.ndarray, x: np.ndarray, limits: np.ndarray, breaks: Sequence[int]) -> None:
    """One coordinate; it is not joined across a break."""
    for part in np.split(np.arange(len(t)), breaks):
        axes.plot(t[part], x[part], color="#222222", linewidth=1.1)
    for b in breaks:
        axes.axvline(0.5 * (t[b - 1] + t[b]), color=PALE, linewidth=0.8, linestyle=":")
    low, high = axes.get_ylim()
    axes.axhspan(max(limits[0], low - (high - low)), min(limits[1], high + (high - low)), color="#f0f0f0", zorder=0)
    axes.set_ylim(low, high)
    axes.spines[["top", "right"]].set_visible(False)
