"""Why there is no solution: which limits are in the way."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.model import screw
from poekin.solve import reasons
from poekin.solve.ik import ik
from poekin.solve.starts import Room
from poekin.solve.task import task_of


def test_limits_between_which_nothing_stops_the_arm_are_named_by_the_solution_beyond_them():
    # the tip is right opposite to the target, from where each way is as good: it stays, at no limit
    z, x, origin = np.array([0, 0, 1.0]), np.array([1.0, 0, 0]), np.zeros(3)
    axes = [screw.revolute(z, origin), screw.prismatic(z), screw.revolute(x, origin)]
    names, limits = ["turn", "lift", "roll"], [[-1.5, 1.5], [-1, 1], [-np.inf, np.inf]]
    arm = pk.Chain(axes, pk.se3.exp([*origin, *x]), limits=limits, joint_names=names)
    q0 = [0.0, 0.5, 0.2]
    found = ik(arm, arm.fk([np.pi, 0.5, 0.2]), task="position", q0=q0, restarts=0)
    assert found.reason == "limits"
    np.testing.assert_allclose(found.q, q0, rtol=0, atol=1e-9)
    assert found.blocked == (("turn",),)


def line(*, coupling, offset, limits):
    """A turning joint 1 m above the floor and a slide; 0.5 m from one to the other and 0.25 m on to the tip."""
    axes = [screw.revolute([0, 1.0, 0], [0, 0, 1]), screw.prismatic([1.0, 0, 0])]
    home = np.eye(4)
    home[:3, 3] = 0.75, 0, 1
    return pk.Chain(axes, home, coupling=coupling, offset=offset, limits=limits)


def lengths(chain):
    return float(np.linalg.norm(chain.local.frames[1:, :3, 3], axis=1).sum())


@pytest.mark.parametrize("limits, coupling, offset, slides", [
    (((-3, 3), (-0.5, 2.0)), None, None, 2.0),
    (((-3, 3), (-2.5, 2.0)), None, None, 2.5),
    (((-3, 3), (-0.5, 2.0)), None, [0, -0.25], 2.25),
    (((-3, 3), (-0.5, 2.0)), [[1, 0], [0, -3.0]], [0, 0.25], 6.25),
    (((-3, 3), (-0.5, 2.0)), [[1, 0], [0.5, 3.0]], None, 7.5),
])  # fmt: skip
def test_the_reach_is_that_of_links_and_slides_within_their_limits(limits, coupling, offset, slides):
    chain = line(limits=limits, coupling=coupling, offset=offset)
    first, long = chain.local.frames[0, :3, 3], lengths(chain) + slides
    targets = np.tile(np.eye(4), (3, 1, 1))
    targets[:, :3, 3] = first + np.array([[0, long - 0.01, 0], [0, 0, long + 0.125], [long + 7, 0, 0]])
    task = task_of("position", None, None)
    beyond = reasons.beyond_reach(chain, task, targets, chain.limits)
    np.testing.assert_allclose(beyond, [0, 0.125, 7], atol=1e-11)
    assert (reasons.beyond_reach(chain, task_of("rotation", None, None), targets, chain.limits) == 0).all()
    assert (reasons.beyond_reach(chain, task, targets, np.full((2, 2), [-np.inf, np.inf])) == 0).all()
    assert (reasons.beyond_reach(pk.Chain([], np.eye(4)), task, targets, np.empty((0, 2))) == 0).all()


def test_what_is_at_its_limit_is_in_the_way_else_what_is_outside_beyond_it_and_nothing_that_is_locked():
    limits, locked = np.array([[-1, 1], [-2, 2], [-3, 3.0]]), np.array([False, False, True])
    nothing = np.zeros(3)
    room = Room(limits, np.zeros((3, 2)), locked, nothing, nothing, winds=False)

    def named(q, found):
        return reasons._in_the_way(room, np.array(q, float), np.array(found, float), ("a", "b", "c"))

    assert named([1, 0, 3], [0, 0, 0]) == ("a",)
    assert named([-1 + 0.9e-9, 2, 0], [0, 0, 0]) == ("a", "b")
    assert named([1 - 1.1e-9, -2, 0], [5, 0, 0]) == ("b",)
    assert named([0, 0, 3], [1.5, -2.5, 4]) == ("a", "b", "c")
    assert named([0, 0, 0], [1.0, 2.5, 0]) == ("b",)
