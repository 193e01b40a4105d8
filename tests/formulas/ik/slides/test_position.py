"""Three joints of any kinds against the place that matrix exponentials bring a point to."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from poekin.formulas.ik.slides import position

U = 2.0**-53
SEEDS = st.integers(0, 2**32 - 1)
ALL = list(product([False, True], repeat=3))
NAMES = ["".join("P" if slide else "R" for slide in one) for one in ALL]


def move(slide, h, x):
    """A joint's motion (4, 4) by the exponential of its matrix."""
    A = np.zeros((4, 4))
    if slide:
        A[:3, 3] = h
    else:
        A[:3, :3] = [[0, -h[2], h[1]], [h[2], 0, -h[0]], [-h[1], h[0], 0]]
    return expm(x * A)


def place(slides, h, P, x):
    y = np.append(P[2], 1.0)
    for i in (2, 1, 0):
        y = move(slides[i], h[i], x[i]) @ y
        if i:
            y[:3] += P[i - 1]
    return y[:3]


def arm(seed, square):
    """Axes, steps and coordinates; of a `square` arm the axes are along those of the base."""
    rng = np.random.default_rng(seed)
    h = rng.normal(size=(3, 3))
    if square:
        h = np.eye(3)[rng.integers(0, 3, 3)] * rng.choice([-1.0, 1.0], 3)[:, None]
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    return h, rng.uniform(-1, 1, (3, 3)), rng.uniform(-2, 2, 3)


def rows_of(slides, h, P, p):
    found = np.array(position.roots(slides, tuple(map(tuple, h)), tuple(map(tuple, P)), tuple(p)))
    x = np.where(slides, found[:, 0:6:2], np.arctan2(found[:, 1:6:2], found[:, 0:6:2]))
    return x, found[:, 6]


def smallest_velocity(slides, h, P, x):
    """The smallest singular value of the point's derivatives, by central differences."""
    steps = 1e-6 * np.eye(3)
    J = [(place(slides, h, P, x + d) - place(slides, h, P, x - d)) / 2e-6 for d in steps]
    return np.linalg.svd(np.array(J))[1][-1]


@given(SEEDS, st.booleans())
def test_a_vector_across_is_of_unit_length_whichever_way_the_axis_points(seed, square):
    for h in arm(seed, square)[0]:
        u = position.across(tuple(h))
        assert abs(np.dot(u, h)) <= 4 * U
        assert abs(np.linalg.norm(u) - 1) <= 4 * U


@pytest.mark.parametrize("slides", ALL, ids=NAMES)
@given(SEEDS, st.booleans())
def test_the_coordinates_that_a_place_was_made_of_are_found(slides, seed, square):
    h, P, q = arm(seed, square)
    p = place(slides, h, P, q)
    least = smallest_velocity(slides, h, P, q)
    if least < 0.05:
        return  # singular, or nearly so: roots are double
    x, margins = rows_of(slides, h, P, p)
    off = x[margins > 0] - q
    off = np.where(slides, off, np.remainder(off + np.pi, 2 * np.pi) - np.pi)
    assert len(off)
    # some 100 roundings of numbers up to 10, twice over the slope: of the equations and of x_2
    assert np.abs(off).max(axis=1).min() <= 4000 * U / least**2


@pytest.mark.parametrize("slides", ALL, ids=NAMES)
@given(SEEDS, st.booleans())
def test_every_row_with_a_margin_brings_the_point_there(slides, seed, square):
    h, P, q = arm(seed, square)
    p = place(slides, h, P, q)
    x, margins = rows_of(slides, h, P, p)
    for row in x[margins > 0]:
        least = smallest_velocity(slides, h, P, row)
        if least > 0.05:
            size = 10 + np.abs(row[list(slides)]).max(initial=0)
            assert np.abs(place(slides, h, P, row) - p).max() <= 1000 * U * size / least**2


@pytest.mark.parametrize("slides", ALL, ids=NAMES)
def test_a_place_out_of_reach_has_no_margin_where_an_arm_turns(slides):
    if slides[0] or slides[2] or slides[1]:
        return
    h, P, _ = arm(1, False)
    _, margins = rows_of(slides, h, P, np.array([9.0, 0.0, 0.0]))
    assert (margins < 0).all()


@pytest.mark.parametrize("slides", ALL, ids=NAMES)
def test_at_rest_every_joint_is_at_0_though_steps_cancel_and_numbers_are_0(slides):
    h = np.array([(0.0, 0.6, 0.8), (0.8, 0.0, 0.6), (0.6, 0.8, 0.0)])
    P = np.array([(1.0, 0.5, 2.0), (-1.0, -0.5, -2.0), (0.0, 1.0, 2.0)])
    x, margins = rows_of(slides, h, P, P[2])
    least = smallest_velocity(slides, h, P, np.zeros(3))
    assert least > 0.02
    assert np.abs(x[margins > 0]).max(axis=1).min() <= 4000 * U / least**2
