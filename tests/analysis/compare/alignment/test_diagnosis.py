"""Models of which most axes differ are aligned to all of them, or left as they stand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from benchmarks.planted_changes import arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment import diagnosis
from poekin.analysis.compare.alignment.diagnosis import diagnose
from poekin.groups import se3

TOL = Tolerances(1e-5, np.radians(1e-3))
NOMINAL = pk.dh.published("ur10e")
CALIBRATED = pk.ur.add_deltas(
    NOMINAL,
    delta_theta=[-2.41e-07, 1.60233952, -1.68607191, 0.0837331148, -1.01e-07, 3.9e-08],
    delta_d=[-0.000160188, 439.140974080, -446.027059806, 6.886186896, -3.87e-05, -0.000879083],
    delta_a=[2.12e-05, 0.632017133, 0.002298336, -4.61e-05, -6.39e-05, 0],
    delta_alpha=[-0.000650247, 0.001394167, 0.006938188, -0.000811642, 0.000411121, 0],
)


def off(chain, wrong, rng):
    """The arm with some axes turned by a milliradian or so and moved by half a millimetre or so."""
    screws = chain.screws.copy()
    for k in wrong:
        motion = [*(2e-3 * rng.normal(size=3)), *(5e-4 * rng.normal(size=3))]
        screws[k] = se3.adjoint(se3.exp(motion)) @ screws[k]
    return chain.replace(screws=screws)


def worse(result):
    """Pose errors aligned by those as they stand."""
    before, after = result.before, result.after
    return max(
        after.worst_position / before.worst_position,
        after.mean_position / before.mean_position,
        after.worst_rotation / before.worst_rotation,
    )


@pytest.mark.parametrize("swapped", [False, True])
def test_a_calibrated_arm_is_left_as_it_stands_and_its_right_joint_is_not_blamed(swapped):
    pair = [pk.dh.to_chain(NOMINAL), pk.dh.to_chain(CALIBRATED)]
    if swapped:
        pair.reverse()
    result = pk.compare(*pair)
    assert [joint.number for joint in result.differing] == [2, 3, 4, 5, 6]
    assert worse(result) <= 1.0
    assert result.aligned_to == "nothing"
    assert result.findings[-1].startswith("left as they stand, as no alignment")
    assert result.base == pytest.approx(np.eye(4))


@pytest.mark.parametrize("k", [1, 2, 3, 4])
@pytest.mark.parametrize("swapped", [False, True])
def test_a_wrong_zero_beside_a_calibration_is_named_and_not_the_axes_behind_it(k, swapped):
    wrong = np.where(np.arange(6) == k, np.radians(5.0), 0.0)
    calibrated = pk.dh.to_chain(CALIBRATED).rezeroed(wrong)
    pair = [pk.dh.to_chain(NOMINAL), calibrated.replace(limits=[[-2 * np.pi, 2 * np.pi]] * 6)]
    if swapped:
        pair.reverse()
    result = pk.compare(*pair)
    assert [joint.number for joint in result.joints if joint.zero_differs] == [k + 1]
    way = 1.0 if swapped else -1.0
    # The calibration itself turns joints by a few hundredths of a degree.
    zero = result.joints[k].zero_offset
    assert zero == pytest.approx(way * np.radians(5.0), abs=np.radians(0.05))
    # What is left is of the calibration's size: no axis is further off than without a wrong zero.
    assert [joint.number for joint in result.differing] == [2, 3, 4, 5, 6]
    assert max(joint.angle or 0.0 for joint in result.joints) < np.radians(0.37)
    assert max(joint.shift or 0.0 for joint in result.joints) < 1.3e-3
    assert result.base == pytest.approx(np.eye(4))


@pytest.mark.parametrize("swapped", [False, True])
def test_two_arms_are_not_aligned_where_the_poses_that_are_told_get_worse(swapped):
    pair = [pk.load(name).chain() for name in ("stanford", "puma560")]
    if swapped:
        pair.reverse()
    result = pk.compare(*pair)
    assert result.before is not None
    assert result.after is not None
    assert result.after.worst_position <= result.before.worst_position
    assert result.after.mean_position <= result.before.mean_position
    assert result.aligned_to == "nothing"


@pytest.mark.parametrize("name", ["ur5e", "panda"])
@pytest.mark.parametrize("seed", range(4))
def test_errors_as_of_a_real_arm_make_no_alignment_and_blame_no_right_joint(name, seed):
    chain = arm(name)
    rng = np.random.default_rng(seed)
    right = set(rng.choice(chain.dof, seed % 3, replace=False).tolist())
    other = off(chain, set(range(chain.dof)) - right, rng)
    pair = (chain, other) if seed % 2 else (other, chain)
    result = pk.compare(*pair)
    assert worse(result) <= 1.0
    assert not {joint.number - 1 for joint in result.differing} & right


@pytest.mark.parametrize("name", ["ur5e", "panda"])
@pytest.mark.parametrize("tool", [False, True])
def test_such_an_arm_that_stands_elsewhere_is_aligned_to_all_axes(name, tool):
    chain = arm(name)
    rng = np.random.default_rng(0)
    other = off(chain, range(1, chain.dof), rng).rebased(se3.exp(0.3 * rng.normal(size=6)))
    if tool:
        other = other.retooled(se3.exp(0.3 * rng.normal(size=6)))
    result = pk.compare(chain, other)
    assert result.aligned_to == "all axes"
    assert worse(result) <= 0.1
    how = "aligned to all axes by least squares, as fewer than half agree: the base frame is moved"
    assert any(text.startswith(how) for text in result.findings)
    assert ("the tool frame" in result.verdict) == tool


def test_half_of_the_axes_are_enough_and_fewer_are_not():
    chain = arm("ur5e")
    rng = np.random.default_rng(2)
    moved = se3.exp([0.1, 0.2, 0, 0.3, 0, 0])
    found = [
        pk.compare(chain, off(chain, wrong, rng).rebased(moved)).aligned_to
        for wrong in ([1, 3, 4], [1, 2, 3, 4])
    ]
    assert found == ["agreeing axes", "all axes"]


def test_what_fewer_than_half_of_the_axes_ask_for_is_not_done():
    # Two axes of six agree exactly under another base; the other four stand.
    chain = arm("ur5e")
    screws = chain.screws.copy()
    T = se3.exp([0, 0, 0, 0.02, 0.03, 0.01])
    screws[4:] = screws[4:] @ se3.adjoint(T).T
    other = off(chain.replace(screws=screws), [1, 3], np.random.default_rng(0))
    result = pk.compare(chain, other)
    assert result.base == pytest.approx(np.eye(4), abs=1e-6)


def test_the_diagnosis_is_one_whichever_model_comes_first():
    chain = arm("panda")
    other = off(chain, [1, 2, 5], np.random.default_rng(4)).rezeroed([0, 0, 0.1, 0, 0, 0, 0])
    x = chain.random(0, 10)
    one = diagnose(chain, other, TOL, (x, x))
    two = diagnose(other, chain, TOL, (x, x))
    assert one.reading.moved.tolist() == two.reading.moved.tolist()
    assert one.reading.base @ two.reading.base == pytest.approx(np.eye(4), abs=1e-12)
    assert one.reading.deviations.tolist() == two.reading.deviations.tolist()
    back = two.reading.swapped(other)
    assert back.axes == pytest.approx(one.reading.axes, abs=1e-12)
    assert back.zeros == pytest.approx(one.reading.zeros, abs=1e-15)


@pytest.mark.parametrize(
    ("worst", "mean", "holds"),
    [(1.5, 1.5, False), (0.5, 1.5, True), (1.5, 0.5, True), (-0.5, 1.5, True), (1.5, -0.5, True)],
)
def test_a_reading_is_none_where_its_worst_pose_and_its_mean_are_worse_by_more_than_a_tolerance(
    worst, mean, holds, monkeypatch
):
    room = 1e-3
    before = np.array([0.0, 0.01, 0.02])
    centre = before.mean() + mean * room
    top = before.max() + worst * room
    rest = 3 * centre - top
    after = np.array([rest / 2, rest / 2, top])
    given: Any = SimpleNamespace(
        samples=[None],
        a=SimpleNamespace(fk=lambda x: None),
        b=SimpleNamespace(fk=lambda x: before),
        pair=SimpleNamespace(n=6, tol=SimpleNamespace(position=room)),
    )
    reading: Any = SimpleNamespace(beside_link=np.zeros(6, bool), poses=lambda chain, x: after)
    monkeypatch.setattr(diagnosis, "pose_differences", lambda ours, theirs: (theirs, None))
    assert diagnosis._holds(given, reading) == holds


def told(monkeypatch, *readings, linked=None):
    """What is told where the models as they stand are 100 tolerances apart in each of two sets of
    poses, and other readings are of so many frames, zeros and errors.
    """
    found: list[Any] = [
        SimpleNamespace(frames=frames, offset=np.arange(6) < zeros, errors=np.array(errors))
        for frames, zeros, *errors in [(0, 0, 100, 100), *readings]
    ]
    first = SimpleNamespace(moved=np.ones(6, bool))
    monkeypatch.setattr(diagnosis, "search", lambda a, b, tol: (first, ["others"]))
    monkeypatch.setattr(diagnosis, "sides", lambda a, b, tol: None)
    monkeypatch.setattr(diagnosis, "_holds", lambda case, reading: False)
    monkeypatch.setattr(diagnosis, "_of_all_axes", lambda case: found)
    monkeypatch.setattr(diagnosis, "_errors", lambda case, reading: reading.errors)
    monkeypatch.setattr(diagnosis, "with_link", lambda pair, readings: [linked] if linked else [])
    nothing: Any = None
    return found, diagnosis._diagnose(nothing, nothing, nothing, ())


@pytest.mark.parametrize("readings, best", [
    ([], 0),
    ([(1, 0, 50, 50)], 1),  # an alignment may leave half
    ([(1, 0, 51, 10)], 0),
    ([(1, 0, 10, 51)], 0),
    ([(0, 1, 25, 25)], 1),  # another zero a quarter
    ([(0, 1, 26, 1)], 0),
    ([(1, 1, 1, 26)], 0),
    ([(0, 0, 60, 60)], 0),  # for nothing there is none
    ([(1, 0, 40, 40), (1, 0, 40, 40)], 2),  # of two that move as much it is the better one
    ([(1, 0, 40, 40), (1, 0, 39, 39)], 2),
    ([(1, 0, 40, 40), (1, 0, 39, 41)], 1),
    ([(0, 1, 20, 20), (0, 1, 19, 19), (0, 0, 18, 18)], 3),
    ([(1, 0, 40, 40), (2, 0, 20, 20)], 2),  # one that moves more is to leave half of the best one's
    ([(1, 0, 40, 40), (2, 0, 21, 21)], 1),
    ([(2, 0, 40, 40), (1, 0, 21, 21)], 1),
    ([(1, 0, 40, 40), (1, 1, 10, 10)], 2),
    ([(1, 0, 40, 40), (1, 1, 11, 11)], 1),
    ([(0, 1, 20, 20), (0, 2, 6, 6), (0, 2, 5, 5)], 3),
])  # fmt: skip
def test_a_reading_is_told_where_it_leaves_enough_less_than_the_best_one_before_it(
    readings, best, monkeypatch
):
    found, result = told(monkeypatch, *readings)
    assert result.reading is found[best]
    assert result.others == []
    assert result.aligned_to == ("all axes" if found[best].frames else "nothing")


@pytest.mark.parametrize("frames, how", [(0, "nothing"), (1, "all axes")])
def test_a_link_that_explains_the_last_axes_is_told_with_what_it_was_aligned_to(
    frames, how, monkeypatch
):
    linked = SimpleNamespace(frames=1 - frames)
    _, result = told(monkeypatch, (frames, 0, 10, 10), linked=linked)
    assert (result.reading, result.aligned_to) == (linked, how)


def case_of(samples, ours, theirs):
    """Two arms with these poses at numbers of samples, and a reading that takes b's as they are."""
    a = SimpleNamespace(fk=lambda x: ours[x])
    b = SimpleNamespace(fk=lambda x: theirs[x])
    case: Any = SimpleNamespace(
        a=a, b=b, samples=samples, pair=SimpleNamespace(tol=Tolerances(0.5, 0.125))
    )
    reading: Any = SimpleNamespace(
        poses=lambda chain, x: chain.fk(x), tool=se3.exp([0.1, 0, 0.2, 1, 2, 3])
    )
    return case, reading


