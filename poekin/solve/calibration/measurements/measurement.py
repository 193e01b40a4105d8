"""Base of all kinds of measurements: rows of q, covariances, unknown frames estimated jointly."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....errors import InputError, ShapeError
from ....groups import se3
from ....groups.arrays import Array, poses
from ....groups.vectors import translation_part
from ....model.checks import finite, one_pose, read_only
from ..model.covariances import covariances

Rows = NDArray[np.integer]
MeasurementKind = Literal["poses", "eye-in-hand", "eye-to-hand", "points", "distances"]
Frames = Sequence[Array]
"""A pose (4, 4) or point (3,), m, for each unknown frame."""
Derivatives = tuple[Array, list[Array]]
"""Jacobians in the parameters of the arm, and in each unknown frame."""


class UnknownFrame(NamedTuple):
    """A frame (6 parameters, T <- T e^[η]) or a point (3 parameters, m) that is estimated jointly.

    guess: its rough value, if given; shared: the name under which sets have it in common, if any.
    """

    name: str
    size: int
    guess: Array | None = None
    shared: str | None = None


class Measurement:
    """Base of the measurements of one kind, one an element of `rows` of q.

    A kind says what the model predicts, by `errors` and their `jacobian`; the errors that are
    angles come first, in rad, the others are lengths in m.

    Attributes
    ----------
    rows : (N,) ndarray of int or None
        Row of q of each measurement; None for all rows in order.
    covariance : (N, width, width) ndarray or None
        Covariance of each measurement's errors, rad² and m²; None where the noise is estimated.
    width : int
        Number of errors of one measurement.
    angular : int
        Number of them that are angles.
    unknown_frames : tuple of UnknownFrame
        Frames and points that are estimated jointly.
    frame : {"base", "unknown"}
        Where they are measured from: the base frame, or the first of `unknown_frames`, a device's
        frame or the centre of distances.
    sees_arm : bool
        Whether the measurements depend on the pose of the arm.
    """

    rows: Any
    covariance: Any
    width: int
    angular: int = 0
    unknown_frames: tuple[UnknownFrame, ...] = ()
    frame: Any = "base"
    sees_arm: bool = True
    _measured: str = "T"  # the attribute that holds the measured numbers
    _others: tuple[str, ...] = ()  # attributes that hold more of each measurement

    def __len__(self) -> int:
        return len(getattr(self, self._measured))

    def __repr__(self) -> str:
        noise = "noise unknown" if self.covariance is None else "noise given"
        words = [f"{len(self)} of {self.width} numbers each", noise]
        if self.rows is not None:
            words.append("at rows of q")
        names = " and ".join(frame.name for frame in self.unknown_frames)
        if names:
            words.append(f"{names} unknown")
        return f"<{self.what}: {', '.join(words)}>"

    @property
    def measured(self) -> Array:
        """Measured poses (N, 4, 4), positions (N, k, 3) or distances (N,), m, in the device's frame."""
        return getattr(self, self._measured)

    @property
    def what(self) -> str:
        """Name of the kind in messages."""
        return type(self).__name__

    def errors(self, T: Array, frame_values: Frames) -> Array:
        """Model minus measurement, by the equation of the kind.

        Parameters
        ----------
        T : (N, 4, 4) ndarray
            Poses T_base_tip of the model, m; not checked.
        frame_values : sequence of ndarray
            A pose (4, 4) or point (3,), m, for each of `unknown_frames`.

        Returns
        -------
        errors : (N, width) ndarray
            In rad and m.

        Raises
        ------
        NotImplementedError
            By the base class, which has no equation.

        Notes
        -----
        Source: the equation of each kind.
        """
        raise NotImplementedError

    def jacobian(
        self,
        T: Array,
        frame_values: Frames,
        errors: Array,
        D: Array,
    ) -> Derivatives:
        """Jacobian of the errors in the parameters of the arm and of each unknown frame.

        Parameters
        ----------
        T : (N, 4, 4) ndarray
            Poses T_base_tip of the model, m; not checked.
        frame_values : sequence of ndarray
            A pose (4, 4) or point (3,), m, for each of `unknown_frames`.
        errors : (N, width) ndarray
            Errors of these poses, rad and m.
        D : (N, 6, P) ndarray
            Space twists dT T⁻¹, (ω; v), rad and m, per unit of each parameter.

        Returns
        -------
        arm : (N, width, P) ndarray
            Derivatives with respect to the parameters of the arm.
        frames : list of (N, width, 6) or (N, width, 3) ndarray
            Derivatives with respect to each unknown frame (T <- T e^[η]) or point.

        Raises
        ------
        NotImplementedError
            By the base class, which has no equation.

        Notes
        -----
        Source: the equation of each kind, differentiated.
        """
        raise NotImplementedError

    def guesses(self, T: Array) -> list[Array]:
        """Initial guesses of the unknown frames, those that are given as they are given.

        Parameters
        ----------
        T : (N, 4, 4) ndarray
            Poses T_base_tip of the nominal arm, m.

        Returns
        -------
        frames : list of ndarray
            A pose (4, 4) or point (3,), m, for each of `unknown_frames`.

        Raises
        ------
        InputError
            If these poses do not determine a frame.

        Notes
        -----
        Source: hand-eye calibration of Shah 2013, registration of Umeyama 1991, centre of Beck,
        Stoica and Li 2008, each by repeated weighted least squares.
        """
        return []

    def subset(self, chosen: Rows) -> Measurement:
        """Some of the measurements as a set of their own.

        Parameters
        ----------
        chosen : (k,) ndarray of int
            Indices into the measurements.

        Returns
        -------
        measurements : Measurement
            Of the same kind, with their rows and covariances.

        Raises
        ------
        IndexError
            If there is no measurement of such an index.
        """
        changes = {}
        for name in (self._measured, *self._others, "rows", "covariance"):
            value = getattr(self, name)
            if value is not None:
                changes[name] = value[chosen]
        return self._with(**changes)

    def with_rows(self, rows: Rows | None) -> Measurement:
        """Copy of the measurements at other rows of q, unchecked.

        Parameters
        ----------
        rows : (N,) ndarray of int or None
            Row of q of each measurement; None for all rows in order.

        Returns
        -------
        measurements : Measurement
            Copy with these rows.

        Notes
        -----
        Raises: nothing, it checks nothing.
        """
        return self._with(rows=rows)

    def with_unknown_frames(self, unknown_frames: Sequence[UnknownFrame]) -> Measurement:
        """Copy of the measurements with other guesses of the unknown frames, unchecked.

        Parameters
        ----------
        unknown_frames : sequence of UnknownFrame
            One for each of `unknown_frames`.

        Returns
        -------
        measurements : Measurement
            Copy with these unknown frames.

        Notes
        -----
        Raises: nothing, it checks nothing.
        """
        return self._with(unknown_frames=tuple(unknown_frames))

    def with_measured(self, measured: Array, covariance: Array | None = None) -> Measurement:
        """Copy with other measured numbers of the same shape, unchecked.

        Parameters
        ----------
        measured : (N, 4, 4), (N, k, 3) or (N,) ndarray
            Poses, positions or distances, m, in the frame of those that they replace.
        covariance : (N, width, width) ndarray, optional
            Covariance of their errors, rad² and m²; by default as it was.

        Returns
        -------
        measurements : Measurement
            Copy with these numbers.

        Notes
        -----
        Raises: nothing, it checks nothing.
        """
        if covariance is None:
            covariance = self.covariance
        return self._with(**{self._measured: measured, "covariance": covariance})

    def scaled(self, unit: float) -> Measurement:
        """Copy of the measurements with all lengths in another unit, and without covariance.

        Parameters
        ----------
        unit : float
            Factor of the measured lengths.

        Returns
        -------
        measurements : Measurement
            Copy with scaled lengths.

        Notes
        -----
        Raises: nothing, it checks nothing.
        """
        measured = getattr(self, self._measured).copy()
        lengths = measured
        if measured.shape[1:] == (4, 4):
            lengths = translation_part(measured)
        lengths *= unit
        return self._with(**{self._measured: measured, "covariance": None})

    def _with(self, **changes: Any) -> Measurement:
        """A copy with some attributes changed, unchecked."""
        other = object.__new__(type(self))
        other._set_fields(**vars(self) | changes)
        return other

    def _keep(self, **values: Any) -> None:
        """Keep checked values, the measured ones among them, with covariances and rows that fit."""
        self._set_fields(**values)
        count = len(self)
        C = covariances(self.covariance, count, self.width, self.what)
        self._set_fields(covariance=C, rows=parse_rows(self.rows, count))

    def _set_fields(self, **values: Any) -> None:
        """Set attributes of a frozen object."""
        for name, value in values.items():
            if isinstance(value, np.ndarray):
                value = read_only(value)
            object.__setattr__(self, name, value)


