"""Factory calibration of an arm of Universal Robots: poses of the joints in the links before them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import InputError, ShapeError, safe_repr
from ...groups.arrays import Array, numbers
from ...model.chain import Chain
from ...model.checks import one_pose, read_only
from ...model.joint import Joint
from ...model.robot import Robot
from ..relink import relinked

LINKS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
"""The links of a calibration, from the base on, as the files call them."""
JOINTS = (
    *("shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint"),
    *("wrist_1_joint", "wrist_2_joint", "wrist_3_joint"),
)
"""The joints that move them, as the driver calls them."""


@dataclass(frozen=True, eq=False)
class FactoryCalibration:
    """Factory calibration of an arm: six poses, f(q) = poses_1 Rz(q_1) ... poses_6 Rz(q_6).

    f is the pose of the flange (ur_description's tool0, the pendant's tool frame without a tool) in
    the controller's base frame (ur_description's `base` and base_link_inertia; its base_link is
    turned against it by π about z). Frozen; equal where poses and hash are.

    Parameters
    ----------
    poses : (6, 4, 4) array_like
        Pose of each of `LINKS` in the link before it at q = 0, m; joint i turns about its z axis.
    hash : str, default ""
        Text by which the driver knows the arm again.

    Raises
    ------
    ShapeError
        If `poses` has another shape.
    PoseError
        If one of them is no pose.
    InputError
        If `hash` is no text.

    Notes
    -----
    Source: Universal Robots ROS 2 driver, package ur_calibration, and ur_description,
    urdf/ur_macro.xacro.

    Examples
    --------
    >>> import poekin as pk
    >>> table = pk.dh.published("ur10e")
    >>> calibration = pk.ur.from_dh(table, nominal=table)
    >>> calibration.poses.shape
    (6, 4, 4)
    """

    poses: Array
    hash: str = ""

    def __post_init__(self) -> None:
        poses = numbers(self.poses, "poses")
        if poses.shape != (len(LINKS), 4, 4):
            raise ShapeError(
                f"poses: expected shape ({len(LINKS)}, 4, 4), one pose a link, got {poses.shape}"
            )
        exact = [one_pose(T, f"pose of {link}") for T, link in zip(poses, LINKS, strict=True)]
        if not isinstance(self.hash, str):
            raise InputError(f"hash: expected a text, got {safe_repr(self.hash)}")
        object.__setattr__(self, "poses", read_only(np.array(exact)))

    def to_robot(self, name: str = "ur") -> Robot:
        """Robot of this calibration, its link frames those of the calibration.

        Parameters
        ----------
        name : str, default "ur"
            Name of the robot.

        Returns
        -------
        robot : Robot
            Links base, shoulder_link, ..., wrist_3_link and tool0, which is wrist_3_link again, and
            joints `JOINTS`: the names of ur_description. A calibration has no limits: see `apply`.

        Raises
        ------
        InputError
            If `name` is no name.
        """
        links = ["base", *(f"{link}_link" for link in LINKS), "tool0"]
        joints = [
            Joint(
                joint,
                "revolute",
                parent,
                child,
                T,
                (0.0, 0.0, 1.0),
            )
            for joint, parent, child, T in zip(JOINTS, links, links[1:-1], self.poses, strict=False)
        ]
        return Robot(name, links, [*joints, Joint("tool0_joint", "fixed", links[-2], links[-1])])

    def to_chain(self) -> Chain:
        """Chain from base to tool0.

        Returns
        -------
        chain : Chain
            Chain of the six joints, without limits.

        Notes
        -----
        Accuracy: rounding of the product of six poses, 1e-15 reach.
        """
        return self.to_robot().chain()

    def _data(self) -> tuple[Any, ...]:
        return self.poses.tobytes(), self.hash

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, FactoryCalibration):
            return NotImplemented
        return self._data() == other._data()

    def __hash__(self) -> int:
        return hash(self._data())

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.poses, self.hash)


def apply(
    robot: Robot,
    calibration: FactoryCalibration,
    *,
    base: str | None = None,
    tip: str | None = None,
) -> Robot:
    """Nominal robot with the kinematics of a calibration and, nearly, its own link frames.

    As `poekin.relinked` does: names, limits, mimic and all that hangs off the arm are the robot's.

    Parameters
    ----------
    robot : Robot
        Robot with six revolute joints in the order of `JOINTS`.
    calibration : FactoryCalibration
        Calibration of the arm.
    base : str, optional
        Link that stands for the controller's base frame: by default the one called "base", else
        "base_link_inertia", else the root.
    tip : str, optional
        Link that stands for the flange: by default "tool0", else the only leaf.

    Returns
    -------
    robot : Robot
        The robot, calibrated.

    Raises
    ------
    InputError
        If `calibration` is no FactoryCalibration, or the robot's joints are not those six, as
        `poekin.relinked` says.
    UnknownName
        If there is no link of that name.
    ModelError
        If base or tip must be named.

    Notes
    -----
    Accuracy: as `poekin.relinked`.

    Examples
    --------
    >>> import poekin as pk
    >>> nominal = pk.dh.published("ur5e")
    >>> measured = pk.ur.add_deltas(nominal, delta_a=[0, 1e-3, 0, 0, 0, 0])
    >>> calibration = pk.ur.from_dh(measured, nominal=nominal)
    >>> robot = pk.ur.apply(pk.load("ur5e"), calibration)
    >>> q = [0.0] * 6
    >>> change = robot.chain().fk(q)[:3, 3] - pk.load("ur5e").chain().fk(q)[:3, 3]
    >>> float(abs(change).max().round(9))
    0.001
    """
    if not isinstance(calibration, FactoryCalibration):
        raise InputError(f"apply: expected a FactoryCalibration, got {type(calibration).__name__}")
    if isinstance(robot, Robot):
        base = base or _first_link(robot, "base", "base_link_inertia")
        tip = tip or _first_link(robot, "tool0")
    return relinked(robot, calibration.to_chain(), base=base, tip=tip)


def _first_link(robot: Robot, *names: str) -> str | None:
    """First of these names that a link of the robot has."""
    return next((name for name in names if name in robot.links), None)
