"""`poekin dh`: any arm as a DH table on the terminal and as a file."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

import poekin as pk


def test_the_table_is_printed_with_base_tool_choices_error_and_bound(poekin):
    code, out, err = poekin("dh", "panda", "--tip", "panda_hand", "--convention", "modified")
    assert (code, err) == (0, "")
    assert (
        "modified DH parameters of panda_link0 → panda_hand: Rx(alpha) Tx(a) Rz(theta) Tz(d)" in out
    )
    row = next(line.split() for line in out.splitlines() if "panda_joint5" in line)
    assert row == [
        "5",
        "panda_joint5",
        "revolute",
        "3.14159265",
        "+",
        "x",
        "0.384",
        "0.0825",
        "1.57079633",
        "-2.8973",
        "2.8973",
    ]
    assert "Tool:" in out
    assert "Free choice: axes of 'panda_joint1' and 'panda_joint2' meet: x is along z x z'" in out
    result = pk.dh.from_chain(pk.load("panda").chain(tip="panda_hand"), convention="modified")
    assert (
        f"÷ reach (1.32 m): {result.error:.2g} over random configurations; at most {result.bound:.2g}\n"
        in out
    )
    assert "Warning" not in out


def test_json_is_the_table_and_what_is_said_about_it(as_json):
    document = as_json("dh", "panda", "--tip", "panda_hand", "--convention", "modified")
    assert (document["convention"], document["written"], document["warnings"]) == (
        "modified",
        None,
        [],
    )
    rows = [
        pk.dh.Row(**{**joint, "limits": tuple(joint["limits"])}) for joint in document["joints"]
    ]
    table = pk.dh.Table("modified", rows, base=document["base_pose"], tool=document["tool_pose"])
    chain = pk.load("panda").chain(tip="panda_hand")
    q = chain.random(0, 20)
    np.testing.assert_allclose(pk.dh.to_chain(table).fk(q), chain.fk(q), rtol=0, atol=1e-14)
    assert document["error"] <= document["bound"] < 1e-13


def test_json_says_where_the_table_is(as_json, tmp_path):
    place = tmp_path / "ur5e.csv"
    assert as_json("dh", "ur5e", "-o", place)["written"] == str(place)
    assert len(pk.dh.read(place)) == 6


def test_the_words_have_the_numbers_of_the_function_and_x_stands_where_the_joint_moves(
    poekin, as_json
):
    chain = pk.load("stanford").chain()
    result = pk.dh.from_chain(chain, convention="standard")
    document = as_json("dh", "stanford")
    assert (document["base"], document["tip"], document["reach"]) == (
        chain.base,
        chain.tip,
        chain.reach,
    )
    assert (document["gauge"], document["error"], document["bound"]) == (
        list(result.gauge),
        result.error,
        result.bound,
    )
    code, out, _ = poekin("dh", "stanford")
    assert code == 0
    for i, (row, kind) in enumerate(zip(result.table.rows, chain.kinds, strict=True), 1):
        line = next(line for line in out.splitlines() if line.startswith(f"{i} "))
        nothing = result.bound * chain.reach
        theta, d, a, alpha = (
            f"{0.0 if abs(x) < nothing else x:.9g}" for x in (row.theta, row.d, row.a, row.alpha)
        )
        moving = [f"{theta} + x", d] if kind == "revolute" else [theta, f"{d} + x"]
        assert re.split(r"\s{2,}", line.strip())[:7] == [str(i), row.name, kind, *moving, a, alpha]
    assert "x are the joints' own values" not in out
    assert out.endswith(
        f"Pose error ÷ reach ({chain.reach:.3g} m): {result.error:.2g} over random configurations;"
        f" at most {result.bound:.2g}\n"
    )


def test_limits_base_and_tool_are_printed_where_there_are_such(poekin, tmp_path):
    T = pk.se3.exp([0, 0, np.pi / 2, 0.5, 0, 0.25])
    rows = [pk.dh.Row(a=0.3, limits=(-0.5, 1.25)), pk.dh.Row(d=0.2, alpha=0.7, kind="prismatic")]
    pk.dh.write(pk.dh.Table("standard", rows, base=T, name="two"), tmp_path / "two.csv")
    lines = poekin("dh", tmp_path / "two.csv")[1].splitlines()
    one, two = (
        re.split(r"\s{2,}", line.strip()) for line in lines if line.startswith(("1 ", "2 "))
    )
    assert one[-2:] == ["-0.5", "1.25"]
    assert len(two) == len(one) - 2  # without limits
    found = pk.dh.from_chain(pk.load(tmp_path / "two.csv").chain(), convention="standard").table
    for what, T in (("Base:", found.base), ("Tool:", found.tool)):
        at = lines.index(what)
        shown = np.array([line.split() for line in lines[at + 1 : at + 5]], float)
        np.testing.assert_allclose(shown, T, atol=1e-9)
        assert (np.eye(4) != T).any()
        assert np.abs(shown[shown != 0]).min() > 1e-3  # what is rounding is a zero
    assert "Base:" not in poekin("dh", "stanford")[1].splitlines()


@pytest.mark.parametrize("ending", ["toml", "csv"])
def test_the_file_is_a_model_that_can_be_read_again(tmp_path, poekin, ending):
    place = tmp_path / f"arm.{ending}"
    code, out, _ = poekin("dh", "ur5e", "--tip", "tool0", "--output", place)
    assert code == 0
    assert out.endswith(f"\nTable of 'ur5e' written to '{place}'\n")
    chain, again = pk.load("ur5e").chain(tip="tool0"), pk.load(place).chain()
    q = chain.random(0, 20)
    np.testing.assert_allclose(again.fk(q), chain.fk(q), rtol=0, atol=1e-14)
    np.testing.assert_array_equal(again.limits, chain.limits)


def test_joints_without_limits_and_joints_that_follow_others(crane, poekin, as_json):
    code, out, _ = poekin("dh", crane, "--tip", "hook")
    assert code == 0
    assert "x are the joints' own values" in out
    assert "has no place" in out
    assert as_json("dh", crane, "--tip", "hook")["joints"][0]["limits"] == [None, None]


def test_an_ill_conditioned_table_is_warned_of(tmp_path, poekin):
    lean = 1e-5
    joint = (
        '<joint name="{0}" type="continuous"><parent link="{1}"/><child link="{2}"/>'
        '<origin xyz="{3} 0 0"/>{4}</joint>'
    )
    text = "".join([
        '<robot name="leaning">', *(f'<link name="{link}"/>' for link in "abc"),
        joint.format("one", "a", "b", 0, '<axis xyz="0 0 1"/>'),
        joint.format("two", "b", "c", 0.4, f'<axis xyz="{math.sin(lean)} 0 {math.cos(lean)}"/>'), "</robot>",
    ])  # fmt: skip
    place = tmp_path / "leaning.urdf"
    place.write_text(text, encoding="utf-8")
    code, out, _ = poekin("dh", place)
    assert code == 0
    assert "Warning: axes of 'one' and 'two' are nearly parallel, 1e-05 rad: d is 4e+04 m" in out


def test_what_cannot_be_is_refused(crane, refused, tmp_path):
    assert "hook" in refused("dh", crane)
    assert "'standard' or 'modified', got 'craig'" in refused(
        "dh", "panda", "--tip", "panda_hand", "--convention", "craig"
    )
    assert ".toml or .csv" in refused(
        "dh", "panda", "--tip", "panda_hand", "--output", tmp_path / "t.txt"
    )
    assert "No such file" in refused(
        "dh", "panda", "--tip", "panda_hand", "--output", tmp_path / "none" / "t.csv"
    )
    assert list(tmp_path.iterdir()) == [tmp_path / "crane.urdf"]
