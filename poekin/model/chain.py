"""A serial chain: n screws and one home pose, from a base frame to a tip.

The face of `ChainData`: each method is one call of a function of the data, in `kinematics` or
`geometry`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..engine.kernels import chain_kernels
from ..groups.arrays import Array
from . import sampling
from .chain_data import ChainData
from .geometry import hp, idealise, other_frames
from .geometry.hp import HPForm
from .geometry.idealise import Idealised
from .kinematics import analytic, derivatives, pose_jacobian
from .kinematics.compiled import CompiledChain
from .kinematics.derivatives import JacobianChanges, PoseChanges
from .kinematics.outputs import checked_out, checked_pair

# Names looked up once: one call for a pose and a Jacobian takes about a microsecond in all.
_ndarray = np.ndarray
_float64 = np.dtype(np.float64)
_empty = np.empty
_POSE_SHAPE = (4, 4)
_FRAME_CODES = pose_jacobian.FRAME_CODES
_pose_one = chain_kernels.pose_one
_pose_jacobian_one = chain_kernels.pose_jacobian_one


class Chain(ChainData):
    """f(q) = e^{A_1 x_1} ... e^{A_n x_n} M with x = C q + c: the pose of the tip in the base frame.

    Parameters
    ----------
    screws (n, 6): A_i = (omega; v) in the base frame at x = 0; |omega| = 1, or omega = 0 and |v| =
    1, to 1e-9.
    home (4, 4): M, the pose of the tip at x = 0, m.
    joint_names, q_names: of the n joints and the m coordinates.
    limits (m, 2): lower and upper bound of each coordinate (rad or m); infinite means unlimited.
    coupling (n, m), offset (n,): C and c; without them every joint is its own coordinate and gives
    it its name.
    base, tip: names of the two frames.
    pitches (n,): m per rad, 0 for a revolute joint and for a prismatic one. Without them the pitch
    is omega . v of the screw, 0 where that is its rounding, below 4e-15 max(1 m, |v|); with them v
    is made exact, so that omega . v is the pitch. `rebased`, `retooled` and `rezeroed` keep them:
    the kind of a joint is not found again.

    Frozen: the arrays are read-only. Equal chains have equal numbers and names; hashable; pickles
    as its data. Revolute, prismatic and helical joints differ only in their screws. A chain without
    joints is legal. Not made to be subclassed.
    Raises: ScrewError, PoseError, ShapeError, InputError. Accuracy: the data are kept to the last
    digit, but for what is made exact (unit length within 1e-9, the rotation of M within 1e-5).
    Source: Park 1994, eqs. (1) and (2).
    """

    __slots__ = ("_compiled",)

    def fk(self, q: Any, *, out: Array | None = None) -> Array:
        """Forward kinematics: T_sb = f(q) = e^{A_1 x_1} ... e^{A_n x_n} M with x = C q + c.

        Parameters: q (..., m) in the order of `q_names`, rad or m, or a dict name -> value; out, a
        C-contiguous float64 array of the result's shape to write into. Returns: T_sb (..., 4, 4),
        the pose of the tip in the base frame, m. NaN in a configuration gives NaN in its pose.
        Raises: ShapeError, UnknownName, InputError.
        Accuracy: for up to 20 joints, a turn and 1 m each, within 2e-14 reach
        (tests/analysis/test_validate.py, against Pinocchio); in general within u (8 (n + 1) + 4 sum
        |x|) (reach + sum |s|), u = 2^-53, s what a prismatic or helical joint slides
        (tests/model/test_chain_laws.py, tests/model/test_pitches.py).
        Source: Park 1994, eq. (1), by the local form of Section IV.
        """
        if type(q) is _ndarray and q.dtype is _float64 and q.shape == self.plain_shape:
            T = _empty(_POSE_SHAPE) if out is None else checked_out(out, _POSE_SHAPE, "out", q)
            _pose_one.call(self.kernel_table, q, T)
            return T
        return pose_jacobian.fk(self, q, out)

    def jacobian(
        self, q: Any, frame: str | int, *, at: ArrayLike | None = None, out: Array | None = None
    ) -> Array:
        """Jacobian J(q) with V = J dq, rows (omega; v), in the frame that is named at every call.

        - "space": V_s = f' f^-1, base axes, velocity of the tool's point that passes the base
          origin
        - "body": V_b = f^-1 f', tool axes, velocity of the tool's origin
        - "hybrid": base axes, velocity of the tool's origin (Pinocchio's LOCAL_WORLD_ALIGNED)
        - k: the twist of the tool in the z-aligned frame of joint k (0 ... n - 1, see
          `joint_poses`), which moves with it

        Parameters: q (..., m) or a dict, as `fk`; frame; at, a point (3,) of the tool in its own
        frame (m), whose velocity is meant instead of its origin's ("body" and "hybrid" only); out,
        an array to write into.
        Returns: J (..., 6, m): rad/s and m/s per unit of dq. Raises: ShapeError, UnknownName,
        InputError.
        Accuracy: as `fk` (tests/analysis/test_validate.py, tests/model/test_chain_laws.py).
        Source: Park 1994, Section III, "The Jacobian".
        """
        if out is None and type(q) is _ndarray and q.ndim == 1:
            return self.fk_jacobian(q, frame, at=at)[1]  # the shorter way in for one configuration
        return pose_jacobian.jacobian(self, q, frame, at, out)

    def fk_jacobian(
        self,
        q: Any,
        frame: str | int,
        *,
        at: ArrayLike | None = None,
        out: tuple[Array, Array] | None = None,
    ) -> tuple[Array, Array]:
        """Pose and Jacobian in one pass: those of `fk` and `jacobian`.

        Parameters: as `jacobian`; out = (T, J), arrays to write into. Returns: T_sb (..., 4, 4), J
        (..., 6, m). Raises, accuracy, source: as `fk` and `jacobian`.
        """
        plain = type(q) is _ndarray and q.dtype is _float64 and q.shape == self.plain_shape
        if plain and at is None and type(frame) is str and frame in _FRAME_CODES:
            if out is None:
                T = _empty(_POSE_SHAPE)
                J = _empty(self.jacobian_shape)
            else:
                T, J = checked_pair(out, _POSE_SHAPE, self.jacobian_shape, q)
            _pose_jacobian_one.call(self.kernel_table, q, _FRAME_CODES[frame], T, J)
            return T, J
        return pose_jacobian.fk_jacobian(self, q, frame, at, out)

    def compile(self, *, parallel: bool = False) -> CompiledChain[Chain]:
        """Machine code made for the numbers of this chain: `fk`, `jacobian`, `fk_jacobian` as here,
        faster.

        Parameters: parallel, whether large batches are shared out among threads. Returns:
        CompiledChain, see there. Raises: InputError. Accuracy: as `fk`. Source: Park 1994, Section
        IV, two planar rotations a link.
        """
        if parallel is not False:
            return CompiledChain(self, parallel)
        kept: CompiledChain[Chain] | None = getattr(self, "_compiled", None)
        if kept is None:
            kept = CompiledChain(self)
            object.__setattr__(self, "_compiled", kept)
        return kept

    def velocity(self, q: Any, dq: Any, frame: str | int) -> Array:
        """Twist V = J(q) dq of the tool by the paper's V recursion, without forming J.

        Parameters: q, dq (..., m), broadcast against each other; frame as in `jacobian`. Returns: V
        (..., 6), rad/s, m/s. Raises: ShapeError, UnknownName, InputError.
        Accuracy: that of `fk` times (n + 1) |C dq|, n the joints (tests/model/test_chain_laws.py).
        Source: Park 1994, Section IV; the recursion yields the body velocity, the other frames are
        reached from it.
        """
        return pose_jacobian.velocity(self, q, dq, frame)

    def joint_poses(self, q: Any) -> Array:
        """Poses of the joints' z-aligned frames in the base frame, moved: f_k = M_1 e^{S x_1} ... M_k
        e^{S x_k}.

        Parameters: q (..., m) or a dict, as `fk`. Returns: (..., n, 4, 4), m. Raises: ShapeError,
        UnknownName, InputError. Accuracy: as `fk`. Source: Park 1994, Section IV; the frames are
        those of `Chain.local`.
        """
        return pose_jacobian.joint_poses(self, q)

    def joint_velocities(self, q: Any, dq: Any, frame: str) -> Array:
        """Twists of the joints' z-aligned frames, those of `joint_poses`, relative to the base: V_k of
        each f_k, moved.

        Parameters: q, dq (..., m) or dicts, broadcast against each other; frame: "space" f_k'
        f_k^-1, "body" f_k^-1 f_k' (in each frame's own axes, velocity of its origin), "hybrid"
        (base axes, velocity of each frame's origin).
        Returns: (..., n, 6), (omega; v) in rad/s and m/s; the tool, which stands still in the last
        of them, is not in it. Raises: ShapeError, UnknownName, InputError. Accuracy: that of
        `velocity` (tests/model/kinematics/test_derivatives.py).
        Source: Park 1994, Section IV, the V recursion, summed in the base frame.
        """
        return derivatives.joint_velocities(self, q, dq, frame)

    def jacobian_rate(self, q: Any, dq: Any, frame: str) -> Array:
        """dJ/dt along the rates dq: dV/dt = J ddq + (dJ/dt) dq. Column k is the sum over j of
        dJ_k/dq_j dq_j.

        Parameters: q, dq (..., m) or dicts, rad or m and rad/s or m/s, broadcast against each
        other; frame "space", "body" or "hybrid", as `jacobian`, and what is differentiated is that
        Jacobian as it stands: in "body" and "space" its entries in moving and in fixed axes, in
        "hybrid" with the moving reference point. It is what Pinocchio calls the time variation in
        LOCAL, WORLD and LOCAL_WORLD_ALIGNED.
        Returns: (..., 6, m), rows (omega; v). Raises: ShapeError, UnknownName, InputError.
        Accuracy: within 1e-13 reach for |dq_k| <= 1 on real robots
        (tests/model/kinematics/test_derivatives_pinocchio.py), in general within 4 n u (8 (n + 1) +
        4 sum |x|) reach sum |dx|, u = 2^-53 (tests/model/kinematics/test_derivatives.py).
        Source: Park 1994, Section III, J differentiated; each column's rate is one bracket.
        """
        return derivatives.jacobian_rate(self, q, dq, frame)

    def hessian(self, q: Any, frame: str) -> Array:
        """The kinematic Hessian H = dJ/dq: H[..., r, i, j] = d J[..., r, i] / d q_j, the column first,
        then the coordinate.

        So dJ/dt = H dq over the last axis. In "hybrid" the linear rows are the second derivatives
        of the tool's origin and symmetric in i and j; no other rows are.

        Parameters: q (..., m) or a dict; frame "space", "body" or "hybrid". Returns: (..., 6, m,
        m), rows (omega; v). Raises: ShapeError, UnknownName, InputError. Accuracy: that of
        `jacobian_rate` with one rate of 1.
        Source: Park 1994, Section III, J differentiated: ds_i/dx_j = [s_j, s_i] for j < i, else 0,
        and so on.
        """
        return derivatives.hessian(self, q, frame)

    def acceleration(self, q: Any, dq: Any, ddq: Any, frame: str) -> Array:
        """dV/dt = J ddq + (dJ/dt) dq, the rate of the tool's twist `velocity(q, dq, frame)` as its six
        numbers stand.

        - "hybrid": (alpha; p''), base axes: angular acceleration, and the acceleration of the
          tool's origin as an accelerometer without gravity would have it (the classical one;
          Pinocchio's getFrameClassicalAcceleration in LOCAL_WORLD_ALIGNED, not its
          getFrameAcceleration there, which is less by omega x p')
        - "body": d/dt (f^-1 f'), the spatial acceleration in tool axes; its linear part is R^T p''
          - omega_b x v_b (Pinocchio's getFrameAcceleration in LOCAL)
        - "space": d/dt (f' f^-1), the spatial acceleration in base axes about the base origin (the
          same in WORLD)

        Parameters: q, dq, ddq (..., m) or dicts, broadcast against each other; frame. Returns:
        (..., 6), rad/s^2, m/s^2. Raises: ShapeError, UnknownName, InputError. Accuracy: as
        `jacobian` for ddq and `jacobian_rate` for dq dq.
        Source: Park 1994, Section IV, V differentiated.
        """
        return derivatives.acceleration(self, q, dq, ddq, frame)

    def screw_derivatives(self, q: Any, by: str = "motion") -> PoseChanges:
        """The derivative of the pose with respect to each screw and the home pose: df f^-1, a space
        twist.

        by="motion": A_i <- Ad(e^eta_i) A_i, M <- M e^eta, which moves an axis and leaves it a unit
        screw of its own pitch: df f^-1 = sum (Ad(P_{i-1}) - Ad(P_i)) eta_i + Ad(f) eta, P_i =
        e^{A_1 x_1} ... e^{A_i x_i}. Of the six directions of eta_i two leave a revolute or helical
        joint as it is, A_i itself and the shift along its axis, and four a prismatic one, all
        shifts and the turn about its axis.
        by="entries": with respect to the six numbers of A_i as they stand, off the unit screws too:
        df f^-1 = sum Ad(P_{i-1}) J_l(A_i x_i) x_i dA_i + Ad(f) eta, J_l the left Jacobian of exp. A
        pitch h moves A_i by (0; omega_i) dh; the Jacobian in q answers for offsets and gains. The
        body twist f^-1 df is Ad(f)^-1 times all this.

        Parameters: q (..., m) or a dict; by. Returns: PoseChanges, (..., 6, n, 6) and (..., 6, 6):
        rows omega (rad) and v (m), per unit of eta or A, rad and m. Raises: ShapeError,
        UnknownName, InputError.
        Accuracy: within 1e-12 of finite differences in 50 digits for arms up to 10 m; in general 8
        u (8 (n + 1) + 4 sum |x|) and lengths times the reach
        (tests/model/kinematics/test_derivatives.py).
        Source: Park 1994, Section II, with e^{Ad(g) A x} = g e^{A x} g^-1; Lemma 5 for the entries.
        """
        return derivatives.screw_derivatives(self, q, by)

    def jacobian_screw_derivatives(self, q: Any, frame: str) -> JacobianChanges:
        """The derivative of `jacobian(q, frame)` under A_i <- Ad(e^eta_i) A_i and M <- M e^eta.

        A space column s_k moves by [d_i eta_i, s_k] for i < k with d_i the pose's derivative
        (`screw_derivatives`), by [Ad(P_{k-1}) eta_k, s_k] for i = k, and not for i > k nor with the
        home pose; the other frames follow the pose too.

        Parameters: q (..., m) or a dict; frame "space", "body" or "hybrid". Returns:
        JacobianChanges, (..., 6, m, n, 6) and (..., 6, m, 6). Raises: ShapeError, UnknownName,
        InputError.
        Accuracy: 16 n u (8 (n + 1) + 4 sum |x|), lengths times the reach squared
        (tests/model/kinematics/test_derivatives.py).
        Source: Park 1994, Sections II and III.
        """
        return derivatives.jacobian_screw_derivatives(self, q, frame)

    def pose_coordinates(self, q: Any, kind: str) -> Array:
        """f(q) as numbers: the rotation's, then the position (x, y, z) in m of the tool's origin in
        the base frame.

        - "rotation_vector": w = log R, 0 <= |w| <= pi, rad; as `so3.log`
        - "quaternion_wxyz": (w, x, y, z) of unit length, of the two that mean R the one with w >= 0
          (w = cos(|log R|/2)); at w = 0, half a turn, the largest of x, y, z is positive. So it
          jumps to its negative where |log R| passes pi
        - "rpy": (roll, pitch, yaw) in rad, R = Rz(yaw) Ry(pitch) Rx(roll) as URDF has it, |pitch|
          <= pi/2

        Parameters: q (..., m) or a dict; kind. Returns: (..., 6), or (..., 7) with a quaternion.
        Raises: ShapeError, UnknownName, InputError. Accuracy: that of `fk` in R; roll and yaw apart
        from each other lose 1/cos(pitch). Source: Park 1994, Lemma 3; the URDF specification for
        rpy.
        """
        return analytic.rotation_numbers(kind).pose_coordinates(self.fk(q))

    def analytic_jacobian(self, q: Any, kind: str) -> Array:
        """The derivative of `pose_coordinates(q, kind)` with respect to q: rows of the rotation's
        numbers, then of p.

        - "rotation_vector": dw/dt = J_l(w)^-1 omega, regular up to and at |w| = pi (there it is
          that of the branch that w is on: w itself jumps)
        - "quaternion_wxyz": dQ/dt = (-omega . v; w omega + omega x v) / 2 with Q = (w; v), of the
          sign that `pose_coordinates` gives; regular everywhere, and Q . dQ = 0
        - "rpy": singular at pitch = ±90 deg, where roll and yaw turn about one axis and cannot give
          every omega

        Parameters: q (..., m) or a dict; kind. Returns: (..., 6, m), or (..., 7, m) with a
        quaternion: per unit of dq, rad/s (1/s of a quaternion) and m/s.
        Raises: InputError with "rpy" where cos(pitch) < 1e-8, with the configuration and its pitch;
        ShapeError, UnknownName, InputError as `jacobian`.
        Accuracy: that of `jacobian`, times 1/cos(pitch) squared with "rpy"
        (tests/model/kinematics/test_analytic.py). Source: Park 1994, Lemma 4 for the rotation
        vector; the kinematic equation of unit quaternions; R of rpy differentiated.
        """
        numbers = analytic.rotation_numbers(kind)
        return numbers.jacobian(*self.fk_jacobian(q, "hybrid"))

    def idealised(self, tol: float) -> Idealised[Chain]:
        """Chain with its geometry made exact where it is so within a tolerance; nothing else ever
        implies this.

        Angles between consecutive axes, and between consecutive common normals, become multiples of
        15 degrees, and the lengths between them 0. Base and tool are the first and last axis of
        this (z axis and x direction): so a tool's rotation is Rz Rx Rz, of which each angle is
        looked at for itself.

        Parameters: tol, one number that is radians for angles and metres for lengths, 0 (nothing
        changes) to 0.05.
        Returns: Idealised. Kinds, pitches, names, limits and coupling stay.
        Raises: InputError for another tol.
        Accuracy: the exact geometry to the last digit of the screws. The bounds hold at every value
        of revolute joints; a joint that slides counts as far as it can within its limits, by as
        much as `random` draws where it has none. They are at most 20 times the worst error of the
        package's arms (tests/model/test_idealised.py).
        Source: none, the lines' geometry; the error of a product of poses is at most the sum of its
        factors'.
        """
        return idealise.idealised(self, tol)

    def to_hp(self) -> HPForm:
        """The chain as directions H (n, 3), steps P (n + 1, 3) and the tip's rotation R_nt (3, 3), in
        q itself.

        EAIK's `HPRobot(H, P)` takes H and P as they are, and so do IK-Geo and ssik as rows; the
        pose that they solve for has the rotation R_st R_nt^T. Base and tool are part of P, zero
        offsets of all three. The points are chosen so that steps that can be zero are zero to the
        last bit: axes that meet share their point (three in a row and more before two, towards the
        tip before towards the base), and an axis that meets none has its point nearest to the one
        before. A step between parallel axes is so perpendicular to them.

        Returns: HPForm, in the order of `q_names`.
        Raises: InputError where a joint is not revolute, or joints are coupled.
        Accuracy: a point is within 1e-14 reach of its axis, so the pose within 4e-14 n reach of
        `fk` (tests/model/geometry/test_hp.py).
        Source: Elias and Wen, IK-Geo (arXiv 2211.05737), Section II, for the form; the points are
        poekin's choice.
        """
        return hp.to_hp(self)

    def rebased(self, P: ArrayLike, base: str | None = None) -> Chain:
        """f' = P f: the same arm seen from another base frame; A' = Ad(P) A, M' = P M.

        Parameters: P (4, 4), the pose of the old base in the new one; base, its name. Returns:
        Chain.
        Raises: PoseError, ShapeError.
        Accuracy: screws within 10 u (reach + |p|), u = 2^-53, p the translation of P
        (tests/model/test_chain.py). Source: Park 1994, Section II, f' = P f Q.
        """
        return other_frames.rebased(self, P, base)

    def retooled(self, Q: ArrayLike, tip: str | None = None) -> Chain:
        """f' = f Q: the same arm with another tool frame; A' = A, M' = M Q, so B' = Ad(Q)^-1 B.

        Parameters: Q (4, 4), the pose of the new tool in the old one; tip, its name. Returns:
        Chain.
        Raises: PoseError, ShapeError. Accuracy: screws as they are. Source: Park 1994, Section II,
        f' = P f Q.
        """
        return other_frames.retooled(self, Q, tip)

    def rezeroed(self, q0: Any) -> Chain:
        """f'(q) = f(q + q0): the same arm with its zero positions at q0.

        A_i' = Ad(e^{A_1 d_1} ... e^{A_{i-1} d_{i-1}}) A_i and M' = e^{A_1 d_1} ... e^{A_n d_n} M
        with d = C q0; limits move by -q0.

        Parameters: q0 (m,) or a dict. Returns: Chain. Raises: ShapeError, UnknownName, InputError.
        Accuracy: screws and M within u (10 (n + 1) + 4 sum |d|) of the reach and what d slides, u =
        2^-53, the sum over joints that turn (tests/model/test_chain.py). Source: Park 1994, Section
        II.
        """
        return other_frames.rezeroed(self, q0)

    def random(self, rng: np.random.Generator | int, size: int | tuple[int, ...] = ()) -> Array:
        """Configurations drawn uniformly within the limits; without, one turn (1 m either way) of the
        fastest joint.

        Parameters: rng, a NumPy generator or a seed; size, the batch shape. Returns: (*size, m),
        rad or m.
        Raises: nothing of its own. Accuracy and source: none, it draws.
        """
        return sampling.random(self, rng, size)
