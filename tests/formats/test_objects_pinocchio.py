"""Pinocchio's Model as a Robot: every frame where Pinocchio has it, and the links and joints of the
URDF behind it.
"""

from __future__ import annotations

import math
import operator
import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import ModelError, PoekinWarning, PoseError
from poekin.formats import urdf
from poekin.formats.erd import example_robots
from poekin.formats.objects import from_object
from poekin.model.joint import MOVING
from poekin.testing.strategies import group_strategies
from tests.groups.test_objects import library
from tests.versions import needs

POSES = group_strategies.poses(lengths=(1e-3, 2.0))
HALF = [0.6, 0.8, 0.0]
# Two products of up to 40 poses in another order, each rounding by u of the distance from the root.
ROUNDING = 1e-14


def pinocchio():
    needs("pin", "3")
    return library("pinocchio")


def configuration(model, robot, x) -> np.ndarray:
    """Pinocchio's own q for values of the robot's coordinates: a continuous joint has its cosine
    and its sine.
    """
    q, values = pinocchio().neutral(model), iter(x)
    for joint in list(model.joints)[1:]:
        if joint.shortname() in ("JointModelFreeFlyer", "JointModelPlanar"):
            continue
        if "RUB" in joint.shortname() or "Unbounded" in joint.shortname():
            angle = next(values)
            q[joint.idx_q : joint.idx_q + 2] = math.cos(angle), math.sin(angle)
        else:
            q[joint.idx_q : joint.idx_q + joint.nq] = [next(values) for _ in range(joint.nq)]
    assert next(values, None) is None, "every coordinate has its place in q"
    return q


def error(model, robot, x, poses=None) -> float:
    """The largest entry by which a frame of the model is not where the robot has its link."""
    pin = pinocchio()
    data, q = model.createData(), configuration(model, robot, x)
    for name, T in (poses or {}).items():
        joint = model.joints[model.getJointId(name)]
        q[joint.idx_q : joint.idx_q + joint.nq] = pin.SE3ToXYZQUAT(pin.SE3(T))
    pin.framesForwardKinematics(model, data, q)
    found = robot.fk(x, poses)
    # Of several joints in series, j_1, j_2, ..., the last one's child is the link of the frame j.
    children = {joint.name.rpartition("_")[0]: joint.child for joint in robot.joints}
    children |= {joint.name: joint.child for joint in robot.joints}
    worst = 0.0
    for i, frame in enumerate(model.frames):
        if i == 0:
            link = robot.root
        elif frame.type in (pin.FrameType.JOINT, pin.FrameType.FIXED_JOINT):
            link = children[frame.name]
        else:
            link = frame.name
        worst = max(worst, float(np.abs(found[link] - data.oMf[i].homogeneous).max()))
    return worst


# Python cannot make a joint of this type but by a URDF.
UNBOUNDED = """<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous">
<parent link="a"/><child link="b"/><axis xyz="0.6 0.8 0"/></joint></robot>"""


def makers() -> dict[str, Any]:
    pin = pinocchio()
    composite = pin.JointModelComposite(
        pin.JointModelRZ(), pin.SE3(pk.se3.exp([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]))
    )
    composite.addJoint(pin.JointModelPY(), pin.SE3(pk.se3.exp([-0.3, 0.2, 0.1, 0.6, 0.5, 0.4])))
    composite.addJoint(
        pin.JointModelUniversal(np.array([1.0, 0, 0]), np.array([0, 1.0, 0])),
        pin.SE3(pk.se3.exp([0.5, -0.1, 0.2, 0.3, -0.6, 0.1])),
    )
    axis = np.array(HALF)
    return {
        **{
            name: getattr(pin, f"JointModel{name}")()
            for name in ("RX", "RY", "RZ", "PX", "PY", "PZ")
        },
        **{name: getattr(pin, f"JointModel{name}")() for name in ("RUBX", "RUBY", "RUBZ")},
        **{name: getattr(pin, f"JointModel{name}")(0.3) for name in ("HX", "HY", "HZ")},
        **{
            f"{name}Unaligned": getattr(pin, f"JointModel{name}Unaligned")(axis)
            for name in ("Revolute", "Prismatic")
        },
        "RevoluteUnboundedUnaligned": pin.buildModelFromXML(UNBOUNDED).joints[1].extract(),
        "HelicalUnaligned": pin.JointModelHelicalUnaligned(axis, -0.2),
        "Universal": pin.JointModelUniversal(np.array([1.0, 0, 0]), np.array([0, 0.6, 0.8])),
        "SphericalZYX": pin.JointModelSphericalZYX(),
        "Translation": pin.JointModelTranslation(),
        "Composite": composite,
    }


