"""The configuration with which the page of an arm opens, where that at zero is singular."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.view.scene import Slider
from poekin.view.scenes.arm import arm_geometry, arm_scene
from poekin.view.scenes.arm_parts.geometry import opening_q
from poekin.view.scenes.arm_parts.regular import (
    GOOD,
    TURN,
    _turned,
    is_one_arm,
    regular_opening,
)

SINGULAR = ["ur3", "ur5e", "ur10e", "puma560", "kr5", "irb140", "jaco", "iiwa14", "stanford"]


def opened(name: str) -> tuple[pk.Chain, np.ndarray, np.ndarray]:
    """An arm, where its page opens, and where it would without a joint turned."""
    chain = pk.load(name).chain()
    plain = opening_q(arm_geometry(chain, ()).sliders)
    return chain, arm_scene(chain).q, plain


@pytest.mark.parametrize("name", SINGULAR)
def test_an_arm_that_is_singular_at_zero_opens_where_it_is_not(name):
    chain, q, plain = opened(name)
    assert pk.singularity(chain, plain).singular
    found = pk.singularity(chain, q)
    assert not found.singular
    assert found.condition < 100
    assert ((chain.limits[:, 0] < q) & (q < chain.limits[:, 1])).all()


@pytest.mark.parametrize("name", SINGULAR)
def test_joints_are_turned_by_a_quarter_or_half_of_what_their_limits_leave(name):
    chain, q, plain = opened(name)
    turned = np.flatnonzero(q != plain)
    assert turned.size
    for k in turned:
        room = chain.limits[k, int(q[k] > plain[k])] - plain[k]
        assert abs(q[k] - plain[k]) == pytest.approx(min(TURN, 0.5 * abs(room)), rel=1e-15)


def test_a_ur_turns_its_elbow_up_and_its_wrist_and_says_so():
    scene = arm_scene(pk.load("ur5e"), meshes=False)
    np.testing.assert_array_equal(scene.q, [0, 0, -TURN, 0, TURN, 0])
    assert scene.words[1:] == (
        "The page opens with 'elbow_joint', 'wrist_2_joint' turned: otherwise 'tool0' is singular.",
    )


@pytest.mark.parametrize("name", ["ur5e", "kr5", "irb140"])
def test_the_fewest_joints_are_turned_that_do_nearly_as_well_as_any(name):
    """Of all 3^6 - 1 ways, by the condition number of the Jacobian with v by the reach."""
    chain, q, plain = opened(name)
    room = 0.5 * np.abs(chain.limits - plain[:, None])
    turns = np.minimum(TURN, room) * [-1.0, 1.0]
    ways = [(x, x + up, x + down) for x, (down, up) in zip(plain, turns, strict=True)]
    every = np.array(np.meshgrid(*ways)).reshape(6, -1).T
    J = chain.jacobian(every, "hybrid")
    J[:, 3:] /= chain.reach
    s = np.linalg.svd(J, compute_uv=False)
    condition = s[:, 0] / np.maximum(s[:, -1], 1e-300)
    good = every[condition <= GOOD * condition.min() * (1 - 1e-9)]
    count = (good != plain).sum(axis=1)
    assert (q != plain).sum() == count.min()
    # a limit's half and its sum with q, rounded at up to 2 rad
    assert np.abs(good - q).max(axis=1).min() <= 1e-15
    arm = arm_geometry(chain, ())
    lowest = [arm.points(row)[:, 2].min() for row in good[count == count.min()]]
    assert arm.points(q)[:, 2].min() == pytest.approx(max(lowest), abs=1e-9)


@pytest.mark.parametrize("name", ["jaco", "kr5"])
def test_a_configuration_that_is_given_or_regular_is_kept(name):
    chain = pk.load(name).chain()
    q = np.zeros(chain.dof)
    np.testing.assert_array_equal(arm_scene(chain, q=q).q, q)
    arm = arm_geometry(chain, ())
    away = regular_opening(arm, chain, range(chain.dof), opening_q(arm.sliders))
    np.testing.assert_array_equal(regular_opening(arm, chain, range(chain.dof), away), away)


def test_an_arm_that_stays_singular_opens_as_it_is():
    """A wrist between fixed limits: no joint has room to turn."""
    joints = [
        pk.Joint(name, "revolute", a, b, axis=axis, limits=(0.0, limit))
        for name, a, b, axis, limit in (
            ("yaw", "base", "one", (0, 0, 1), 0.0),
            ("pitch", "one", "two", (0, 1, 0), 0.0),
            ("roll", "two", "tip", (0, 0, 1), 0.0),
        )
    ]
    scene = arm_scene(pk.Robot("wrist", ["base", "one", "two", "tip"], joints))
    np.testing.assert_array_equal(scene.q, np.zeros(3))
    assert any("where the page opens: singular" in words for words in scene.words)


def test_a_robot_with_several_arms_is_left_as_it_is():
    panda = arm_scene(pk.load("panda"), meshes=False).arms[0].tips
    assert is_one_arm(panda)
    two = arm_scene(pk.load("erd:talos_reduced"), meshes=False)
    assert not is_one_arm(two.arms[0].tips)


@pytest.mark.parametrize("n", [1, 2, 3])
def test_every_way_to_turn_some_of_the_angles_is_looked_at_the_fewest_first(n):
    sliders = [
        *(Slider(f"q{k}", "rad", -9.0, 9.0) for k in range(n)),
        Slider("lift", "m", -9.0, 9.0),
    ]
    rows = np.array(list(_turned(sliders, range(n + 1), np.zeros(n + 1))))
    assert np.unique(rows, axis=0).shape == rows.shape == (3**n - 1, n + 1)
    assert set(np.abs(rows[:, :n]).ravel()) <= {0.0, TURN}
    assert not rows[:, n].any()
    assert (np.diff((rows != 0).sum(axis=1)) >= 0).all()


def test_a_joint_that_opens_away_from_zero_is_turned_by_half_of_what_its_limits_leave_there():
    sliders = [Slider("a", "rad", 1.0, 2.0), Slider("b", "rad", -7.0, -5.0)]
    rows = list(_turned(sliders, [0, 1], np.array([1.5, -5.5])))
    assert [row.tolist() for row in rows[:4]] == [
        [1.75, -5.5], [1.25, -5.5], [1.5, -5.25], [1.5, -6.25],
    ]  # fmt: skip


def test_an_arm_that_only_places_its_tip_opens_where_it_moves_it_in_all_directions():
    axes = [([0, 0, 1], [0, 0, 0]), ([0, 1, 0], [0, 0, 0.4]), ([0, 1, 0], [0.4, 0, 0.4])]
    arm = pk.Chain.from_space(
        [pk.screw.revolute(*axis) for axis in axes], pk.se3.exp([0, 0, 0, 0.7, 0, 0.4])
    )
    assert pk.singularity(arm, np.zeros(3)).singular
    scene = arm_scene(arm)
    np.testing.assert_array_equal(scene.q, [0, 0, TURN])
    assert not pk.singularity(arm, scene.q).singular
