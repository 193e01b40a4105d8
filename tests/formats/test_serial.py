"""A chain as a robot of one branch: which joint is a coordinate's master, and what the links are
called.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from poekin.errors import InputError, PoekinWarning
from poekin.formats import urdf
from poekin.formats.load import load
from poekin.formats.serial import serial_robot
from poekin.formats.urdf_text import to_urdf
from poekin.model.chain import Chain
from tests.formats.test_urdf_text import again


def test_a_follower_does_not_narrow_the_limits_of_its_master():
    for ratio, shift in np.random.default_rng(0).uniform(-3, 3, (50, 2)):
        A = [[0, 0, 1, 0, 0, 0], [0, 0, 1, 0, 0, 0]]
        limits = [[-0.1, 0.7]]
        chain = Chain.from_space(
            A, np.eye(4), coupling=[[1], [ratio]], offset=[0, shift], q_names=["q"], limits=limits
        )
        assert again(chain).limits.tolist() == limits
        low, high = again(chain).joint("joint2").limits
        assert np.allclose(
            sorted([ratio * -0.1 + shift, ratio * 0.7 + shift]), [low, high], rtol=0, atol=1e-14
        )


def test_the_velocity_limits_of_a_chain_come_back_to_the_last_digit():
    for ratio, first in np.random.default_rng(0).uniform(-3, 3, (50, 2)):
        A = [[0, 0, 1, 0, 0, 0], [0, 0, 1, 0, 0, 0]]
        for master in (1.0, -1.0, first):
            chain = Chain.from_space(
                A, np.eye(4), coupling=[[master], [ratio]], q_names=["q"], velocity_limits=[0.7]
            )
            back = again(chain).chain()
            # x = q (±1), else the robot's coordinate is a joint's own value
            assert back.velocity_limits == pytest.approx([0.7 * abs(master)], rel=1e-15, abs=0)
            if abs(master) == 1:
                assert back.velocity_limits.tolist() == [0.7]
            slow = again(chain).joint("joint2").velocity
            assert slow == pytest.approx(0.7 * abs(ratio), rel=1e-15)


def test_what_is_not_known_of_a_chain_stays_unknown():
    robot = serial_robot(two([[1], [2]], q_names=["q"]))
    assert [joint.velocity for joint in robot.joints] == [math.inf] * 3


@pytest.mark.parametrize("start", [0.0, 0.3])
def test_masses_of_a_chain_are_those_of_the_links_that_its_joints_move(start):
    rows = np.array([[2.0, 0.1, 0.2, 0.3], [0.0, 0, 0, 0], [5.0, -0.4, 0.5, 0.6]])
    turned = np.array([[1.0, 0, 0], [0, 0.6, 0.8], [0, 0, 1.0]])
    screws = np.hstack([turned, np.cross([0.3, 0.1, 0.2], turned)])
    chain = Chain.from_space(screws, np.eye(4), masses=rows, offset=[0, start, 0])
    robot = serial_robot(chain)
    assert [own.link for own in robot.masses] == ["joint1_link", "joint3_link"]
    np.testing.assert_allclose(again_masses(robot, [0, start, 0]), rows, rtol=0, atol=1e-15)
    heavy = chain.replace(masses=rows * [1e4, 1, 1, 1])
    assert serial_robot(heavy).masses == ()


def again_masses(robot, x):
    """Masses of a robot's joints where its joints are at -x: their own values are 0."""
    T = robot.fk(-np.asarray(x))
    rows = np.zeros((3, 4))
    for own in robot.masses:
        place = T[own.link] @ [*own.centre, 1.0]
        rows[int(own.link[5]) - 1] = [own.mass, *place[:3]]
    return rows


def two(coupling, offset=(0, 0), kinds=("turn", "turn"), **options) -> Chain:
    A = [[0, 0, 1, 0, 0, 0] if kind == "turn" else [0, 0, 0, 1, 0, 0] for kind in kinds]
    return Chain.from_space(
        A, np.eye(4), coupling=coupling, offset=offset, joint_names=["a", "b"], **options
    )


