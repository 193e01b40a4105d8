"""Measurements of another tool or another arm are told with figures; a base that stands elsewhere
is no fault.
"""

from __future__ import annotations

import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.groups import se3
from poekin.solve.calibration import Calibration, Distances, EyeInHand, Points, Poses, calibrate
from poekin.solve.calibration.diagnostics import explanation
from poekin.solve.calibration.diagnostics.explanation import Explanation, Size
from poekin.solve.calibration.measurements.simulated import simulated
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem
from poekin.solve.calibration.model.residuals import Residuals
from poekin.solve.calibration.report import toml_io

PANDA = pk.load("panda").chain(tip="panda_link8")
X, Z = se3.exp([0.3, -0.5, 0.2, 2.0, 1.4, -0.3]), se3.exp([-0.1, 0.2, 1.4, 0.05, -0.08, 0.1])
TOOL = np.array([0.2, 0.1, 0.4])  # 0.458 m
ARMS = {
    "ur5": pk.load("ur5").chain(),
    "stanford": pk.load("stanford").chain(),
    "scara": pk.Chain.from_space(
        [
            pk.screw.revolute([0, 0, 1], [0, 0, 0]),
            pk.screw.revolute([0, 0, 1], [0.4, 0, 0]),
            pk.screw.prismatic([0, 0, 1]),
            pk.screw.revolute([0, 0, 1], [0.7, 0, 0]),
        ],
        se3.exp([0, 0, 0, 0.7, 0, 0.2]),
    ),
}


def warned(arm, q, measurements, **options) -> tuple[Calibration, str]:
    """A calibration that warns, once, and what it says."""
    with pytest.warns(pk.PoekinWarning) as caught:
        found = calibrate(arm, q, measurements, folds=0, **options)
    assert [str(one.message) for one in caught] == list(found.warnings)
    (words,) = found.warnings
    assert found.remarks == ()
    return found, words


@pytest.mark.parametrize("kind", ["eye-in-hand", "eye-to-hand"])
def test_camera_poses_given_as_poses_of_the_tip_are_told_with_how_far_base_and_tool_are(
    kind, tmp_path
):
    s = simulated(PANDA, 40, kind=kind, seed=3)
    found, words = warned(PANDA, s.q, Poses(s.measurements.T))  # type: ignore[attr-defined]
    assert found.success
    moved = re.search(
        r"base moved by ([\d.]+) m and ([\d.]+) rad, tool by ([\d.]+) m and ([\d.]+) rad; ", words
    )
    assert moved is not None
    true = [size(T) for T in (s.X, s.Z)]
    # an arm that is off by 2 mrad and 1 mm in each of 34 parameters: a base and tool off by some 10
    np.testing.assert_allclose(
        np.array(moved.groups(), float).reshape(2, 2), true, rtol=0, atol=0.02
    )
    assert "EyeInHand or EyeToHand (kind eye-in-hand or eye-to-hand)" in words
    assert f"\nwarning: {words}" in str(found)
    found.save(tmp_path / "arm.toml")
    assert toml_io.load(tmp_path / "arm.toml").warnings == (words,)
    assert calibrate(PANDA, s.q, s.measurements, folds=0).warnings == ()


def size(T: np.ndarray | None) -> tuple[float, float]:
    assert T is not None
    return float(np.linalg.norm(T[:3, 3])), float(np.linalg.norm(pk.so3.log(T[:3, :3])))


@pytest.mark.parametrize("name", ARMS)
def test_a_base_that_is_elsewhere_is_a_remark_and_no_warning(name, tmp_path):
    arm = ARMS[name]
    s = simulated(arm, 40, seed=1)
    T = se3.inverse(X) @ s.measurements.T  # type: ignore[attr-defined]
    found = calibrate(arm, s.q, T, folds=0)
    assert found.success
    assert found.warnings == ()
    (words,) = found.remarks
    assert "base moved by 2.4" in words
    assert words in str(found)
    found.save(tmp_path / "arm.toml")
    assert toml_io.load(tmp_path / "arm.toml").remarks == (words,)
    assert "tool by " in warned(arm, s.q, T @ Z)[1]


UNKNOWN = {
    "point": lambda T: Points((T @ [*TOOL, 1])[:, :3], points=None),
    "probe": lambda T: Poses(T @ Z, tool="unknown"),
}