TYPES = (
    *(
        "RX",
        "RY",
        "RZ",
        "PX",
        "PY",
        "PZ",
        "RUBX",
        "RUBY",
        "RUBZ",
        "HX",
        "HY",
        "HZ",
        "RevoluteUnaligned",
    ),
    *(
        "PrismaticUnaligned",
        "RevoluteUnboundedUnaligned",
        "HelicalUnaligned",
        "Universal",
        "SphericalZYX",
    ),
    *("Translation", "Composite"),
)


@st.composite
def models(draw):
    """Models of all joint types in any tree, with and without the joints' own frames, and frames of
    all kinds.
    """
    pin, kinds = pinocchio(), makers()
    model = pin.Model()
    for i in range(draw(st.integers(0, 6))):
        parent = draw(st.integers(0, i))
        kind = kinds[draw(st.sampled_from(TYPES))]
        joint = model.addJoint(parent, kind, pin.SE3(draw(POSES).copy()), f"j{i}")
        if draw(st.booleans()):
            model.addJointFrame(joint, -1)
    types = (
        pin.FrameType.BODY,
        pin.FrameType.OP_FRAME,
        pin.FrameType.FIXED_JOINT,
        pin.FrameType.SENSOR,
    )
    for i in range(draw(st.integers(0, 5))):
        joint, above = (
            draw(st.integers(0, model.njoints - 1)),
            draw(st.integers(0, len(model.frames) - 1)),
        )
        placement = pin.SE3.Identity() if draw(st.booleans()) else pin.SE3(draw(POSES).copy())
        model.addFrame(pin.Frame(f"f{i}", joint, above, placement, draw(st.sampled_from(types))))
    return model


@given(models(), st.integers(0, 2**32))
def test_every_frame_of_a_model_stands_where_pinocchio_has_it(model, seed):
    robot = from_object(model)
    x = np.random.default_rng(seed).uniform(-2, 2, robot.dof)
    reach = 1 + sum(np.linalg.norm(p.translation) for p in model.jointPlacements) + 2 * robot.dof
    assert error(model, robot, x) <= ROUNDING * reach


@pytest.mark.parametrize("kind", TYPES)
def test_a_joint_of_each_type_moves_as_pinocchio_moves_it(kind):
    pin = pinocchio()
    model = pin.Model()
    model.addJointFrame(model.addJoint(0, makers()[kind], pin.SE3.Random(), "j"), 0)
    robot = from_object(model)
    x = np.linspace(0.3, -1.2, robot.dof)
    assert error(model, robot, x) <= 4 * ROUNDING
    assert robot.dof == model.nv > 0


def urdfs() -> dict[str, str]:
    try:
        return example_robots()[0]
    except pk.errors.MissingExtra:
        return {}


ROBOTS = urdfs()


@pytest.mark.skipif(
    not ROBOTS, reason="example-robot-data is not installed: none of its models can be built"
)
@pytest.mark.filterwarnings("ignore::poekin.errors.PoekinWarning")
@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_a_model_built_from_a_urdf_is_the_robot_of_that_urdf(name):
    path = ROBOTS[name]
    model, read = pinocchio().buildModelFromUrdf(path), pk.load(path)
    robot = from_object(model)
    named = {(j.name, j.kind, j.parent, j.child) for j in read.joints}
    assert set(robot.links) == set(read.links)
    assert {(j.name, j.kind, j.parent, j.child) for j in robot.joints} == named
    assert {j.name: j.limits for j in robot.joints if j.kind != "fixed"} == {
        j.name: j.limits for j in read.joints if j.kind not in ("fixed", "planar")
    }
    of_fields = operator.attrgetter("name", "velocity", "effort", "damping", "friction")
    moving = [[of_fields(j) for j in r.joints if j.kind in MOVING] for r in (robot, read)]
    assert sorted(moving[0]) == sorted(moving[1])
    assert robot.q_names == tuple(list(model.names)[1:])
    x = np.random.default_rng(0).uniform(-np.pi, np.pi, robot.dof)
    assert error(model, robot, x) <= ROUNDING


