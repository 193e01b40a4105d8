"""Hypothesis strategies for kinematics: angles, axes, twists, poses, noisy rotations; chains are in `chain_strategies`.

The one idea: magnitudes are log-uniform and **independent**, an angle never scaled together with a length. With that
a logarithm or exponential that is wrong in some decade is found within a few hundred cases; with Gaussian samples it
is not. 0, every switch point of the package's formulas ± 1 ulp, π - 10⁻ᵏ and π itself are drawn on purpose.
Everything shrinks, towards 0 and the x axis. All arrays are float64 and read-only.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

from poekin.errors import MissingExtra

try:
    from hypothesis import strategies as st
except ImportError as error:
    raise MissingExtra("hypothesis", "testing", "poekin.testing.strategies") from error

from .reader import Reader

SWITCHES = (2e-140, 1.0, 2.0)
"""Angles in rad at which the package's formulas for exp, log and the Jacobians of exp change their form."""
LENGTHS = (1e-12, 1e3)
"""The smallest length in m that is drawn beside 0, and the largest."""

T = TypeVar("T")
Arrays = st.SearchStrategy[np.ndarray]
Reals = st.SearchStrategy[float]


def frozen(x: object) -> np.ndarray:
    """A read-only float64 array."""
    array = np.array(x, dtype=float)
    array.flags.writeable = False
    return array


def read(size: int, decode: Callable[[Reader], T]) -> st.SearchStrategy[T]:
    """What `decode` makes of `size` random bytes.

    Hypothesis spreads bytes evenly; of its numbers it draws most next to 0, and of a case made of several choices it
    tries many with one of them set to its simplest, where nothing is learnt here. As bytes a case is one choice.
    """
    return st.binary(min_size=size, max_size=size).map(lambda data: decode(Reader(data)))


def magnitudes(smallest: float = 1e-150, largest: float = 1e3) -> Reals:
    """0, or log-uniform from smallest to largest; shrinks to 0, then to 1 and to powers of 10."""
    return read(4, lambda r: r.magnitude(smallest, largest))


def around(x: float) -> tuple[float, float, float]:
    """The number x and the floats on both sides of it."""
    return x, math.nextafter(x, -math.inf), math.nextafter(x, math.inf)


def angles(largest: float = math.pi, smallest: float = 1e-150) -> Reals:
    """Rotation angles in rad, 0 to largest: log-uniform, uniform, and the special ones.

    Special are the switches ± 1 ulp, π/2, π - 10⁻ᵏ, π and 2π. Log-uniform ones are mostly above 1e-12, where most
    formulas go wrong.
    """
    return read(6, functools.partial(_angle, largest=largest, smallest=smallest))


@functools.cache
def axes() -> Arrays:
    """Unit vectors (3,): along an axis of the frame, nearly so, or anywhere."""
    return read(12, lambda r: frozen(_axis(r)))


def vectors(lengths: tuple[float, float] = LENGTHS) -> Arrays:
    """Vectors (3,): 0 or a log-uniform length within the bounds, times an independent direction."""
    return read(16, lambda r: frozen(_vector(r, lengths)))


def rotation_vectors(largest: float = math.pi, smallest: float = 1e-150) -> Arrays:
    """Rotation vectors ω (3,) in rad, |ω| as in `angles` (to the rounding of |ω|)."""
    return read(18, lambda r: frozen(_angle(r, largest, smallest) * _axis(r)))


def twists(largest: float = math.pi, lengths: tuple[float, float] = LENGTHS, smallest: float = 1e-150) -> Arrays:
    """Twists (ω; v) (6,): |ω| as in `angles`, |v| as in `vectors`, the two independent."""
    return read(34, lambda r: frozen(np.concatenate([_angle(r, largest, smallest) * _axis(r), _vector(r, lengths)])))


@functools.cache
def rotations() -> Arrays:
    """Rotations (3, 3), orthonormal to a few roundings: e^{[n]θ} of a unit n, by NumPy alone."""
    return read(18, lambda r: frozen(_rotation(r)))


