"""Configurations drawn at random, and the range that a coordinate without limits is given."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..checks import whole
from ..errors import InputError
from ..groups.arrays import Array
from .chain_data import ChainData
from .readings.coupled import beyond_own_limits, sum_limits

DRAWS = 10_000
"""Draws of a configuration after which there is hardly any."""


def random(
    chain: ChainData,
    rng: np.random.Generator | int,
    size: int | tuple[int, ...] = (),
) -> Array:
    """Configurations (*size, m) drawn uniformly from what of `sampling_range` keeps the joints
    within their own limits. Raises: InputError where next to nothing does.
    """
    rng = _generator(rng)
    lengths = size if isinstance(size, Sequence) else (size,)
    shape = tuple(whole(length, "size", 0) for length in lengths)
    low, high = sampling_range(chain)
    width = high - low
    q = low + width * rng.random((*shape, chain.dof))
    for _ in range(DRAWS):
        beyond = beyond_own_limits(chain, q).any(axis=-1)
        if not beyond.any():
            return q
        q[beyond] = low + width * rng.random(q[beyond].shape)
    raise InputError(
        f"random: of {DRAWS} draws within the coordinates' limits, none keeps the joints within "
        "their own: joint_limits"
    )


def _generator(rng: np.random.Generator | int) -> np.random.Generator:
    if isinstance(rng, np.random.Generator):
        return rng
    return np.random.default_rng(whole(rng, "rng, as a seed", 0))


def sampling_range(chain: ChainData) -> tuple[Array, Array]:
    """Least and greatest value (m,) that `random` draws of each coordinate."""
    half = half_range(chain)
    lower, upper = chain.limits.T
    has_lower = np.isfinite(lower)
    has_upper = np.isfinite(upper)
    lowest = np.where(has_upper, upper - 2 * half, -half)
    highest = np.where(has_lower, lower + 2 * half, half)
    low = np.where(has_lower, lower, lowest)
    high = np.where(has_upper, upper, highest)
    _move_to_joint_limits(chain, low, high)
    return low, high


def largest_slides(chain: ChainData) -> Array:
    """Largest distance (n,) that each joint slides within `sampling_range`, m."""
    low, high = sampling_range(chain)
    C = chain.coupling
    middle = low / 2 + high / 2
    half = high / 2 - low / 2
    farthest = np.abs(C @ middle + chain.offset)
    farthest += np.abs(C) @ half
    return np.abs(chain.local.slides) * farthest


def _move_to_joint_limits(chain: ChainData, low: Array, high: Array) -> None:
    """Moves ranges of coordinates without limits to where the joints are in the middle of their own,
    where they do not reach that.

    Of the coordinates that a joint follows the one is moved that the fewest limited joints follow.
    """
    limited = np.isfinite(chain.joint_limits).any(axis=1)
    C = chain.coupling
    free = np.isinf(chain.limits).all(axis=1)
    shared = np.count_nonzero(C[limited], axis=0)
    for j in np.flatnonzero(limited):
        ranges = np.stack([low, high], axis=1)
        (ends,) = sum_limits(C[j : j + 1], ranges) + chain.offset[j]
        own = chain.joint_limits[j]
        middle = own.mean()
        if np.isinf(middle):
            middle = np.clip(ends.mean(), *own)
        moving = np.flatnonzero(free & (C[j] != 0))
        if len(moving) and not ends[0] <= middle <= ends[1]:
            k = moving[np.argmin(shared[moving])]
            moved = (middle - ends.mean()) / C[j, k]
            low[k] += moved
            high[k] += moved


def half_range(chain: ChainData) -> Array:
    """Greatest value (m,) that `random` draws of coordinates without limits; the least is its
    opposite.
    """
    ranges = np.where(angle_mask(chain), np.pi, 1.0)
    return ranges / joint_ratios(chain)


def radians_per_unit(chain: ChainData) -> Array:
    """Radians (m,) by which the joint that a coordinate moves most turns with its unit; 0 for a
    length.
    """
    return np.where(angle_mask(chain), np.pi / half_range(chain), 0.0)


def angle_mask(chain: ChainData) -> NDArray[np.bool_]:
    """Whether each coordinate (m,) is an angle."""
    coordinates = range(chain.dof)
    return np.array([chain.is_angle(k) for k in coordinates], bool)


def joint_ratios(chain: ChainData) -> Array:
    """Radians or metres (m,) by which the joint that a coordinate moves most goes with its unit."""
    return np.abs(dominant_ratios(chain))


def dominant_ratios(chain: ChainData) -> Array:
    """Ratios (m,) of largest size to each coordinate, of joints that turn where it is an angle and
    slide where not.
    """
    found = np.ones(chain.dof)
    C = chain.nontrivial_coupling
    if C is None:
        return found
    slides = np.array(chain.kinds) == "prismatic"
    for k, is_angle in enumerate(angle_mask(chain)):
        ratios = C[slides != is_angle, k]
        if ratios.any():
            found[k] = max(ratios, key=abs)
    return found
