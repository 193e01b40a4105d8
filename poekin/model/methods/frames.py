"""One arm with another base frame, tool frame or zero position, or in exact geometry."""

from __future__ import annotations

from typing import Any, Self

from numpy.typing import ArrayLike

from ..chain_data import ChainData
from ..geometry import hp, idealise, other_frames
from ..geometry.hp import HPForm
from ..geometry.idealise import Idealised
from ..readings import coupled
from ..readings.statements import Statements


class ChainFrames(ChainData):
    """Methods that make another chain of a chain, and the form of the closed solvers."""

    __slots__ = ()

    def rebased(self, P: ArrayLike, base: str | None = None) -> Self:
        """Chain of the same arm in another base frame: f' = P f, A' = Ad(P) A, M' = P M.

        Parameters
        ----------
        P : (4, 4) array_like
            Pose of the old base frame in the new one, m.
        base : str, optional
            Name of the new base frame; the old name where it is left out.

        Returns
        -------
        chain : Chain
            Chain whose base is the new frame.

        Raises
        ------
        PoseError
            If P is no pose.
        ShapeError
            If P has another shape.

        Notes
        -----
        Accuracy: screws within 10 u (reach + |p|) of Ad(P) A of unit length, u = 2^-53, p the
        translation of P, whose rotation is one to rounding (tests/model/test_chain.py). Source:
        Park 1994, Section II, f' = P f Q.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> arm = pk.load("ur5e").chain()
        >>> table = arm.rebased(pk.se3.pose(np.eye(3), [0, 0, 0.8]), base="table")
        >>> print((table.home - arm.home)[:3, 3].round(6) + 0.0)
        [0.  0.  0.8]
        """
        return other_frames.rebased(self, P, base)

    def retooled(self, Q: ArrayLike, tip: str | None = None) -> Self:
        """Chain of the same arm with another tool frame: f' = f Q, A' = A, M' = M Q.

        The screws in the tool frame become B' = Ad(Q)^-1 B.

        Parameters
        ----------
        Q : (4, 4) array_like
            Pose of the new tool frame in the old one, m.
        tip : str, optional
            Name of the new tool frame; the old name where it is left out.

        Returns
        -------
        chain : Chain
            Chain whose tip is the new frame.

        Raises
        ------
        PoseError
            If Q is no pose.
        ShapeError
            If Q has another shape.

        Notes
        -----
        Accuracy: screws as they are, M Q to its rounding. Source: Park 1994, Section II,
        f' = P f Q.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> arm = pk.load("ur5e").chain()
        >>> gripper = arm.retooled(pk.se3.pose(np.eye(3), [0, 0, 0.15]), tip="gripper")
        >>> print((arm.home[:3, :3].T @ (gripper.home - arm.home)[:3, 3]).round(6) + 0.0)
        [0.   0.   0.15]
        """
        return other_frames.retooled(self, Q, tip)

    def rezeroed(self, q0: Any) -> Self:
        """Chain of the same arm whose zero position is at q0: f'(q) = f(q + q0).

        A_i' = Ad(e^{A_1 d_1} ... e^{A_{i-1} d_{i-1}}) A_i and M' = e^{A_1 d_1} ... e^{A_n d_n} M
        with d = C q0; limits move by -q0.

        Parameters
        ----------
        q0 : (m,) array_like or dict
            Configuration that becomes zero, rad or m.

        Returns
        -------
        chain : Chain
            Chain with the new zero position, in the same base and tool frame.

        Raises
        ------
        ShapeError
            If q0 has another number of coordinates.
        UnknownName
            If a dict has a name that is no coordinate.
        InputError
            If a number is not finite, or a dict lacks a coordinate.

        Notes
        -----
        Accuracy: screws and M within u (10 (n + 1) + 4 sum |d|) of the reach and what d slides,
        u = 2^-53, the sum over joints that turn (tests/model/test_chain.py). Source: Park 1994,
        Section II.
        """
        return other_frames.rezeroed(self, q0)

    def coupled(self, coupling: Statements) -> Self:
        """Chain whose coordinates are readings that several joints follow: f'(r) = f(K r).

        On arms with a parallel linkage, and on all of Fanuc's, the controller displays the angle of
        joint 3 against the ground: q3 = J2 + J3. A statement gives the value of a joint as a sum of
        readings of the same names; a joint without one has its own reading. C' = C K.

        Parameters
        ----------
        coupling : str or sequence of str
            Statements such as "J3 = J2 + J3" or "J6 = J6 - 1/80 J5": names, with numbers or
            fractions before them, + and -.

        Returns
        -------
        chain : Chain
            Chain of the same arm with coordinates of the same names. `fk`, Jacobians, `pk.ik` and
            `pk.calibrate` take or give readings. `limits` and `velocity_limits` are what the joints'
            own leave to the readings one by one; the joints' own are `joint_limits` and
            `joint_velocity_limits`, which `random`, `pk.ik`, `pk.ik_all`, `pk.follow` and
            `pk.motion.time_optimal` keep to, too.

        Raises
        ------
        InputError
            For what is no such statement, a name that is unknown or said twice, or readings that do
            not determine the joints.

        Notes
        -----
        Accuracy: C K to its rounding (tests/model/readings/test_coupled.py). Source: none, the
        chain rule.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> arm = pk.load("puma560").chain()
        >>> fanuc = arm.coupled("joint3 = joint2 + joint3")
        >>> readings = np.array([0.0, 0.5, -0.2, 0.0, 0.0, 0.0])
        >>> joints = np.array([0.0, 0.5, 0.3, 0.0, 0.0, 0.0])
        >>> bool(np.allclose(fanuc.fk(readings), arm.fk(joints)))
        True
        """
        return coupled.coupled(self, coupling)

    def idealised(self, tol: float) -> Idealised[Self]:
        """Chain with its geometry made exact where it is so within a tolerance.

        Angles between consecutive axes, and between consecutive common normals, become multiples of
        15 degrees, and the lengths between them 0. Base and tool are the first and last axis (z
        axis and x direction): so a tool's rotation is Rz Rx Rz, each angle of which is judged by
        itself. No other function does this unasked.

        Parameters
        ----------
        tol : float
            Tolerance from 0 (nothing changes) to 0.05: radians for angles and metres for lengths.

        Returns
        -------
        result : Idealised
            Exact chain, its difference from the given one and the changes in words. Kinds, pitches,
            names, limits and coupling stay.

        Raises
        ------
        InputError
            If tol is no number from 0 to 0.05.

        Notes
        -----
        Accuracy: the exact geometry to the last digit of the screws. The bounds hold at every value
        of revolute joints; a joint that slides counts as far as it can within its limits, by as
        much as `random` draws where it has none. They are at most 20 times the worst error of the
        package's arms (tests/model/test_idealised.py). Source: none, the lines' geometry; the error
        of a product of poses is at most the sum of its factors'.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> tilted = pk.screw.revolute([0, 1e-6, 1], [0, 0, 0])
        >>> result = pk.Chain.from_space([tilted], np.eye(4)).idealised(1e-5)
        >>> print(result.chain.screws)
        [[0. 0. 1. 0. 0. 0.]]
        """
        return idealise.idealised(self, tol)

    def to_hp(self) -> HPForm:
        """Directions H and steps P between axes: the form of the closed solvers, in q itself.

        EAIK's `HPRobot(H, P)` takes H and P as they are, and so do IK-Geo and ssik as rows; the
        pose that they solve for has the rotation R_st R_nt^T. Base and tool are part of P, zero
        offsets of all three. The points are chosen so that steps that can be zero are zero to the
        last bit: axes that meet share their point (three in a row and more before two, towards the
        tip before towards the base), and an axis that meets none has its point nearest to the one
        before. A step between parallel axes is so perpendicular to them.

        Returns
        -------
        form : HPForm
            H (n, 3), P (n + 1, 3) in m and the tip's rotation R_nt (3, 3), in the order of
            `q_names`.

        Raises
        ------
        InputError
            If a joint is not revolute, or joints are coupled.

        Notes
        -----
        Accuracy: a point is within 1e-14 reach of its axis, so the pose within 4e-14 n reach of
        `fk` (tests/model/geometry/test_hp.py). Source: Elias and Wen, IK-Geo (arXiv 2211.05737),
        Section II, for the form; the points are poekin's choice.

        Examples
        --------
        >>> import poekin as pk
        >>> H, P, R_nt = pk.load("ur5e").chain().to_hp()
        >>> H.shape, P.shape, R_nt.shape
        ((6, 3), (7, 3), (3, 3))
        """
        return hp.to_hp(self)
