"""URDF out: what the text says, name by name and number by number, and what is refused."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]

from poekin.errors import InputError, PoekinWarning
from poekin.formats import urdf
from poekin.formats.load import load
from poekin.formats.urdf_text import UNLIMITED, to_urdf
from poekin.model.chain import Chain
from poekin.model.joint import Joint, JointKind, Mimic, SafetyController
from poekin.model.robot import Robot
from poekin.testing.oracles.pinocchio_oracle import pinocchio
from tests.formats.test_urdf_text import again, limb

INF = math.inf


def test_the_text_says_what_it_says():
    elbow = Joint(
        "elbow",
        "revolute",
        "upper",
        "fore",
        np.eye(4),
        (0, 0, 1),
        (-1, 0.1 + 0.2),
        Mimic("slide", -0.5, 0.25),
        velocity=2.5,
        friction=0.25,
        safety_controller=SafetyController(40, 100, -0.9, 0.2),
    )
    slide = Joint(
        "slide",
        "prismatic",
        "fore",
        "hand",
        urdf.rpy.pose((0, 0, 1e-17), (0, 0, 1.5)),
        (0, 1, 0),
        (-INF, 1),
    )
    robot = Robot("arm", ["upper", "fore", "hand"], [elbow, slide])
    assert (
        to_urdf(robot, name="two")
        == """<?xml version="1.0"?>
<robot name="two">
  <!-- effort and velocity 0: not known -->
  <link name="upper"/>
  <link name="fore"/>
  <link name="hand"/>
  <joint name="elbow" type="revolute">
    <parent link="upper"/>
    <child link="fore"/>
    <origin xyz="0 0 0" rpy="0 0 0"/>
    <axis xyz="0 0 1"/>
    <limit lower="-1" upper="0.30000000000000004" effort="0" velocity="2.5"/>
    <dynamics damping="0" friction="0.25"/>
    <safety_controller k_velocity="40" k_position="100" soft_lower_limit="-0.9" soft_upper_limit="0.2"/>
    <mimic joint="slide" multiplier="-0.5" offset="0.25"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="fore"/>
    <child link="hand"/>
    <origin xyz="0 0 1e-17" rpy="0 0 1.5"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1e+16" upper="1" effort="0" velocity="0"/>
  </joint>
</robot>
"""
    )


def test_equal_models_have_equal_texts():
    chain = limb()
    assert to_urdf(chain) == to_urdf(pickle.loads(pickle.dumps(chain)))
    assert to_urdf(load("panda")) == to_urdf(again(load("panda")))


def test_a_robot_read_from_a_file_does_not_say_where(tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(to_urdf(slider(0, 1), name=""), encoding="utf-8")
    assert str(tmp_path) not in to_urdf(urdf.read(path))
    assert '<robot name="arm">' in to_urdf(urdf.read(path))


def slider(lower: float = -INF, upper: float = INF, kind: JointKind = "prismatic") -> Robot:
    return Robot("r", ["a", "b"], [Joint("j", kind, "a", "b", limits=(lower, upper))])


@pytest.mark.parametrize("limits", [(-INF, INF), (-INF, 2.0), (0.1, INF)])
@pytest.mark.parametrize("kind", ["prismatic", "revolute"])
def test_a_bound_that_is_not_there_comes_back_as_none_and_is_huge_to_others(limits, kind):
    text = to_urdf(slider(limits[0], limits[1], kind))
    if kind == "revolute" and limits == (-INF, INF):
        assert 'type="continuous"' in text
        back = urdf.read_text(text)
    else:
        with pytest.warns(PoekinWarning, match="taken as unlimited: 'j'"):
            back = urdf.read_text(text)
        model = pinocchio().buildModelFromXML(text)
        wanted = np.clip(limits, -UNLIMITED, UNLIMITED)
        assert [model.lowerPositionLimit[0], model.upperPositionLimit[0]] == wanted.tolist()
    assert back.limits.tolist() == [list(limits)]


REFUSED = {
    "helical": (
        Chain.from_space([[0, 0, 1, 0, 0, 0.1]], np.eye(4), joint_names=["nut"]),
        "helical joints.*'nut'",
    ),
    "a helical joint of a robot": (
        Robot("r", ["a", "b"], [Joint("nut", "helical", "a", "b", pitch=0.1)]),
        "helical joints.*'nut'",
    ),
    "a link that XML cannot hold": (
        Robot("r", ["a\0"], []),
        r"link 'a\\x00': XML cannot hold the character U\+0000 of its name$",
    ),
    "a robot that XML cannot hold": (Robot("r\ufffe", ["a"], []), r"robot 'r\\ufffe': .*U\+FFFE"),
    "a joint that XML cannot hold": (
        Robot("r", ["a", "b"], [Joint("\ud800", "fixed", "a", "b")]),
        r"joint '\\ud800': .*U\+D800",
    ),
    "something else": ("panda", "expected a Robot or a Chain, got str"),
}


@pytest.mark.parametrize(("model", "message"), REFUSED.values(), ids=REFUSED)
def test_what_urdf_cannot_say_is_refused_by_name(model, message):
    with pytest.raises(InputError, match=message):
        to_urdf(model)


def test_a_name_that_is_none_is_refused():
    with pytest.raises(InputError, match=r"^name: expected the robot's name, a str, got 3$"):
        to_urdf(limb(), name=3)  # pyright: ignore[reportArgumentType]


def test_a_helical_joint_without_pitch_is_a_revolute_one():
    robot = Robot("r", ["a", "b"], [Joint("nut", "helical", "a", "b", limits=(-1, 1))])
    assert urdf.read_text(to_urdf(robot)).joints[0] == replace(robot.joints[0], kind="revolute")


def holds(name: str) -> bool:
    """Whether XML can hold a name, as lxml sees it."""
    try:
        etree.Element("a").set("b", name)
    except (ValueError, UnicodeEncodeError):
        return False
    return True


names = st.text(st.characters(), min_size=1, max_size=8)
nasty = st.sampled_from(
    [
        ' a"',
        "<b>&amp;",
        "]]>",
        "-->",
        "\n\t\r",
        "&#10;",
        "'",
        "\u202e\x9b2J",
        "\x7f",
        "\u2028",
        "ü𝄞",
    ]
)


@given(st.lists(st.one_of(names, nasty), min_size=4, max_size=4, unique=True))
def test_names_survive_exactly_or_are_refused(four):
    robot_name, a, b, joint = four
    robot = Robot(robot_name, [a, b], [Joint(joint, "continuous", a, b)])
    if not all(map(holds, four)):
        with pytest.raises(InputError, match=r"XML cannot hold the character U\+"):
            to_urdf(robot)
        return
    text = to_urdf(robot)
    assert urdf.read_text(text) == robot
    assert all(c.isprintable() or c == "\n" for c in text)


@pytest.mark.parametrize(
    "name", [' a"', "<b>&amp;", "]]>", "-->", "a\n\t\rb", "&#10;", "'", "\u202ex\x9b2J", "ü𝄞"]
)
def test_pinocchio_reads_the_same_names(name):
    robot = Robot(name, ["a", name], [Joint(name, "continuous", "a", name)])
    model = pinocchio().buildModelFromXML(to_urdf(robot))
    assert model.name == name
    assert list(model.names)[1:] == [name]
    assert model.frames[model.nframes - 1].name == name
