"""A serial chain: n screws and one home pose, from a base frame to a tip."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..engine.kernels import chain_kernels
from ..errors import InputError, ShapeError, quote
from ..groups import se3
from ..groups.arrays import Array
from . import screw
from .checks import (
    bounds,
    coupling_matrix,
    distinct_names,
    finite,
    frame_name,
    one_pose,
    ordered_names,
    read_only,
)
from .coordinates import coordinates
from .geometry import hp, idealise
from .geometry.local import LocalForm, kernel_table, local_form
from .kinematics import analytic, derivatives, pose_jacobian

if TYPE_CHECKING:
    from .kinematics.compiled import CompiledChain


class ScrewForm(NamedTuple):
    """One global form of the product of exponentials: screws (n, 6), per rad or m, in one frame;
    home (4, 4), m.
    """

    screws: Array
    home: Array


class Chain:
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
        is omega . v of the screw, 0 where that is its rounding, below 4e-15 max(1 m, |v|); with
        them v is made exact, so that omega . v is the pitch. `rebased`, `retooled` and `rezeroed`
        keep them: the kind of a joint is not found again.

    Frozen: the arrays are read-only. Equal chains have equal numbers and names; hashable; pickles
    as its data. Revolute, prismatic and helical joints differ only in their screws. A chain without
    joints is legal. Not made to be subclassed.
    Raises: ScrewError, PoseError, ShapeError, InputError. Accuracy: the data are kept to the last
    digit, but for what is made exact (unit length within 1e-9, the rotation of M within 1e-5).
    Source: Park 1994, eqs. (1) and (2).
    """

    __slots__ = (
        *(
            "screws",
            "home",
            "joint_names",
            "q_names",
            "limits",
            "_coupling",
            "offset",
            "base",
            "tip",
            "pitches",
        ),
        *("kinds", "local", "reach", "_table", "_one", "_jacobian_shape", "_compiled"),
    )
    screws: Array
    home: Array
    joint_names: tuple[str, ...]
    q_names: tuple[str, ...]
    limits: Array
    _coupling: Array | None
    offset: Array
    base: str
    tip: str
    pitches: Array
    kinds: tuple[str, ...]
    local: LocalForm
    reach: float
    _table: Array
    _one: tuple[int, ...] | None
    _jacobian_shape: tuple[int, int]
    _compiled: CompiledChain | None

    def __init__(
        self,
        screws: ArrayLike,
        home: ArrayLike,
        *,
        joint_names: Sequence[str] | None = None,
        q_names: Sequence[str] | None = None,
        limits: ArrayLike | None = None,
        coupling: ArrayLike | None = None,
        offset: ArrayLike | None = None,
        base: str = "base",
        tip: str = "tool",
        pitches: ArrayLike | None = None,
    ):
        A = screw.checked(screws, ordered_names(joint_names, "joint_names"))
        n = len(A)
        h = screw.pitches_of(A, pitches, ordered_names(joint_names, "joint_names"))
        A = A if pitches is None else screw.with_pitches(A, h)
        joints = distinct_names(joint_names, n, "joint_names", "joint")
        C = None if coupling is None else coupling_matrix(coupling, n)
        m = n if C is None else C.shape[1]
        c = np.zeros(n) if offset is None else finite(offset, "offset")
        if c.shape != (n,):
            raise ShapeError(f"offset: expected shape ({n},), one number a joint, got {c.shape}")
        names = distinct_names(
            joints if q_names is None and C is None else q_names, m, "q_names", "q"
        )
        M = one_pose(home)
        form = local_form(A, M, h)
        table = kernel_table(form, C, c)
        data = {
            "screws": A,
            "home": M,
            "joint_names": joints,
            "q_names": names,
            "limits": bounds(limits, names),
            "_coupling": C,
            "offset": c,
            "base": frame_name(base, "base"),
            "tip": frame_name(tip, "tip"),
            "pitches": h,
            "kinds": tuple(_kind(r, s) for r, s in zip(form.rotates, form.slides, strict=True)),
            "local": form,
            "reach": max(
                1.0,
                float(
                    np.linalg.norm(form.frames[:, :3, 3], axis=1).sum() + (form.rotates == 0).sum()
                ),
            ),
            "_table": table,
            # the shape of one configuration that needs no coupling
            "_one": (m,) if table.shape[1] == chain_kernels.OFFSET else None,
            "_jacobian_shape": (6, m),
            "_compiled": None,
        }
        for name, value in data.items():
            # The kernels' own table stays writable: Numba takes half a microsecond longer over a
            # read-only array.
            frozen = isinstance(value, np.ndarray) and name != "_table"
            object.__setattr__(self, name, read_only(value) if frozen else value)

    fk = pose_jacobian.fk
    jacobian = pose_jacobian.jacobian
    fk_jacobian = pose_jacobian.fk_jacobian
    velocity = pose_jacobian.velocity
    joint_poses = pose_jacobian.joint_poses
    joint_velocities = derivatives.joint_velocities
    jacobian_rate = derivatives.jacobian_rate
    hessian = derivatives.hessian
    acceleration = derivatives.acceleration
    screw_derivatives = derivatives.screw_derivatives
    jacobian_screw_derivatives = derivatives.jacobian_screw_derivatives
    pose_coordinates = analytic.pose_coordinates
    analytic_jacobian = analytic.analytic_jacobian
    _fill_poses, _fill_both, _fill_jacobians = (
        pose_jacobian.fill_poses,
        pose_jacobian.fill_both,
        pose_jacobian.fill_jacobians,
    )
    _frame_code = pose_jacobian.frame_code
    idealised = idealise.idealised
    to_hp = hp.to_hp

    @property
    def dof(self) -> int:
        """m, the number of coordinates."""
        return len(self.q_names)

    @property
    def coupling(self) -> Array:
        """C (n, m) of x = C q + c: made anew at each call where every joint is its own coordinate."""
        C = np.eye(self.dof) if self._coupling is None else self._coupling
        return read_only(C)

    @property
    def space(self) -> ScrewForm:
        """A_1 ... A_n in the base frame and M: f = e^{A_1 x_1} ... e^{A_n x_n} M."""
        return ScrewForm(self.screws, self.home)

    @property
    def body(self) -> ScrewForm:
        """B_i = Ad(M)^-1 A_i in the tool frame and M: f = M e^{B_1 x_1} ... e^{B_n x_n}."""
        return ScrewForm(self.screws @ se3.adjoint(se3.inverse(self.home)).T, self.home)

    def compile(self, *, parallel: bool = False) -> CompiledChain:
        """The same arm with machine code made for its numbers: methods `fk`, `jacobian`,
        `fk_jacobian` as here, faster.

        Parameters: parallel, whether large batches are shared out among threads. Returns:
        CompiledChain, see there. Raises: InputError. Accuracy: as `fk`. Source: Park 1994, Section
        IV, two planar rotations a link.
        """
        from .kinematics.compiled import CompiledChain

        if parallel is not False:
            return CompiledChain(self, parallel)
        if self._compiled is None:
            object.__setattr__(self, "_compiled", CompiledChain(self))
        return self._compiled  # type: ignore[return-value]

    def rebased(self, P: ArrayLike, base: str | None = None) -> Chain:
        """f' = P f: the same arm seen from another base frame; A' = Ad(P) A, M' = P M.

        Parameters: P (4, 4), the pose of the old base in the new one; base, its name. Returns:
        Chain.
        Raises: PoseError, ShapeError.
        Accuracy: screws within 10 u (reach + |p|), u = 2^-53, p the translation of P
        (tests/model/test_chain.py). Source: Park 1994, Section II, f' = P f Q.
        """
        P = one_pose(P, "P")
        return self._with(
            screws=self.screws @ se3.adjoint(P).T, home=P @ self.home, base=base or self.base
        )

    def retooled(self, Q: ArrayLike, tip: str | None = None) -> Chain:
        """f' = f Q: the same arm with another tool frame; A' = A, M' = M Q, so B' = Ad(Q)^-1 B.

        Parameters: Q (4, 4), the pose of the new tool in the old one; tip, its name. Returns:
        Chain.
        Raises: PoseError, ShapeError. Accuracy: screws as they are. Source: Park 1994, Section II,
        f' = P f Q.
        """
        return self._with(home=self.home @ one_pose(Q, "Q"), tip=tip or self.tip)

    def rezeroed(self, q0: Any) -> Chain:
        """f'(q) = f(q + q0): the same arm with its zero positions at q0.

        A_i' = Ad(e^{A_1 d_1} ... e^{A_{i-1} d_{i-1}}) A_i and M' = e^{A_1 d_1} ... e^{A_n d_n} M
        with d = C q0; limits move by -q0.

        Parameters: q0 (m,) or a dict. Returns: Chain. Raises: ShapeError, UnknownName, InputError.
        Accuracy: screws and M within u (10 (n + 1) + 4 sum |d|) of the reach and what d slides, u =
        2^-53, the sum over joints that turn (tests/model/test_chain.py). Source: Park 1994, Section
        II.
        """
        q0 = coordinates(q0, self.q_names, "q0")
        if q0.ndim != 1 or not np.isfinite(q0).all():
            raise InputError(
                f"q0: expected one finite configuration ({self.dof},), got {q0.tolist()}"
            )
        A, P = np.empty_like(self.screws), np.eye(4)
        shifts = q0 if self._coupling is None else self._coupling @ q0
        for i, (S, d) in enumerate(zip(self.screws, shifts, strict=True)):
            A[i] = se3.adjoint(P) @ S
            P = P @ se3.exp(S * d)
        return self._with(screws=A, home=P @ self.home, limits=self.limits - q0[:, None])

    def random(self, rng: np.random.Generator | int, size: int | tuple[int, ...] = ()) -> Array:
        """Configurations drawn uniformly within the limits; without, one turn (1 m either way) of
        the fastest joint.

        Parameters: rng, a NumPy generator or a seed; size, the batch shape. Returns: (*size, m),
        rad or m.
        Raises: nothing of its own. Accuracy and source: none, it draws.
        """
        rng = np.random.default_rng(rng)
        size = (size,) if isinstance(size, (int, np.integer)) else tuple(size)
        low, high = self._range()
        return low + (high - low) * rng.random((*size, self.dof))

    def _half_range(self) -> Array:
        """The greatest value (m,) that `random` draws of coordinates without limits; the least is
        its opposite.
        """
        return np.array(
            [(np.pi if self._turns(k) else 1.0) / abs(self._ratio(k)) for k in range(self.dof)]
        )

    def _ratio(self, k: int) -> float:
        """The ratio of largest size to coordinate k, of joints that turn where it is an angle and
        slide where not.
        """
        slides = np.array(self.kinds) == "prismatic"
        ratios = self.coupling[slides != self._turns(k), k]
        return float(ratios[np.argmax(np.abs(ratios))]) if ratios.any() else 1.0

    def _range(self) -> tuple[Array, Array]:
        """Least and greatest value (m,) that `random` draws of each coordinate."""
        turn = self._half_range()
        lower, upper = self.limits.T
        bounded = np.isfinite(lower), np.isfinite(upper)
        low = np.where(bounded[0], lower, np.where(bounded[1], upper - 2 * turn, -turn))
        high = np.where(bounded[1], upper, np.where(bounded[0], lower + 2 * turn, turn))
        return low, high

    def _turns(self, k: int) -> bool:
        """Whether coordinate k is an angle: the first joint that follows it turns."""
        followers = [k] if self._coupling is None else np.flatnonzero(self._coupling[:, k])
        return not len(followers) or self.kinds[followers[0]] != "prismatic"

    def _with(self, **changes: Any) -> Chain:
        return _rebuilt({**self._data(), **changes})

    def _data(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in _DATA} | {"coupling": self._coupling}

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(
            f"a Chain is frozen: cannot set {name!r}; rebased, retooled and rezeroed make new ones"
        )

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"a Chain is frozen: cannot delete {name!r}")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Chain):
            return NotImplemented
        pairs = zip(self._data().values(), other._data().values(), strict=True)
        return all(type(a) is type(b) and np.array_equal(a, b) for a, b in pairs)

    def __hash__(self) -> int:
        return hash(
            tuple(a.tobytes() if isinstance(a, np.ndarray) else a for a in self._data().values())
        )

    def __reduce__(self):
        return _rebuilt, (self._data(),)

    def __repr__(self) -> str:
        counts = [f"{self.kinds.count(kind)} {kind}" for kind in _KINDS if kind in self.kinds]
        coupled = (
            "" if self.dof == len(self.kinds) else f", {self.dof} coordinate{'s' * (self.dof != 1)}"
        )
        return (
            f"<Chain {quote(self.base)} -> {quote(self.tip)}: {', '.join(counts) or 'no'} "
            f"joint{'s' * (len(self.kinds) != 1)}{coupled}, reach {self.reach:.3g} m>"
        )


_DATA = ("screws", "home", "joint_names", "q_names", "limits", "offset", "base", "tip", "pitches")
_KINDS = ("revolute", "prismatic", "helical")


def _rebuilt(data: dict[str, Any]) -> Chain:
    return Chain(**data)


def _kind(rotates: float, slides: float) -> str:
    return "prismatic" if rotates == 0 else "helical" if slides else "revolute"
