"""Pose as a rotation vector, quaternion or roll, pitch and yaw, and the analytic Jacobian."""

from __future__ import annotations

from typing import Any

from ...groups.arrays import Array
from ..chain_data import ChainData
from ..kinematics import analytic, pose_jacobian
from ..kinematics.analytic import RotationKind


class ChainCoordinates(ChainData):
    """Methods that write the pose of a chain as numbers of the rotation and the position."""

    __slots__ = ()

    def pose_coordinates(self, q: Any, kind: RotationKind) -> Array:
        """Pose f(q) as numbers: the rotation's, then the position x, y, z of the tool's origin.

        - "rotation_vector": w = log R, 0 <= |w| <= π, rad; as `so3.log`
        - "quaternion_wxyz": (w, x, y, z) of unit length, of the two that mean R the one with w >= 0
          (w = cos(|log R|/2)); at w = 0, half a turn, the largest of x, y, z is positive. So it
          jumps to its negative where |log R| passes π
        - "rpy": (roll, pitch, yaw) in rad, R = Rz(yaw) Ry(pitch) Rx(roll) as URDF has it, |pitch|
          <= π/2

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m, as `fk`.
        kind : {"rotation_vector", "quaternion_wxyz", "rpy"}
            Numbers of the rotation.

        Returns
        -------
        x : (..., 6) or (..., 7) ndarray
            Coordinates in the base frame, the position in m.

        Raises
        ------
        ShapeError
            If q has another number of coordinates.
        UnknownName
            If a name is no coordinate.
        InputError
            If the kind is none of the three, or values cannot be used.

        Notes
        -----
        Accuracy: that of `fk` in R; roll and yaw apart from each other lose 1/cos(pitch). Source:
        Park 1994, Lemma 3; the URDF specification for rpy.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> turn = pk.Chain.from_space([[0, 0, 1, 0, 0, 0]], np.eye(4))
        >>> print(turn.pose_coordinates([0.3], "rpy").round(6) + 0.0)
        [0.  0.  0.3 0.  0.  0. ]
        """
        return analytic.rotation_numbers(kind).pose_coordinates(pose_jacobian.fk(self, q))

    def analytic_jacobian(self, q: Any, kind: RotationKind) -> Array:
        """Derivative of `pose_coordinates(q, kind)`: rows of the rotation's numbers, then of p.

        - "rotation_vector": dw/dt = J_l(w)^-1 ω, regular up to and at |w| = π (there it is that of
          the branch that w is on: w itself jumps)
        - "quaternion_wxyz": dQ/dt = (-ω · v; w ω + ω × v) / 2 with Q = (w; v), of the sign that
          `pose_coordinates` gives; regular everywhere, and Q · dQ = 0
        - "rpy": singular at pitch = ±90°, where roll and yaw turn about one axis and cannot give
          every ω

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m, as `fk`.
        kind : {"rotation_vector", "quaternion_wxyz", "rpy"}
            Numbers of the rotation.

        Returns
        -------
        J : (..., 6, m) or (..., 7, m) ndarray
            Jacobians: per unit of dq, rad/s (1/s of a quaternion) and m/s, in the base frame.

        Raises
        ------
        InputError
            If the kind is none of the three, or "rpy" has cos(pitch) < 1e-8, with the configuration
            and its pitch.
        ShapeError
            If q has another number of coordinates.
        UnknownName
            If a name is no coordinate.

        Notes
        -----
        Accuracy: that of `jacobian`, times 1/cos(pitch) squared with "rpy"
        (tests/model/kinematics/test_analytic.py). Source: Park 1994, Lemma 4 for the rotation
        vector; the kinematic equation of unit quaternions; R of rpy differentiated.
        """
        numbers = analytic.rotation_numbers(kind)
        return numbers.jacobian(*pose_jacobian.fk_jacobian(self, q, "hybrid"))
