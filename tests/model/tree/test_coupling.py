"""Which coordinate a joint follows and how, and the limits that followers leave to it, by numbers
made by hand.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from poekin.errors import ModelError
from poekin.model.joint import Joint, Mimic
from poekin.model.provenance import Source
from poekin.model.tree.coupling import Coupling, coupling_of, shared_limits, shared_velocity_limits

INF = np.inf


def joint(name, kind: Any = "revolute", mimic=None):
    return Joint(name, kind, "a", "b", mimic=mimic)


def coupled(*joints):
    found = coupling_of(joints, Source("x.urdf"))
    assert not any(array.flags.writeable for array in found[1:])
    return found


def test_a_mimic_of_a_mimic_is_composed_whichever_comes_first():
    found = coupled(
        joint("last", mimic=Mimic("middle", -3.0, 1.0)), joint("other", "prismatic"),
        joint("middle", "continuous", Mimic("master", 2.0, 0.5)), joint("master", "helical"), joint("end", "fixed"),
        joint("same", mimic=Mimic("other")),
    )  # fmt: skip
    # x = -3 (2 q + 0.5) + 1
    assert found.q_names == ("master", "other")
    assert found.master.tolist() == [3, 1]
    assert found.coordinate.tolist()[:4] == [0, 1, 0, 0]
    assert found.ratio.tolist() == [-6, 1, 2, 1, 0, 1]
    assert found.shift.tolist() == [-0.5, 0, 0.5, 0, 0, 0]
    assert found.coordinate[4] < 0
    assert found.coordinate[5] == 1


def test_a_multiplier_that_is_too_large_is_that_of_the_joint_where_the_product_is():
    joints = [
        joint("last", mimic=Mimic("j", 2.0)),
        joint("i"),
        joint("j", mimic=Mimic("k", 1e200)),
        joint("k", mimic=Mimic("i", 1e200)),
    ]
    with pytest.raises(ModelError, match=r"^x\.urdf: joint 'j': the product of its chain"):
        coupled(*joints)


def test_what_follows_a_fixed_joint_stands_still_and_a_fixed_joint_follows_nothing():
    found = coupled(
        joint("wall", "fixed", Mimic("turn", 5.0, 7.0)), joint("turn"), joint("one", mimic=Mimic("wall", 2.0, 0.25)),
        joint("two", mimic=Mimic("one", 4.0, 1.0)), joint("free", "floating"), joint("flat", "planar"),
    )  # fmt: skip
    assert found.q_names == ("turn",)
    assert (found.coordinate >= 0).tolist() == [False, True, False, False, False, False]
    assert found.ratio.tolist() == [0, 1, 0, 0, 0, 0]
    assert found.shift.tolist() == [0, 0, 0.25, 2.0, 0, 0]


# One coordinate, its master and one follower x = ratio q + shift within bounds.
@pytest.mark.parametrize("own, ratio, shift, bound, limits, torn", [
    ((-1, 1), 2.0, 0.5, (-1.5, 1), (-1, 0.25), False),
    ((-1, 1), 2.0, 0.5, (-0.5, 9), (-0.5, 1), False),
    ((-1, 1), -2.0, 1.0, (0, 5), (-1, 0.5), False),
    ((-1, 1), -2.0, 1.0, (-5, 2), (-0.5, 1), False),
    ((-INF, INF), 0.5, 0.0, (-1, INF), (-2, INF), False),
    ((-INF, INF), -0.5, 0.0, (-1, INF), (-INF, 2), False),
    ((-1, 1), 0.0, 0.5, (7, 8), (-1, 1), False),  # it does not follow
    ((-1, 1), 1.0, 0.0, (2, 3), (-1, 1), True),
    ((-1, 1), 1.0, 0.0, (-3, -2), (-1, 1), True),
    ((-1, 1), 1.0, 0.0, (1, 3), (-1, 1), True),  # a point is no interval
    ((-1, 1), 1.0, 0.0, (-3, -1), (-1, 1), True),
    ((2, 2), 1.0, 0.0, (-3, 3), (2, 2), False),  # but the master's own is one
    ((2, 2), 1.0, 0.0, (2, 2), (2, 2), False),
    # a bound beyond the largest number is none
    ((0, 1), 1e-300, 0.0, (-1e300, 1e300), (0, 1), False),
])  # fmt: skip
def test_limits_are_what_all_followers_leave_and_the_master_s_own_where_that_is_nothing(
    own, ratio, shift, bound, limits, torn
):
    ratios, shifts = np.array([1.0, 3.0, ratio]), np.array([0, 9.0, shift])
    coupling = Coupling(("q",), np.array([0]), np.array([0, -1, 0]), ratios, shifts)
    bounds = np.array([own, (-0.1, 0.1), bound], float)
    found, apart = shared_limits(coupling, bounds, np.arange(3))
    assert found.tolist() == [list(map(float, limits))]
    assert apart.tolist() == ([0] if torn else [])


@pytest.mark.parametrize("own, ratio, velocity, expected", [
    (2.0, 2.0, 3.0, 1.5),
    (2.0, -2.0, 3.0, 1.5),
    (2.0, 0.5, 3.0, 2.0),
    (INF, -4.0, 3.0, 0.75),
    (2.0, 3.0, INF, 2.0),
    (INF, 3.0, INF, INF),
    (2.0, 0.0, 3.0, 2.0),  # it does not follow
    (2.0, 1e-300, 1e300, 2.0),  # a bound beyond the largest number is none
    (2.0, 1e300, 1e-300, 5e-324),  # and one below the smallest is it
])  # fmt: skip
def test_a_coordinate_is_as_fast_as_the_slowest_of_its_followers_allows(
    own, ratio, velocity, expected
):
    coupling = Coupling(
        ("q",), np.array([0]), np.array([0, -1, 0]), np.array([1, 3, ratio]), np.zeros(3)
    )
    velocities = np.array([own, 0.1, velocity])
    assert shared_velocity_limits(coupling, velocities, np.arange(3)).tolist() == [expected]


def test_a_master_off_the_way_sets_no_velocity_limit():
    coupling = Coupling(
        ("p", "q"), np.array([0, 1]), np.array([0, 1, 1]), np.array([1, 1, 2]), np.zeros(3)
    )
    found = shared_velocity_limits(coupling, np.array([5.0, 6.0]), np.array([0, 2]))
    assert found.tolist() == [5, 3]


def test_a_master_off_the_way_sets_no_limits_limits_unless_those_on_it_contradict_each_other():
    coupling = Coupling(
        ("p", "q"), np.array([0, 1]), np.array([0, 1, 1, 1]), np.ones(4), np.zeros(4)
    )
    bounds = np.array([(-9, 9), (-1, 1), (-3, 2), (4, 5)], float)
    for joints, limits, torn in (
        ([0, 2], (-3, 2), []),
        ([0, 1, 2], (-1, 1), []),
        ([2, 3, 0], (-1, 1), [1]),
    ):
        found, apart = shared_limits(coupling, bounds, np.array(joints))
        assert found.tolist() == [[-9, 9], list(limits)]
        assert apart.tolist() == torn
