"""A calibration as numbers: errors of all measurements and their slopes, as functions of one vector
of parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ....errors import InputError, ShapeError, safe_repr
from ....groups import se3
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.checks import read_only
from ....model.coordinates import coordinates
from ..measurements.measurement import Indices, Measurement
from ..measurements.points import Points
from ..measurements.poses import Poses
from .parameters import Arm, Parameter

_TURNS = ("turn about x", "turn about y", "turn about z")
_SHIFTS = ("shift along x", "shift along y", "shift along z")


class Linear(NamedTuple):
    """Errors (N, d) of a set of measurements, and their slopes (N, d, P) in all parameters."""

    errors: Array
    slopes: Array


class Problem:
    """An arm, the readings q, sets of measurements, and where their unknown frames are at p = 0.

    p is the arm's parameters and then six of each unknown frame (T <- T e^eta, about its own axes)
    or three of a point.
    """

    def __init__(
        self, arm: Arm, q: Array, sets: Sequence[Measurement], places: Sequence[Array] | None = None
    ):
        self.arm, self.q, self.sets = arm, q, tuple(sets)
        self.rows: list[Indices] = [
            np.arange(len(q)) if s.rows is None else s.rows for s in self.sets
        ]
        unknowns: dict[str, int] = {}
        self._own: list[list[int]] = []  # which of all unknown frames those of each set are
        for k, s in enumerate(self.sets):
            which = f" of measurement set {k}" if len(self.sets) > 1 else ""
            names = [
                u.name + (which if u.shared is None else f" of {u.shared!r}") for u in s.unknowns
            ]
            unknowns |= {name: u.size for name, u in zip(names, s.unknowns, strict=True)}
            self._own.append([list(unknowns).index(name) for name in names])
        self.place_names, sizes = list(unknowns), list(unknowns.values())
        named = list(arm.parameters)
        for name, size in unknowns.items():
            turns = _TURNS if size == 6 else ()
            named += [Parameter(name, what, "rad") for what in turns] + [
                Parameter(name, s, "m") for s in _SHIFTS
            ]
        self.parameters = tuple(named)
        self._ends = len(arm.parameters) + np.concatenate([[0], np.cumsum(sizes)]).astype(int)
        self.scale = np.where([p.unit in ("m", "m/rad") for p in named], arm.nominal.reach, 1.0)
        self.places = self._guesses() if places is None else tuple(places)
        self._erred: tuple[bytes, list[Array]] | None = None

    def _guesses(self) -> tuple[Array, ...]:
        """First values of the unknown frames: of what sets share, by the largest of them."""
        T, found = self.arm.nominal.fk(self.q), dict[int, Array]()
        for k in sorted(range(len(self.sets)), key=lambda k: -len(self.sets[k])):
            s, own = self.sets[k].taken(np.arange(len(self.sets[k]))), self._own[k]
            known = tuple(
                u._replace(guess=found.get(i, u.guess))
                for i, u in zip(own, s.unknowns, strict=True)
            )
            object.__setattr__(s, "unknowns", known)
            found |= dict(zip(own, s.guesses(T[self.rows[k]]), strict=True))
        return tuple(found[i] for i in range(len(found)))

    @property
    def size(self) -> int:
        """P, the number of parameters."""
        return len(self.parameters)

    @property
    def arm_size(self) -> int:
        """How many of the parameters, the first ones, are the arm's."""
        return len(self.arm.parameters)

    @property
    def numbers(self) -> int:
        """How many numbers were measured."""
        return sum(len(s) * s.width for s in self.sets)

    def placed(self, p: Array) -> list[Array]:
        """The unknown frames (4, 4) and points (3,) at p."""
        moves = [p[a:b] for a, b in zip(self._ends[:-1], self._ends[1:], strict=True)]
        return [
            place @ se3.exp(eta) if len(eta) == 6 else place + eta
            for place, eta in zip(self.places, moves, strict=True)
        ]

    def errors(self, p: Array) -> list[Array]:
        """The errors (N, d) of each set. The last are kept: a fit asks for each several times."""
        kept, key = self._erred, p.tobytes()
        if kept is not None and kept[0] == key:
            return kept[1]
        T, places = self.arm.poses(p[: self.arm_size], self.q), self.placed(p)
        found = [
            read_only(s.errors(T[rows], [places[i] for i in own]))
            for s, rows, own in zip(self.sets, self.rows, self._own, strict=True)
        ]  # fmt: skip
        self._erred = key, found
        return found

    def linearised(self, p: Array) -> list[Linear]:
        """The errors of each set and their slopes."""
        T, D = self.arm.changes(p[: self.arm_size], self.q)
        seen = [(T[rows], D[rows]) for rows in self.rows]
        return self._linearised(p, seen, measured=True)

    def slopes(self, p: Array, q: Array | None = None) -> list[Array]:
        """The slopes (N, d, P) of each set as they would be if the model were right: no measured
        number is looked at.

        q (K, m): other readings, at each of which every set measures.
        """
        T, D = self.arm.changes(p[: self.arm_size], self.q if q is None else q)
        seen = (
            [(T[rows], D[rows]) for rows in self.rows] if q is None else [(T, D)] * len(self.sets)
        )
        return [linear.slopes for linear in self._linearised(p, seen, measured=False)]

    def _linearised(
        self, p: Array, seen: Sequence[tuple[Array, Array]], measured: bool
    ) -> list[Linear]:
        places, found = self.placed(p), []
        for k, (s, (T, D), own) in enumerate(zip(self.sets, seen, self._own, strict=True)):
            mine = [places[i] for i in own]
            errors = self.errors(p)[k] if measured else np.zeros((len(T), s.width))
            arm, others = s.slopes(T, mine, errors, D)
            slopes = np.zeros((*errors.shape, self.size))
            slopes[..., : self.arm_size] = arm
            for i, slope in zip(own, others, strict=True):
                a, b = self._ends[i], self._ends[i + 1]
                # at T e^eta with eta != 0 the frame moves by J_r(eta) d eta
                slopes[..., a:b] = slope @ se3.right_jacobian(p[a:b]) if b - a == 6 else slope
            found.append(Linear(errors, slopes))
        return found

    def at(
        self, q: Array, sets: Sequence[Measurement], places: Sequence[Array] | None = None
    ) -> Problem:
        """The same arm and parameters with other readings and measurements."""
        return Problem(self.arm, q, sets, self.places if places is None else places)

    def part(self, chosen: Indices) -> Problem:
        """The measurements at the readings of these rows of q only."""
        new = np.full(len(self.q), -1)
        new[chosen] = np.arange(len(chosen))
        sets = []
        for s, rows in zip(self.sets, self.rows, strict=True):
            kept = np.flatnonzero(new[rows] >= 0)
            part = s.taken(kept)
            object.__setattr__(part, "rows", new[rows[kept]])
            sets.append(part)
        return self.at(self.q[chosen], sets)


