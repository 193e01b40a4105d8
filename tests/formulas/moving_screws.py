"""Derivatives of Jacobians of a chain by central differences of Jacobians made of
matrix exponentials.

A step of 1e-5 leaves 1e-10 of a third derivative (up to 1e3 here); a wrong sign or index is an
error of about 1.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.formulas.matrices import Ad, exp

rng = np.random.default_rng(8)
MOST, STEP, CLOSE = 4, 1e-5, 2e-7
SCREWS, HOME_XI = rng.normal(size=(MOST, 6)), rng.normal(size=6)
X, RATES, SECOND = rng.normal(size=(3, MOST))
COUNTS = pytest.mark.parametrize("count", [1, 2, 3, 4])
FRAMES = pytest.mark.parametrize("frame", ["space", "body", "hybrid"])


def twist_of(D, T):
    """The twist of dT T^-1."""
    V = D @ np.linalg.inv(T)
    return np.r_[V[2, 1], V[0, 2], V[1, 0], V[:3, 3]]


HOME = exp(HOME_XI)


def products(screws, x):
    """P_0 = I, P_i = P_{i-1} e^{A_i x_i}, and f = P_n M."""
    found = [np.eye(4)]
    for S, xi in zip(screws, x, strict=True):
        found.append(found[-1] @ exp(S * xi))
    return found


def jacobian(screws, home, x, frame):
    before = products(screws, x)
    f = before[-1] @ home
    J = np.transpose([Ad(T) @ S for T, S in zip(before, screws, strict=False)])
    if frame == "body":
        return Ad(np.linalg.inv(f)) @ J
    if frame == "hybrid":
        at = np.eye(4)
        at[:3, 3] = -f[:3, 3]
        return Ad(at) @ J
    return J


def slope(function: Any) -> Any:
    return (function(STEP) - function(-STEP)) / (2 * STEP)


def close(got, expected):
    np.testing.assert_allclose(got, expected, rtol=0, atol=CLOSE)
