"""Locked coordinates: values for each target, and the arm that is left."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.solve.joint_units import bounds, joint_units
from poekin.solve.lock import (
    at_ends,
    brought_back,
    free_chain,
    items,
    locked_rows,
    locked_values,
)
from poekin.testing.strategies import chain_strategies

AXES = [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.revolute([0, 1, 0], [0.5, 0, 0])]
# the second coordinate counts the other way, and twice as fast
UNITS = joint_units(
    pk.Chain.from_space(
        AXES,
        np.eye(4),
        coupling=[[1, 0], [0, -2.0]],
        q_names=["a", "b"],
        limits=[[-2, 4], [-1.5, 1]],
    ).compile(),
    locked=True,
)
LIMITS = bounds(UNITS.fast.chain, True)


def test_values_of_a_batch_are_those_of_each_target_in_joint_units():
    lock = items({"b": [[0.5, -1.0]]})
    np.testing.assert_allclose(
        locked_rows(UNITS, lock, LIMITS, (2, 2)),
        [[np.nan, -1.0], [np.nan, 2.0], [np.nan, -1.0], [np.nan, 2.0]],
    )
    one = locked_values(UNITS, items({"b": 0.5}), LIMITS)
    np.testing.assert_array_equal(locked_rows(UNITS, items({"b": 0.5}), LIMITS, (3,)), [one] * 3)
    assert np.isnan(locked_rows(UNITS, None, LIMITS, (3,))).all()
    assert locked_rows(UNITS, lock, LIMITS, (0, 2)).shape == (0, 2)


@pytest.mark.parametrize("value", [-1.5, 1.0])
def test_the_limits_themselves_are_taken(value):
    lock = items({"b": value})
    np.testing.assert_array_equal(locked_values(UNITS, lock, LIMITS), [np.nan, -2 * value])
    np.testing.assert_array_equal(locked_rows(UNITS, lock, LIMITS, (1,)), [[np.nan, -2 * value]])


@pytest.mark.parametrize(("lock", "error", "words"), [
    ({"c": 1.0}, UnknownName, "lock: no coordinate 'c'; "),
    ({"b": [2.0, -3.0]}, InputError, "lock: 'b': expected a number within [-1.5, 1.0], got 2.0"),
    ({"b": [0.5, np.nan]}, InputError, "lock: 'b': expected a number within [-1.5, 1.0], got nan"),
    ({"b": True}, InputError, "lock: 'b': expected real numbers, got bool"),
    ({"b": "1"}, InputError, "lock: 'b': expected "),
    ({"b": [0.5, 0.1, 0.2]}, ShapeError, "lock: 'b': shape (3,) does not fit the targets' (2,)"),
])  # fmt: skip
def test_values_that_do_not_fit_are_refused_in_the_user_s_units(lock: Any, error, words):
    with pytest.raises(error, match=f"^{re.escape(words)}"):
        locked_rows(UNITS, items(lock), LIMITS, (2,))


@pytest.mark.parametrize(("name", "value", "within"), [
    ("b", 1.1, "[-1.5, 1.0], got 1.1"),
    ("b", -1.6, "[-1.5, 1.0], got -1.6"),
    ("a", -2.1, "[-2.0, 4.0], got -2.1"),
    ("a", np.nan, "[-2.0, 4.0], got nan"),
    ("a", "1", "[-2.0, 4.0], got '1'"),
    ("a", True, "[-2.0, 4.0], got True"),
])  # fmt: skip
def test_one_value_that_does_not_fit_is_refused_in_the_user_s_units(name, value, within):
    words = f"lock: '{name}': expected a number within {within}"
    with pytest.raises(InputError, match=f"^{re.escape(words)}$"):
        locked_values(UNITS, items({name: value}), LIMITS)
    for end in (-1.5, 1.0):
        assert locked_values(UNITS, items({"b": end}), LIMITS)[1] == -2 * end


def test_a_coordinate_that_is_not_there_cannot_be_locked():
    words = "lock: no coordinate 'c'; available: 'a', 'b'"
    with pytest.raises(UnknownName, match=f"^{re.escape(words)}$"):
        locked_values(UNITS, items({"c": 1.0}), LIMITS)


def test_what_is_no_dict_is_no_lock():
    wrong: Any = [("a", 1.0)]
    words = "lock: expected a dict of names and values, got [('a', 1.0)]"
    with pytest.raises(InputError, match=f"^{re.escape(words)}$"):
        items(wrong)
    assert items(None) is None
    assert items({"a": 1.0}) == (("a", 1.0),)


@given(st.data())
def test_the_arm_that_is_left_moves_as_the_whole_one_with_what_is_locked_at_its_value(data):
    chain = data.draw(chain_strategies.chains(1, 7).filter(lambda chain: chain.dof > 1))
    q = data.draw(chain_strategies.coordinates(chain))
    locked = np.array(data.draw(st.lists(st.booleans(), min_size=chain.dof, max_size=chain.dof)))
    left = free_chain(chain, np.where(locked, q, np.nan))
    assert left.q_names == tuple(np.array(chain.q_names)[~locked])
    np.testing.assert_array_equal(left.limits, chain.limits[~locked])
    # both are within u (8 (n + 1) + 4 sum |x|) of the reach of the pose (`Chain.fk`), and each screw
    # of `left` is moved as by `rezeroed`, within u (10 (n + 1) + 4 sum |x|), and moves the tool by it
    x = np.abs(chain.coupling) @ np.abs(q) + np.abs(chain.offset)
    n = len(chain.kinds)
    reach = chain.reach + x.sum()
    bound = 2.0**-53 * (n + 2) * (30 * (n + 1) + 12 * x.sum()) * reach
    np.testing.assert_allclose(left.fk(q[~locked]), chain.fk(q), rtol=0, atol=bound)


@given(st.data())
def test_one_arm_serves_all_values_of_what_is_locked_at_its_ends(data):
    chain = data.draw(chain_strategies.chains(2, 7).filter(lambda chain: chain.dof > 1))
    q = data.draw(chain_strategies.coordinates(chain))
    free = np.ones(chain.dof, bool)
    free[: data.draw(st.integers(0, chain.dof - 1))] = False
    if data.draw(st.booleans()):
        free = free[::-1].copy()
    ends = at_ends(chain, free)
    assert not (ends & free).any()
    left = free_chain(chain, np.where(free, np.nan, np.where(ends, 0.0, q)))
    values = np.where(free, np.nan, q)[None]
    T = brought_back(chain, chain.fk(q)[None], values, free)[0]
    # as of free_chain, and twice as many factors, each with its inverse
    x = np.abs(chain.coupling) @ np.abs(q) + np.abs(chain.offset)
    n = len(chain.kinds)
    reach = chain.reach + x.sum()
    bound = 2.0**-53 * (n + 2) * (120 * (n + 1) + 48 * x.sum()) * reach
    np.testing.assert_allclose(T, left.fk(q[free]), rtol=0, atol=bound)


def test_several_joints_at_an_end_are_taken_back_in_their_order():
    offset = np.array([0.4, -0.9, 0.7, 0.2, -1.1, 0.6])
    chain = pk.load("puma560").chain().replace(offset=offset)
    q = np.array([0.8, 0.5, -0.3, 1.2, 0.9, -0.7])
    free = np.array([False, False, True, True, False, False])
    left = free_chain(chain, np.where(free, np.nan, 0.0))
    T = brought_back(chain, chain.fk(q)[None], np.where(free, np.nan, q)[None], free)[0]
    # some ten products of poses, each within a few u of the reach; another order is off by 0.1 and more
    np.testing.assert_allclose(T, left.fk(q[free]), rtol=0, atol=1e-14)


def test_joints_between_those_that_move_are_not_at_the_ends():
    chain = pk.load("panda").chain(tip="panda_hand")
    free = np.array([False, True, True, False, True, True, False])
    assert at_ends(chain, free).tolist() == [True] + [False] * 5 + [True]
    T = chain.fk(chain.random(0, 3))
    whole = np.ones(7, bool)
    assert brought_back(chain, T, np.full((3, 7), np.nan), whole) is T


def test_limits_of_joints_stay_theirs_where_a_coordinate_of_a_sum_is_locked():
    chain = pk.Chain.from_space(
        AXES,
        np.eye(4),
        coupling=[[1.0, 0], [1, 1]],
        q_names=["a", "b"],
        joint_limits=[[-1, 1], [-1, 2]],
    )
    left = free_chain(chain, np.array([0.5, np.nan]))
    assert left.joint_names == ("joint2",)
    np.testing.assert_allclose(left.offset, [0.5])
    np.testing.assert_allclose(left.joint_limits, [[-1, 2]])


@given(chain_strategies.chains(1, 7, coupled=False))
def test_an_arm_of_which_nothing_is_locked_is_left_as_it_is(chain):
    free = np.full(chain.dof, np.nan)
    assert free_chain(chain, free) is chain
    free[0] = 0.0
    assert free_chain(chain, free) is not chain


@pytest.mark.parametrize(("coupling", "ends"), [
    # joints a, c and b: what is locked, b, moves the last one alone, and then with another
    ([[1, 0, 0], [0, 0, 1], [0, 1, 0]], [False, True, False]),
    ([[1, 0, 0], [0, 0, 1], [0, 1, 1]], [False, False, False]),
    ([[0, 1, 0], [1, 0, 0], [0, 0, 1]], [False, True, False]),
    ([[1, 1, 0], [1, 0, 0], [0, 0, 1]], [False, False, False]),
    ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [False, False, False]),
])  # fmt: skip
def test_what_moves_a_joint_that_moves_otherwise_too_is_not_at_an_end(coupling, ends):
    screws = [pk.screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in range(3)]
    chain = pk.Chain.from_space(screws, np.eye(4), coupling=coupling, q_names=["a", "b", "c"])
    assert at_ends(chain, np.array([True, False, True])).tolist() == ends
