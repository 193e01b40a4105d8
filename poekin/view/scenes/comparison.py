"""Scene of a comparison: two models of one arm overlaid, what differs in red."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ...analysis.compare.comparison import Comparison, JointComparison
from ...analysis.compare.joint_table import HEADS, joint_row
from ...groups import se3
from ..scene import PageTable, Scene
from .arm import arm_scene, arm_size
from .arm_parts.of_chain import chain_geometry
from .two_arms.exaggerated import compared_rows, exaggerated
from .two_arms.overlay import second_arm, second_nodes

MOST_WORDS = 8
"""Sentences of the comparison that the page holds."""
ALWAYS = 7
"""Columns of the table that are always shown."""
NOTHING = {"", "0 deg", "0 mm", "same", "0 0"}
"""Cells of the other columns where the models agree."""
LEGEND = "Grey: the first model; blue: the second; red: what differs."


def comparison_scene(found: Comparison, *, q: Any = None, title: str = "") -> Scene:
    """Scene of two models that were compared.

    Parameters
    ----------
    found : Comparison
        Result of `compare`.
    q : (m,) array_like or dict, optional
        Configuration of model a when the page opens, rad or m.
    title : str, optional
        Title of the page.

    Returns
    -------
    scene : Scene
        Model a at its base; model b, aligned as `found` says, at the same joint values; joints
        that differ in the role "differs", and their differences as large as `exaggerated`, which
        is the last coordinate of the second arm.

    Raises
    ------
    ShapeError, UnknownName, InputError
        If q does not fit model a.

    Notes
    -----
    Accuracy: at a factor of 1 model b stands where `compare` has it, to the rounding of
    `Chain.fk` (tests/view/scenes/test_comparison_scene.py).
    """
    scene = arm_scene(found.a, q=q)
    second = exaggerated(found)
    base = np.eye(4) if found.base is None else found.base
    n = len(found.b.screws)
    factors = np.zeros((n, found.a.dof))
    if found.joints:
        directions = [[-1.0 if joint.reversed else 1.0] for joint in found.joints]
        factors = directions * found.a.coupling[compared_rows(found)]
    arm = second_arm(second, base, factors)
    own_size = arm_size(chain_geometry(second.b), np.zeros(n))
    size = max(scene.size, own_size)
    ends = set(_moved_ends(found))
    nodes = second_nodes(second, _sentences(found), ends, size)
    lines = found.summary().splitlines()
    words = [lines[-1], LEGEND, *lines[:-1]]
    left = len(words) - MOST_WORDS
    if left > 0:
        words[MOST_WORDS:] = [f"{left} more: summary() of the comparison, and `poekin compare`."]
    return replace(
        scene,
        title=title or f"Two models of one arm: {found.a.base} → {found.a.tip}",
        words=tuple(words),
        arms=(*scene.arms, arm),
        nodes=(*scene.nodes, *nodes),
        shown=frozenset({"skeleton", "axes", "differences", "frames"}),
        size=size,
        tables=(joint_table(found),),
        exaggerated=second.factor,
    )


def joint_table(found: Comparison) -> PageTable:
    """The joints of both models side by side; the last columns only where they say something."""
    rows = (map(str, joint_row(joint, found)) for joint in found.joints)
    columns = list(zip(HEADS, *rows, strict=True))
    told = columns[:ALWAYS]
    for column in columns[ALWAYS:]:
        _, *cells = column
        if not NOTHING.issuperset(cells):
            told.append(column)
    heads, *cells = zip(*told, strict=True)
    return PageTable("Joint by joint", heads, tuple(cells))


def _sentences(found: Comparison) -> dict[str, str]:
    """A sentence for each of b's joints that differ: that of the verdict, where it has one."""
    return {joint.name_b: _sentence(joint, found) for joint in found.differing}


def _sentence(joint: JointComparison, found: Comparison) -> str:
    begin = f"joint {joint.number} ("
    own = (words for words in found.findings if words.startswith(begin))
    return next(own, joint.summary())


def _moved_ends(found: Comparison) -> Iterator[str]:
    """Names of b's base and tip, where they are elsewhere than a's."""
    b = found.b
    for name, moved in ((b.base, found.base), (b.tip, found.tool)):
        if moved is not None and np.abs(se3.log(moved)).max() > found.tol_position:
            yield name
