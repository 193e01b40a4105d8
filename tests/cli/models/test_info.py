"""`poekin info`: tree, chains, screws."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from poekin.cli.models.info import _coordinate, _screw_rows, tree
from poekin.formats.load import load
from poekin.model.chain import Chain
from poekin.model.joint import Joint
from poekin.model.robot import Robot


def test_the_tree_the_chains_and_the_screws(crane, poekin):
    code, out, err = poekin("info", crane)
    assert (code, err) == (0, "")
    assert out.startswith(
        "crane: 5 links, 4 joints, 2 coordinates\n\nroot\n  turn (continuous) → a\n"
    )
    assert "├ slide (prismatic) → b" in out
    assert "│ lower (prismatic = 0.5 × slide + 0.1) → hook" in out
    assert "└ bracket (fixed) → lamp" in out
    screws = out.partition("\nLimits of")[0]
    rows = {line.split()[0]: line.split() for line in screws.splitlines() if line.strip()}
    assert rows["turn"][:9] == ["turn", "revolute", "turn", "0", "0", "1", "0", "0", "0"]
    assert rows["lower"][1:6] == ["prismatic", "0.5", "slide", "+", "0.1"]


def test_one_chain_with_its_home_pose(crane, poekin):
    code, out, _ = poekin("info", crane, "--tip", "hook")
    assert code == 0
    assert out.startswith("root → hook: 3 joints, 2 coordinates, reach ")
    assert "Home pose of hook in root (m)" in out


def test_json_has_every_number_to_the_last_bit(crane, as_json):
    document = as_json("info", crane)
    robot = load(crane)
    assert document["q_names"] == list(robot.q_names)
    for chain in document["chains"]:
        expected = robot.chain(tip=chain["tip"])
        np.testing.assert_array_equal(np.array(chain["screws"]).reshape(-1, 6), expected.screws)
        np.testing.assert_array_equal(chain["home"], expected.home)
    assert document["limits"][robot.q_names.index("turn")] == [None, None]
    one = as_json("info", crane, "--tip", "hook")
    assert one == document["chains"][0]


def test_json_says_of_every_joint_and_chain_what_the_robot_says(crane, as_json):
    document, robot = as_json("info", crane), load(crane)
    assert (document["robot"], document["root"], document["links"]) == (
        "crane",
        "root",
        list(robot.links),
    )
    assert [(j["name"], j["kind"], j["parent"], j["child"]) for j in document["joints"]] == [
        (j.name, j.kind, j.parent, j.child) for j in robot.joints
    ]
    assert [j["mimic"] for j in document["joints"]] == [
        None, None, {"joint": "slide", "multiplier": 0.5, "offset": 0.1}, None,
    ]  # fmt: skip
    assert [(c["base"], c["tip"]) for c in document["chains"]] == [
        ("root", "hook"),
        ("root", "lamp"),
    ]
    chain, said = robot.chain(tip="hook"), document["chains"][0]
    assert "note" not in said
    assert (said["reach"], said["joint_names"], said["kinds"], said["q_names"]) == (
        chain.reach, list(chain.joint_names), list(chain.kinds), list(chain.q_names),
    )  # fmt: skip
    assert (said["coupling"], said["offset"]) == (chain.coupling.tolist(), chain.offset.tolist())
    assert said["limits"] == [[None, None], [0, 1]]


def test_the_tables_of_chains_and_screws_have_the_numbers_of_the_robot(crane, poekin):
    _, out, _ = poekin("info", crane)
    lines, robot = out.splitlines(), load(crane)
    at = lines.index("Chains from root to leaf")
    for line, tip in zip(lines[at + 3 : at + 5], ("hook", "lamp"), strict=True):
        chain = robot.chain(tip=tip)
        assert line.split() == [
            "root",
            tip,
            str(len(chain.joint_names)),
            str(chain.dof),
            f"{chain.reach:.6g}",
        ]
    _, out, _ = poekin("info", crane, "--tip", "hook")
    chain, lines = robot.chain(tip="hook"), out.splitlines()
    assert lines[0] == f"root → hook: 3 joints, 2 coordinates, reach {chain.reach:.6g} m"
    at = lines.index("Screws (w; v) at home, seen from root (rad, m)")
    bounds = {"turn": ["-inf", "inf"], "slide": ["0", "1"], "lower": ["0", "1"]}
    for line, joint, S in zip(lines[at + 3 : at + 6], chain.joint_names, chain.screws, strict=True):
        words = line.split()
        assert words[0] == joint
        assert words[-8:] == [*(f"{x + 0.0:.6g}" for x in S), *bounds[joint]]
    matrix = [line.split() for line in lines[lines.index("Home pose of hook in root (m)") + 1 :]]
    np.testing.assert_allclose(np.array(matrix[:4], float), chain.home, rtol=1e-8)


def test_a_joint_s_coordinate_is_written_with_factor_and_offset():
    assert _coordinate(CHAIN, [(1.0, 0)], 0.0) == "a"
    assert _coordinate(CHAIN, [(-0.5, 1)], 0.1) == "-0.5 b + 0.1"
    assert _coordinate(CHAIN, [(1.0, 0), (2.0, 1)], 0.0) == "a + 2 b"
    assert _coordinate(CHAIN, [], 0.0) == "0"


CHAIN = Chain.from_space(
    np.tile([0, 0, 1.0, 0, 0, 0], (2, 1)), np.eye(4), q_names=["a", "b"], coupling=np.eye(2)
)


def test_a_joint_has_the_limits_of_the_coordinate_that_it_follows():
    limits = [[-1, 2], [-3, 4]]
    swapped = Chain.from_space(
        CHAIN.screws, np.eye(4), coupling=[[0, 1], [2, 0]], limits=limits, joint_names=["x", "y"]
    )
    assert [(row[0], row[2], row[-2:]) for row in _screw_rows(swapped)] == [
        ("x", "q2", ("-3", "4")), ("y", "2 q1", ("-1", "2")),
    ]  # fmt: skip
    both = Chain.from_space(
        CHAIN.screws, np.eye(4), coupling=[[1, 1], [0, 0]], offset=[0, 0.5], limits=limits
    )
    named = both.replace(coupling=np.ones((2, 2)), joint_names=["q1", "q2"])
    assert [row[-2:] for row in _screw_rows(named)] == [("-1", "2"), ("-3", "4")]
    rows = list(_screw_rows(both))
    assert [(row[2], row[-2:]) for row in rows] == [("q1 + q2", ("-1", "2")), ("0.5", ("0", "0"))]
    assert {len(row) for row in rows} == {11}


def drive(name, parent, kind, inside):
    ends = f'<parent link="{parent}"/><child link="{name}"/>'
    return f'<link name="{name}"/><joint name="j_{name}" type="{kind}">{ends}{inside}</joint>'


DRIVES = '<robot name="r"><link name="base"/>' + "".join([
    drive("a", "base", "continuous", '<limit effort="87" velocity="2.175"/>'),
    drive("b", "a", "fixed", '<limit effort="5" velocity="6"/>'),
    drive("c", "b", "continuous", '<limit effort="0" velocity="1.5"/><dynamics damping="3" friction="4"/>'),
    drive("d", "c", "continuous", ""),
    drive("e", "a", "continuous", '<limit effort="7" velocity="0"/><safety_controller k_velocity="9"/>'),
    "</robot>",
])  # fmt: skip
LIMITS = "Limits of velocity (rad/s or m/s) and effort (N m or N), inf where not known"


def test_velocity_and_effort_are_shown_of_the_joints_that_say_them(tmp_path, poekin):
    path = tmp_path / "r.urdf"
    path.write_text(DRIVES)
    for options, expected in (
        ((), [["j_a", "2.175", "87"], ["j_c", "1.5", "inf"], ["j_e", "inf", "7"]]),
        (("--tip", "d"), [["j_a", "2.175", "87"], ["j_c", "1.5", "inf"]]),
        (("--base", "c", "--tip", "d"), []),
    ):
        _, out, _ = poekin("info", path, *options)
        lines = out.splitlines()
        if not expected:
            assert LIMITS not in lines
            continue
        at = lines.index(LIMITS)
        assert lines[at + 1].split() == ["joint", "velocity", "effort"]
        assert [line.split() for line in lines[at + 3 : at + 3 + len(expected)]] == expected


def test_json_says_what_a_joint_s_drive_is(tmp_path, as_json):
    path = tmp_path / "r.urdf"
    path.write_text(DRIVES)
    document = as_json("info", path)
    a, _, c, d, e = document["joints"]
    assert [a[key] for key in ("velocity", "effort", "damping", "friction")] == [2.175, 87, 0, 0]
    assert [c[key] for key in ("velocity", "effort", "damping", "friction")] == [1.5, None, 3, 4]
    assert (d["velocity"], d["safety_controller"]) == (None, None)
    assert e["safety_controller"]["k_velocity"] == 9
    assert document["chains"][0]["velocity_limits"] == [2.175, 1.5, None]


def test_a_chain_below_a_floating_joint_says_so(tmp_path, crane, poekin):
    path = tmp_path / "floating.urdf"
    path.write_text(Path(crane).read_text().replace("continuous", "floating"))
    code, out, _ = poekin("info", path)
    assert code == 0
    assert "starts below the floating joint 'turn'" in out


def test_a_robot_that_is_one_link(tmp_path, poekin):
    path = tmp_path / "stone.urdf"
    path.write_text('<robot name="stone"><link name="stone"/></robot>')
    code, out, err = poekin("info", path)
    assert (code, err) == (0, "")
    assert out.startswith("stone: 1 links, 0 joints, 0 coordinates")


def test_a_very_long_chain_does_not_recurse(tmp_path, poekin):
    links = "".join(f'<link name="l{i}"/>' for i in range(3001))
    joints = "".join(
        f'<joint name="j{i}" type="fixed"><parent link="l{i}"/><child link="l{i + 1}"/></joint>'
        for i in range(3000)
    )
    path = tmp_path / "long.urdf"
    path.write_text(f'<robot name="long">{links}{joints}</robot>')
    code, out, _ = poekin("info", path)
    assert code == 0
    assert "  j2999 (fixed) → l3000\n" in out


def test_a_deep_fork_at_every_link_does_not_recurse():
    links = [f"{kind}{i}" for i in range(1201) for kind in "ls"]
    joints = [
        Joint(f"j{kind}{i}", "fixed", f"l{i}", f"{kind}{i + 1}")
        for i in range(1200)
        for kind in "ls"
    ]
    lines = list(tree(Robot("comb", links[:1] + links[2:], joints)))
    assert len(lines) == 2401
    assert lines[-1] == "  " + "└ js0 (fixed) → s1"


def test_screws_of_a_long_chain_ask_for_the_coupling_once():
    n = 50
    joints = [Joint(f"j{i}", "revolute", f"l{i}", f"l{i + 1}") for i in range(n)]
    chain = Robot("line", [f"l{i}" for i in range(n + 1)], joints).chain()
    asked = []

    class Counted:
        def __getattr__(self, name):
            asked.append(name)
            return getattr(chain, name)

    assert len(list(_screw_rows(Counted()))) == n  # type: ignore[arg-type]
    assert asked.count("coupling") == 1
