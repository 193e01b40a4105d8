"""`poekin info`: tree, chains, screws."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from poekin.cli.info import _screw_rows, tree
from poekin.formats.load import load
from poekin.model.joint import Joint
from poekin.model.robot import Robot


def test_the_tree_the_chains_and_the_screws(crane, poekin):
    code, out, err = poekin("info", crane)
    assert (code, err) == (0, "")
    assert out.startswith("crane: 5 links, 4 joints, 2 coordinates\n\nroot\n  turn (continuous) → a\n")
    assert "├ slide (prismatic) → b" in out
    assert "│ lower (prismatic = 0.5 × slide + 0.1) → hook" in out
    assert "└ bracket (fixed) → lamp" in out
    rows = {line.split()[0]: line.split() for line in out.splitlines() if line.strip()}
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
        f'<joint name="j{i}" type="fixed"><parent link="l{i}"/><child link="l{i + 1}"/></joint>' for i in range(3000)
    )
    path = tmp_path / "long.urdf"
    path.write_text(f'<robot name="long">{links}{joints}</robot>')
    code, out, _ = poekin("info", path)
    assert code == 0
    assert "  j2999 (fixed) → l3000\n" in out


def test_a_deep_fork_at_every_link_does_not_recurse():
    links = [f"{kind}{i}" for i in range(1201) for kind in "ls"]
    joints = [Joint(f"j{kind}{i}", "fixed", f"l{i}", f"{kind}{i + 1}") for i in range(1200) for kind in "ls"]
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
