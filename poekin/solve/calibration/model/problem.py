"""Calibration problem: errors of all measurements and their Jacobian, as functions of one vector of
parameters.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ....groups import se3
from ....groups.arrays import Array
from ....groups.vectors import applied, rotation_part, translation_part
from ....model.checks import read_only
from ..measurements.measurement import Measurement, Rows, rows_of
from ..terms.conditions import Conditions, in_order
from .error_model import ErrorModel
from .last_result import LastResult
from .parameters import frame_parameters
from .residual_vectors import ResidualVectors, places_and_errors
from .residuals import Residuals, residuals


class Linear(NamedTuple):
    """Errors (N, d) of a set of measurements, and their Jacobian (N, d, P) in all parameters."""

    errors: Array
    jacobian: Array


class MeasuredPoints(NamedTuple):
    """Measured points of all sets: rows (K,) of q, and places and errors (K, 3) in the base frame."""

    rows: Rows
    places: Array
    errors: Array


class _PosedSet(NamedTuple):
    """A set of measurements at rows of q, the poses there (N, 4, 4), and its unknown frames."""

    measured: Measurement
    rows: Rows
    T: Array
    frames: list[Array]

    @property
    def errors(self) -> Array:
        return self.measured.errors(self.T, self.frames)


class Problem:
    """An error model, the readings q, sets of measurements, and their unknown frames at p = 0.

    p is the model's parameters and then six of each unknown frame (T <- T e^eta, about its own
    axes) or three of a point. `basis` (N, m, k) of the model's terms, by default that of readings in
    the order in which they were taken.
    """

    def __init__(
        self,
        model: ErrorModel,
        q: Array,
        sets: Sequence[Measurement],
        initial_frames: Sequence[Array] | None = None,
        basis: Array | None = None,
    ) -> None:
        self.model = model
        self.q = q
        self.basis = self._in_order(q) if basis is None else basis
        self.sets = tuple(sets)
        self.rows = [rows_of(s, len(q)) for s in self.sets]
        numbers = range(len(self.sets))
        self._own = [_frame_names(k, self.sets) for k in numbers]
        named = list(model.parameters)
        self._parts: dict[str, slice] = {}
        for s, own in zip(self.sets, self._own, strict=True):
            for name, frame in zip(own, s.unknown_frames, strict=True):
                if name not in self._parts:
                    begin = len(named)
                    named += frame_parameters(name, frame.size)
                    self._parts[name] = slice(begin, len(named))
        self.frame_names = list(self._parts)
        self.parameters = tuple(named)
        lengths = [p.unit in ("m", "m/rad") for p in named]
        self.scale = np.where(lengths, model.nominal.reach, 1.0)
        self.scale[self._of_terms] = _inverse_sizes(self.basis)
        if initial_frames is None:
            initial_frames = self._guesses()
        self.initial_frames = tuple(initial_frames)
        self._last_errors = LastResult[list[Array]]()
        self._last_residuals = LastResult[Residuals]()

    def under(self, conditions: Conditions) -> Problem:
        """The problem with the readings under these conditions."""
        if not self.model.terms:
            return self
        basis = self.model.basis(self.q, conditions)
        return Problem(self.model, self.q, self.sets, self.initial_frames, basis)

    @property
    def _of_terms(self) -> slice:
        """Coefficients of the terms among the parameters."""
        end = self.model_size
        return slice(end - self.basis.shape[2], end)

    def _in_order(self, q: Array) -> Array:
        conditions = in_order(q, self.model.reference)
        return self.model.basis(q, conditions)

    def _guesses(self) -> list[Array]:
        """Initial guesses of the unknown frames: of those that sets share, by the largest set."""
        T = self.model.nominal.fk(self.q)
        found: dict[str, Array] = {}
        parts = list(zip(self.sets, self._own, self.rows, strict=True))
        parts.sort(key=lambda part: (not part[0].sees_arm, -len(part[0])))
        for s, own, rows in parts:
            known = []
            for name, unknown in zip(own, s.unknown_frames, strict=True):
                guess = found.get(name, unknown.guess)
                known.append(unknown._replace(guess=guess))
            with_guesses = s.with_unknown_frames(known)
            guesses = with_guesses.guesses(T[rows])
            found |= dict(zip(own, guesses, strict=True))
        return [found[name] for name in self.frame_names]

    @property
    def size(self) -> int:
        """P, the number of parameters."""
        return len(self.parameters)

    @property
    def model_size(self) -> int:
        """Number of the error model's parameters, which come first."""
        return len(self.model.parameters)

    @property
    def n_equations(self) -> int:
        """Number of measured values."""
        return sum(len(s) * s.width for s in self.sets)

    def frame_values(self, p: Array) -> dict[str, Array]:
        """The unknown frames (4, 4) and points (3,) at p, by name."""
        frames = zip(self.initial_frames, self._parts.items(), strict=True)
        return {name: _moved(frame, p[part]) for frame, (name, part) in frames}

    def frames_of_set(self, k: int, p: Array) -> list[Array]:
        """The unknown frames of set k at p."""
        return self._frames_of_sets(p)[k]

    def _frames_of_sets(self, p: Array) -> list[list[Array]]:
        """The unknown frames of each set at p."""
        values = self.frame_values(p)
        return [[values[name] for name in own] for own in self._own]

    def residuals(self, p: Array) -> Residuals:
        """Residuals of all measurements."""
        errors = self.errors(p)
        key = p.tobytes()
        return self._last_residuals(key, lambda: residuals(self.sets, self.rows, errors))

    def residual_vectors(self, old: MeasuredPoints, p: Array, previous: Array) -> ResidualVectors:
        """Residuals of all measured points before and after a fit, as vectors in the base frame;
        previous (N, m): the readings before.
        """
        new = self.points(p)
        T = self.poses(p)
        was = self.model.poses(self._of_model(p), previous) @ se3.inverse(T)
        came = was[new.rows]
        moves = new.places - (applied(rotation_part(came), new.places) + translation_part(came))
        R = rotation_part(T)[new.rows]
        return ResidualVectors(self.q, new.rows, new.places, old.errors, new.errors, R, moves)

    def points(self, p: Array) -> MeasuredPoints:
        """Places and errors of all measured points."""
        all_rows = []
        all_places = []
        all_errors = []
        for posed in self._at(p):
            places, errors = places_and_errors(posed.measured, posed.T, posed.frames)
            count = errors.shape[1]
            all_rows.append(np.repeat(posed.rows, count))
            all_places.append(places.reshape(-1, 3))
            all_errors.append(errors.reshape(-1, 3))
        parts = (all_rows, all_places, all_errors)
        return MeasuredPoints(*map(np.concatenate, parts))

    def _at(self, p: Array) -> Iterator[_PosedSet]:
        """Each set with the poses of its readings and its unknown frames."""
        T = self.poses(p)
        for k, frames in enumerate(self._frames_of_sets(p)):
            rows = self.rows[k]
            yield _PosedSet(self.sets[k], rows, T[rows], frames)

    def poses(self, p: Array) -> Array:
        """T_base_tip (N, 4, 4) at the readings."""
        return self.model.poses(self._of_model(p), self.q, self.basis)

    def reading_twists(self, p: Array) -> Array:
        """Space twists (N, 6, m) of the tip per unit of each coordinate."""
        return self.model.reading_twists(self._of_model(p), self.q, self.basis)

    def along_twists(self, p: Array, D: Array) -> list[Array]:
        """Derivatives (N, d, k) of the errors of each set along space twists (N, 6, k) of the tip."""
        found = []
        pairs = zip(self._at(p), self.errors(p), strict=True)
        for (s, rows, T, frames), errors in pairs:
            of_arm, _ = s.jacobian(T, frames, errors, D[rows])
            found.append(of_arm)
        return found

    def _of_model(self, p: Array) -> Array:
        """The error model's part of the parameters."""
        return p[: self.model_size]

    def errors(self, p: Array) -> list[Array]:
        """The errors (N, d) of each set."""
        key = p.tobytes()
        return self._last_errors(key, lambda: self._errors(p))

    def _errors(self, p: Array) -> list[Array]:
        return [read_only(posed.errors) for posed in self._at(p)]

    def linearised(self, p: Array) -> list[Linear]:
        """The errors of each set and their Jacobian."""
        errors = self.errors(p)
        jacobians = self.jacobians(p, errors=errors)
        return list(map(Linear, errors, jacobians))

    def jacobians(
        self,
        p: Array,
        q: Array | None = None,
        errors: Sequence[Array] | None = None,
    ) -> list[Array]:
        """The Jacobian (N, d, P) of each set, as if the model were right where no errors (N, d) are
        given: no measured value is used.

        q (K, m): other readings, at each of which every set measures.
        """
        rows = self.rows
        basis = self.basis
        if q is None:
            q = self.q
        else:
            basis = self._in_order(q)
            every = np.arange(len(q))
            rows = [every] * len(self.sets)
        if errors is None:
            pairs = zip(rows, self.sets, strict=True)
            shapes = [(len(here), s.width) for here, s in pairs]
            errors = list(map(np.zeros, shapes))
        T, D = self.model.poses_and_twists(self._of_model(p), q, basis)
        found = []
        for k, frames in enumerate(self._frames_of_sets(p)):
            here = rows[k]
            jacobian = self.sets[k].jacobian(T[here], frames, errors[k], D[here])
            parts = [self._parts[name] for name in self._own[k]]
            found.append(in_all_parameters(*jacobian, parts, p))
        return found

    def part(self, chosen: Rows) -> Problem:
        """The measurements at the readings of these rows of q only."""
        new = np.full(len(self.q), -1)
        new[chosen] = np.arange(len(chosen))
        sets = []
        for s, rows in zip(self.sets, self.rows, strict=True):
            kept = np.flatnonzero(new[rows] >= 0)
            kept_rows = new[rows[kept]]
            sets.append(s.subset(kept).with_rows(kept_rows))
        part = Problem(
            self.model,
            self.q[chosen],
            sets,
            self.initial_frames,
            self.basis[chosen],
        )
        part.scale = self.scale
        return part


