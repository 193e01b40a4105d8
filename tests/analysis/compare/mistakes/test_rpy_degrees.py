"""Degrees that stand in a URDF's rpy are recognised in the angles of neighbouring axes."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from benchmarks.planted_changes import arm, planted, random_arm
from poekin.analysis.compare.compare import compare
from poekin.analysis.compare.mistakes.rpy_degrees import in_degrees

JOINT = """<joint name="j{k}" type="revolute"><parent link="l{k}"/><child link="l{n}"/>
<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>"""


def urdf(turns, xyz=("0 0 0.3", "0.1 0 0.2", "0 0.3 0", "0.2 0.1 0", "0 0.1 0.1")):
    """A URDF of joints about z, turned by these (degrees about x)."""
    rows = [
        JOINT.format(k=k, n=k + 1, xyz=place, rpy=f"{turn:.9g} 0 0")
        for k, (turn, place) in enumerate(zip(turns, xyz, strict=True))
    ]
    links = "".join(f'<link name="l{k}"/>' for k in range(len(turns) + 1))
    return f'<robot name="r">{links}{"".join(rows)}</robot>'


def chain(tmp_path, turns):
    path = tmp_path / "arm.urdf"
    path.write_text(urdf(turns), encoding="utf-8")
    return pk.load(str(path)).chain()


@pytest.mark.filterwarnings("ignore:.*rpy is more than a turn")
@pytest.mark.parametrize(
    "degrees, rounded",
    [((0, 90, -90, 90, 0), 1e-4), ((0, 45, 0, -30, 180), 1e-4), ((0, 0, 180, 90, 90), 1e-12)],
)
def test_a_file_with_degrees_in_rpy_is_named_either_way_round(tmp_path, degrees, rounded):
    turns = np.round(np.radians(degrees) / rounded) * rounded
    right = chain(tmp_path, turns)
    wrong = chain(tmp_path, degrees)
    for pair, model in (((right, wrong), "b"), ((wrong, right), "a")):
        result = compare(*pair, samples=5)
        assert (result.outcome, result.mistake) == ("differ", "degrees")
        assert result.findings[0].startswith(f"links of model {model} turn by as many radians")


@pytest.mark.filterwarnings("ignore:.*rpy is more than a turn")
@pytest.mark.parametrize("degrees", [30, 60, 100, 120, 135, 150, 170, -50, -130])
def test_one_angle_that_differs_says_it_alone_be_it_sharp_or_blunt(tmp_path, degrees):
    right = chain(tmp_path, (0, np.radians(degrees), 0, 0, 0))
    wrong = chain(tmp_path, (0, degrees, 0, 0, 0))
    assert (in_degrees(right, wrong), in_degrees(wrong, right)) == ("b", "a")


def test_a_slide_is_turned_by_degrees_in_rpy_as_any_other_joint():
    def turned(angle):
        rows = [
            pk.screw.revolute([0, 0, 1], [0, 0, 0]),
            pk.screw.prismatic([0, np.sin(angle), np.cos(angle)]),
            pk.screw.revolute([1, 0, 0], [0.3, 0, 0]),
        ]
        return pk.Chain.from_space(rows, np.eye(4))

    right, wrong = turned(np.radians(30.0)), turned(30.0)
    assert (in_degrees(right, wrong), in_degrees(wrong, right)) == ("b", "a")


@pytest.mark.parametrize("name", ["panda", "ur5e", "random 6a"])
@pytest.mark.parametrize("change", ["tilt", "shift", "zero"])
def test_what_differs_otherwise_is_not_called_so(name, change):
    one = arm(name)
    other = planted(one, change, 2, np.random.default_rng(0))
    assert in_degrees(one, other) == ""
    assert compare(one, other, samples=1).mistake == ""
    assert in_degrees(one, random_arm(3, ("revolute",) * one.dof)) == ""


@pytest.mark.filterwarnings("ignore:.*rpy is more than a turn")
def test_one_angle_of_many_that_fits_by_chance_says_nothing(tmp_path):
    right = chain(tmp_path, np.radians([0, 90, -90, 90, 0]))
    some = chain(tmp_path, [0, 90, *np.radians([-80, 60, 20])])
    assert in_degrees(right, some) == ""
    assert re.match("[ab]", in_degrees(right, chain(tmp_path, [0, 90, -90, 1, 0])))


@pytest.mark.parametrize("turns", [(90,), (-90,), (45, 180), (135, -90), (-45, -180), (-135, 45)])
def test_degrees_about_a_joint_s_own_axis_are_named_by_the_zeros_that_they_make(turns):
    one = arm("ur5e")
    q = np.zeros(6)
    q[2 : 2 + len(turns)] = (180 / np.pi - 1) * np.radians(turns)
    result = compare(one, one.rezeroed(q).replace(limits=one.limits), samples=5)
    assert (result.mistake, result.outcome) == ("degrees", "conventions")
    assert result.findings[0].startswith("zeros differ as if one model had degrees for radians")
    assert all(joint.zero_differs for joint in result.differing)


def test_a_slide_that_begins_elsewhere_has_no_degrees():
    one = pk.load("stanford").chain()
    q = np.where([kind == "prismatic" for kind in one.kinds], (180 / np.pi - 1) * np.pi / 2, 0.0)
    assert q.any()
    result = compare(one, one.rezeroed(q).replace(limits=one.limits), samples=1)
    assert [joint.zero_differs for joint in result.joints] == (q != 0).tolist()
    assert result.mistake == ""


@pytest.mark.parametrize("degrees", [(5,), (90,), (180,), (26.7,), (26.62, 5)])
def test_other_zeros_are_no_degrees(degrees):
    one = arm("ur5e")
    q = np.zeros(6)
    q[2 : 2 + len(degrees)] = np.radians(degrees)
    assert compare(one, one.rezeroed(q), samples=5).mistake == ""
