"""The scene of an arm: its axes lie on its screws, each node hangs on its link, and what is said of
the model is the model's.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.analysis.axis_lines import uncoupled_at_zero
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.formats.visuals.visual import LeftOut
from poekin.testing.strategies.chain_strategies import chains, coordinates
from poekin.view.kinematics import tip_chain
from poekin.view.nodes import Cloud, Label, Node, Polyline, Triangles
from poekin.view.scene import Scene, Slider
from poekin.view.scenes.arm import arm_geometry, arm_nodes, arm_scene, arm_size
from poekin.view.scenes.arm_parts import skeleton
from poekin.view.scenes.arm_parts.axes import (
    COVERED,
    END_FRAME,
    LINK_FRAME,
    axis_nodes,
    frame_nodes,
)
from poekin.view.scenes.arm_parts.geometry import ArmGeometry, opening_q
from poekin.view.scenes.arm_parts.missing import left_out_words
from poekin.view.scenes.arm_parts.of_chain import chain_geometry
from poekin.view.scenes.arm_parts.of_robot import robot_geometry
from poekin.view.scenes.arm_parts.skeleton import glyph_radii
from tests.model.laws.chain_bounds import budget

FEW = settings(max_examples=max(settings().max_examples // 2, 20))


def odd_robot() -> pk.Robot:
    """A tree with each kind of joint, a mimic, names that are markup, and links out of order."""
    turned = pk.se3.exp([0.3, -0.2, 0.5, 0.1, 0.2, 0.3])
    return pk.Robot(
        "odd <b>",
        ["spin", "base", "slid", "screwed", "right", "left", "free"],
        [
            pk.Joint("slide", "prismatic", "spin", "slid", turned, (0, 1, 1), limits=(0.1, 0.4)),
            pk.Joint("turn", "revolute", "base", "spin", turned, (1, 2, 0), limits=(-1, 2)),
            pk.Joint("thread", "helical", "slid", "screwed", turned, (0, 0, 1), pitch=-0.02),
            pk.Joint("<i>left\u202e", "prismatic", "screwed", "left", turned, limits=(0.0, 0.05)),
            pk.Joint(
                "right",
                "prismatic",
                "screwed",
                "right",
                turned,
                mimic=pk.Mimic("<i>left\u202e", -2),
            ),
            pk.Joint("loose", "floating", "base", "free", turned),
        ],
    )


def of_kind(scene_nodes: tuple[Node, ...] | list[Node], kind: type, layer: str) -> list:
    return [
        node for node in scene_nodes if isinstance(node, kind) and node.attachment.layer == layer
    ]


def in_the_world(arm: ArmGeometry, q: np.ndarray, node: Node) -> np.ndarray:
    """Points of a node where the page draws them at q."""
    assert isinstance(node, Triangles | Polyline)
    points = node.vertices if isinstance(node, Triangles) else node.points
    T = arm.poses(q)[node.attachment.link]
    return points @ T[:3, :3].T + T[:3, 3]


def off_axis(screw: np.ndarray, points: np.ndarray) -> tuple[float, float]:
    """Greatest distance of points from the axis of a screw, m, and its angle to their line, rad."""
    w, v = screw[:3], screw[3:]
    way = np.diff(points, axis=0)[0]
    way = way / np.linalg.norm(way)
    if not w.any():
        return 0.0, float(np.linalg.norm(way - v))
    gaps = v - w * (w @ v) + np.cross(w, points)
    return float(np.linalg.norm(gaps, axis=1).max()), float(np.linalg.norm(way - w))


@FEW
@given(st.data())
def test_the_lines_of_a_chain_lie_on_its_screws_at_every_q(data):
    """Bound: the budgets of the pose at q and at 0, and of the screw at q with its 1 + n factors,
    over the farthest point; the direction is that of two points, each with that error.
    """
    chain = data.draw(chains())
    q = data.draw(coordinates(chain))
    arm = arm_geometry(chain, ())
    zero = np.zeros(chain.dof)
    size = arm_size(arm, zero)
    lines = of_kind(axis_nodes(arm, glyph_radii(arm, zero, size), size), Polyline, "axes")
    rest = uncoupled_at_zero(chain)
    J = rest.jacobian(chain.coupling @ q, "space")
    angular = budget(chain, q)[0] + budget(chain, zero)[0]
    linear = budget(chain, q)[1] + budget(chain, zero)[1]
    for k, line in enumerate(lines):
        points = in_the_world(arm, q, line)
        far = np.abs(points).max() + np.abs(line.points).max()
        bound = 2 * (2 + len(lines)) * (linear + angular * far)
        gap, angle = off_axis(J[:, k], points)
        assert gap <= bound
        assert angle <= 2 * (2 + len(lines)) * angular + 2 * bound / np.linalg.norm(
            np.ptp(points, 0)
        )
        assert line.attachment.link == k
        assert off_axis(arm.joints[k].screw, in_the_world(arm, zero, line))[0] <= bound
    assert len(lines) == len(chain.kinds)


@pytest.mark.parametrize(
    ("robot", "tip"),
    [("panda", "panda_leftfinger"), ("stanford", None), (odd_robot(), "right")],
    ids=["panda", "stanford", "odd"],
)
def test_the_lines_of_a_robot_lie_on_the_screws_of_its_chain(robot, tip):
    """Rounding of a few poses of about 2 m: 1e-14 m."""
    robot = pk.load(robot) if isinstance(robot, str) else robot
    chain = robot.chain(tip=tip)
    arm = arm_geometry(robot, ())
    q = opening_q(arm.sliders) + 0.3
    x = chain.coupling @ q[[robot.q_names.index(name) for name in chain.q_names]]
    J = uncoupled_at_zero(chain).jacobian(x, "space")
    lines = of_kind(arm_nodes(arm, q, arm_size(arm, q)), Polyline, "axes")
    names = [line.attachment.name.split(" ", 1)[1] for line in lines]
    for k, name in enumerate(chain.joint_names):
        gap, angle = off_axis(J[:, k], in_the_world(arm, q, lines[names.index(name)]))
        assert gap < 1e-14
        assert angle < 1e-13


def test_frames_are_where_the_robot_has_its_links():
    robot = odd_robot()
    scene = arm_scene(robot, tip="left")
    arm = arm_geometry(robot, scene.arms[0].tips)
    assert scene.arms[0].links == robot.links
    q = np.array([0.2, -0.3, 0.4, 0.05])
    poses = robot.fk(q)
    frames = of_kind(scene.nodes, Triangles, "frames")
    shown = [node for node in frames if node.attachment.rule is None]
    for node in shown:
        axis = {"x": 0, "y": 1, "z": 2}[node.attachment.role]
        T = poses[node.attachment.name]
        points = in_the_world(arm, q, node)
        along = (points - T[:3, 3]) @ T[:3, axis]
        across = np.linalg.norm(points - T[:3, 3] - along[:, None] * T[:3, axis], axis=1)
        assert across[np.argmax(along)] < 1e-14  # the point of the arrow
        assert along.min() > -1e-14
    assert {node.attachment.name for node in shown} == {
        "base",
        "spin",
        "slid",
        "screwed",
        "left",
        "right",
    }


@pytest.mark.parametrize("covered", [False, True])
def test_a_frame_is_as_long_as_its_joint_and_the_base_and_the_first_tip_as_the_largest(covered):
    arm = robot_geometry(odd_robot(), ["left", "free"])
    radii = np.arange(1.0, len(arm.joints) + 1)
    lengths = {}
    for node in frame_nodes(arm, radii, 1.0, covered):
        if isinstance(node, Triangles):
            (frame,) = (one for one in arm.frames if one.name == node.attachment.name)
            away = node.vertices - frame.pose[:3, 3]
            lengths[frame.name] = np.linalg.norm(away, axis=1).max()
    end = END_FRAME * radii[-1] * (COVERED if covered else 1.0)
    joints = {arm.links[joint.child]: r for joint, r in zip(arm.joints, radii, strict=True)}
    links = {name: LINK_FRAME * r for name, r in joints.items()}
    still = {"free": LINK_FRAME * radii[-1]}  # a tip that no joint moves
    assert lengths == pytest.approx(links | still | {"base": end, "left": end}, rel=1e-9)


def test_the_tool_frame_of_a_chain_moves_with_its_last_body():
    chain = pk.load("ur5e").chain()
    arm = arm_geometry(chain, ())
    q = np.array([0.4, -1.0, 0.7, 0.2, 0.9, -0.3])
    tool = arm.frames[-1]
    np.testing.assert_allclose(arm.poses(q)[tool.link] @ tool.pose, chain.fk(q), atol=1e-14)
    assert tool.link == len(chain.kinds)
    np.testing.assert_array_equal(arm.poses(q)[0], np.eye(4))


def test_a_glyph_shows_the_kind_of_its_joint():
    """Revolute: a hinge with its arc to one side. Prismatic: longer than wide, on the link that it
    moves. Helical: between them, on the link that carries it.
    """
    robot = odd_robot()
    scene = arm_scene(robot)
    glyphs = {
        node.attachment.name: node
        for node in of_kind(scene.nodes, Triangles, "skeleton")
        if node.attachment.role == "joint"
    }
    assert set(glyphs) == {"turn", "slide", "thread", "<i>left\u202e", "right"}
    links = {name: robot.links[node.attachment.link] for name, node in glyphs.items()}
    assert links == {
        "turn": "base", "slide": "slid", "thread": "slid", "<i>left\u202e": "left", "right": "right",
    }  # fmt: skip
    ratios = {}
    for joint in arm_geometry(robot, ()).joints:
        node = glyphs[joint.name]
        here = node.attachment.link == joint.parent
        point, z = joint.child_point, joint.child_direction
        if here:
            point, z = joint.point, joint.direction
        along = (node.vertices - point) @ z
        across = np.linalg.norm(node.vertices - point - along[:, None] * z, axis=1)
        ratios[joint.name] = np.ptp(along) / across.max()
    assert ratios["turn"] < 1.5 < ratios["thread"] < 3.0 < ratios["slide"]


@pytest.mark.parametrize("pitch", [0.02, -0.02])
def test_the_glyph_of_a_helical_joint_has_the_hand_of_its_screw(pitch):
    """Its thread begins below for a right-handed one; the ends of the tube are the last vertices."""
    screw = pk.screw.helical([0, 0, 1], [0, 0, 0], pitch)
    scene = arm_scene(pk.Chain.from_space([screw], pk.se3.exp([0, 0, 0, 1, 0, 0])))
    (glyph,) = (
        node
        for node in of_kind(scene.nodes, Triangles, "skeleton")
        if node.attachment.role == "joint"
    )
    start, end = glyph.vertices[-2:, 2]
    assert math.copysign(1.0, end - start) == math.copysign(1.0, pitch)


def test_the_table_numbers_the_axes_as_their_labels_do():
    scene = arm_scene(odd_robot())
    (table,) = scene.tables
    labels = [node.text for node in of_kind(scene.nodes, Label, "axes")]
    assert [row[0] for row in table.rows] == labels == ["A1", "A2", "A3", "A4", "A5"]


def test_the_rail_of_a_prismatic_joint_reaches_over_its_limits():
    robot = odd_robot()
    arm = arm_geometry(robot, ())
    slide = next(joint for joint in arm.joints if joint.name == "slide")
    bones = of_kind(arm_scene(robot).nodes, Triangles, "skeleton")
    (rail,) = (
        n for n in bones if n.attachment.role == "first" and n.attachment.link == slide.parent
    )
    along = (rail.vertices - slide.point) @ slide.direction
    assert 0.4 < along.max() < 0.42


@pytest.mark.parametrize("size", [0.5, 1.0, 2.0])
@pytest.mark.parametrize(("limit", "end"), [(20.0, 20.0), (np.nextafter(20.0, 21.0), 0.5)])
def test_a_rail_is_drawn_up_to_twenty_sizes_of_the_arm(limit, end, size):
    limit, end = size * limit, size * end
    slide = pk.Joint("slide", "prismatic", "base", "cart", axis=(1, 0, 0), limits=(-limit, limit))
    (joint,) = arm_geometry(pk.Robot("cart", ["base", "cart"], [slide]), ()).joints
    low, high = skeleton._rail(joint, size)
    assert (low.tolist(), high.tolist()) == ([-end, 0, 0], [end, 0, 0])


def test_a_rail_without_limits_is_as_long_as_the_arm():
    """So are limits of a kilometre, which stand for none."""
    for limits in ((-math.inf, math.inf), (-1e3, 1e3)):
        slide = pk.Joint("slide", "prismatic", "base", "cart", axis=(1, 0, 0), limits=limits)
        arm = pk.Joint("turn", "revolute", "cart", "arm", pk.se3.exp([0, 0, 0, 0, 0, 1]))
        scene = arm_scene(pk.Robot("cart", ["base", "cart", "arm"], [slide, arm]))
        (rail,) = (
            node
            for node in of_kind(scene.nodes, Triangles, "skeleton")
            if node.attachment.role == "first" and node.attachment.link == 0
        )
        assert scene.size == 1.0
        assert 1.0 < np.ptp(rail.vertices[:, 0]) < 1.05


def test_sliders_have_the_names_units_and_limits_of_the_coordinates():
    scene = arm_scene(odd_robot())
    assert scene.arms[0].coordinates == (
        Slider("slide", "m", 0.1, 0.4),
        Slider("turn", "rad", -1.0, 2.0),
        Slider("thread", "rad", -math.inf, math.inf),
        Slider("<i>left\u202e", "m", 0.0, 0.05),
    )
    np.testing.assert_array_equal(scene.q, [0.25, 0.0, 0.0, 0.0])


@given(chains(limits=True))
def test_a_page_of_a_chain_opens_within_its_limits(chain):
    arm = arm_geometry(chain, ())
    q = opening_q(arm.sliders)
    low, high = chain.limits.T
    assert (low <= q).all()
    assert (q <= high).all()
    assert (q[(low <= 0) & (high >= 0)] == 0).all()
    assert [slider.unit == "rad" for slider in arm.sliders] == [
        chain.is_angle(k) for k in range(chain.dof)
    ]


@pytest.mark.parametrize(
    ("bounds", "opening"),
    [
        ((0.5, math.inf), 0.5),
        ((-math.inf, -0.5), -0.5),
        ((0.25, 1.0), 0.625),
        ((-1.0, -0.25), -0.625),
        ((0.0, 1.0), 0.0),
        ((-1.0, 0.0), 0.0),
    ],
)
def test_a_slider_opens_at_zero_or_in_the_middle_or_at_its_only_bound(bounds, opening):
    assert opening_q((Slider("q", "rad", *bounds),)).tolist() == [opening]


def test_a_slider_has_the_unit_of_the_joint_that_its_coordinate_moves():
    screws = [pk.screw.prismatic([1, 0, 0]), pk.screw.revolute([0, 1, 0], [0, 0, 0.2])]
    arm = pk.Chain(np.array(screws), np.eye(4), frame="space", coupling=[[0, 1], [1, 0]])
    assert [slider.unit for slider in chain_geometry(arm).sliders] == ["rad", "m"]


def test_a_table_rounds_to_six_decimals():
    screw = pk.screw.revolute([0, 0, 1], [1.26e-5, 0.1234564, 0])
    chain = pk.Chain.from_space([screw], np.eye(4))
    (row,) = arm_scene(chain).tables[0].rows
    assert row[4] == "1.3e-05, 0.12346, 0"


def test_a_page_can_open_beyond_the_limits_and_says_so():
    scene = arm_scene(odd_robot(), q=[0.5, 0.0, 0.0, 0.0])
    assert scene.arms[0].coordinates[0] == Slider("slide", "m", 0.1, 0.5)
    assert "The page opens beyond the limits of 'slide'." in scene.words


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"q": [0, 0]}, ShapeError, "expected 4 coordinates"),
        ({"q": [0, 0, 0, math.nan]}, InputError, "one finite configuration"),
        ({"q": {"slied": 0}}, UnknownName, "no coordinate 'slied'"),
        ({"tip": "lefft"}, UnknownName, "did you mean 'left'"),
        ({"cloud": -1}, InputError, "cloud"),
    ],
)
def test_what_cannot_be_shown_is_refused(options, error, words):
    with pytest.raises(error, match=words):
        arm_scene(odd_robot(), **options)


def test_a_chain_has_its_own_tip():
    with pytest.raises(
        InputError, match=r"^tip: a chain has its own, 'tool0'; got 'wrist_1_link'$"
    ):
        arm_scene(pk.load("ur5e").chain(), tip="wrist_1_link")
    with pytest.raises(InputError, match="expected a Chain"):
        arm_scene("ur5e")  # type: ignore[arg-type]


def test_the_table_holds_the_screws_of_the_chain():
    """Five digits of numbers up to 1 m: within 5e-6."""
    chain = odd_robot().chain(tip="left")
    for rows in (arm_scene(chain).tables[0].rows, arm_scene(odd_robot()).tables[0].rows):
        by_name = {row[1]: row for row in rows}
        for k, name in enumerate(["turn", "slide", "thread"]):
            _, _, kind, w, place, v, pitch = by_name[name]
            shown = [float(x) for x in f"{w}, {v}".split(", ")]
            np.testing.assert_allclose(shown, chain.screws[k], rtol=0, atol=5e-6)
            assert kind == chain.kinds[k]
            if kind == "prismatic":
                assert (place, pitch) == ("none", "∞")
            else:
                found = pk.screw.axis_of(chain.screws[k])
                assert found.point is not None
                point = [float(x) for x in place.split(", ")]
                np.testing.assert_allclose(point, found.point, rtol=0, atol=5e-6)
                assert float(pitch) == pytest.approx(found.pitch, abs=5e-7)


def test_names_are_kept_as_data_and_shown_without_control_characters():
    scene = arm_scene(odd_robot())
    assert scene.title == "odd <b>"
    assert scene.arms[0].coordinates[3].name == "<i>left\u202e"
    texts = [node.text for node in of_kind(scene.nodes, Label, "labels")]
    assert "<i>left\\u202e" in texts
    assert any("<i>left\\u202e" in row for row in scene.tables[0].rows)


def columns(scene: Scene, rule: str) -> list[int]:
    return [node.attachment.index for node in scene.nodes if node.attachment.rule == rule]


def test_each_coordinate_of_the_largest_tip_has_its_columns():
    scene = arm_scene(odd_robot())
    largest = max(len(tip.coordinates) for tip in scene.arms[0].tips)
    assert largest == 4
    for rule in ("column_v", "column_w"):
        assert columns(scene, rule) == [0, 1, 2, 3]
    for rule in ("ellipsoid_v", "ellipsoid_w", "singular", "target"):
        assert columns(scene, rule) == [0]


def test_unit_geometry_is_of_unit_size():
    scene = arm_scene(pk.load("ur5e"))
    for node in scene.nodes:
        if not isinstance(node, Triangles):
            continue
        if node.attachment.rule in ("column_v", "column_w", "singular"):
            assert node.vertices[:, 2].min() == 0.0
            assert node.vertices[:, 2].max() == 1.0
        elif node.attachment.rule in ("ellipsoid_v", "ellipsoid_w"):
            np.testing.assert_allclose(np.linalg.norm(node.vertices, axis=1), 1.0, rtol=1e-15)


def test_a_singular_opening_is_said_in_words():
    arm = pk.load("ur5e").chain()
    said = " ".join(arm_scene(arm, q=np.zeros(6)).words)
    assert "'tool0' where the page opens: singular" in said
    away = [0.3, -1.0, 1.2, -0.7, 1.1, 0.2]
    assert "singular" not in " ".join(arm_scene(arm, q=away).words)


@pytest.mark.parametrize("straight", ["left", "right"])
def test_of_two_arms_the_one_that_is_shown_is_said_to_be_singular_where_it_is(straight):
    step = pk.se3.exp([0, 0, 0, 0.3, 0, 0])
    joints = []
    for side in ("left", "right"):
        above = "body"
        for k in range(4):
            kind = "revolute" if k < 3 else "fixed"
            link = f"{side} {k + 1}"
            joints.append(pk.Joint(link, kind, above, link, step, (0, 0, 1), limits=(-3, 3)))
            above = link
    robot = pk.Robot("two arms", ["body", *(joint.child for joint in joints)], joints)
    q = [0, 0, 0, 0.2, 0.7, 0.9] if straight == "left" else [0.2, 0.7, 0.9, 0, 0, 0]
    for side in ("left", "right"):
        said = " ".join(arm_scene(robot, q=q, tip=f"{side} 4").words)
        assert (f"'{side} 4' where the page opens: singular" in said) == (side == straight)


def test_a_cloud_holds_points_that_the_tip_reaches():
    arm = pk.load("ur5e").chain()
    (cloud,) = of_kind(arm_scene(arm, cloud=50).nodes, Cloud, "cloud")
    q = arm.random(0, size=50)
    np.testing.assert_array_equal(cloud.points, arm.fk(q)[:, :3, 3])
    np.testing.assert_array_equal(cloud.values, pk.manipulability(arm, q).translation.yoshikawa)
    scene = arm_scene(arm, cloud=50)
    assert "cloud" in scene.shown
    assert scene.words[2].startswith("Cloud: 50 points that 'tool0' reaches")


def test_the_cloud_of_a_floating_robot_is_where_the_floating_joint_is_zero():
    robot = pk.Robot(
        "drone",
        ["world", "body", "hand"],
        [
            pk.Joint("fly", "floating", "world", "body", pk.se3.exp([0, 0, 0, 0, 0, 1])),
            pk.Joint("turn", "revolute", "body", "hand", pk.se3.exp([0, 0, 0, 0.1, 0, 0])),
        ],
    )
    scene = arm_scene(robot, cloud=3)
    (cloud,) = of_kind(scene.nodes, Cloud, "cloud")
    assert cloud.attachment.link is None
    np.testing.assert_allclose(cloud.points, [[0.1, 0, 1]] * 3, atol=1e-15)
    assert "Floating and planar joints are at zero: 'fly'." in scene.words


def test_a_floating_robot_has_the_coupled_readings_that_it_had():
    step = pk.se3.exp([0, 0.3, 0, 0.4, 0, 0])
    robot = pk.Robot(
        "drone",
        ["world", "body", "upper", "hand"],
        [
            pk.Joint("fly", "floating", "world", "body"),
            pk.Joint("J1", "revolute", "body", "upper", step, limits=(-2, 2)),
            pk.Joint("J2", "revolute", "upper", "hand", step, limits=(-2, 2)),
        ],
    ).coupled("J2 = J1 + J2")
    q = [0.3, 0.5]
    np.testing.assert_allclose(tip_chain(robot, "hand").fk(q), robot.fk(q)["hand"], atol=1e-15)


def test_a_tip_that_nothing_moves_leaves_the_others_their_jacobians():
    scene = arm_scene(pk.load("panda"), tip="panda_link0", meshes=False)
    assert scene.arms[0].tips[0].coordinates == ()
    assert len(columns(scene, "column_v")) == 8


@pytest.mark.parametrize("model", ["chain", "robot"])
def test_a_model_that_does_not_move_is_drawn_all_the_same(model):
    robot = pk.Robot("post", ["base", "top"], [pk.Joint("weld", "fixed", "base", "top")])
    scene = arm_scene(robot if model == "robot" else robot.chain())
    assert scene.size == 1.0
    assert scene.arms[0].coordinates == ()
    assert columns(scene, "column_v") == []


def test_the_joints_of_fingers_are_drawn_smaller_than_those_of_arms():
    robot = pk.load("erd:romeo")
    glyphs = [
        node
        for node in of_kind(arm_scene(robot).nodes, Triangles, "skeleton")
        if node.attachment.role == "joint"
    ]
    sizes = {node.attachment.name: np.ptp(node.vertices, axis=0).max() for node in glyphs}
    assert sizes["LShoulderPitch"] > 2 * sizes["LFinger12"]


BOXED = """<robot name="boxed">
  <link name="base"><visual><geometry><box size="0.2 0.4 0.6"/></geometry></visual>
    <visual><geometry><mesh filename="package://nowhere/lid.stl"/></geometry></visual></link>
  <link name="arm">
    <visual><geometry><mesh filename="package://nowhere/arm.stl"/></geometry></visual>
    <visual><geometry><mesh filename="package://nowhere/cover.stl"/></geometry></visual>
  </link>
  <link name="tip"/>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><origin xyz="0 0 0.3"/>
  </joint>
  <joint name="end" type="fixed">
    <parent link="arm"/><child link="tip"/><origin xyz="1 0 0"/>
  </joint>
