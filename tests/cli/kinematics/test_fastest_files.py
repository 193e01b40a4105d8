"""`poekin follow --fastest`: files for a controller, of a path of poses."""

from __future__ import annotations

import json

import numpy as np
import pytest
import yaml

import poekin as pk
from poekin.solve import motion

Q0 = [0.0, -1.2, 1.5, -1.8, -1.5, 0.0]
UR5E = ["follow", "ur5e", "--tip", "tool0", "--q0", ",".join(map(str, Q0))]
FASTEST = ["--fastest", "--acceleration", 5]


@pytest.fixture(scope="module")
def arm():
    return pk.load("ur5e").chain(tip="tool0")


@pytest.fixture(scope="module")
def T(arm):
    T_s0 = arm.fk(Q0)
    T_s1 = T_s0.copy()
    T_s1[:2, 3] += 0.2
    return motion.line(T_s0, T_s1, np.linspace(0, 1, 30))


@pytest.fixture
def given(T, tmp_path):
    motion.write_poses(tmp_path / "T.csv", T, "12")
    return ["--input", tmp_path / "T.csv", "--format", 12]


@pytest.fixture(scope="module")
def expected(arm, T):
    return pk.follow(arm, T, q0=Q0).time_optimal(5.0)


@pytest.mark.parametrize("suffix", [".csv", ".yaml", ".yml", ".json", ".script"])
def test_the_file_is_that_of_the_library(suffix, poekin, given, expected, tmp_path):
    out = tmp_path / f"t{suffix}"
    code, text, err = poekin(*UR5E, *given, *FASTEST, "-o", out)
    assert (code, err) == (0, "")
    lines = text.splitlines()
    assert lines[0] == f"trajectory written to '{out}'"
    assert lines[1:9] == expected.summary().splitlines()
    assert lines[9].startswith("30 of 30 poses reached")
    assert out.read_text() == expected.text_of(out)


def test_without_a_file_csv_is_printed_and_the_report_stands_on_stderr(poekin, given, expected):
    code, out, err = poekin(*UR5E, *given, *FASTEST)
    assert (code, out) == (0, expected.to_csv())
    assert err.startswith(f"poekin: {expected.duration:.6g} s, ")


def test_limits_are_those_that_are_given(poekin, arm, T, given, tmp_path):
    speed = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    words = ["--speed", ",".join(map(str, speed)), "--acceleration", "1,2,3,4,5,6", "--fastest"]
    code, _, _ = poekin(*UR5E, *given, *words, "--output", tmp_path / "t.yaml")
    expected = pk.follow(arm, T, q0=Q0).time_optimal([1, 2, 3, 4, 5, 6], speed=speed)
    assert code == 0
    assert (tmp_path / "t.yaml").read_text() == expected.to_joint_trajectory("yaml")
    assert expected.largest_speed.max() <= 0.6


def test_json_says_it_all_and_less_where_there_is_a_file(as_json, given, expected, tmp_path):
    result = as_json(*UR5E, *given, *FASTEST)
    assert (result["robot"], result["ok"], len(result["q"])) == ("ur5e", True, 30)
    found = result["trajectory"]
    assert found["times"] == expected.times.tolist()
    assert found["dq"] == expected.dq.tolist()
    assert found["duration"] == expected.duration
    out = tmp_path / "t.json"
    result = as_json(*UR5E, *given, *FASTEST, "--output", out)
    assert result["written"] == str(out)
    assert "q" not in result
    assert not {"q", "dq", "times"} & set(result["trajectory"])
    assert result["trajectory"]["duration"] == expected.duration
    assert set(json.loads(out.read_text())) == {"joint_names", "points"}


def test_what_it_writes_is_read_by_fk(poekin, given, expected, arm, tmp_path):
    poekin(*UR5E, *given, *FASTEST, "--output", tmp_path / "t.csv")
    code, _, err = poekin(
        "fk",
        "ur5e",
        "--tip",
        "tool0",
        "--input",
        tmp_path / "t.csv",
        "--output",
        tmp_path / "T.npy",
    )
    assert (code, err) == (0, "")
    np.testing.assert_array_equal(np.load(tmp_path / "T.npy"), arm.fk(expected.q))