@pytest.mark.parametrize(
    ("chain", "masters"),
    [
        (two([[2], [1]], q_names=["q"]), ["b"]),
        (two([[1], [1]], [0.5, 0], q_names=["q"]), ["b"]),
        (two([[1], [-1]], [0.5, 0], q_names=["q"]), ["a"]),
        (two([[2], [-1]], [0, 0.5], q_names=["q"]), ["b"]),
    ],
)
def test_a_coordinate_is_named_after_the_joint_that_is_nearest_to_it(chain, masters):
    robot = urdf.read_text(to_urdf(chain))
    assert list(robot.q_names) == masters
    assert np.abs(robot.chain().fk([0.3]) - chain.fk([0.3])).max() <= 1e-15


@pytest.mark.parametrize(
    ("chain", "message"),
    [
        (two([[2], [3]], [0.5, 0], q_names=["q"]), "in the place of 'q' is 'a' = 2.0 'q' \\+ 0.5"),
        (two([[1, 0], [0, 0]], q_names=["a", "idle"]), "'idle' is left out, no joint follows it"),
        (two([[0, 1], [1, 0]], q_names=["b", "a"]), "the order is 'a', 'b'"),
    ],
)
def test_coordinates_that_are_not_the_same_any_more_are_told(chain, message):
    with pytest.warns(
        PoekinWarning, match=f"from 'base' to 'tool' has other coordinates as a robot: {message}"
    ):
        to_urdf(chain)


def test_a_joint_that_follows_nothing_stands_where_it_stood():
    robot = urdf.read_text(to_urdf(two([[1], [0]], [0, 0.5], q_names=["a"])))
    assert (robot.joint("b").kind, robot.q_names) == ("fixed", ("a",))
    assert abs(robot.chain().fk([0.0])[1, 0] - math.sin(0.5)) <= 1e-16


def test_links_are_called_after_their_joints_and_differ_from_base_and_tip():
    A = [[0, 0, 1, 0, 0, 0]] * 2
    robot = serial_robot(
        Chain.from_space(A, np.eye(4), joint_names=["a", "t_joint"], base="a_link", tip="t")
    )
    assert robot.links == ("a_link", "a_link_", "t_joint_link", "t")
    assert [joint.name for joint in robot.joints] == ["a", "t_joint", "t_joint_"]
    assert robot.name == "a_link_to_t"


def test_a_chain_from_a_link_to_itself_is_one_link():
    assert again(load("panda").chain("panda_hand", "panda_hand")).links == ("panda_hand",)


def test_a_joint_that_follows_several_coordinates_is_refused_by_name():
    for coupling, joint in (([[1, 0.5], [0, 1]], "a"), ([[1, 0], [2, 1]], "b")):
        with pytest.raises(
            InputError, match=f"^joint '{joint}' follows several coordinates, 'p', 'q': a robot's "
        ):
            to_urdf(two(coupling, q_names=["p", "q"]))


def test_a_helical_joint_keeps_the_sign_of_its_pitch():
    A = [[0, 0, 1, 0, 0, -0.3], [0, 1, 0, 0, 0.2, 0]]
    chain = Chain.from_space(A, np.eye(4), coupling=[[1], [-2]], offset=[0.1, 0.4], q_names=["q"])
    robot = serial_robot(chain)
    assert [joint.pitch for joint in robot.joints] == [-0.3, 0.2, 0.0]
    assert np.abs(robot.chain().fk([0.7]) - chain.fk([0.7])).max() <= 1e-15


def test_a_chain_whose_base_and_tip_are_one_name_for_two_frames_is_refused():
    with pytest.raises(InputError) as caught:
        serial_robot(Chain.from_space(np.zeros((0, 6)), np.diag([1, -1, -1, 1]), base="x", tip="x"))
    assert str(caught.value) == (
        "the chain's base and tip are both called 'x', and two links cannot be: give one another"
        ' name, as in chain.retooled(np.eye(4), tip="tool")'
    )


def test_what_is_no_chain_is_refused():
    with pytest.raises(InputError, match=r"^chain: expected a Chain, as .* makes it, got Robot"):
        serial_robot(load("panda"))  # pyright: ignore[reportArgumentType]
