"""A design that grows by one candidate at a time, each the one that adds most to log det N."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ....groups.arrays import Array
from ..model.tsqr import blocked_product, qr_r

# of the information of a mean candidate: stands in for what the first few do not see
REGULARISATION = 1e-9


def greedy(
    blocks: Array,
    n: int,
    tick: Callable[[], None] = lambda: None,
    given: Array | None = None,
) -> list[int]:
    """n rows of blocks (K, r, L), each the one that adds most to log det N; tick() after each.

    given (k, L): rows of what was measured before.
    """
    count, rows, size = blocks.shape
    before = rows_before(given, size)
    # On axes in which all candidates together show every direction alike: what is best is the same.
    flat = blocks.reshape(-1, size)
    R = qr_r(np.concatenate([flat, before]))
    even: Any = np.linalg.inv(R)
    flat = blocked_product(flat, even)
    blocks = flat.reshape(blocks.shape)
    before = before @ even
    N = np.eye(size) * (REGULARISATION / count) + before.T @ before
    chosen: list[int] = []
    for _ in range(n):
        # det(N + B^T B) = det N det(1 + B N^-1 B^T)
        weighted = blocked_product(flat, np.linalg.inv(N))
        products = weighted.reshape(blocks.shape) @ blocks.transpose(0, 2, 1)
        factors = np.eye(rows) + products
        _, gains = np.linalg.slogdet(factors)
        gains[chosen] = -np.inf
        best = int(gains.argmax())
        chosen.append(best)
        N = N + blocks[best].T @ blocks[best]
        tick()
    return chosen


def rows_before(given: Array | None, size: int) -> Array:
    """Rows (k, L) of what was measured before, of nothing where there is none."""
    if given is None:
        return np.empty((0, size))
    return given
