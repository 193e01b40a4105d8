"""Hypothesis strategies for kinematics: angles, axes, twists, rotations, poses and batches of them.

The one idea: magnitudes are log-uniform and independent, an angle never scaled together with a
length. With that
a logarithm or exponential that is wrong in some decade is found within a few hundred cases; with
Gaussian samples it
is not. 0, every switch point of the package's formulas ± 1 ulp, π - 10⁻ᵏ and π itself are drawn on
purpose.
Everything shrinks, towards 0 and the x axis. All arrays are float64 and read-only, in rad and m,
twists (ω; v), poses of a frame in the base frame; what is drawn is no more exact than its rounding.

Parameters of many: largest and smallest, of |ω| in rad beside 0; lengths, (smallest, largest) of
|v| or |t| in m beside 0. Returns: a strategy, to be given to `hypothesis.given` or drawn from in a
composite one.
Raises: InputError, at the call, for bounds that are no finite numbers, or not 0 < smallest <=
largest.
Source: how peers' tests miss what these find is measured in
tests/testing/strategies/test_group_strategies.py.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

from poekin.errors import InputError, MissingExtra, safe_repr

try:
    from hypothesis import strategies as st
except ImportError as error:
    raise MissingExtra("hypothesis", "testing", "poekin.testing.strategies") from error

from . import arguments
from .decoding import decoders
from .decoding.bytes_reader import BytesReader
from .decoding.decoders import SMALLEST, SWITCHES, around

__all__ = [
    "BATCH_SHAPES",
    "KINDS",
    "LENGTHS",
    "SMALLEST",
    "SWITCHES",
    "angles",
    "around",
    "axes",
    "batch_shapes",
    "batches",
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
BATCH_SHAPES = ((), (1,), (0,), (3, 1, 2))
"""The shapes of leading axes that a function of batches has to know: none, one, an empty one,
several.
"""

T = TypeVar("T")
Arrays = st.SearchStrategy[np.ndarray]
Reals = st.SearchStrategy[float]


def frozen(x: object) -> np.ndarray:
    """A read-only float64 array of the numbers x, of any shape (...)."""
    array = np.array(x, dtype=float)
    array.flags.writeable = False
    return array


def read(size: int, decode: Callable[[BytesReader], T]) -> st.SearchStrategy[T]:
    """Strategy of decode(r) of `size` random bytes r, which it gets as a `BytesReader`: to write
    strategies like these.

    Hypothesis spreads bytes evenly; of its numbers it draws most next to 0, and of a case made of
    several choices it tries many with one of them set to its simplest, where nothing is learnt
    here. As bytes a case is one choice.
    """
    return st.binary(min_size=size, max_size=size).map(lambda data: decode(BytesReader(data)))


def magnitudes(smallest: float = SMALLEST, largest: float = 1e3) -> Reals:
    """0 (one time in sixteen), or log-uniform from smallest to largest; shrinks to 0, then to 1 and
    powers of 10.
    """
    bounds = arguments.magnitudes("smallest, largest", (smallest, largest))
    return read(4, lambda r: r.magnitude(*bounds))


def angles(largest: float = math.pi, smallest: float = SMALLEST) -> Reals:
    """Rotation angles in rad, 0 to largest: log-uniform, uniform, and the special ones; shrinks to
    0.

    Special are the switches ± 1 ulp, π/2, π - 10⁻ᵏ, π and 2π. Log-uniform ones are mostly above
    1e-12, where most formulas go wrong. Of 24 angles one lies within 1e-12 of π; for all of them
    there, see `near_strategies`.
    """
    smallest, largest = _turning(largest, smallest)
    return read(6, functools.partial(decoders.angle, largest=largest, smallest=smallest))


@functools.cache
def axes() -> Arrays:
    """Unit vectors (3,): along an axis of the frame (1 of 4), nearly so (1 of 4), or anywhere;
    shrinks to x.
    """
    return read(12, lambda r: frozen(decoders.axis(r)))


def vectors(lengths: tuple[float, float] = LENGTHS) -> Arrays:
    """Vectors (3,) in m: 0 or a log-uniform length within the bounds, times an independent
    direction as in `axes`.
    """
    bounds = arguments.magnitudes("lengths", lengths)
    return read(16, lambda r: frozen(decoders.vector(r, bounds)))


def rotation_vectors(largest: float = math.pi, smallest: float = SMALLEST) -> Arrays:
    """Rotation vectors ω (3,) in rad, |ω| as in `angles` (to the rounding of |ω|), its axis as in
    `axes`.
    """
    smallest, largest = _turning(largest, smallest)
    return read(18, lambda r: frozen(decoders.angle(r, largest, smallest) * decoders.axis(r)))


def twists(
    largest: float = math.pi, lengths: tuple[float, float] = LENGTHS, smallest: float = SMALLEST
) -> Arrays:
    """Twists (ω; v) (6,): |ω| as in `angles`, |v| as in `vectors`, each with its own direction; all
    independent.
    """
    smallest, largest = _turning(largest, smallest)
    bounds = arguments.magnitudes("lengths", lengths)

    def twist(r: BytesReader) -> np.ndarray:
        w = decoders.angle(r, largest, smallest) * decoders.axis(r)
        return frozen(np.concatenate([w, decoders.vector(r, bounds)]))

    return read(34, twist)


@functools.cache
def rotations() -> Arrays:
    """Rotations (3, 3), orthonormal to a few roundings: e^{[n]θ} by NumPy alone, θ as in `angles`,
    n as in `axes`.
    """
    return read(18, lambda r: frozen(decoders.rotation(r)))


def noisy_rotations(noise: tuple[float, float] = (1e-17, 1e-8)) -> Arrays:
    """Rotations (3, 3) as in `rotations`, each entry off by up to a size that is 0, or log-uniform
    between the bounds.

    Parameters: noise, (smallest, largest) of that size. Shrinks to no noise.
    """
    bounds = arguments.magnitudes("noise", noise)

    def noisy(r: BytesReader) -> np.ndarray:
        R = decoders.rotation(r)
        size = r.magnitude(*bounds)
        return frozen(R + size * np.reshape([r.fraction(-1.0, 1.0) for _ in range(9)], (3, 3)))

    return read(49, noisy)


def poses(lengths: tuple[float, float] = LENGTHS) -> Arrays:
    """Poses (4, 4) with a rotation as in `rotations` and an independent translation as in
    `vectors`.
    """
    bounds = arguments.magnitudes("lengths", lengths)
    return read(34, lambda r: pose(decoders.rotation(r), decoders.vector(r, bounds)))


@functools.cache
def quaternions_wxyz() -> Arrays:
    """Unit quaternions (4,), w first: (cos θ/2, n sin θ/2), θ as in `angles`, n as in `axes`; of
    both signs.

    Of length 1 to rounding, and near w = 0 where θ is near π. x y z w is `np.roll(q, -1)`. Shrinks
    to (1, 0, 0, 0).
    """

    def quaternion(r: BytesReader) -> np.ndarray:
        n = decoders.axis(r)
        theta = decoders.angle(r, math.pi, SMALLEST)
        sign = -1.0 if r.byte() >= 128 else 1.0
        return frozen(sign * np.array([math.cos(theta / 2), *(math.sin(theta / 2) * n)]))

    return read(19, quaternion)


def pose(R: np.ndarray, t: np.ndarray) -> np.ndarray:
    """The read-only pose (4, 4) of a rotation R (3, 3) and a translation t (3,) in m, in the same
    frame.
    """
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = t
    return frozen(T)


def batch_shapes() -> st.SearchStrategy[tuple[int, ...]]:
    """Shapes of leading axes, `BATCH_SHAPES`, each as often as any: none, one, an empty one,
    several; shrinks to ().
    """
    return st.sampled_from(BATCH_SHAPES)


def batches(elements: Arrays, shape: Sequence[int]) -> Arrays:
    """Arrays (*shape, ...) of elements drawn independently of each other.

    Parameters: elements, a strategy of arrays of one shape (...) each; shape, of the leading axes,
    such as `batch_shapes` draws: `batch_shapes().flatmap(lambda shape: batches(twists(), shape))`.
    Where the shape holds
    none, one element is drawn for its own shape.
    """
    sizes = arguments.shape(shape)
    if not isinstance(elements, st.SearchStrategy):
        raise InputError(f"elements: expected a strategy of arrays, got {safe_repr(elements)}")
    count = math.prod(sizes)
    drawn = st.lists(elements, min_size=max(count, 1), max_size=max(count, 1))
    return drawn.map(lambda x: frozen(np.stack(x)[:count].reshape(*sizes, *np.shape(x[0]))))


KINDS = ("twist", "far_twist", "element", "noisy_element")
"""What a law of a group may ask for."""


def group_cases(kinds: Sequence[str], size: int) -> st.SearchStrategy[tuple[np.ndarray, ...]]:
    """Arguments of a group's law by their kinds (`laws.Law`), for SO(3) (size 3) or SE(3) (size 6).

    Parameters: kinds, of `KINDS`: "twist" is principal (|ω| up to π), "far_twist" has |ω| up to 10,
    "element" is a rotation (3, 3) or pose (4, 4), and "noisy_element" one with a defect of up to
    1e-8 an entry; size, 3 or 6.
    Returns: a strategy of tuples of twists (size,) and elements, one for each kind. Raises:
    InputError for others.
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