@pytest.mark.parametrize("name", ["j0", "other"])
@pytest.mark.parametrize("kind", ["JOINT", "BODY", "OP_FRAME"])
def test_a_joint_s_own_frame_is_one_of_its_name_and_of_the_type_joint(name, kind):
    pin = pinocchio()
    model = pin.Model()
    joint = model.addJoint(0, pin.JointModelRZ(), pin.SE3.Random(), "j0")
    frame = pin.Frame(name, joint, 0, pin.SE3.Identity(), getattr(pin.FrameType, kind))
    model.addFrame(frame)
    robot = from_object(model)
    if (name, kind) == ("j0", "JOINT"):
        assert robot.links == ("universe", "j0")
        return
    # a link of its own, fixed to the one that the joint moves
    beside = robot.joints[-1]
    assert (beside.kind, beside.child) == ("fixed", name)
    assert robot.joint("j0").child == beside.parent == ("j0_" if name == "j0" else "j0")


MIMIC = """<robot name="r"><link name="l0"/><link name="l1"/><link name="l2"/><link name="l3"/><link name="l4"/>
<joint name="a" type="revolute"><parent link="l0"/><child link="l1"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="b" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0 1 0"/><axis xyz="0.6 0.8 0"/>
  <mimic joint="a" multiplier="-2" offset="0.3"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="c" type="prismatic"><parent link="l2"/><child link="l3"/><origin xyz="1 0 0"/><axis xyz="0 0.6 0.8"/>
  <mimic joint="a" multiplier="0.5" offset="0.4"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="f" type="fixed"><parent link="l3"/><child link="l4"/><origin xyz="1 2 3" rpy="0.3 0 0"/></joint>
</robot>"""


def test_a_joint_that_mimics_another_one_follows_it():
    model = pinocchio().buildModelFromXML(MIMIC, mimic=True)
    robot, read = from_object(model), urdf.read_text(MIMIC)
    assert robot.q_names == ("a",)
    assert [j.mimic for j in robot.joints] == [j.mimic for j in read.joints]
    for x in (-0.9, 0.0, 0.7):
        assert error(model, robot, np.array([x])) <= ROUNDING


def test_a_free_flyer_is_a_floating_joint_at_the_universe():
    pin = pinocchio()
    model = pin.buildModelFromXML(MIMIC, pin.JointModelFreeFlyer())
    robot = from_object(model)
    assert (robot.root, robot.joint("root_joint").kind, robot.dof) == ("universe", "floating", 3)
    T = pk.se3.exp([0.3, -0.4, 0.5, 1.0, 2.0, 3.0])
    assert error(model, robot, np.array([0.1, 0.2, 0.3]), {"root_joint": T}) <= ROUNDING


