"""`poekin compare`: 0 equal, 1 differ, 2 error."""

from __future__ import annotations

import inspect
import json
import re
from pathlib import Path

import numpy as np
import pytest

from poekin.analysis.compare.compare import compare
from poekin.cli.models.compare import command
from poekin.formats.load import load

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
    assert poekin("compare", a, a, "--samples", 1)[0] == 0


def test_what_is_not_asked_for_is_compared_as_the_library_does():
    asked = inspect.signature(command).parameters
    defaults = inspect.signature(compare).parameters
    same = {"strict", "samples", "seed"}
    assert {name: asked[name].default for name in same} == {
        name: defaults[name].default for name in same
    }
    assert asked["tol_mm"].default == pytest.approx(1e3 * defaults["tol_position"].default)
    assert asked["tol_deg"].default == pytest.approx(np.degrees(defaults["tol_rotation"].default))


def test_a_different_model_is_one_and_is_said_in_words_and_json(tmp_path, poekin):
    a, b = written(tmp_path, "a.urdf", 0), written(tmp_path, "b.urdf", 0.02)
    code, out, err = poekin("compare", a, b)
    assert (code, err) == (1, "")
    assert "DIFFERS" in out
    code, out, _ = poekin("compare", a, b, "--json")
    assert code == 1
    document = json.loads(out)
    assert (document["equal"], len(document["joints"])) == (False, 3)
    assert document["a"] == {"file": a, "base": "a", "tip": "d"}
    assert document["b"] == {"file": b, "base": "a", "tip": "d"}
    assert poekin("compare", a, b, "--tol-mm", "50")[0] == 0


def test_the_table_and_the_pose_errors_are_those_of_the_comparison(tmp_path, poekin):
    a, b = written(tmp_path, "a.urdf", 0), written(tmp_path, "b.urdf", 0.02)
    text = Path(b).read_text()
    Path(b).write_text(text.replace('<axis xyz="1 0 0"/>', '<axis xyz="-1 0 0"/>'))
    result = compare(load(a).chain(), load(b).chain())
    lines = poekin("compare", a, b)[1].splitlines()
    for words, errors in (("as they stand", result.before), ("aligned", result.after)):
        (line,) = [line for line in lines if line.startswith(f"Pose error {words}: ")]
        assert errors is not None
        wanted = [
            1e3 * errors.worst_position,
            np.degrees(errors.worst_rotation),
            1e3 * errors.mean_position,
            np.degrees(errors.mean_rotation),
        ]
        numbers = [float(x) for x in re.findall(r"[-+.e\d]+(?= mm|°)", line)]
        assert numbers == pytest.approx(wanted, rel=5e-3, abs=1e-9)
    for joint in result.joints:
        (row,) = [line.split() for line in lines if joint.name_a in line and "revolute" in line]
        assert row[3] == ("DIFFERS" if joint.axis_differs else "same")
        assert ("flipped" in row) == joint.reversed
        shown = [
            np.degrees(joint.angle),
            1e3 * (joint.normal or 0.0),
            1e3 * (joint.shift or 0.0),
            np.degrees(joint.zero_offset),
        ]
        tiny = 1e-6 * 0.001  # what is far below tolerance is shown as 0
        values = [0.0 if abs(x) < tiny else x for x in shown]
        assert [float(x) for x in row[4 : 4 + len(values)]] == pytest.approx(values, rel=1e-3)


def test_strict_counts_the_frames(tmp_path, poekin):
    a = written(tmp_path, "a.urdf", 0)
    assert poekin("compare", a, a, "--strict")[0] == 0
    assert (
        poekin(
            "compare",
            a,
            a,
            "--tip",
            "d",
            "--tip-b",
            "d",
            "--base",
            "a",
            "--base-b",
            "a",
            "--strict",
        )[0]
        == 0
    )
    assert poekin("compare", "ur5e", "erd:ur5_robot", "--tip", "tool0", "--strict")[0] == 1


def test_a_tree_without_a_tip_is_refused_with_its_tips(crane, tmp_path, refused):
    assert "tips: 'hook', 'lamp'" in refused("compare", crane, crane)
    assert "--tip-b" in refused("compare", written(tmp_path, "a.urdf", 0), crane, "--tip", "d")


def test_what_cannot_be_used_is_refused(tmp_path, refused):
    a = written(tmp_path, "a.urdf", 0)
    assert "--tol-mm: expected a positive number" in refused("compare", a, a, "--tol-mm", "0")
    assert "nowhere.urdf" in refused("compare", a, str(tmp_path / "nowhere.urdf"))
    assert "elsewhere" in refused("compare", a, a, "--tip", "elsewhere")


def test_an_extra_joint_is_named(tmp_path, poekin):
    code, out, _ = poekin(
        "compare", "panda", "panda", "--tip", "panda_link7", "--tip-b", "panda_leftfinger"
    )
    assert code == 1
    assert "one joint more, 'panda_finger_joint1'" in out


CHANGED = URDF.replace('name="one" type="revolute"', 'name="uno" type="revolute"').replace(
    '<axis xyz="1 0 0"/>', '<axis xyz="-1 0.01 0"/>'
).replace("<limit lower=\"-1\" upper=\"1\"", "<limit lower=\"-0.5\" upper=\"1\"", 1)  # fmt: skip


