"""Screws from axis, point and pitch, and back."""

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ScrewError, ShapeError
from poekin.testing.accuracy.error_bounds import UNIT as U

vectors = st.tuples(*[st.floats(-10, 10)] * 3).map(np.array)
axes = vectors.filter(lambda v: np.linalg.norm(v) > 1e-3)
pitches = st.one_of(st.just(0.0), st.floats(1e-6, 1), st.floats(-1, -1e-6))
Extended = np.longdouble
LEAST = 1e-300  # what is smaller has not all its digits


def made_off(z, p, h):
    """How far the screw of an axis, a point and a pitch is off ÷ what the docstrings of `revolute`
    and `helical` say.

    The direction: a quotient by the largest, the length of three squares of these, and the quotient
    by it are at most 5.5 u of each entry. Its moment has that of the direction, 2 u |p| of the two
    products and 4 u |p| of the part along the axis that is taken away: 12 u |p|; and h z has 8 u
    |h|. The truth is in extended precision, where there is one.
    """
    S, own = pk.screw.helical(z, p, h), float(np.finfo(Extended).eps)
    n = (z / np.abs(z).max()).astype(Extended) if np.abs(z).max() < 1e-290 else z.astype(Extended)
    n = n / np.sqrt(n @ n)
    v = np.cross(p.astype(Extended), n) + Extended(h) * n
    lengths = math.hypot(*p) + abs(h)  # which squares no small number
    turned, moved = np.abs(S[:3] - n).max() / (6 * U + 4 * own), np.abs(S[3:] - v).max()
    return float(max(turned, moved / (lengths * (12 * U + 8 * own) + LEAST)))


def read_off(z, p, h):
    """How far the axis of a screw is from the line of its numbers ÷ what the docstring of `axis_of`
    says.

    The length of omega may be off by 4 u, and so omega x v and omega . v by 8 u |v|, and by 4 u |v|
    of their products. What may be rounding of the pitch is none: 36 u of 1 m, or of |v|.
    """
    S = pk.screw.helical(z, p, h)
    axis, (w, v) = pk.screw.axis_of(S), S.astype(Extended).reshape(2, 3)
    assert axis.point is not None
    w = w / np.sqrt(w @ w)
    within = (12 * U + 4 * float(np.finfo(Extended).eps)) * math.hypot(*S[3:])
    off = [
        np.abs(axis.direction - w).max() / (4 * U),
        np.abs(axis.point - np.cross(w, v)).max() / (within + LEAST),
    ]
    rounding = 4e-15 * max(1.0, np.linalg.norm(S[3:]))
    off.append(abs(axis.pitch - w @ v) / (within + (rounding if axis.pitch == 0 else 0.0)))
    return float(max(off))


def moved_off(z, p, q):
    """How far a point of a revolute axis moves with it ÷ rounding.

    The terms of e^{S q} p that cancel are up to (1 + 2 |q|) |p|, each rounded a few times, and S
    has 12 u |p| of its own, times q.
    """
    moved = pk.se3.exp(pk.screw.revolute(z, p) * q) @ [*p, 1]
    return np.abs(moved[:3] - p).max() / (16 * U * (1 + 2 * abs(q)) * math.hypot(*p) + LEAST)


@given(axes, vectors, pitches)
def test_a_screw_has_the_axis_the_point_and_the_pitch_that_it_is_made_of(z, p, h):
    assert made_off(z, p, h) <= 1


@given(axes, vectors, pitches)
def test_a_screw_gives_back_its_axis_the_foot_of_the_perpendicular_and_its_pitch(z, p, h):
    assert read_off(z, p, h) <= 1
    axis = pk.screw.axis_of(pk.screw.helical(z, p, h))
    assert (axis.pitch == 0) == (h == 0)


@given(axes)
def test_a_prismatic_screw_has_a_direction_and_no_place(z):
    S = pk.screw.prismatic(z)
    np.testing.assert_array_equal(S[3:], pk.screw.revolute(z, [0, 0, 0])[:3])
    axis = pk.screw.axis_of(S)
    np.testing.assert_allclose(axis.direction, S[3:], rtol=0, atol=4 * U)
    assert axis.point is None
    assert axis.pitch == np.inf


@given(axes, vectors, st.floats(-3, 3))
@example(np.array([0.0, 0.0, 1.0]), np.array([0.0, 3.166505383751732e-243, 0.0]), 1.5)
def test_a_point_on_the_axis_stays_where_it_is(z, p, q):
    assert moved_off(z, p, q) <= 1


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


@given(axes, vectors, pitches, st.floats(0.992, 1.008))
def test_a_rounded_screw_is_brought_back_to_its_axis(z, p, h, scale):
    S = pk.screw.helical(z, p, h)
    found = pk.screw.normalised(scale * S)
    assert np.abs(found - S).max() <= 8 * U * max(1.0, np.abs(S).max())
    slide = pk.screw.prismatic(z)
    assert np.abs(pk.screw.normalised([scale * slide, slide])[0] - slide).max() <= 8 * U


def test_what_is_far_from_a_unit_screw_is_not_normalised():
    line = [0, 0, 1, 0, -0.5, 0]
    far = (
        r"^screws\[1\]: expected \|omega\| = 1, or omega = 0 and .* got \[0\.0, 0\.0, 1\.011, 0\.0,"
    )
    with pytest.raises(ScrewError, match=far):
        pk.screw.normalised([line, [0, 0, 1.011, 0, 0, 0], line, [0, 0, 2, 0, 0, 0]])
    with pytest.raises(
        ScrewError, match=r"^screws: .* within 0\.01; got \[0\.0, 0\.0, 0\.0, 0\.0, 0\.0, 0\.0\]"
    ):
        pk.screw.normalised(np.zeros(6))
    assert pk.screw.normalised([0, 0, 1.1, 0, 0, 0], tolerance=0.2).tolist() == [0, 0, 1, 0, 0, 0]
    assert pk.screw.normalised([1e-9, 0, 0, 0, 0, 1]).tolist() == [0, 0, 0, 0, 0, 1]
    with pytest.raises(ScrewError, match="screws: expected"):
        pk.screw.normalised([2e-9, 0, 0, 0, 0, 1])
    assert pk.screw.normalised(np.zeros((0, 6))).shape == (0, 6)
    with pytest.raises(ShapeError, match=r"expected shape \(\.\.\., 6\), got \(1, 5\)"):
        pk.screw.normalised([line[:5]])
    with pytest.raises(InputError, match=r"screws\[0\]: expected a finite number, got nan"):
        pk.screw.normalised([float("nan"), *line[1:]])