def readings(arm: Chain, q: object) -> Array:
    """q (N, m), finite, N > 0. Raises: ShapeError with the number of joints; InputError with the
    row not finite.
    """
    array = coordinates(q, arm.q_names)
    if array.ndim != 2:
        raise ShapeError(
            f"q: expected readings (N, {arm.dof}), one row a measurement, got shape {array.shape}"
        )
    if not len(array):
        raise InputError("q: expected readings, got none")
    good = np.isfinite(array).all(1)
    if not good.all():
        raise InputError(
            f"q[{int(np.argmin(good))}]: expected finite numbers, got {array[np.argmin(good)].tolist()}"
        )
    return array


def sets_of(measurements: Any, count: int) -> list[Measurement]:
    """Measurements as a list of sets; a bare array (N, 4, 4) is poses, (N, 3) points. Each fits the
    rows of q.
    """
    if isinstance(measurements, Measurement):
        sets = [measurements]
    elif (
        isinstance(measurements, (list, tuple))
        and measurements
        and isinstance(measurements[0], Measurement)
    ):
        sets = list(measurements)
    else:
        shape = _shape(measurements)
        kind = {(4, 4): Poses, (3,): Points}.get(shape[1:])
        if kind is None:
            raise ShapeError(
                "measurements: expected Poses, Points, Distances, EyeInHand, EyeToHand, a list of them, or an array"
                f" (N, 4, 4) of poses or (N, 3) of points, got {type(measurements).__name__} of shape {shape}"
            )
        sets = [kind(measurements)]
    for k, s in enumerate(sets):
        where = f"measurements[{k}]" if len(sets) > 1 else "measurements"
        if not isinstance(s, Measurement):
            raise InputError(
                f"{where}: expected Poses, Points, Distances, EyeInHand or EyeToHand, got {safe_repr(s)}"
            )
        if s.rows is None and len(s) != count:
            raise ShapeError(
                f"{where}: {len(s)} {s.what} for {count} rows of q; say which with rows="
            )
        if s.rows is not None and len(s) and s.rows.max() >= count:
            raise InputError(f"{where}: rows names row {int(s.rows.max())} of q, which has {count}")
        if not len(s):
            raise InputError(f"{where}: expected {s.what}, got none")
    return sets


def _shape(values: Any) -> tuple[int, ...]:
    """The shape of an array; () of what is none, such as a list of unlike things."""
    try:
        return np.shape(values)
    except ValueError:
        return ()
