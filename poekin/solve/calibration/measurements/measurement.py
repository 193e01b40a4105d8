"""What all kinds of measurements share: rows of q, covariances, frames that are solved along."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....errors import InputError, PoseError, ShapeError, safe_repr
from ....groups import se3
from ....groups.arrays import Array, numbers, poses
from ....model.checks import read_only

Indices = NDArray[np.integer]


class Unknown(NamedTuple):
    """A frame (6 parameters, T <- T e^eta) or a point (3 parameters, m) that is solved along;
    guess: where, if said; shared: the name under which sets have it in common, if any.
    """

    name: str
    size: int
    guess: Array | None
    shared: str | None = None


class Measurement:
    """Measurements of one kind, one an element of `rows` of q.

    A kind says what the model foretells: `errors(T, places)` from the poses T = T_base_tip (N, 4,
    4) and the values of its unknown frames, and how they change, `slopes(T, places, errors, D)`,
    with D (N, 6, P) the space twists of T. `angular` of its `width` errors are angles in rad and
    come first; the others are lengths in m.
    """

    rows: Any
    covariance: Any
    width: int
    angular: int = 0
    unknowns: tuple[Unknown, ...] = ()
    what: str = "measurement"

    def __len__(self) -> int:
        raise NotImplementedError

    def errors(self, T: Array, places: Sequence[Array]) -> Array:
        """Model minus measurement (N, width), rad and m.

        Parameters: T (N, 4, 4), poses of the tip in the base frame, m; places, a pose (4, 4) or
        point (3,) for each of `unknowns`. Returns: (N, width). Raises: nothing, it checks nothing.
        Source: the class's equation.
        """
        raise NotImplementedError

    def slopes(
        self, T: Array, places: Sequence[Array], errors: Array, D: Array
    ) -> tuple[Array, list[Array]]:
        """The change of the errors (N, width, P) with the arm's parameters, and (N, width, size)
        with each unknown.

        Parameters: T (N, 4, 4) and places as `errors`, poses (4, 4) or points (3,); errors (N,
        width),
        what that gave; D (N, 6, P), space twists of T, (omega; v), rad and m, per unit of each
        parameter.
        Returns: an array, and one for each of `unknowns`.
        Raises: nothing, it checks nothing. Source: the class's equation, differentiated.
        """
        raise NotImplementedError

    def guesses(self, T: Array) -> list[Array]:
        """First values of the unknown frames, given the nominal poses T (N, 4, 4).

        Parameters: T (N, 4, 4), in the base frame, m. Returns: a pose (4, 4) or point (3,) for each
        of `unknowns`. Raises: InputError where they cannot be had from these. Source: see each
        kind.
        """
        return []

    def taken(self, chosen: Indices) -> Measurement:
        """The measurements of the indices `chosen` (k,) into it, as a set of their own. Raises:
        nothing of its own.
        """
        other = object.__new__(type(self))
        for name, value in vars(self).items():
            along = name in self._along or (name == "covariance" and value is not None)
            object.__setattr__(other, name, value[chosen] if along and value is not None else value)
        return other

    def scaled(self, unit: float) -> Measurement:
        """The same with all measured lengths times `unit`, and nothing said about how they scatter.
        Raises: nothing.
        """
        other = self.taken(np.arange(len(self)))
        measured = getattr(other, self._along[0]).copy()
        lengths = measured[:, :3, 3] if measured.shape[1:] == (4, 4) else measured
        lengths *= unit
        object.__setattr__(other, self._along[0], measured)
        object.__setattr__(other, "covariance", None)
        return other

    _along: tuple[str, ...] = ()
    """The attributes that have an element for each measurement; the measured numbers first."""

    def _settle(self, **values: Any) -> None:
        """Keep checked values in a frozen object."""
        for name, value in values.items():
            object.__setattr__(
                self, name, read_only(value) if isinstance(value, np.ndarray) else value
            )


def rows_of(rows: ArrayLike | None, count: int) -> Indices | None:
    """Indices into q (N,), each not negative; None for all of q in order."""
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
        raise InputError(
            f"{what}[{int(np.argmin(good))}]: expected finite numbers, got NaN or infinity"
        )
    return array


def pose_rows(T: ArrayLike, what: str) -> Array:
    """Poses (N, 4, 4), finite."""
    array = finite_rows(numbers(T, what), what)
    if array.ndim != 3:
        raise ShapeError(f"{what}: expected poses (N, 4, 4), got shape {array.shape}")
    return poses(array, what).copy()


def unknown_frame(name: str, said: ArrayLike | str | None) -> Unknown:
    """A frame to be solved along: said by a rough pose (4, 4), by a name that sets have in common,
    or not at all.
    """
    if said is None:
        return Unknown(name, 6, None)
    if isinstance(said, str):
        if not said:
            raise InputError(f"{name}: expected a pose, a name or None, got ''")
        return Unknown(name, 6, None, said)
    array = poses(said, name)
    if array.shape != (4, 4) or not np.isfinite(array).all():
        raise PoseError(f"{name}: expected one finite pose (4, 4) or None, got shape {array.shape}")
    return Unknown(name, 6, array.copy())


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
            f"{what}: covariance: expected shape ({width}, {width}), or ({count}, {width}, {width}), got {C.shape}"
        )
    C = C.reshape(-1, width, width)
    for k, one in enumerate(C):
        where = f"{what}: covariance[{k}]" if len(C) > 1 else f"{what}: covariance"
        if not np.isfinite(one).all():
            raise InputError(f"{where}: expected finite numbers")
        scale = np.sqrt(np.abs(np.diag(one)))
        if not (np.diag(one) > 0).all():
            raise InputError(
                f"{where} is not positive definite: its diagonal is {safe_repr(np.diag(one).tolist())}"
            )
        even = one / np.outer(scale, scale)
        if np.abs(even - even.T).max() > 1e-9:
            raise InputError(
                f"{where} is not symmetric, by {np.abs(even - even.T).max():.3g} of its diagonal"
            )
        least = float(np.linalg.eigvalsh(0.5 * (even + even.T))[0])
        # below the rounding of the factorisation there is no telling it from a singular one
        if least <= 1e-14 * width:
            raise InputError(
                f"{where} is not positive definite: scaled to a unit diagonal, its least eigenvalue is {least:.3g}"
            )
    return np.broadcast_to(C, (count, width, width)).copy()


def carried(T: Array, D: Array) -> Array:
    """Space twists D (N, 6, P) seen in a frame whose pose T_ab (4, 4) of the old frame b in it is
    given.
    """
    return se3.adjoint(T) @ D
