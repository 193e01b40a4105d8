"""Solutions that were found for many targets, and how often."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ...ragged import Ragged
from .self_motion import SelfMotion

_OF_TARGETS = ("ends", "restarts", "full", "singular")  # of `Found`: (N,), one of each target


@dataclass(frozen=True, eq=False)
class Found:
    """Solutions found for N targets, limits apart, target after target.

    Attributes: q, the solutions of each target (S, m); hits (S,), how often each was found; ends
    (N,), how many tries ended at any of them; restarts (N,), 0 where the given starts were enough;
    full (N,), whether there was no room for more; singular (N,), whether any of them is singular;
    self_motion, by number of the target the continuum of solutions, of which one is listed.
    """

    q: Ragged
    hits: Array
    ends: np.ndarray
    restarts: np.ndarray
    full: np.ndarray
    singular: np.ndarray
    self_motion: Mapping[int, SelfMotion] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.q)

    def least_hits(self) -> Array:
        """Hits (N,) of the solution of each target that was found least often; 0 without any."""
        return reduce_parts(np.minimum, self.hits, self.q, 0.0)

    def kept(self, rows: np.ndarray) -> Found:
        """Without the solutions whose entry in `rows` (S,) is False."""
        q = self.q
        counts = np.bincount(q.owner[rows], minlength=len(self))
        return replace(self, q=Ragged(q.rows[rows], counts), hits=self.hits[rows])

    def placed(self, numbers: np.ndarray, count: int) -> Found:
        """The solutions as those of `count` targets, of which these have the `numbers` (N,), in
        order; the others have none.
        """
        self_motion = {}
        for k, motion in self.self_motion.items():
            self_motion[int(numbers[k])] = motion
        counts = scattered([numbers], [self.q.counts], count)
        return Found(
            q=Ragged(self.q.rows, counts),
            hits=self.hits,
            self_motion=self_motion,
            **{name: scattered([numbers], [getattr(self, name)], count) for name in _OF_TARGETS},
        )

    def tally(self, sure: bool) -> Tally:
        """Numbers of each target; `sure`, whether a solver of the arm itself found them."""
        return Tally(
            found=self.q.counts,
            least_hits=self.least_hits(),
            ends=self.ends,
            restarts=self.restarts,
            full=self.full,
            sure=np.full(len(self), sure),
            self_motion=self.self_motion,
        )


class Tally(NamedTuple):
    """Numbers of the solutions found for N targets, limits apart, as in `Found`: how many, and how
    often the one that was found least often; `sure` (N,), whether without a search these are all.
    """

    found: np.ndarray
    least_hits: Array
    ends: np.ndarray
    restarts: np.ndarray
    full: np.ndarray
    sure: np.ndarray
    self_motion: Mapping[int, SelfMotion]


def joined(parts: Sequence[Found], dof: int) -> Found:
    """Solutions of the targets of all parts, one part after the other."""
    parts = [_nothing(dof), *parts]
    self_motion = {}
    start = 0
    for part in parts:
        for k, motion in part.self_motion.items():
            self_motion[int(k + start)] = motion
        start += len(part)
    rows = np.concatenate([part.q.rows for part in parts])
    counts = np.concatenate([part.q.counts for part in parts])
    return Found(
        q=Ragged(rows, counts),
        hits=np.concatenate([part.hits for part in parts]),
        self_motion=self_motion,
        **{name: np.concatenate([getattr(part, name) for part in parts]) for name in _OF_TARGETS},
    )


def replaced(found: Found, numbers: np.ndarray, others: Found) -> Found:
    """`found` with `others` in the place of the targets of these numbers, in order."""
    if not len(numbers):
        return found
    kept = ~np.isin(np.arange(len(found)), numbers)
    rest = found.kept(kept[found.q.owner])
    new = others.placed(numbers, len(found))
    owner = np.concatenate([rest.q.owner, new.q.owner])
    order = np.argsort(owner, kind="stable")
    rows = np.concatenate([rest.q.rows, new.q.rows])
    hits = np.concatenate([rest.hits, new.hits])
    self_motion = {k: motion for k, motion in found.self_motion.items() if kept[k]}
    self_motion.update(new.self_motion)
    return Found(
        q=Ragged(rows[order], rest.q.counts + new.q.counts),
        hits=hits[order],
        self_motion=self_motion,
        **{name: np.where(kept, getattr(found, name), getattr(new, name)) for name in _OF_TARGETS},
    )


def reduce_parts(
    function: np.ufunc,
    values: Array,
    parts: Ragged,
    empty: float,
) -> Array:
    """function.reduce of the values (S, ...) of each part, along them; `empty` where it has none."""
    shape = (len(parts), *values.shape[1:])
    whole = np.full(shape, empty)
    some = np.flatnonzero(parts.counts)
    if len(some):
        starts = parts.ends[some]
        whole[some] = function.reduceat(values, starts, axis=0)
    return whole


def scattered(parts: Sequence[np.ndarray], values: Sequence[np.ndarray], count: int) -> np.ndarray:
    """An array of `count` entries, those of each part's numbers from its values."""
    whole = np.zeros(count, values[0].dtype)
    for numbers, own in zip(parts, values, strict=True):
        whole[numbers] = own
    return whole


def _nothing(dof: int) -> Found:
    """No solutions of no targets."""
    none = np.zeros(0, int)
    no = np.zeros(0, bool)
    q = Ragged(np.empty((0, dof)), none)
    return Found(q, np.empty(0), none, none, no, no)
