"""Read-only arrays, and strategies of what is read off random bytes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from poekin.errors import MissingExtra

try:
    from hypothesis import strategies as st
except ImportError as error:
    raise MissingExtra("hypothesis", "testing", "poekin.testing.strategies") from error

from .bytes_reader import BytesReader

T = TypeVar("T")
Arrays = st.SearchStrategy[np.ndarray]
Reals = st.SearchStrategy[float]


def frozen(x: object) -> np.ndarray:
    """Read-only float64 array of numbers.

    Parameters
    ----------
    x : (...) array_like
        Numbers of any unit.

    Returns
    -------
    x : (...) ndarray
        The array.
    """
    array = np.array(x, dtype=float)
    array.flags.writeable = False
    return array


def pose(R: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Read-only pose of a rotation and a translation.

    Parameters
    ----------
    R : (3, 3) ndarray
        Rotation.
    t : (3,) ndarray
        Translation in the frame of R, m.

    Returns
    -------
    T : (4, 4) ndarray
        Pose in the same frame.
    """
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = t
    return frozen(T)


def read(
    size: int,
    decode: Callable[[BytesReader], T],
) -> st.SearchStrategy[T]:
    """Strategy of values read off random bytes: to write strategies like these.

    Hypothesis spreads bytes evenly; of its numbers it draws most next to 0, and of a case made of
    several choices it tries many with one of them set to its simplest, where nothing is learnt here.
    As bytes a case is one choice.

    Parameters
    ----------
    size : int
        Number of bytes that are drawn.
    decode : callable
        Function that makes a value of a `BytesReader`.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of the values; shrinks to the value of zeros.

    Examples
    --------
    >>> from hypothesis import find
    >>> from poekin.testing.strategies.group_strategies import read
    >>> lengths = read(4, lambda r: r.magnitude(1e-6, 1.0))
    >>> find(lengths, lambda x: x > 0)
    0.1
    """
    return st.binary(min_size=size, max_size=size).map(lambda data: decode(BytesReader(data)))
