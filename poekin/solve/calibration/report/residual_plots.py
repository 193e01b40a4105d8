"""Pictures of residuals as vectors, in small multiples: against joints, levers, moves, rows, places."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from .... import svg
from ....groups.arrays import Array
from ....svg import INK, PALE
from ..diagnostics.effects.diagnosis import FitEvidence
from ..measurements.points import velocities
from ..model.residual_vectors import ResidualVectors
from ..terms.gravity import levers, wrist_in_tip
from . import plots

_COLUMNS = 3
_MOST_DOTS = 120  # of a panel
_BINS = 8
_STILL = 1e-3  # m/rad: a point so near to a joint's axis is not moved by it
_LEAST = 1e-6  # m: a lever that is never longer carries nothing


class Panel(NamedTuple):
    """One small picture: residuals (mm) against something."""

    x: Array
    y: Array
    label: str


class Picture(NamedTuple):
    """Panels of one kind, and their caption."""

    panels: list[Panel]
    words: str


def pictures(
    residuals: ResidualVectors,
    evidence: FitEvidence,
) -> Iterator[Picture]:
    """Residuals along the motion of each joint, against its value, gravity lever and last move; in
    base axes against row and place.
    """
    chain = evidence.problem.model.nominal
    rows = residuals.rows
    along = 1e3 * _along_joints(residuals, evidence)
    q = residuals.q
    conditions = evidence.conditions
    carried = levers(chain, q, conditions.gravity, wrist_in_tip(chain))
    moved = q - conditions.previous
    by_joint = (
        (q, "", "each joint's value"),
        (carried, "m", "each joint's gravity lever"),
        (moved, "", "each joint's last move"),
    )
    for values, unit, words in by_joint:
        panels = []
        for i, name in enumerate(chain.q_names):
            own = unit or ("deg" if chain.is_angle(i) else "m")
            x = np.rad2deg(values[:, i]) if own == "deg" else values[:, i]
            if np.abs(values[:, i]).max() > _LEAST:
                panels.append(Panel(x[rows], along[:, i], f"{svg.label(name, 24)} ({own})"))
        yield Picture(panels, f"Residuals along the motion of each joint against {words}.")
    e = 1e3 * residuals.after
    panels = [
        Panel(rows.astype(float), e[:, k], f"row: residual along {axis}")
        for k, axis in enumerate("xyz")
    ]
    panels += [
        Panel(residuals.places[:, k], e[:, k], f"{axis} (m): residual along {axis}")
        for k, axis in enumerate("xyz")
    ]
    yield Picture(panels, "Residuals in base axes against the row and the place in space.")


def _along_joints(
    residuals: ResidualVectors,
    evidence: FitEvidence,
) -> Array:
    """Components (K, m) of the residuals along the motion of their point by each joint, m; NaN where
    it does not move.
    """
    twists = evidence.problem.reading_twists(evidence.fit.p)[residuals.rows]
    motions = velocities(twists, residuals.places)
    sizes = np.linalg.norm(motions, axis=1)
    along = np.einsum("kc,kci->ki", residuals.after, motions)
    return np.where(sizes > _STILL, along / np.maximum(sizes, _STILL), np.nan)


def drawn(picture: Picture) -> str:
    """The panels side by side, with one scale of residuals."""
    count = len(picture.panels)
    lines = -(-count // _COLUMNS)

    height = 0.4 + 1.7 * lines

    def draw(figure: Any) -> None:
        # a fixed layout takes half the time of one that looks for room
        figure.set_layout_engine(None)
        figure.subplots_adjust(0.075, 0.5 / height, 0.98, 1.0 - 0.1 / height, 0.08, 0.5)
        grid = figure.subplots(lines, _COLUMNS, sharey=True, squeeze=False)
        every = grid.ravel()
        for axes in every[count:]:
            axes.set_visible(False)
        for axes, panel in zip(every, picture.panels, strict=False):
            _dots(axes, panel)
        for axes in grid[:, 0]:
            axes.set_ylabel("mm")

    return plots.inline(height, draw)


def _dots(
    axes: Any,
    panel: Panel,
) -> None:
    known = np.isfinite(panel.y)
    x = panel.x[known]
    y = panel.y[known]
    dots = min(len(x), _MOST_DOTS)
    some = np.unique(np.linspace(0, len(x) - 1, dots).astype(int))
    axes.plot(x[some], y[some], "o", color=PALE, markersize=2, alpha=0.7)
    parts = [part for part in np.array_split(np.argsort(x), _BINS) if len(part) > 1]
    if parts:
        axes.errorbar(
            [np.mean(x[part]) for part in parts],
            [np.mean(y[part]) for part in parts],
            yerr=[2.0 * np.std(y[part], ddof=1) / np.sqrt(len(part)) for part in parts],
            fmt="o",
            color=INK,
            markersize=3.5,
            elinewidth=1,
        )
    axes.axhline(0, color=INK, linewidth=0.6)
    axes.set_xlabel(panel.label)
    plots.plain(axes, "y")
