"""Scene of a singularity: the arm where it was asked, and the motion that is lost there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ...analysis.dexterity.messages import motion_words
from ...analysis.dexterity.singularity import Singularity
from ...groups.arrays import Array
from ...groups.vectors import angular_part, linear_part, norm, translation_part
from ...model.robot import Robot
from ..nodes import Label, Node, Role, Triangles
from ..scene import Scene
from ..shapes import arrow
from .stage import Stage, make_stage

LENGTH = 0.25
"""Length of an arrow as a share of the arm's size."""
SMALL = 1e-3
"""Share of a unit twist below which a part of it is not drawn."""


def singularity_scene(found: Singularity, robot: Robot | None = None) -> Scene:
    """Scene of a singularity.

    Parameters
    ----------
    found : Singularity
        Result of `singularity`.
    robot : Robot, optional
        The robot of the arm, to be drawn in its place.

    Returns
    -------
    scene : Scene
        The arm at `found.q`, with the lost motions, or the one that would be lost first, as arrows
        at the tip: along the translation, and along the axis of the rotation.
    """
    stage = make_stage(found.chain, found.q, robot)
    tip = translation_part(found.chain.fk(found.q))
    lost = found.singular_subspace if found.singular else found.singular_direction[None]
    arrows = [node for twist in lost for node in _arrows(twist, found.length, tip, stage)]
    # in place of the page's own arrow, which is of what the tip moves worst as it stands
    own = [node for node in stage.scene.nodes if node.attachment.rule != "singular"]
    stage = stage._replace(scene=replace(stage.scene, nodes=tuple(own), words=()))
    title = f"Singularity of {found.chain.tip} in {found.chain.base}"
    return stage.with_result(title, [found.summary()], arrows, "singular")


def _arrows(twist: Array, length: float, tip: Array, stage: Stage) -> Iterator[Node]:
    """Arrows of a unit twist at the tip: its translation by length, and its rotation."""
    words = motion_words(twist)
    parts: tuple[tuple[Array, Role, str], ...] = (
        (linear_part(twist) / length, "marked", "lost translation"),
        (angular_part(twist), "angular", "lost rotation"),
    )
    for part, role, label in parts:
        share = norm(part)
        if share < SMALL:
            continue
        attachment = stage.attachment("singular", role, f"{label}: {words}")
        length_drawn = LENGTH * stage.size * share
        way = part / share
        yield Triangles(attachment, *arrow().scaled(length_drawn).placed(tip, way))
        yield Label(attachment, tip + 1.1 * length_drawn * way, label)
