"""Result of `from_fk`: the calibration and how exact it is at worst."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import norms
from ....model.chain import Chain
from ....model.coordinates import coordinates
from ....results import Result
from ..calibration import Calibration
from ..diagnostics.uncertainty import pose_jacobian
from .bounds import Propagation, ReadingErrors, worst_case

_DRAWN = 1000


class PoseErrors(NamedTuple):
    """Errors of poses.

    Parameters
    ----------
    rotation : (...,) ndarray
        Angle, rad.
    position : (...,) ndarray
        Distance, m.
    """

    rotation: Array
    position: Array


@dataclass(frozen=True, eq=False, repr=False)
class FromFk(Result):
    """Arm that a controller calculates with, and how exact it is known at worst.

    Attributes
    ----------
    calibration : Calibration
        The calibration; `chain` is its arm. Its nominal arm stands in the controller's frames.
    digits : str
        Digits that the pairs were printed with, where they have fewer than a double.
    errors : ReadingErrors
        Largest errors of the pairs by these digits: `joints` (m,), rad or m, `rotation`, rad, and
        `position` in each axis, m. Of numbers without known digits, five standard deviations of the
        residuals.
    screw_bounds : (n, 6) ndarray
        Largest error of each entry of `chain.screws`, 1 and m.
    typical : PoseErrors
        Root mean square error of poses at 1000 configurations drawn within the limits, by the
        residuals' scatter.
    worst : PoseErrors
        Largest `pose_bound` at these configurations.
    remarks : tuple of str
        Where the controller's frames are not those of the nominal arm, and what limits the result.
    fit : Propagation
        Residuals at the end of the fit and their derivatives, which the bounds are made of.
    """

    left_out: ClassVar = ("calibration", "fit")

    calibration: Calibration
    digits: str
    errors: ReadingErrors
    screw_bounds: Array = field(repr=False)
    typical: PoseErrors
    worst: PoseErrors
    remarks: tuple[str, ...]
    fit: Propagation = field(repr=False)

    @property
    def chain(self) -> Chain:
        """Arm of the calibration: chain.fk(q) is the pose that the controller calculates."""
        return self.calibration.chain

    def pose_bound(self, q: Any) -> PoseErrors:
        """Largest errors that the digits of the pairs leave in the pose at q.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations, rad or m.

        Returns
        -------
        bound : PoseErrors
            Largest errors of rotation, rad, and position, m, each (...,).

        Raises
        ------
        ShapeError, UnknownName, InputError
            If q does not fit the arm.

        Notes
        -----
        Accuracy: first order in the errors of the pairs, whatever their signs
        (tests/solve/calibration/exact/test_from_fk.py). Source: the triangle inequality over the
        gains of the least-squares fit.
        """
        q = coordinates(q, self.chain.q_names)
        return pose_bound(self.calibration, self.fit, self.errors, q)

    def summary(self) -> str:
        """Digits, bounds and remarks as text, in µm and µrad."""
        residuals = _largest(np.abs(self.fit.errors))
        screws = _largest(self.screw_bounds)
        lines = [
            f"{len(self.fit.errors)} exact pairs, residuals of at most {_sizes(residuals)}",
            f"screws: directions and moments known to {_sizes(screws)} at worst",
            f"poses: known to {_sizes(self.typical)} rms, {_sizes(self.worst)} at worst",
            *self.remarks,
        ]
        return "\n".join(lines)


def pose_bound(
    found: Calibration,
    fit: Propagation,
    errors: ReadingErrors,
    q: Array,
) -> PoseErrors:
    """Largest errors of the poses at q (..., m)."""
    rows = q.reshape(-1, q.shape[-1])
    J = pose_jacobian(*found.estimate.at(rows))
    components = worst_case(J, fit, errors).reshape(*q.shape[:-1], 2, 3)
    lengths = norms(components)
    return PoseErrors(lengths[..., 0], lengths[..., 1])


def drawn_pose_errors(
    found: Calibration,
    fit: Propagation,
    errors: ReadingErrors,
) -> tuple[PoseErrors, PoseErrors]:
    """Root mean square errors, and largest bounds, at configurations drawn within the limits."""
    q = found.chain.random(0, _DRAWN)
    variances = np.diagonal(found.pose_covariance(q), axis1=1, axis2=2)
    squares = variances.reshape(-1, 2, 3).sum(axis=2).mean(axis=0)
    bounds = pose_bound(found, fit, errors, q)
    largest = [float(np.max(values)) for values in bounds]
    # of angles without any noise the estimate is a floor, which the bound may be below
    typical = np.minimum(np.sqrt(squares), largest)
    return PoseErrors(*typical), PoseErrors(*map(np.asarray, largest))


def _largest(values: Array) -> Array:
    """The largest of angles and of lengths, of rows of both."""
    return values.reshape(-1, 2, 3).max(axis=(0, 2), initial=0.0)


def _sizes(values: Iterable[float | Array]) -> str:
    """An angle, rad, and a length, m, as text in µrad and µm."""
    angle, length = (1e6 * float(value) for value in values)
    return f"{angle:.3g} µrad and {length:.3g} µm"
