"""Words of the structure of an arm's inverse kinematics."""

from __future__ import annotations

import json

import pytest

from poekin.solve.ik_structure.result import (
    Assumption,
    IKStructure,
    LockedStructure,
    axes_of,
    mm,
)


@pytest.mark.parametrize(
    ("joints", "words"),
    [((4,), "axis 4"), ((1, 2), "axes 1 and 2"), ((2, 3, 4), "axes 2, 3 and 4")],
)
def test_axes_are_numbered_in_words(joints, words):
    assert axes_of(joints) == words


def test_an_assumption_says_its_size_in_mm_or_degrees():
    meet = Assumption((4, 5, 6), "meet in a point", 0.0, 1.25e-3)
    assert str(meet) == "axes 4, 5 and 6 meet in a point within 1.25 mm"
    assert mm(0.0999) == "99.9 mm"
    parallel = Assumption((2, 3, 4), "are parallel", 0.01, 0.0)
    assert str(parallel) == "axes 2, 3 and 4 are parallel within 0.573°"


def test_a_reversed_arm_with_sliding_joints_says_so_a_line_each():
    found = IKStructure(
        "two axes intersect",
        "search",
        (1, 2),
        reversed=True,
        prismatic=("rail", "lift"),
        hint="closed form if axes 1, 2 and 3 met: they miss by 12 mm",
    )
    assert str(found).split("\n") == [
        "two axes intersect: axes 1 and 2, solved reversed (from the tip to the base)",
        "search from random starts",
        "prismatic: 'rail', 'lift'",
        "closed form if axes 1, 2 and 3 met: they miss by 12 mm",
    ]


def test_a_locked_joint_whose_axes_nearly_fit_is_called_so():
    one = LockedStructure("joint7", "spherical shoulder", (1, 2, 3), True, False, "")
    assert str(one) == (
        "'joint7' locked: spherical shoulder (axes 1, 2 and 3), solved reversed, nearly"
    )
    none = LockedStructure("joint1", "general", (), False, True, "")
    assert str(none) == "'joint1' locked: general"


def test_what_an_arm_of_fewer_joints_is_solved_as_is_said():
    found = IKStructure("spherical wrist", "closed form", (2, 3, 4), fictitious=2)
    assert str(found).split("\n") == [
        "spherical wrist: axes 2, 3 and 4",
        "closed form",
        "overdetermined: solved as an arm of six joints, 2 of them fictitious and held at zero",
    ]


def test_of_an_arm_without_relations_nothing_else_is_said():
    assert IKStructure("general").to_dict() == {
        "kind": "general",
        "method": "search",
        "joints": [],
        "reversed": False,
        "exact": True,
        "first_joints": "",
        "prismatic": [],
        "fictitious": 0,
        "assumptions": [],
        "position_bound": 0.0,
        "rotation_bound": 0.0,
        "locked": [],
        "hint": "",
    }


def test_json_is_the_dict():
    found = IKStructure("general")
    assert found.to_json() == json.dumps(found.to_dict(), indent=2)
