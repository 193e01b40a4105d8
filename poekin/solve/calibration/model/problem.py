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
from ..measurements.measurement import Measurement, Rows
from .error_model import ErrorModel, PosesAndTwists
from .last_result import LastResult
from .parameters import frame_parameters, point_parameters


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
        self.rows = [_rows(s, len(q)) for s in self.sets]
        names = [_frame_names(k, self.sets) for k in range(len(self.sets))]
        sizes: dict[str, int] = {}
        for s, own in zip(self.sets, names, strict=True):
            sizes |= {name: u.size for name, u in zip(own, s.unknown_frames, strict=True)}
        self.frame_names = list(sizes)
        # of all unknown frames, those of each set
        self._own = [[self.frame_names.index(name) for name in own] for own in names]
        named = list(model.parameters)
        self._parts: list[slice] = []
        for name, size in sizes.items():
            self._parts.append(slice(len(named), len(named) + size))
            named += frame_parameters(name) if size == 6 else point_parameters(name)
        self.parameters = tuple(named)
        lengths = [p.unit in ("m", "m/rad") for p in named]
        self.scale = np.where(lengths, model.nominal.reach, 1.0)
        self.initial_frames = tuple(self._guesses() if initial_frames is None else initial_frames)
        self._last_errors = LastResult[list[Array]]()

    def _guesses(self) -> list[Array]:
        """Initial guesses of the unknown frames: of those that sets share, by the largest set."""
        T = self.model.nominal.fk(self.q)
        found: dict[int, Array] = {}
        for k in sorted(range(len(self.sets)), key=lambda k: -len(self.sets[k])):
            s = self.sets[k]
            own = self._own[k]
            pairs = zip(own, s.unknown_frames, strict=True)
            known = [u._replace(guess=found.get(i, u.guess)) for i, u in pairs]
            guesses = s.with_unknown_frames(known).guesses(T[self.rows[k]])
            found |= dict(zip(own, guesses, strict=True))
        return [found[i] for i in range(len(found))]

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

    def frame_values(self, p: Array) -> list[Array]:
        """The unknown frames (4, 4) and points (3,) at p."""
        pairs = zip(self.initial_frames, self._parts, strict=True)
        return [_moved(frame, p[part]) for frame, part in pairs]

    def errors(self, p: Array) -> list[Array]:
        """The errors (N, d) of each set."""
        return self._last_errors(p.tobytes(), lambda: self._errors(p))

    def _errors(self, p: Array) -> list[Array]:
        T = self.model.poses(p[: self.model_size], self.q)
        frames = self.frame_values(p)
        found = []
        for s, rows, own in zip(self.sets, self.rows, self._own, strict=True):
            found.append(read_only(s.errors(T[rows], [frames[i] for i in own])))
        return found

    def linearised(self, p: Array) -> list[Linear]:
        """The errors of each set and their Jacobian."""
        return self._linearised(p, self._moved(p), self.errors(p))

    def _moved(self, p: Array) -> list[PosesAndTwists]:
        """Poses and their twists at the readings of each set."""
        T, D = self.model.poses_and_twists(p[: self.model_size], self.q)
        return [PosesAndTwists(T[rows], D[rows]) for rows in self.rows]

    def jacobians(self, p: Array, q: Array | None = None) -> list[Array]:
        """The Jacobian (N, d, P) of each set as if the model were right: no measured value is used.

        q (K, m): other readings, at each of which every set measures.
        """
        if q is None:
            moved = self._moved(p)
        else:
            moved = [self.model.poses_and_twists(p[: self.model_size], q)] * len(self.sets)
        errors = [np.zeros((len(m.T), s.width)) for m, s in zip(moved, self.sets, strict=True)]
        return [linear.jacobian for linear in self._linearised(p, moved, errors)]

    def _linearised(
        self,
        p: Array,
        moved: Sequence[PosesAndTwists],
        errors: Sequence[Array],
    ) -> list[Linear]:
        frames = self.frame_values(p)
        found = []
        for k, s in enumerate(self.sets):
            own = self._own[k]
            mine = [frames[i] for i in own]
            of_model, of_frames = s.jacobian(moved[k].T, mine, errors[k], moved[k].D)
            jacobian = np.zeros((*errors[k].shape, self.size))
            jacobian[..., : self.model_size] = of_model
            for i, of_frame in zip(own, of_frames, strict=True):
                part = self._parts[i]
                if of_frame.shape[2] == 6:
                    # at T e^eta with eta != 0 the frame moves by J_r(eta) d eta
                    of_frame = of_frame @ se3.right_jacobian(p[part])
                jacobian[..., part] = of_frame
            found.append(Linear(errors[k], jacobian))
        return found

    def part(self, chosen: Rows) -> Problem:
        """The measurements at the readings of these rows of q only."""
        new = np.full(len(self.q), -1)
        new[chosen] = np.arange(len(chosen))
        sets = []
        for s, rows in zip(self.sets, self.rows, strict=True):
            kept = np.flatnonzero(new[rows] >= 0)
            sets.append(s.subset(kept).with_rows(new[rows[kept]]))
        return Problem(self.model, self.q[chosen], sets, self.initial_frames)


def _rows(s: Measurement, count: int) -> Rows:
    if s.rows is None:
        return np.arange(count)
    return s.rows


def _frame_names(k: int, sets: Sequence[Measurement]) -> list[str]:
    """Names of the unknown frames of set k: frames that sets share by what they call them."""
    which = ""
    if len(sets) > 1:
        which = f" of measurement set {k}"
    frames = sets[k].unknown_frames
    return [u.name + (f" of {u.shared!r}" if u.shared else which) for u in frames]


def _moved(frame: Array, eta: Array) -> Array:
    """A pose moved about its own axes, or a point."""
    if len(eta) == 6:
        return frame @ se3.exp(eta)
    return frame + eta