def test_a_plot_is_of_the_trajectory(poekin, given, expected, tmp_path):
    pytest.importorskip("matplotlib")
    words = [*UR5E, *given, *FASTEST, "--output", tmp_path / "t.csv"]
    code, out, _ = poekin(*words, "--plot", tmp_path / "t.svg")
    assert code == 0
    assert f"joints drawn in '{tmp_path}/t.svg'" in out
    text = (tmp_path / "t.svg").read_text()
    assert motion.plot_joints(expected.q, expected.chain, times=expected.times) in text
    code, out, _ = poekin(*words, "--plot", tmp_path / "t.svg", "--json")
    assert "drawn" not in out


@pytest.mark.parametrize("more", [[], ["--json"]], ids=["words", "json"])
def test_a_path_that_breaks_gives_no_trajectory(more, poekin, T, tmp_path):
    T = T.copy()
    T[20:, 0, 3] = 5
    motion.write_poses(tmp_path / "T.csv", T, "12")
    words = ["--input", tmp_path / "T.csv", "--format", 12, *FASTEST]
    out = tmp_path / "t.yaml"
    code, text, err = poekin(*UR5E, *words, "--output", out, *more)
    assert code == 1
    assert "poses 20 to 29 not reached" in err
    assert err.endswith("poekin: no trajectory is made of a path that breaks\n")
    assert not out.exists()
    assert (json.loads(text)["trajectory"] is None) if more else (text == "")


def test_a_path_whose_branch_changes_gives_no_trajectory(poekin, T, tmp_path):
    motion.write_poses(tmp_path / "T.csv", T[[0, -1]], "12")
    words = ["--input", tmp_path / "T.csv", "--format", 12, *FASTEST, "--max-step", 1e-4]
    out = tmp_path / "t.yaml"
    code, text, err = poekin(*UR5E, *words, "--output", out)
    assert (code, text) == (1, "")
    assert "2 of 2 poses reached" in err
    assert "the branch changes before pose 1" in err
    assert err.endswith("poekin: no trajectory is made of a path that breaks\n")
    assert not out.exists()


def test_a_spline_beyond_a_limit_is_exit_code_1(poekin, tmp_path):
    slides = [pk.screw.prismatic([1, 0, 0]), pk.screw.prismatic([0, 1, 0])]
    table = pk.Chain.from_space(slides, np.eye(4), limits=[[0, 1], [0, 1]])
    (tmp_path / "table.urdf").write_text(pk.to_urdf(table))
    T = table.fk([[0, 0], [1, 0], [1, 1]])
    motion.write_poses(tmp_path / "T.csv", T, "12")
    words = ["--input", tmp_path / "T.csv", "--format", 12, "--task", "position", "--max-step", 2]
    out = tmp_path / "t.yaml"
    code, text, _ = poekin(
        "follow", tmp_path / "table.urdf", *words, *FASTEST, "--speed", 1, "--output", out
    )
    assert code == 1
    assert "leaves its limits by 0.125" in text
    assert len(yaml.safe_load(out.read_text())["joint_names"]) == 2


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--fastest"], "--fastest: expected together with --acceleration"),
        ([*FASTEST, "--duration", 2], "--fastest: expected without --duration"),
        (["--fastest", "--acceleration", "0"], "acceleration: expected positive numbers"),
        (["--fastest", "--acceleration", "nan"], "acceleration: expected positive numbers"),
        (["--fastest", "--acceleration", "inf"], "acceleration: expected numbers from 1e-09"),
        (["--fastest", "--acceleration", "1,2"], "--acceleration: 6 coordinates expected"),
        (["--fastest", "--acceleration", "five"], "--acceleration: number 1: a number expected"),
        ([*FASTEST, "--speed", "-1"], "speed: expected positive numbers"),
        ([*FASTEST, "--speed", "1,2,3"], "--speed: 6 coordinates expected"),
        ([*FASTEST, "--speed", "1e12"], "speed: expected numbers from 1e-09 to 1e+09"),
    ],
    ids=lambda x: " ".join(map(str, x)) if isinstance(x, list) else None,
)
def test_options_that_make_no_sense_are_refused_and_nothing_is_written(
    words, says, refused, given, tmp_path
):
    out = tmp_path / "t.csv"
    assert says in refused(*UR5E, *given, *words, "--output", out)
    assert not out.exists()


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("t.npy", "a name that ends in .csv or .yaml or .yml or .json or .script expected"),
        ("t", "a name that ends in .csv or .yaml or"),
        ("no/t.csv", "there is no directory"),
        ("T.csv", "it is the file of the poses"),
    ],
)
def test_a_place_that_is_none_is_refused(name, says, refused, given, tmp_path):
    before = given[1].read_bytes()
    assert says in refused(*UR5E, *given, *FASTEST, "--output", tmp_path / name)
    assert given[1].read_bytes() == before


