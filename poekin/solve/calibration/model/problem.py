"""Calibration problem: errors of all measurements and their Jacobian, as functions of one vector of
parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....groups import se3
from ....groups.arrays import Array
from ....model.checks import read_only
from ..measurements.measurement import Measurement, Rows, rows_of
from .error_model import ErrorModel
from .last_result import LastResult
from .parameters import frame_parameters
from .residual_vectors import ResidualVectors, places_and_errors
from .residuals import Residuals, residuals


class Linear(NamedTuple):
    """Errors (N, d) of a set of measurements, and their Jacobian (N, d, P) in all parameters."""

    errors: Array
    jacobian: Array


class Problem:
    """An error model, the readings q, sets of measurements, and their unknown frames at p = 0.

    p is the model's parameters and then six of each unknown frame (T <- T e^eta, about its own
    axes) or three of a point.
    """

    def __init__(
        self,
        model: ErrorModel,
        q: Array,
        sets: Sequence[Measurement],
        initial_frames: Sequence[Array] | None = None,
    ) -> None:
        self.model = model
        self.q = q
        self.sets = tuple(sets)
        self.rows = [rows_of(s, len(q)) for s in self.sets]
        self._own = [_frame_names(k, self.sets) for k in range(len(self.sets))]
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
        if initial_frames is None:
            initial_frames = self._guesses()
        self.initial_frames = tuple(initial_frames)
        self._last_errors = LastResult[list[Array]]()

    def _guesses(self) -> list[Array]:
        """Initial guesses of the unknown frames: of those that sets share, by the largest set."""
        T = self.model.nominal.fk(self.q)
        found: dict[str, Array] = {}
        parts = zip(self.sets, self._own, self.rows, strict=True)
        for s, own, rows in sorted(parts, key=lambda part: -len(part[0])):
            known = [
                unknown._replace(guess=found.get(name, unknown.guess))
                for name, unknown in zip(own, s.unknown_frames, strict=True)
            ]
            guesses = s.with_unknown_frames(known).guesses(T[rows])
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
        pairs = zip(self.initial_frames, self._parts.items(), strict=True)
        return {name: _moved(frame, p[part]) for frame, (name, part) in pairs}

    def _frames_of_sets(self, p: Array) -> list[list[Array]]:
        """The unknown frames of each set at p."""
        values = self.frame_values(p)
        return [[values[name] for name in own] for own in self._own]

    def residuals(self, p: Array) -> Residuals:
        """Residuals of all measurements."""
        return residuals(self.sets, self.rows, self.errors(p))

    def residual_vectors(self, before: Array, after: Array) -> ResidualVectors:
        """Residuals of all measured points before and after a fit, as vectors in the base frame."""
        _, nominal = self._places_and_errors(before)
        places, calibrated = self._places_and_errors(after)
        rows = [np.repeat(r, e.shape[1]) for r, e in zip(self.rows, nominal, strict=True)]
        parts = (
            np.concatenate([part.reshape(-1, 3) for part in every])
            for every in (places, nominal, calibrated)
        )
        return ResidualVectors(self.q, np.concatenate(rows), *parts)

    def _places_and_errors(self, p: Array) -> tuple[list[Array], list[Array]]:
        T = self.model.poses(p[: self.model_size], self.q)
        parts = zip(self.sets, self.rows, self._frames_of_sets(p), strict=True)
        pairs = [places_and_errors(s, T[rows], frames) for s, rows, frames in parts]
        return [place for place, _ in pairs], [error for _, error in pairs]

    def errors(self, p: Array) -> list[Array]:
        """The errors (N, d) of each set."""
        return self._last_errors(p.tobytes(), lambda: self._errors(p))

    def _errors(self, p: Array) -> list[Array]:
        T = self.model.poses(p[: self.model_size], self.q)
        parts = zip(self.sets, self.rows, self._frames_of_sets(p), strict=True)
        return [read_only(s.errors(T[rows], frames)) for s, rows, frames in parts]

    def linearised(self, p: Array) -> list[Linear]:
        """The errors of each set and their Jacobian."""
        errors = self.errors(p)
        return list(map(Linear, errors, self.jacobians(p, errors=errors)))

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
        if q is None:
            q = self.q
        else:
            rows = [np.arange(len(q))] * len(self.sets)
        if errors is None:
            errors = [np.zeros((len(r), s.width)) for r, s in zip(rows, self.sets, strict=True)]
        T, D = self.model.poses_and_twists(p[: self.model_size], q)
        found = []
        for k, frames in enumerate(self._frames_of_sets(p)):
            here = rows[k]
            of_model, of_frames = self.sets[k].jacobian(T[here], frames, errors[k], D[here])
            jacobian = np.zeros((*errors[k].shape, self.size))
            jacobian[..., : self.model_size] = of_model
            for name, of_frame in zip(self._own[k], of_frames, strict=True):
                part = self._parts[name]
                if of_frame.shape[2] == 6:
                    # at T e^eta with eta != 0 the frame moves by J_r(eta) d eta
                    of_frame = of_frame @ se3.right_jacobian(p[part])
                jacobian[..., part] = of_frame
            found.append(jacobian)
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
        return Problem(
            self.model,
            self.q[chosen],
            sets,
            self.initial_frames,
        )


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


def _moved(frame: Array, eta: Array) -> Array:
    """A pose moved about its own axes, or a point."""
    if len(eta) == 6:
        return frame @ se3.exp(eta)
    return frame + eta
