"""Term: one kind of non-geometric error, as data and a basis function."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, ShapeError, escape_unprintable
from ....groups.arrays import Array, numbers
from ....model.checks import finite
from ..model.parameters import Parameter
from .conditions import Conditions
from .scalars import Columns, of_rows

Owners = NDArray[np.intp]
Basis = Callable[[Array, Conditions], Array]


class Formula(NamedTuple):
    """Basis of a term for scalars of any kind, and the coordinates that its columns are added to."""

    owners: Owners
    columns: Columns


@dataclass(frozen=True)
class Term:
    """Non-geometric error of the readings: q_true = q + B(q, conditions) c.

    Parameters
    ----------
    name : str
        Its name.
    parameters : tuple of Parameter
        The k coefficients c: whose they are, what they are, and their unit.
    basis : callable
        B (N, m, k) of readings q (N, m) and of their `Conditions`.
    formula : Formula, optional
        The same for scalars, of which `Calibration.emit` writes code; poekin's own terms have one.

    Raises
    ------
    InputError
        Without a name or coefficients.

    Examples
    --------
    A gear whose error repeats 100 times a turn of the first joint:

    >>> import numpy as np
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> def ripple(q, conditions):
    ...     B = np.zeros((*q.shape, 2))
    ...     B[:, 0, 0] = np.sin(100 * q[:, 0])
    ...     B[:, 0, 1] = np.cos(100 * q[:, 0])
    ...     return B
    >>> owner = arm.q_names[0]
    >>> coefficients = [pk.calibration.Parameter(owner, f"ripple, {f}", "rad") for f in ("sin", "cos")]
    >>> gear = pk.calibration.Term("ripple", tuple(coefficients), ripple)
    >>> made = pk.calibration.simulated(arm, 40, seed=2)
    >>> found = pk.calibrate(arm, made.q, made.measurements, parameters=("screws", "home", gear))
    >>> found.parameters[-1].name
    'shoulder_pan_joint: ripple, cos'
    """

    name: str
    parameters: tuple[Parameter, ...]
    basis: Basis = field(repr=False, compare=False)
    formula: Formula | None = field(default=None, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not self.name or not self.parameters:
            raise InputError("Term: expected a name and at least one coefficient")


def checked_basis(term: Term, q: Array, conditions: Conditions) -> Array:
    """B (N, m, k) of a term at readings q (N, m). Raises: ShapeError, InputError."""
    what = f"basis of the term '{escape_unprintable(term.name, 60)}'"
    B = numbers(term.basis(q, conditions), what)
    shape = (*q.shape, len(term.parameters))
    if B.shape != shape:
        raise ShapeError(f"{what}: expected shape {shape}, got {B.shape}")
    return finite(B, what)


def name_of(kind: str | Term) -> str:
    """Name of a kind of parameters."""
    if isinstance(kind, Term):
        return kind.name
    return kind


def make_term(
    name: str,
    parameters: Iterable[Parameter],
    owners: Owners,
    columns: Columns,
) -> list[Term]:
    """The term whose coefficient j multiplies number j of the columns at coordinate owners[j]; none
    without coefficients.
    """
    named = tuple(parameters)
    if not named:
        return []

    def basis(q: Array, conditions: Conditions) -> Array:
        N, dof = q.shape
        B = np.zeros((N, dof, len(owners)))
        for j, values in enumerate(columns(of_rows(q, conditions))):
            B[:, owners[j], j] = values
        return B

    return [Term(name, named, basis, Formula(owners, columns))]
