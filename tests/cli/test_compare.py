"""`poekin compare`: 0 equal, 1 differ, 2 error."""

from __future__ import annotations

import json

URDF = """<robot name="three"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="one" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="two[b]" type="revolute"><parent link="b"/><child link="c"/><origin xyz="{x} 0 0.3"/><axis xyz="0 1 0"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="three" type="revolute"><parent link="c"/><child link="d"/><origin xyz="0.1 0 0.3"/><axis xyz="1 0 0"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


def written(tmp_path, name, x):
    path = tmp_path / name
    path.write_text(URDF.format(x=x), encoding="utf-8")
    return str(path)


def test_the_same_model_is_equal(tmp_path, poekin):
    a = written(tmp_path, "a.urdf", 0)
    code, out, err = poekin("compare", a, a)
    assert (code, err) == (0, "")
    assert out.endswith("The models are the same\n")
    assert "two[b]" in out


def test_a_different_model_is_one_and_is_said_in_words_and_json(tmp_path, poekin):
    a, b = written(tmp_path, "a.urdf", 0), written(tmp_path, "b.urdf", 0.02)
    code, out, err = poekin("compare", a, b)
    assert (code, err) == (1, "")
    assert "DIFFERS" in out
    code, out, _ = poekin("compare", a, b, "--json")
    assert code == 1
    document = json.loads(out)
    assert (document["equal"], len(document["joints"]), document["a"]["tip"]) == (False, 3, "d")
    assert poekin("compare", a, b, "--tol-mm", "50")[0] == 0


def test_strict_counts_the_frames(tmp_path, poekin):
    a = written(tmp_path, "a.urdf", 0)
    assert poekin("compare", a, a, "--strict")[0] == 0
    assert poekin("compare", a, a, "--tip", "d", "--tip-b", "d", "--base", "a", "--base-b", "a", "--strict")[0] == 0
    assert poekin("compare", "ur5e", "erd:ur5_robot", "--tip", "tool0", "--strict")[0] == 1


def test_a_tree_without_a_tip_is_refused_with_its_tips(crane, tmp_path, refused):
    assert "tips: 'hook', 'lamp'" in refused("compare", crane, crane)
    assert "--tip-b" in refused("compare", written(tmp_path, "a.urdf", 0), crane, "--tip", "d")


def test_what_cannot_be_used_is_refused(tmp_path, refused):
    a = written(tmp_path, "a.urdf", 0)
    assert "tol_mm" in refused("compare", a, a, "--tol-mm", "0")
    assert "nowhere.urdf" in refused("compare", a, str(tmp_path / "nowhere.urdf"))
    assert "elsewhere" in refused("compare", a, a, "--tip", "elsewhere")


def test_an_extra_joint_is_named(tmp_path, poekin):
    code, out, _ = poekin("compare", "panda", "panda", "--tip", "panda_link7", "--tip-b", "panda_leftfinger")
    assert code == 1
    assert "one joint more, 'panda_finger_joint1'" in out
