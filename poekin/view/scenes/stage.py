"""Stage of a result: the scene of its arm, by itself or as part of its robot, and where the result's
own nodes are attached.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...errors import InputError, quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.robot import Robot
from ..nodes import Attachment, Layer, Node, Role
from ..scene import Scene
from .arm import arm_scene
from .arm_parts.geometry import beyond, opening_q, widened
from .arm_parts.of_robot import robot_geometry


class Stage(NamedTuple):
    """Scene of an arm for a result in coordinates of a chain.

    Parameters
    ----------
    scene : Scene
        The arm at the configuration with which the page opens.
    base : int
        Number of the link that is the chain's base.
    sliders : tuple of int
        Number of the slider of each coordinate of the chain.
    """

    scene: Scene
    base: int
    sliders: tuple[int, ...]

    @property
    def size(self) -> float:
        """Size of the scene, m."""
        return self.scene.size

    def configurations(self, q: Array) -> Array:
        """Configurations (..., m) of the chain as those of all sliders, the others as they open."""
        every = np.tile(self.scene.q, (*q.shape[:-1], 1))
        every[..., list(self.sliders)] = q
        return every

    def attachment(
        self,
        layer: Layer,
        role: Role,
        name: str,
        *,
        choice: int | None = None,
        opacity: float = 1.0,
    ) -> Attachment:
        """Place of a node whose points are in the frame of the chain's base."""
        return Attachment(layer, role, self.base, name=name, choice=choice, opacity=opacity)

    def with_result(
        self,
        title: str,
        words: Iterable[str],
        nodes: Iterable[Node],
        *layers: Layer,
        rows: Array | None = None,
    ) -> Scene:
        """The scene with a title, words before its own, nodes, layers that are shown, and sliders
        that reach the rows (N, sliders) that a reader can have shown, rad or m.
        """
        arm = self.scene.arms[0]
        reached = widened(arm.coordinates, self.scene.q[None] if rows is None else rows)
        said = [*words, *self.scene.words]
        names = beyond(arm.coordinates, reached)
        if names:
            said.append(f"What is shown goes beyond the limits of {names}.")
        return replace(
            self.scene,
            title=title,
            words=tuple(said),
            arms=(replace(arm, coordinates=reached),),
            nodes=(*self.scene.nodes, *nodes),
            shown=self.scene.shown | {*layers},
        )


def make_stage(chain: Chain, q: Array | None, robot: Robot | None) -> Stage:
    """Stage of a chain at q, or of the robot that it is a part of.

    Raises: InputError where the robot has no such link or coordinate.
    """
    if robot is None:
        scene = arm_scene(chain, q=q)
        return Stage(scene, 0, tuple(range(chain.dof)))
    missing = [name for name in chain.q_names if name not in robot.q_names]
    if missing or not {chain.base, chain.tip} <= set(robot.links):
        raise InputError(
            f"robot: expected the robot of the chain from {quote(chain.base)} to {quote(chain.tip)}, got "
            f"{quote(robot.name)} without these links, or without their coordinates"
        )
    scene = arm_scene(robot, q=whole_q(robot, chain, q), tip=chain.tip)
    return Stage(scene, robot.links.index(chain.base), _sliders(robot, chain))


def whole_q(robot: Robot, chain: Chain, q: Array | None) -> Array:
    """Coordinates of a robot: those of its chain as given, the others as a page opens."""
    values = opening_q(robot_geometry(robot, ()).sliders)
    if q is not None:
        values[list(_sliders(robot, chain))] = q
    return values


def _sliders(robot: Robot, chain: Chain) -> tuple[int, ...]:
    """Numbers of a chain's coordinates among its robot's."""
    return tuple(map(robot.q_names.index, chain.q_names))


def evenly(count: int, most: int) -> np.ndarray:
    """Indices of at most so many of `count` things, the first and the last among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
