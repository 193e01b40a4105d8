"""Poses as small frames in the world, and the solutions of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...analysis.amounts import amount
from ...errors import InputError, quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ...solve.ik.solution import Solution
from ..nodes import Hung, Label, Layer, Node, Triangles
from ..scene import Scene, SceneChoice
from ..shapes import frame_axes
from .arm import arm_scene
from .arm_parts.axes import XYZ

MOST = 32
"""Configurations that a reader can choose."""


def pose_nodes(poses: Array, length: float, layer: Layer, name: str) -> list[Node]:
    """Frames at poses (n, 4, 4) in the world, m, as arrows of a length."""
    return [
        Triangles(Hung(layer, role, name=f"{name} {k}" if len(poses) > 1 else name), *axis)
        for k, pose in enumerate(poses)
        for role, axis in zip(XYZ, frame_axes(pose, length), strict=True)
    ]


def target_nodes(poses: Array, size: float) -> list[Node]:
    """Frames at targets, the word "target" beside a single one."""
    nodes = pose_nodes(poses, 0.1 * size, "path", "target")
    if len(poses) == 1:
        place = poses[0, :3, 3] + 0.03 * size
        nodes.append(Label(Hung("path", "path", name="target"), place, "target"))
    return nodes


def configuration_words(chain: Chain, q: Array) -> str:
    """A configuration for reading: "12.5°, −3°, 20 mm"."""
    units = ("rad" if chain.is_angle(k) else "m" for k in range(chain.dof))
    return ", ".join(amount(float(x), unit, 3) for x, unit in zip(q, units, strict=True))


def chain_kept(chain: Chain | None, what: str) -> Chain:
    """The arm that a result holds. Raises: InputError where it was put together without one."""
    if chain is None:
        raise InputError(f"view: {what} that holds its chain expected, as its function makes it")
    return chain


def solution_scene(found: Solution) -> Scene:
    """Scene of `ik`: the arm at the solution, and the target.

    Parameters
    ----------
    found : Solution
        Result of `ik`.

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
    chain = chain_kept(found.chain, "a Solution")
    q = found.q.reshape(-1, chain.dof)
    poses = np.reshape(found.target, (-1, 4, 4))
    known = np.flatnonzero(np.isfinite(q).all(axis=1) & np.isfinite(poses).all(axis=(1, 2)))
    if not len(known):
        raise InputError(f"view: expected a finite target, got {found.summary()}")
    scene = arm_scene(chain, q=q[known[0]], meshes=False)
    shown = known[:MOST]
    choices: tuple[SceneChoice, ...] = ()
    words = [found.summary()]
    if found.success.ndim:
        flat = zip(shown.tolist(), found.reason.reshape(-1)[shown], strict=True)
        choices = tuple(SceneChoice(q[k], f"target {k}: {reason}") for k, reason in flat)
        if len(known) > MOST:
            words.append(f"The first {MOST} of {len(known)} targets are shown.")
    return replace(
        scene,
        title=f"Inverse kinematics of {quote(chain.tip)} in {quote(chain.base)}",
        words=(*words, *scene.words),
        nodes=(*scene.nodes, *target_nodes(poses[shown], scene.size)),
        shown=scene.shown | {"path"},
        choices=choices,
    )
