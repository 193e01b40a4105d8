"""Poses as small frames in the world, and the solutions of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...analysis.amounts import Unit, amount
from ...errors import InputError
from ...groups.arrays import Array
from ...groups.vectors import translation_part
from ...model.chain import Chain
from ...model.robot import Robot
from ...solve.ik.solution import Solution
from ...solve.ik_all.all_solutions import AllSolutions
from ..nodes import Label, Node, Triangles
from ..scene import Scene, SceneChoice
from ..shapes import frame_axes
from .arm_parts.axes import XYZ
from .stage import Stage, make_stage

MOST = 32
"""Configurations that a reader can choose."""


def pose_nodes(stage: Stage, poses: Array, length: float, name: str) -> list[Node]:
    """Frames at poses (n, 4, 4) in the chain's base, m, as arrows of a length."""
    nodes: list[Node] = []
    for k, pose in enumerate(poses):
        words = name if len(poses) == 1 else f"{name} {k}"
        for role, axis in zip(XYZ, frame_axes(pose, length), strict=True):
            attachment = stage.attachment("path", role, words)
            nodes.append(Triangles(attachment, *axis))
    return nodes


def target_nodes(stage: Stage, poses: Array) -> list[Node]:
    """Frames at targets, the word "target" beside a single one."""
    nodes = pose_nodes(stage, poses, 0.1 * stage.size, "target")
    if len(poses) == 1:
        place = translation_part(poses[0]) + 0.03 * stage.size
        attachment = stage.attachment("path", "path", "target")
        nodes.append(Label(attachment, place, "target"))
    return nodes


def configuration_words(chain: Chain, q: Array) -> str:
    """A configuration for reading: "12.5°, −3°, 20 mm"."""
    rounded = np.round(q, 9) + 0.0  # what is below is the rounding of a zero
    words = []
    for k, x in enumerate(rounded.tolist()):
        unit: Unit = "rad" if chain.is_angle(k) else "m"
        words.append(amount(x, unit, 3))
    return ", ".join(words)


def asked_of(found: Solution | AllSolutions) -> tuple[Chain, Array]:
    """Arm and targets (n, 4, 4) of a result. Raises: InputError where it was made by hand."""
    if found.chain is None or found.target is None:
        kind = type(found).__name__
        raise InputError(f"view: {kind}: expected one that ik or ik_all returned, with its chain")
    return found.chain, found.target.reshape(-1, 4, 4)


def solution_scene(found: Solution, robot: Robot | None = None) -> Scene:
    """Scene of `ik`: the arm at the solution, and the target.

    Parameters
    ----------
    found : Solution
        Result of `ik`.
    robot : Robot, optional
        The robot of the arm, to be drawn in its place.

    Returns
    -------
    scene : Scene
        The arm at its solution, or where it comes nearest to the target; of several targets the
        first `MOST`, one of which a reader chooses.

    Raises
    ------
    InputError
        If the result holds no chain, or no finite target.
    """
    chain, poses = asked_of(found)
    q = found.q.reshape(-1, chain.dof)
    finite = np.isfinite(q).all(axis=1) & np.isfinite(poses).all(axis=(1, 2))
    known = np.flatnonzero(finite)
    if not len(known):
        raise InputError(f"view: expected a finite target, got {found.summary()}")
    stage = make_stage(chain, q[known[0]], robot)
    shown = known[:MOST]
    rows = stage.configurations(q[shown])
    words = [found.summary()]
    if len(known) > MOST:
        words.append(f"The first {MOST} of {len(known)} targets are shown.")
    scene = stage.with_result(
        f"Inverse kinematics of {chain.tip} in {chain.base}",
        words,
        target_nodes(stage, poses[shown]),
        "path",
        rows=rows,
    )
    if not found.success.ndim:
        return scene
    reasons = found.reason.reshape(-1)[shown]
    flat = zip(shown.tolist(), rows, reasons, strict=True)
    choices = tuple(SceneChoice(row, f"target {k}: {reason}") for k, row, reason in flat)
    return replace(scene, choices=choices)