def rows_of(s: Measurement, count: int) -> Rows:
    """Row of q of each measurement: as given, or all `count` of them in order."""
    if s.rows is None:
        return np.arange(count)
    return s.rows


def per_error(s: Measurement, angle: float | None, length: float) -> Array:
    """Vector (width,): one number for the errors that are angles, another for lengths."""
    counts = [s.angular, s.width - s.angular]
    return np.repeat(np.array([angle, length], float), counts)


def parse_rows(rows: ArrayLike | None, count: int) -> Rows | None:
    """Rows into q (N,), each not negative; None for all of q in order."""
    if rows is None:
        return None
    array = np.asarray(rows)
    if array.dtype.kind not in "iu" or array.shape != (count,):
        raise ShapeError(
            f"rows: expected {count} whole numbers, the row of q of each measurement, got "
            f"{array.dtype.name} of shape {array.shape}"
        )
    if count and array.min() < 0:
        raise InputError(f"rows: expected rows of q counted from 0, got {array.min()}")
    return array.astype(np.intp)


def pose_rows(T: ArrayLike, what: str) -> Array:
    """Poses (N, 4, 4), finite."""
    array = finite(T, what)
    if array.ndim != 3:
        raise ShapeError(f"{what}: expected poses (N, 4, 4), got shape {array.shape}")
    return poses(array, what)


def seen_from(
    X: Array,
    T: Array,
    D: Array,
) -> tuple[Array, Array]:
    """Poses X^-1 T of a frame X, and their twists (N, 6, P + 6): Ad(X^-1) D of T's twists D, and -xi
    of X <- X e^[xi].
    """
    back = se3.inverse(X)
    fixed = np.broadcast_to(-np.eye(6), (len(T), 6, 6))
    return back @ T, np.concatenate([se3.adjoint(back) @ D, fixed], axis=2)


def make_unknown_frame(name: str, said: ArrayLike | str | None) -> UnknownFrame:
    """A frame to be estimated jointly: given by a rough pose (4, 4), by a name that sets have in
    common, or not at all.
    """
    if said is None:
        return UnknownFrame(name, 6)
    if isinstance(said, str):
        if not said:
            raise InputError(f"{name}: expected a pose, a name or None, got ''")
        return UnknownFrame(name, 6, shared=said)
    return UnknownFrame(name, 6, one_pose(said, name))
