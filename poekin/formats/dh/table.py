"""Tables of Denavit-Hartenberg parameters: convention, offsets, directions, base and tool."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from ... import html_page
from ...checks import REQUIRED, choice
from ...errors import InputError, ShapeError, quote, safe_repr
from ...groups.arrays import Array
from ...model.checks import bounds, distinct_names, finite, one_pose, read_only
from ...model.provenance import warn
from ...model.readings.statements import Statements, canonical
from ..common.limits import UNBOUNDED, Interval

Convention = Literal["standard", "modified"]
CONVENTIONS: tuple[Convention, ...] = get_args(Convention)
RowKind = Literal["revolute", "prismatic"]
KINDS: tuple[RowKind, ...] = get_args(RowKind)
COLUMNS = ("theta", "d", "a", "alpha")
PRODUCTS = {
    "standard": "Rz(theta) Tz(d) Tx(a) Rx(alpha)",
    "modified": "Rx(alpha) Tx(a) Rz(theta) Tz(d)",
}
"""Transform from one frame to the next, of each convention."""
_MEANING = (
    f"; standard (Paul, distal) is {PRODUCTS['standard']},"
    f" modified (Craig, proximal) is {PRODUCTS['modified']}"
)


@dataclass(frozen=True)
class Row:
    """Row of a Denavit-Hartenberg table: one joint and the transform that it moves.

    A revolute joint's angle is theta + x, a prismatic joint's length d + x, with -x in place of x
    where `flip` is true. A joint's offset stands in theta or d. Of a modified table a and alpha are
    a_{i-1} and alpha_{i-1}.

    Parameters
    ----------
    theta : float, default 0.0
        Angle about z at x = 0, rad.
    d : float, default 0.0
        Length along z at x = 0, m.
    a : float, default 0.0
        Length along x, m.
    alpha : float, default 0.0
        Angle about x, rad.
    kind : {"revolute", "prismatic"}, default "revolute"
        Kind of the joint.
    flip : bool, default False
        Whether the joint moves by -x.
    name : str, default ""
        Name of the joint; "" becomes joint1, joint2, ... in a table.
    limits : tuple of two floats, default (-inf, inf)
        Lower and upper limit of x, rad or m.
    """

    theta: float = 0.0
    d: float = 0.0
    a: float = 0.0
    alpha: float = 0.0
    kind: RowKind = "revolute"
    flip: bool = False
    name: str = ""
    limits: Interval = UNBOUNDED


@dataclass(frozen=True, init=False, eq=False, repr=False, slots=True)
class Table:
    """Denavit-Hartenberg parameters of n joints, frozen.

    Parameters
    ----------
    convention : {"standard", "modified"}
        Standard (Paul, distal) is f = base prod [Rz(theta) Tz(d) Tx(a) Rx(alpha)] tool; modified
        (Craig, proximal) is f = base prod [Rx(alpha) Tx(a) Rz(theta) Tz(d)] tool.
    rows : sequence of Row or dict
        One a joint; a dict holds the fields of a `Row`.
    base : (4, 4) array_like, optional
        Pose of the first frame in the base frame, m; by default the identity.
    tool : (4, 4) array_like, optional
        Pose of the tool in the last frame, m; by default the identity.
    name : str, default "arm"
        Name of the arm.
    coupling : str or sequence of str, optional
        Statements such as "J3 = J2 + J3", by which a joint's x follows several readings; see
        `Chain.coupled`.

    Attributes
    ----------
    theta, alpha : (n,) ndarray
        Angles about z and x, rad.
    d, a : (n,) ndarray
        Lengths along z and x, m.
    kinds : tuple of str
        "revolute" or "prismatic".
    flips : tuple of bool
        Whether a joint moves by -x.
    names : tuple of str
        Names of the joints.
    limits : (n, 2) ndarray
        Lower and upper limits of x, rad or m.
    coupling : tuple of str
        Statements of the coupling, none where each joint's x is its reading.

    Raises
    ------
    InputError
        If the convention, a kind, a name or a number is none, or a dict has other keys.
    ShapeError
        If `rows` is no sequence of rows, or base or tool has another shape.
    PoseError
        If base or tool is no pose.

    Warns
    -----
    PoekinWarning
        If an angle of more than a turn looks like degrees.

    Notes
    -----
    Source: Paul 1981 and Craig 1986, as Park 1994, Section II, writes them.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> rows = [pk.dh.Row(a=0.5, limits=(-2, 2)), pk.dh.Row(a=0.3)]
    >>> table = pk.dh.Table("standard", rows, name="planar")
    >>> table
    <standard DH table 'planar', 2 joints
      'joint1': theta 0 + x  d 0  a 0.5  alpha 0
      'joint2': theta 0 + x  d 0  a 0.3  alpha 0>
    >>> pk.dh.to_chain(table).fk([0, np.pi / 2]).round(3)[:2, 3]
    array([0.5, 0.3])
    """

    convention: Convention
    theta: Array
    d: Array
    a: Array
    alpha: Array
    kinds: tuple[RowKind, ...]
    flips: tuple[bool, ...]
    names: tuple[str, ...]
    limits: Array
    base: Array
    tool: Array
    name: str
    coupling: tuple[str, ...]

    def __init__(
        self,
        convention: Convention = REQUIRED,
        rows: Sequence[Row | dict[str, Any]] = REQUIRED,
        *,
        base: ArrayLike | None = None,
        tool: ArrayLike | None = None,
        name: str = "arm",
        coupling: Statements = (),
    ) -> None:
        check_convention(convention)
        if isinstance(rows, (str, bytes, dict)) or not isinstance(rows, Iterable):
            raise ShapeError(
                f"rows: expected a list of Rows or dicts, one a joint, got {safe_repr(rows)}"
            )
        made = [_row(row, i) for i, row in enumerate(rows)]
        for i, row in enumerate(made):
            choice(row.kind, KINDS, f"row {i}: kind")
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
            "coupling": canonical(coupling, names),
        }
        for column in COLUMNS:
            values[column] = read_only(finite([getattr(row, column) for row in made], column))
        for column in ("theta", "alpha"):
            large = np.flatnonzero(np.abs(values[column]) > 2 * math.pi)
            if large.size:
                angle = values[column][large[0]]
                message = (
                    f"table {quote(str(name))}: {column} = {angle:g} of joint {quote(names[large[0]])}"
                    f" is more than a turn: degrees? Expected are rad, as np.radians makes them"
                )
                warn(message)
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

    def _data(self) -> tuple[Any, ...]:
        return tuple(getattr(self, field.name) for field in fields(self))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Table):
            return NotImplemented
        return all(np.array_equal(a, b) for a, b in zip(self._data(), other._data(), strict=True))

    def __hash__(self) -> int:
        return hash((self.convention, self.kinds, self.names, tuple(self.theta.tolist())))

    def __reduce__(self) -> tuple[Any, ...]:
        make = functools.partial(
            Table,
            base=self.base,
            tool=self.tool,
            name=self.name,
            coupling=self.coupling,
        )
        return make, (self.convention, self.rows)

    def _repr_html_(self) -> str:
        rows = []
        for r in self.rows:
            cells = (r.name, r.kind, *map(_shown, (r.theta, r.d, r.a, r.alpha)))
            rows.append(html_page.row(cells, _CLASSES))
        words = f"{self.convention} DH table {self.name}"
        return html_page.caption(words) + html_page.table(_HEADS, _CLASSES, rows)

    def __repr__(self) -> str:
        lines = [f"<{self.convention} DH table {quote(self.name)}, {len(self)} joints"]
        lines += [
            f"  {quote(r.name)}: theta {_shown(r.theta)}{_moves(r, 'revolute')}"
            f"  d {_shown(r.d)}{_moves(r, 'prismatic')}  a {_shown(r.a)}  alpha {_shown(r.alpha)}"
            for r in self.rows
        ]
        lines += [f"  coupling: {statement}" for statement in self.coupling]
        return "\n".join(lines) + ">"


_HEADS = ("joint", "kind", "θ, rad", "d, m", "a, m", "α, rad")
_CLASSES = ("word", "word", "number", "number", "number", "number")


def check_convention(convention: object) -> None:
    """Refuse what is no convention of DH parameters. Raises: InputError."""
    choice(convention, CONVENTIONS, "convention", _MEANING)


def check_table(table: object, what: str) -> None:
    """Refuse what is no table, in a function called `what`. Raises: InputError."""
    if not isinstance(table, Table):
        raise InputError(
            f"{what}: expected a dh.Table, got {safe_repr(table)}; dh.read(path), dh.published(name)"
            " and dh.from_chain(...).table make one"
        )


def _pose(pose: ArrayLike | None, what: str) -> Array:
    if pose is None:
        return read_only(np.eye(4))
    return read_only(one_pose(pose, what))


def _shown(value: float) -> str:
    """Nine digits of a number, and 0 for what is rounding: 1e-12 rad or m and less."""
    if abs(value) < 1e-12:
        return "0"
    return f"{value:.9g}"


def _moves(row: Row, kind: str) -> str:
    """Sign of x behind the parameter that moves a joint of that kind; nothing for other joints."""
    if row.kind != kind:
        return ""
    return " - x" if row.flip else " + x"


def _row(row: Any, index: int) -> Row:
    if isinstance(row, Row):
        return row
    if not isinstance(row, dict):
        raise ShapeError(
            f"row {index}: expected a Row or a dict, as in Row(theta, d, a, alpha) [rad, m],"
            f" got {type(row).__name__}"
        )
    unknown = [key for key in row if key not in Row.__dataclass_fields__]
    if unknown:
        raise InputError(
            f"row {index}: no column {quote(unknown[0])}; there are"
            f" {', '.join(Row.__dataclass_fields__)}; a joint's offset stands in theta or d"
        )
    missing = [column for column in COLUMNS if column not in row]
    if missing:
        raise InputError(
            f"row {index}: column {missing[0]} is missing; needed are {', '.join(COLUMNS)}"
        )
    return Row(**row)
