"""The report on a path that was followed: which coordinate, where, and how much of what bound."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.model import screw
from poekin.solve.ik.solution import Solution
from poekin.solve.ik.task import make_task
from poekin.solve.path.path_interval import PathInterval
from poekin.solve.path.path_result import NEAR_SINGULAR, PathResult

Z = [0, 0, 1.0]
ARM = pk.Chain.from_space(
    [screw.revolute(Z, [0, 0, 0]), screw.revolute(Z, [1, 0, 0]), screw.prismatic(Z)], pk.se3.exp([0, 0, 0, 2, 0, 0]),
    joint_names=["shoulder", "elbow", "lift"], limits=[[-1, 2], [-2, 2], [0, 0.5]],
)  # fmt: skip


def followed(
    q, reason=None, errors=None, changes=(), task="position", limits=None, arm=ARM, **given
):
    """A path of which this is known; solved where nothing else is said."""
    q = np.array(q, float)
    n = len(q)
    reason = np.array(["solved"] * n if reason is None else reason)
    off = np.zeros((n, 2)) if errors is None else np.array(errors, float)
    nothing = np.zeros(n, np.int64)
    blocked = tuple(("lift",) if word == "limits" else () for word in reason)
    solution = Solution(
        q, reason == "solved", reason, off[:, 0], off[:, 1], nothing, nothing, np.zeros(n), blocked
    )
    bounds = arm.limits if limits is None else np.array(limits, float)
    times, speed, acceleration = (
        None if given.get(name) is None else np.array(given[name], float)
        for name in ("times", "speed", "acceleration")
    )
    return PathResult(
        arm,
        solution,
        tuple(changes),
        make_task(task, None, None),
        bounds,
        times,
        speed,
        acceleration,
    )


def test_steps_are_those_of_the_coordinate_that_moves_most():
    path = followed([[0, 1, 0], [0.1, 0.7, 0.1], [0.1, 0.75, 0.3], [np.nan] * 3, [0.1, 0.8, 0.3]])
    assert path.steps[:2] == pytest.approx([0.3, 0.2])
    assert np.isnan(path.steps[2:]).all()
    assert path.largest_step == pytest.approx(0.3)
    assert path.rates is None
    assert path.accelerations is None
    assert followed(np.zeros((1, 3))).largest_step == 0
    assert followed(np.zeros((0, 3))).largest_step == 0


def test_rates_and_accelerations_are_differences_over_the_time_between():
    q = np.array([[0, 0, 0], [0.1, 0, 0.2], [0.4, -0.2, 0.2], [0.2, 0, 0]])
    times = np.array([0, 0.1, 0.3, 0.7])
    path = followed(q, times=times)
    assert path.rates == pytest.approx(np.array([[1, 0, 2], [1.5, -1, 0], [-0.5, 0.5, -0.5]]))
    # From the middle of one step to that of the next it is 0.15 and 0.3 s.
    assert path.accelerations == pytest.approx(
        np.array([[0.5 / 0.15, -1 / 0.15, -2 / 0.15], [-2 / 0.3, 1.5 / 0.3, -0.5 / 0.3]])
    )


def test_what_exceeds_a_limit_is_named_from_where_to_where_with_its_worst_point():
    times, q = (
        np.arange(6.0),
        np.array([[0, 0, 0], [1, 0, 0], [3, 0, 0], [4.5, 0, 0], [5, 0, 3], [5.1, 0, 3.0]]),
    )
    path = followed(q, times=times, speed=[0.9, 1, 1], acceleration=[0.9, 5, 2.5])
    assert path.speed_violations == (
        PathInterval(0, 2, "shoulder", 1, 2.0, 0.9),
        PathInterval(3, 3, "lift", 3, 3.0, 1.0),
    )
    assert path.acceleration_violations == (
        PathInterval(1, 1, "shoulder", 1, 1.0, 0.9), PathInterval(3, 3, "shoulder", 3, 1.0, 0.9),
        PathInterval(3, 4, "lift", 3, 3.0, 2.5),
    )  # fmt: skip
    assert not path.ok
    at = followed(q, times=times, speed=[2, 1, 3], acceleration=[1, 5, 3])
    assert (at.speed_violations, at.acceleration_violations, at.ok) == ((), (), True)
    assert followed(q, times=times).ok
    assert not followed(q, changes=[2]).ok
    assert not followed(q, reason=["solved"] * 5 + ["unreachable"]).ok


def test_coordinates_at_their_limits_are_named_at_the_point_nearest_to_it():
    q = [[0, 0, 0.5], [2 - 2e-9, 0, 0.5 - 9e-10], [2 - 9e-10, 0, 0.1], [2, 1, 0], [-1, 1, np.nan]]
    path = followed(q)
    assert path.at_limits == (
        PathInterval(0, 1, "lift", 0, 0.5, 0.5),
        PathInterval(2, 3, "shoulder", 3, 2.0, 2.0), PathInterval(3, 3, "lift", 3, 0.0, 0.0),
        PathInterval(4, 4, "shoulder", 4, -1.0, -1.0),
    )  # fmt: skip
    assert followed(q, limits=[[-np.inf, np.inf]] * 3).at_limits == ()


def test_regularity_is_the_quotient_of_the_singular_values_of_what_the_task_asks():
    q = np.array([[0.3, 1.0, 0.1], [0.3, 5e-3, 0.1], [0.3, 1e-3, 0.1], [0.3, -1.0, 0.1]])
    J = ARM.jacobian(q, "hybrid")[:, 3:] / ARM.reach
    s = np.linalg.svd(J, compute_uv=False)
    path = followed(q)
    assert path.inverse_condition == pytest.approx(s[:, 2] / s[:, 0])
    (near,) = path.near_singular
    assert near == PathInterval(1, 2, "", 2, path.inverse_condition[2], NEAR_SINGULAR)
    rotation = followed(q, task="rotation")
    # three numbers, and the arm turns about one axis alone, but about that one everywhere
    assert rotation.inverse_condition == pytest.approx(np.ones(4))
    whole = np.linalg.svd(
        ARM.jacobian(q, "hybrid") / np.repeat([1, ARM.reach], 3)[:, None], compute_uv=False
    )
    assert followed(q, task="pose").inverse_condition == pytest.approx(whole[:, 2] / whole[:, 0])


def test_the_report_says_it_all_in_sentences():
    q = np.array(
        [
            [0, 1, 0.1],
            [0.1, 1, 0.1],
            [0.2, 1, 0.5],
            [0.2, 1, 0.5],
            [np.nan] * 3,
            [-0.5, -1.5, 0.2],
            [0.1, -1.5, 0.2],
        ]
    )
    reason = ["solved", "solved", "limits", "limits", "bad target", "solved", "solved"]
    errors = [[1e-10, 0], [2e-9, 3e-9], [0.1, 0], [0.2, 0.3], [np.nan] * 2, [0, 0], [0, 0]]
    path = followed(
        q,
        reason,
        errors,
        changes=[5],
        times=np.arange(7.0),
        speed=[0.55, 3, 1],
        acceleration=[9, 9, 0.35],
    )
    assert path.summary().splitlines() == [
        "4 of 7 poses reached, within 2e-06 mm and 1.7e-07°; largest step 0.6 (rad or m)",
        f"poses 2 to 3 not reached, least of all 3: {path.solution.summary(3)}",
        "pose 4 not reached: bad target: it is not made of finite numbers",
        "the branch changes before pose 5: no way on from pose 3; the joints jump by 2.5, most of it in 'elbow'",
        "poses 2 to 3: 'lift' at its limit 0.5",
        "pose 5: 'shoulder' exceeds its speed, 0.6 of 0.55 (rad or m)/s at 5",
        "poses 1 to 2: 'lift' exceeds its acceleration, 0.4 of 0.35 (rad or m)/s^2 at 1",
    ]
    assert "in the way are those of 'lift'" in path.solution.summary(3)
    assert str(path) == path.summary()
    assert repr(path) == "<PathResult 4 of 7 poses, largest step 0.6, 1 change of branch>"
    assert repr(followed(q[:2], changes=[1, 2])).endswith(", 2 changes of branch>")
    assert repr(followed(q[:2])) == "<PathResult 2 of 2 poses, largest step 0.1>"
    with pytest.raises(IndexError):
        path.solution.summary(7)


def test_of_rotations_that_are_not_reached_the_farthest_off_is_named():
    errors = [[0, 0.1], [0, 0.3], [0, 0.2]]
    path = followed([[0, 1, 0.1]] * 3, ["unreachable"] * 3, errors, task="rotation")
    assert "poses 0 to 2 not reached, least of all 1: " in path.summary()


def test_a_singularity_is_told_in_the_words_of_what_the_task_asks():
    q = [[0.0, 0.5, 0.1], [0.0, 5e-4, 0.1], [0.0, 1e-3, 0.1]]
    (said,) = followed(q).summary().splitlines()[1:]
    words = pk.singularity(ARM, q[1], part="translation").summary()
    assert said == f"poses 1 to 2: near a singularity, most at 1: {words}"
    assert "the base's x axis" in said


def arm_along_x(*joints):
    """An arm of joints about z at these x, and its tool at 1.2 m."""
    axes = [screw.revolute(Z, [x, 0, 0]) for x in joints]
    return pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, 1.2, 0, 0]))


@pytest.mark.parametrize("task", ["pose", "position", "rotation", "direction", "planar"])
def test_a_planar_arm_is_near_a_singularity_where_it_is_stretched_and_nowhere_else(task):
    arm = arm_along_x(0.0, 0.5, 0.9)
    q = np.array([0.4, 0.5, 0.6]) + np.linspace(0, 0.1, 5)[:, None]
    path = pk.follow(arm, arm.fk(q), task=task, q0=q[0])
    assert (path.inverse_condition > NEAR_SINGULAR).all()
    assert path.near_singular == ()
    assert path.summary().count("\n") == 0
    straight = followed([[0.4, 0, 0]], task=task, arm=arm)
    assert len(straight.near_singular) == (task != "rotation")


def test_a_locked_coordinate_leads_out_of_no_singularity():
    arm = arm_along_x(0.0, 0.5, 0.9)
    name = arm.q_names[2]
    tip = arm.fk([0, 0, 1.0])[:2, 3] - [0.5, 0]
    stretched = [0.4, -np.arctan2(tip[1], tip[0]), 1.0]
    q = np.array(stretched) + np.outer(np.linspace(-0.3, 0.3, 7), [0, 1, 0])
    path = pk.follow(arm, arm.fk(q), task="position", q0=q[0], lock={name: 1.0}, max_step=0.2)
    assert path.q == pytest.approx(q, abs=1e-3)  # along the arm's direction the tool stands still
    J = arm.jacobian(path.q, "hybrid")[:, 3:5, :2]
    s = np.linalg.svd(J, compute_uv=False)
    assert path.inverse_condition == pytest.approx(s[:, 1] / s[:, 0], abs=1e-12)
    (near,) = path.near_singular
    assert (near.first, near.last) == (3, 3)
    assert path.to_dict()["lock"] == {name: 1.0}
    words = path.summary().splitlines()[1]
    assert words.startswith("pose 3: near a singularity, most at 3: singular (")
    assert name not in words
    free = followed(q, arm=arm)
    assert free.near_singular == ()
    assert free.lock == {}


def test_a_coordinate_in_degrees_is_locked_where_it_stands_and_not_at_as_many_radians():
    # at 180 degrees the outer axes are one line: the wrist has one turn, and that is never lost
    axes = [[0, 0, 1], [0, 1, 0], [0, 0, 1]]
    wrist = pk.Chain.from_space(
        [screw.revolute(w, [0, 0, 0]) for w in axes], np.eye(4), coupling=np.diag([1, np.pi / 180, 1]),
        q_names=["first", "tilt", "last"],
    )  # fmt: skip
    q = np.linspace([0, 180, 0], [0.2, 180, 0], 5)
    path = pk.follow(wrist, wrist.fk(q), task="rotation", q0=q[0], lock={"tilt": 180.0})
    assert path.success.all()
    assert path.inverse_condition == pytest.approx(1.0)
    assert path.near_singular == ()


def test_an_arm_without_any_motion_that_the_task_asks_is_nowhere_near_a_singularity():
    slides = pk.Chain.from_space([screw.prismatic(way) for way in np.eye(3)], np.eye(4))
    path = followed(np.zeros((2, 3)), task="rotation", arm=slides)
    assert path.inverse_condition.tolist() == [1, 1]
    assert path.near_singular == ()


@pytest.mark.parametrize("task", ["pose", "position"])
def test_near_a_singularity_is_not_called_regular(task):
    arm = arm_along_x(0.0, 0.5, 0.9)
    q = [[0.4, 0.02, 0.02]]
    path = followed(q, task=task, arm=arm)
    (near,) = path.near_singular
    part = "translation" if task == "position" else "pose"
    found = pk.singularity(arm, q[0], part=part)
    assert not found.singular
    assert near.value == pytest.approx(found.smallest / found.singular_values[0])
    words = path.summary().splitlines()[1]
    assert words == (
        "pose 0: near a singularity, most at 0 " + found.summary().removeprefix("regular ")
    )
    assert f"at 0 (smallest ÷ largest singular value {near.value:.3g}, tolerance 0.001): " in words
    assert "the nearest singularity is about 0.0" in words
    assert "regular" not in words


@pytest.mark.parametrize("task", ["direction", "planar"])
def test_of_other_tasks_the_quotient_alone_is_told(task):
    path = followed([[0.4, 0, 0]], task=task, arm=arm_along_x(0.0, 0.5, 0.9))
    words = path.summary().splitlines()[1]
    assert words.startswith("pose 0: near a singularity, most at 0 (smallest ÷ largest singular ")
    assert words.endswith(f" value {path.inverse_condition[0]:.3g})")


@pytest.mark.parametrize("elbow", [np.pi / 2, 1.0, 0.7])
def test_of_an_arm_that_is_badly_conditioned_everywhere_no_singularity_is_said_to_be_far(elbow):
    # the elbow is bent by what it is, and the distance is about its tangent
    arm = arm_along_x(0.0, 1.195)
    q = [[0.4, elbow]]
    path = followed(q, arm=arm)
    found = pk.singularity(arm, q[0], part="translation")
    assert not found.singular
    assert found.distance == pytest.approx(np.tan(elbow), rel=0.05) or elbow > 1.5
    (near,) = path.near_singular
    words = f" (smallest ÷ largest singular value {near.value:.3g})"
    if elbow == 0.7:
        words = " " + found.summary().removeprefix("regular ")
        assert "singularity is about 0.84 rad away" in words
    assert path.summary().splitlines()[1] == f"pose 0: near a singularity, most at 0{words}"


def test_where_the_tool_stands_still_whatever_moves_is_a_singularity():
    # two links folded in step move their end along a line, and not at all where they are stretched
    axes = [screw.revolute(Z, [x, 0, 0]) for x in (0.0, 1.0)]
    arm = pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, 2, 0, 0]), coupling=[[1], [-2]])
    path = followed([[0.0], [0.5]], arm=arm)
    assert path.inverse_condition.tolist() == [0, 1]
    assert "pose 0: near a singularity, most at 0: singular" in path.summary()


def test_a_path_is_plain_data_without_its_chain():
    q = [[0, 1, 0.1], [0.1, 1, 0.5]]
    document = json.loads(followed(q, times=[0, 1.0], speed=[0.05, 3, 1]).to_json())
    assert document["q"] == q
    assert document["task"]["name"] == "position"
    assert document["ok"] is False
    assert document["speed_violations"] == [
        {"first": 0, "last": 0, "name": "shoulder", "worst": 0, "value": 0.1, "bound": 0.05}
    ]
    assert not {"chain", "solution"} & set(document)


def test_where_nothing_is_reached_nothing_is_off():
    path = followed([[0, 1, 0.1]], reason=["unreachable"], errors=[[0.5, 0.25]])
    assert path.summary().splitlines()[0] == "0 of 1 poses reached"


def test_the_fastest_trajectory_is_through_its_coordinates():
    q = [[0, 0, 0.1], [0.1, 0.2, 0.1], [0.2, 0.2, 0.3]]
    found = followed(q).time_optimal(2.0, speed=[1.0, 2.0, 3.0])
    expected = pk.motion.time_optimal(ARM, q, acceleration=2.0, speed=[1.0, 2.0, 3.0])
    np.testing.assert_array_equal(found.q, expected.q)
    np.testing.assert_array_equal(found.times, expected.times)


def test_its_plot_is_over_its_times_and_broken_where_the_branch_changes(drawn_figures):
    pytest.importorskip("matplotlib")
    q = [[0, 0, 0], [0.1, 0, 0], [1.5, 0.2, 0], [1.6, 0.2, 0]]
    followed(q, changes=[2], times=[0, 1, 3, 8]).plot()
    first, last, gap = drawn_figures[0].axes[0].lines
    assert (first.get_xdata().tolist(), last.get_xdata().tolist()) == ([0, 1], [3, 8])
    assert gap.get_xdata() == [2, 2]


def test_there_is_no_fastest_trajectory_along_a_path_with_a_break():
    q = [[0, 0, 0.1], [0.1, 0.2, 0.1], [0.2, 0.2, 0.3]]
    missed = followed(q, reason=["solved", "unreachable", "solved"])
    with pytest.raises(InputError, match="a path without a break; pose 1 not reached: unreachable"):
        missed.time_optimal(2.0, speed=1.0)
    jumping = followed(q, changes=[2])
    with pytest.raises(
        InputError, match="a path without a break; the branch changes before pose 2"
    ):
        jumping.time_optimal(2.0, speed=1.0)


def test_each_event_has_its_place_its_kind_and_its_line_of_the_summary():
    path = followed(
        [[0, 1, 0], [0.1, 0.7, 0.1], [2, 0.75, 0.3], [0, 0, 0.3]],
        reason=["solved", "limits", "solved", "solved"],
        changes=[3],
        times=[0, 1, 2, 3],
        speed=[1, 9, 9],
    )
    found = [(event.first, event.last, event.kind) for event in path.events]
    # the elbow is stretched in the last one; 2 rad is the shoulder's limit, 0 m the lift's
    assert found == [
        (1, 1, "missed"),
        (3, 3, "switch"),
        (0, 0, "limit"),
        (2, 2, "limit"),
        (1, 2, "speed"),
        (3, 3, "singular"),
    ]
    assert [event.text for event in path.events] == path.summary().splitlines()[1:]