@pytest.mark.filterwarnings("ignore:.*was normalised")
def test_the_table_has_the_numbers_of_the_function_in_the_order_of_its_heads(tmp_path, poekin):
    a, path = written(tmp_path, "a.urdf", 0), tmp_path / "b.urdf"
    path.write_text(
        CHANGED.format(x=0.02).replace('name="three"><link', 'name="other"><link'), encoding="utf-8"
    )
    b = str(path)
    code, out, _ = poekin(
        "compare", a, b, "--samples", 50, "--seed", 3, "--base", "a", "--tip", "c"
    )
    assert code == 1
    assert out.startswith("A: a → c; B: a → c\n\n")
    _, out, _ = poekin("compare", a, b, "--samples", 50, "--seed", 3)
    result = compare(load(a).chain(), load(b).chain(), samples=50, seed=3)
    lines = out.splitlines()
    at = next(i for i, line in enumerate(lines) if "angle (deg)" in line)
    assert lines[at].split("  ")[-1].strip() == "limits"
    titles, rows = ["one / uno", "two[b]", "three"], lines[at + 2 : at + 5]
    for title, joint, row in zip(titles, result.joints, rows, strict=True):
        words = [word.strip() for word in row.split("  ") if word.strip()]
        lengths = [
            f"{1e3 * x if abs(x) > 1e-11 else 0:.4g}"
            for x in (joint.normal or 0.0, joint.shift or 0.0)
        ]
        angle, zero, *ends = (
            f"{np.degrees(x) if abs(x) >= 1e-6 * result.tol_rotation else 0:.4g}"
            for x in (joint.angle, joint.zero_offset, *joint.limits)
        )
        assert words == [word for word in (
            str(joint.number), title, joint.kind_a, "DIFFERS" if joint.axis_differs else "same",
            angle, *lengths, f"{zero} deg", "flipped" if joint.reversed else "same", " ".join(ends),
        ) if word]  # fmt: skip
    assert any(joint.reversed for joint in result.joints)
    for title, errors in (("as they stand", result.before), ("aligned", result.after)):
        assert errors is not None
        assert (
            f"Pose error {title}: worst {1e3 * errors.worst_position:.3g} mm, {np.degrees(errors.worst_rotation):.3g}°;"
            f" mean {1e3 * errors.mean_position:.3g} mm, {np.degrees(errors.mean_rotation):.3g}°"
            in lines
        )
    assert lines[-1] == "The models differ"
    clauses = [text[0].upper() + text[1:] for text in result.findings]
    assert lines[-1 - len(clauses) : -1] == clauses


def test_a_tree_is_refused_by_the_name_of_its_file_and_the_option_that_helps(
    crane, tmp_path, refused
):
    said = f"'{crane}' is a tree: say which tip with {{}}; tips: 'hook', 'lamp'\n"
    assert refused("compare", crane, crane) == "poekin: error: " + said.format("--tip")
    assert refused(
        "compare", written(tmp_path, "a.urdf", 0), crane
    ) == "poekin: error: " + said.format("--tip-b")


def changed(tmp_path, name, *changes):
    """The robot with text replaced, as a file."""
    text = URDF.format(x=0)
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return str(path)


CHANGES = {
    "zero": ('xyz="0 0 0.3"', 'xyz="0 0 0.3" rpy="0 0.1 0"'),
    "limits": ('lower="-1"', 'lower="-0.9"'),
    "directions": ('<axis xyz="0 1 0"/>', '<axis xyz="0 -1 0"/>'),
    "names": ('name="two[b]"', 'name="due"'),
    "axis": ('xyz="0.1 0 0.3"', 'xyz="0.1 0.01 0.3"'),
}


@pytest.mark.parametrize("change, usual, word", [
    ("zero", 3, "zeros"), ("limits", 1, "limits"), ("directions", 3, "directions"), ("names", 0, "names"),
    ("axis", 1, ""),
])  # fmt: skip
def test_the_exit_code_counts_what_may_not_differ(tmp_path, poekin, change, usual, word):
    a = changed(tmp_path, "a.urdf")
    b = changed(tmp_path, "b.urdf", CHANGES[change])
    assert poekin("compare", a, b)[0] == usual
    every = "base,tool,zeros,directions,limits,names"
    assert poekin("compare", a, b, "--same", every)[0] == (usual or 3)
    # About another zero the same limits are others.
    free = {word, "limits"} if word == "zeros" else {word}
    others = ",".join(name for name in every.split(",") if name not in free)
    assert poekin("compare", a, b, "--same", others)[0] == (0 if word else 1)
    assert poekin("compare", a, b, "--same", "")[0] == (0 if word else 1)
    assert poekin("compare", a, b, "--strict", "--json")[0] == usual


def test_the_zero_that_is_elsewhere_is_named_in_strict_mode_too(tmp_path, poekin):
    a = changed(tmp_path, "a.urdf")
    b = changed(tmp_path, "b.urdf", CHANGES["zero"])
    for options in ((), ("--strict",)):
        code, out, _ = poekin("compare", a, b, *options)
        said, outcome = out.splitlines()[-2:]
        assert code == 3
        assert said.startswith("Joint 2 ('two[b]') has its zero 5.73° elsewhere: ")
        assert said.endswith(" mm at the tool")
        assert outcome == "The models are the same arm in other conventions"


@pytest.mark.parametrize("words, got", [("base,speed", "speed"), (",", ""), ("Base", "Base")])
def test_words_that_are_no_conventions_are_refused(tmp_path, refused, words, got):
    a = changed(tmp_path, "a.urdf")
    known = "'base', 'tool', 'zeros', 'directions', 'limits' or 'names'"
    said = f"poekin: error: --same: expected names out of {known}, got '{got}'\n"
    assert refused("compare", a, a, "--same", words) == said


def test_blanks_between_words_are_read(tmp_path, poekin):
    a = changed(tmp_path, "a.urdf")
    b = changed(tmp_path, "b.urdf", CHANGES["zero"])
    assert poekin("compare", a, b, "--same", " base , tool")[0] == 0
