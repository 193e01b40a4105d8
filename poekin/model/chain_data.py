"""Data of a serial chain: screws, home pose, names, limits, coupling, and what follows from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, Self, TypedDict, TypeVar, get_args

import numpy as np
from numpy.typing import ArrayLike

from ..checks import REQUIRED, choice
from ..engine.kernels import chain_kernels
from ..errors import ShapeError, quote
from ..groups import se3
from ..groups.arrays import Array
from ..groups.vectors import norms, translation_part
from .checks import (
    bounds,
    coupling_matrix,
    distinct_names,
    finite,
    frame_name,
    joint_masses,
    one_pose,
    ordered_names,
    read_only,
    velocity_bounds,
)
from .geometry.local import LocalForm, kernel_table, local_form
from .screw_rows.unit_screws import pitches_of, unit_screws, with_pitches

ScrewFrame = Literal["space", "body"]
"""Frame of a chain's screws: the base frame, or the tool frame at home."""

ScrewKind = Literal["revolute", "prismatic", "helical"]

_ENTRANCES = "; or write Chain.from_space(A, M), from_body(B, M) or from_local(S, M_i)"


class ScrewForm(NamedTuple):
    """One global form of the product of exponentials.

    Attributes
    ----------
    screws : (n, 6) ndarray
        Screws (ω; v) in one frame, per rad or m.
    home : (4, 4) ndarray
        Home pose, m.
    """

    screws: Array
    home: Array


class ChainOptions(TypedDict, total=False):
    """Optional arguments of a chain, by name."""

    joint_names: Sequence[str] | None
    q_names: Sequence[str] | None
    limits: ArrayLike | None
    coupling: ArrayLike | None
    offset: ArrayLike | None
    base: str
    tip: str
    pitches: ArrayLike | None
    velocity_limits: ArrayLike | None
    joint_limits: ArrayLike | None
    joint_velocity_limits: ArrayLike | None
    masses: ArrayLike | None