def test_the_errors_of_each_set_are_its_worst_in_position_and_in_rotation_each_in_tolerances():
    ours = np.tile(np.eye(4), (4, 1, 1))
    theirs = se3.exp([[0, 0, 0, 2, 0, 0], [0.5, 0, 0, 0, 0, 0], [0, 0.25, 0, 0, 0, 0], [0] * 6])
    case, reading = case_of((np.array([0, 1]), np.array([2, 3]), np.array([3])), ours, theirs)
    assert diagnosis._errors(case, reading) == pytest.approx(
        [2 / 0.5 + 0.5 / 0.125, 0.25 / 0.125, 0]
    )


def test_the_tool_brings_the_poses_nearest_in_the_mean():
    rng = np.random.default_rng(0)
    theirs = se3.exp(rng.normal(size=(9, 6)))
    tool = se3.exp([0.4, -0.3, 0.2, 0.1, 0.2, 0.3])
    ours = theirs @ tool @ se3.exp(0.3 * rng.normal(size=(9, 6)))
    case, reading = case_of((np.arange(4), np.arange(4, 9)), ours, theirs)
    mean = se3.inverse(reading.tool) @ diagnosis._tool(case, reading)
    left = se3.log(se3.inverse(theirs @ mean) @ ours)
    assert np.abs(left).max() > 0.1
    # Three steps leave 1e-6, of which each leaves a fiftieth or so; two of them 1e-4.
    np.testing.assert_allclose(left.mean(0), 0, atol=1e-5)
