"""Why there is no solution: which limits are in the way."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels import ik_codes as codes
from poekin.model import screw
from poekin.solve.ik import diagnosis
from poekin.solve.ik.ik import ik
from poekin.solve.ik.joint_domain import JointDomain
from poekin.solve.ik.task import make_task


def test_limits_between_which_nothing_stops_the_arm_are_named_by_the_solution_beyond_them():
    # the tip is right opposite to the target, from where each way is as good: it stays, at no limit
    z, x, origin = np.array([0, 0, 1.0]), np.array([1.0, 0, 0]), np.zeros(3)
    axes = [screw.revolute(z, origin), screw.prismatic(z), screw.revolute(x, origin)]
    names, limits = ["turn", "lift", "roll"], [[-1.5, 1.5], [-1, 1], [-np.inf, np.inf]]
    arm = pk.Chain.from_space(axes, pk.se3.exp([*origin, *x]), limits=limits, joint_names=names)
    q0 = [0.0, 0.5, 0.2]
    found = ik(arm, arm.fk([np.pi, 0.5, 0.2]), task="position", q0=q0, restarts=0)
    assert found.reason == "limits"
    np.testing.assert_allclose(found.q, q0, rtol=0, atol=1e-9)
    assert found.limits_hit == (("turn",),)


def line(*, coupling, offset, limits):
    """A turning joint 1 m above the floor and a slide; 0.5 m from one to the other and 0.25 m on to
    the tip.
    """
    axes = [screw.revolute([0, 1.0, 0], [0, 0, 1]), screw.prismatic([1.0, 0, 0])]
    home = np.eye(4)
    home[:3, 3] = 0.75, 0, 1
    return pk.Chain.from_space(axes, home, coupling=coupling, offset=offset, limits=limits)


def lengths(chain):
    return float(np.linalg.norm(chain.local.frames[1:, :3, 3], axis=1).sum())


@pytest.mark.parametrize("limits, coupling, offset, slides", [
    (((-3, 3), (-0.5, 2.0)), None, None, 2.0),
    (((-3, 3), (-2.5, 2.0)), None, None, 2.5),
    (((-3, 3), (-0.5, 2.0)), None, [0, -0.25], 2.25),
    (((-3, 3), (-0.5, 2.0)), [[1, 0], [0, -3.0]], [0, 0.25], 6.25),
    (((-3, 3), (-0.5, 2.0)), [[1, 0], [0.5, 3.0]], None, 7.5),
])  # fmt: skip
def test_the_reach_is_that_of_links_and_slides_within_their_limits(
    limits, coupling, offset, slides
):
    chain = line(limits=limits, coupling=coupling, offset=offset)
    first, long = chain.local.frames[0, :3, 3], lengths(chain) + slides
    targets = np.tile(np.eye(4), (3, 1, 1))
    targets[:, :3, 3] = first + np.array(
        [[0, long - 0.01, 0], [0, 0, long + 0.125], [long + 7, 0, 0]]
    )
    task = make_task("position", None, None)
    beyond = diagnosis.distance_beyond_reach(chain, task, targets, chain.limits)
    np.testing.assert_allclose(beyond, [0, 0.125, 7], atol=1e-11)
    assert (
        diagnosis.distance_beyond_reach(
            chain, make_task("rotation", None, None), targets, chain.limits
        )
        == 0
    ).all()
    assert (
        diagnosis.distance_beyond_reach(chain, task, targets, np.full((2, 2), [-np.inf, np.inf]))
        == 0
    ).all()
    assert (
        diagnosis.distance_beyond_reach(
            pk.Chain.from_space([], np.eye(4)), task, targets, np.empty((0, 2))
        )
        == 0
    ).all()


def test_a_target_beside_the_plane_of_an_arm_is_as_far_as_its_foot_in_the_plane():
    axes = [screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in (0, 1)]
    arm = pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, 2, 0, 0]))
    targets = np.tile(np.eye(4), (2, 1, 1))
    targets[:, :3, 3] = [[3, 4, 12], [0.5, 0, 12]]
    task = make_task("planar", None, None)
    beyond = diagnosis.distance_beyond_reach(arm, task, targets, arm.limits)
    np.testing.assert_allclose(beyond, [3, 0], atol=1e-11)


def test_what_is_at_its_limit_is_in_the_way_else_what_is_outside_beyond_it_and_nothing_that_is_locked():
    limits = np.array([[-1, 1], [-2, 2], [-3, 3.0]])
    locked_values = np.array([np.nan, np.nan, 0.0])
    room = JointDomain(limits, np.zeros((3, 2)), locked_values, np.zeros(3))

    def named(q, found):
        return diagnosis.limits_hit(
            room, np.array(q, float), np.array(found, float), ("a", "b", "c")
        )

    assert named([1, 0, 3], [0, 0, 0]) == ("a",)
    assert named([-1 + 0.9e-9, 2, 0], [0, 0, 0]) == ("a", "b")
    assert named([1 - 1.1e-9, -2, 0], [5, 0, 0]) == ("b",)
    assert named([0, 0, 3], [1.5, -2.5, 4]) == ("a", "b", "c")
    assert named([0, 0, 0], [1.0, 2.5, 0]) == ("b",)


class Tries:
    """A solver, as the reasons ask it: what it finds without limits is known."""

    def __init__(self, limits, found, states):  # type: ignore[no-untyped-def]
        chain = line(coupling=None, offset=None, limits=[[-3, 3], [-0.5, 2.0]])
        self.fast = SimpleNamespace(chain=chain, q_names=("turn", "slide"))
        self.task = make_task("position", None, None)
        free = np.full(2, np.nan)
        self.domain = JointDomain(np.array(limits, float), np.zeros((2, 2)), free, np.zeros(2))
        self.contains = self.domain.contains
        self.has_joint_limits = False
        self.found, self.states, self.asked = np.array(found, float), states, []
        self.options = np.zeros(codes.OPTIONS)
        self.again: Any = None

    def solve(self, targets, numbers, q0, limits=None, ranges=None):  # type: ignore[no-untyped-def]
        self.asked.append((targets, numbers.tolist(), q0, limits, ranges))
        found, states = (self.found, self.states) if limits is not None else self.again
        info = np.zeros((len(targets), codes.INFO))
        info[:, codes.AT_STATE] = states
        return found, info


STATES = [
    codes.STALLED,
    codes.OUT_OF_ITERATIONS,
    codes.BAD_TARGET,
    codes.SOLVED,
    codes.OUT_OF_ITERATIONS,
    codes.STALLED,
]
FREE = [[-np.inf, np.inf]] * 2


def asked(solver, q):  # type: ignore[no-untyped-def]
    """What is said of six targets in these states, the fifth of them 100 m away."""
    info = np.zeros((6, codes.INFO))
    info[:, codes.AT_STATE] = STATES
    T = np.tile(np.eye(4), (6, 1, 1))
    T[4, 0, 3] = 100.0
    T[2] = np.nan
    success = np.array([False, False, False, True, False, False])
    return diagnosis.find_causes(solver, T, q, info, success)


def test_a_reason_is_that_of_the_state_in_which_the_tries_ended():
    solver = Tries(FREE, np.zeros((0, 2)), [])
    reason, beyond, blocked, _ = asked(solver, np.zeros((6, 2)))
    assert reason.tolist() == [
        "unreachable",
        "iterations",
        "bad target",
        "solved",
        "iterations",
        "unreachable",
    ]
    assert (beyond > 0).tolist() == [False] * 6, "without limits a slide reaches any place"
    assert blocked == ((),) * 6
    assert solver.asked == []


def test_what_is_solved_without_limits_is_in_their_way_or_within_them_after_all():
    solver = Tries(
        [[-1, 1], [-0.5, 2]],
        [[0.5, 1.0], [7.0, 0.0], [0.0, 0.0]],
        [codes.SOLVED, codes.SOLVED, codes.STALLED],
    )
    q = np.tile([1.0, 0.25], (6, 1))
    reason, beyond, blocked, _ = asked(solver, q)
    assert reason.tolist() == [
        "solved",
        "limits",
        "bad target",
        "solved",
        "unreachable",
        "unreachable",
    ]
    assert (beyond > 0).tolist() == [False] * 4 + [True, False]
    assert blocked == ((), ("turn",), (), (), (), ())
    np.testing.assert_array_equal(q, [[0.5, 1.0], *[[1.0, 0.25]] * 5])
    ((targets, numbers, q0, limits, ranges),) = solver.asked
    assert (targets.shape, numbers) == ((3, 4, 4), [0, 1, 5])
    assert np.isnan(q0).all()
    assert q0.shape == (3, 2)
    np.testing.assert_array_equal(limits, FREE)
    np.testing.assert_allclose(ranges, [[-np.pi, np.pi], [-1, 1]])


@pytest.mark.parametrize(("again", "reason"), [
    ([0.25, 1.5], "solved"), ([0.25, 2.5], "limits"), (None, "limits"),
])  # fmt: skip
def test_what_is_solved_beyond_the_limits_is_tried_within_them_once_more(again, reason):
    """From the nearest place within them, and by as many restarts; without restarts it is not."""
    solver = Tries([[-1, 1], [-0.5, 2]], [[7.0, 0.0], [0.5, 1.0], [0.0, 3.0]], [codes.SOLVED] * 3)
    solver.options[codes.RESTARTS] = 20
    state = codes.SOLVED if again else codes.STALLED
    solver.again = (np.array([again or [0.5, 0.5], [0.5, 0.5]]), [state, codes.STALLED])
    q = np.tile([1.0, 0.25], (6, 1))
    reasons = asked(solver, q).reason
    assert reasons[[0, 1, 5]].tolist() == [reason, "solved", "limits"]
    assert q[0].tolist() == (again if reason == "solved" else [1.0, 0.25])
    _, (targets, numbers, q0, *_) = solver.asked
    assert (targets.shape, numbers) == ((2, 4, 4), [3e10, 5 + 3e10])
    assert q0.tolist() == [[1.0, 0.0], [0.0, 2.0]]


@pytest.mark.parametrize("far", [1e160, 1e308])
def test_a_target_whose_square_is_no_number_is_as_far_as_it_is(far):
    arm = pk.load("ur5e").chain()
    target = np.eye(4)
    target[:3, 3] = far / 2
    with np.errstate(all="raise"):
        found = ik(arm, target)
    assert found.reason == "unreachable"
    assert found.distance_beyond_reach == pytest.approx(far * math.sqrt(0.75), rel=1e-15)
    assert found.summary().endswith("; there is no nearest pose: the numbers are too large")