def test_a_planar_joint_is_planar_in_its_own_x_and_y():
    pin = pinocchio()
    model = pin.Model()
    model.addJointFrame(model.addJoint(0, pin.JointModelPlanar(), pin.SE3.Random(), "p"), 0)
    robot = from_object(model)
    data = model.createData()
    c, s = math.cos(0.4), math.sin(0.4)
    pin.framesForwardKinematics(model, data, np.array([0.2, 0.3, c, s]))
    T = np.array([[c, -s, 0, 0.2], [s, c, 0, 0.3], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    assert (robot.joint("p").kind, robot.joint("p").axis) == ("planar", (0, 0, 1))
    np.testing.assert_allclose(
        robot.fk([], {"p": T})["p"], data.oMf[1].homogeneous, rtol=0, atol=ROUNDING
    )


@pytest.mark.parametrize("kind", ["Spherical", "Ellipsoid"])
def test_a_joint_that_robot_has_no_kind_for_is_refused_by_name(kind):
    pin = pinocchio()
    if not hasattr(pin, f"JointModel{kind}"):
        pytest.skip(f"this version of Pinocchio has no joint of type {kind}")
    model = pin.Model()
    model.addJoint(0, getattr(pin, f"JointModel{kind}")(), pin.SE3.Identity(), "hip")
    with pytest.raises(
        ModelError, match=rf"joint 'hip': a Pinocchio joint of type '{kind}' has no counterpart"
    ):
        from_object(model)


def test_a_model_with_locked_joints_keeps_their_frames():
    pin = pinocchio()
    model = pin.buildModelFromXML(MIMIC)
    reduced = pin.buildReducedModel(model, [model.getJointId("b")], np.array([0.1, 0.7, 0.2]))
    robot = from_object(reduced)
    assert (robot.q_names, robot.joint("b").kind, robot.joint("b").child) == (
        ("a", "c"),
        "fixed",
        "l2",
    )
    assert error(reduced, robot, np.array([0.4, -0.2])) <= ROUNDING


def placed(x=0.0) -> Any:
    T = np.eye(4)
    T[0, 3] = x
    return SimpleNamespace(homogeneous=T)


def frame(name: str, kind: str, joint: int, above: int, x: float = 0.0) -> Any:
    return SimpleNamespace(
        name=name,
        type=SimpleNamespace(name=kind),
        parentJoint=joint,
        parentFrame=above,
        placement=placed(x),
    )


def stand_in(shortname: str = "JointModelRZ", limits=(-1.0, 2.0), **more: Any) -> Any:
    """A model of one joint `j`, 1 m from the universe, its link 2 m from it, without Pinocchio."""
    joint = SimpleNamespace(shortname=lambda: shortname, idx_q=0, nq=1, **more)
    frames = [
        frame("universe", "FIXED_JOINT", 0, 0),
        frame("ground", "BODY", 0, 0),
        frame("j", "JOINT", 1, 1),
        frame("arm", "BODY", 1, 2),
        frame("end", "OP_FRAME", 1, 3, 2.0),
    ]
    return SimpleNamespace(
        njoints=2, joints=[None, joint], names=["universe", "j"], parents=[0, 0], frames=frames, name="one",
        jointPlacements=[placed(), placed(1.0)], lowerPositionLimit=[limits[0]], upperPositionLimit=[limits[1]],
    )  # fmt: skip


def test_a_stand_in_with_the_same_attributes_is_a_model():
    robot = from_object(stand_in())
    assert (robot.name, robot.links, robot.q_names) == ("one", ("ground", "arm", "end"), ("j",))
    assert robot.limits.tolist() == [[-1, 2]]
    np.testing.assert_allclose(robot.fk([math.pi / 2])["end"][:3, 3], [1, 2, 0], rtol=0, atol=1e-15)


def test_a_model_of_pinocchio_2_is_refused():
    model = stand_in()
    del model.frames[3].parentFrame
    with pytest.raises(
        ModelError,
        match=r"^expected a model of Pinocchio 3 or newer; its frame 'arm' has no parentFrame$",
    ):
        from_object(model)


@pytest.mark.parametrize("limits", [(-1e16, 1e16), (-math.inf, math.inf), (-1.7e308, 1.7e308)])
def test_limits_that_bound_nothing_are_none(limits):
    assert from_object(stand_in(limits=limits)).limits.tolist() == [[-math.inf, math.inf]]


def test_equal_limits_are_none_and_said():
    with pytest.warns(
        PoekinWarning,
        match=r"^joints without usable limits are taken as unlimited: 'j' \(equal, 0\.0\)$",
    ):
        assert from_object(stand_in(limits=(0.0, 0.0))).limits.tolist() == [[-math.inf, math.inf]]


def test_an_axis_that_a_joint_does_not_have_itself_is_read_off_its_motion_subspace():
    S = np.array([0, 0, 0, *HALF])
    joint = from_object(
        stand_in("JointModelRevoluteUnboundedUnaligned", createData=lambda: SimpleNamespace(S=S))
    ).joint("j")
    assert (joint.kind, joint.axis) == ("continuous", tuple(HALF))
    with pytest.raises(
        ModelError,
        match=r"^joint 'j': Pinocchio does not tell the axis of this 'RevoluteUnboundedUnaligned' joint$",
    ):
        from_object(
            stand_in(
                "JointModelRevoluteUnboundedUnaligned",
                createData=lambda: SimpleNamespace(S=np.zeros(6)),
            )
        )
    with pytest.raises(ModelError, match=r"'RevoluteUnboundedUnaligned' joint of multiplier 0$"):
        from_object(
            stand_in(
                "JointModelRevoluteUnboundedUnaligned",
                createData=lambda: SimpleNamespace(S=np.zeros(6)),
                scaling=0.0,
            )
        )


def test_frames_and_joints_of_one_name_get_names_of_their_own():
    model = stand_in()
    model.frames += [frame("arm", "OP_FRAME", 1, 2, 1.0), frame("j", "OP_FRAME", 1, 2, 3.0)]
    robot = from_object(model)
    assert set(robot.links) == {"ground", "arm", "end", "arm_", "j"}
    assert {joint.name for joint in robot.joints} == {"j", "end", "arm", "j_"}


def test_two_bodies_on_the_universe_leave_it_a_link_of_its_own():
    model = stand_in()
    model.frames.append(frame("table", "BODY", 0, 0))
    robot = from_object(model)
    assert robot.root == "universe"
    assert {"ground", "table"} <= set(robot.links)


def test_a_frame_that_hangs_on_one_of_another_joint_hangs_on_its_own_joint():
    model = stand_in()
    model.frames.append(frame("lost", "OP_FRAME", 1, 0, 0.5))
    model.frames.append(frame("later", "OP_FRAME", 1, 99, 0.5))
    robot = from_object(model)
    assert [robot.joint(name).parent for name in ("lost", "later")] == ["arm", "arm"]


def test_a_body_keeps_its_name_and_a_fixed_joint_its_own_whatever_came_before_them():
    model = stand_in()
    model.frames += [frame("x", "OP_FRAME", 1, 3, 0.1), frame("x", "BODY", 1, 3, 0.2)]
    model.frames += [frame("g", "OP_FRAME", 1, 3, 0.3), frame("g", "FIXED_JOINT", 1, 3, 0.4)]
    model.frames += [frame("h", "BODY", 1, 3, 0.5), frame("h", "FIXED_JOINT", 1, 3, 0.6)]
    robot = from_object(model)
    place = {link: T[0, 3] for link, T in robot.fk([0.0]).items()}
    np.testing.assert_allclose([place["x"], place["x_"]], [1.2, 1.1], rtol=0, atol=1e-15)
    for name, x in (("g", 0.4), ("h", 0.6)):
        np.testing.assert_allclose(robot.joint(name).origin[0, 3], x, rtol=0, atol=1e-15)


def test_a_joint_s_frame_that_is_not_in_the_joint_s_place_is_a_link_on_it():
    model = stand_in()
    model.frames[2].placement = placed(0.5)
    place = {link: T[0, 3] for link, T in from_object(model).fk([0.0]).items()}
    assert place == {"ground": 0, "j": 1.5, "arm": 1, "end": 3, "j_": 1}


def test_a_placement_that_is_no_pose_is_refused_with_its_frame():
    model = stand_in()
    model.frames[2].placement = np.eye(4) * 2
    with pytest.raises(
        PoseError, match=rf"^placement of frame '{model.frames[2].name}' is no pose: "
    ):
        from_object(model)


def test_a_joint_s_placement_that_is_no_pose_is_refused_with_its_joint():
    model = stand_in()
    model.jointPlacements[1] = np.eye(4) * 2
    with pytest.raises(PoseError, match=r"^placement of joint 'j' is no pose: "):
        from_object(model)


def test_each_part_of_a_joint_of_several_degrees_of_freedom_has_its_own_limits():
    model = stand_in("JointModelTranslation")
    model.lowerPositionLimit, model.upperPositionLimit = [-1, -2, -3], [4, 5, 1e5]
    robot = from_object(model)
    assert robot.q_names == ("j_1", "j_2", "j_3")
    assert [joint.child for joint in robot.joints[:2]] == ["j_1", "j_2"]
    assert robot.limits.tolist() == [[-1, 4], [-2, 5], [-3, math.inf]]


def test_each_part_of_a_joint_has_its_own_drive_and_numbers_that_mean_none_are_none():
    model = stand_in("JointModelTranslation", idx_v=1)
    model.lowerPositionLimit, model.upperPositionLimit = [-1, -2, -3], [4, 5, 6]
    model.velocityLimit = [9, 2.5, 0, 1e4]
    model.effortLimit = [9, 0, 87, sys.float_info.max]
    model.damping, model.friction = [9, 0.5, -1, 0], [9, 0, math.inf, 0.25]
    joints = from_object(model).joints[:3]
    assert [joint.velocity for joint in joints] == [2.5, math.inf, math.inf]
    assert [joint.effort for joint in joints] == [math.inf, 87, math.inf]
    assert [joint.damping for joint in joints] == [0.5, 0, 0]
    assert [joint.friction for joint in joints] == [0, 0, 0.25]
    free = stand_in("JointModelFreeFlyer", idx_v=0)
    free.velocityLimit = free.damping = [2.0] * 6
    floating = from_object(free).joints[0]
    assert (floating.kind, floating.velocity, floating.damping) == ("floating", math.inf, 0)
    del model.friction
    assert [joint.friction for joint in from_object(model).joints[:3]] == [0, 0, 0]


def test_a_joint_that_mimics_has_no_drive_of_its_own_as_pinocchio_keeps_none():
    limit = '<limit lower="-1" upper="1" effort="7" velocity="{}"/>'
    joints = [
        f'<joint name="j{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        f"{limit.format(k + 2)}{mimic}</joint>"
        for k, mimic in enumerate(("", '<mimic joint="j0" multiplier="2"/>', ""))
    ]
    links = "".join(f'<link name="l{k}"/>' for k in range(4))
    text = f'<robot name="r">{links}{"".join(joints)}</robot>'
    robot = from_object(pinocchio().buildModelFromXML(text, mimic=True))
    assert [robot.joint(f"j{k}").velocity for k in range(3)] == [2, math.inf, 4]
