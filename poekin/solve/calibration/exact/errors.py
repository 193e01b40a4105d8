"""Largest errors of joint readings and poses: half a unit of the digits they were printed with, or
by the residuals where there are no digits.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import rotation_part, translation_part
from ....model.chain import Chain
from ....model.sampling import angle_mask
from ..fit.losses import chi_square
from .bounds import ROUNDING, Propagation, ReadingErrors
from .digits import MOST, DecimalGrid, RotationGrid, angle_grid, length_grid, rotation_grid

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

    angles: DecimalGrid | None
    lengths: DecimalGrid | None
    positions: DecimalGrid | None
    rotations: RotationGrid | None

    @property
    def halves(self) -> Array:
        """Half a unit of the last digit of rotations, rad, and positions, m; 0 without digits."""
        rotations = self.rotations and self.rotations.grid
        return np.array([_half(rotations), _half(self.positions)])

    def __str__(self) -> str:
        named = {
            "joint angles": self.angles,
            "joint lengths": self.lengths,
            "positions": self.positions,
        }
        found = {name: grid for name, grid in named.items() if grid is not None}
        parts = [f"{name} to {grid}" for name, grid in found.items()]
        if self.rotations is not None:
            parts.append(f"rotations ({self.rotations.what}) to {self.rotations.grid}")
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
    """Whether the residuals refute errors as large as these, whether they are larger than these
    errors make them, and the deviations (2,), rad and m, that are to be expected.
    """

    too_small: bool
    too_large: bool
    deviations: Array


def printed_digits(chain: Chain, q: Array, T: Array) -> Digits:
    """Digits of readings (N, m) and poses (N, 4, 4) as they were printed."""
    turns = angle_mask(chain)
    angles = q[:, turns]
    lengths = q[:, ~turns]
    return Digits(
        angles=angle_grid(angles) if angles.size else None,
        lengths=length_grid(lengths) if lengths.size else None,
        positions=length_grid(translation_part(T)),
        rotations=rotation_grid(rotation_part(T)),
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
    sizes = np.array([1.0, chain.reach])
    allowed = np.maximum(expected.deviations, LIMITS * sizes)
    unknown = digits.halves == 0
    beyond = expected.too_large and not unknown.all()
    far = deviations > _MARGIN * allowed
    beyond |= bool((unknown & far).any())
    rounded = digits.halves
    if digits.rotations is not None:
        rounded[0] = digits.rotations.radius
    errors = np.where(unknown, TIMES * deviations, rounded)
    rotation, position = np.maximum(errors, ROUNDING * sizes).tolist()
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
    telling = left.reshape(2, 3).sum(axis=1) >= _TELLING
    idle = telling & (deviations < _NOTHING * printed.halves)
    if idle[0]:
        printed = printed._replace(rotations=None)
    if idle[1]:
        printed = printed._replace(positions=None)
    return printed


def _refined(printed: Digits) -> Iterator[Digits]:
    """The digits as they were found, then with more and more of the joint readings', at last all."""
    # With more than MOST places no grid is left.
    for more in (*range(MOST), MOST + 1):
        yield printed._replace(
            angles=_finer(printed.angles, more),
            lengths=_finer(printed.lengths, more),
        )


def _finer(grid: DecimalGrid | None, more: int) -> DecimalGrid | None:
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
    halves = digits.halves
    sizes = np.array([1.0, chain.reach])
    known = np.repeat((halves > 0) | ~halves.any(), 3)
    halves = np.maximum(halves, ROUNDING * sizes)
    moved = fit.jacobian * joints
    of_joints = moved @ np.swapaxes(moved, 1, 2)
    of_poses = np.diag(np.repeat(halves**2, 3))
    covariance = (of_joints + of_poses) / 3.0
    variances = _diagonals(covariance).mean(axis=0)
    whitened = covariance / np.outer(fit.deviations, fit.deviations)
    weighted = whitened[:, known][:, :, known]
    squares = _diagonals(weighted).sum(axis=0)
    errors = (fit.errors / fit.deviations)[:, known]
    mean = float(squares @ left[known]) / len(errors)
    total = float(np.sum(weighted**2))
    freedom = max(1.0, mean * float(squares.sum()) / total)
    found = freedom * float(np.sum(errors**2))
    of_each = variances.reshape(2, 3).mean(axis=1)
    return _Expected(
        too_small=found * _MARGIN < mean * chi_square(freedom, -_SURE),
        too_large=found > _MARGIN * mean * chi_square(freedom, _SURE),
        deviations=np.sqrt(of_each),
    )


def _diagonals(matrices: Array) -> Array:
    """Diagonals (N, k) of matrices (N, k, k)."""
    return np.diagonal(matrices, axis1=1, axis2=2)


def _deviations(fit: Propagation, left: Array) -> Array:
    """Standard deviations (2,) of the residuals, rad and m, without what the parameters took up."""
    errors = fit.errors.reshape(-1, 2, 3)
    squares = np.sum(errors**2, axis=(0, 2))
    freedom = left.reshape(2, 3).sum(axis=1)
    return np.sqrt(squares / np.maximum(freedom, 1.0))


def _joint_errors(digits: Digits, chain: Chain) -> Array:
    """Largest error (m,) of each coordinate, rad or m."""
    angle = _half(digits.angles)
    length = _half(digits.lengths)
    return np.where(angle_mask(chain), angle, length)


def _half(grid: DecimalGrid | None) -> float:
    return 0.0 if grid is None else grid.half
