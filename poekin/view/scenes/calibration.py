"""Scene of a calibration: the nominal and the calibrated arm, and what measurements say of both."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...analysis.compare.compare import compare
from ...groups.arrays import Array
from ...groups.vectors import norm, norms
from ...solve.calibration.calibration import Calibration
from ...solve.calibration.model.residual_vectors import ResidualVectors
from ...solve.calibration.report import changes
from ..nodes import Attachment, Cloud, Node, Role, Triangles
from ..scene import PageTable, Scene
from ..shapes import arrow, merged
from .arm import arm_scene, arm_size
from .arm_parts.of_chain import chain_geometry
from .stage import evenly
from .two_arms.exaggerated import STEPS, exaggerated, visible_factor
from .two_arms.overlay import second_arm, second_nodes

MOST = 400
"""Residuals that are drawn."""
SIDES = 5
"""Sides of the polygon that stands for an arrow's circle."""


def calibration_scene(found: Calibration) -> Scene:
    """Scene of a calibration.

    Parameters
    ----------
    found : Calibration
        Result of `calibrate`.

    Returns
    -------
    scene : Scene
        The nominal and the calibrated arm at the same coordinates, the corrections of the axes
        enlarged; at measured points the residuals of both, enlarged by a factor that the page
        says; a table of the corrections. Of a calibration out of a file without residuals.
    """
    vectors = found.residuals
    scene = arm_scene(found.nominal, q=_widest(found))
    side_by_side = compare(found.nominal, found.chain, strict=True)
    second = exaggerated(side_by_side)
    arm = second_arm(second, np.eye(4), np.asarray(found.chain.coupling))
    nodes = second_nodes(second, {}, (), scene.size)
    words = [changes.sentence(found), *found.warnings]
    if vectors is not None and len(vectors.places):
        lengths = norms(np.array([vectors.before, vectors.after]))
        nine_of_ten = float(np.quantile(lengths, 0.9))
        k = visible_factor(nine_of_ten, scene.size, (1000.0, *STEPS))
        nodes += _residuals(vectors, k, scene.size)
        words.append(
            f"Residuals are drawn {k:g} times as long, from the measured point to where the nominal"
            " arm (red) and the calibrated arm (blue) have it."
        )
    return replace(
        scene,
        title=f"Calibration: {found.chain.base} → {found.chain.tip}",
        words=tuple(words),
        arms=(*scene.arms, arm),
        nodes=(*scene.nodes, *nodes),
        shown=frozenset({"skeleton", "axes", "frames", "cloud"}),
        tables=(correction_table(found),),
        exaggerated=second.factor,
    )


def _widest(found: Calibration) -> Array | None:
    """The measured configuration, of some, at which the arm reaches farthest; None where there is none."""
    if found.residuals is None or not len(found.residuals.q):
        return None
    q = found.residuals.q
    some = q[evenly(len(q), MOST)]
    arm = chain_geometry(found.nominal)
    sizes = [arm_size(arm, row) for row in some]
    return some[np.argmax(sizes)]


def correction_table(found: Calibration) -> PageTable:
    """Distance of each axis from the nominal one, base and tool aligned."""
    rows = tuple(changes.row(joint) for joint in changes.aligned_joints(found))
    return PageTable("Corrections of the axes", changes.HEADS, rows)


def _residuals(vectors: ResidualVectors, k: float, size: float) -> Iterator[Node]:
    """Measured points, and arrows from them to where the two arms have them, k times as long."""
    chosen = evenly(len(vectors.places), MOST)
    measured = (vectors.places - vectors.after)[chosen]
    lengths = norms(vectors.before[chosen])
    points = Attachment("cloud", "second", 0, name="measured points")
    yield Cloud(points, measured, 0.006 * size, lengths)
    of_arms: tuple[tuple[Array, Role, str], ...] = (
        (vectors.before, "differs", "residuals of the nominal arm"),
        (vectors.after, "second", "residuals of the calibrated arm"),
    )
    for errors, role, name in of_arms:
        arrows = _arrows(measured, k * errors[chosen], size)
        if arrows is not None:
            yield replace(arrows, attachment=Attachment("cloud", role, 0, name=f"{name} × {k:g}"))


def _arrows(starts: Array, ways: Array, size: float) -> Triangles | None:
    """Arrows from points along vectors, as one surface; None where all have no length."""
    surfaces = []
    for start, way in zip(starts, ways, strict=True):
        length = norm(way)
        if length < 1e-4 * size:
            continue
        thick = min(0.003 * size, 0.1 * length)
        one = arrow(length, thick, 2.5 * thick, min(6.0 * thick, 0.4 * length), SIDES)
        surfaces.append(one.placed(start, way / length))
    if not surfaces:
        return None
    return Triangles(Attachment("cloud", "second", 0), *merged(*surfaces))
