"""Where coordinates may go, and where the tries begin."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.model import screw
from poekin.solve.ik.joint_domain import JointDomain, first_tries, for_targets, make_joint_domain
from poekin.solve.joint_units import joint_units

AXES = [screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in (0, 0.4)]


def room(coupling=None, limits=None) -> JointDomain:
    return make_joint_domain(
        joint_units(
            pk.Chain.from_space(AXES, np.eye(4), coupling=coupling, limits=limits).compile()
        ),
        None,
        True,
    )


def test_tries_begin_all_over_the_period_of_a_coordinate_without_limits():
    # the second joint turns half as fast: the arm is where it was after two turns of the first
    geared = room(coupling=[[1.0], [0.5]])
    np.testing.assert_allclose(geared.ranges, [[-2 * np.pi, 2 * np.pi]], rtol=1e-15)
    np.testing.assert_array_equal(room(coupling=[[1.0], [0.5]], limits=[[-1, 4]]).ranges, [[-1, 4]])


def test_the_first_start_is_near_the_middle_of_the_limits_and_beside_it_in_turn():
    joints = [[-1.0, 4.0], [-np.inf, np.inf]]
    np.testing.assert_allclose(
        room(limits=joints).middle(2), np.tile([1.5 + 0.02 * 5, -0.02 * 2 * np.pi], (2, 1))
    )
    units = joint_units(pk.Chain.from_space(AXES, np.eye(4), q_names=["a", "b"]).compile())
    locked = make_joint_domain(units, (("a", 3.0),), True).middle(1)
    np.testing.assert_allclose(locked, [[3.0, -0.04 * np.pi]])


def test_a_configuration_of_which_no_turn_is_within_the_limits_stays():
    np.testing.assert_array_equal(
        room(limits=[[-1, 1]] * 2).wrapped(np.full(2, 10.0), np.zeros(2)), 10.0
    )


def test_a_turn_to_a_limit_itself_is_taken():
    turn = np.full(2, 2 * np.pi)
    for limits, q in (([0, 7], -turn), ([-7, 0], turn)):
        np.testing.assert_array_equal(room(limits=[limits] * 2).wrapped(q, np.zeros(2)), 0.0)


def test_a_turn_that_rounding_would_take_beyond_a_limit_is_not_taken():
    lower = np.random.default_rng(0).uniform(-6, 0, (500, 2))
    for low in lower:
        high = np.nextafter(low + 2 * np.pi, -np.inf)
        tight = room(limits=np.stack([low, high], axis=1))
        assert tight.contains(tight.wrapped(low, high))


def test_a_domain_has_what_its_limits_and_locks_say_in_joint_units():
    units = joint_units(pk.Chain.from_space(AXES, np.eye(4), coupling=[[0.5, 0], [0, -2.0]], q_names=["a", "b"],
                                 limits=[[-2, 4], [-np.inf, np.inf]]).compile())  # fmt: skip
    found = make_joint_domain(units, (("a", 3.0),), True)
    np.testing.assert_array_equal(found.limits, [[-1, 2], [-np.inf, np.inf]])
    np.testing.assert_allclose(found.ranges, [[-1, 2], [-np.pi, np.pi]])
    np.testing.assert_allclose(found.periods, [2 * np.pi] * 2)
    np.testing.assert_array_equal([found.locked, found.locked_values], [[1, 0], [1.5, np.nan]])
    assert found.unbounded_periods.tolist() == pytest.approx([0, 2 * np.pi])
    free = make_joint_domain(units, None, False)
    np.testing.assert_array_equal(free.limits, np.tile([-np.inf, np.inf], (2, 1)))
    np.testing.assert_allclose(free.ranges, np.tile([-np.pi, np.pi], (2, 1)))
    assert free.unbounded_periods.all()
    assert not free.locked.any()
    narrow = room(limits=[[-1, 1], [0, 1]])
    assert not narrow.unbounded_periods.any()
    assert narrow.contains(np.array([[-1, 0], [1, 1], [1.1, 0.5], [0, -0.1]])).tolist() == [
        True,
        True,
        False,
        False,
    ]


def test_a_slide_without_limits_is_begun_within_a_metre_either_way():
    slide = joint_units(
        pk.Chain.from_space([AXES[0], screw.prismatic([1.0, 0, 0])], np.eye(4)).compile()
    )
    found = make_joint_domain(slide, None, True)
    np.testing.assert_allclose(found.ranges, [[-np.pi, np.pi], [-1, 1]])
    np.testing.assert_allclose(found.periods, [2 * np.pi, 0])
    alone = joint_units(pk.Chain.from_space([screw.prismatic([1.0, 0, 0])], np.eye(4)).compile())
    assert not make_joint_domain(alone, None, True).unbounded_periods.any()


@pytest.mark.parametrize("lock, error, words", [
    ({"c": 1.0}, UnknownName, "lock: no coordinate 'c'; "),
    ({"a": 5.0}, InputError, "lock: 'a': expected a number within [-2.0, 4.0], got 5.0"),
    ({"a": -2.1}, InputError, "lock: 'a': expected a number within [-2.0, 4.0], got -2.1"),
    ({"b": 2.0}, InputError, "lock: 'b': expected a number within [-1.5, 1.0], got 2.0"),
    ({"b": True}, InputError, "lock: 'b': expected a number within [-1.5, 1.0], got True"),
    ({"b": np.nan}, InputError, "lock: 'b': expected a number within [-1.5, 1.0], got nan"),
    ({"b": "1"}, InputError, "lock: 'b': expected a number within [-1.5, 1.0], got '1'"),
])  # fmt: skip
def test_a_lock_that_is_none_is_told_in_the_user_s_units(lock, error, words):
    units = joint_units(pk.Chain.from_space(AXES, np.eye(4), coupling=[[0.5, 0], [0, -2.0]], q_names=["a", "b"],
                                 limits=[[-2, 4], [-1.5, 1]]).compile())  # fmt: skip
    with pytest.raises(error, match=f"^{re.escape(words)}"):
        make_joint_domain(units, tuple(lock.items()), True)
    make_joint_domain(units, (("a", -2), ("b", 1)), True)


def test_whole_periods_are_taken_off_towards_zero_or_what_is_near():
    free = room()
    q = np.array([[7.0, -3.5], [np.pi - 0.1, 20.0]])
    np.testing.assert_allclose(
        free.principal(q), [[7 - 2 * np.pi, 2 * np.pi - 3.5], [np.pi - 0.1, 20 - 6 * np.pi]]
    )
    near = free.wrapped(q, np.array([6.0, 3.0]))
    np.testing.assert_allclose(near, [[7, 2 * np.pi - 3.5], [np.pi - 0.1, 20 - 6 * np.pi]])
    # With limits only towards what is near, and not beyond them.
    limited = room(limits=[[-4, 8], [-1, 1]])
    np.testing.assert_array_equal(limited.principal(np.array([7.0, 0.5])), [7, 0.5])
    np.testing.assert_allclose(
        limited.wrapped(np.array([7.0, 0.5]), np.array([-5.0, 7])), [7 - 2 * np.pi, 0.5]
    )
    np.testing.assert_allclose(
        limited.wrapped(np.array([-3.5, 0.5]), np.array([20.0, 7])), [2 * np.pi - 3.5, 0.5]
    )
    nowhere = np.full((2, 2), [-np.inf, np.inf])
    periods = np.full(2, 2 * np.pi)
    locked = JointDomain(nowhere, np.zeros((2, 2)), np.array([7.0, np.nan]), periods)
    np.testing.assert_allclose(locked.principal(np.array([7.0, 7.0])), [7, 7 - 2 * np.pi])


def test_the_first_try_is_at_q0_within_the_limits_or_anywhere_and_at_what_is_locked():
    units = joint_units(
        pk.Chain.from_space(
            AXES, np.eye(4), limits=[[-1, 1], [-2, 2]], joint_names=["a", "b"]
        ).compile()
    )
    free, locked = (
        make_joint_domain(units, None, True),
        make_joint_domain(units, (("b", 0.5),), True),
    )
    assert np.isnan(first_tries(units.fast.chain, units, free, (3,), 3, None)).all()
    np.testing.assert_array_equal(
        first_tries(units.fast.chain, units, locked, (2,), 2, None), [[np.nan, 0.5]] * 2
    )
    np.testing.assert_array_equal(
        first_tries(units.fast.chain, units, locked, (), 1, [0.25, 1.0]), [[0.25, 0.5]]
    )
    # What is locked is no matter of q0.
    np.testing.assert_array_equal(
        first_tries(units.fast.chain, units, locked, (), 1, [1.0, 9.0]), [[1.0, 0.5]]
    )
    with pytest.warns(
        pk.PoekinWarning, match=r"^q0 is outside the limits of 'b' and is moved to them$"
    ):
        moved = first_tries(units.fast.chain, units, free, (2,), 2, [[0.5, 0.5], [1.0, -3.0]])
    np.testing.assert_array_equal(moved, [[0.5, 0.5], [1, -2]])
    with pytest.warns(pk.PoekinWarning, match="limits of 'a', 'b' and"):
        first_tries(units.fast.chain, units, free, (), 1, [2, 3])


def test_a_configuration_is_given_for_all_targets_or_for_each():
    chain = pk.Chain.from_space(AXES, np.eye(4), joint_names=["a", "b"])
    np.testing.assert_array_equal(for_targets(chain, (2, 3), 6, [1, 2], "q0"), [[1, 2]] * 6)
    each = np.arange(12.0).reshape(2, 3, 2)
    np.testing.assert_array_equal(for_targets(chain, (2, 3), 6, each, "q0"), each.reshape(6, 2))
    with pytest.raises(
        ShapeError, match=r"^near: shape \(3, 2\) does not fit the targets' \(2, 2\)$"
    ):
        for_targets(chain, (2,), 2, np.zeros((3, 2)), "near")
    with pytest.raises(InputError, match=r"^near: expected finite numbers, got \[0, inf\]$"):
        for_targets(chain, (2,), 2, [0, np.inf], "near")
