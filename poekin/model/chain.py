"""Serial chain: n screws and one home pose, from a base frame to a tip.

`Chain` is the face of `ChainData`: its methods, here and in `methods`, call functions of the data.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..checks import REQUIRED
from ..engine.kernels import chain_kernels
from ..groups.arrays import Array
from . import sampling
from .kinematics import pose_jacobian
from .kinematics.compiled import CompiledChain
from .kinematics.outputs import checked_out, checked_pair
from .kinematics.pose_jacobian import Frame
from .methods.chain_derivatives import ChainDerivatives
from .methods.entrances import ChainEntrances
from .methods.frames import ChainFrames
from .methods.peer_names import OF_CHAINS, answer_peer_names
from .methods.pictures import ChainPictures
from .methods.pose_coordinates import ChainCoordinates

# Names looked up once: one call for a pose and a Jacobian takes about a microsecond in all.
_ndarray = np.ndarray
_float64 = np.dtype(np.float64)
_empty = np.empty
_POSE_SHAPE = (4, 4)
_FRAME_CODES = pose_jacobian.FRAME_CODES
_pose_one = chain_kernels.pose_one
_pose_jacobian_one = chain_kernels.pose_jacobian_one


class Chain(ChainEntrances, ChainFrames, ChainDerivatives, ChainCoordinates, ChainPictures):
    """Serial chain f(q) = e^{A_1 x_1} ... e^{A_n x_n} M with x = C q + c.

    f(q) is the pose of the tip in the base frame. Revolute, prismatic and helical joints differ
    only in their screws. `from_space`, `from_body` and `from_local` make chains without `frame`.

    Parameters
    ----------
    screws : (n, 6) array_like
        Unit screws (ω; v) at x = 0, a row a joint: |ω| = 1, or ω = 0 and |v| = 1, to 1e-9; rad and
        m.
    home : (4, 4) array_like
        Home pose M, that of the tip in the base frame at x = 0, m.
    frame : {"space", "body"}
        Frame of the screws, base or tool; there is no default.
    joint_names : sequence of str, optional
        Names of the n joints; joint1, joint2, ... where they are left out.
    q_names : sequence of str, optional
        Names of the m coordinates; those of the joints where each joint is its own coordinate.
    limits : (m, 2) array_like, optional
        Lower and upper bound of each coordinate, rad or m; infinite means unlimited.
    coupling : (n, m) array_like, optional
        Matrix C; without it every joint is its own coordinate.
    offset : (n,) array_like, optional
        Constant part c of the joint values, rad or m.
    base, tip : str, default "base" and "tool"
        Names of the two frames.
    pitches : (n,) array_like, optional
        Pitches, m per rad, 0 for a revolute and for a prismatic joint. Without them the pitch is
        ω · v of the screw, 0 where that is its rounding, below 4e-15 max(1 m, |v|); with them v is
        made exact, so that ω · v is the pitch.
    velocity_limits : (m,) array_like, optional
        Greatest |dq| of each coordinate, rad/s or m/s; infinite where it is not known.
    joint_limits : (n, 2) array_like, optional
        Lower and upper bound of each joint's own value x, where the coordinates' limits do not say
        it all, as of coupled readings; infinite means no more than those say.
    joint_velocity_limits : (n,) array_like, optional
        Greatest |dx| of each joint, likewise.
    masses : (n, 4) array_like, optional
        Mass of what each joint moves and the next one does not, kg, and its centre at x = 0, m.

    Raises
    ------
    ScrewError
        If a row is no unit screw; the message names the remedy where another reading fits.
    PoseError
        If the home pose is no pose.
    ShapeError
        If an array has another shape.
    InputError
        If the frame is left out, a number is not finite, or names or limits cannot be used.

    Notes
    -----
    Frozen, with read-only arrays. Equal chains have equal numbers and names, but for masses; they
    are hashable and pickle as their data. A chain without joints is legal. Not made to be subclassed.
    `rebased`, `retooled` and `rezeroed` keep the pitches. Accuracy: data are kept to the last digit,
    but for what is made exact (unit length within 1e-9, the rotation of M within 1e-5). Source: Park
    1994, eqs. (1) and (2).

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> shoulder = pk.screw.revolute([0, 0, 1], [0, 0, 0])
    >>> slide = pk.screw.prismatic([1, 0, 0])
    >>> arm = pk.Chain([shoulder, slide], np.eye(4), frame="space", joint_names=["turn", "reach"])
    >>> print(arm.fk({"turn": np.pi / 2, "reach": 0.5})[:3, 3].round(6))
    [0.  0.5 0. ]
    """

    __slots__ = ("_compiled",)

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if name not in OF_CHAINS]

    def fk(self, q: Any, *, out: Array | None = None) -> Array:
        """Forward kinematics T_sb = f(q) = e^{A_1 x_1} ... e^{A_n x_n} M with x = C q + c.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations in the order of `q_names`, rad or m, or a dict from name to value.
        out : (..., 4, 4) ndarray, optional
            C-contiguous float64 array of the result's shape to write into.

        Returns
        -------
        T : (..., 4, 4) ndarray
            Poses of the tip in the base frame, m. NaN in a configuration gives NaN in its pose.

        Raises
        ------
        ShapeError
            If q has another number of coordinates, or out another shape or type.
        UnknownName
            If a dict has a name that is no coordinate.
        InputError
            If values are no real numbers, a dict lacks a coordinate, or out cannot be written.

        Notes
        -----
        Accuracy: for up to 20 joints, a turn and 1 m each, within 2e-14 reach
        (tests/analysis/test_validate.py, against Pinocchio); in general within u (8 (n + 1) + 4 sum
        |x|) (reach + sum |s|), u = 2^-53, s what a prismatic or helical joint slides
        (tests/model/test_chain_laws.py, tests/model/test_pitches.py). Source: Park 1994, eq. (1),
        by the local form of Section IV.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> arm = pk.load("panda").chain(tip="panda_hand")
        >>> T = arm.fk(np.zeros(7))
        >>> print(T[:3, 3].round(3) + 0.0)
        [0.088 0.    0.926]
        >>> arm.fk(arm.random(0, size=1000)).shape
        (1000, 4, 4)
        """
        if type(q) is _ndarray and q.dtype is _float64 and q.shape == self.plain_shape:
            T = _empty(_POSE_SHAPE) if out is None else checked_out(out, _POSE_SHAPE, "out", q)
            _pose_one.call(self.kernel_table, q, T)
            return T
        return pose_jacobian.fk(self, q, out)

    def jacobian(
        self,
        q: Any,
        frame: Frame | int = REQUIRED,
        *,
        at: ArrayLike | None = None,
        out: Array | None = None,
    ) -> Array:
        """Jacobian J(q) with V = J dq, rows (ω; v), in the frame that is named at every call.

        - "space": V_s = f' f^-1, base axes, velocity of the tool's point that passes the base
          origin
        - "body": V_b = f^-1 f', tool axes, velocity of the tool's origin
        - "hybrid": base axes, velocity of the tool's origin: the geometric Jacobian of many books,
          Pinocchio's LOCAL_WORLD_ALIGNED
        - k: the twist of the tool in the z-aligned frame of joint k (0 ... n - 1, see
          `joint_poses`), which moves with it

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m, as `fk`.
        frame : {"space", "body", "hybrid"} or int
            Frame of the twist; there is no default.
        at : (3,) array_like, optional
            Point of the tool in its own frame, m, whose velocity is meant instead of its origin's
            ("body" and "hybrid" only).
        out : (..., 6, m) ndarray, optional
            C-contiguous float64 array of the result's shape to write into.

        Returns
        -------
        J : (..., 6, m) ndarray
            Jacobians: rad/s and m/s per unit of dq.

        Raises
        ------
        ShapeError
            If q, at or out has another shape.
        UnknownName
            If a name is no coordinate.
        InputError
            If the frame is none or left out, or values cannot be used.

        Notes
        -----
        Accuracy: as `fk` (tests/analysis/test_validate.py, tests/model/test_chain_laws.py). Source:
        Park 1994, Section III, "The Jacobian".

        Examples
        --------
        >>> import poekin as pk
        >>> A = [[0, 0, 1, 0, 0, 0], [0, 0, 1, 0, -0.5, 0]]
        >>> arm = pk.Chain.from_space(A, pk.se3.exp([0, 0, 0, 0.8, 0, 0]))
        >>> print(arm.jacobian([0.0, 0.0], frame="hybrid")[[2, 4]])
        [[1.  1. ]
         [0.8 0.3]]
        """
        if out is None and type(q) is _ndarray and q.ndim == 1:
            return self.fk_jacobian(q, frame, at=at)[1]  # the shorter way in for one configuration
        return pose_jacobian.jacobian(self, q, frame, at, out)

    def fk_jacobian(
        self,
        q: Any,
        frame: Frame | int = REQUIRED,
        *,
        at: ArrayLike | None = None,
        out: tuple[Array, Array] | None = None,
    ) -> tuple[Array, Array]:
        """Pose and Jacobian in one pass: those of `fk` and `jacobian`.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m, as `fk`.
        frame : {"space", "body", "hybrid"} or int
            Frame of the Jacobian, as in `jacobian`; there is no default.
        at : (3,) array_like, optional
            Point of the tool in its own frame, m, as in `jacobian`.
        out : tuple of ndarray, optional
            Arrays (T, J) of the results' shapes to write into.

        Returns
        -------
        T : (..., 4, 4) ndarray
            Poses of the tip in the base frame, m.
        J : (..., 6, m) ndarray
            Jacobians: rad/s and m/s per unit of dq.

        Raises
        ------
        ShapeError
            If q, at or an array of out has another shape.
        UnknownName
            If a name is no coordinate.
        InputError
            If the frame is none or left out, or values cannot be used.

        Notes
        -----
        Accuracy and source: as `fk` and `jacobian`.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5e").chain()
        >>> T, J = arm.fk_jacobian(arm.random(0), frame="body")
        >>> T.shape, J.shape
        ((4, 4), (6, 6))
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
        """Machine code for the numbers of this chain: `fk`, `jacobian`, `fk_jacobian`, but faster.

        Parameters
        ----------
        parallel : bool, default False
            Whether large batches are shared out among threads.

        Returns
        -------
        compiled : CompiledChain
            Kinematics of this chain; without `parallel` the same object at every call.

        Raises
        ------
        InputError
            If parallel is no truth value.

        Notes
        -----
        Accuracy: as `fk`. Source: Park 1994, Section IV, two planar rotations a link.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5e").chain()
        >>> fast = arm.compile()
        >>> q = arm.random(0)
        >>> bool(abs(fast.fk(q) - arm.fk(q)).max() < 1e-14)
        True
        """
        if parallel is not False:
            return CompiledChain(self, parallel)
        kept: CompiledChain[Chain] | None = getattr(self, "_compiled", None)
        if kept is None:
            kept = CompiledChain(self)
            object.__setattr__(self, "_compiled", kept)
        return kept

    def joint_poses(self, q: Any) -> Array:
        """Poses of the joints' z-aligned frames in the base: f_k = M_1 e^{S x_1} ... M_k e^{S x_k}.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m, as `fk`.

        Returns
        -------
        T : (..., n, 4, 4) ndarray
            Poses, m; the frames are those of `Chain.local`, moved by their joints.

        Raises
        ------
        ShapeError
            If q has another number of coordinates.
        UnknownName
            If a name is no coordinate.
        InputError
            If values cannot be used.

        Notes
        -----
        Accuracy: as `fk`. Source: Park 1994, Section IV.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> pk.load("ur5e").chain().joint_poses(np.zeros(6)).shape
        (6, 4, 4)
        """
        return pose_jacobian.joint_poses(self, q)

    def random(
        self,
        rng: np.random.Generator | int,
        size: int | tuple[int, ...] = (),
    ) -> Array:
        """Configurations drawn uniformly within the limits.

        A coordinate without limits is drawn from one turn, or 1 m either way, of the joint that it
        moves fastest, about 0 or, where joints do not get there otherwise, about the middle of
        their own limits. Joints are within their own limits, `joint_limits`, too.

        Parameters
        ----------
        rng : numpy.random.Generator or int
            Generator, or a seed.
        size : int or tuple of int, default ()
            Batch shape.

        Returns
        -------
        q : (*size, m) ndarray
            Configurations, rad or m.

        Raises
        ------
        InputError
            If seed or size is no whole number from 0 on, or hardly a q keeps joint_limits.

        Notes
        -----
        Accuracy and source: none, it draws.

        Examples
        --------
        >>> import poekin as pk
        >>> pk.load("ur5e").chain().random(0, size=(2, 3)).shape
        (2, 3, 6)
        """
        return sampling.random(self, rng, size)


answer_peer_names(Chain, OF_CHAINS)
