"""Largest errors of joint readings and poses: half a unit of the digits they were printed with, or
by the residuals where there are no digits.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....model.chain import Chain
from ..fit.losses import chi_square
from ..model.parameters import Mask
from .bounds import ROUNDING, Propagation, ReadingErrors
from .digits import MOST, Grid, RotationGrid, angle_grid, length_grid, rotation_grid

TIMES = 5.0
"""Standard deviations of the residuals that no error is taken to exceed where no digits are found;
1.7 is right for rounding.
"""
LIMITS = (1e-3, 1e-6)
"""Standard deviations of rotations, rad, and positions, reaches, above which numbers without known
digits are none of an exact model: positions of single precision scatter by 1e-7.
"""
_SURE = 4.75  # quantile of the normal distribution that is passed once in 10^6
_NOTHING = 1e-2  # of half a unit: residuals of numbers that were rounded are larger
_TELLING = 6.0  # degrees of freedom from which on that is so, but once in 10^10 times
_MARGIN = 1.5  # for taking a fit to leave the same part of the errors everywhere


class Digits(NamedTuple):
    """Digits of joint angles, of joint lengths, of positions and of rotations; None where all of a
    double are there, or none were found.
    """

    angles: Grid | None
    lengths: Grid | None
    positions: Grid | None
    rotations: RotationGrid | None

    def __str__(self) -> str:
        what = ""
        rotations = None
        if self.rotations is not None:
            what = f" ({self.rotations.what})"
            rotations = self.rotations.grid
        named = {
            "joint angles": self.angles,
            "joint lengths": self.lengths,
            "positions": self.positions,
            f"rotations{what}": rotations,
        }
        parts = [f"{name} to {grid}" for name, grid in named.items() if grid is not None]
        return ", ".join(parts)


class Judged(NamedTuple):
    """Digits that the pairs were rounded to, and the largest errors that they allow; standard
    deviations of the residuals (2,), rad and m; and whether they are larger than the digits allow.
    """

    digits: Digits
    largest: ReadingErrors
    deviations: Array
    beyond_digits: bool


class _Expected(NamedTuple):
    """Sum of squares of the weighted residuals, the one that rounding lets expect, its degrees of
    freedom, and the expected deviations (2,), rad and m.
    """

    found: float
    mean: float
    freedom: float
    deviations: Array

    @property
    def too_small(self) -> bool:
        """Whether the residuals refute errors as large as these."""
        least = chi_square(self.freedom, -_SURE) / self.freedom
        return self.found * _MARGIN < self.mean * least

    @property
    def too_large(self) -> bool:
        """Whether the residuals are larger than these errors make them."""
        most = chi_square(self.freedom, _SURE) / self.freedom
        return self.found > _MARGIN * self.mean * most


def printed_digits(chain: Chain, q: Array, T: Array) -> Digits:
    """Digits of readings (N, m) and poses (N, 4, 4) as they were printed."""
    turns = _turning(chain)
    return Digits(
        angles=angle_grid(q[:, turns]) if turns.any() else None,
        lengths=length_grid(q[:, ~turns]) if not turns.all() else None,
        positions=length_grid(T[:, :3, 3]),
        rotations=rotation_grid(T[:, :3, :3]),
    )


def judge(printed: Digits, fit: Propagation, chain: Chain) -> Judged:
    """Digits of the joint readings that the residuals of a fit do not refute, and what follows.

    Readings such as 30 degrees may be exact, and were then not rounded: their decimals are taken to
    end where the residuals are not too small for it, as seen once in 10^6 times. Poses are what the
    model makes of them, and end where their digits do.
    """
    left = _left(fit)
    deviations = _deviations(fit, left)
    printed = _borne_out(printed, deviations, left)
    for digits in _refined(printed):
        expected = _expected(digits, fit, left, chain)
        if not expected.too_small:
            break
    floor = ROUNDING * np.array([1.0, chain.reach])
    allowed = np.maximum(expected.deviations, np.array([LIMITS[0], LIMITS[1] * chain.reach]))
    unknown = np.array([digits.rotations is None, digits.positions is None])
    beyond = expected.too_large and not unknown.all()
    beyond |= bool((unknown & (deviations > _MARGIN * allowed)).any())
    errors = np.where(unknown, TIMES * deviations, _pose_errors(digits))
    rotation, position = np.maximum(errors, floor).tolist()
    largest = ReadingErrors(_joint_errors(digits, chain), rotation, position)
    if digits != printed:  # readings that were said with fewer digits than they had
        digits = digits._replace(angles=None, lengths=None)
    return Judged(digits, largest, deviations, beyond)


def _left(fit: Propagation) -> Array:
    """Degrees of freedom (6,) that the fit leaves to each of a pose's six numbers, of N pairs: the
    sum of 1 - h, h the diagonal of J G.
    """
    leverage = np.einsum("nkp,pnk->k", fit.design, fit.gain)
    return np.clip(len(fit.errors) - leverage, 0.0, None)


def _borne_out(printed: Digits, deviations: Array, left: Array) -> Digits:
    """The digits without those of rotations or positions that the residuals know nothing of, as
    where an arm does not turn: zeros lie on every grid.
    """
    small = deviations / _NOTHING
    telling = left.reshape(2, 3).sum(axis=1) >= _TELLING
    rotations = printed.rotations
    if rotations is not None and telling[0] and small[0] < rotations.grid.half:
        rotations = None
    positions = printed.positions
    if positions is not None and telling[1] and small[1] < positions.half:
        positions = None
    return printed._replace(rotations=rotations, positions=positions)


def _refined(printed: Digits) -> Iterator[Digits]:
    """The digits as they were found, then with more and more of the joint readings', at last all."""
    for more in range(MOST):
        yield printed._replace(
            angles=_finer(printed.angles, more),
            lengths=_finer(printed.lengths, more),
        )
    yield printed._replace(angles=None, lengths=None)


