"""Whole turns that bring a coordinate nearest, and the numbers that margins and travel are made of."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.sweep import JointTravel, LimitMargin
from tests.messages import says
from tests.sweep.arms import slide, two_links

TURN = 2 * np.pi
# a joint of three turns, one that turns without end, one of less than a turn, and a slide
SCREWS = [
    pk.screw.revolute([0, 0, 1], [0, 0, 0]),
    pk.screw.revolute([0, 1, 0], [0.5, 0, 0]),
    pk.screw.revolute([0, 1, 0], [1, 0, 0]),
    pk.screw.prismatic([1, 0, 0]),
]
LIMITS = np.array([[-10.0, 8.0], [-np.inf, np.inf], [-1.0, 3.0], [-20.0, 40.0]])
ARM = pk.Chain(np.array(SCREWS), np.eye(4), frame="space", limits=LIMITS)
MIDDLES = np.array([-1.0, 0.0, 1.0, 10.0])


def nearest(q, reference):
    """Of all whole turns that are within the limits the one that is nearest, number by number."""
    found = q.copy()
    for row in found:
        for i in range(3):
            turned = row[i] + TURN * np.arange(-30, 31)
            inside = (turned >= LIMITS[i, 0]) & (turned <= LIMITS[i, 1])
            allowed = turned[inside]
            row[i] = allowed[np.abs(allowed - reference[i]).argmin()]
    return found


@pytest.mark.parametrize("reference", [(-9.0, 50.0, 2.5, 3.0), (7.0, -31.0, -0.5, 0.0), MIDDLES])
def test_coordinates_come_as_near_to_a_reference_as_whole_turns_within_the_limits_bring_them(
    reference,
):
    rng = np.random.default_rng(1)
    q = rng.uniform([-10, -9, -1, -20], [8, 9, 3, 40], (300, 4))
    measure = LimitMargin() if reference is MIDDLES else JointTravel(tuple(reference))
    found = measure.at_best_turns(ARM, q)
    # a product with a whole number of turns and a sum, of numbers below 64
    np.testing.assert_allclose(found, nearest(q, reference), rtol=0, atol=1e-13)
    np.testing.assert_array_equal(found[:, 3], q[:, 3])


def test_what_rounding_has_brought_beyond_a_limit_stays_there():
    beyond = np.array([[8.0 + 1e-12, 0.0, 3.0 + 1e-12, 1.0], [-10 - 1e-12, 0.0, -1 - 1e-12, 1.0]])
    travel = JointTravel((9.0, 0.0, 3.0, 0.0)), JointTravel((-12.0, 0.0, -2.0, 0.0))
    for measure, row in zip(travel, beyond, strict=True):
        assert measure.at_best_turns(ARM, row[None])[0].tolist() == row.tolist()


def test_joints_with_limits_of_their_own_are_not_turned():
    own = ARM.replace(joint_limits=[[-12, 12], [-9, 9], [-4, 4], [-50, 50]])
    q = np.array([[7.0, 3.0, 1.0, 0.0]])
    assert JointTravel((-3.0, -4.0, 0.0, 0.0)).at_best_turns(own, q) is q
    assert (JointTravel((-3.0, -4.0, 0.0, 0.0)).at_best_turns(ARM, q) != q).any()


def test_margins_are_of_middles_and_half_ranges_and_of_limited_coordinates_alone():
    numbers = LimitMargin().numbers(ARM)
    assert numbers.tolist() == pytest.approx([*MIDDLES, 1 / 9, 0, 1 / 2, 1 / 30])
    # limits at which a sum of them would overflow
    wide = ARM.replace(limits=[[1e308, 1.5e308], [0, np.inf], [-np.inf, 0], [-1, 1]])
    middles, weights = np.split(LimitMargin().numbers(wide), 2)
    assert middles.tolist() == pytest.approx([1.25e308, 0, 0, 0])
    assert weights.tolist() == pytest.approx([2 / 0.5e308, 0, 0, 1])


def test_travel_is_from_the_coordinate_nearest_to_0_and_in_seconds_where_there_are_speeds():
    chain = slide().replace(limits=[[0.1, 0.4], [-3, -2]])
    assert JointTravel().numbers(chain).tolist() == [0.1, -2, 1, 1]
    timed = JointTravel((0.2, -2.5), (0.5, 4.0))
    assert timed.numbers(chain).tolist() == [0.2, -2.5, 2, 0.25]
    assert (timed.name, JointTravel().name) == ("travel_time", "travel")
    assert timed.describe() == {"reference": [0.2, -2.5], "speeds": [0.5, 4.0]}
    assert JointTravel().describe() == {"reference": None, "speeds": None}


@pytest.mark.parametrize(
    ("measure", "kind", "words"),
    [
        (
            JointTravel((0.0,) * 3),
            ShapeError,
            "reference: expected 2 numbers, got (3,)",
        ),
        (JointTravel(None, (1.0,)), ShapeError, "speeds: expected 2 numbers, got (1,)"),
        (
            JointTravel((0.0, np.inf)),
            InputError,
            "reference: expected finite numbers, speeds above 0, got (0.0, inf)",
        ),
        (
            JointTravel((-1.0, 0.0), (1.0, 0.0)),
            InputError,
            "speeds: expected finite numbers, speeds above 0, got (1.0, 0.0)",
        ),
    ],
)
def test_numbers_of_another_arm_are_refused(measure, kind, words):
    with pytest.raises(kind) as caught:
        measure.check(two_links())
    assert says(caught.value, words)
    JointTravel((-1.0, 0.0), (0.1, 1e-300)).check(two_links())


def test_a_coordinate_that_cannot_move_is_at_no_limit():
    limits = LIMITS.copy()
    limits[2] = 0.5
    assert LimitMargin().numbers(ARM.replace(limits=limits))[[2, 6]].tolist() == [0.0, 0.0]
    held = ARM.replace(limits=np.tile([0.5, 0.5], (4, 1)))
    with pytest.raises(InputError, match=r"no coordinate of .* has limits"):
        LimitMargin().check(held)


@pytest.mark.parametrize("values", [[1, 2, 3, 4], np.arange(1.0, 5.0), (1.0, 2.0, 3.0, 4.0)])
def test_travel_takes_any_row_of_numbers(values):
    measure = JointTravel(values, speeds=values)
    assert measure.reference == measure.speeds == (1.0, 2.0, 3.0, 4.0)
    assert hash(measure) == hash(JointTravel((1.0, 2.0, 3.0, 4.0), (1.0, 2.0, 3.0, 4.0)))
    with pytest.raises(InputError, match=r"^reference: expected real numbers, got text"):
        JointTravel(("a",) * 4)  # pyright: ignore[reportArgumentType]