@pytest.mark.parametrize("what", UNKNOWN)
def test_a_base_that_is_elsewhere_is_told_where_the_tool_is_not_known(what):
    arm = ARMS["ur5"]
    q = arm.random(1, 40)
    T = se3.inverse(se3.exp([0, 0, 0.3, 0.5, 0.2, 0.1])) @ arm.fk(q)
    found = calibrate(arm, q, UNKNOWN[what](T), folds=0)
    assert found.warnings == ()
    (words,) = found.remarks
    assert ": base moved by 0.546 m and 0.3 rad, to the frame that was measured in; " in words
    assert re.search(
        r"most likely: the \w+: base moved by 0.546 m and 0.3 rad \(", found.verdict[0]
    )


def test_nothing_is_told_of_base_and_tool_where_neither_is_known():
    q = PANDA.random(1, 40)
    T = X @ PANDA.fk(q) @ Z
    sets = [
        Poses(T, frame="unknown", tool="unknown"),
        Points(T[:, :3, 3], points=None, frame="unknown"),
    ]
    problem = Problem(ErrorModel(PANDA, ("home",), None), q, sets)
    assert [explanation.explained(problem, k) for k in range(2)] == [None, None]


def test_a_tool_that_is_not_known_is_no_tip_to_be_taken():
    s = Poses(np.eye(4)[None], tool="unknown")
    assert "EyeInHand" in explanation.hint(s, Explanation(NEAR, None, NEAR), 5.0)
    assert explanation.hint(s, Explanation(NEAR, FAR, NEAR), 5.0).startswith("take the tip")


@pytest.mark.parametrize("seed", range(3))
def test_nothing_is_said_of_an_arm_that_is_off_by_a_centimetre(seed):
    s = simulated(PANDA, 40, tilt=1e-2, shift=1e-2, seed=seed)
    found = calibrate(PANDA, s.q, s.measurements, folds=0)
    assert (found.warnings, found.remarks) == ((), ())


def test_another_tool_is_told_where_the_base_stays():
    s = simulated(PANDA, 40, seed=1)
    T = s.measurements.T  # type: ignore[attr-defined]
    for tool, words in (
        (se3.exp([0, 0, 1.57, 0, 0, 0]), "mm and 1.57 rad; "),
        (se3.exp([0, 0, 0, 0, 0, 0.3]), "tool by 0.30"),
    ):
        said = warned(PANDA, s.q, T @ tool)[1]
        assert words in said
        assert said.endswith(
            "take the tip whose pose was measured, or put the tool on that it has (retooled)"
        )


POINTS = {
    "in the base": (
        lambda p: Points(p),
        r": base moved by \d(\.\d+)? mm and .* mrad, tool by 0.4[56]\d* m; .*points= says",
    ),
    "of a device": (
        lambda p: Points((p - X[:3, 3]) @ X[:3, :3], frame="unknown"),
        r": tool moved by 0.4[56]\d* m; .*points= says",
    ),
    "distances": (
        lambda p: Distances(np.linalg.norm(p - [0.2, 0.1, 2.0], axis=1), [0.2, 0.1, 2.0]),
        r"tool by 0.4[56]\d* m; .*point= says",
    ),
}


@pytest.mark.parametrize("what", POINTS)
def test_a_point_of_the_tool_that_was_not_said_is_told(what):
    made, words = POINTS[what]
    s = simulated(PANDA, 80, noise=(0, 0), seed=1)
    T = s.truth.fk(s.q)
    found, said = warned(PANDA, s.q, made(T[:, :3, :3] @ TOOL + T[:, :3, 3]))
    assert found.after.median_length < 1e-9
    assert re.search(words, said)


def test_another_arm_is_told_as_no_base_and_tool_explain_it():
    ur5, ur3 = ARMS["ur5"], pk.load("ur3").chain()
    q = ur5.random(0, 40)
    T = ur3.fk(q)
    for measured in (T, EyeInHand(se3.inverse(X) @ T @ Z)):
        assert "no other base and tool explain it: is it this arm" in warned(ur5, q, measured)[1]


def test_of_several_sets_the_one_is_named():
    s = simulated(PANDA, 40, seed=1)
    T = s.measurements.T  # type: ignore[attr-defined]
    beside = EyeInHand(se3.inverse(X) @ T @ Z)
    tool = T @ se3.exp([0, 0, 0, 0, 0, 0.3])
    assert warned(PANDA, s.q, [beside, Poses(tool)])[1].startswith(
        "measurement set 1 (Poses): the nominal arm is off"
    )


