"""Components of vectors that turn against matrices in 60 digits."""

from __future__ import annotations

import math

import mpmath

from poekin.formulas.ik.turned_component import turned_component
from tests.formulas.ik.moved import place

ZERO = (0.0, 0.0, 0.0)


def test_the_component_of_a_turned_vector_is_that_of_rodrigues():
    w, k, a = ((0.3, -0.4, 0.5), (0.0, 0.6, 0.8), (1.0, -2.0, 0.5))
    A, B, C = turned_component(w, k, a)
    with mpmath.workdps(60):
        for theta in (0.0, 0.3, -1.2, 3.0):
            turned = place([k], [ZERO, a], [theta])[0]
            expected = sum(mpmath.mpf(x) * y for x, y in zip(w, turned, strict=True))
            assert abs(A * math.cos(theta) + B * math.sin(theta) + C - expected) < 1e-15
