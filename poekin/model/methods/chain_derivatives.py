"""Velocities, accelerations, and derivatives of pose and Jacobian with respect to q and the model."""

from __future__ import annotations

from typing import Any

from ...checks import REQUIRED
from ...groups.arrays import Array
from ..chain_data import ChainData
from ..kinematics import derivatives, pose_jacobian
from ..kinematics.derivatives import JacobianChanges, Parameters, PoseChanges
from ..kinematics.pose_jacobian import Frame


class ChainDerivatives(ChainData):
    """Methods that differentiate pose and Jacobian of a chain."""

    __slots__ = ()

    def velocity(
        self,
        q: Any,
        dq: Any,
        frame: Frame | int = REQUIRED,
    ) -> Array:
        """Twist V = J(q) dq of the tool by the paper's recursion, without forming J.

        Parameters
        ----------
        q, dq : (..., m) array_like or dict
            Configurations, rad or m, and rates, rad/s or m/s; broadcast against each other.
        frame : {"space", "body", "hybrid"} or int
            Frame of the twist, as in `jacobian`; there is no default.

        Returns
        -------
        V : (..., 6) ndarray
            Twists (ω; v), rad/s and m/s.

        Raises
        ------
        ShapeError
            If q or dq has another number of coordinates, or they do not broadcast.
        UnknownName
            If a name is no coordinate.
        InputError
            If the frame is none or left out, or values cannot be used.

        Notes
        -----
        Accuracy: that of `fk` times (n + 1) |C dq|, n the joints (tests/model/test_chain_laws.py).
        Source: Park 1994, Section IV; the recursion yields the body velocity, the other frames are
        reached from it.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.Chain.from_space([[0, 0, 1, 0, 0, 0]], pk.se3.exp([0, 0, 0, 0.5, 0, 0]))
        >>> print(arm.velocity([0.0], [2.0], frame="hybrid"))
        [0. 0. 2. 0. 1. 0.]
        """
        return pose_jacobian.velocity(self, q, dq, frame)

    def joint_velocities(self, q: Any, dq: Any, frame: Frame = REQUIRED) -> Array:
        """Twists of the joints' z-aligned frames of `joint_poses`, relative to the base.

        Parameters
        ----------
        q, dq : (..., m) array_like or dict
            Configurations, rad or m, and rates, rad/s or m/s; broadcast against each other.
        frame : {"space", "body", "hybrid"}
            "space": f_k' f_k^-1; "body": f_k^-1 f_k' (each frame's own axes, velocity of its
            origin); "hybrid": base axes, velocity of each frame's origin. There is no default.

        Returns
        -------
        V : (..., n, 6) ndarray
            Twists (ω; v), rad/s and m/s. The tool stands still in the last frame and has no row.

        Raises
        ------
        ShapeError
            If q or dq has another number of coordinates, or they do not broadcast.
        UnknownName
            If a name is no coordinate.
        InputError
            If the frame is none of the three or left out, or values cannot be used.

        Notes
        -----
        Accuracy: that of `velocity` (tests/model/kinematics/test_derivatives.py). Source: Park
        1994, Section IV, the V recursion, summed in the base frame.
        """
        return derivatives.joint_velocities(self, q, dq, frame)

    def jacobian_rate(self, q: Any, dq: Any, frame: Frame = REQUIRED) -> Array:
        """Rate dJ/dt of the Jacobian along the rates dq: dV/dt = J ddq + (dJ/dt) dq.

        Column k is the sum over j of dJ_k/dq_j dq_j. The Jacobian is differentiated as it stands:
        in "body" and "space" its entries in moving and in fixed axes, in "hybrid" with the moving
        reference point. Pinocchio calls this the time variation in LOCAL, WORLD and
        LOCAL_WORLD_ALIGNED.

        Parameters
        ----------
        q, dq : (..., m) array_like or dict
            Configurations, rad or m, and rates, rad/s or m/s; broadcast against each other.
        frame : {"space", "body", "hybrid"}
            Frame of the Jacobian, as in `jacobian`; there is no default.

        Returns
        -------
        dJ : (..., 6, m) ndarray
            Rates, rows (ω; v).

        Raises
        ------
        ShapeError
            If q or dq has another number of coordinates, or they do not broadcast.
        UnknownName
            If a name is no coordinate.
        InputError
            If the frame is none of the three or left out, or values cannot be used.

        Notes
        -----
        Accuracy: within 1e-13 reach for |dq_k| <= 1 on real robots
        (tests/model/kinematics/test_derivatives_pinocchio.py), in general within 4 n u (8 (n + 1) +
        4 sum |x|) reach sum |dx|, u = 2^-53 (tests/model/kinematics/test_derivatives.py). Source:
        Park 1994, Section III, J differentiated; each column's rate is one bracket.
        """
        return derivatives.jacobian_rate(self, q, dq, frame)

    def hessian(self, q: Any, frame: Frame = REQUIRED) -> Array:
        """Kinematic Hessian H = dJ/dq: H[..., r, i, j] = d J[..., r, i] / d q_j.

        dJ/dt = H dq over the last axis. In "hybrid" the linear rows are the second derivatives of
        the tool's origin and symmetric in i and j; no other rows are.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m.
        frame : {"space", "body", "hybrid"}
            Frame of the Jacobian, as in `jacobian`; there is no default.

        Returns
        -------
        H : (..., 6, m, m) ndarray
            Hessians, rows (ω; v).

        Raises
        ------
        ShapeError
            If q has another number of coordinates.
        UnknownName
            If a name is no coordinate.
        InputError
            If the frame is none of the three or left out, or values cannot be used.

        Notes
        -----
        Accuracy: that of `jacobian_rate` with one rate of 1. Source: Park 1994, Section III, J
        differentiated: ds_i/dx_j = [s_j, s_i] for j < i, else 0.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5e").chain()
        >>> arm.hessian(arm.random(0), "hybrid").shape
        (6, 6, 6)
        """
        return derivatives.hessian(self, q, frame)

    def acceleration(
        self,
        q: Any,
        dq: Any,
        ddq: Any,
        frame: Frame = REQUIRED,
    ) -> Array:
        """Rate dV/dt = J ddq + (dJ/dt) dq of the tool's twist `velocity(q, dq, frame)`.

        - "hybrid": (alpha; p''), base axes: angular acceleration, and the acceleration of the
          tool's origin as an accelerometer without gravity measures it (the classical one;
          Pinocchio's getFrameClassicalAcceleration in LOCAL_WORLD_ALIGNED, not its
          getFrameAcceleration there, which is less by ω × p')
        - "body": d/dt (f^-1 f'), the spatial acceleration in tool axes; its linear part is R^T p''
          - ω_b × v_b (Pinocchio's getFrameAcceleration in LOCAL)
        - "space": d/dt (f' f^-1), the spatial acceleration in base axes about the base origin (the
          same in WORLD)

        Parameters
        ----------
        q, dq, ddq : (..., m) array_like or dict
            Configurations, rad or m, rates and accelerations; broadcast against each other.
        frame : {"space", "body", "hybrid"}
            Frame of the twist; there is no default.

        Returns
        -------
        A : (..., 6) ndarray
            Accelerations, rad/s^2 and m/s^2.

        Raises
        ------
        ShapeError
            If an array has another number of coordinates, or they do not broadcast.
        UnknownName
            If a name is no coordinate.
        InputError
            If the frame is none of the three or left out, or values cannot be used.

        Notes
        -----
        Accuracy: as `jacobian` for ddq and `jacobian_rate` for dq dq. Source: Park 1994, Section
        IV, V differentiated.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.Chain.from_space([[0, 0, 1, 0, 0, 0]], pk.se3.exp([0, 0, 0, 0.5, 0, 0]))
        >>> print(arm.acceleration([0.0], [2.0], [0.0], frame="hybrid") + 0.0)
        [ 0.  0.  0. -2.  0.  0.]
        """
        return derivatives.acceleration(self, q, dq, ddq, frame)

    def screw_derivatives(self, q: Any, wrt: Parameters = "twist") -> PoseChanges:
        """Derivative of the pose with respect to each screw and the home pose: df f^-1.

        - "twist": A_i <- Ad(e^eta_i) A_i, M <- M e^eta, which moves an axis and leaves it a unit
          screw of its own pitch: df f^-1 = sum (Ad(P_{i-1}) - Ad(P_i)) eta_i + Ad(f) eta, P_i =
          e^{A_1 x_1} ... e^{A_i x_i}. Of the six directions of eta_i two leave a revolute or
          helical joint as it is, A_i itself and the shift along its axis, and four a prismatic one,
          all shifts and the turn about its axis
        - "components": with respect to the six numbers of A_i as they stand, off the unit screws
          too: df f^-1 = sum Ad(P_{i-1}) J_l(A_i x_i) x_i dA_i + Ad(f) eta, J_l the left Jacobian of
          exp. A pitch h moves A_i by (0; ω_i) dh; the Jacobian in q answers for offsets and gains

        The body twist f^-1 df is Ad(f)^-1 times all this.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m.
        wrt : {"twist", "components"}, default "twist"
            Parameters of the screws that the derivative is with respect to.

        Returns
        -------
        changes : PoseChanges
            Derivatives (..., 6, n, 6) and (..., 6, 6): rows ω (rad) and v (m) in the base frame,
            per unit of eta or A, rad and m.

        Raises
        ------
        ShapeError
            If q has another number of coordinates.
        UnknownName
            If a name is no coordinate.
        InputError
            If wrt is neither of the two, or values cannot be used.

        Notes
        -----
        Accuracy: within 1e-12 of finite differences in 50 digits for arms up to 10 m; in general 8
        u (8 (n + 1) + 4 sum |x|) and lengths times the reach
        (tests/model/kinematics/test_derivatives.py). Source: Park 1994, Section II, with e^{Ad(g) A
        x} = g e^{A x} g^-1; Lemma 5 for the components.
        """
        return derivatives.screw_derivatives(self, q, wrt)

    def jacobian_screw_derivatives(self, q: Any, frame: Frame = REQUIRED) -> JacobianChanges:
        """Derivative of `jacobian(q, frame)` under A_i <- Ad(e^eta_i) A_i and M <- M e^eta.

        A space column s_k moves by [d_i eta_i, s_k] for i < k with d_i the pose's derivative
        (`screw_derivatives`), by [Ad(P_{k-1}) eta_k, s_k] for i = k, and not for i > k nor with the
        home pose; the other frames follow the pose too.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m.
        frame : {"space", "body", "hybrid"}
            Frame of the Jacobian, as in `jacobian`; there is no default.

        Returns
        -------
        changes : JacobianChanges
            Derivatives (..., 6, m, n, 6) and (..., 6, m, 6), rows (ω; v), per unit of eta, rad
            and m.

        Raises
        ------
        ShapeError
            If q has another number of coordinates.
        UnknownName
            If a name is no coordinate.
        InputError
            If the frame is none of the three or left out, or values cannot be used.

        Notes
        -----
        Accuracy: 16 n u (8 (n + 1) + 4 sum |x|), lengths times the reach squared, u = 2^-53
        (tests/model/kinematics/test_derivatives.py). Source: Park 1994, Sections II and III.
        """
        return derivatives.jacobian_screw_derivatives(self, q, frame)
