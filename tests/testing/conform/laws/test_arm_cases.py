"""Arms as cases: what they mean, what of them is drawn, and what a smaller one may be."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from poekin.model.chain import Chain
from poekin.testing.conform import Subject
from poekin.testing.conform.laws import arm_cases
from poekin.testing.conform.laws.arm_cases import ARM_LAWS, CoordinateLimits
from poekin.testing.conform.laws.law import Case
from poekin.testing.oracles import exact
from tests.testing.drawing import drawn

REVOLUTE = [0.6, 0, 0.8, 0.5, -1.0, 0.25, 0.7, 0]
PRISMATIC = [0, 0.8, -0.6, 0, 0, 0, 1.5, 0]
HELICAL = [0.36, 0.48, 0.8, 0.1, 0.2, -0.3, -2.0, 0.25]
HOME = [0.3, -0.2, 0.1, 1.0, -2.0, 0.5]
CASE = Case(
    np.array([*REVOLUTE, *PRISMATIC, *HELICAL, *HOME]), ("revolute", "prismatic", "helical")
)
LAWS = {law.name: law for law in ARM_LAWS}
SUBJECT = Subject(Poekin)


def test_the_numbers_of_a_case_are_axis_point_q_pitch_and_home():
    arm, q = arm_cases.drawn(CASE)
    n, p = np.array(REVOLUTE[:3]), np.array(REVOLUTE[3:6])
    assert arm.screws[0] == pytest.approx([*n, *np.cross(p, n)], abs=1e-15)
    assert arm.screws[1] == pytest.approx([0, 0, 0, *PRISMATIC[:3]], abs=1e-15)
    n, p = np.array(HELICAL[:3]), np.array(HELICAL[3:6])
    assert arm.screws[2] == pytest.approx([*n, *(np.cross(p, n) + 0.25 * n)], abs=1e-15)
    assert q.tolist() == [0.7, 1.5, -2.0]
    assert np.array_equal(arm.home, exact.rounded(exact.exp(np.array(HOME))))
    longer = CASE.numbers.copy()
    longer[:3] *= 1 + 5e-10
    assert arm_cases.drawn(CASE._replace(numbers=longer))[0].screws == pytest.approx(
        arm.screws, abs=1e-15
    )


def test_a_simpler_case_has_a_joint_less():
    found = [(case.layout, case.numbers.tolist()) for case in arm_cases.simpler(CASE)]
    assert found == [
        (("prismatic", "helical"), [*PRISMATIC, *HELICAL, *HOME]),
        (("revolute", "helical"), [*REVOLUTE, *HELICAL, *HOME]),
        (("revolute", "prismatic"), [*REVOLUTE, *PRISMATIC, *HOME]),
    ]
    assert not list(arm_cases.simpler(Case(np.array([*REVOLUTE, *HOME]), ("revolute",))))


def test_vectors_and_directions_are_where_they_are():
    assert list(arm_cases.directions(CASE)) == [0, 8, 16]
    assert list(arm_cases.triples(CASE)) == [3, 11, 19, 24, 27]
    declared = Case(np.zeros(7), CoordinateLimits((-1.0,) * 7, (1.0,) * 7))
    assert not list(arm_cases.directions(declared))
    assert not list(arm_cases.triples(declared))


def changed(**places: float) -> Case:
    numbers = CASE.numbers.copy()
    for name, value in places.items():
        numbers[int(name[1:])] = value
    return CASE._replace(numbers=numbers)


ALLOWED = {
    "as it is": ({}, True),
    "an axis that is no direction": ({"_0": 0.61}, False),
    "q of a half turn": ({"_6": math.pi}, True),
    "q of more": ({"_6": 3.2}, False),
    "q of nothing": ({"_6": 0.0}, True),
    "a tiny q": ({"_6": 1e-200}, False),
    "a slide of 2 m": ({"_14": 2.0}, True),
    "a slide of more": ({"_14": 2.1}, False),
    "a slide of 1e-7": ({"_14": 1e-7}, False),
    "a pitch of 1 m": ({"_23": -1.0}, True),
    "a pitch of more": ({"_23": 1.1}, False),
    "a pitch of 1e-4": ({"_23": 1e-4}, False),
    "a point too far": ({"_19": 3.0}, False),
    "a point too near": ({"_3": 1e-4, "_4": 0.0, "_5": 0.0}, False),
    "home turned by more than π": ({"_24": 3.14}, False),
    "home turned by more than π about z": ({"_26": 3.14}, False),
    "home turned by π": ({"_24": math.pi, "_25": 0.0, "_26": 0.0}, True),
    "home 2 mm away": ({"_27": 0.0, "_28": 0.0, "_29": 2e-3}, True),
    "a point too far up": ({"_21": 3.0}, False),
    "a point 2 mm away": ({"_3": 0.0, "_4": 2e-3, "_5": 0.0}, True),
    "a slide of 1e-5": ({"_14": 1e-5}, True),
    "a pitch of 2 mm": ({"_23": 2e-3}, True),
    "a turn of 3 rad about a screw": ({"_22": 3.0}, True),
    "a turn of 1e-8 rad about a screw": ({"_22": 1e-8}, True),
    "a turn of 4 rad about a screw": ({"_22": 4.0}, False),
    "home turned by a tiny angle": ({"_24": 1e-200, "_25": 0.0, "_26": 0.0}, False),
    "home too far": ({"_27": 2.9}, False),
    "home too near": ({"_27": 1e-4, "_28": 0.0, "_29": 0.0}, False),
    "home at the origin": ({f"_{k}": 0.0 for k in range(24, 30)}, True),
}


@pytest.mark.parametrize("what", ALLOWED)
def test_what_may_be_drawn_is_allowed(what):
    places, allowed = ALLOWED[what]
    assert arm_cases.allowed(changed(**places)) is allowed


def test_a_declared_arm_stays_within_its_limits():
    arm = Chain.from_space(
        [[0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0]], np.eye(4), limits=[[-0.5, 1.5], [0.25, 2.0]]
    )  # fmt: skip
    subject: Any = Subject(
        type("Declared", (), {"fk": lambda self, q: arm.fk(q), "arm": arm, "poses": "home"})
    )
    cases = drawn(arm_cases.cases(subject), 100)
    q = np.array([case.numbers for case in cases])
    assert {case.layout for case in cases} == {CoordinateLimits((-0.5, 0.25), (1.5, 2.0))}
    assert q.min(axis=0).tolist() == [-0.5, 0.25]
    assert q.max(axis=0).tolist() == [1.5, 2.0]
    assert np.count_nonzero((q > [-0.5, 0.25]) & (q < [1.5, 2.0])) > 50
    layout = cases[0].layout
    for values, allowed in (
        ([-0.5, 0.25], True), ([1.5, 2.0], True), ([-0.6, 1.0], False), ([0.0, 2.1], False), ([0.0, 0.0], False)
    ):  # fmt: skip
        assert arm_cases.allowed(Case(np.array(values), layout)) is allowed


@pytest.mark.parametrize(("name", "kinds"), [("fk", 2), ("jacobian helical", 3)])
def test_arms_of_one_to_four_joints_are_drawn_with_signs_of_all_kinds(name, kinds):
    cases = drawn(LAWS[name].cases(SUBJECT), 150)
    assert {len(arm_cases._kinds(case)) for case in cases} == {1, 2, 3, 4}
    every = ["revolute", "prismatic", "helical"]
    assert {kind for case in cases for kind in arm_cases._kinds(case)} == set(every[:kinds])
    rows = np.concatenate([case.numbers[:-6].reshape(-1, 8) for case in cases])
    sorts = np.array([kind for case in cases for kind in arm_cases._kinds(case)])
    assert all(arm_cases.allowed(case) for case in cases)
    turns, slides = rows[sorts != "prismatic"], rows[sorts == "prismatic"]
    assert {-1.0, 1.0} <= set(np.sign(turns[:, 6]))
    assert np.abs(turns[:, 6]).max() > 3
    assert 0.5 < slides[:, 6].max() <= 2
    assert not slides[:, 3:6].any()
    assert turns[:, 3:6].any(axis=1).mean() > 0.5
    pitched = rows[sorts == "helical"]
    assert not rows[sorts != "helical", 7].any()
    if kinds > 2:
        assert {-1.0, 1.0} <= set(np.sign(pitched[:, 7]))
        assert 0.1 < np.abs(pitched[:, 7]).max() <= 1
    home = np.array([case.numbers[-6:] for case in cases])
    assert np.linalg.norm(home[:, :3], axis=1).max() > 3
    assert 1 < np.linalg.norm(home[:, 3:], axis=1).max() <= 3 * (1 + 1e-9)


def test_a_law_of_pitches_is_about_a_pitch():
    flat = Case(np.array([*REVOLUTE, *HOME]), ("revolute",))
    assert [LAWS[name].about(CASE) for name in LAWS] == [True] * 4
    assert [LAWS[name].about(flat) for name in LAWS] == [True, True, False, False]
    assert [law.applies(SUBJECT) for law in ARM_LAWS] == [
        True,
        True,
        SUBJECT.helical,
        SUBJECT.helical,
    ]
    assert [law.examples for law in ARM_LAWS] == [150] * 4


def test_what_is_shown_of_an_arm_can_be_pasted_and_is_exact():
    case = Case(np.array([*REVOLUTE, *PRISMATIC, *HOME]), ("revolute", "prismatic"))
    arm, q = arm_cases.drawn(case)
    pose, J = LAWS["fk"].show(SUBJECT, case), LAWS["jacobian"].show(SUBJECT, case)
    assert pose.words.startswith("screws revolute (ω = (0.6, 0, 0.8), v = (")
    assert "; prismatic (ω = (0, 0, 0), v = (0, 0.8, -0.6))" in pose.words
    assert pose.words.endswith("M = e^ξ of ω = (0.3, -0.2, 0.1), v = (1, -2, 0.5); q = [0.7, 1.5]")
    chain = Chain.from_space(arm.screws, arm.home)
    assert pose.expected == pytest.approx(chain.fk(q), abs=1e-14)
    frame: Any = SUBJECT.frame
    assert J.expected == pytest.approx(chain.jacobian(q, frame), abs=1e-14)
    for shown, function in ((pose, "fk"), (J, "jacobian")):
        assert f".{function}(" in shown.paste
        found: list[str] = []
        names: dict[str, Any] = {"print": found.append}
        exec(shown.paste, names)
        assert np.array(found[0]) == pytest.approx(shown.expected, abs=1e-14)


def test_the_second_oracle_is_asked_about_pose_and_jacobian(monkeypatch):
    arm, q = arm_cases.drawn(CASE)
    assert arm_cases.confirmed(arm, q, jacobian=True)
    with monkeypatch.context() as patch:
        patch.setattr(arm_cases.confirm, "of_velocities", lambda *_: False)
        assert not arm_cases.confirmed(arm, q, jacobian=True)
        assert arm_cases.confirmed(arm, q, jacobian=False)
        # only the law of the Jacobian asks of velocities
        agreed = {name: law.confirm(SUBJECT, CASE) for name, law in LAWS.items()}
        assert agreed == {name: "jacobian" not in name for name in LAWS}
    monkeypatch.setattr(arm_cases.confirm, "of_pose", lambda *_: False)
    assert not arm_cases.confirmed(arm, q, jacobian=False)
    assert not arm_cases.confirmed(arm, q, jacobian=True)


def test_zeros_to_rounding_are_shown_as_zeros():
    arm, _ = arm_cases.drawn(Case(np.array([0, 0, 1.0, 0, 0, 0, 0, 0, *[0.0] * 6]), ("revolute",)))
    quarter = arm_cases.truth(SUBJECT, arm, np.array([math.pi / 2]), False)
    assert quarter[0, 0] == pytest.approx(6.1e-17, rel=0.01, abs=0)  # cos of the float next to π/2
    assert arm_cases.truth(SUBJECT, arm, np.array([1e-61]), False)[1, 0] == 0
    assert arm_cases.truth(SUBJECT, arm, np.array([1e-59]), False)[1, 0] == 1e-59
    far, _ = arm_cases.drawn(
        Case(np.array([0, 0, 1.0, 0, 0, 0, 0, 0, 0, 0, 0, 1e3, 0, 0]), ("revolute",))
    )
    assert far.home[0, 3] == 1e3
    assert arm_cases.truth(SUBJECT, far, np.array([1e-58]), False)[1, 0] == 0


@pytest.mark.parametrize("shape", [(6,), (5, 2), (7, 2), (6, 1), (6, 3), (6, 2, 1), (2, 6, 2)])
@pytest.mark.parametrize("order", ["angular first", "linear first"])
def test_a_jacobian_of_another_shape_is_told_as_it_came(shape, order):
    class Wrong:
        twist_order, jacobian_frame = order, "space"

        def jacobian(self, screws: np.ndarray, home: np.ndarray, q: np.ndarray) -> np.ndarray:
            return np.zeros(shape)

    case = Case(np.array([*REVOLUTE, *PRISMATIC, *HOME]), ("revolute", "prismatic"))
    assert (
        LAWS["jacobian"].check(Subject(Wrong), case).fault
        == f"shape {shape} where (6, 2) was expected"
    )