@pytest.mark.parametrize("suffix", [".yaml", ".yml", ".script"])
def test_files_for_a_controller_need_fastest(suffix, refused, given, tmp_path):
    said = refused(*UR5E, *given, "--output", tmp_path / f"t{suffix}")
    assert "expected together with --fastest, which times it" in said
    assert not (tmp_path / f"t{suffix}").exists()


def test_an_arm_without_known_speeds_is_refused_with_their_names(refused, given, tmp_path):
    said = refused("follow", "ur5", *UR5E[4:], *given, *FASTEST, "--output", tmp_path / "t.csv")
    assert "speed: the model states no limit for 'shoulder_pan_joint', " in said


def test_a_script_for_another_arm_is_refused(refused, tmp_path):
    panda = pk.load("panda").chain(tip="panda_hand")
    T = panda.fk(np.linspace([0, -0.5, 0, -2, 0, 1.6, 0.8], [0.1, -0.5, 0, -2, 0, 1.6, 0.8], 5))
    motion.write_poses(tmp_path / "T.csv", T, "12")
    words = ["--input", tmp_path / "T.csv", "--format", 12, *FASTEST]
    out = tmp_path / "t.script"
    said = refused("follow", "panda", "--tip", "panda_hand", *words, "--output", out)
    assert "URScript: expected an arm with 6 revolute joints" in said
    assert not out.exists()


POSE = "0.4,0.1,0.5,0,3.1,0\n"
LOWER = "0.4,0.1,0.45,0,3.1,0\n"
SPOKEN_OF = {
    "one pose": (
        POSE,
        ["--speed", 1],
        "--input: with --fastest two poses or more expected, not all the same",
    ),
    "nothing moves": (
        POSE * 2,
        ["--speed", 1],
        "--input: with --fastest two poses or more expected, not all the same",
    ),
    "no speeds": (POSE + LOWER, [], "--speed: the model states no limit for 'shoulder_pan_joint'"),
    "a speed of 0": (POSE + LOWER, ["--speed", 0], "--speed: expected positive numbers"),
}


@pytest.mark.parametrize("case", SPOKEN_OF)
def test_a_refusal_speaks_of_the_option_and_not_of_the_library_s_parameter(case, refused, tmp_path):
    text, words, message = SPOKEN_OF[case]
    path, out = tmp_path / "T.csv", tmp_path / "t.yaml"
    path.write_text(text)
    model = tmp_path / "arm.urdf"
    model.write_text(pk.to_urdf(pk.load("ur5e")).replace('velocity="', 'velocity="0" was="'))
    said = refused(
        "follow",
        model,
        "--tip",
        "tool0",
        "--input",
        path,
        "--format",
        "ur",
        *FASTEST,
        *words,
        "-o",
        out,
    )
    assert said.startswith(f"poekin: error: {message}")
    assert not out.exists()
