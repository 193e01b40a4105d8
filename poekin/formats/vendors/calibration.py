"""Factory calibration of an arm: poses of the joints in the links before them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...by_value import ByValue
from ...errors import InputError, ShapeError, safe_repr
from ...groups.arrays import Array, numbers
from ...groups.vectors import norms
from ...model.chain import Chain
from ...model.checks import one_pose, read_only
from ...model.joint import Joint
from ...model.robot import Robot
from .naming import UR, Naming


@dataclass(frozen=True, eq=False)
class FactoryCalibration(ByValue):
    """Factory calibration of an arm: f(q) = P_1 R_1(q_1) ... P_n R_n(q_n) F, R_i about axis i.

    f is the pose of the flange in the vendor's base frame, by the names of the vendor's robot
    description. For Universal Robots these are ur_description's tool0, the pendant's tool frame
    without a tool, and `base` or base_link_inertia, against which its base_link is turned by π
    about z; for UFACTORY link_eef and link_base; for Flexiv flange and base_link. Frozen; equal
    where all of it is.

    Parameters
    ----------
    poses : (n, 4, 4) array_like
        Pose P_i of each link in the link before it at q = 0, m.
    hash : str, default ""
        Text by which the driver knows the arm again: Universal Robots' hash, or Flexiv's serial
        number.
    naming : Naming, optional
        The vendor, and its names of links and joints; by default those of Universal Robots. The
        module `vendors.naming` makes others, as ufactory(6) or flexiv(7).
    axes : (n, 3) array_like, optional
        Axis of each joint in its link, by default z.
    flange : (4, 4) array_like, optional
        Pose F of the flange in the last link, by default that link's own.

    Raises
    ------
    ShapeError
        If `poses` or `axes` has another shape.
    PoseError
        If a pose is none.
    InputError
        If `hash` is no text, or an axis is no unit vector.

    Notes
    -----
    Source: Universal Robots ROS 2 driver, package ur_calibration, and ur_description,
    urdf/ur_macro.xacro; UFACTORY xarm_description, urdf/xarm6/xarm6.urdf.xacro; Flexiv
    flexiv_description, urdf/common/flexiv_common.xacro.

    Examples
    --------
    >>> import poekin as pk
    >>> table = pk.dh.published("ur10e")
    >>> calibration = pk.ur.from_dh(table, nominal=table)
    >>> calibration.poses.shape
    (6, 4, 4)
    >>> calibration.vendor
    'Universal Robots'
    """

    poses: Array
    hash: str = ""
    naming: Naming = UR
    axes: Array = None  # type: ignore[assignment]  # the default is made below
    flange: Array = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        poses = numbers(self.poses, "poses")
        links = self.naming.entries
        if poses.shape != (len(links), 4, 4):
            raise ShapeError(
                f"poses: expected shape ({len(links)}, 4, 4), one pose a link, got {poses.shape}"
            )
        exact = [one_pose(T, f"pose of {link}") for T, link in zip(poses, links, strict=True)]
        if not isinstance(self.hash, str):
            raise InputError(f"hash: expected a text, got {safe_repr(self.hash)}")
        object.__setattr__(self, "poses", read_only(np.array(exact)))
        object.__setattr__(self, "axes", read_only(_unit(self.axes, len(links))))
        flange = self.flange
        if flange is None:
            flange = np.eye(4)
        object.__setattr__(self, "flange", read_only(one_pose(flange, "flange")))

    @property
    def vendor(self) -> str:
        """Name of the vendor."""
        return self.naming.vendor

    def to_robot(self, name: str | None = None) -> Robot:
        """Robot of this calibration, its link frames those of the calibration.

        Parameters
        ----------
        name : str, optional
            Name of the robot: by default "ur", "ufactory" or "flexiv".

        Returns
        -------
        robot : Robot
            Links and joints with the names of the vendor's description, as base, shoulder_link,
            ..., wrist_3_link, and tool0, fixed to the last. A calibration has no limits:
            `pk.calibration.apply` puts it on a robot that has them.

        Raises
        ------
        InputError
            If `name` is no name.
        """
        naming = self.naming
        links = [naming.bases[0], *naming.links]
        joints = [
            Joint(
                joint,
                "revolute",
                parent,
                child,
                T,
                tuple(axis),
            )
            for joint, parent, child, T, axis in zip(
                naming.joints,
                links[:-1],
                links[1:],
                self.poses,
                self.axes.tolist(),
                strict=True,
            )
        ]
        if naming.tip is not None:
            joints.append(Joint(naming.tip_joint, "fixed", links[-1], naming.tip, self.flange))
            links.append(naming.tip)
        if name is None:
            name = _NAMES[naming.vendor]
        return Robot(name, links, joints)

    def to_chain(self) -> Chain:
        """Chain from the vendor's base to the flange.

        Returns
        -------
        chain : Chain
            Chain of the joints, without limits.

        Notes
        -----
        Accuracy: rounding of the product of the poses, 1e-15 reach.
        """
        return self.to_robot().chain()


_NAMES = {"Universal Robots": "ur", "UFACTORY": "ufactory", "Flexiv": "flexiv"}
_UNIT = 1e-9
"""Distance of an axis' length from 1 that is rounding."""


def _unit(axes: ArrayLike | None, n: int) -> Array:
    """Axes (n, 3), z where none are given."""
    if axes is None:
        return np.tile([0.0, 0.0, 1.0], (n, 1))
    found = numbers(axes, "axes").copy()
    if found.shape != (n, 3):
        raise ShapeError(f"axes: expected shape ({n}, 3), one axis a joint, got {found.shape}")
    off = np.abs(norms(found) - 1.0)
    for i in np.flatnonzero(~(off <= _UNIT)):
        raise InputError(f"axes[{i}]: expected a unit vector, got {found[i].tolist()}")
    return found
