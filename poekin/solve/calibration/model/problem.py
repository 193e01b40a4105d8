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
from .error_model import ErrorModel, PosesAndTwists
from .last_result import LastResult
from .parameters import frame_parameters
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
        count = len(q)
        self.rows = [rows_of(s, count) for s in self.sets]
        numbers = range(len(self.sets))
        self._own = [_frame_names(k, self.sets) for k in numbers]
        named = list(model.parameters)
        self._parts: dict[str, slice] = {}
        pairs = zip(self.sets, self._own, strict=True)
        for s, own in pairs:
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
        largest_first = sorted(
            zip(self.sets, self._own, self.rows, strict=True),
            key=lambda part: -len(part[0]),
        )
        for s, own, rows in largest_first:
            known = []
            for name, unknown in zip(own, s.unknown_frames, strict=True):
                guess = found.get(name, unknown.guess)
                known.append(unknown._replace(guess=guess))
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
        values = {}
        pairs = zip(self.initial_frames, self._parts.items(), strict=True)
        for frame, (name, part) in pairs:
            values[name] = _moved(frame, p[part])
        return values

    def residuals(self, p: Array) -> Residuals:
        """Residuals of all measurements."""
        return residuals(self.sets, self.rows, self.errors(p))

    def errors(self, p: Array) -> list[Array]:
        """The errors (N, d) of each set."""
        return self._last_errors(p.tobytes(), lambda: self._errors(p))

    def _errors(self, p: Array) -> list[Array]:
        of_model = p[: self.model_size]
        T = self.model.poses(of_model, self.q)
        frames = self.frame_values(p)
        found = []
        parts = zip(self.sets, self.rows, self._own, strict=True)
        for s, rows, own in parts:
            mine = [frames[name] for name in own]
            errors = s.errors(T[rows], mine)
            found.append(read_only(errors))
        return found

    def linearised(self, p: Array) -> list[Linear]:
        """The errors of each set and their Jacobian."""
        errors = self.errors(p)
        moved = self._moved(p)
        jacobians = self._jacobians(p, moved, errors)
        return list(map(Linear, errors, jacobians))

    def _moved(self, p: Array) -> list[PosesAndTwists]:
        """Poses and their twists at the readings of each set."""
        of_model = p[: self.model_size]
        T, D = self.model.poses_and_twists(of_model, self.q)
        return [PosesAndTwists(T[rows], D[rows]) for rows in self.rows]

    def jacobians(
        self,
        p: Array,
        q: Array | None = None,
    ) -> list[Array]:
        """The Jacobian (N, d, P) of each set as if the model were right: no measured value is used.

        q (K, m): other readings, at each of which every set measures.
        """
        if q is None:
            moved = self._moved(p)
        else:
            of_model = p[: self.model_size]
            everywhere = self.model.poses_and_twists(of_model, q)
            moved = [everywhere] * len(self.sets)
        errors = []
        for (T, _), s in zip(moved, self.sets, strict=True):
            zeros = np.zeros((len(T), s.width))
            errors.append(zeros)
        return self._jacobians(p, moved, errors)

    def _jacobians(
        self,
        p: Array,
        moved: Sequence[PosesAndTwists],
        errors: Sequence[Array],
    ) -> list[Array]:
        frames = self.frame_values(p)
        found = []
        parts = zip(self.sets, self._own, moved, errors, strict=True)
        for s, own, (T, D), e in parts:
            mine = [frames[name] for name in own]
            of_model, of_frames = s.jacobian(T, mine, e, D)
            jacobian = np.zeros((*e.shape, self.size))
            jacobian[..., : self.model_size] = of_model
            for name, of_frame in zip(own, of_frames, strict=True):
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
