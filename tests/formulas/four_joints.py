"""Four joints between generic constant poses: one that only turns, one that only slides, two helical
ones. A chain of one joint and one of two go the ways that longer ones do not.
"""

from __future__ import annotations

import numpy as np
import pytest

from tests.formulas.matrices import exp, product

rng = np.random.default_rng(3)
MOST = 4
ROTATES, SLIDES = np.array([1.0, 0.0, 0.8, -0.9]), np.array([0.0, 1.0, 0.2, 0.3])
X, RATES = rng.normal(size=MOST), rng.normal(size=MOST)
LOCAL = [np.array([0, 0, r, 0, 0, s]) for r, s in zip(ROTATES, SLIDES, strict=True)]
ANGLES = ROTATES * X
MOTION = (np.sin(ANGLES), np.cos(ANGLES), SLIDES * X)
FEW = 1e-13  # eleven products of poses whose entries reach 10
COUNTS = pytest.mark.parametrize("count", [1, 2, 3, 4])

LINKS = [exp(xi) for xi in rng.normal(size=(MOST + 1, 6))]
TOOL, PARENT = exp(rng.normal(size=6)), exp(rng.normal(size=6))
SCREWS = rng.normal(size=(MOST, 6))
MOVES = [exp(S * x) for S, x in zip(LOCAL, X, strict=True)]
EXPONENTIALS = [exp(S * x) for S, x in zip(SCREWS, X, strict=True)]
MOVED = [L @ E for L, E in zip(LINKS[:MOST], MOVES, strict=True)]  # f_{i-1,i} = M_i e^{S_i x_i}
FRAMES = [product(*MOVED[: i + 1]) for i in range(MOST)]


def rows(count):
    return np.full((6, count), np.nan)


def same(got, expected):
    np.testing.assert_allclose(got, expected, rtol=0, atol=FEW)
