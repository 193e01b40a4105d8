"""A chain compiled: poses and Jacobians by straight-line machine code made for its numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ...by_value import ByValue
from ...checks import REQUIRED, true_or_false
from ...engine.jit import threads
from ...engine.jit.kernel import Kernel
from ...engine.jit.locks import COMPILING
from ...engine.kernels import chain_kernels
from ...engine.straight_line import interpret
from ...groups.arrays import Array
from ..chain_data import AnyChain
from . import pose_jacobian
from .pose_jacobian import AnyFrame
from .programs import ChainPrograms

if TYPE_CHECKING:
    from ...engine.straight_line.arm_code import ArmCode

_Calls = dict[object, tuple[Callable, int]]
# Names looked up once: one call takes less than a microsecond.
_empty = np.empty
_float64 = np.dtype(np.float64)
_POSE_SHAPE = (4, 4)
_RESULTS = {(True, False): "pose", (False, True): "jacobian", (True, True): "pose_jacobian"}
_NOT_PLAIN = (AttributeError, KeyError, TypeError, ValueError)


class CompiledChain(ByValue, ChainPrograms[AnyChain]):
    """Kinematics of one arm, as `Chain` has them, by code that was made for its numbers.

    `fk`, `jacobian` and `fk_jacobian` take and return what those of the chain do. What is 0, ±1 or
    a right angle in the arm costs nothing; nothing is rounded to that beyond 2 u, u = 2^-53, the
    rounding of the cosine of a right angle (`Chain.idealised` does, where it is asked to). Besides
    the chain's frames there is "cheapest", the z-aligned frame in which the Jacobian costs least:
    `cheapest` says which.

    Parameters
    ----------
    chain : Chain
        Chain to compile; `Chain.compile` keeps one for each chain.
    parallel : bool, default False
        Whether large batches are shared out among threads.

    Attributes
    ----------
    chain : Chain
        Chain that was compiled.
    parallel : bool
        As given.
    joint_names, q_names : tuple of str
        Names of joints and coordinates, as the chain's.
    dof : int
        Number m of coordinates.

    Raises
    ------
    InputError
        If parallel is no truth value.

    Notes
    -----
    Machine code is made at the first use of a frame, in a fraction of a second, and kept in the
    cache. Pickles as its chain and options, never as code; works in threads and in forked workers.
    Accuracy: within u (40 (n + 1) + 4 sum |x|) reach of the product of exponentials: the rounding
    of `Chain.fk`, and 32 u (n + 1) for the constants that are taken for 0 or ±1
    (tests/model/kinematics/test_compiled.py). An entry that does not depend on a coordinate is a
    number even where that coordinate is NaN. Source: Park 1994, Section IV, each link as two planar
    rotations.
    """

    def __init__(self, chain: AnyChain, parallel: bool = False) -> None:
        true_or_false(parallel, "parallel")
        with COMPILING:  # the import of Numba, after all that only reads a model
            from numba.core import config

            from ...engine.kernels import arm_kernels

        self.chain = chain
        self.parallel = parallel
        self.joint_names = chain.joint_names
        self.q_names = chain.q_names
        self.dof = chain.dof
        self._kernels = arm_kernels
        self._interpreted = bool(config.DISABLE_JIT)  # type: ignore[attr-defined]
        self._shape = chain.jacobian_shape
        self._arms: dict[tuple[int | None, bool], ArmCode] = {}
        # The kernel and the arm that one configuration needs, by the frame as the user says it. A
        # kernel refuses what is not exactly one float64 configuration and its results; then the
        # longer way is taken, which takes everything and says what is wrong. Only the order of a
        # number's bytes is no matter to Numba.
        self._poses: _Calls = {}
        self._jacobians: _Calls = {}
        self._both: _Calls = {}

    def fk(self, q: Any, *, out: Array | None = None) -> Array:
        """Poses of the tip in the base frame, as `Chain.fk`.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m.
        out : (..., 4, 4) ndarray, optional
            C-contiguous float64 array of the result's shape to write into.

        Returns
        -------
        T : (..., 4, 4) ndarray
            Poses of the tip in the base frame, m.

        Raises
        ------
        ShapeError
            If an array has another shape.
        UnknownName
            If a name is no coordinate.
        InputError
            If values cannot be used.

        Notes
        -----
        Accuracy: see the class. Source: as `Chain.fk`.
        """
        try:
            if q.ndim == 1:
                kernel, arm = self._poses.get(None) or self._prepare(self._poses, None)
                T = _empty(_POSE_SHAPE) if out is None else out
                if q.dtype is T.dtype is _float64 and kernel(arm, q, T):
                    return T
        except _NOT_PLAIN:
            pass
        return pose_jacobian.fk(self.chain, q, out, self._fill)

    def jacobian(
        self,
        q: Any,
        frame: AnyFrame = REQUIRED,
        *,
        at: ArrayLike | None = None,
        out: Array | None = None,
    ) -> Array:
        """Jacobians as `Chain.jacobian`; the frame may be "cheapest" too.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m.
        frame : {"space", "body", "hybrid", "cheapest"} or int
            Frame of the Jacobian; there is no default.
        at : (3,) array_like, optional
            Point of the tool in its own frame, m, as in `Chain.jacobian`.
        out : (..., 6, m) ndarray, optional
            C-contiguous float64 array of the result's shape to write into.

        Returns
        -------
        J : (..., 6, m) ndarray
            Jacobians, rows (ω; v): rad/s and m/s per unit of dq.

        Raises
        ------
        ShapeError
            If an array has another shape.
        UnknownName
            If a name is no coordinate.
        InputError
            If the frame is none or left out, or values cannot be used.

        Notes
        -----
        Accuracy: see the class. Source: as `Chain.jacobian`.
        """
        try:
            if q.ndim == 1 and at is None:
                kernel, arm = self._jacobians.get(frame) or self._prepare(self._jacobians, frame)
                J = _empty(self._shape) if out is None else out
                if q.dtype is J.dtype is _float64 and kernel(arm, q, J):
                    return J
        except _NOT_PLAIN:
            pass
        code = self._frame_code(frame)
        return pose_jacobian.jacobian(self.chain, q, frame, at, out, code, self._fill)

    def fk_jacobian(
        self,
        q: Any,
        frame: AnyFrame = REQUIRED,
        *,
        at: ArrayLike | None = None,
        out: tuple[Array, Array] | None = None,
    ) -> tuple[Array, Array]:
        """Pose and Jacobian in one pass, as `Chain.fk_jacobian`; the frame may be "cheapest" too.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m.
        frame : {"space", "body", "hybrid", "cheapest"} or int
            Frame of the Jacobian; there is no default.
        at : (3,) array_like, optional
            Point of the tool in its own frame, m, as in `Chain.jacobian`.
        out : tuple of ndarray, optional
            Arrays (T, J) of the results' shapes to write into.

        Returns
        -------
        T : (..., 4, 4) ndarray
            Poses of the tip in the base frame, m.
        J : (..., 6, m) ndarray
            Jacobians, rows (ω; v): rad/s and m/s per unit of dq.

        Raises
        ------
        ShapeError
            If an array has another shape.
        UnknownName
            If a name is no coordinate.
        InputError
            If the frame is none or left out, or values cannot be used.

        Notes
        -----
        Accuracy: see the class. Source: as `Chain.fk_jacobian`.
        """
        try:
            if q.ndim == 1 and at is None:
                kernel, arm = self._both.get(frame) or self._prepare(self._both, frame)
                T, J = (_empty(_POSE_SHAPE), _empty(self._shape)) if out is None else out
                if q.dtype is T.dtype is J.dtype is _float64 and kernel(arm, q, T, J):
                    return T, J
        except _NOT_PLAIN:
            pass
        code = self._frame_code(frame)
        return pose_jacobian.fk_jacobian(self.chain, q, frame, at, out, code, self._fill)

    @property
    def hybrid_address(self) -> int:
        """Address of the code of pose and hybrid Jacobian; valid as long as this object lives."""
        return self._arm(chain_kernels.HYBRID, True).address

    def _prepare(self, calls: _Calls, frame: object) -> tuple[Callable, int]:
        """The kernel and the arm for a frame, from now on in `calls`."""
        if self._interpreted:
            return _refusing, 0
        code = None if calls is self._poses else self._frame_code(frame)
        pose = calls is not self._jacobians
        kernel = self._kernel(pose, code, "one").ready()
        calls[frame] = kernel, self._arm(code, pose).address
        return calls[frame]

    def _kernel(self, pose: bool, code: int | None, many: str) -> Kernel:
        """The kernel of poses, Jacobians or both, for "one" configuration or "many"."""
        results = _RESULTS[pose, code is not None]
        return getattr(self._kernels, f"{results}_{many}")

    def _arm(self, code: int | None, pose: bool) -> ArmCode:
        """The machine code for a frame; for None, of the pose alone."""
        with COMPILING:
            if (code, pose) not in self._arms:
                from ...engine.straight_line.arm_code import arm_code

                # the structure, not the chain's numbers: it also holds what the modules of this
                # room make of them
                key = self.structure, code, code is not None
                self._arms[code, pose] = arm_code(
                    key,
                    lambda: self._program(code, pose),
                    self.dof,
                    pose,
                )
            return self._arms[code, pose]

    def _fill(
        self,
        rows: Array,
        code: int | None,
        T: Array | None,
        J: Array | None,
    ) -> None:
        """Poses into T and Jacobians in the frame of a code into J, where these are given."""
        if self._interpreted:
            self._interpret(code, rows, T, J)
            return
        kernel = self._kernel(T is not None, code, "many")
        arm = self._arm(code, T is not None)
        results = [array for array in (T, J) if array is not None]
        q = np.require(rows, np.float64, ["C", "A", "W"])
        if self.parallel:
            threads.share_out(lambda *part: kernel.call(arm.address, *part), q, *results)
        else:
            kernel.call(arm.address, q, *results)

    def _interpret(
        self,
        code: int | None,
        rows: Array,
        T: Array | None,
        J: Array | None,
    ) -> None:
        """Runs the programs without machine code, where Numba is told to compile nothing."""
        values = interpret.evaluate(self._program(code, T is not None), rows)
        if T is not None:
            T[:, :3, :3] = values[:, :9].reshape(len(T), 3, 3)
            T[:, :3, 3] = values[:, 9:12]
            T[:, 3] = 0.0, 0.0, 0.0, 1.0
            values = values[:, 12:]
        if J is not None:
            J[...] = values.reshape(J.shape)

    def _values(self) -> list[Any]:
        return [self.chain, self.parallel]

    def __repr__(self) -> str:
        return f"<CompiledChain of {self.chain!r}{', parallel' * self.parallel}>"


def _refusing(*_arguments: object) -> int:
    """A kernel that takes nothing."""
    return 0
