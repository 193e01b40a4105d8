"""Links and joints that a model of MJCF becomes: which links are added, and what is said of equalities."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from poekin.errors import ModelError
from poekin.formats.mjcf import mjcf, mjcf_robot
from poekin.model.tree.link_masses import LinkMass

pytest.importorskip("mujoco", reason="the package mujoco is not installed")

G = '<geom size="0.1"/>'


def read(body, rest=""):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        robot = mjcf.read_text(
            f'<mujoco model="m"><worldbody>{body}</worldbody>{rest}</mujoco>', "m.xml"
        )
    return robot, [str(w.message) for w in caught]


@pytest.mark.parametrize(
    ("joint", "links"),
    [
        ('type="hinge" axis="0 0 1" pos="0 0 3"', ["a"]),
        ('type="hinge" axis="0 1 0" pos="0 0 3"', ["a_after_j", "a"]),
        ('type="hinge" axis="0 0 1" pos="0 2 0"', ["a_after_j", "a"]),
        ('type="slide" axis="0 1 0" pos="0 0 3"', ["a"]),
        ('type="ball" pos="0 0 3"', ["a_after_j", "a"]),
        ('type="ball"', ["a"]),
    ],
)
def test_a_link_is_added_where_a_joint_turns_about_what_is_not_its_bodys_origin(joint, links):
    robot, _ = read(f'<body name="a" pos="1 2 4">{G}<joint name="j" {joint}/></body>')
    assert [link for link in robot.links if link != "world"] == links
    names = ["j", "a_fixed"] if len(links) == 2 else ["j"]
    assert [joint.name for joint in robot.joints] == names
    assert [joint.kind for joint in robot.joints[1:]] == ["fixed"] * (len(names) - 1)


def test_a_site_called_like_a_link_and_sites_without_a_name():
    robot, _ = read(
        f'<body name="a">{G}<joint name="j"/><site name="a"/><site/><site name="tip" pos="1 2 3"/></body>'
    )
    assert list(robot.links)[-2:] == ["a_site", "tip"]
    fixed = {joint.name: joint for joint in robot.joints if joint.kind == "fixed"}
    assert list(fixed) == ["a_site_fixed", "tip_fixed"]
    assert (fixed["tip_fixed"].parent, fixed["tip_fixed"].child) == ("a", "tip")


THREE = "".join(f'<body name="{n}{n}">{G}<joint name="{n}" ref="0"/></body>' for n in "abc")


@pytest.mark.parametrize("place", [2, 3, 4])
def test_each_coefficient_above_the_linear_makes_an_equality_no_mimic(place):
    powers = [0.25, 0.5, 0, 0, 0]
    powers[place] = 7
    text = " ".join(map(str, powers))
    robot, said = read(
        THREE, f'<equality><joint joint1="b" joint2="a" polycoef="{text}"/></equality>'
    )
    assert said == ["m.xml: equalities are left out for joints whose polynomial is not linear: 'b'"]
    assert list(robot.q_names) == ["a", "b", "c"]


def test_a_chain_of_mimics_behind_what_is_held_is_held():
    robot, said = read(
        THREE,
        '<equality><joint joint1="a" polycoef="0.5 0 0 0 0"/>'
        '<joint joint1="b" joint2="a" polycoef="0.25 3 0 0 0"/>'
        '<joint joint1="c" joint2="b" polycoef="0.125 2 0 0 0"/></equality>',
    )
    assert said == []
    assert list(robot.q_names) == []
    found = robot.fk({})
    # a = 0.5, b = 0.25 + 3 a = 1.75, c = 0.125 + 2 b = 3.625, each about z
    for name, angle in [("aa", 0.5), ("bb", 1.75), ("cc", 3.625)]:
        expected = [np.cos(angle), np.sin(angle)]
        np.testing.assert_allclose(found[name][:2, 0], expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize("x", [np.inf, -np.inf, np.nan])
def test_a_coordinate_that_is_not_finite_is_said(x):
    with pytest.raises(ModelError) as said:
        mjcf_robot._moved("revolute", [0.0, 0.0, 1.0], x)
    assert str(said.value) == f"ref and equality: expected a finite coordinate, got {x}"


@pytest.mark.parametrize(
    ("range_", "limited", "effort"),
    [
        ("-3 3", "true", 3),
        ("-3 4", "true", np.inf),
        ("-4 3", "true", np.inf),
        ("-3 3", "false", np.inf),
    ],
)
def test_the_effort_is_a_range_of_force_that_is_the_same_both_ways(range_, limited, effort):
    robot, _ = read(
        f'<body name="a">{G}<joint name="j" damping="0.5" frictionloss="0.25"'
        f' actuatorfrcrange="{range_}" actuatorfrclimited="{limited}"/></body>'
    )
    (joint,) = robot.joints
    assert (joint.damping, joint.friction) == (0.5, 0.25)
    assert joint.effort == effort


@pytest.mark.parametrize(("mass", "known"), [("1e-12", False), ("2e-12", True), ("0.5", True)])
def test_a_mass_is_known_above_what_mujoco_has_to_hold(mass, known):
    inertial = f'<inertial mass="{mass}" pos="1 2 3" diaginertia="1e-9 1e-9 1e-9"/>'
    robot, said = read(f'<body name="a">{inertial}<joint/></body>')
    assert said == []
    assert robot.masses == ((LinkMass("a", float(mass), (1, 2, 3)),) if known else ())


def test_bodies_that_float_freely_are_not_said_to_be_balls():
    robot, said = read(f'<body name="a">{G}<freejoint name="f"/></body>')
    assert said == []
    assert [joint.kind for joint in robot.joints] == ["floating"]


@pytest.mark.parametrize("bound", [0, 2, 3])
def test_a_bound_of_inertias_neither_gives_nor_takes_a_mass(bound):
    inertial = '<inertial mass="5" pos="1 2 3" diaginertia="1 1 1"/>'
    robot, said = read(
        f'<body name="a">{inertial}<joint/></body><body name="b">{G}<joint/></body>',
        f'<compiler boundinertia="{bound}"/>',
    )
    assert said == []
    assert robot.masses == (LinkMass("a", 5.0, (1, 2, 3)),)