def test_what_is_refused_is_told_with_the_base_and_tool_that_explain_it():
    s = simulated(PANDA, 40, kind="eye-in-hand", seed=3)
    words = (
        r"no arm near the nominal one explains these Poses.* most likely: the Poses: base moved by "
        r"0.92\d m and .* rad, tool by 0.1\d* m and .* rad \(poses between a camera and a board.*\); "
        r"with that the nominal arm is off by \d.* mm and .* mrad \(median\), as the data stand by "
    )
    with pytest.raises(InputError, match=words):
        calibrate(PANDA, s.q, s.measurements.T, parameters=["offsets"], folds=0)  # type: ignore[attr-defined]


def test_nothing_is_claimed_of_lengths_from_which_no_place_can_be_told():
    """A planar arm's distances: the place they are from, were it not the one that was said, cannot
    be found.
    """
    arm = pk.Chain.from_space(
        [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0, 0.4, 0.7)],
        se3.exp([0, 0, 0, 0.9, 0, 0]),
    )
    q = arm.random(0, 60)
    d = np.linalg.norm(arm.fk(q)[:, :3, 3] - [0.0, 2.0, 0.5], axis=1)
    said = warned(arm, q, Distances(d, [1.0, 1.5, 0.5]), on_rank_deficiency="fix")[1]
    assert re.search(r"the calibrated one by [\d.]+ mm: is it this arm, ", said)


@pytest.mark.parametrize("tool, left, other", [
    ((0.029 * 5, 0.0), (0.0, 0.0), False), ((0.031 * 5, 0.0), (0.0, 0.0), True), ((0.3, 0.0), (0.08, 0.0), False),
    ((0.3, 0.0), (0.07, 0.0), True), ((0.0, 0.09), (0.0, 0.0), False), ((0.0, 0.11), (0.0, 0.0), True),
    ((0.0, 0.5), (0.0, 0.13), False), ((0.0, 0.5), (0.0, 0.12), True), ((0.1,), (0.0,), False),
    ((0.2,), (0.04,), True),
])  # fmt: skip
def test_a_tool_is_another_one_beyond_what_it_may_be_off_and_what_the_arm_leaves(tool, left, other):
    found = Explanation(None, Size(*tool), Size(*left))
    assert explanation._is_other_tool(found, 5.0) == other


@pytest.mark.parametrize("length, angle, beyond", [
    (0.49, 0.19, False), (0.51, 0.0, True), (0.0, 0.21, True), (0.49, np.nan, False), (0.51, np.nan, True),
])  # fmt: skip
def test_that_far_no_arm_is_off(length, angle, beyond):
    assert explanation.far(Size(length, angle), 5.0) == beyond


@pytest.mark.parametrize("size, words", [
    (Size(0.1, 0.0999), "0.1 m and 99.9 mrad"), (Size(1.2345, 0.5), "1.23 m and 0.5 rad"), (Size(0.02), "20 mm"),
    (Size(9e-12, 2e-11), "0 mm and 2e-08 mrad"),
])  # fmt: skip
def test_a_size_is_told_in_thousandths_below_a_tenth(size, words):
    assert str(size) == words
    assert str(Explanation(size, Size(0.5), size)) == f"base moved by {words}, tool by 0.5 m"
    assert str(Explanation(None, Size(0.5), size)) == "tool moved by 0.5 m"
    assert str(Explanation(size, None, size)) == f"base moved by {words}"


NEAR, FAR, BASE = Size(0.01, 0.01), Size(2.0, 0.5), Size(1.0, 0.25)
HEAD = f"the nominal arm is off by {FAR} (median), the calibrated one by {NEAR}"
OTHER_ARM = (
    f"{HEAD}, and no other base and tool explain it: is it this arm, in its order of joints, are lengths in m and"
    " angles in rad? compare() says which joints changed"
)
OTHERS = (
    "the calibrated arm's frames are then other ones than base 'here' and tip 'there'; the hint"
)


def residuals(*sizes):
    count = np.arange(len(sizes))
    return Residuals(
        np.array([s.length for s in sizes]), np.array([s.angle for s in sizes]), count, count
    )


def kinds(*angular) -> Any:
    sets = [SimpleNamespace(angular=a, what=f"Kind{k}") for k, a in enumerate(angular)]
    return SimpleNamespace(
        sets=sets,
        model=SimpleNamespace(nominal=SimpleNamespace(reach=1.0, base="here", tip="there")),
    )


