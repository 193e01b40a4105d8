"""Screws from axis, point and pitch, and back."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ScrewError, ShapeError

vectors = st.tuples(*[st.floats(-10, 10)] * 3).map(np.array)
axes = vectors.filter(lambda v: np.linalg.norm(v) > 1e-3)


@given(axes, vectors)
def test_a_revolute_screw_gives_back_its_axis_and_the_foot_of_the_perpendicular(z, p):
    axis = pk.screw.axis_of(pk.screw.revolute(z, p))
    n = z / np.linalg.norm(z)
    np.testing.assert_allclose(axis.direction, n, rtol=0, atol=1e-15)
    assert axis.point is not None
    np.testing.assert_allclose(axis.point, p - n * (n @ p), rtol=0, atol=1e-13)  # of lengths up to 17 m: 50 u each
    assert axis.pitch == 0


@given(axes, vectors, st.floats(1e-6, 1))
def test_a_helical_screw_gives_back_its_pitch(z, p, h):
    axis = pk.screw.axis_of(pk.screw.helical(z, p, h))
    # omega . v of v = p x omega + h omega: each of the nine products is rounded up to five times on its way
    assert axis.pitch == pytest.approx(h, rel=0, abs=9 * 5 * 2.0**-53 * (np.linalg.norm(p) + h))


@given(axes)
def test_a_prismatic_screw_has_a_direction_and_no_place(z):
    axis = pk.screw.axis_of(pk.screw.prismatic(z))
    np.testing.assert_allclose(axis.direction, z / np.linalg.norm(z), rtol=0, atol=1e-15)
    assert axis.point is None
    assert axis.pitch == np.inf


@given(axes, vectors, vectors, st.floats(-3, 3))
def test_a_point_on_the_axis_stays_where_it_is(z, p, x, q):
    S = pk.screw.revolute(z, p)
    moved = pk.se3.exp(S * q) @ [*p, 1]
    # the terms of e^{S q} p that cancel are up to (1 + 2 |q|) |p|, |p| <= 17 m, and each is rounded a few times
    np.testing.assert_allclose(moved[:3], p, rtol=0, atol=16 * 2.0**-53 * 7 * 2 * 17.4)


def test_an_axis_may_have_any_length():
    np.testing.assert_array_equal(pk.screw.prismatic([0, 0, 1e-300]), [0, 0, 0, 0, 0, 1])
    np.testing.assert_array_equal(pk.screw.prismatic([0, 0, -1e300]), [0, 0, 0, 0, 0, -1])


@pytest.mark.parametrize(
    "function, arguments, error",
    [
        (pk.screw.revolute, ([0, 0, 0], [0, 0, 0]), ScrewError),
        (pk.screw.revolute, ([0, 0, np.nan], [0, 0, 0]), InputError),
        (pk.screw.revolute, ([0, 0, 1], [0, 0, np.inf]), InputError),
        (pk.screw.revolute, ([0, 0], [0, 0, 0]), ShapeError),
        (pk.screw.helical, ([0, 0, 1], [0, 0, 0], "x"), InputError),
        (pk.screw.prismatic, ([[0, 0, 1]],), InputError),
        (pk.screw.axis_of, ([0, 0, 2, 0, 0, 0],), ScrewError),
        (pk.screw.axis_of, ([0, 0, 1],), ShapeError),
    ],
    ids=lambda x: getattr(x, "__name__", None) or repr(x),
)
def test_what_makes_no_screw_is_refused(function, arguments, error):
    with pytest.raises(error):
        function(*arguments)
