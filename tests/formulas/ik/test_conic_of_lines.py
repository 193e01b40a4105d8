"""The pair of lines in a pencil of conics: its parts, each against NumPy."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np
import pytest

from poekin.formulas.ik import circle_conic


def parallel(a, b) -> float:
    """Sine of the angle between two vectors."""
    return float(np.linalg.norm(np.cross(a, b)) / (np.linalg.norm(a) * np.linalg.norm(b)))


def test_two_lines_are_found_in_their_conic_whichever_entry_of_their_meeting_point_is_the_largest():
    rng = np.random.default_rng(0)
    largest = set()
    for _ in range(60):
        g, h = rng.normal(size=(2, 3))
        M = 0.5 * (np.outer(g, h) + np.outer(h, g))
        Q = (M[0, 0], M[0, 1], M[1, 1], M[0, 2], M[1, 2], M[2, 2])
        meeting = np.abs(np.cross(g, h))
        largest.add(int(np.argmax(meeting)))
        found = circle_conic._lines(Q)
        # the point is known to some roundings of M^2 over its own size, squared
        limit = 1e-14 * np.sum(M**2) / np.sum(meeting**2)
        in_order = max(parallel(found[0], g), parallel(found[1], h))
        turned = max(parallel(found[0], h), parallel(found[1], g))
        assert min(in_order, turned) <= limit
    assert largest == {0, 1, 2}


@pytest.mark.parametrize("turns", range(3))
def test_two_lines_are_found_where_they_meet_on_an_axis_of_which_the_other_entries_are_0(turns):
    g, h = np.roll([[0.9, 0.3, 0.0], [-0.4, 0.7, 0.0]], turns, axis=1)
    M = 0.5 * (np.outer(g, h) + np.outer(h, g))
    found = circle_conic._lines((M[0, 0], M[0, 1], M[1, 1], M[0, 2], M[1, 2], M[2, 2]))
    apart = [min(parallel(line, g), parallel(line, h)) for line in found]
    assert max(apart) <= 1e-14  # some ten roundings of numbers below 1


@pytest.mark.parametrize("lengths", list(permutations((1.0, 2.0, 3.0))))
def test_the_longest_of_three_is_taken_in_any_order(lengths):
    a, b, c = [(0.0, -x, 0.5 * x) for x in lengths]
    assert circle_conic._longest(a, b, c) == (0.0, -3.0, 1.5)


@pytest.mark.parametrize("i, j", list(product(range(3), repeat=2)))
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_the_largest_entry_of_the_longest_row_comes_first_by_turning_rows_and_columns(i, j, sign):
    M = np.random.default_rng([i, j]).normal(size=(3, 3))
    M[i, j] = sign * 9.0
    turned = circle_conic._largest_first(*(tuple(row) for row in M.tolist()))
    expected = np.roll(M, (-i, -j), (0, 1))
    np.testing.assert_array_equal(turned, expected)


def test_the_determinant_is_that_of_the_matrix():
    rng = np.random.default_rng(1)
    for _ in range(50):
        a, b, c, d, e, f = Q = tuple(rng.normal(size=6).tolist())
        M = np.array([[a, b, d], [b, c, e], [d, e, f]])
        expected = np.linalg.det(M)
        # some roundings of products of three entries
        limit = 1e-15 * np.linalg.norm(M) ** 3
        assert abs(circle_conic._determinant(Q) - expected) <= limit
    assert circle_conic._determinant((0.0,) * 6) == 0.0


@pytest.mark.parametrize("roots, passes", [((0.0, 0.2, 0.25), 1), ((0.0, 0.01, 0.02), 2)])
def test_only_roots_of_the_cubic_that_nearly_meet_are_looked_for_twice(roots, passes, monkeypatch):
    calls = []
    ends = circle_conic._ends

    def counted(*given):
        calls.append(given)
        return ends(*given)

    monkeypatch.setattr(circle_conic, "_ends", counted)
    a, b, c = roots
    # the pencil of diag(A, C, F) has the roots -A, -C and F
    found = circle_conic._with_lines((-a, 0.0, -b, 0.0, 0.0, c))
    assert len(calls) == passes
    values = found[0] * found[2] * found[5]
    assert abs(values) <= 1e-17
