"""Screws of a chain's joints as they are given: checked, and made exact to the last digit."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...errors import ScrewError, ShapeError, quote
from ...groups.arrays import Array, numbers
from ...groups.vectors import angular_part, directions, linear_part, norms
from ..checks import LONGEST, finite
from .remedies import UNIT, matrix_among, other_reading

_EXACT = 4.5e-16  # two units in the last place of 1
_NO_PITCH = 4e-15  # m per rad, relative to max(1 m, |v|): the rounding of omega . v


def unit_screws(
    screws: ArrayLike,
    names: tuple[str, ...] = (),
    what: str = "screws",
) -> Array:
    """Screws (n, 6) with |omega| = 1, or omega = 0 and |v| = 1, to the last digit.

    Accepted where that holds to 1e-9; anything else is refused, as rescaling it would rescale q.
    Raises: ShapeError; ScrewError with the joint's name or index. Both name the remedy, if another
    reading of the numbers fits.
    """
    S = _rows(screws, what)
    for i in np.flatnonzero(~(np.abs(S) <= LONGEST).all(axis=1)).tolist():
        raise ScrewError(
            f"{_place(what, i, names)}: expected finite numbers of at most {LONGEST:g}, got {S[i].tolist()}"
        )
    lengths = norms(directions(S))
    off = np.abs(lengths - 1.0)
    for i in np.flatnonzero(off > UNIT).tolist():
        name = "omega" if angular_part(S[i]).any() else "v, where omega = 0,"
        remedy = other_reading(S, what) or other_reading(S[i], f"{what}[{i}]")
        raise ScrewError(
            f"{_place(what, i, names)}: {name} must have length 1 to {UNIT:g}, got {lengths[i]:.12g} in"
            f" {S[i].tolist()}{remedy}"
        )
    inexact = off > _EXACT
    S[inexact] /= lengths[inexact, None]  # all six, which leaves the line where it is
    return S


def _place(what: str, i: int, names: tuple[str, ...]) -> str:
    """Name of row i in messages."""
    return f"{what}[{i}]" + (f" (joint {quote(names[i])})" if i < len(names) else "")


def _rows(screws: ArrayLike, what: str) -> Array:
    """A copy (n, 6) of the numbers, no zero with a sign."""
    try:
        S = numbers(screws, what).copy() + 0.0
    except ShapeError as fault:
        raise ShapeError(f"{fault}{matrix_among(screws)}") from fault.__cause__
    if S.shape == (0,):
        S = S.reshape(0, 6)
    if S.ndim == 2 and S.shape[1] == 6:
        return S
    remedy = ""
    if S.ndim == 2:
        remedy = other_reading(S, what)
    if not remedy:
        remedy = matrix_among([S] if S.ndim == 2 else S)
    raise ShapeError(
        f"{what}: expected shape (n, 6), one row (omega; v) a joint, got {S.shape}{remedy}"
    )


def pitch_of(screws: Array) -> Array:
    """omega . v (...) of unit screws (..., 6), in m per rad; exactly 0 where it is rounding."""
    w = angular_part(screws)
    v = linear_part(screws)
    pitches = (w * v).sum(axis=-1)
    is_rounding = np.abs(pitches) <= _NO_PITCH * np.maximum(1.0, norms(v))
    return np.where(is_rounding, 0.0, pitches)


def pitches_of(
    screws: Array,
    given: ArrayLike | None = None,
    names: tuple[str, ...] = (),
) -> Array:
    """Pitches (n,) of unit screws (n, 6), in m per rad; 0 for a prismatic joint, which has none.

    Raises: ShapeError; ScrewError for a pitch of a prismatic joint or one above 1e100; InputError
    for one that is not finite.
    """
    if given is None:
        return pitch_of(screws)
    pitches = finite(given, "pitches")
    if pitches.shape != (len(screws),):
        raise ShapeError(
            f"pitches: expected shape ({len(screws)},), one number a joint, got {pitches.shape}"
        )
    turns = np.any(angular_part(screws), axis=1)
    for i, (pitch, turning) in enumerate(zip(pitches.tolist(), turns, strict=True)):
        if abs(pitch) > LONGEST:
            where = _place("pitches", i, names)
            raise ScrewError(f"{where}: expected at most {LONGEST:g} m per rad, got {pitch:g}")
        if pitch and not turning:
            where = _place("pitches", i, names)
            raise ScrewError(
                f"{where}: expected 0 for a prismatic joint, which has no pitch, got {pitch:g}"
            )
    return pitches


def with_pitches(screws: Array, pitches: Array) -> Array:
    """Screws (n, 6) on the same lines whose omega . v is the pitch, to their own rounding.

    A screw moved by a far pose comes back with the rounding of that distance, which would pass for
    a pitch. A screw that has its pitch already stays as it is, to the last bit, and so does a
    prismatic one. omega . v is then within 4e-15 max(1 m, |v|) of the pitch.
    """
    w = angular_part(screws)
    v = linear_part(screws)
    missing = pitches - (w * v).sum(axis=1)
    far = np.maximum(1.0, norms(v))
    put = w.any(axis=1) & (np.abs(missing) > _NO_PITCH * far)
    out = screws.copy()
    out[put, 3:] += missing[put, None] * w[put]
    return out