@dataclass(slots=True, init=False, eq=False, repr=False)
class ChainData:
    """Frozen numbers and names of a serial chain, checked and made exact once.

    Parameters and errors: as `Chain`, its face. Further attributes
    - kinds (n): "revolute", "prismatic" or "helical"; local: the local form; reach, m.
    - nontrivial_coupling (n, m): C, or None where every joint is its own coordinate.
    - kernel_table: the numbers as the engine's kernels read them; to be read only.
    - plain_shape (m,): shape of a q that goes straight to the kernel of one configuration, None
      where joints and coordinates are not the same. jacobian_shape: (6, m).
    """

    screws: Array
    home: Array
    joint_names: tuple[str, ...]
    q_names: tuple[str, ...]
    limits: Array
    offset: Array
    base: str
    tip: str
    pitches: Array
    velocity_limits: Array
    joint_limits: Array
    joint_velocity_limits: Array
    masses: Array | None
    nontrivial_coupling: Array | None
    kinds: tuple[ScrewKind, ...]
    local: LocalForm
    reach: float
    kernel_table: Array
    plain_shape: tuple[int, ...] | None
    jacobian_shape: tuple[int, int]

    def __init__(  # noqa: PLR0913 - the data of a chain
        self,
        screws: ArrayLike,
        home: ArrayLike,
        *,
        frame: ScrewFrame = REQUIRED,
        joint_names: Sequence[str] | None = None,
        q_names: Sequence[str] | None = None,
        limits: ArrayLike | None = None,
        coupling: ArrayLike | None = None,
        offset: ArrayLike | None = None,
        base: str = "base",
        tip: str = "tool",
        pitches: ArrayLike | None = None,
        velocity_limits: ArrayLike | None = None,
        joint_limits: ArrayLike | None = None,
        joint_velocity_limits: ArrayLike | None = None,
        masses: ArrayLike | None = None,
    ) -> None:
        choice(frame, get_args(ScrewFrame), "frame", _ENTRANCES)
        given_names = ordered_names(joint_names, "joint_names")
        A = unit_screws(screws, given_names)
        h = pitches_of(A, pitches, given_names)
        M = one_pose(home)
        if frame == "body":
            A = unit_screws(A @ se3.adjoint(M).T)
        if pitches is not None or frame == "body":
            A = with_pitches(A, h)
        n = len(A)
        joints = distinct_names(joint_names, n, "joint_names", "joint")
        C = coupling_matrix(coupling, n)
        c = _offset(offset, n)
        m = n
        if C is not None:
            m = C.shape[1]
        elif q_names is None:
            q_names = joints
        names = distinct_names(q_names, m, "q_names", "q")
        form = local_form(A, M, h)
        table = kernel_table(form, C, c)
        plain = table.shape[1] == chain_kernels.OFFSET
        self._freeze(
            screws=read_only(A),
            home=read_only(M),
            joint_names=joints,
            q_names=names,
            limits=read_only(bounds(limits, names)),
            offset=read_only(c),
            base=frame_name(base, "base"),
            tip=frame_name(tip, "tip"),
            pitches=read_only(h),
            velocity_limits=read_only(velocity_bounds(velocity_limits, names)),
            joint_limits=read_only(bounds(joint_limits, joints, "joint_limits")),
            joint_velocity_limits=read_only(
                velocity_bounds(joint_velocity_limits, joints, "joint_velocity_limits")
            ),
            masses=joint_masses(masses, n),
            nontrivial_coupling=None if C is None else read_only(C),
            kinds=tuple(map(_kind, form.rotates, form.slides)),
            local=form,
            reach=_reach(form),
            # Writable: Numba takes half a microsecond longer over a read-only array.
            kernel_table=table,
            plain_shape=(m,) if plain else None,
            jacobian_shape=(6, m),
        )

    def _freeze(self, **values: object) -> None:
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @property
    def dof(self) -> int:
        """Number m of coordinates."""
        return len(self.q_names)

    @property
    def coupling(self) -> Array:
        """Matrix C (n, m) of x = C q + c; made anew where every joint is its own coordinate."""
        C = self.nontrivial_coupling
        return read_only(np.eye(self.dof) if C is None else C)

    @property
    def space(self) -> ScrewForm:
        """Screws A (n, 6) in the base frame and M: f = e^{A_1 x_1} ... e^{A_n x_n} M."""
        return ScrewForm(self.screws, self.home)

    @property
    def body(self) -> ScrewForm:
        """Screws B = Ad(M)^-1 A (n, 6) in the tool frame and M: f = M e^{B_1 x_1} ... e^{B_n x_n}."""
        return ScrewForm(self.screws @ se3.adjoint(se3.inverse(self.home)).T, self.home)

    def is_angle(self, k: int) -> bool:
        """Whether a coordinate is an angle, rad, and no length, m.

        It has the unit of the joint of its name where it moves that one, else of the first joint it
        moves.

        Parameters
        ----------
        k : int
            Number of the coordinate, from 0.

        Returns
        -------
        angle : bool
            True for an angle, and where no joint follows the coordinate.
        """
        C = self.nontrivial_coupling
        followers = [k] if C is None else np.flatnonzero(C[:, k]).tolist()
        if not followers:
            return True
        named = (i for i in followers if self.joint_names[i] == self.q_names[k])
        return self.kinds[next(named, followers[0])] != "prismatic"

    def replace(self, **changes: Any) -> Self:
        """Copy with some parameters changed.

        Parameters
        ----------
        **changes : dict
            Parameters of `Chain` by name. New `screws` are in the base frame, unless `frame` says
            otherwise; their pitches are found anew and masses left out, unless `pitches` and `masses`
            say them.

        Returns
        -------
        chain : Chain
            Chain with these parameters, the others as they are.

        Raises
        ------
        ShapeError
            If there are more or fewer screws than before, and the parameters of each joint and each
            coordinate are not given with them.
        InputError
            If `Chain` refuses a parameter: ShapeError, ScrewError, PoseError or InputError itself.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5e").chain()
        >>> arm.replace(tip="flange").tip
        'flange'
        """
        kept = self._data()
        if "screws" in changes:
            kept |= {"pitches": None, "masses": None}
            count = _row_count(changes["screws"])
            needed = [name for name in _SIZED if name not in changes and kept[name] is not None]
            if count not in (None, len(self.screws)) and needed:
                raise ShapeError(
                    f"screws: {count} in place of {len(self.screws)}: give {', '.join(needed)} too,"
                    " or None for the default"
                )
        return type(self)(**{"frame": "space", **kept, **changes})

    def _data(self) -> dict[str, Any]:
        data: dict[str, Any] = {name: getattr(self, name) for name in _DATA}
        data["coupling"] = self.nontrivial_coupling
        for name in _OF_JOINTS:
            if not np.isfinite(data[name]).any():
                data[name] = None
        return data

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(
            f"a Chain is frozen: cannot set {name!r}; rebased, retooled and rezeroed make new ones"
        )

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"a Chain is frozen: cannot delete {name!r}")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ChainData):
            return NotImplemented
        pairs = zip(self._kinematics(), other._kinematics(), strict=True)
        return all(type(a) is type(b) and np.array_equal(a, b) for a, b in pairs)

    def __hash__(self) -> int:
        values = self._kinematics()
        return hash(tuple(a.tobytes() if isinstance(a, np.ndarray) else a for a in values))

    def _kinematics(self) -> list[Any]:
        """The data without the masses, which say nothing of where the arm is."""
        return [value for name, value in self._data().items() if name != "masses"]

    def __reduce__(self) -> tuple[object, ...]:
        return _rebuilt, (type(self), self._data())

    def __repr__(self) -> str:
        counts = [f"{self.kinds.count(kind)} {kind}" for kind in _KINDS if kind in self.kinds]
        joints = f"{', '.join(counts) or 'no'} joint{'s' * (len(self.kinds) != 1)}"
        if self.dof != len(self.kinds):
            joints += f", {self.dof} coordinate{'s' * (self.dof != 1)}"
        frames = f"{quote(self.base)} -> {quote(self.tip)}"
        return f"<Chain {frames}: {joints}, reach {self.reach:.3g} m>"


