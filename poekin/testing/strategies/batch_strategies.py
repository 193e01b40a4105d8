"""Hypothesis strategies for batches: the shapes of leading axes, and arrays of independent elements.

Arrays are float64 and read-only. Raises: InputError, at the call, for what is no shape or no
strategy. Source: the shapes that functions of batches are known to get wrong.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from poekin.errors import InputError, safe_repr

from . import arguments
from .decoding.arrays import Arrays, frozen, st

BATCH_SHAPES = ((), (1,), (0,), (3, 1, 2))
"""The shapes of leading axes that a function of batches has to know: none, one, an empty one,
several.
"""


def batch_shapes() -> st.SearchStrategy[tuple[int, ...]]:
    """Shapes of leading axes: none, one, an empty one, several, each as often as any.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of `BATCH_SHAPES`; shrinks to ().
    """
    return st.sampled_from(BATCH_SHAPES)


def batches(elements: Arrays, shape: Sequence[int]) -> Arrays:
    """Arrays of elements that are drawn independently of each other.

    Parameters
    ----------
    elements : SearchStrategy
        Strategy of arrays of one shape (...), of any unit.
    shape : sequence of int
        Shape of the leading axes; if it holds none, one element is drawn for its own shape.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (*shape, ...).

    Raises
    ------
    InputError
        If the elements are no strategy, or the shape is none.

    Examples
    --------
    >>> from hypothesis import find
    >>> from poekin.testing import strategies
    >>> twists = strategies.batches(strategies.twists(), (3, 1, 2))
    >>> find(twists, lambda xi: True).shape
    (3, 1, 2, 6)
    """
    sizes = arguments.shape(shape)
    if not isinstance(elements, st.SearchStrategy):
        raise InputError(f"elements: expected a strategy of arrays, got {safe_repr(elements)}")
    count = math.prod(sizes)
    drawn = st.lists(elements, min_size=max(count, 1), max_size=max(count, 1))
    return drawn.map(lambda x: frozen(np.stack(x)[:count].reshape(*sizes, *np.shape(x[0]))))