def noisy_rotations(noise: tuple[float, float] = (1e-17, 1e-8)) -> Arrays:
    """Rotations (3, 3), each entry off by up to a size that is 0 or within the bounds."""

    def noisy(r: Reader) -> np.ndarray:
        R, size = _rotation(r), r.magnitude(*noise)
        return frozen(R + size * np.reshape([r.fraction(-1.0, 1.0) for _ in range(9)], (3, 3)))

    return read(49, noisy)


def poses(lengths: tuple[float, float] = LENGTHS) -> Arrays:
    """Poses (4, 4) with any rotation and an independent translation as in `vectors`."""
    return read(34, lambda r: pose(_rotation(r), _vector(r, lengths)))


def pose(R: np.ndarray, t: np.ndarray) -> np.ndarray:
    """The read-only pose (4, 4) of a rotation and a translation."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, t
    return frozen(T)


def batch_shapes() -> st.SearchStrategy[tuple[int, ...]]:
    """Shapes of leading axes: none, an empty one, one, several."""
    return st.sampled_from([(), (1,), (0,), (3, 1, 2)])


def batches(elements: Arrays, shape: Sequence[int]) -> Arrays:
    """Arrays (*shape, ...) of the elements; where the shape holds none, one element is drawn for its own shape."""
    count = math.prod(shape)
    drawn = st.lists(elements, min_size=max(count, 1), max_size=max(count, 1))
    return drawn.map(lambda x: frozen(np.stack(x)[:count].reshape(*shape, *x[0].shape)))


def group_cases(kinds: Sequence[str], size: int) -> st.SearchStrategy[tuple[np.ndarray, ...]]:
    """Arguments of a group's law by their kinds (`laws.Law`), for SO(3) (size 3) or SE(3) (size 6).

    "twist" is principal (|ω| up to π), "far_twist" has |ω| up to 10, "element" is a rotation or pose, and
    "noisy_element" one with a defect of up to 1e-8 an entry.
    """
    if size == 3:
        arguments = {"twist": rotation_vectors(), "far_twist": rotation_vectors(10.0)}
        arguments |= {"element": rotations(), "noisy_element": noisy_rotations()}
    else:
        arguments = {"twist": twists(), "far_twist": twists(10.0)}
        arguments |= {"element": poses(), "noisy_element": st.builds(pose, noisy_rotations(), vectors())}
    return st.tuples(*(arguments[kind] for kind in kinds))


@functools.cache
def _marks(largest: float, smallest: float) -> list[float]:
    marks = [*(x for s in SWITCHES for x in around(s)), math.pi]
    marks += [x for centre in (math.pi, math.pi / 2, 2 * math.pi) for x in around(centre)]
    return [x for x in marks if smallest <= x <= largest]


def _angle(r: Reader, largest: float, smallest: float) -> float:
    kind, fresh = r.byte() % 12, min(max(smallest, 1e-12), largest)
    if kind < 5:
        return r.magnitude(fresh, largest)
    if kind < 6:
        return r.magnitude(smallest, max(smallest, 1e-12))
    if kind < 8 and (marks := _marks(largest, smallest)):
        return r.pick(marks)
    if kind < 10 and largest >= math.pi:
        return max(math.pi - 10.0 ** -r.fraction(0.0, 16.0), 0.0)
    return r.fraction(0.0, largest)


def _axis(r: Reader) -> np.ndarray:
    kind, place, sign = r.byte() % 4, r.byte(), 1.0 if r.byte() < 128 else -1.0
    n = np.array([sign, 0.0, 0.0])
    if kind == 1:
        n[1:] = [10.0 ** -r.fraction(1.0, 17.0), -(10.0 ** -r.fraction(1.0, 17.0))]
    elif kind > 1:
        anywhere = np.array([r.fraction(-1.0, 1.0) for _ in range(3)])
        n = anywhere if math.hypot(*anywhere) > 0.1 else n
    return np.roll(n / math.hypot(*n), place % 3)


def _vector(r: Reader, lengths: tuple[float, float]) -> np.ndarray:
    return r.magnitude(*lengths) * _axis(r)


def _rotation(r: Reader) -> np.ndarray:
    n, angle = _axis(r), _angle(r, math.pi, 1e-150)
    N = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + math.sin(angle) * N + 2 * math.sin(angle / 2) ** 2 * (N @ N)
