"""Where one model has a longer base or end, the option that leaves it out is named, and helps."""

from __future__ import annotations

import pytest

LINK = '<link name="{0}"/>'
FIXED = """<joint name="{0}" type="fixed"><parent link="{1}"/><child link="{2}"/>
<origin xyz="{3}" rpy="0.2 0 0"/></joint>"""
TURNS = """<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/><origin xyz="{3}" rpy="{4}"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="2" effort="1" velocity="1"/></joint>"""
ARM = [
    TURNS.format("one", "base", "l1", "0 0 0.3", "0 0 0"),
    TURNS.format("two", "l1", "l2", "0.1 0 0.2", "1 0.2 0"),
    TURNS.format("three", "l2", "l3", "0.3 0 0.1", "0.3 1 0"),
    TURNS.format("four", "l3", "tip", "0.2 0.1 0.1", "0.5 0 1"),
]


def written(tmp_path, name, more=(), links=()):
    """The robot of four joints with joints and links more."""
    every = ["base", "l1", "l2", "l3", "tip", *links]
    path = tmp_path / name
    body = "".join([*map(LINK.format, every), *more, *ARM])
    path.write_text(f'<robot name="r">{body}</robot>', encoding="utf-8")
    return str(path)


CASES = {
    "fixed base": ([FIXED.format("up", "world", "base", "0 0 0.8")], ["world"], "base"),
    "fixed end": ([FIXED.format("end", "tip", "flange", "0 0 0.1")], ["flange"], "tip"),
    "two joints in front": (
        [
            TURNS.format("lift", "floor", "torso", "0 0 0.5", "0 1 0"),
            TURNS.format("nod", "torso", "base", "0 0.1 0.5", "1 0 0"),
        ],
        ["floor", "torso"],
        "base",
    ),
    "a joint behind": ([TURNS.format("grip", "tip", "jaw", "0 0 0.1", "1 0 0")], ["jaw"], "tip"),
}


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("case", CASES)
def test_the_option_that_is_named_makes_the_models_the_same(tmp_path, poekin, case, swapped):
    more, links, link = CASES[case]
    pair = [written(tmp_path, "a.urdf"), written(tmp_path, "b.urdf", more, links)]
    option = f"--{link}-b"
    if swapped:
        pair.reverse()
        option = f"--{link}"
    code, out, _ = poekin("compare", *pair)
    assert code == (3 if "fixed" in case else 1)
    (line,) = [line for line in out.splitlines() if line.startswith("Remedy: ")]
    assert line.endswith(f"{option} {link}")
    assert line.startswith(f"Remedy: model {'a' if swapped else 'b'}: it")
    assert poekin("compare", *pair, option, link)[0] == 0


def test_where_no_link_helps_none_is_named(tmp_path, poekin):
    a = written(tmp_path, "a.urdf")
    b = written(tmp_path, "b.urdf")
    assert "Remedy" not in poekin("compare", a, b)[1]
    moved = written(tmp_path, "c.urdf", [FIXED.format("up", "world", "base", "0 0 0.8")], ["world"])
    other = written(tmp_path, "d.urdf", [FIXED.format("up", "world", "base", "0 0 0.7")], ["world"])
    code, out, _ = poekin("compare", moved, other)
    assert code == 3
    assert "Remedy" not in out
    assert "the base frame is moved" in out


def test_a_base_or_tip_of_a_counts_for_b_too_where_b_has_such_a_link(tmp_path, poekin):
    pair = []
    for name, height in (("a.urdf", "0.8"), ("b.urdf", "0.7")):
        stand = FIXED.format("up", "world", "base", f"0 0 {height}")
        hand = FIXED.format("end", "tip", "flange", f"0 0 {height}")
        pair.append(written(tmp_path, name, [stand, hand], ["world", "flange"]))
    assert poekin("compare", *pair)[0] == 3
    code, out, _ = poekin("compare", *pair, "--base", "base", "--tip", "tip")
    assert out.startswith("A: base → tip; B: base → tip\n")
    assert code == 0
    assert poekin("compare", *pair, "--base", "base", "--tip", "tip", "--base-b", "world")[0] == 3


def test_a_joint_in_the_middle_has_no_remedy(tmp_path, poekin):
    a = written(tmp_path, "a.urdf")
    text = (tmp_path / "a.urdf").read_text(encoding="utf-8")
    more = TURNS.format("extra", "l2", "m", "0 0 0", "0 0 0") + LINK.format("m")
    more = more.replace('<axis xyz="0 0 1"/>', '<axis xyz="1 0 0"/>')
    text = text.replace('<parent link="l2"/>', '<parent link="m"/>')
    (tmp_path / "b.urdf").write_text(text.replace("</robot>", more + "</robot>"), encoding="utf-8")
    code, out, _ = poekin("compare", a, str(tmp_path / "b.urdf"))
    assert code == 1
    assert "one joint more, 'extra'" in out
    assert "Remedy" not in out


def test_joints_that_differ_in_number_beyond_that_have_no_remedy(tmp_path, poekin):
    a = written(tmp_path, "a.urdf")
    code, out, _ = poekin("compare", a, "panda", "--tip-b", "panda_hand")
    assert code == 1
    assert "Remedy" not in out
    assert out.splitlines()[-1].startswith("The models differ: 4 joints against 7, and no 3 joints")


@pytest.mark.parametrize("swapped", [False, True])
def test_an_arm_and_a_model_without_joints_differ_and_no_option_helps(tmp_path, poekin, swapped):
    alone = tmp_path / "alone.urdf"
    alone.write_text('<robot name="r"><link name="base"/></robot>', encoding="utf-8")
    pair = [written(tmp_path, "a.urdf"), str(alone)]
    code, out, err = poekin("compare", *(pair[::-1] if swapped else pair))
    assert (code, err) == (1, "")
    assert "Remedy" not in out
    assert out.endswith("The models differ\n")
