"""Base of all kinds of measurements: rows of q, covariances, unknown frames estimated jointly."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....errors import InputError, PoseError, ShapeError, safe_repr
from ....groups import se3
from ....groups.arrays import Array, numbers, poses
from ....model.checks import read_only

Rows = NDArray[np.integer]


class UnknownFrame(NamedTuple):
    """A frame (6 parameters, T <- T e^eta) or a point (3 parameters, m) that is estimated jointly;
    guess: its rough value, if given; shared: the name under which sets have it in common, if any.
    """

    name: str
    size: int
    guess: Array | None
    shared: str | None = None


class Measurement:
    """Measurements of one kind, one an element of `rows` of q.

    A kind says what the model predicts: `errors(T, frame_values)` from the poses T = T_base_tip
    (N, 4, 4) and the values of its unknown frames, and their derivatives, `jacobian(T,
    frame_values, errors, D)`, with D (N, 6, P) the space twists of T. `angular` of its `width`
    errors are angles in rad and come first; the others are lengths in m.
    """

    rows: Any
    covariance: Any
    width: int
    angular: int = 0
    unknown_frames: tuple[UnknownFrame, ...] = ()
    what: str = "measurement"

    def __len__(self) -> int:
        raise NotImplementedError

    def errors(self, T: Array, frame_values: Sequence[Array]) -> Array:
        """Model minus measurement (N, width), rad and m.

        Parameters: T (N, 4, 4), poses of the tip in the base frame, m; frame_values, a pose (4, 4)
        or point (3,) for each of `unknown_frames`. Returns: (N, width). Raises: nothing, it checks
        nothing. Source: the class's equation.
        """
        raise NotImplementedError

    def jacobian(
        self, T: Array, frame_values: Sequence[Array], errors: Array, D: Array
    ) -> tuple[Array, list[Array]]:
        """Jacobian of the errors in the arm's parameters (N, width, P), and in each unknown frame
        (N, width, size).

        Parameters: T (N, 4, 4) and frame_values as `errors`, poses (4, 4) or points (3,); errors
        (N, width), of the same; D (N, 6, P), space twists of T, (omega; v), rad and m, per unit of
        each parameter.
        Returns: an array, and one for each of `unknown_frames`.
        Raises: nothing, it checks nothing. Source: the class's equation, differentiated.
        """
        raise NotImplementedError

    def guesses(self, T: Array) -> list[Array]:
        """Initial guesses of the unknown frames, given the nominal poses T (N, 4, 4).

        Parameters: T (N, 4, 4), in the base frame, m. Returns: a pose (4, 4) or point (3,) for each
        of `unknown_frames`. Raises: InputError where they cannot be had from these. Source: see each
        kind.
        """
        return []

    def subset(self, chosen: Rows) -> Measurement:
        """The measurements of the indices `chosen` (k,) into it, as a set of their own. Raises:
        nothing of its own.
        """
        fields = {}
        for name in (*self._per_measurement, "covariance"):
            value = getattr(self, name)
            fields[name] = None if value is None else value[chosen]
        return self._with(**fields)

    def with_rows(self, rows: Rows | None) -> Measurement:
        """Copy of the measurements at other rows of q. Raises: nothing."""
        return self._with(rows=rows)

    def with_unknown_frames(self, unknown_frames: Sequence[UnknownFrame]) -> Measurement:
        """Copy of the measurements with other guesses: unknown_frames, one for each. Raises: nothing."""
        return self._with(unknown_frames=tuple(unknown_frames))

    def scaled(self, unit: float) -> Measurement:
        """Copy of the measurements with all lengths times `unit`, and no covariance. Raises: nothing."""
        name = self._per_measurement[0]
        measured = getattr(self, name).copy()
        if measured.shape[1:] == (4, 4):
            lengths = measured[:, :3, 3]
        else:
            lengths = measured
        lengths *= unit
        return self._with(**{name: measured, "covariance": None})

    def _with(self, **changes: Any) -> Measurement:
        """A copy with some attributes changed, unchecked."""
        other = object.__new__(type(self))
        for name, value in (vars(self) | changes).items():
            object.__setattr__(other, name, value)
        return other

    _per_measurement: tuple[str, ...] = ()
    """The attributes that have an element for each measurement; the measured numbers first."""

    def _set_fields(self, **values: Any) -> None:
        """Keep checked values in a frozen object."""
        for name, value in values.items():
            if isinstance(value, np.ndarray):
                value = read_only(value)
            object.__setattr__(self, name, value)


def parse_rows(rows: ArrayLike | None, count: int) -> Rows | None:
    """Rows into q (N,), each not negative; None for all of q in order."""
    if rows is None:
        return None
    array = np.asarray(rows)
    if array.dtype.kind not in "iu" or array.shape != (count,):
        raise ShapeError(
            f"rows: expected {count} whole numbers, the row of q of each measurement, got {array.dtype.name} of shape"
            f" {array.shape}"
        )
    if count and array.min() < 0:
        raise InputError(f"rows: expected rows of q counted from 0, got {array.min()}")
    return array.astype(np.intp)


def finite_rows(array: Array, what: str) -> Array:
    """The array, all of it finite. Raises: InputError with the first row that is not."""
    good = np.isfinite(array).all(axis=tuple(range(1, array.ndim)))
    if not good.all():
        row = int(np.argmin(good))
        raise InputError(f"{what}[{row}]: expected finite numbers, got NaN or infinity")
    return array


def pose_rows(T: ArrayLike, what: str) -> Array:
    """Poses (N, 4, 4), finite."""
    array = finite_rows(numbers(T, what), what)
    if array.ndim != 3:
        raise ShapeError(f"{what}: expected poses (N, 4, 4), got shape {array.shape}")
    return poses(array, what).copy()


def make_unknown_frame(name: str, said: ArrayLike | str | None) -> UnknownFrame:
    """A frame to be estimated jointly: given by a rough pose (4, 4), by a name that sets have in
    common, or not at all.
    """
    if said is None:
        return UnknownFrame(name, 6, None)
    if isinstance(said, str):
        if not said:
            raise InputError(f"{name}: expected a pose, a name or None, got ''")
        return UnknownFrame(name, 6, None, said)
    array = poses(said, name)
    if array.shape != (4, 4) or not np.isfinite(array).all():
        raise PoseError(f"{name}: expected one finite pose (4, 4) or None, got shape {array.shape}")
    return UnknownFrame(name, 6, array.copy())


def covariances(values: ArrayLike | None, count: int, width: int, what: str) -> Array | None:
    """Covariances (N, width, width) of one for all, or one each; None stays None.

    Raises: ShapeError; InputError with the element that is not symmetric or not positive definite.
    """
    if values is None:
        return None
    C = numbers(values, f"{what}: covariance")
    if width == 1 and C.shape in ((), (count,)):
        C = C.reshape(-1, 1, 1)
    if C.shape not in ((width, width), (count, width, width), (1, width, width)):
        raise ShapeError(
            f"{what}: covariance: expected shape ({width}, {width}), or ({count}, {width}, {width})"
            f", got {C.shape}"
        )
    C = C.reshape(-1, width, width)
    for k, one in enumerate(C):
        which = f"[{k}]" if len(C) > 1 else ""
        _check_covariance(one, f"{what}: covariance{which}")
    return np.broadcast_to(C, (count, width, width)).copy()


def _check_covariance(C: Array, where: str) -> None:
    """Raises: InputError for a matrix that is not finite, symmetric and positive definite."""
    if not np.isfinite(C).all():
        raise InputError(f"{where}: expected finite numbers")
    variances = np.diag(C)
    if not (variances > 0).all():
        raise InputError(
            f"{where} is not positive definite: its diagonal is {safe_repr(variances.tolist())}"
        )
    scale = np.sqrt(np.abs(variances))
    even = C / np.outer(scale, scale)
    skew = np.abs(even - even.T).max()
    if skew > 1e-9:
        raise InputError(f"{where} is not symmetric, by {skew:.3g} of its diagonal")
    least = float(np.linalg.eigvalsh(0.5 * (even + even.T))[0])
    # below the rounding of the factorisation there is no telling it from a singular one
    if least <= 1e-14 * len(C):
        raise InputError(
            f"{where} is not positive definite: scaled to a unit diagonal, its least eigenvalue is "
            f"{least:.3g}"
        )


def transform_twists(T: Array, D: Array) -> Array:
    """Space twists D (N, 6, P) seen in a frame whose pose T_ab (4, 4) of the old frame b in it is
    given.
    """
    return se3.adjoint(T) @ D
