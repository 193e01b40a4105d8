"""Hypothesis strategies for kinematics: angles, axes, twists, rotations, poses and batches of them.

The one idea: magnitudes are log-uniform and independent, an angle never scaled together with a
length. With that a logarithm or exponential that is wrong in some decade is found within a few
hundred cases; with Gaussian samples it is not. 0, every switch point of the package's formulas ± 1
ulp, π - 10⁻ᵏ and π itself are drawn on purpose.
Everything shrinks, towards 0 and the x axis. All arrays are float64 and read-only, in rad and m,
twists (ω; v), poses of a frame in the base frame; what is drawn is no more exact than its rounding.

Raises: InputError, at the call, for bounds that are no finite numbers.
Source: how peers' tests miss what these find is measured in
tests/testing/strategies/test_group_strategies.py.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import get_args

import numpy as np

from poekin.errors import InputError, safe_repr

from ..laws.laws import GroupKind
from . import arguments
from .decoding import decoders
from .decoding.arrays import Arrays, Reals, frozen, pose, read, st
from .decoding.bytes_reader import BytesReader
from .decoding.decoders import SMALLEST, SWITCHES, around

__all__ = [
    "KINDS",
    "LENGTHS",
    "SMALLEST",
    "SWITCHES",
    "angles",
    "around",
    "axes",
    "frozen",
    "group_cases",
    "magnitudes",
    "noisy_rotations",
    "pose",
    "poses",
    "quaternions_wxyz",
    "read",
    "rotation_vectors",
    "rotations",
    "twists",
    "vectors",
]

LENGTHS = (1e-12, 1e3)
"""The smallest length in m that is drawn beside 0, and the largest."""


def magnitudes(smallest: float = SMALLEST, largest: float = 1e3) -> Reals:
    """Numbers that are 0, one time in sixteen, or log-uniform.

    Parameters
    ----------
    smallest : float, default 1e-150
        Smallest number beside 0.
    largest : float, default 1e3
        Largest number.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of floats; shrinks to 0, then to 1 and powers of 10.

    Raises
    ------
    InputError
        If bounds are no finite numbers, or not 0 < smallest <= largest.
    """
    bounds = arguments.magnitudes("smallest, largest", (smallest, largest))
    return read(4, lambda r: r.magnitude(*bounds))


def angles(largest: float = math.pi, smallest: float = SMALLEST) -> Reals:
    """Rotation angles: log-uniform, uniform, and special ones.

    Special are the switches of formulas ± 1 ulp, π/2, π - 10⁻ᵏ, π and 2π. Log-uniform ones are mostly
    above 1e-12, where most formulas go wrong. Of 24 angles one lies within 1e-12 of π; for all of them
    there, see `near_strategies`.

    Parameters
    ----------
    largest : float, default π
        Largest angle, rad.
    smallest : float, default 1e-150
        Smallest angle beside 0, rad.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of floats, rad; shrinks to 0.

    Raises
    ------
    InputError
        If bounds are no finite numbers, or not 0 < smallest <= largest.
    """
    smallest, largest = _turning(largest, smallest)
    return read(6, functools.partial(decoders.angle, largest=largest, smallest=smallest))


@functools.cache
def axes() -> Arrays:
    """Unit vectors: along an axis of the frame (1 of 4), nearly so (1 of 4), or anywhere.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (3,); shrinks to x.
    """
    return read(12, lambda r: frozen(decoders.axis(r)))


def vectors(lengths: tuple[float, float] = LENGTHS) -> Arrays:
    """Vectors of length 0, or of log-uniform length, in an independent direction.

    Directions are as in `axes`.

    Parameters
    ----------
    lengths : tuple of float, default (1e-12, 1e3)
        Smallest |v| beside 0, and largest, m.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (3,), m; shrinks to 0.

    Raises
    ------
    InputError
        If bounds are no finite numbers, or not 0 < smallest <= largest.
    """
    bounds = arguments.magnitudes("lengths", lengths)
    return read(16, lambda r: frozen(decoders.vector(r, bounds)))


def rotation_vectors(largest: float = math.pi, smallest: float = SMALLEST) -> Arrays:
    """Rotation vectors ω, |ω| as in `angles`, with an axis as in `axes`.

    Parameters
    ----------
    largest : float, default π
        Largest |ω|, rad.
    smallest : float, default 1e-150
        Smallest |ω| beside 0, rad.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (3,), rad; shrinks to 0.

    Raises
    ------
    InputError
        If bounds are no finite numbers, or not 0 < smallest <= largest.
    """
    smallest, largest = _turning(largest, smallest)
    return read(18, lambda r: frozen(decoders.angle(r, largest, smallest) * decoders.axis(r)))


def twists(
    largest: float = math.pi,
    lengths: tuple[float, float] = LENGTHS,
    smallest: float = SMALLEST,
) -> Arrays:
    """Twists (ω; v), |ω| as in `angles`, |v| as in `vectors`, all independent.

    Each half has its own direction. With both scaled together an exponential that is wrong passes.

    Parameters
    ----------
    largest : float, default π
        Largest |ω|, rad.
    lengths : tuple of float, default (1e-12, 1e3)
        Smallest |v| beside 0, and largest, m.
    smallest : float, default 1e-150
        Smallest |ω| beside 0, rad.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (6,), rad and m, of any frame; shrinks to 0.

    Raises
    ------
    InputError
        If bounds are no finite numbers, or not 0 < smallest <= largest.

    Examples
    --------
    >>> from hypothesis import find, settings
    >>> import numpy as np
    >>> import poekin as pk
    >>> from poekin.testing import strategies
    >>> def hasty(xi):  # as if a small rotation were none
    ...     return pk.se3.exp(xi if abs(xi[:3]).max() > 1e-5 else [0, 0, 0, *xi[3:]])
    >>> def wrong(xi):
    ...     return np.abs(hasty(xi) - pk.se3.exp(xi)).max() > 1e-9
    >>> xi = find(strategies.twists(), wrong, settings=settings(database=None, derandomize=True))
    >>> int(np.count_nonzero(xi)) <= 2
    True
    """
    smallest, largest = _turning(largest, smallest)
    bounds = arguments.magnitudes("lengths", lengths)

    def twist(r: BytesReader) -> np.ndarray:
        w = decoders.angle(r, largest, smallest) * decoders.axis(r)
        return frozen(np.concatenate([w, decoders.vector(r, bounds)]))

    return read(34, twist)


@functools.cache
def rotations() -> Arrays:
    """Rotations e^{[n]θ}, θ as in `angles`, n as in `axes`.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (3, 3), orthonormal to a few roundings; shrinks to I.
    """
    return read(18, lambda r: frozen(decoders.rotation(r)))


def noisy_rotations(noise: tuple[float, float] = (1e-17, 1e-8)) -> Arrays:
    """Rotations as in `rotations`, with noise in each entry.

    Parameters
    ----------
    noise : tuple of float, default (1e-17, 1e-8)
        Smallest size of the noise beside 0, and largest.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (3, 3); shrinks to no noise.

    Raises
    ------
    InputError
        If bounds are no finite numbers, or not 0 < smallest <= largest.
    """
    bounds = arguments.magnitudes("noise", noise)

    def noisy(r: BytesReader) -> np.ndarray:
        R = decoders.rotation(r)
        size = r.magnitude(*bounds)
        return frozen(R + size * np.reshape([r.fraction(-1.0, 1.0) for _ in range(9)], (3, 3)))

    return read(49, noisy)


def poses(lengths: tuple[float, float] = LENGTHS) -> Arrays:
    """Poses with a rotation as in `rotations` and an independent translation.

    Parameters
    ----------
    lengths : tuple of float, default (1e-12, 1e3)
        Smallest |t| beside 0, and largest, m.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (4, 4), of a frame in the base frame, m; shrinks to I.

    Raises
    ------
    InputError
        If bounds are no finite numbers, or not 0 < smallest <= largest.
    """
    bounds = arguments.magnitudes("lengths", lengths)
    return read(34, lambda r: pose(decoders.rotation(r), decoders.vector(r, bounds)))


@functools.cache
def quaternions_wxyz() -> Arrays:
    """Unit quaternions (cos θ/2, n sin θ/2), w first, of both signs.

    θ is as in `angles`, n as in `axes`; w is near 0 where θ is near π. x y z w is np.roll(q, -1).

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (4,), of length 1 to rounding; shrinks to (1, 0, 0, 0).
    """

    def quaternion(r: BytesReader) -> np.ndarray:
        n = decoders.axis(r)
        theta = decoders.angle(r, math.pi, SMALLEST)
        sign = -1.0 if r.byte() >= 128 else 1.0
        return frozen(sign * np.array([math.cos(theta / 2), *(math.sin(theta / 2) * n)]))

    return read(19, quaternion)


KINDS = get_args(GroupKind)
"""What a law of a group may ask for."""


def group_cases(
    kinds: Sequence[GroupKind],
    size: int,
) -> st.SearchStrategy[tuple[np.ndarray, ...]]:
    """Arguments of a law of a group by their kinds.

    Parameters
    ----------
    kinds : sequence of str
        Kinds of `KINDS`: "twist" is principal (|ω| up to π), "far_twist" has |ω| up to 10, "element" is a
        rotation (3, 3) or pose (4, 4), and "noisy_element" one with a defect of up to 1e-8 an entry.
    size : {3, 6}
        Length of the twists, 3 for SO(3), 6 for SE(3).

    Returns
    -------
    strategy : SearchStrategy
        Strategy of tuples of twists (size,) and elements, rad and m, one for each kind.

    Raises
    ------
    InputError
        For other kinds or sizes.
    """
    if size == 3:
        known = {"twist": rotation_vectors(), "far_twist": rotation_vectors(10.0)}
        known |= {"element": rotations(), "noisy_element": noisy_rotations()}
    elif size == 6:
        known = {"twist": twists(), "far_twist": twists(10.0)}
        known |= {
            "element": poses(),
            "noisy_element": st.builds(pose, noisy_rotations(), vectors()),
        }
    else:
        raise InputError(f"size: expected 3 for SO(3) or 6 for SE(3), got {safe_repr(size)}")
    return st.tuples(*(known[kind] for kind in arguments.some("kinds", kinds, KINDS)))


def _turning(largest: float, smallest: float) -> tuple[float, float]:
    return arguments.magnitudes("smallest, largest (|ω| in rad)", (smallest, largest))
