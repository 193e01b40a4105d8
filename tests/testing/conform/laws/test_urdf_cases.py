"""Cases of URDFs: what each law draws, what it may shrink to, and what it is about."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from poekin.testing.conform import Subject
from poekin.testing.conform.laws import small_urdf, urdf_cases
from poekin.testing.conform.laws.law import SLACK, Case, drawable, typed, unit
from poekin.testing.conform.laws.small_urdf import UrdfJoint, UrdfLayout, chain
from poekin.testing.conform.laws.urdf_cases import URDF_LAWS
from tests.testing.drawing import drawn

LAWS = {law.name: law for law in URDF_LAWS}
SUBJECT = Subject(Poekin)
ROW = [0, 0, 1.0, 0.5, -1.0, 0.25, 0.1, -0.2, 0.3, 0, 0, 0.7]


def case(layout: UrdfLayout, *rows: list[float]) -> Case:
    return Case(np.concatenate([np.array(row, dtype=float) for row in rows]), layout)


def one(kind: str = "revolute", axis: bool = True, **places: float) -> Case:
    row = list(ROW)
    for name, value in places.items():
        row[int(name[1:])] = value
    return case(chain((UrdfJoint(kind, "j0", axis),)), row)


def found(name: str, count: int = 40) -> list[Case]:
    return drawn(LAWS[name].cases(SUBJECT), count)


def rows(cases: list[Case]) -> np.ndarray:
    return np.concatenate([small_urdf.rows_of(case) for case in cases])


@pytest.mark.parametrize("name", LAWS)
def test_what_a_law_draws_is_allowed_and_about_it_now_and_then(name):
    cases = found(name, 15)
    assert all(LAWS[name].allowed(case) for case in cases)
    assert any(LAWS[name].about(case) for case in cases)


def test_numbers_are_drawn_with_all_their_kinds():
    cases = found("urdf", 100)
    every = rows(cases)
    kinds = [joint.kind for case in cases for joint in case.layout.joints]
    assert set(kinds) == {"revolute", "prismatic", "fixed"}
    assert {len(small_urdf.rows_of(case)) for case in cases} == {1, 2, 3}
    assert all(case.layout.joints[0].kind != "fixed" for case in cases)
    assert {tuple(axis) for axis in every[:, :3]} == {tuple(axis) for axis in urdf_cases.FRAME_AXES}
    assert {0.0, math.pi / 2, -math.pi / 2, math.pi} <= set(every[:, 6:9].ravel())
    assert {-1.0, 0.0, 1.0} <= set(np.sign(every[:, 11]))
    assert {-1.0, 1.0} <= set(
        np.sign(np.setdiff1d(every[:, 6:9], [math.pi / 2, -math.pi / 2, math.pi, 0]))
    )
    lengths = np.linalg.norm(every[:, 3:6], axis=1)
    assert 1 < lengths.max() <= 3 * (1 + SLACK)
    assert not every[:, 9:11].any()


def test_a_follower_has_a_multiplier_and_an_offset_and_its_master_a_value():
    for name in ("urdf mimic", "urdf mimic across", "robot mimic"):
        cases = found(name, 100)
        pairs = [
            (joint, row)
            for case in cases
            for joint, row in zip(case.layout.joints, small_urdf.rows_of(case), strict=True)
        ]
        following = np.array([row for joint, row in pairs if joint.follows >= 0])
        others = np.array([row for joint, row in pairs if joint.follows < 0])
        assert len(following) == len(cases)
        assert set(following[:, 9]) == {0.0, -2.0, -0.5, 1.0}
        assert set(following[:, 10]) == {0.0, 0.25, -1.0}
        assert not following[:, 11].any()
        assert not others[:, 9:11].any()
        assert others[:, 11].any()
    layouts = [case.layout for case in found("urdf mimic", 40)]
    assert {layout.joints[0].follows for layout in layouts} == {-1, 1}
    assert {layout.joints[1].follows for layout in layouts} == {-1, 0}


def test_trees_branch_in_many_ways_and_files_have_any_order():
    layouts = [case.layout for case in found("robot", 100)]
    assert {len(layout.joints) for layout in layouts} == {3, 4}
    for layout in layouts:
        last = len(layout.joints) - 1
        assert layout.after[0] == -1
        assert all(-1 <= after < k for k, after in enumerate(layout.after))
        assert layout.after[last] <= last - 2
        assert sorted(layout.order) == list(range(last + 1))
    assert len({layout.after for layout in layouts}) > 8
    assert len({layout.order for layout in layouts}) > 8
    followers = [case.layout.joints for case in found("robot mimic", 60)]
    assert all(joints[-1].follows == len(joints) - 2 for joints in followers)
    assert all(joints[-1].kind == joints[-2].kind for joints in followers)
    assert all(joint.kind != "fixed" for joints in followers for joint in joints)


def test_orders_have_a_branch_or_none():
    layouts = [case.layout for case in found("urdf order", 100)]
    assert {layout.after for layout in layouts} == {
        (-1, 0), (-1, 0, 1), (-1, 0, 1, 2), (-1, -1, 1), (-1, -1, 1, 2)
    }  # fmt: skip
    assert {layout.joints[0].name for layout in layouts} == {"j0", "j1", "j2", "side"}


ALLOWED = {
    "as it is": ("urdf", {}, True),
    "a turn of 1e-10": ("urdf", {"_6": 1e-10}, False),
    "a pitch of more than π": ("urdf", {"_7": 3.2}, False),
    "a yaw of more than π": ("urdf", {"_8": -3.2}, False),
    "no turn": ("urdf", {"_6": 0.0, "_7": 0.0, "_8": 0.0}, True),
    "an origin of more than 3 m": ("urdf", {"_3": 3.0}, False),
    "an origin of less than 1 mm": ("urdf", {"_3": 1e-4, "_4": 0.0, "_5": 0.0}, False),
    "q of more than π": ("urdf", {"_11": 3.2}, False),
    "q of 1e-10": ("urdf", {"_11": 1e-10}, False),
    "q of more than π, continuous": ("urdf continuous", {"_11": -9.9}, True),
    "q of more than 10": ("urdf continuous", {"_11": 10.1}, False),
    "an oblique axis": ("urdf", {"_0": 0.6, "_2": 0.8}, False),
    "an oblique axis of an oblique law": ("urdf oblique axis", {"_0": 0.6, "_2": 0.8}, True),
    "a long axis": ("urdf", {"_2": 2.0}, False),
    "a long axis of an oblique law": ("urdf oblique axis", {"_2": 2.0}, False),
    "a long axis of a long law": ("urdf long axis", {"_2": 900.0}, True),
    "a longer axis of a long law": ("urdf long axis", {"_2": 1100.0}, False),
    "an axis of 999.5": ("urdf long axis", {"_2": 999.5}, True),
    "an axis of 1000.5": ("urdf long axis", {"_2": 1000.5}, False),
    "an axis of 2e-3": ("urdf long axis", {"_2": -2e-3}, True),
    "an axis of 5e-4": ("urdf long axis", {"_2": 5e-4}, False),
    "an oblique axis of a long law": ("urdf long axis", {"_0": 1.0}, False),
}


@pytest.mark.parametrize("what", ALLOWED)
def test_what_may_be_drawn_is_allowed(what):
    name, places, allowed = ALLOWED[what]
    assert LAWS[name].allowed(one(**places)) is allowed


def test_a_law_is_about_what_it_is_called_after():
    straight = one()
    twins = (UrdfJoint("revolute", "j0"), UrdfJoint("revolute", "j1"))
    follower = case(chain((twins[0], twins[1]._replace(follows=0))), ROW, ROW)
    branch = case(
        UrdfLayout((*twins, UrdfJoint("revolute", "j2", follows=1)), (0, 1, 2), (-1, 0, 0)),
        ROW,
        ROW,
        ROW,
    )
    about = {
        "urdf": [straight],
        "urdf oblique axis": [one(_0=0.6, _2=0.8)],
        "urdf long axis": [one(_2=1 + 2e-9), one(_2=0.5)],
        "urdf missing axis": [one(axis=False)],
        "urdf continuous": [one(_11=3.2), one(_11=-3.2)],
        "urdf mimic": [follower],
        "urdf mimic across": [branch],
        "urdf order": [
            case(chain(twins, (1, 0)), ROW, ROW),
            case(chain(twins[::-1]), ROW, ROW),
            case(UrdfLayout(twins, (0, 1), (-1, -1)), ROW, ROW),
        ],
        "robot": [branch],
        "robot mimic": [follower],
    }  # fmt: skip
    for name, cases in about.items():
        assert all(LAWS[name].about(case) for case in cases), name
        assert name in ("urdf",) or not LAWS[name].about(straight), name
    assert not LAWS["urdf oblique axis"].about(one("fixed", _0=0.6, _2=0.8))
    assert not LAWS["urdf long axis"].about(one("fixed", _2=0.5))
    assert not LAWS["urdf continuous"].about(one(_11=3.1))
    assert not LAWS["urdf mimic across"].about(follower)
    assert not LAWS["urdf order"].about(case(chain(twins), ROW, ROW))


def test_axes_of_any_length_are_vectors_and_others_directions():
    twins = case(chain((UrdfJoint("revolute", "j0"), UrdfJoint("revolute", "j1"))), ROW, ROW)
    for name, law in LAWS.items():
        long = name == "urdf long axis"
        assert list(law.directions(twins)) == ([] if long else [0, 12]), name
        assert sorted(law.triples(twins)) == ([0, 3, 6, 12, 15, 18] if long else [3, 6, 15, 18]), (
            name
        )


def test_a_law_of_jacobians_asks_for_a_frame():
    class Plain:
        def read_urdf(self, text: str, base: str, tip: str) -> None: ...

    subject = Subject(Plain)
    assert [name for name, law in LAWS.items() if not law.applies(subject)] == ["urdf jacobian"]
    assert all(law.applies(SUBJECT) for law in URDF_LAWS)


def test_magnitudes_may_be_beyond_what_is_drawn_by_rounding_only():
    assert drawable(0.0, (1.0, 2.0))
    for x, allowed in (
        (1.0, True),
        (1 - 9e-10, True),
        (1 - 2e-9, False),
        (2 + 1.9e-9, True),
        (2 + 3e-9, False),
    ):
        assert drawable(x, (1.0, 2.0)) == drawable(-x, (1.0, 2.0)) == allowed
    for length, is_unit in (
        (1.0, True),
        (1 + 9e-10, True),
        (1 - 9e-10, True),
        (1 + 2e-9, False),
        (1 - 2e-9, False),
    ):
        assert unit(np.array([0.6, 0, 0.8]) * length) == is_unit


def test_numbers_are_typed_short_and_as_floats():
    assert typed([0, 0]) == "[0.0, 0.0]"
    assert typed([-0.0, 0.5, 0]) == "[0, 0.5, 0]"
    assert typed([1e20, 0]) == "[1e+20, 0]"
    assert typed([[1e-5, 0], [0, 2]]) == "[[1e-05, 0], [0, 2.0]]"
    assert typed(0.0) == "0.0"


def test_a_long_axis_has_any_length_but_none():
    lengths = np.linalg.norm(rows(found("urdf long axis", 150))[:, :3], axis=1)
    assert (lengths.min() > 0) & (lengths == 2.0).any()
    assert lengths.max() > 100
    assert lengths.min() < 0.01
