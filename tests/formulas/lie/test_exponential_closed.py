"""A, B and cos theta of exp where theta is large, against 60 digits: what rounding took from theta
is put back.
"""

from __future__ import annotations

import numpy as np

from poekin.algebra import dot
from poekin.formulas.lie import exponential
from poekin.testing.oracles import exact
from poekin.testing.oracles.exact import mp

UNIT = 2.0**-53


def errors(w):
    """Of theta A, theta^2 B and cos theta, in units of 2^-53."""
    w = tuple(map(float, w))
    a, b, cosine = exponential.closed(w, dot(w, w))
    t = exact.norm(exact.exactly(w))
    return [
        abs(float(e)) / UNIT
        for e in (t * a - mp.sin(t), t * t * b - (1 - mp.cos(t)), cosine - mp.cos(t))
    ]


def test_what_rounding_takes_from_the_angle_does_not_count_in_a_b_and_the_cosine():
    rng = np.random.default_rng(5)
    vectors = rng.normal(size=(400, 3))
    vectors *= (rng.uniform(1, 10, 400) / np.linalg.norm(vectors, axis=1))[:, None]
    worst = np.max([errors(w) for w in vectors], axis=0)
    # sin and cos to 1 u, a sum and a quotient to u each of what is at most 1, or 2 of 1 - cos
    # theta, and u of the rest that is put back. An angle that is off by u theta alone would count
    # 10.
    assert (worst <= [3, 5, 2]).all(), worst
