"""Places of solutions within the limits, whole turns apart, and the order in which they are listed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.readings.coupled import beyond_own_limits
from ...ragged import Ragged

MOST = 4096
"""The most places that `all_revolutions=True` lists for one target."""

MANY = 2**63 - 1
"""The largest number of `n_revolutions`."""

_EDGE = 1e-12  # rad or m: a solution that is outside the limits by less is at them
_DIGITS = 9  # solutions that differ by less than rounding are sorted by later coordinates
_FEW = 256  # solutions that are sorted as they are
_WASTE = 4  # so many times the solutions' own memory is taken to sort them target by target


class Box(NamedTuple):
    """Domain of solutions: `limits` (m, 2), infinite where there are none, and `periods` (m,) of
    the coordinates, 0 for those that do not turn.
    """

    limits: Array
    periods: Array


class Places(NamedTuple):
    """Configurations q (S, m) within the limits, and the target of each.

    `number` (S,) says for how many places within the limits each stands, `within` (N,) how many
    solutions each target has there.
    """

    q: Array
    owner: np.ndarray
    number: np.ndarray
    within: np.ndarray

    def chosen(self, rows: np.ndarray) -> Places:
        """The configurations of these rows, and `within` as it is."""
        return self._replace(q=self.q[rows], owner=self.owner[rows], number=self.number[rows])


def turns_within(box: Box, Q: Array) -> tuple[Array, Array]:
    """The fewest and the most periods (S, m) that may be added to configurations within the limits.

    The fewest are more than the most where there is no way, infinite where there is no limit.
    """
    low, high = box.limits.T
    turns = box.periods > 0
    step = np.where(turns, box.periods, 1.0)
    lowest = low - _EDGE
    highest = high + _EDGE
    first = np.ceil((lowest - Q) / step)
    last = np.floor((highest - Q) / step)
    if not turns.all():
        inside = (lowest <= Q) & (highest >= Q)
        first = np.where(turns, first, ~inside)
        last = np.where(turns, last, 0.0)
    return first, last


def make_places(
    chain: Chain,
    found: Ragged,
    box: Box,
    by_joints: bool,
    all_revolutions: bool,
) -> Places:
    """The solutions within the limits; of those that are whole turns apart the one nearest to 0, or
    all. `by_joints` says whether the joints' own limits count, too. Raises: InputError.
    """
    first, last = turns_within(box, found.rows)
    kept = np.flatnonzero((first <= last).all(axis=1))
    Q = found.rows[kept]
    owner = found.owner[kept]
    first = first[kept]
    last = last[kept]
    turns = np.clip(0.0, first, last)
    bounded = np.isfinite(first) & np.isfinite(last)
    first = np.where(bounded, first, turns)
    last = np.where(bounded, last, turns)
    with np.errstate(over="ignore"):
        number = (last - first + 1).prod(axis=1)
    row = np.arange(len(Q))
    if all_revolutions or by_joints:
        _check_number(owner, number)
        row, turns = turns_between(first, last)
    moved = Q[row] + box.periods * turns
    q = np.clip(moved, *box.limits.T) + 0.0
    if by_joints:
        beyond = beyond_own_limits(chain, q)
        allowed = np.flatnonzero(~beyond.any(axis=1))
        number = np.bincount(row[allowed], minlength=len(Q))
        if not all_revolutions:
            _, first_of_row = np.unique(row[allowed], return_index=True)
            allowed = allowed[first_of_row]
        q = q[allowed]
        row = row[allowed]
    listed = np.bincount(row, minlength=len(Q)) > 0
    within = np.bincount(owner[listed], minlength=len(found))
    if all_revolutions:
        number = np.ones(len(Q))
    numbers = whole_numbers(number[row])
    return Places(q, owner[row], numbers, within)


def turns_between(first: Array, last: Array) -> tuple[np.ndarray, Array]:
    """All whole turns (S, m) from the first to the last (s, m), and the row to which each belongs;
    row after row, the fewest first.
    """
    choices = (last - first + 1).astype(np.int64)
    number = choices.prod(axis=1)
    row = np.repeat(np.arange(len(first)), number)
    before = np.cumsum(number) - number
    index = np.arange(len(row)) - before[row]
    turns = np.empty((len(row), first.shape[1]))
    for k in reversed(range(first.shape[1])):  # the digits of a number, the last one first
        choice = choices[row, k]
        turns[:, k] = first[row, k] + index % choice
        index = index // choice
    lengths = (turns * turns).sum(axis=1)
    order = np.lexsort((lengths, row))
    return row, turns[order]


def in_order(places: Places, ratios: Array) -> Places:
    """The places target by target, sorted by the values of their joints; what differs by rounding
    alone, by later coordinates.
    """
    order = _order(places.q * ratios, places.owner)
    return places.chosen(order)


def _order(q: Array, owner: np.ndarray) -> np.ndarray:
    """Order of solutions (S, m) that stand target by target."""
    keys = np.round(q, _DIGITS)
    targets = int(owner.max(initial=-1)) + 1
    counts = np.bincount(owner, minlength=targets)
    parts = Ragged(np.arange(len(q)), counts)
    most = int(parts.counts.max(initial=0))
    if len(q) < _FEW or targets * most > _WASTE * len(q):
        return np.lexsort((*keys.T[::-1], owner))
    # some short rows are sorted faster than one long one
    order = parts.padded(-1)
    there = order >= 0
    for key in keys.T[::-1]:
        values = np.where(order >= 0, key[order], np.inf)
        by_key = np.argsort(values, axis=1, kind="stable")
        order = np.take_along_axis(order, by_key, axis=1)
    return order[there]


def _check_number(owner: np.ndarray, number: Array) -> None:
    of_targets = np.bincount(owner, number, minlength=1)
    most = of_targets.max(initial=0)
    if most > MOST:
        raise InputError(
            f"all_revolutions: {most:.0f} places for one target, more than {MOST}; "
            "`n_revolutions` of the result tells"
        )


def whole_numbers(number: np.ndarray) -> np.ndarray:
    """Numbers of places as whole numbers, the largest ones as MANY."""
    whole = np.full(len(number), MANY)
    few = number < float(MANY)
    whole[few] = number[few]
    return whole