</robot>"""


def test_a_link_whose_mesh_is_not_found_is_a_bone_and_is_named():
    robot = pk.from_text(BOXED)
    scene = arm_scene(robot)
    bodies = of_kind(scene.nodes, Triangles, "meshes")
    assert [robot.links[node.attachment.link] for node in bodies] == ["base", "arm"]
    np.testing.assert_allclose(np.ptp(bodies[0].vertices, axis=0), [0.2, 0.4, 0.6], rtol=1e-15)
    bone = bodies[1].vertices[:, 0]
    assert bone.min() < 0.0
    assert bone.max() > 1.0  # from the joint to the tip
    (said,) = (words for words in scene.words if words.startswith("Not drawn"))
    names = "', 'package://nowhere/".join(["lid.stl", "arm.stl", "cover.stl"])
    assert f"'package://nowhere/{names}': no package" in said
    assert "meshes" in scene.shown
    assert "skeleton" not in scene.shown


def test_the_size_of_a_scene_covers_its_bodies():
    """The box of the base reaches 0.1, 0.2 and 0.3 m behind, aside and below, the tip 1 m ahead."""
    robot = pk.from_text(BOXED)
    assert arm_scene(robot).size == pytest.approx(math.hypot(1.1, 0.4, 0.6), rel=1e-14)
    bare = arm_scene(robot, meshes=False)
    assert bare.size == pytest.approx(math.hypot(1.0, 0.3), rel=1e-14)
    assert not of_kind(bare.nodes, Triangles, "meshes")
    assert not any(words.startswith("Not drawn") for words in bare.words)


def test_many_shapes_that_are_not_drawn_for_one_reason_make_one_sentence():
    lost = [LeftOut("arm", "a:1", f"'m{k}.stl'", "no such file") for k in range(9)]
    words = left_out_words([*lost, LeftOut("", "a", "9 triangles are drawn as 3", "1 mm off")])
    assert words == [
        "9 triangles are drawn as 3: 1 mm off.",
        "Not drawn: 'm0.stl', 'm1.stl', 'm2.stl', 'm3.stl', 'm4.stl', 'm5.stl' and 3 more: "
        "no such file.",
    ]


@pytest.mark.parametrize(
    ("kind", "radius"), [("prismatic", 0.02), ("revolute", 0.06), ("helical", 0.06)]
)
def test_the_glyph_of_a_slide_is_as_wide_as_its_way_and_no_other_glyph_is(kind, radius):
    """Its radius is half the way, where its neighbours leave more room."""
    joints = [
        pk.Joint("turn", "revolute", "base", "post"),
        pk.Joint(
            "slide",
            kind,
            "post",
            "cart",
            pk.se3.exp([0, 0, 0, 1, 0, 0]),
            limits=(-0.01, 0.03),
            pitch=0.1 * (kind == "helical"),
        ),
        pk.Joint("tilt", "revolute", "cart", "arm", pk.se3.exp([0, 0, 0, 0, 1, 0])),
    ]
    arm = arm_geometry(pk.Robot("cart", ["base", "post", "cart", "arm"], joints), ())
    assert glyph_radii(arm, np.zeros(2 + 1), 1.5)[1] == radius


@pytest.mark.parametrize("size", (0.1, 2.0))
def test_of_joints_that_stand_close_together_the_glyphs_are_a_share_of_the_arm(size):
    """The same picture of an arm of any size: 0.006 of it, where the room is less."""
    places = [[0, 0, 0], [0.011 * size, 0, 0], [0.5 * size, 0, 0], [size, 0, 0]]
    screws = [pk.screw.revolute([0, 0, 1], place) for place in places]
    chain = pk.Chain.from_space(screws, pk.se3.pose(np.eye(3), [size, 0, 0]))
    radii = glyph_radii(chain_geometry(chain), np.zeros(4), size)
    assert radii[:2] == pytest.approx([0.006 * size] * 2)
    # and where all stand together
    places = [[0.011 * size * k, 0, 0] for k in range(4)]
    screws = [pk.screw.revolute([0, 0, 1], place) for place in places]
    chain = pk.Chain.from_space(screws, pk.se3.pose(np.eye(3), [size, 0, 0]))
    radii = glyph_radii(chain_geometry(chain), np.zeros(4), size)
    assert radii == pytest.approx([0.006 * size] * 4)


@pytest.mark.parametrize(("length", "bones"), [(1e-4, 1), (1e-2, 2)])
def test_a_bone_shorter_than_a_millionth_of_the_arm_is_not_drawn(length, bones):
    """Of an arm of a kilometre, 1 mm."""
    far = pk.se3.exp([0, 0, 0, 1000, 0, 0])
    near = pk.se3.exp([0, 0, 0, 0, length, 0])
    joints = [
        pk.Joint("a", "revolute", "base", "long", far),
        pk.Joint("b", "revolute", "long", "short", near),
    ]
    scene = arm_scene(pk.Robot("mast", ["base", "long", "short"], joints))
    found = of_kind(scene.nodes, Triangles, "skeleton")
    assert len([node for node in found if node.attachment.role == "first"]) == bones


def test_a_cloud_has_a_million_points_at_most():
    with pytest.raises(
        InputError, match=r"^cloud: expected at most 1000000 points, got 1000000000000$"
    ):
        arm_scene(odd_robot(), cloud=10**12)
