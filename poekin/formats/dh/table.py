"""Tables of Denavit-Hartenberg parameters: convention, offsets, directions, base and tool."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError, PoekinWarning, ShapeError, quote, safe_repr
from ...groups.arrays import Array
from ...model.checks import bounds, distinct_names, finite, one_pose, read_only
from ..common.limits import UNBOUNDED, Interval

Convention = Literal["standard", "modified"]
CONVENTIONS: tuple[Convention, ...] = get_args(Convention)
EITHER = " or ".join(map(repr, CONVENTIONS))
KINDS = ("revolute", "prismatic")
COLUMNS = ("theta", "d", "a", "alpha")


@dataclass(frozen=True)
class Row:
    """One joint of a table: theta, alpha [rad], d, a [m] at x = 0, kind, flip, name, limits (lower,
    upper).

    A revolute joint's theta is theta + x, a prismatic joint's d is d + x, with -x in place of x
    where `flip` is true.
    A joint's offset stands in theta or d. Of a modified table a and alpha are a_{i-1} and
    alpha_{i-1}.
    """

    theta: float = 0.0
    d: float = 0.0
    a: float = 0.0
    alpha: float = 0.0
    kind: str = "revolute"
    flip: bool = False
    name: str = ""
    limits: Interval = UNBOUNDED


class Table:
    """Denavit-Hartenberg parameters of n joints, frozen.

    - "standard" (Paul, distal): f = base prod [Rz(theta) Tz(d) Tx(a) Rx(alpha)] tool
    - "modified" (Craig, proximal): f = base prod [Rx(alpha) Tx(a) Rz(theta) Tz(d)] tool

    Parameters: convention; rows, `Row`s or dicts of a row's fields; base, tool (4, 4), poses, m;
    name.
    Attributes: theta, d, a, alpha (n,), kinds, flips, names (n), limits (n, 2), convention, base,
    tool, name.
    Raises: InputError, ShapeError, PoseError. Warns: PoekinWarning where |alpha| > 2 pi looks like
    degrees.
    Source: Paul 1981 and Craig 1986, as Park 1994, Section II, writes them.
    """

    __slots__ = (
        "a",
        "alpha",
        "base",
        "convention",
        "d",
        "flips",
        "kinds",
        "limits",
        "name",
        "names",
        "theta",
        "tool",
    )
    convention: Convention
    theta: Array
    d: Array
    a: Array
    alpha: Array
    kinds: tuple[str, ...]
    flips: tuple[bool, ...]
    names: tuple[str, ...]
    limits: Array
    base: Array
    tool: Array
    name: str

    def __init__(
        self,
        convention: Convention,
        rows: Sequence[Row | dict[str, Any]],
        *,
        base: ArrayLike | None = None,
        tool: ArrayLike | None = None,
        name: str = "arm",
    ):
        check_convention(convention)
        if isinstance(rows, (str, bytes, dict)) or not isinstance(rows, Iterable):
            raise ShapeError(
                f"rows: expected a list of Rows or dicts, one a joint, got {safe_repr(rows)}"
            )
        made = [_row(row, i) for i, row in enumerate(rows)]
        for i, row in enumerate(made):
            if row.kind not in KINDS:
                raise InputError(
                    f"row {i}: kind must be 'revolute' or 'prismatic', got {quote(row.kind)}"
                )
        given = [row.name or f"joint{i + 1}" for i, row in enumerate(made)]
        names = distinct_names(given, len(made), "names", "joint")
        values: dict[str, Any] = {
            "convention": convention,
            "kinds": tuple(row.kind for row in made),
            "flips": tuple(bool(row.flip) for row in made),
            "names": names,
            "limits": read_only(bounds([row.limits for row in made] or None, names)),
            "base": _pose(base, "base"),
            "tool": _pose(tool, "tool"),
            "name": str(name),
        }
        for column in COLUMNS:
            values[column] = read_only(finite([getattr(row, column) for row in made], column))
        large = [i for i, alpha in enumerate(values["alpha"].tolist()) if abs(alpha) > 2 * math.pi]
        if large:
            first = f"alpha = {values['alpha'][large[0]]:g} of joint {quote(names[large[0]])}"
            message = (
                f"table {quote(str(name))}: {first} is more than a turn: degrees? Expected are rad"
            )
            warnings.warn(message, PoekinWarning, stacklevel=2)
        for field, value in values.items():
            object.__setattr__(self, field, value)

    @property
    def rows(self) -> tuple[Row, ...]:
        """The table joint by joint."""
        numbers = zip(*(getattr(self, column).tolist() for column in COLUMNS), strict=True)
        limits = map(tuple, self.limits.tolist())
        rest = zip(self.kinds, self.flips, self.names, limits, strict=True)
        return tuple(Row(*four, *others) for four, others in zip(numbers, rest, strict=True))  # type: ignore[arg-type]

    def __len__(self) -> int:
        return len(self.kinds)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a Table is frozen: cannot set {name!r}")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"a Table is frozen: cannot delete {name!r}")

    def _data(self) -> tuple[Any, ...]:
        return tuple(getattr(self, name) for name in self.__slots__)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Table):
            return NotImplemented
        return all(np.array_equal(a, b) for a, b in zip(self._data(), other._data(), strict=True))

    def __hash__(self) -> int:
        return hash((self.convention, self.kinds, self.names, tuple(self.theta.tolist())))

    def __reduce__(self):
        return _rebuilt, (self.convention, self.rows, self.base, self.tool, self.name)

    def __repr__(self) -> str:
        lines = [f"<{self.convention} DH table {quote(self.name)}, {len(self)} joints"]
        lines += [
            f"  {quote(r.name)}: theta {r.theta:.9g}{_moves(r, 'revolute')}  d {r.d:.9g}{_moves(r, 'prismatic')}"
            f"  a {r.a:.9g}  alpha {r.alpha:.9g}"
            for r in self.rows
        ]
        return "\n".join(lines) + ">"


def check_convention(convention: object) -> None:
    """Refuse what is no convention of DH parameters. Raises: InputError."""
    if convention not in CONVENTIONS:
        raise InputError(f"convention: expected {EITHER}, got {convention!r:.60}")


def _pose(pose: ArrayLike | None, what: str) -> Array:
    if pose is None:
        return read_only(np.eye(4))
    return read_only(one_pose(pose, what))


def _moves(row: Row, kind: str) -> str:
    """Sign of x behind the parameter that moves a joint of that kind; nothing for other joints."""
    if row.kind != kind:
        return ""
    return " - x" if row.flip else " + x"


def _rebuilt(
    convention: Convention, rows: Sequence[Row], base: Array, tool: Array, name: str
) -> Table:
    return Table(convention, rows, base=base, tool=tool, name=name)


def _row(row: Any, index: int) -> Row:
    if isinstance(row, Row):
        return row
    if not isinstance(row, dict):
        raise ShapeError(f"row {index}: expected a Row or a dict, got {type(row).__name__}")
    unknown = [key for key in row if key not in Row.__dataclass_fields__]
    if unknown:
        raise InputError(
            f"row {index}: no column {quote(unknown[0])}; there are {', '.join(Row.__dataclass_fields__)}"
        )
    missing = [column for column in COLUMNS if column not in row]
    if missing:
        raise InputError(
            f"row {index}: column {missing[0]} is missing; needed are {', '.join(COLUMNS)}"
        )
    return Row(**row)
