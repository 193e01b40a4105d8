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


# fourth powers of smaller numbers are 0
@given(
    st.lists(
        st.floats(-1.0, 1.0).map(lambda x: x if abs(x) > 1e-75 else 0.0), min_size=12, max_size=12
    )
)
def test_the_longest_column_and_the_longest_row_of_a_vector_tell_its_angles(v):
    V = np.reshape(v, (4, 3))
    columns = [np.linalg.norm(V[:, k]) for k in range(3)]
    rows = [np.linalg.norm(V[k, [0, 1, 1, 2]]) for k in range(4)]
    for lengths in (columns, rows):
        if np.diff(np.sort(lengths)[-2:]) < 1e-9:  # rounding tells which is longer
            return
    longest = V[:, np.argmax(columns)], V[np.argmax(rows), [0, 1, 1, 2]]
    expected = []
    for C, S, C2, S2 in longest:
        x = 2 * (np.arctan2(S2, C2) if abs(C) < abs(S2) else np.arctan2(S, C))
        expected += [np.cos(x), np.sin(x)]
    assert joints.outer(v) == pytest.approx(expected, abs=1e-14)


def test_of_no_length_the_point_is_that_of_the_angle_0():
    assert joints.unit(0.0, 0.0) == (1.0, 0.0)


@pytest.mark.parametrize("length, told", [(0.5, 0.64), (1e-3, 4e-6), (2.0, 0.64)])
def test_how_well_the_second_angle_is_told_is_of_the_equations_not_of_their_size(length, told):
    # rows (length, 0) and (0, -1), so that (2 length / (1 + length^2))^2 is told: 4 length^2 of
    # a small one, but for 2 length^2 of it
    x, y, z, zero = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
    p = (length, 0.0, 0.0)
    found = joints.second((x, z), (zero, zero), p, x, p, y)
    assert found[2] == pytest.approx(told, rel=1e-5)


@given(st.integers(0, 2**32 - 1))
def test_how_well_it_is_told_is_one_where_both_singular_values_of_the_equations_are_equal(seed):
    h, P, _, E = arm(seed)
    p, d = map(tuple, line(P, E, h))
    h = tuples(h)
    P = tuples(P)
    rows = [joints._row(w, h[1], a, 0.0)[:2] for w in (h[0], P[0]) for a in (p, d)]
    sizes = np.linalg.svd(rows, compute_uv=False)
    expected = (2.0 * sizes[0] * sizes[1] / (sizes[0] ** 2 + sizes[1] ** 2)) ** 2
    assert joints.second(h, P, p, d, p, d)[2] == pytest.approx(expected, abs=1e-14)
