"""Screws of joints: six numbers (omega; v), the angular part first, and the lines in space that
they stand for.

A screw is in the frame in which its direction and point are given; a chain wants those of its base.

revolute   (z; -z x p)             z a unit vector along the axis, p any point on it
helical    (z; -z x p + h z)       h the pitch in m per rad
prismatic  (0; z)                  a direction; it has no place
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..errors import InputError, ScrewError, ShapeError, quote
from ..groups.arrays import Array, numbers, shaped
from .checks import LONGEST, finite

__all__ = [
    "Axis",
    "axis_of",
    "checked",
    "helical",
    "pitch_of",
    "pitches_of",
    "prismatic",
    "revolute",
    "with_pitches",
]

UNIT = 1e-9  # how far from 1 the length of a screw's direction may be
_EXACT = 4.5e-16  # two units in the last place of 1
_NO_PITCH = 4e-15  # m per rad, relative to max(1 m, |v|): the rounding of omega . v


class Axis(NamedTuple):
    """The axis of a screw: unit direction (3,), its point nearest the origin (3,) in m, and the
    pitch in m per rad.

    Of a prismatic joint point is None and pitch infinite: it has a direction and no place.
    """

    direction: Array
    point: Array | None
    pitch: float


def _unit(axis: ArrayLike) -> Array:
    z = shaped(axis, (3,), "axis")
    if z.ndim != 1 or not np.isfinite(z).all():
        raise InputError(f"axis: expected one finite vector (3,), got {z.tolist()}")
    z = z / max(np.abs(z).max(), np.finfo(float).tiny)
    length = float(np.linalg.norm(z))
    if length == 0:
        raise ScrewError("axis: expected a direction, got the zero vector")
    return z / length


def revolute(axis: ArrayLike, point: ArrayLike) -> Array:
    """Screw (z; -z x p) of a revolute joint.

    Parameters: axis (3,), any length but zero; point (3,), m, any point on the axis. Returns: (6,),
    per rad.
    Raises: ScrewError, ShapeError, InputError.
    Accuracy: z within 6 u in each entry, its moment within 12 u |p|, u = 2^-53
    (tests/model/test_screw.py).
    Source: Park 1994, Section II.
    """
    return helical(axis, point, 0.0)


def helical(axis: ArrayLike, point: ArrayLike, pitch: float) -> Array:
    """Screw (z; -z x p + h z) of a helical joint.

    Parameters: axis (3,), any length but zero; point (3,), m; pitch h, m per rad. Returns: (6,),
    per rad.
    Raises: ScrewError, ShapeError, InputError.
    Accuracy: as `revolute`, with |p| + |h| in place of |p|. Source: Park 1994, Section II.
    """
    z = _unit(axis)
    p = shaped(point, (3,), "point")
    h = float(shaped(pitch, (), "pitch"))
    if p.ndim != 1 or not np.isfinite([*p, h]).all():
        raise InputError(
            f"expected a finite point (3,) and pitch, got point {p.tolist()} and pitch {h}"
        )
    # The cross product with a far point has the rounding of that distance along z too, which would
    # pass for a pitch.
    (S,) = with_pitches(np.concatenate([z, np.cross(p, z)])[None], np.zeros(1))
    S[3:] += h * z
    return S


def prismatic(axis: ArrayLike) -> Array:
    """Screw (0; z) of a prismatic joint.

    Parameters: axis (3,), any length but zero. Returns: (6,), per m. Raises: ScrewError,
    ShapeError, InputError. Accuracy: as z of `revolute`. Source: Park 1994, Section II.
    """
    return np.concatenate([np.zeros(3), _unit(axis)])


def pitch_of(screw: Array) -> float:
    """omega . v of a checked screw (6,) with omega != 0, in m per rad; exactly 0 where it is
    rounding.

    Parameters: screw (6,), as `checked` gives it. Returns: the pitch. Raises: nothing, it looks at
    nothing else. Accuracy: what is rounding is below 4e-15 max(1 m, |v|). Source: Park 1994,
    Section II.
    """
    pitch = float(screw[:3] @ screw[3:])
    if abs(pitch) <= _NO_PITCH * max(1.0, float(np.linalg.norm(screw[3:]))):
        return 0.0
    return pitch


def pitches_of(screws: Array, given: ArrayLike | None = None, names: tuple[str, ...] = ()) -> Array:
    """Pitches (n,) of checked screws (n, 6), in m per rad; 0 for a prismatic joint, which has none.

    Parameters: screws; given (n,), the pitches where they are known, else `pitch_of` finds them;
    names of the joints, for the message. Returns: a new array (n,). Raises: ShapeError; ScrewError
    for a pitch of a prismatic joint or one above 1e100; InputError for one that is not finite.
    Accuracy: as `pitch_of`. Source: Park 1994, Section II.
    """
    turns = np.any(screws[:, :3], axis=1)
    if given is None:
        return np.array(
            [pitch_of(S) if turning else 0.0 for S, turning in zip(screws, turns, strict=True)]
        )
    pitches = finite(given, "pitches")
    if pitches.shape != (len(screws),):
        raise ShapeError(
            f"pitches: expected shape ({len(screws)},), one number a joint, got {pitches.shape}"
        )
    for i, (pitch, turning) in enumerate(zip(pitches.tolist(), turns, strict=True)):
        where = f"pitches[{i}]" + (f" (joint {quote(names[i])})" if i < len(names) else "")
        if abs(pitch) > LONGEST:
            raise ScrewError(f"{where}: expected at most {LONGEST:g} m per rad, got {pitch:g}")
        if pitch and not turning:
            raise ScrewError(
                f"{where}: expected 0 for a prismatic joint, which has no pitch, got {pitch:g}"
            )
    return pitches


def with_pitches(screws: Array, pitches: Array) -> Array:
    """Screws (n, 6) on the same lines whose omega . v is the pitch, to their own rounding.

    A screw moved by a far pose comes back with the rounding of that distance, which would pass for
    a pitch. A screw that has its pitch already stays as it is, to the last bit, and so does a
    prismatic one.

    Parameters: screws (n, 6), |omega| = 1 or omega = 0; pitches (n,), m per rad. Returns: a new
    array (n, 6).
    Raises: nothing of its own. Accuracy: omega . v is within 4e-15 max(1 m, |v|) of the pitch.
    Source: Park 1994, Section II.
    """
    w = screws[:, :3]
    v = screws[:, 3:]
    missing = pitches - (w * v).sum(1)
    far = np.maximum(1.0, np.linalg.norm(v, axis=1))
    put = np.any(w, axis=1) & (np.abs(missing) > _NO_PITCH * far)
    out = screws.copy()
    out[put, 3:] += missing[put, None] * w[put]
    return out


def axis_of(screw: ArrayLike) -> Axis:
    """Direction, point and pitch of a screw: the inverse of `revolute`, `prismatic` and `helical`.

    The point is omega x v, the foot of the perpendicular from the origin.

    Parameters: screw (6,). Returns: Axis. Raises: ScrewError, ShapeError, InputError.
    Accuracy: direction within 4 u, point within 12 u |v|, the pitch as `pitch_of` has it
    (tests/model/test_screw.py). Source: Park 1994, Section II: "omega x v is a point on the axis"
    holds for |omega| = 1.
    """
    S = checked(shaped(screw, (6,), "screw")[None])[0]
    if not S[:3].any():
        return Axis(S[3:], None, np.inf)
    return Axis(S[:3], np.cross(S[:3], S[3:]), pitch_of(S))


def checked(screws: ArrayLike, names: tuple[str, ...] = ()) -> Array:
    """Screws (n, 6), all in one frame, with |omega| = 1, or omega = 0 and |v| = 1, to the last
    digit.

    Accepted where that holds to 1e-9; anything else is refused: rescaling it would rescale the
    user's q.

    Parameters: screws (n, 6); names of the joints, for the message. Returns: a new array (n, 6).
    Raises: ScrewError with the joint's name or index. Accuracy: within 2 u of unit length.
    Source: Park 1994, Lemmas 1 and 2, which need it.
    """
    S = numbers(screws, "screws").copy() + 0.0
    if S.shape == (0,):
        S = S.reshape(0, 6)
    if S.ndim != 2 or S.shape[1] != 6:
        raise ShapeError(
            f"screws: expected shape (n, 6), one row (omega; v) a joint, got {S.shape}"
        )
    for i, row in enumerate(S):
        where = f"screws[{i}]" + (f" (joint {names[i]!r})" if i < len(names) else "")
        if not (np.abs(row) <= LONGEST).all():
            raise ScrewError(
                f"{where}: expected finite numbers of at most {LONGEST:g}, got {row.tolist()}"
            )
        part = row[:3]
        what = "omega"
        if not part.any():
            part = row[3:]
            what = "v, where omega = 0,"
        length = float(np.linalg.norm(part))
        if abs(length - 1.0) > UNIT:
            raise ScrewError(
                f"{where}: {what} must have length 1 to {UNIT:g}, got {length:.12g} in {row.tolist()}"
            )
        if abs(length - 1.0) > _EXACT:
            row /= length  # all six, which leaves the line where it is
    return S
