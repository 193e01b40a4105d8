"""The six equations hold at every configuration of the loop, and of no other are they asked."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.ik.elimination import line_equations
from poekin.groups import so3
from tests.formulas.ik.elimination.loops import arm, equations, halves, line


@given(st.integers(0, 2**32 - 1))
def test_six_equations_hold_at_the_angles_that_the_line_was_made_of(seed):
    h, P, x, E = arm(seed)
    p, d = line(P, E, h)
    sigma, _ = equations(h, P, p, d)
    left = np.einsum("rijk,i,j,k", sigma, *(halves(x[i]) for i in (2, 3, 4)))
    size = np.abs(sigma).max()
    # some hundred roundings of terms of that size and of the squares of lengths
    assert np.abs(left).max() <= 400 * 2.3e-16 * max(size, (1 + np.linalg.norm(p)) ** 2)
    off = np.einsum("rijk,i,j,k", sigma, *(halves(x[i] + 0.3) for i in (2, 3, 4)))
    assert np.abs(off).max() > 1e-6 * size


@given(st.integers(0, 2**32 - 1))
def test_quarter_turns_are_the_rotation_at_three_angles(seed):
    rng = np.random.default_rng(seed)
    h = rng.normal(size=3)
    h /= np.linalg.norm(h)
    a = rng.normal(size=3)
    expected = so3.exp(h * np.array([[0.0], [np.pi / 2], [np.pi]])) @ a
    # a few sums of numbers of the length of a
    assert np.abs(line_equations.quarter_turns(h, a) - expected).max() <= 2e-15 * np.linalg.norm(a)
