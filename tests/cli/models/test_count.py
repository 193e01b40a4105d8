"""`poekin count`: the operation counts of a user's own arm."""

from __future__ import annotations

import json

import pytest

from poekin.analysis.counting.count_table import MEANING, count_table
from poekin.formats.load import load

NAMES = ["[bold]x[/bold]", "[/b]", "<b>&amp;", "\u202eevil", "%s{0}", "=1+1", "ü"]
URDF = """<robot name="{n}r"><link name="{n}root"/><link name="{n}mid"/><link name="{n}tip"/>
<joint name="{n}j" type="continuous"><parent link="{n}root"/><child link="{n}mid"/><axis xyz="0 0 1"/></joint>
<joint name="{n}k" type="continuous"><parent link="{n}mid"/><child link="{n}tip"/><axis xyz="0 1 0"/>
<origin xyz="0 0 1" rpy="0 0 0.00001"/></joint></robot>"""


def test_the_table_and_what_it_means_are_said(poekin):
    code, out, err = poekin("count", "panda", "--tip", "panda_hand")
    assert (code, err) == (0, "")
    lines = [" ".join(line.split()) for line in out.splitlines()]
    assert "POE, recursive: 42n - 78 and 30n - 57 body 216 153 0" in lines
    assert "DH, recursive on modified (Craig's) frames body 216 153 0 252 180 0" in lines
    heads = [
        lines.index(head)
        for head in ("Printed in the paper", "As the paper charges", "This arm's own program")
    ]
    assert heads == sorted(heads)
    assert lines[heads[-1] + 1] == "space Jacobian space 93 47 6 108 57 7"
    assert "an advantage of 78 multiplications and 57 additions over DH" in out
    assert "That is bookkeeping at the chain's two ends, not POE" in out
    assert "lowest" not in out
    assert "idealised" not in out


def test_the_idealised_arm_is_counted_with_what_that_costs(poekin, tmp_path):
    path = tmp_path / "rounded.urdf"
    path.write_text(URDF.format(n=""), encoding="utf-8")
    code, out, err = poekin("count", path, "--idealise", "1e-3")
    assert (code, err) == (0, "")
    assert "The idealised arm's own program" in out
    # the tip's rotation about the first axis, 1e-5 rad
    assert "The idealised arm's pose is within" in out
    assert "1e-05 rad of the arm's" in out


def test_every_count_is_in_its_column_and_every_heading_has_its_meaning(poekin, tmp_path):
    path = tmp_path / "rounded.urdf"
    path.write_text(URDF.format(n=""), encoding="utf-8")
    table = count_table(load(path).chain(), idealise=1e-3)
    lines = poekin("count", path, "--idealise", 1e-3)[1].splitlines()
    assert lines[0] == "Operations of one Jacobian of root → tip: 2 joints, 2 coordinates"
    rows = iter(" ".join(line.split()) for line in lines[4:])
    for group in table.groups:
        assert next(rows) == group[0].upper() + group[1:]
        for row in table.of(group):
            costs = [row.jacobian] + ([] if row.with_pose is None else [row.with_pose])
            numbers = [
                n for c in costs for n in (c.multiplications, c.additions, c.sine_cosine_pairs)
            ]
            assert next(rows) == " ".join([*row.what.split(), str(row.frame), *map(str, numbers)])
        assert f"{group[0].upper() + group[1:]}: {MEANING[group]}" in lines
    ideal = table.idealised
    assert ideal is not None
    assert ideal.changes
    at = lines.index(
        f"The idealised arm's pose is within {ideal.position_bound:.2g} m and {ideal.rotation_bound:.2g} rad of the"
        " arm's"
    )
    assert lines[at + 1 :] == [*(f"  {words}" for words in ideal.changes), *table.verdict]


def test_json_has_every_row(as_json):
    document = as_json("count", "ur5e", "--tip", "tool0", "--idealise", "1e-6")
    assert document["robot"] == "ur5e"
    assert document["joints"] == 6
    rows = {(r["group"], r["method"], r["frame"], r["counting"]): r for r in document["rows"]}
    assert (
        rows["as the paper charges", "recursive", "body", "paper"]["jacobian"]["multiplications"]
        == 174
    )
    body = rows["this arm's own program", "specialised", "body", "everything"]
    assert body["with_pose"]["sine_cosine_pairs"] == 6
    assert ("the idealised arm's own program", "specialised", "cheapest", "everything") in rows


def test_joints_that_slide_and_follow_are_counted(poekin, crane):
    code, out, err = poekin("count", crane, "--tip", "hook")
    assert (code, err) == (0, "")
    assert "3 joints, 2 coordinates" in out
    assert "Printed in the paper" not in out


def test_a_chain_without_joints_costs_nothing(as_json, crane):
    document = as_json("count", crane, "--base", "a", "--tip", "lamp")
    assert {row["with_pose"]["multiplications"] for row in document["rows"]} == {0}


@pytest.mark.parametrize("name", NAMES)
def test_a_hostile_name_is_shown_as_it_is_or_escaped(poekin, tmp_path, name):
    path = tmp_path / "hostile.urdf"
    path.write_text(
        URDF.format(n=name.replace("&", "&amp;").replace("<", "&lt;")), encoding="utf-8"
    )
    for words in ([], ["--json"], ["--idealise", "1e-3"]):
        code, out, err = poekin("count", path, *words)
        assert (code, err) == (0, "")
        shown = json.dumps(name)[1:-1] if words == ["--json"] else name.replace("\u202e", "\\u202e")
        assert shown in out
        assert "\u202e" not in out
        assert "\x1b" not in out


def test_a_bad_tolerance_tip_or_tree_is_refused(crane, refused):
    assert "tol" in refused("count", "ur5e", "--idealise", "2")
    assert "hook" in refused("count", crane)
    assert "hook" in refused("count", crane, "--tip", "hok")