def _finer(grid: Grid | None, more: int) -> Grid | None:
    if grid is None or grid.places + more > MOST:
        return None
    return grid._replace(places=grid.places + more)


def _expected(digits: Digits, fit: Propagation, left: Array, chain: Chain) -> _Expected:
    """The residuals that rounding to these digits lets expect: uniform errors of variance h^2 / 3,
    as of each of three axes of a rotation, of which the fit leaves a part.

    Compared are the numbers whose digits are known, or all where they are of neither kind. Source
    of the degrees of freedom: Satterthwaite 1946.
    """
    joints = _joint_errors(digits, chain)
    halves = np.zeros(2)
    if digits.rotations is not None:
        halves[0] = digits.rotations.grid.half
    if digits.positions is not None:
        halves[1] = digits.positions.half
    known = np.repeat(halves > 0, 3)
    if not known.any():
        known[:] = True
    halves = np.maximum(halves, ROUNDING * np.array([1.0, chain.reach]))
    moved = fit.jacobian * joints
    covariance = (moved @ np.swapaxes(moved, 1, 2) + np.diag(np.repeat(halves**2, 3))) / 3.0
    variances = np.mean(np.diagonal(covariance, axis1=1, axis2=2), axis=0)
    weighted = (covariance / np.outer(fit.deviations, fit.deviations))[:, known][:, :, known]
    squares = np.diagonal(weighted, axis1=1, axis2=2).sum(axis=0)
    mean = float(squares @ left[known]) / len(fit.errors)
    residuals = (fit.errors / fit.deviations)[:, known]
    return _Expected(
        found=float(np.sum(residuals**2)),
        mean=mean,
        freedom=max(1.0, mean * float(squares.sum()) / float(np.sum(weighted**2))),
        deviations=np.sqrt(variances.reshape(2, 3).mean(axis=1)),
    )


def _deviations(fit: Propagation, left: Array) -> Array:
    """Standard deviations (2,) of the residuals, rad and m, without what the parameters took up."""
    squares = np.sum(fit.errors.reshape(-1, 2, 3) ** 2, axis=(0, 2))
    return np.sqrt(squares / np.maximum(left.reshape(2, 3).sum(axis=1), 1.0))


def _pose_errors(digits: Digits) -> Array:
    """Largest errors (2,) of rotations, rad, and positions, m, of known digits."""
    errors = np.zeros(2)
    if digits.rotations is not None:
        errors[0] = digits.rotations.radius
    if digits.positions is not None:
        errors[1] = digits.positions.half
    return errors


def _joint_errors(digits: Digits, chain: Chain) -> Array:
    """Largest error (m,) of each coordinate, rad or m."""
    halves = [0.0 if grid is None else grid.half for grid in (digits.angles, digits.lengths)]
    return np.where(_turning(chain), *halves)


def _turning(chain: Chain) -> Mask:
    """Mask (m,) of the coordinates that are angles."""
    return np.array([chain.is_angle(k) for k in range(chain.dof)], bool)
