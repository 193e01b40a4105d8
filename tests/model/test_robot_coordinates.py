"""A robot's coordinates, their order, names and limits; and what is refused by name."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

from poekin.errors import InputError, ModelError, PoekinWarning, PoseError, ShapeError, UnknownName
from poekin.model.joint import FREE, Joint, Mimic
from poekin.model.provenance import Source
from poekin.model.robot import Robot


def line(*joints: Joint, **fields) -> Robot:
    return Robot("line", [joints[0].parent, *(j.child for j in joints)], joints, **fields)


def revolute(name: str, parent: str, child: str, **fields) -> Joint:
    return Joint(name, "revolute", parent, child, axis=(0, 0, 1), **fields)


def test_coordinates_come_in_order_of_first_appearance_and_are_named_after_masters():
    robot = line(
        revolute("j1", "a", "b", mimic=Mimic("j3", 2)),
        revolute("j2", "b", "c"),
        revolute("j3", "c", "d"),
    )
    assert robot.q_names == ("j3", "j2")
    forth, back = robot.chain("a", "d"), robot.chain("d", "a")
    assert (forth.joint_names, forth.q_names) == (("j1", "j2", "j3"), ("j3", "j2"))
    assert (back.joint_names, back.q_names) == (("j3", "j2", "j1"), ("j3", "j2"))
    assert forth.coupling.tolist() == [[2, 0], [0, 1], [1, 0]]
    assert robot.chain("a", "b").q_names == ("j3",)  # its master is off the way
    assert robot.chain("a", "b").coupling.tolist() == [[2]]


def test_a_mimic_of_a_mimic_composes_and_a_mimic_of_a_fixed_joint_is_constant():
    robot = line(
        revolute("j1", "a", "b"),
        revolute("j2", "b", "c", mimic=Mimic("j1", 2, 0.5)),
        revolute("j3", "c", "d", mimic=Mimic("j2", -3, 0.25)),
        Joint("stop", "fixed", "d", "e"),
        revolute("j4", "e", "f", mimic=Mimic("stop", 2, 0.125)),
        revolute("j5", "f", "g", mimic=Mimic("j4", 2, 0.125)),
        Joint("still", "fixed", "g", "h", mimic=Mimic("j1")),
    )
    chain = robot.chain()
    assert (robot.dof, chain.q_names) == (1, ("j1",))
    assert chain.coupling.tolist() == [[1], [2], [-6], [0], [0]]
    assert chain.offset.tolist() == [0, 0.5, -1.25, 0.125, 0.375]


def test_limits_are_intersected_over_all_joints_that_follow():
    robot = line(
        revolute("j1", "a", "b", limits=(-1, 1)),
        revolute("j2", "b", "c", limits=(-1, 3), mimic=Mimic("j1", -2, 1)),
        revolute("j3", "c", "d", limits=(-9, -8), mimic=Mimic("j1", 0, -8.5)),
        revolute("j4", "d", "e"),
    )
    assert robot.limits.tolist() == [[-1, 1], [-math.inf, math.inf]]
    tighter = line(robot.joints[0], replace(robot.joints[1], limits=(0, 2)), *robot.joints[2:])
    assert tighter.limits.tolist() == [[-0.5, 0.5], [-math.inf, math.inf]]
    assert tighter.chain().limits.tolist() == tighter.limits.tolist()
    assert tighter.chain("a", "b").limits.tolist() == [[-1, 1]]
    assert tighter.chain("b", "c").limits.tolist() == [[-0.5, 0.5]]
    assert tighter.chain("c", "b").limits.tolist() == [[-0.5, 0.5]]


@pytest.mark.parametrize("limits", [(2, 3), (1, 3)])
def test_where_limits_contradict_each_other_the_masters_stand_with_a_warning(limits):
    joints = (
        revolute("j1", "a", "b", limits=(-1, 1)),
        revolute("j2", "b", "c", limits=limits, mimic=Mimic("j1")),
    )
    with pytest.warns(
        PoekinWarning, match=r"^f\.urdf:7: .*'j1' have no interval in common.*\[-1\.0, 1\.0\]"
    ) as caught:
        robot = line(*joints, source=Source("f.urdf", (), (7, 9)))
    assert caught[0].filename == __file__
    assert robot.limits.tolist() == [[-1, 1]]
    assert robot.chain().limits.tolist() == [[-1, 1]]
    assert pickle.loads(pickle.dumps(robot)) == robot  # and this warns no more


@pytest.mark.parametrize("count, more", [(1, ""), (2, " (nor do those of 1 more coordinates)"),
                                         (3, " (nor do those of 2 more coordinates)")])  # fmt: skip
def test_one_warning_counts_the_coordinates_whose_limits_contradict_each_other(count, more):
    masters = [revolute(f"j{k}", f"l{k}", f"l{k + 1}", limits=(k, k + 1)) for k in range(3)]
    followers = [
        revolute(f"f{k}", f"l{k + 3}", f"l{k + 4}", limits=(-1, -0.5), mimic=Mimic(f"j{2 - k}"))
        for k in range(count)
    ]
    with pytest.warns(PoekinWarning) as caught:
        line(*masters, *followers, source="f.urdf")
    assert [str(warning.message) for warning in caught] == [
        f"f.urdf: the limits of the joints that follow 'j{3 - count}' have no interval in common{more}:"
        f" its own limits {[3.0 - count, 4.0 - count]} stand"
    ]


def test_a_locked_joint_keeps_its_one_value():
    assert line(revolute("j", "a", "b", limits=(0.5, 0.5))).limits.tolist() == [[0.5, 0.5]]


@pytest.mark.parametrize("kind", FREE)
def test_a_chain_that_would_cross_a_free_joint_is_refused_by_name(kind):
    robot = line(
        Joint("base", kind, "world", "body"), revolute("j", "body", "hand"), source="x.urdf"
    )
    with pytest.raises(
        ModelError, match=f"x.urdf: .*'world' to 'hand' crosses the {kind} joint 'base'"
    ):
        robot.chain()
    with pytest.raises(ModelError, match=kind):
        robot.chain("hand", "world")
    assert robot.chain("body", "hand").dof == 1
    assert robot.q_names == ("j",)


def test_a_tip_that_is_taken_for_the_base_is_told():
    robot = line(revolute("a", "base", "arm"), revolute("b", "arm", "tool0"))
    words = r"tip must be given, .*; the base is 'tool0': chain\(tip='tool0'\) ends there"
    with pytest.raises(InputError, match=words):
        robot.chain("tool0")
    fork = Robot("fork", [*robot.links, "lamp"], [*robot.joints, revolute("c", "arm", "lamp")])
    with pytest.raises(InputError, match=words):
        fork.chain("tool0")
    assert robot.chain("arm").tip == "tool0"
    assert robot.chain("tool0", "tool0").dof == 0
    assert Robot("one", ["base"], []).chain("base").dof == 0


def test_unknown_names_are_answered_with_the_closest():
    robot = line(revolute("shoulder", "base_link", "upper_arm"))
    with pytest.raises(UnknownName, match="no tip link 'uper_arm'; did you mean 'upper_arm'"):
        robot.chain(tip="uper_arm")
    with pytest.raises(UnknownName, match=r"no base link 'base'; .*'base_link'"):
        robot.chain("base")
    with pytest.raises(UnknownName, match="no tip link '7'"):
        robot.chain(tip=7)  # pyright: ignore[reportArgumentType]
    with pytest.raises(UnknownName, match="no joint 'sholder'; did you mean 'shoulder'"):
        robot.joint("sholder")
    with pytest.raises(UnknownName, match="'sholder'; did you mean 'shoulder'"):
        robot.fk({"sholder": 0})
    assert robot.joint("shoulder") is robot.joints[0]


def test_wrong_poses_of_free_joints_are_refused():
    robot = line(Joint("base", "floating", "a", "b"), revolute("j", "b", "c"))
    with pytest.raises(UnknownName, match=r"'j', which is no floating or planar joint; .*'base'"):
        robot.fk([0], {"j": np.eye(4)})
    with pytest.raises(ShapeError, match=r"'base'.*\(\.\.\., 4, 4\)"):
        robot.fk([0], {"base": np.eye(3)})
    with pytest.raises(PoseError, match="'base'"):
        robot.fk([0], {"base": 2 * np.eye(4)})
    with pytest.raises(ShapeError, match=r"'line'.* 1 coordinates.*'j'"):
        robot.fk([0, 0])
    with pytest.raises(InputError, match=r"poses must be a dict .* got 5"):
        robot.fk([0], 5)  # pyright: ignore[reportArgumentType]


def test_batches_of_q_and_poses_that_do_not_meet_are_refused():
    robot = line(Joint("base", "floating", "a", "b"), Joint("top", "planar", "b", "c"))
    with pytest.raises(
        ShapeError,
        match=r"'line': the leading axes .* joint 'base' has \(2,\), .* before it \(3,\)",
    ):
        robot.fk(np.empty((3, 0)), {"base": [np.eye(4)] * 2})
    with pytest.raises(ShapeError, match=r"joint 'top' has \(4,\), .* before it \(2,\)"):
        robot.fk([], {"base": [np.eye(4)] * 2, "top": [np.eye(4)] * 4})


def test_a_coupling_too_large_for_memory_is_refused_and_the_links_are_still_there():
    count = 8002
    joints = [
        Joint(f"j{i}", "revolute", f"l{i}", f"l{i + 1}", axis=(0, 0, 1)) for i in range(count)
    ]
    joints[-1] = replace(joints[-1], mimic=Mimic("j0"))
    robot = Robot("long", [f"l{i}" for i in range(count + 1)], joints)
    with pytest.raises(
        InputError, match=r"'long'.* from 'l0' to 'l8002' .* 8002 x 8001 .* at most 64000000"
    ):
        robot.chain()
    assert robot.chain(tip="l100").dof == 100
    assert robot.fk(np.zeros(8001))["l8002"].shape == (4, 4)
