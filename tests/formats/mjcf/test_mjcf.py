"""MJCF: every body and named site stands where MuJoCo's own kinematics puts it, at any qpos."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from poekin.errors import FileError, InputError, MissingExtra, ModelError, PoekinWarning
from poekin.formats.load import load
from poekin.formats.mjcf import mjcf
from poekin.formats.urdf_text import to_urdf
from poekin.model.robot import Robot
from poekin.model.tree.link_masses import LinkMass

mujoco = pytest.importorskip("mujoco", reason="the package mujoco is not installed")

# Of rotation entries, and of places ÷ R: MuJoCo's quaternions round at each of some ten joints,
# 2^-53 each.
TOLERANCE = 1e-13

G = '<geom size="0.1"/>'


def model_of(body: str, rest: str = "", top: str = "") -> str:
    return f'<mujoco model="m">{top}<worldbody>{body}</worldbody>{rest}</mujoco>'


def read(text: str) -> tuple[Robot, list[str]]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        robot = mjcf.read_text(text, "m.xml")
    assert all(issubclass(w.category, PoekinWarning) and w.filename == __file__ for w in caught)
    return robot, [str(w.message) for w in caught]


def pose(place, rotation) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.reshape(rotation, (3, 3)), place
    return T


def random_qpos(model, rng: np.random.Generator) -> np.ndarray:
    q = model.qpos0 + rng.uniform(-2, 2, model.nq)
    mujoco.mj_normalizeQuat(model, q)
    return q


def given_to_poekin(model, qpos: np.ndarray) -> tuple[dict[str, float], dict[str, np.ndarray]]:
    """qpos as poekin takes it: values by joint, and poses of free and ball joints."""
    values, poses = {}, {}
    for j in range(model.njnt):
        joint, at, R = model.joint(j).name, model.jnt_qposadr[j], np.empty(9)
        if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_FREE:
            mujoco.mju_quat2Mat(R, qpos[at + 3 : at + 7])
            poses[joint] = pose(qpos[at : at + 3], R)
        elif model.jnt_type[j] == mujoco.mjtJoint.mjJNT_BALL:
            mujoco.mju_quat2Mat(R, qpos[at : at + 4])
            poses[joint] = pose([0, 0, 0], R)
        else:
            values[joint] = qpos[at]
    return values, poses


def assert_it_moves_as_in_mujoco(text: str, count: int = 5) -> Robot:
    """All bodies and named sites at random qpos; joints without a name and mimics are not for this
    test.
    """
    robot, _ = read(text)
    model = mujoco.MjModel.from_xml_string(text)
    data, rng = mujoco.MjData(model), np.random.default_rng(0)
    for _ in range(count):
        data.qpos[:] = random_qpos(model, rng)
        mujoco.mj_kinematics(model, data)
        values, poses = given_to_poekin(model, data.qpos)
        assert list(robot.q_names) == list(values)  # the order is MuJoCo's
        found = robot.fk(values, poses)
        reach = max(1.0, np.abs(data.xpos).max(), np.abs(data.site_xpos).max(initial=0.0))
        for what, places, rotations in (
            ("body", data.xpos, data.xmat),
            ("site", data.site_xpos, data.site_xmat),
        ):
            for i, (p, R) in enumerate(zip(places, rotations, strict=True)):
                name = getattr(model, what)(i).name or (f"body{i}" if what == "body" else "")
                if name:
                    off = np.abs(found[name] - pose(p, R)) / np.array([[1, 1, 1, reach]])
                    # MuJoCo takes what lies within 1e-6 of its body's (or a body of its inertia's)
                    # frame for that frame
                    same = what == "site" and model.site_sameframe[i]
                    assert off.max() <= (1e-6 if same else TOLERANCE), (name, off)
    return robot


MODELS = {
    "degrees, classes, autolimits and a frame": model_of(
        f'<body name="a" pos="1 0 0" euler="10 20 30">{G}<joint name="j" class="c" pos="0.1 0.2 0.3"/>'
        f'<frame pos="0 0 1" euler="0 0 90"><site name="tool" pos="0.1 0 0"/><body pos="0 0.3 0">{G}'
        '<joint name="k"/></body></frame></body>',
        top='<default><default class="c"><joint axis="0 1 1" range="-30 60"/></default></default>',
    ),
    "radians and another order of angles": model_of(
        f'<body name="a" euler="0.1 0.2 0.3">{G}<joint name="j" range="-1 1"/></body>',
        top='<compiler angle="radian" eulerseq="ZYX"/>',
    ),
    "anchors, references and several joints in a body": model_of(
        f'<body name="a" pos="0.3 0 1" quat="1 2 3 4">{G}<joint name="h" pos="0.1 0.2 0.3" axis="1 2 3" ref="20"/>'
        '<joint name="s" type="slide" pos="1 1 1" axis="0 1 1" ref="0.2"/>'
        '<joint name="i" pos="-0.1 0 0.5" axis="0 1 0" ref="-70"/></body>'
    ),
    "an anchor on the axis": model_of(
        f'<body name="a">{G}<joint name="j" pos="0 0 3" axis="0 0 1" ref="5"/></body>'
    ),
    "a free body that carries an arm": model_of(
        f'<body name="a" pos="0 0 3" euler="0 0 40">{G}<freejoint name="f"/><body name="b" pos="0 1 0">{G}'
        '<joint name="j" axis="1 0 0"/></body></body>'
    ),
    "a ball joint with an anchor": model_of(
        f'<body name="a" pos="0 0 3">{G}<joint name="ball" type="ball" pos="0.1 0.2 0.3"/><site name="s"/>'
        f'<body name="b" pos="0 1 0">{G}<joint name="j" axis="1 0 0"/></body></body>'
    ),
    "replicated bodies": model_of(
        f'<replicate count="3" offset="1 0 0" euler="0 0 20"><body name="r" pos="0 1 0">{G}<joint name="j"/>'
        '<site name="s" pos="0 0 1" zaxis="1 1 1"/></body></replicate>'
    ),
    "inertial frames that are somewhere else": model_of(
        '<body name="a" pos="1 0 0"><inertial pos="3 2 1" quat="1 2 3 4" mass="2" diaginertia="1 1 1"/>'
        f'<joint name="j" axis="0 1 0"/><body name="b" pos="0 1 0">{G}<joint name="k" type="slide"/></body></body>'
    ),
}


@pytest.mark.parametrize("text", MODELS.values(), ids=MODELS.keys())
def test_bodies_and_sites_are_where_mujoco_puts_them(text):
    assert_it_moves_as_in_mujoco(text)


def numbers(count: int, size: float = 2.0) -> st.SearchStrategy[str]:
    entries = st.floats(-size, size).map(lambda x: x if abs(x) > 1e-9 else 0.0)
    return st.lists(entries, min_size=count, max_size=count).map(lambda v: " ".join(map(repr, v)))


def directions(count: int) -> st.SearchStrategy[str]:
    return numbers(count).filter(lambda text: sum(float(x) ** 2 for x in text.split()) > 1e-3)


@st.composite
def trees(draw) -> str:
    """A random tree of bodies with hinges and slides."""
    count = draw(st.integers(1, 6))
    inside: list[list[int]] = [[] for _ in range(count + 1)]
    for i in range(1, count + 1):
        inside[draw(st.integers(0, i - 1))].append(i)
    joints = iter(range(100))

    def body(i: int) -> str:
        own = "".join(
            f'<joint name="j{next(joints)}" type="{draw(st.sampled_from(["hinge", "slide"]))}"'
            f' pos="{draw(numbers(3))}" axis="{draw(directions(3))}" ref="{draw(numbers(1))}" armature="1"/>'
            for _ in range(draw(st.integers(0, 3)))
        )
        place = f'pos="{draw(numbers(3))}" quat="{draw(directions(4))}"'
        site = f'<site name="s{i}" pos="{draw(numbers(3))}"/>' if draw(st.booleans()) else ""
        return f'<body name="b{i}" {place}>{G}{own}{site}{"".join(map(body, inside[i]))}</body>'

    return model_of("".join(map(body, inside[0])), top='<compiler angle="radian"/>')


@given(trees())
@example(
    model_of(
        '<body name="b1" quat="0 0 0 1"><geom size="0.1"/><site name="s1" pos="0 0 1e-8"/></body>'
    )
)
def test_random_trees_move_as_in_mujoco(text):
    assert_it_moves_as_in_mujoco(text, 2)


def test_the_jacobian_is_mujocos():
    text = MODELS["anchors, references and several joints in a body"]
    chain = read(text)[0].chain(tip="a")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[:] = [0.3, -0.2, 1.1]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    linear, angular = np.zeros((3, 3)), np.zeros((3, 3))
    mujoco.mj_jacBody(model, data, linear, angular, model.body("a").id)
    J = chain.jacobian(data.qpos, "hybrid")
    assert np.abs(J - np.vstack([angular, linear])).max() <= TOLERANCE * chain.reach


def test_names_kinds_and_limits_are_those_of_the_file():
    text = model_of(
        f'<body name="a">{G}<joint range="-90 90"/><joint name="s" type="slide" axis="1 0 0"/>'
        f'<body>{G}<joint axis="0 1 0"/><site name="a"/><site/></body></body><body name="still" pos="1 0 0"/>'
    )
    robot, said = read(text)
    assert said == []
    assert (robot.name, robot.root) == ("m", "world")
    assert robot.links == ("world", "a_after_a_joint1", "a", "body2", "still", "a_site")
    assert [(j.name, j.kind, j.child) for j in robot.joints] == [
        ("a_joint1", "revolute", "a_after_a_joint1"), ("s", "prismatic", "a"), ("body2_joint", "continuous", "body2"),
        ("still_fixed", "fixed", "still"), ("a_site_fixed", "fixed", "a_site"),
    ]  # fmt: skip
    assert robot.limits.tolist() == [[-np.pi / 2, np.pi / 2], [-np.inf, np.inf], [-np.inf, np.inf]]


def test_joints_of_one_body_without_names_are_counted_from_1():
    joints = "".join(f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))
    before = f'<body name="a">{G}<joint/></body>'
    robot, _ = read(model_of(f'{before}<body name="b">{G}{joints}</body>'))
    assert robot.q_names == ("a_joint", "b_joint1", "b_joint2", "b_joint3")


DRIVE = 'damping="0.5" frictionloss="0.25"'


@pytest.mark.parametrize(
    "joint, expected",
    [
        (f'<joint {DRIVE} actuatorfrcrange="-3 3"/>', (0.5, 0.25, 3)),
        ('<joint actuatorfrcrange="-3 4"/>', (0, 0, np.inf)),
        ('<joint actuatorfrcrange="-3 3" actuatorfrclimited="false"/>', (0, 0, np.inf)),
        (f'<joint type="slide" {DRIVE}/>', (0.5, 0.25, np.inf)),
        (f'<joint type="ball" {DRIVE}/>', (0.5, 0.25, np.inf)),
    ],
)
@pytest.mark.filterwarnings("ignore:ball joints:poekin.errors.PoekinWarning")
def test_a_joint_says_of_its_drive_what_mjcf_knows(joint, expected):
    before = f'<body name="before">{G}<joint type="ball"/></body>'
    robot = read(model_of(f'{before}<body name="a">{G}{joint}</body>'))[0]
    found = robot.joint("a_joint")
    assert (found.damping, found.friction, found.effort) == expected
    assert found.velocity == np.inf
    assert robot.joint("before_joint").damping == 0


def test_a_joint_held_still_has_no_drive():
    held = f'<body name="a">{G}<joint name="x" {DRIVE}/></body>'
    (joint,) = read(model_of(held, '<equality><joint joint1="x"/></equality>'))[0].joints
    assert (joint.kind, joint.damping, joint.friction) == ("fixed", 0, 0)


COUPLED = model_of(
    f'<body name="a">{G}<joint name="x" ref="0.3"/></body><body name="b">{G}<joint name="y" type="slide" ref="0.1"/>'
    f'</body><body name="c">{G}<joint name="z" ref="0.4"/></body>'
    f'<body name="d">{G}<joint name="w" axis="1 0 0" ref="0.2"/></body>',
    '<equality><joint joint1="y" joint2="x" polycoef="0.2 -1.5 0 0 0"/><joint joint1="z" polycoef="0.7 0 0 0 0"/>'
    '<joint joint1="w" joint2="z" polycoef="0.1 2 0 0 0"/></equality>',
    '<compiler angle="radian"/>',
)


def test_linear_equalities_hold_in_mujoco_where_poekin_puts_the_joints():
    robot, said = read(COUPLED)
    assert said == []
    assert robot.q_names == ("x",)
    model = mujoco.MjModel.from_xml_string(COUPLED)
    data = mujoco.MjData(model)
    follow = robot.joint("y").mimic
    assert follow is not None
    for x in (-1.0, 0.0, 0.4):
        data.qpos[:] = [x, follow.multiplier * x + follow.offset, 0.4 + 0.7, 0.2 + 0.1 + 2 * 0.7]
        mujoco.mj_forward(model, data)
        assert (
            np.abs(data.efc_pos[: model.neq]).max() <= 1e-15
        )  # the residuals of the equalities, of numbers below 2
        found = robot.fk([x])
        for i in range(1, model.nbody):
            assert (
                np.abs(found[model.body(i).name] - pose(data.xpos[i], data.xmat[i])).max()
                <= TOLERANCE
            )


@pytest.mark.parametrize(
    ("equality", "said"),
    [
        (
            '<joint joint1="x" joint2="y" polycoef="0 1 1 0 0"/>',
            "equalities are left out for joints whose polynomial is not linear: 'x'",
        ),
        (
            '<joint joint1="x" joint2="y"/><joint joint1="y" joint2="x"/>',
            "equalities are left out for joints that follow each other in a circle: 'y'",
        ),
        (
            '<joint joint1="x" joint2="y"/><joint joint1="x"/>',
            "equalities are left out for joints of which there is an earlier equality: 'x'",
        ),
        (
            '<weld name="w" body1="a" body2="b"/>',
            "constraints are left out (a robot here is a tree): 'weld w'",
        ),
        ('<connect body1="a" body2="b" anchor="0 0 0"/>', "'connect a b'"),
        ('<joint joint1="x" joint2="y" active="false"/>', None),
    ],
    ids=["curved", "a circle", "twice", "weld", "connect", "not active"],
)
def test_an_equality_that_is_not_honoured_is_said(equality, said):
    body = f'<body name="a">{G}<joint name="x"/></body><body name="b">{G}<joint name="y"/></body>'
    _, messages = read(model_of(body, f"<equality>{equality}</equality>"))
    assert len(messages) == (said is not None)
    assert said is None or said in messages[0]


def test_mocap_bodies_and_what_hangs_on_them_are_left_out_and_balls_named():
    text = model_of(
        f'<body name="target" mocap="true"><site name="s"/><body name="on"><joint name="k"/>{G}</body></body>'
        f'<body name="a">{G}<joint name="b" type="ball"/></body><body name="other" mocap="true"/>'
    )
    robot, said = read(text)
    assert robot.links == ("world", "a")
    assert [j.kind for j in robot.joints] == ["floating"]
    assert len(said) == 2
    assert said[0] == (
        "m.xml: ball joints are floating ones here, which no chain can cross: 'b'; Robot.fk takes"
        " the rotation of each as a pose"
    )
    assert said[1].endswith(
        "mocap bodies are left out, with all that hangs on them: 'target', 'other'"
    )


def test_no_file_of_an_asset_is_needed_and_none_is_written(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = model_of(
        '<light texture="t"/><camera mode="targetbody" target="a"/><geom type="hfield" hfield="h"/><body name="a">'
        '<geom name="g" type="mesh" mesh="me" material="ma"/><joint name="j"/><site name="s" material="ma"/></body>',
        '<tendon><fixed name="te"><joint joint="j" coef="1"/></fixed></tendon><actuator><motor tendon="te"/></actuator>'
        '<sensor><framepos objtype="geom" objname="g"/></sensor><keyframe><key qpos="1"/></keyframe>'
        '<contact><pair geom1="g" geom2="g"/></contact><custom><numeric name="n" data="1"/></custom>',
        '<asset><mesh name="me" file="gone.obj"/><texture name="t" file="gone.png" type="2d"/><material name="ma"'
        ' texture="t"/><hfield name="h" file="gone.png" size="1 1 1 1"/></asset><compiler inertiafromgeom="true"/>'
        '<default><geom material="ma"/></default>',
    )
    robot, said = read(text)
    assert (robot.q_names, said) == (("j",), [])
    assert list(tmp_path.iterdir()) == []


def test_load_takes_an_mjcf_by_its_root_with_what_it_includes(tmp_path, monkeypatch):
    (tmp_path / "arm.xml").write_text(
        f'<mujoco><worldbody><body name="a">{G}<joint name="j"/></body></worldbody></mujoco>'
    )
    (tmp_path / "scene.xml").write_text('<mujoco><include file="arm.xml"/></mujoco>')
    monkeypatch.chdir(Path("/"))
    robot = load(tmp_path / "scene.xml")
    assert (robot.name, robot.links) == ("scene", ("world", "a"))
    (tmp_path / "r.xml").write_text('<robot name="r"><link name="l"/></robot>')
    assert load(tmp_path / "r.xml").name == "r"
    (tmp_path / "arm.xml").unlink()
    with pytest.raises(ModelError, match=r"scene\.xml: MuJoCo refuses this model: .*arm\.xml"):
        load(tmp_path / "scene.xml")


REFUSED = {
    "another root": ('<robot name="r"/>', r"^m\.xml:1: expected the root element <mujoco>, got 'robot'$"),
    "a DTD": ('<!DOCTYPE mujoco [<!ENTITY a "b">]><mujoco/>', r"^m\.xml:1: a document type declaration"),
    "an unknown attribute": (
        model_of("<body><joint\n foo='1'/></body>"),
        r"^m\.xml: MuJoCo refuses this model: XML Error: .*'foo'; Element 'joint', line 1$",
    ),
    "a name twice": (model_of('<body name="a"/><body name="a"/>'), r"repeated name 'a' in body"),
    "a name that a terminal would obey": (model_of('<body name="&#x9;a"/><body name="&#x9;a"/>'), r"name '\\ta' in"),
    "no number": (model_of('<body pos="0 NaN 0"/>'), r"^m\.xml:1: <body>: pos must be finite numbers, got '0 NaN 0'$"),
    "infinite": (model_of('<body name="a" pos="inf 0 0"/>'), r"^m\.xml: joint 'a_fixed': origin"),
    "too far": (model_of('<body name="a" pos="1e200 0 0"/>'), r"^m\.xml: joint 'a_fixed': origin: expected lengths"),
    "limits the wrong way round": (
        model_of(f'<body name="a"><joint name="j" limited="true" range="1 0"/>{G}</body>'), r"m\.xml: .*range",
    ),
    "an include that is not there": ('<mujoco><include file="gone.xml"/></mujoco>', r"Error opening file 'gone\.xml'"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "message"), REFUSED.values(), ids=REFUSED.keys())
def test_what_cannot_be_understood_is_refused_in_one_line(text, message):
    with pytest.raises(ModelError, match=message) as caught:
        read(text)
    assert str(caught.value).isprintable()


def test_what_is_no_file_and_no_text_is_refused(tmp_path):
    with pytest.raises(FileError, match="No such file"):
        mjcf.read(tmp_path / "gone.xml")
    with pytest.raises(FileError, match="a directory"):
        mjcf.read(tmp_path)
    with pytest.raises(InputError, match=r"^<text>: expected a text, str or bytes, got 7$"):
        mjcf.read_text(7)  # type: ignore[arg-type]
    with pytest.raises(
        InputError, match=r"^name: expected what to call the text in messages, a str, got 7$"
    ):
        mjcf.read_text("<mujoco/>", 7)  # type: ignore[arg-type]
    assert mjcf.read_text(b"<mujoco/>").links == ("world",)


def test_without_mujoco_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(
        MissingExtra, match=r"^reading MJCF needs the package mujoco: pip install 'poekin\[mjcf\]'$"
    ):
        mjcf.read_text("<mujoco/>")


def test_bodies_that_mujoco_would_fuse_stay_in_attached_models_too(tmp_path):
    (tmp_path / "part.xml").write_text(
        '<mujoco><compiler angle="radian" fusestatic="true" inertiafromgeom="true"/><asset><mesh name="m"'
        ' file="gone.obj"/></asset><worldbody><body name="b"><joint name="j" range="-1 1"/><geom type="mesh" mesh="m"/>'
        '<body name="still" pos="0 0 1"/></body></worldbody></mujoco>'
    )
    (tmp_path / "whole.xml").write_text(
        '<mujoco><compiler fusestatic="true"/><asset><model name="c" file="part.xml"/></asset><worldbody><body name="a"'
        ' pos="1 0 0"><attach model="c" body="b" prefix="L_"/></body></worldbody></mujoco>'
    )
    robot = load(tmp_path / "whole.xml")
    assert robot.links == ("world", "a", "L_b", "L_still")
    assert robot.limits.tolist() == [[-1, 1]]
    assert robot.fk([0.3])["L_still"][:3, 3].tolist() == [1, 0, 1]


def test_a_floating_joint_is_the_one_that_its_urdf_gives(tmp_path):
    robot, _ = read(model_of(f'<body name="b">{G}<freejoint name="f"/></body>'))
    (tmp_path / "a.urdf").write_text(to_urdf(robot), encoding="ascii")
    (ours,), (theirs,) = robot.joints, load(tmp_path / "a.urdf").joints
    assert (ours.kind, ours.axis, ours.limits) == (theirs.kind, theirs.axis, theirs.limits)


def test_bodies_with_an_inertial_have_its_mass_whatever_geoms_and_options_say():
    inner = '<body name="c"><inertial pos="0 0 0" mass="1e-13" diaginertia="1 1 1"/></body>'
    heavy = '<body name="d"><inertial pos="0 0 0" mass="2e4" diaginertia="1 1 1"/></body>'
    robot, said = read(
        model_of(
            f"""<body name="a"><inertial pos="1 2 3" mass="4" diaginertia="1 2 2"/><joint/>
            <body name="b">{G}<joint/>{inner}{heavy}</body></body>
            <body name="e" mocap="true"><inertial pos="0 0 0" mass="4" diaginertia="1 1 1"/></body>""",
            top='<compiler settotalmass="90" boundmass="8"/>',
        )
    )
    assert robot.masses == (LinkMass("a", 4.0, (1, 2, 3)),)
    assert len(said) == 1  # of the mocap body