def in_all_parameters(
    of_model: Array,
    of_frames: Sequence[Array],
    parts: Sequence[slice | list[int]],
    p: Array,
) -> Array:
    """Jacobian (N, d, P) in all parameters, of those in the model's and in each frame's part of p."""
    N, d, count = of_model.shape
    jacobian = np.zeros((N, d, len(p)))
    jacobian[..., :count] = of_model
    for part, of_frame in zip(parts, of_frames, strict=True):
        if of_frame.shape[2] == 6:
            # at T e^eta with eta != 0 the frame moves by J_r(eta) d eta
            of_frame = of_frame @ se3.right_jacobian(p[part])
        jacobian[..., part] = of_frame
    return jacobian


def _frame_names(k: int, sets: Sequence[Measurement]) -> list[str]:
    """Names of the unknown frames of set k: frames that sets share by what they call them."""
    which = ""
    if len(sets) > 1:
        which = f" of measurement set {k}"
    names = []
    for frame in sets[k].unknown_frames:
        whose = f" of {frame.shared!r}" if frame.shared else which
        names.append(frame.name + whose)
    return names


def _inverse_sizes(basis: Array) -> Array:
    """1 / root mean square (k,) of each coefficient's columns of the basis (N, m, k), or 1."""
    squares = np.sum(basis * basis, axis=(0, 1))
    sizes = np.sqrt(squares / len(basis))
    sizes[sizes == 0.0] = 1.0
    return 1.0 / sizes


def _moved(frame: Array, eta: Array) -> Array:
    """A pose moved about its own axes, or a point."""
    if len(eta) == 6:
        return frame @ se3.exp(eta)
    return frame + eta
