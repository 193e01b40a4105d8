"""Records of arrays with one row an alignment, which are taken, joined and written row by row."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from ....groups import se3
from ....groups.arrays import Array


class Rows:
    """Base of records whose fields are arrays, or records of such, with a first axis in common."""

    def __getitem__(self, rows: Any) -> Self:
        fields = (field[rows] for field in vars(self).values())
        return type(self)(*fields)

    def __setitem__(self, rows: Any, others: Self) -> None:
        for name, field in vars(self).items():
            field[rows] = getattr(others, name)

    def joined(self, *others: Self) -> Self:
        """These rows and those of others behind them."""
        records = [vars(record).values() for record in (self, *others)]
        return type(self)(*map(_joined, *records))


def _joined(first: Any, *others: Any) -> Any:
    if isinstance(first, Rows):
        return first.joined(*others)
    return np.concatenate([first, *others])


@dataclass(frozen=True, eq=False)
class Alignments(Rows):
    """Alignments (P, z) of model b with model a, about the arms' centres.

    Attributes: P (m, 4, 4), b's base in a's; z (m, n), rad or m, the zero offsets of b's joints.
    """

    P: Array
    z: Array

    def __len__(self) -> int:
        return len(self.z)

    @classmethod
    def rigid(cls, P: Array, n: int) -> Self:
        """Poses of b's base without any zero offset of its n joints."""
        return cls(P, np.zeros((len(P), n)))

    def tiled(self, times: int) -> Self:
        """All alignments, one behind the other, so many times."""
        each = np.arange(len(self))
        return self[np.tile(each, times)]

    def moved(self, steps: Array) -> Self:
        """Alignments to which steps (m, 6 + n) lead: a motion of the base, changes of zero offsets."""
        motions = se3.exp(steps[:, :6])
        return type(self)(motions @ self.P, self.z + steps[:, 6:])
