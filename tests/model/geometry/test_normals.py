"""Common normals of lines, in 50 digits: where they stand, which way they point, and the angle
about them.
"""

from __future__ import annotations

from decimal import Decimal

import pytest

from poekin.model.geometry.normals import ZERO, common_normal, digits, exact, parallel_normal

ORIGIN, X, Y, Z = exact([0, 0, 0]), exact([1, 0, 0]), exact([0, 1, 0]), exact([0, 0, 1])
DOWN = exact([0, 0, -1])


@pytest.mark.parametrize(("z2", "cosine"), [(Z, 1), (DOWN, -1)], ids=["same", "opposite"])
def test_parallel_lines_have_their_normal_at_the_point_of_the_first_and_no_sine(z2, cosine):
    with digits():
        found = parallel_normal(ORIGIN, Z, exact([0, 2, 7]), z2, X, Decimal("1e-16"))
    assert found == (ORIGIN, Y, 2, ZERO, cosine)


def test_of_one_and_the_same_line_the_normal_keeps_x_and_has_no_length():
    with digits():
        found = parallel_normal(ORIGIN, Z, exact([0, 1e-17, 5]), DOWN, X, Decimal("1e-16"))
    assert found == (ORIGIN, X, ZERO, ZERO, -1)


@pytest.mark.parametrize("side", [3, -3])
def test_a_common_normal_points_to_the_second_line_and_the_angle_is_about_it(side):
    # Y is a quarter turn from z about -x.
    with digits():
        found = common_normal(exact([0, 0, 5]), Z, exact([side, 8, 1]), Y)
    assert found == (exact([0, 0, 1]), exact([side / 3, 0, 0]), 3, -side / 3, 0)


def test_lines_that_meet_have_their_normal_along_the_product_of_their_directions():
    with digits():
        found = common_normal(exact([0, 0, 5]), Z, exact([0, 8, 1]), Y)
    assert found == (exact([0, 0, 1]), exact([-1, 0, 0]), 0, 1, 0)


def test_slanted_lines_are_as_far_apart_as_along_the_product_of_their_directions():
    # The second line passes the first, z through the origin, 2 m beside it at a height of 4 m.
    slanted = exact([0, 0.6, 0.8])
    with digits():
        found = common_normal(ORIGIN, Z, exact([2, 3, 8]), slanted)
    assert found.foot == pytest.approx((0, 0, 4), abs=Decimal("1e-15"))
    assert found.x == pytest.approx((1, 0, 0), abs=Decimal("1e-40"))
    assert found.a == pytest.approx(2, abs=Decimal("1e-40"))
    assert float(found.sine) == -0.6
    assert float(found.cosine) == 0.8
