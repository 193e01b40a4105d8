"""The other five angles of a loop, told by one of them and a vector of products."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas.ik.elimination import joints
from tests.formulas.ik.elimination.loops import arm, line, products, tuples

angles = st.floats(-np.pi, np.pi)


@given(angles, angles, st.floats(-1.0, 1.0).filter(lambda k: abs(k) > 1e-3))
def test_a_vector_of_products_tells_its_two_angles_whatever_its_length(x4, x5, length):
    v = [length * product for product in products(x4, x5)]
    # squares of the vector's largest entries, brought to the circle
    assert joints.outer(v) == pytest.approx(
        (np.cos(x4), np.sin(x4), np.cos(x5), np.sin(x5)), abs=1e-14
    )


@given(st.integers(0, 2**32 - 1))
def test_three_angles_tell_the_other_three(seed):
    h, P, x, E = arm(seed)
    p, d = line(P, E, h)
    R = np.linalg.multi_dot(E)
    across = np.cross(h[5], [0.3, -0.8, 0.5])
    points = tuple(f(x[i]) for i in (2, 3, 4) for f in (np.cos, np.sin))
    loop = (tuples(h), tuples(P), tuple(p), tuple(d), tuple(R.ravel()), tuple(across))
    found, told, gap = joints.every(*loop, points)
    expected = np.stack([np.cos(x), np.sin(x)], axis=1).ravel()
    # normal equations: rounding of squares of lengths over their determinant
    size = (1 + np.linalg.norm(p)) ** 2
    assert np.abs(np.array(found) - expected).max() <= 1e-14 * size**2 / told
    assert gap <= 1e-14 * size**2 / told
    # at other angles the line is elsewhere
    turned = (*points[:4], *(np.cos(x[4] + 0.1), np.sin(x[4] + 0.1)))
    assert joints.every(*loop, turned)[2] > 1e-6
