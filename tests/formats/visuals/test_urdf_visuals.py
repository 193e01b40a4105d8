"""Visuals of URDF: each shape where Pinocchio puts it, each colour as urdfdom decides, and no more
files refused than before.
"""

from __future__ import annotations

import copy
import pickle
import re
import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.formats import erd, urdf
from poekin.formats.visuals.of_robot import visuals_of
from poekin.formats.visuals.visual import Visuals

HANDFUL = (
    "panda",
    "ur5_gripper",
    "talos_left_arm",
    "tiago_dual",
    "anymal_b_simple_description/anymal",
)


def looks(inside: str, above: str = "", version: str = "") -> Visuals:
    """Visuals of a URDF of one link that holds this."""
    text = f'<robot name="r"{version}>{above}\n<link name="a">\n{inside}\n</link></robot>'
    return visuals_of(pk.from_text(text, "r.urdf"))


def visual(geometry: str, rest: str = "") -> str:
    return f"<visual>{rest}<geometry>{geometry}</geometry></visual>"


@pytest.mark.parametrize("name", HANDFUL)
def test_visuals_stand_where_pinocchio_s_geometry_model_puts_them(name):
    pin = pytest.importorskip("pinocchio", reason="the package pin is not installed")
    path = erd.available()[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        robot = urdf.read(path)
    model = pin.buildModelFromUrdf(path)
    with open(path, encoding="utf-8") as file:  # boxes, as Pinocchio would open the meshes
        text = re.sub(r"<mesh [^>]*/>", '<box size="1 1 1"/>', file.read())
    shapes = pin.buildGeomFromUrdfString(model, text, pin.GeometryType.VISUAL)
    data, shape_data = model.createData(), shapes.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    pin.updateGeometryPlacements(model, data, shapes, shape_data)
    ours: dict[str, list[np.ndarray]] = {}
    poses = robot.fk(np.zeros(robot.dof))
    reach = max(np.abs(T[:3, 3]).max() for T in poses.values()) + 1.0
    found = visuals_of(robot).found
    for shape in found:
        ours.setdefault(shape.link, []).append(poses[shape.link] @ shape.T_link_visual)
    assert len(found) == len(shapes.geometryObjects) > 5
    for number, shape in enumerate(shapes.geometryObjects):
        link, _, place = shape.name.rpartition("_")
        T = shape_data.oMg[number].homogeneous
        # products of some twenty poses, each rounded twice, on either side
        assert np.abs(T - ours[link][int(place)]).max() <= 1e-13 * reach


@pytest.mark.parametrize(
    ("geometry", "shape", "size"),
    [
        ('<box size="1 2 3"/>', "box", (1, 2, 3)),
        ('<cylinder radius="0.1" length="2"/>', "cylinder", (0.1, 2)),
        ('<capsule radius="0.1" length="2"/>', "capsule", (0.1, 2)),
        ('<sphere radius="0.5"/>', "sphere", (0.5,)),
        ('<mesh filename="m.stl"/>', "mesh", (1, 1, 1)),
        ('<mesh filename="m.stl" scale="1 -1 2"/>', "mesh", (1, -1, 2)),
    ],
)
def test_each_shape_comes_with_its_sizes_file_and_line(geometry, shape, size):
    (found,) = looks(visual("\n" + geometry)).found
    assert (found.link, found.shape, found.size) == ("a", shape, size)
    assert found.file == ("m.stl" if shape == "mesh" else "")
    assert found.place == "r.urdf:4"
    assert found.color is None
    assert np.array_equal(found.T_link_visual, np.eye(4))


BALL = '<sphere radius="1"/>'
RED = '<color rgba="1 0 0 1"/>'
BLUE = '<color rgba="0 0 1 0.5"/>'


@pytest.mark.parametrize(
    ("above", "material", "color"),
    [
        ("", f"<material>{RED}</material>", (1, 0, 0, 1)),
        ("", f'<material name="m">{RED}</material>', (1, 0, 0, 1)),
        (f'<material name="m">{RED}</material>', '<material name="m"/>', (1, 0, 0, 1)),
        (f'<material name="m">{RED}</material>', f'<material name="m">{BLUE}</material>', (1, 0, 0, 1)),
        ("", '<material name="m"/>', None),
        ("", '<material name="m"><texture filename="t.png"/></material>', None),
        ("", '<material><color rgba="2 -1 0 1"/></material>', (1, 0, 0, 1)),
        ("", "<material><color/></material>", (1, 1, 1, 1)),
    ],
)  # fmt: skip
def test_a_colour_is_the_one_of_the_robot_s_material_then_the_visual_s_own(above, material, color):
    assert looks(visual(BALL, material), above).found[0].color == color


def test_a_material_s_colour_stands_for_its_name_in_the_visuals_after_it():
    first = visual(BALL, f'<material name="m">{BLUE}</material>')
    found = looks(first + visual(BALL, '<material name="m"/>')).found
    assert [shape.color for shape in found] == [(0, 0, 1, 0.5)] * 2
    bare = visual(BALL, '<material name="m"/>')
    found = looks(bare + first + bare).found
    assert [shape.color for shape in found] == [None, (0, 0, 1, 0.5), (0, 0, 1, 0.5)]


def test_the_pose_of_a_visual_may_be_a_quaternion_where_the_robot_s_may():
    turned = visual(BALL, '<origin xyz="1 2 3" quat_xyzw="0 0 2 0"/>')
    (found,) = looks(turned, version=' version="1.1"').found
    assert np.array_equal(found.T_link_visual, [[-1, 0, 0, 1], [0, -1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])  # fmt: skip


FAULTY = {
    "<visual/>": "expected an element <geometry>, there is none",
    visual(""): "expected one of mesh, box, .*, got none",
    visual("<teapot/>"): "expected one of mesh, box, .*, got 'teapot'",
    visual('<box size="1 2"/>'): "size must be three numbers, got 2",
    visual(
        '<box size="1 2 -3"/>'
    ): r"expected positive lengths in size, got \(1\.0, 2\.0, -3\.0\)$",
    visual(
        "<box/>"
    ): r"^link 'a': <visual>: <geometry>: <box>: expected positive lengths in size, got \(\)$",
    visual('<cylinder radius="x" length="1"/>'): "radius must be a finite number",
    visual("<sphere/>"): r"<sphere>: expected positive lengths in radius, got \(0\.0,\)$",
    visual(
        '<cylinder radius="0" length="-1"/>'
    ): r"expected positive lengths in radius and length, got \(0\.0, -1\.0\)$",
    visual('<mesh scale="1 1 1"/>'): "expected an attribute filename",
    visual(
        '<mesh filename="a" scale="1 0 2"/>'
    ): r"^link 'a': <visual>: <geometry>: <mesh>: scale must not be zero, got \(1\.0, 0\.0, 2\.0\)$",
    visual(BALL, '<origin xyz="1 2"/>'): "xyz must be three numbers",
    visual(BALL, '<material><color rgba="1 2"/></material>'): "rgba must be four numbers",
}


@pytest.mark.parametrize("text", FAULTY)
def test_a_faulty_visual_is_left_out_with_its_line_and_the_robot_is_read_without_a_warning(text):
    found, (left,) = looks(text + visual(BALL))
    assert [shape.shape for shape in found] == ["sphere"]
    assert (left.link, left.place, left.what) == ("a", "r.urdf:3", "<visual>")
    assert re.search(FAULTY[text], left.why)
    assert not left.why.startswith("r.urdf")


@given(st.text(max_size=60), st.sampled_from(("box size", "mesh filename", "sphere radius", "color rgba")))  # fmt: skip
def test_whatever_stands_in_a_visual_nothing_is_raised(value, place):
    tag, attribute = place.split()
    plain = "".join(c for c in value if c.isprintable() and c not in '<&"')
    element = f'<{tag} {attribute}="{plain}"/>'
    rest = f"<material>{element}</material>" if tag == "color" else ""
    found, left = looks(visual(element if not rest else BALL, rest))
    assert len(found) + len(left) == 1


def test_visuals_go_with_a_robot_that_is_copied_pickled_coupled_or_calibrated():
    robot = pk.load("panda")
    names = [shape.file for shape in visuals_of(robot).found]
    arm = robot.chain(tip="panda_hand")
    shift = np.eye(4)
    shift[0, 3] = 1e-3
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        moved = pk.relinked(robot, arm.rebased(shift), tip="panda_hand")
    again = pickle.loads(pickle.dumps(robot))
    coupled = robot.coupled("panda_joint3 = panda_joint2 + panda_joint3")
    for other in (copy.deepcopy(robot), again, moved, coupled):
        assert [shape.file for shape in visuals_of(other).found] == names
    assert len(names) == 11


def test_what_hangs_on_links_that_a_robot_does_not_have_is_not_seen():
    whole = pk.from_text(
        '<robot name="r"><link name="a"><visual/></link><link name="b"><visual><geometry>'
        f'{BALL}</geometry></visual></link><joint name="j" type="fixed"><parent link="a"/>'
        '<child link="b"/></joint></robot>'
    )
    assert [len(found) for found in visuals_of(whole)] == [1, 1]
    assert visuals_of(pk.Robot("r", ["c"], [], whole.source)) == Visuals()


def test_there_is_nothing_to_see_of_a_robot_that_was_read_from_no_file():
    assert visuals_of(pk.load("puma560")) == Visuals()
    assert visuals_of(pk.Robot("r", ["a"], [])) == Visuals()


def test_the_built_in_panda_names_the_meshes_of_example_robot_data_as_that_does():
    ours = visuals_of(pk.load("panda")).found
    theirs = visuals_of(pk.load("erd:panda")).found
    assert [(v.link, v.file, v.size) for v in ours] == [(v.link, v.file, v.size) for v in theirs]
    # pi there has eleven digits
    for one, other in zip(ours, theirs, strict=True):
        assert np.abs(one.T_link_visual - other.T_link_visual).max() <= 1e-11