@pytest.mark.parametrize("before, after, other, warning, remark", [
    (NEAR, NEAR, None, None, None), (FAR, FAR, None, None, None),
    (FAR, NEAR, None, OTHER_ARM, None), (FAR, NEAR, Explanation(BASE, NEAR, Size(0.11, 0.0)), OTHER_ARM, None),
    (FAR, NEAR, Explanation(None, NEAR, NEAR), f"{HEAD}: tool moved by {NEAR}; {OTHERS}", None),
    (FAR, NEAR, Explanation(BASE, FAR, NEAR), f"{HEAD}: base moved by {BASE}, tool by {FAR}; {OTHERS}", None),
    (FAR, NEAR, Explanation(BASE, NEAR, NEAR), None,
     f"{HEAD}: base moved by {BASE}, to the frame that was measured in; the hint"),
])  # fmt: skip
def test_of_a_set_that_the_nominal_arm_misses_by_far_it_is_told_what_explains_it(
    before, after, other, warning, remark, monkeypatch
):
    monkeypatch.setattr(explanation, "explained", lambda problem, k: other)
    monkeypatch.setattr(explanation, "hint", lambda *given: "the hint")
    said = explanation.explain(kinds(3), residuals(before), residuals(after))
    assert said == (() if warning is None else (warning,), () if remark is None else (remark,))
    both = explanation.explain(kinds(3, 3), residuals(NEAR, before), residuals(NEAR, after))
    assert [len(words) for words in both] == [len(words) for words in said]
    for one, alone in zip(
        (*both.warnings, *both.remarks), (*said.warnings, *said.remarks), strict=True
    ):
        assert one == f"measurement set 1 (Kind1): {alone}"


def test_of_lengths_whose_place_cannot_be_found_no_more_is_claimed(monkeypatch):
    monkeypatch.setattr(explanation, "explained", lambda problem, k: None)
    (words,), remarks = explanation.explain(kinds(0), residuals(Size(2.0)), residuals(Size(0.01)))
    assert words.startswith(
        "the nominal arm is off by 2 m (median), the calibrated one by 10 mm: is it this arm, "
    )
    assert remarks == ()


def test_a_set_is_named_by_its_number_where_there_are_several():
    sets = [Distances([1.0]), Distances([2.0, 3.0])]
    assert explanation.set_name(sets, 1, "the") == "measurement set 1 (Distances)"
    assert explanation.set_name(sets[1:], 0, "these") == "these Distances"


def test_distances_have_their_base_moved_by_how_far_their_centre_is():
    known = Distances([1.0], centre=[1.0, 2.0, 3.0])
    assert explanation._base(known, np.array([4.0, 6.0, 3.0])) == Size(5.0)


def test_the_tool_alone_is_told_of_distances_whose_centre_is_not_known():
    q = PANDA.random(1, 40)
    T = PANDA.fk(q)
    d = np.linalg.norm(T[:, :3, :3] @ TOOL + T[:, :3, 3] - [1.0, 1.5, 0.5], axis=1)
    problem = Problem(ErrorModel(PANDA, ("home",), None), q, [Distances(d)])
    found = explanation.explained(problem, 0)
    assert found is not None
    assert found.base is None
    assert found.tool is not None
    assert found.tool.length == pytest.approx(np.linalg.norm(TOOL))


def test_the_point_that_distances_are_of_is_no_other_tool():
    q = PANDA.random(1, 40)
    T, centre = PANDA.fk(q), np.array([1.0, 1.5, 0.5])
    d = np.linalg.norm(T[:, :3, :3] @ TOOL + T[:, :3, 3] - centre, axis=1)
    told = Distances(d, centre - [0.3, 0, 0.4], point=TOOL)
    found = explanation.explained(Problem(ErrorModel(PANDA, ("home",), None), q, [told]), 0)
    assert found is not None
    assert found.base is not None
    assert found.base.length == pytest.approx(0.5)
    assert found.tool is not None
    assert found.tool.length < 1e-9


def test_base_and_tool_are_those_at_the_rows_of_q_that_a_set_names():
    q, rows = PANDA.random(1, 40), np.arange(1, 40, 2)
    told = Poses(X @ PANDA.fk(q[rows]) @ Z, rows=rows)
    found = explanation.explained(Problem(ErrorModel(PANDA, ("home",), None), q, [told]), 0)
    assert found is not None
    assert found.tool is not None
    assert found.tool.angle == pytest.approx(explanation.size_of(Z).angle)
    assert found.left.length < 1e-9
