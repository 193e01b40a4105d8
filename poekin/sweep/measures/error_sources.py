"""Errors of an arm's screws and home pose as independent sources: from tolerances, a covariance or a
calibration.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError, ShapeError
from ...groups import se3
from ...groups.arrays import Array
from ...model.chain import Chain
from ...solve.calibration.model.error_model import across, joint_frames
from ...solve.calibration.result import CalibrationData

_STEP = 1e-4
_FITS = 1e-6  # of a screw's change, that no motion of the screw explains: differences err by 1e-8
_NEGATIVE = -1e-10  # of the largest eigenvalue of a covariance, by rounding


def tolerance_sources(
    chain: Chain,
    tilt: ArrayLike,
    shift: ArrayLike,
    offset: ArrayLike,
    home_rotation: float,
    home_position: float,
) -> Array:
    """Sources (K, n + 1, 6), each one number of the arm that is off by its tolerance. Raises:
    InputError, ShapeError.
    """
    n = len(chain.joint_names)
    tilts = _sizes(tilt, n, "tilt")
    shifts = _sizes(shift, n, "shift")
    offsets = _sizes(offset, chain.dof, "offset")
    rotation = _size(home_rotation, "home_rotation")
    position = _size(home_position, "home_position")
    frames = joint_frames(chain)
    twists = np.swapaxes(across(frames), 1, 2)
    sizes = np.stack([tilts, tilts, shifts, shifts], axis=1)
    twists *= sizes[..., None]
    slides = chain.local.rotates == 0
    twists[slides, 2:] = 0.0  # a slide has a direction and no place
    of_screws = np.zeros((n, 4, n + 1, 6))
    for i, of_screw in enumerate(twists):
        of_screws[i, :, i] = of_screw
    of_offsets = _offset_sources(chain) * offsets[:, None, None]
    of_home = np.zeros((6, n + 1, 6))
    of_home[:3, n, :3] = rotation * np.eye(3)
    of_home[3:, n, 3:] = position * np.eye(3)
    parts = [of_screws.reshape(-1, n + 1, 6), of_offsets, of_home]
    return _kept(np.concatenate(parts))


def covariance_sources(chain: Chain, covariance: ArrayLike) -> Array:
    """Sources whose covariance is that of (eta_1, ..., eta_n, eta). Raises: InputError, ShapeError."""
    n = len(chain.joint_names)
    C = np.asarray(covariance, float)
    size = 6 * (n + 1)
    if C.shape != (size, size):
        raise ShapeError(f"covariance: expected ({size}, {size}), got {C.shape}")
    sources = _half(C).T
    return _kept(sources.reshape(size, n + 1, 6))


def calibration_sources(found: CalibrationData) -> Array:
    """Sources of what a calibration left unknown of the arm that it found. Raises: InputError."""
    model = found.error_model
    if model.terms:
        raise InputError(
            f"calibration: {model.terms[0].name!r} is no error of a screw: calibrate without it"
        )
    count = len(model.parameters)
    p = found.values[:count]
    n = len(found.chain.joint_names)
    twists = np.empty((count, n + 1, 6))
    steps = _STEP * np.eye(count)
    for k, step in enumerate(steps):
        ahead = model.chain(p + step)
        behind = model.chain(p - step)
        if not np.array_equal(ahead.coupling, behind.coupling):
            raise InputError(
                f"calibration: {model.parameters[k].name} is a gain, whose error no screw has"
            )
        moved = _between(behind, ahead, found.chain)
        twists[k] = moved / (2.0 * _STEP)
    C = found.covariance[:count, :count]
    H = _half(C)
    return _kept(np.tensordot(H.T, twists, axes=1))


def _between(behind: Chain, ahead: Chain, chain: Chain) -> Array:
    """eta_1 ... eta_n, eta (n + 1, 6) that lead from one arm to the other. Raises: InputError."""
    change = ahead.screws - behind.screws
    largest = np.abs(change).max()
    etas = []
    for A, dA in zip(chain.screws, change, strict=True):
        to_change = -se3.ad(A)
        eta, *_ = np.linalg.lstsq(to_change, dA, rcond=1e-9)
        left = to_change @ eta - dA
        if np.abs(left).max() > _FITS * largest:
            raise InputError(
                "calibration: a pitch is estimated, whose error no motion of a screw has"
            )
        etas.append(eta)
    way = se3.inverse(behind.home) @ ahead.home
    return np.array([*etas, se3.log(way)])


def _offset_sources(chain: Chain) -> Array:
    """Sources (m, n + 1, 6) of each coordinate's offset: a joint that stands farther by dx moves all
    behind it by A_i dx.
    """
    n = len(chain.joint_names)
    to_tool = se3.inverse(chain.home)
    Ad = se3.adjoint(to_tool)
    found = np.zeros((chain.dof, n + 1, 6))
    for i, A in enumerate(chain.screws):
        ways = chain.coupling[i][:, None, None]
        found[:, i + 1 : n] += ways * A
        found[:, n:] += ways * (Ad @ A)
    return found


def _half(C: Array) -> Array:
    """H with H Hᵀ = C. Raises: InputError."""
    is_finite = np.isfinite(C).all()
    if not is_finite or not np.allclose(C, C.T, rtol=1e-9, atol=0.0):
        raise InputError("covariance: expected a symmetric matrix of finite numbers")
    values, vectors = np.linalg.eigh((C + C.T) / 2)
    if values.size and values[0] < _NEGATIVE * values[-1]:
        raise InputError(f"covariance: expected no negative eigenvalue, got {values[0]:g}")
    return vectors * np.sqrt(np.maximum(values, 0.0))


def _kept(sources: Array) -> Array:
    largest = np.abs(sources).max(axis=(1, 2), initial=0.0)
    return sources[largest > 0]


def _sizes(values: ArrayLike, count: int, what: str) -> Array:
    sizes: Any = np.asarray(values, float)
    if sizes.shape not in ((), (count,)):
        raise ShapeError(f"{what}: expected one or {count} numbers, got {sizes.shape}")
    is_size = np.isfinite(sizes) & (sizes >= 0)
    if not is_size.all():
        raise InputError(f"{what}: expected finite numbers from 0 on, got {values}")
    return np.broadcast_to(sizes, count)


def _size(value: float, what: str) -> float:
    (size,) = _sizes([value], 1, what)
    return float(size)
