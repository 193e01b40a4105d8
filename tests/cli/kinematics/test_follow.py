"""`poekin follow`: a path of poses in, joints and a report out."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict

import numpy as np
import pytest

import poekin as pk
from poekin.cli.output import as_json as as_json_text
from poekin.solve import motion

PANDA = ["follow", "panda", "--tip", "panda_hand"]
Q0 = np.array([0, -0.5, 0, -2.0, 0, 1.6, 0.8])


@pytest.fixture(scope="module")
def arm():
    return pk.load("panda").chain(tip="panda_hand")


@pytest.fixture(scope="module")
def T(arm):
    T_s0 = arm.fk(Q0)
    T_s1 = T_s0.copy()
    T_s1[1, 3] += 0.2
    return motion.line(T_s0, T_s1, np.linspace(0, 1, 50))


@pytest.fixture
def given(T, tmp_path):
    motion.write_poses(tmp_path / "T.csv", T, "12")
    return ["--input", tmp_path / "T.csv", "--format", 12]


def test_a_path_is_followed_and_its_joints_are_csv(poekin, arm, T, given):
    code, out, err = poekin(*PANDA, *given, "--q0", ",".join(map(str, Q0)))
    assert code == 0
    lines = out.splitlines()
    assert lines[0].split(",") == list(arm.q_names)
    q = np.array([line.split(",") for line in lines[1:]], float)
    np.testing.assert_allclose(arm.fk(q), T, rtol=0, atol=3e-9)
    assert np.abs(np.diff(q, axis=0)).max() < 0.1
    assert err.startswith("poekin: 50 of 50 poses reached, within ")


def test_without_limits_a_path_goes_beyond_them(poekin, crane, tmp_path):
    q = np.linspace([0.2, 0.9], [0.3, 1.1], 20)
    T = pk.load(crane).chain(tip="hook").fk(q)
    motion.write_poses(tmp_path / "beyond.csv", T, "12")
    words = ["follow", crane, "--tip", "hook", "--input", tmp_path / "beyond.csv", "--format", 12]
    code, out, _ = poekin(*words, "--q0", "0.2,0.9", "--no-limits")
    assert code == 0
    found = np.array([line.split(",") for line in out.splitlines()[1:]], float)
    np.testing.assert_allclose(found, q, rtol=0, atol=1e-8)
    assert poekin(*words, "--q0", "0.2,0.9")[0] == 1


def test_json_holds_the_whole_report(as_json, given):
    result = as_json(*PANDA, *given)
    assert result["ok"] is True
    assert (result["poses"], result["solved"], result["branch_switches"]) == (50, 50, [])
    assert result["largest_step"] < 0.1
    assert len(result["q"]) == 50
    assert result["words"][0].startswith("50 of 50")


def test_numbers_and_options_are_those_of_the_library(poekin, arm, T, given):
    speed, acceleration = np.linspace(0.05, 0.1, 7), 0.02
    words = [
        "--duration",
        2,
        "--speed",
        ",".join(map(str, speed)),
        "--acceleration",
        acceleration,
        "--seed",
        2,
    ]
    more = [
        "--q0",
        ",".join(map(str, Q0)),
        "--max-step",
        0.002,
        "--task",
        "position",
        "--no-limits",
    ]
    expected = pk.follow(
        arm, T, q0=Q0, times=np.linspace(0, 2, 50), speed=speed, acceleration=acceleration, max_step=0.002,
        task="position", limits=False, seed=2,
    )  # fmt: skip
    code, out, _ = poekin(*PANDA, *given, *words, *more, "--json")
    result = json.loads(out)
    assert (code, result["ok"]) == (1, False)
    assert [result[name] for name in ("robot", "base", "tip")] == [
        "panda",
        "panda_link0",
        "panda_hand",
    ]
    assert expected.speed_violations
    assert expected.acceleration_violations
    for name in ("q", "success", "reason", "position_error", "rotation_error"):
        assert result[name] == getattr(expected, name).tolist()
    for name in ("at_limits", "speed_violations", "acceleration_violations", "near_singular"):
        assert result[name] == json.loads(
            as_json_text([asdict(s) for s in getattr(expected, name)])
        )
    assert result["branch_switches"] == list(expected.branch_switches)
    assert result["largest_step"] == expected.largest_step
    assert result["words"] == expected.summary().splitlines()


@pytest.mark.parametrize("suffix", [".csv", ".npy", ".json"])
def test_joints_go_to_a_file_with_times(suffix, poekin, arm, given, tmp_path):
    out = tmp_path / f"q{suffix}"
    code, text, err = poekin(*PANDA, *given, "--duration", 2, "--speed", 3, "--output", out)
    assert (code, err) == (0, "")
    assert text.startswith(f"50 × q written to '{out}'\n50 of 50 poses reached")
    if suffix == ".csv":
        q, times = motion.read_joints(out, arm)
        np.testing.assert_array_equal(times, np.linspace(0, 2, 50))
    else:
        q = np.load(out) if suffix == ".npy" else np.array(json.loads(out.read_text())["q"])
    assert q.shape == (50, 7)


def test_a_speed_that_is_exceeded_is_exit_code_1_with_its_joint(poekin, given, tmp_path):
    words = [*given, "--q0", ",".join(map(str, Q0)), "--output", tmp_path / "q.npy"]
    code, out, _ = poekin(
        *PANDA, *words, "--duration", 0.1, "--speed", "1", "--acceleration", "1,1,1,1,1,1,1"
    )
    assert code == 1
    assert "exceeds its speed" in out
    assert "exceeds its acceleration" in out


def test_a_path_out_of_reach_is_exit_code_1_with_its_reason(poekin, T, tmp_path):
    T = T.copy()
    T[30:, 0, 3] = 5
    motion.write_poses(tmp_path / "T.csv", T, "7", quaternion="xyzw")
    words = ["--input", tmp_path / "T.csv", "--format", 7, "--quaternion", "xyzw"]
    code, _, err = poekin(*PANDA, *words)
    assert code == 1
    assert "poses 30 to 49 not reached" in err
    assert "unreachable: the target is farther than the arm's reach" in err
    code, out, _ = poekin(*PANDA, *words, "--json")
    assert code == 1
    assert json.loads(out)["success"] == [True] * 30 + [False] * 20


def test_a_row_of_nan_is_a_bad_target(poekin, T, tmp_path):
    T = T.copy()
    T[10] = np.nan
    np.save(tmp_path / "T.npy", T)
    code, out, _ = poekin(*PANDA, "--input", tmp_path / "T.npy", "--format", 16, "--json")
    assert code == 1
    result = json.loads(out)
    assert result["reason"][10] == "bad target"
    assert sum(result["success"]) == 49
    assert result["branch_switches"] == []


def test_a_plot_is_written(poekin, given, tmp_path):
    pytest.importorskip("matplotlib")
    code, out, _ = poekin(
        *PANDA, *given, "--output", tmp_path / "q.csv", "--plot", tmp_path / "q.svg"
    )
    assert code == 0
    assert f"joints drawn in '{tmp_path}/q.svg'" in out
    assert "panda_joint1 (rad)" in (tmp_path / "q.svg").read_text()


def test_a_plot_without_matplotlib_names_the_extra_and_writes_nothing(
    refused, given, tmp_path, monkeypatch
):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    message = refused(*PANDA, *given, "--output", tmp_path / "q.csv", "--plot", tmp_path / "q.svg")
    assert "pip install 'poekin[report]'" in message
    assert not (tmp_path / "q.csv").exists()


@pytest.mark.parametrize(
    ("call", "says"),
    [
        ([], "--input: a file of poses expected, got none"),
        (["--input", "T.csv"], "--format: expected one of matrix, quat"),
        (["--input", "T.csv", "--format", "7"], "--quaternion: the format 7 needs the order"),
        (
            ["--input", "T.csv", "--format", "12", "--plot", "q.png"],
            "a name that ends in .svg expected",
        ),
        (
            ["--input", "T.csv", "--format", "12", "--plot", "/no/q.svg"],
            "there is no directory",
        ),
        (
            ["--input", "T.csv", "--format", "12", "--output", "/no/q.csv"],
            "there is no directory '/no'",
        ),
    ],
    ids=["no-input", "no-format", "no-order", "plot", "plot-place", "output"],
)
def test_what_cannot_be_done_is_refused_at_once(call, says, refused):
    assert says in refused(*PANDA, *call)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--duration", "-1"], "--duration: expected a positive number, got -1"),
        (["--duration", "nan"], "--duration: expected a positive number, got nan"),
        (["--duration", "0"], "--duration: expected a positive number, got 0"),
        (["--speed", "1"], "--speed and --acceleration: expected together with --duration"),
        (["--acceleration", "1"], "--speed and --acceleration: expected together with --duration"),
        (["--duration", "1", "--speed", "0"], "speed: expected positive numbers"),
        (["--duration", "1", "--speed", "1,2"], "--speed: 7 coordinates expected"),
        (["--q0", "1"], "--q0: 7 coordinates expected"),
        (["--max-step", "0"], "--max-step: expected positive"),
    ],
    ids=lambda x: " ".join(x) if isinstance(x, list) else None,
)
def test_options_that_make_no_sense_are_refused(words, says, refused, given):
    assert says in refused(*PANDA, *given, *words)


@pytest.mark.parametrize("command", ["follow", "ik"])
def test_the_poses_are_not_written_over(command, refused, given):
    before = given[1].read_bytes()
    said = refused(command, *PANDA[1:], *given, "--output", given[1].parent / "." / "T.csv")
    assert "it is the file of the poses" in said
    assert given[1].read_bytes() == before