AnyChain = TypeVar("AnyChain", bound=ChainData)
"""The class of the chain that is given: a function of a `Chain` that makes a new one makes a Chain."""

_OF_JOINTS = ("joint_limits", "joint_velocity_limits")
_DATA = (
    "screws",
    "home",
    "joint_names",
    "q_names",
    "limits",
    "offset",
    "base",
    "tip",
    "pitches",
    "velocity_limits",
    "masses",
    *_OF_JOINTS,
)
# by the number of joints
_SIZED = ("joint_names", "q_names", "limits", "coupling", "offset", "velocity_limits", *_OF_JOINTS)
_KINDS: tuple[ScrewKind, ...] = get_args(ScrewKind)


def _rebuilt(kind: type[ChainData], data: dict[str, Any]) -> ChainData:
    return kind(**data, frame="space")


def _row_count(screws: Any) -> int | None:
    """Number of screws that are given as rows; None of anything else."""
    try:
        shape = np.shape(screws)
    except ValueError:
        return None
    if shape == (0,) or shape[1:] == (6,):
        return shape[0]
    return None


def _offset(given: ArrayLike | None, n: int) -> Array:
    """The constant part c (n,) of x = C q + c."""
    if given is None:
        return np.zeros(n)
    c = finite(given, "offset")
    if c.shape != (n,):
        raise ShapeError(f"offset: expected shape ({n},), one number a joint, got {c.shape}")
    return c


def _kind(rotates: float, slides: float) -> ScrewKind:
    """Kind of the joint that turns by rotates x and slides by slides x."""
    if rotates == 0:
        return "prismatic"
    return "helical" if slides else "revolute"


def _reach(form: LocalForm) -> float:
    """Lengths between the joints, and 1 m for each joint that only slides; at least 1 m."""
    lengths = norms(translation_part(form.frames)).sum()
    return max(1.0, float(lengths + (form.rotates == 0).sum()))
