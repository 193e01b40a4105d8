"""Where coordinates may go, and where the tries begin."""

from __future__ import annotations

import numpy as np

import poekin as pk
from poekin.model import screw
from poekin.solve.joint_units import joint_units
from poekin.solve.starts import Room, room_of

AXES = [screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in (0, 0.4)]


def room(coupling=None, limits=None) -> Room:
    return room_of(joint_units(pk.Chain(AXES, np.eye(4), coupling=coupling, limits=limits).compile()), None, True)


def test_tries_begin_all_over_the_period_of_a_coordinate_without_limits():
    # the second joint turns half as fast: the arm is where it was after two turns of the first
    geared = room(coupling=[[1.0], [0.5]])
    np.testing.assert_allclose(geared.ranges, [[-2 * np.pi, 2 * np.pi]], rtol=1e-15)
    np.testing.assert_array_equal(room(coupling=[[1.0], [0.5]], limits=[[-1, 4]]).ranges, [[-1, 4]])


def test_a_configuration_of_which_no_turn_is_within_the_limits_stays():
    np.testing.assert_array_equal(room(limits=[[-1, 1]] * 2).unwound(np.full(2, 10.0), np.zeros(2)), 10.0)


def test_a_turn_that_rounding_would_take_beyond_a_limit_is_not_taken():
    lower = np.random.default_rng(0).uniform(-6, 0, (500, 2))
    for low in lower:
        high = np.nextafter(low + 2 * np.pi, -np.inf)
        tight = room(limits=np.stack([low, high], axis=1))
        assert tight.holds(tight.unwound(low, high))
