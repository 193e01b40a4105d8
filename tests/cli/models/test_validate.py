"""`poekin validate`: 0 pass, 1 fail, 2 error."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest

from poekin.analysis.validate import BAR, ChainErrors, Validation
from poekin.cli import run
from poekin.cli.models import validate as command


def test_a_right_robot_passes(crane, poekin):
    code, out, err = poekin("validate", crane, "--samples", 5)
    assert (code, err) == (0, "")
    assert "crane" in out
    assert out.endswith("1 of 1 robots pass\n")


def test_json_has_every_chain(crane, as_json):
    document = as_json("validate", crane, "--samples", 5)
    assert document["passed"] is True
    (robot,) = document["robots"]
    assert {c["tip"]: c["joints"] for c in robot["chains"]} == {"hook": 3, "lamp": 1}
    assert all(c["worst"] <= robot["bar"] for c in robot["chains"])


def test_a_wrong_robot_fails_with_one_and_says_where(crane, poekin, monkeypatch):
    import dataclasses

    right = command.validate

    def wrong(*args, **options):
        v = right(*args, **options)
        row = dataclasses.replace(v.chains[0], body=1e-3)
        return dataclasses.replace(v, chains=(row, *v.chains[1:]))

    monkeypatch.setattr(command, "validate", wrong)
    code, out, _ = poekin("validate", crane, "--samples", 3)
    assert code == 1
    assert "FAIL" in out
    assert "root → hook is off by 0.001 R; worst at turn = " in out
    code, out, _ = poekin("validate", crane, "--samples", 3, "--json")
    assert code == 1
    assert json.loads(out)["passed"] is False


def test_the_table_and_the_lines_have_the_errors_and_notes_of_each_chain(capsys):
    rows = (
        ChainErrors("a", "b", 2, 2, 1.5, 1e-15, 2e-15, 3e-15, 4e-15),
        ChainErrors(
            "a",
            "c",
            1,
            1,
            1.5,
            5e-15,
            1e-3,
            3.3349e-15,
            math.inf,
            {"q": 0.25, "p": -1 / 3},
            "ends above 'x'",
        ),
        ChainErrors("a", "d", 0, 0, 1.5, 2.5e-14, 0.0, 0.0, 0.0),
        ChainErrors("a", "e", 1, 1, 1.5, 0.0, 0.0, 0.0, 0.0, {}, "starts below 'y'"),
    )
    results = [
        Validation("two", "", rows, BAR, 5, 0, "4"),
        Validation("one", "", rows[:1], BAR, 5, 0, "4"),
    ]
    command._show(results, 3, ["erd:ur3"])
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].endswith(" against Pinocchio, each ÷ R; the bar is 2e-14")
    assert [re.split(r" {2,}", line) for line in lines[3:5]] == [
        ["two", "FAIL", "a → c", "4", "2.5e-14", "0.001", "3.33e-15", "inf"],
        ["one", "pass", "a → b", "1", "1e-15", "2e-15", "3e-15", "4e-15"],
    ]
    assert lines[5:] == [
        "two: a → c is off by inf R (ends above 'x'); worst at q = 0.25, p = -0.333333333",
        "two: a → d is off by 2.5e-14 R; worst at home",
        "two: a → e starts below 'y'",
        "erd:ur3 is left out: there is no robot in it",
        "1 of 5 robots pass; 3 could not be validated",
    ]


def test_progress_says_which_chain_of_which_file_it_is_at(crane, poekin, monkeypatch):
    told = []
    monkeypatch.setattr(command.ProgressLine, "__call__", lambda _, *words: told.append(words))
    assert poekin("validate", crane, "panda", "--samples", 1)[0] == 0
    assert told[:2] == [
        (0, 2, f"{crane}: chain 0 of 2, hook"),
        (0, 2, f"{crane}: chain 1 of 2, lamp"),
    ]
    assert told[2][0] == 1
    assert told[2][2].startswith("panda: chain 0 of ")


def test_an_error_in_one_file_does_not_hide_the_others(crane, poekin, tmp_path):
    (tmp_path / "bad.urdf").write_text("<robot")
    code, out, err = poekin("validate", tmp_path / "bad.urdf", crane, "--samples", 3)
    assert code == 2
    assert out.endswith("1 of 2 robots pass; 1 could not be validated\n")
    assert err.startswith("poekin: error: ")
    assert len(err.splitlines()) == 1


def test_json_tells_of_a_file_that_cannot_be_read_and_does_not_pass(crane, poekin, tmp_path):
    bad = tmp_path / "bad.urdf"
    bad.write_text("<robot")
    code, out, err = poekin("validate", bad, crane, "--samples", 1, "--json")
    document = json.loads(out)
    assert (code, document["passed"], document["robots"][0]["passed"]) == (2, False, True)
    assert err == f"poekin: error: {document['errors'][str(bad)]}\n"


def test_what_pinocchio_refuses_is_one_message_with_its_reason(crane, tmp_path, capfd):
    path = tmp_path / "no-limit.urdf"
    path.write_text(
        Path(crane)
        .read_text()
        .replace('<limit lower="0" upper="1" effort="1" velocity="1"/></joint>', "</joint>")
    )
    assert run(["validate", str(path)]) == 2
    out, err = capfd.readouterr()
    assert out == "0 of 1 robots pass; 1 could not be validated\n"
    error = err.splitlines()[-1]
    assert error.startswith(f"poekin: error: {path}: Pinocchio refuses this URDF: ")
    assert "slide" in error
    assert "urdf_parser" not in err
    assert all(line.startswith("poekin: ") for line in err.splitlines())


def test_what_moves_above_a_floating_joint_is_validated_and_listed(tmp_path, as_json, poekin):
    path = tmp_path / "f.urdf"
    path.write_text(
        '<robot name="f"><link name="a"/><link name="b"/><link name="c"/><joint name="j" type="continuous">'
        '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint><joint name="k" type="floating">'
        '<parent link="b"/><child link="c"/></joint></robot>'
    )
    ways = [("c", "c", []), ("a", "b", ["j"])]
    document = as_json("info", path)
    assert [(c["base"], c["tip"], c["joint_names"]) for c in document["chains"]] == ways
    assert document["chains"][1]["note"] == "ends above the floating joint 'k'"
    assert poekin("info", path)[1].splitlines()[-1].split()[:3] == ["j", "revolute", "j"]
    (robot,) = as_json("validate", path, "--samples", 3)["robots"]
    assert [(c["base"], c["tip"], c["joints"]) for c in robot["chains"]] == [
        (b, t, len(j)) for b, t, j in ways
    ]


@pytest.mark.parametrize(("words", "message"), [([], "nothing to validate"), (["erd:no-such-robot"], "no-such-robot"),
                                                (["--samples", "-1", "panda"], "samples")])  # fmt: skip
def test_what_cannot_be_validated_is_an_error(poekin, words, message):
    code, _, err = poekin("validate", *words)
    assert code == 2
    assert message in err


def test_all_takes_every_robot_and_names_the_file_that_holds_none(poekin, monkeypatch):
    monkeypatch.setattr(command, "example_robots", lambda: ({"double_pendulum": ""}, {"ur3": ""}))
    code, out, _ = poekin("validate", "--all", "--samples", 2)
    assert code == 0
    assert "erd:ur3 is left out: there is no robot in it" in out
    assert out.endswith("1 of 1 robots pass\n")
