"""`poekin calibrate`: measurements in, the calibrated arm, its uncertainty and a report out."""

from __future__ import annotations

import functools
import json
import os
import re
import shlex

import numpy as np
import pytest

import poekin as pk
from poekin.cli.calibration import calibrate as command
from poekin.cli.calibration.measured import MeasurementOptions, read
from poekin.cli.calibration.outputs import Outputs
from poekin.errors import PoekinWarning
from poekin.solve.calibration import Distances, Points, Poses, calibrate
from poekin.solve.calibration.measurements import data
from poekin.solve.calibration.measurements.simulated import simulated
from poekin.solve.calibration.report import changes, toml_io
from poekin.solve.calibration.report.summary import MOST_OUTLIERS

PANDA = pk.load("panda").chain(tip="panda_link8")
ARM = ["calibrate", "panda", "--tip", "panda_link8", "--folds", 2]


@pytest.fixture(scope="module")
def measured():
    return simulated(PANDA, 50, noise=(1e-4, 1e-4), outliers=0.05, seed=1)


@pytest.fixture
def csv(measured, tmp_path):
    path = tmp_path / "poses.csv"
    data.write(path, PANDA, measured.q, measured.measurements)
    return path


def test_the_summary_begins_with_data_kept_aside(poekin, measured, csv):
    code, out, err = poekin(*ARM, csv, "--loss", "huber")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0] == "panda, panda_link0 → panda_link8"
    assert lines[1].startswith("On held-out data, the median position error goes from ")
    assert lines[2].startswith("34 parameters, 50 measurements, converged in ")
    wrong = np.flatnonzero(measured.outliers) + 2
    assert f"Outliers: {csv}:{', '.join(map(str, wrong))}" in lines


@pytest.mark.skipif(not os.path.exists("/dev/fd"), reason="an open pipe has no name here")
def test_measurements_come_out_of_a_pipe_as_out_of_a_file(measured, csv):
    reading, writing = os.pipe()
    pipe = f"/dev/fd/{reading}"
    with open(reading), open(writing, "wb") as stream:
        stream.write(csv.read_bytes())
        stream.close()
        piped = read([pipe], PANDA, SAID)
    expected = read([str(csv)], PANDA, SAID)
    np.testing.assert_array_equal(piped.q, expected.q)
    for found in (piped, expected):
        assert isinstance(found.sets[0], Poses)
        np.testing.assert_array_equal(found.sets[0].T, measured.measurements.T)
    assert piped.sources == [f"{pipe}:{line}" for line in range(2, 52)]
    assert expected.sources == [f"{csv}:{line}" for line in range(2, 52)]


def test_every_output_holds_the_same_arm(poekin, measured, csv, tmp_path):
    outputs = [tmp_path / name for name in ("arm.toml", "arm.urdf", "arm.csv")]
    report = tmp_path / "arm.html"
    pytest.importorskip("matplotlib")
    words = [word for path in outputs for word in ("-o", path)]
    code, out, err = poekin(
        *ARM, csv, "--loss", "tukey", "--seed", 3, *words, "--report", report, "--dh", "modified"
    )
    assert (code, err) == (0, "")
    assert [line for line in out.splitlines() if line.startswith("written: ")] == [
        f"written: '{path}'" for path in (*outputs, report)
    ]
    found = toml_io.load(outputs[0])
    expected = calibrate(PANDA, measured.q, data.read(csv, PANDA)[1], loss="tukey", folds=2, seed=3)
    assert found.chain == expected.chain
    assert found.cross_validation is not None
    assert expected.cross_validation is not None
    np.testing.assert_array_equal(
        found.cross_validation.after.length, expected.cross_validation.after.length
    )
    q = PANDA.random(0, 20)
    for path in outputs:
        tip = "panda_link8" if path.suffix != ".csv" else None
        # the frames of a robot and a DH table are other numbers: rounding only
        np.testing.assert_allclose(
            pk.load(path).chain(tip=tip).fk(q), found.chain.fk(q), rtol=0, atol=1e-13
        )
    assert pk.dh.read(outputs[2]).convention == "modified"
    assert set(pk.load(outputs[1]).links) >= {"panda_hand", "panda_leftfinger"}
    page = report.read_text(encoding="utf-8")
    assert "<h1>Calibration of panda: panda_link0 to panda_link8</h1>" in page
    assert f"{csv}:{np.flatnonzero(measured.outliers)[0] + 2}</td>" in page


SAID = MeasurementOptions([], [], None, None, None, None, [])


def test_deviations_points_and_frames_reach_the_measurements_of_their_kind(tmp_path):
    sets = {
        "poses": simulated(PANDA, 3, seed=1),
        "points": simulated(PANDA, 4, kind="points", points=[[0, 0, 0.1], [0, 0.2, 0.1]], seed=2),
        "distances": simulated(PANDA, 5, kind="distances", points=[0, 0, 0.1], seed=3),
    }
    for kind, s in sets.items():
        data.write(tmp_path / f"{kind}.csv", PANDA, s.q, s.measurements)
    points = ["0,0.25,0.5", "1 2 3"]
    said = SAID._replace(
        point=points,
        sigma_angle=0.5,
        sigma_length=0.25,
        frame="unknown",
        centre="1,2,4",
        ignore=["x"],
    )
    found = read([str(tmp_path / f"{kind}.csv") for kind in sets], PANDA, said)
    poses, some, distances = found.sets
    assert isinstance(poses, Poses)
    assert isinstance(some, Points)
    assert isinstance(distances, Distances)
    np.testing.assert_array_equal(poses.covariance, [np.diag([0.25] * 3 + [0.0625] * 3)] * 3)
    np.testing.assert_array_equal(some.covariance, [0.0625 * np.eye(6)] * 4)
    np.testing.assert_array_equal(some.points, [[0, 0.25, 0.5], [1, 2, 3]])
    assert some.frame == "unknown"
    np.testing.assert_array_equal(distances.covariance, np.full((5, 1, 1), 0.0625))
    np.testing.assert_array_equal(distances.point, [0, 0.25, 0.5])
    np.testing.assert_array_equal(distances.centre, [1, 2, 4])
    assert [np.asarray(s.rows).tolist() for s in found.sets] == [
        [0, 1, 2],
        [3, 4, 5, 6],
        [7, 8, 9, 10, 11],
    ]
    np.testing.assert_array_equal(found.q, np.concatenate([s.q for s in sets.values()]))
    one = read([str(tmp_path / "poses.csv")] * 2, PANDA, SAID._replace(kind=["eye-in-hand"]))
    assert [type(s).__name__ for s in one.sets] == ["EyeInHand"] * 2
    bare = read([str(tmp_path / "distances.csv")], PANDA, SAID).sets[0]
    assert isinstance(bare, Distances)
    assert (bare.covariance, bare.centre) == (None, None)


def test_text_and_json_hold_the_figures_of_the_library(poekin, as_json, measured, csv):
    expected = calibrate(PANDA, measured.q, data.read(csv, PANDA)[1], loss="huber", folds=2)
    result = as_json(*ARM, csv, "--loss", "huber")
    aside = expected.cross_validation
    assert aside is not None
    for said, figures in (
        (result["before"], expected.before),
        (result["after"], expected.after),
        (result["cross_validation"]["before"], aside.before),
        (result["cross_validation"]["after"], aside.after),
    ):
        assert said == {
            name: getattr(figures, name)
            for name in ("rms_length", "median_length", "rms_angle", "median_angle")
        }
    assert [result[name] for name in ("robot", "base", "tip", "loss")] == [
        "panda", "panda_link0", "panda_link8", "huber",
    ]  # fmt: skip
    assert result["steps"] == len(expected.steps)
    assert result["identification"]["condition"] == expected.identification.condition
    assert [(p["owner"], p["value"], p["deviation"]) for p in result["parameters"]] == [
        (p.owner, v, d)
        for p, v, d in zip(expected.parameters, expected.values, expected.deviations, strict=True)
    ]
    out = poekin(*ARM, csv, "--loss", "huber")[1]
    assert f"\n{changes.sentence(expected)}\n{expected.summary()}\n\n" in out


def test_json_holds_all_of_it(as_json, measured, csv):
    result = as_json(*ARM, csv, "--loss", "huber")
    assert result["success"] is True
    assert (result["measurements"], result["identification"]["rank"]) == (50, 34)
    assert result["cross_validation"]["folds"] == 2
    assert (
        result["cross_validation"]["after"]["median_length"]
        < 0.2 * result["cross_validation"]["before"]["median_length"]
    )
    assert [o["row"] for o in result["outliers"]] == np.flatnonzero(measured.outliers).tolist()
    assert result["outliers"][0]["source"] == f"{csv}:{result['outliers'][0]['row'] + 2}"
    assert len(result["parameters"]) == 34
    assert set(result["parameters"][0]) == {"owner", "what", "unit", "value", "deviation"}
    assert result["written"] == []


@pytest.mark.parametrize("kind", ["eye-in-hand", "eye-to-hand"])
def test_cameras_and_boards_are_solved_along(kind, as_json, tmp_path):
    s = simulated(PANDA, 40, kind=kind, seed=2)
    data.write(tmp_path / "m.csv", PANDA, s.q, s.measurements)
    result = as_json(*ARM, tmp_path / "m.csv", "--kind", kind)
    assert list(result["frames"]) == list(s.frames)
    for name, T in s.frames.items():
        # a frame is only known up to what the arm's held directions leave: 2 mm and 2 mrad of them,
        # seven joints
        np.testing.assert_allclose(result["frames"][name], T, rtol=0, atol=0.03)


def test_camera_poses_of_a_forgotten_kind_are_warned_of(poekin, tmp_path):
    s = simulated(PANDA, 40, kind="eye-in-hand", seed=3)
    data.write(tmp_path / "m.csv", PANDA, s.q, s.measurements)
    given = [*ARM, tmp_path / "m.csv", "--folds", 0, "-o", tmp_path / "arm.toml"]
    code, out, err = poekin(*given, "--json")
    assert code == 1
    said = json.loads(out)
    (words,) = said["warnings"]
    assert "most likely: the Poses: base moved by 0.92" in said["verdict"][0]
    assert err == f"poekin: warning: {words}\n"
    assert "base moved by 0.92" in words
    assert "kind eye-in-hand or eye-to-hand" in words
    assert said["remarks"] == []
    assert toml_io.load(tmp_path / "arm.toml").warnings == (words,)


def test_a_base_that_is_elsewhere_is_told_first_and_not_warned_of(poekin, measured, tmp_path):
    T = pk.se3.exp([0.3, -0.5, 0.2, 2.0, 1.4, -0.3]) @ measured.truth.fk(measured.q)
    data.write(tmp_path / "m.csv", PANDA, measured.q, pk.calibration.Poses(T))
    code, out, err = poekin(*ARM, tmp_path / "m.csv", "--folds", 0)
    assert (code, err) == (1, "")
    assert re.match(
        r"Do NOT use this calibration: the axis of .* most likely: the base moved by ", out
    )
    assert "\nthe nominal arm is off by " in out
    assert ": base moved by " in out


def test_several_files_make_one_calibration(as_json, tmp_path):
    points = [[0.0, 0.0, 0.1], [0.05, 0.0, 0.1]]
    sets = [
        simulated(PANDA, 30, kind="points", points=points, seed=4),
        simulated(PANDA, 25, kind="distances", points=points[0], seed=5),
    ]
    for s, name in zip(sets, ("points.csv", "distances.csv"), strict=True):
        data.write(tmp_path / name, PANDA, s.q, s.measurements)
    words = [
        tmp_path / "points.csv",
        "--point",
        "0,0,0.1",
        "--point",
        "0.05 0 0.1",
        "--sigma-length",
        1e-4,
    ]
    one = as_json(*ARM, *words)
    q, measured = data.read(words[0], PANDA, points=np.array(points), covariance=1e-8 * np.eye(6))
    assert [p["value"] for p in one["parameters"]] == calibrate(
        PANDA, q, measured, folds=2
    ).values.tolist()
    assert one["noise_std"] == [None]
    lines = (tmp_path / "distances.csv").read_text().splitlines()
    noted = [lines[0] + ",note", *(f"{line},x" for line in lines[1:])]
    (tmp_path / "distances.csv").write_text("\n\n".join(noted))
    arm = [*ARM[:4], "--folds", 0, "--on-rank-deficiency", "fix"]
    both = as_json(*arm, words[0], tmp_path / "distances.csv", "--ignore", "note", *words[1:5])
    assert both["measurements"] == 55


def test_mixed_files_take_their_own_options(as_json, tmp_path):
    rng = np.random.default_rng(0)
    q = PANDA.random(rng, 60)
    T = PANDA.fk(q)
    d = np.linalg.norm(T[30:, :3, 3] - [1.0, 0.5, 0.2], axis=1)
    data.write(tmp_path / "p.csv", PANDA, q[:30], Points(T[:30, :3, 3]))
    data.write(tmp_path / "d.csv", PANDA, q[30:], Distances(d))
    given = [
        *ARM[:4],
        "--folds",
        0,
        "--on-rank-deficiency",
        "fix",
        tmp_path / "p.csv",
        tmp_path / "d.csv",
        "--kind",
        "points",
    ]
    known = as_json(*given, "--kind", "distances", "--centre", "1, 0.5, 0.2")
    unknown = as_json(*given, "--kind", "distances", "--frame", "unknown")
    assert known["frames"] == {}
    assert list(unknown["frames"]) == [
        "T_base_device of measurement set 0",
        "centre of measurement set 1",
    ]
    np.testing.assert_allclose(
        unknown["frames"]["centre of measurement set 1"], [1, 0.5, 0.2], rtol=0, atol=1e-6
    )


def test_parameters_joints_and_priors_are_obeyed(as_json, poekin, csv):
    robust = [*ARM, csv, "--loss", "huber"]
    chosen = [
        "--parameters",
        "screws,gains",
        "--joints",
        "panda_joint2",
        "--joints",
        "panda_joint4",
    ]
    # two joints of seven leave more than 5 mm
    code, out, _ = poekin(*robust, *chosen, "--json")
    some = json.loads(out)
    assert code == 1
    assert any("the calibrated arm is still off by " in words for words in some["verdict"])
    assert {p["owner"] for p in some["parameters"]} == {"panda_joint2", "panda_joint4"}
    assert len(some["parameters"]) == 10
    free = as_json(*robust)
    # a prior that holds the arm at its nominal model leaves what that leaves
    code, out, _ = poekin(*robust, "--prior-angle", 1e-9, "--prior-length", 1e-9, "--json")
    held = json.loads(out)
    assert code == 1
    assert "the calibrated arm is still off by " in held["verdict"][0]
    largest = [max(abs(p["value"]) for p in result["parameters"]) for result in (free, held)]
    assert largest[0] > 1e-3
    assert largest[1] < 1e-6


def test_what_is_not_seen_is_refused_or_held(poekin, refused, measured, tmp_path):
    q = measured.q.copy()
    q[:, 3] = -1.5
    path = tmp_path / "still.csv"
    data.write(path, PANDA, q, pk.calibration.Poses(measured.truth.fk(q)))
    said = refused(*ARM, path)
    assert "these measurements identify 30 of 34 parameters. Unobserved: " in said
    assert said.endswith("estimate the rest only with --on-rank-deficiency fix\n")
    code, out, _ = poekin(*ARM, path, "--on-rank-deficiency", "fix")
    assert code == 0
    assert "rank 30 of 34" in out
    assert "\nunobserved by these measurements: " in out


def test_a_search_that_does_not_converge_is_exit_code_1_and_written(
    poekin, csv, monkeypatch, tmp_path
):
    monkeypatch.setattr(command, "calibrate", functools.partial(calibrate, iterations=1))
    code, out, err = poekin(*ARM, csv, "-o", tmp_path / "best.toml", "--json")
    assert code == 1
    assert err == "poekin: the search did not converge: this is the best that was found\n"
    assert json.loads(out)["success"] is False
    assert toml_io.load(tmp_path / "best.toml").success is False


def test_the_urdf_is_the_model_s_own_text_and_the_result_is_printed_too(
    poekin, measured, csv, tmp_path
):
    model, out = tmp_path / "mine.urdf", tmp_path / "out.urdf"
    text = pk.to_urdf(pk.load("panda")).replace("<link ", "<!-- mine -->\n  <link ")
    model.write_text(text, encoding="utf-8")
    code, said, err = poekin("calibrate", model, *ARM[2:], csv, "--loss", "huber", "-o", out)
    assert (code, err) == (0, "")
    assert out.read_text(encoding="utf-8").count("<!-- mine -->") == text.count("<!-- mine -->") > 0
    plain = poekin("calibrate", model, *ARM[2:], csv, "--loss", "huber")[1]
    assert said == plain + (
        f"written: '{out}'\nthe URDF is the model's own text with other origins and axes of joints that"
        " moved: all else is as it was\n"
    )


def test_a_fit_whose_tip_is_the_last_moving_link_is_written_with_a_tool_link(poekin, tmp_path):
    chain = pk.load("panda").chain(tip="panda_link7")
    made = simulated(chain, 40, noise=(1e-4, 1e-4), seed=3)
    data.write(tmp_path / "m.csv", chain, made.q, made.measurements)
    given = ["calibrate", "panda", "--tip", "panda_link7", "--folds", 0, tmp_path / "m.csv"]
    outputs = ["-o", tmp_path / "out.urdf", "-o", tmp_path / "out.toml"]
    code, said, err = poekin(*given, *outputs)
    assert code == 0
    assert err.count("warning: link 'panda_link7' stays on the axis of joint 'panda_joint7'") == 1
    assert err.count("the tip is the new link 'panda_link7_tool', fixed to it") == 1
    assert "panda_link7_tool" not in said
    found = toml_io.load(tmp_path / "out.toml")
    q = chain.random(0, 20)
    tool = pk.load(tmp_path / "out.urdf").chain(tip="panda_link7_tool")
    assert np.abs(tool.fk(q) - found.chain.fk(q)).max() <= 1e-13


@pytest.mark.parametrize("json_", [(), ("--json",)])
def test_a_file_that_cannot_be_written_does_not_cost_the_result(json_, poekin, csv, tmp_path):
    given = [*ARM, csv, *json_, "--parameters", "gains"]  # of which URDF knows nothing
    code, said, err = poekin(*given, "-o", tmp_path / "arm.urdf", "-o", tmp_path / "arm.csv")
    assert code == 2
    assert err.startswith("poekin: error: the chain's joints follow its coordinates otherwise")
    assert {path.name for path in tmp_path.iterdir()} == {"poses.csv"}
    assert said == poekin(*given)[1] != ""


def test_faults_in_a_row_name_file_and_line(refused, csv):
    lines = csv.read_text().splitlines()
    for cell, message in (
        ("nan", "expected a finite number, got nan"),
        ("x", "a number expected, got 'x'"),
    ):
        wrong = lines.copy()
        wrong[7] = ",".join([cell, *wrong[7].split(",")[1:]])
        csv.write_text("\n".join(wrong))
        said = refused(*ARM, csv)
        assert f"{csv}:8, column " in said
        assert message in said


def test_degrees_for_radians_are_suggested_not_converted(refused, measured, tmp_path):
    data.write(tmp_path / "deg.csv", PANDA, np.rad2deg(measured.q), measured.measurements)
    said = refused(*ARM, tmp_path / "deg.csv")
    assert "the joint angles look like degrees: --deg says so\n" in said


def test_what_python_calls_its_parameters_is_told_as_options(refused, measured, tmp_path):
    few = tmp_path / "few.csv"
    data.write(few, PANDA, measured.q[:5], measured.measurements.subset(np.arange(5)))
    said = refused(*ARM, few)
    assert "34 identifiable parameters" in said
    assert "(--parameters, --joints), or fix what is unobserved (--on-rank-deficiency fix)" in said
    assert "or give --sigma-angle and --sigma-length\n" in refused(
        *ARM, few, "--on-rank-deficiency", "fix"
    )
    assert "folds: 9 parts of 5 readings; --folds 0 holds none out" in refused(
        *ARM,
        few,
        "--on-rank-deficiency",
        "fix",
        "--folds",
        9,
        "--sigma-angle",
        1e-3,
        "--sigma-length",
        1e-3,
    )


@pytest.mark.parametrize(
    ("column", "typed"),
    [
        ("q8", "q8"),
        ("t.0:a/b+c-d_e", "t.0:a/b+c-d_e"),
        ("room air", "'room air'"),
        ("$(ls)", "'$(ls)'"),
    ],
    ids=["plain", "signs", "blank", "shell"],
)
def test_a_column_that_is_none_is_told_with_the_option_as_it_is_typed(
    column, typed, poekin, refused, csv
):
    head, _, rows = csv.read_text().partition("\n")
    csv.write_text(f"{head},{column}\n" + "".join(f"{row},x\n" for row in rows.splitlines()))
    assert f"; --ignore {typed} passes it over\n" in refused(*ARM, csv)
    quick = ["--folds", 0, "--loss", "huber"]
    assert poekin(*ARM, csv, *quick, "--ignore", shlex.split(typed)[0])[0] == 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--kind", "pose"], "--kind: expected 'poses', 'eye-in-hand',"),
        (
            ["--kind", "points"],
            "the columns T00 ... T23 are those of poses or eye-in-hand or eye-to-hand",
        ),
        (
            ["--kind", "poses", "--kind", "poses"],
            "--kind: expected one for all files or one for each of 1, got 2",
        ),
        (["--point", "0,0,1"], "--point: expected with points or distances only, got poses"),
        (["--centre", "0,0,1"], "--centre: expected with distances only, got poses"),
        (
            ["--kind", "eye-in-hand", "--frame", "unknown"],
            "--frame: expected with points or poses only, got eye-in-hand",
        ),
        (
            ["--sigma-angle", "1e-3"],
            "--sigma-angle and --sigma-length: of measured poses, both expected or neither",
        ),
        (
            ["--sigma-length", "1e-3"],
            "--sigma-angle and --sigma-length: of measured poses, both expected or neither",
        ),
        (
            ["--sigma-angle", "-1", "--sigma-length", "1"],
            "--sigma-angle: expected a positive number, got -1.0",
        ),
        (["--prior-angle", "0"], "--prior-angle: expected a positive number, got 0"),
        (
            ["--sigma-angle", "1", "--sigma-length", "0"],
            "--sigma-length: expected a positive number, got 0",
        ),
        (["--loss", "l1"], "--loss: expected 'linear', 'huber'"),
        (["--parameters", "screw"], "--parameters: expected some of"),
        (["--joints", "elbow"], "--joints: no joint 'elbow'"),
        (["--folds", "1"], "--folds: expected 0 for none, or 2 and more, got 1"),
        (["--dh", "craig"], "--dh: expected 'standard' or 'modified', got 'craig'"),
        (
            ["-o", "a.txt"],
            "cannot write 'a.txt': a name that ends in .toml or .urdf or .csv expected",
        ),
        (["--report", "a.txt"], "cannot write 'a.txt': a name that ends in .html or .htm expected"),
        (
            ["-o", "none/a.toml"],
            "cannot write 'none/a.toml': there is no directory 'none'",
        ),
        (["-o", "a.toml", "-o", "./a.toml"], "cannot write 'a.toml': it is named twice"),
    ],
    ids=lambda x: " ".join(x) if isinstance(x, list) else "",
)
def test_wrong_options_are_refused(words, message, refused, csv, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert message in refused(*ARM[:4], csv, *words)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["poses.csv"]


def test_measurements_are_never_written_over(refused, csv):
    before = csv.read_bytes()
    assert "it is the file of the measurements" in refused(*ARM, csv, "-o", csv)
    assert csv.read_bytes() == before


def test_wrong_points_and_angles_of_lengths_are_refused(refused, tmp_path):
    s = simulated(PANDA, 40, kind="distances", seed=5)
    path = tmp_path / "d.csv"
    data.write(path, PANDA, s.q, s.measurements)
    cases = {
        ("--point", "0,0"): "--point: three numbers expected (x,y,z), got 2",
        ("--point", "0,0,z"): "--point: number 3: a number expected, got 'z'",
        (
            "--sigma-angle",
            "1",
        ): "--sigma-angle: expected with measured poses only, and there are lengths alone",
    }
    for words, message in cases.items():
        assert message in refused(*ARM, path, *words)


def test_outliers_beyond_the_first_are_counted():
    sources = [f"{'ab'[k % 2]}.csv:{k}" for k in range(MOST_OUTLIERS + 2)]
    here = {
        file: ", ".join(str(k) for k in range(first, MOST_OUTLIERS, 2))
        for first, file in enumerate(("a", "b"))
    }
    assert command._locations(sources) == f"a.csv:{here['a']}; b.csv:{here['b']} and 2 more"
    assert command._locations(sources[:-1]).endswith(" and 1 more")
    assert command._locations(sources[:-2]) == f"a.csv:{here['a']}; b.csv:{here['b']}"
    assert command._locations(sources[:1]) == "a.csv:0"
    assert command._locations(["a.csv:1"] * (2 * MOST_OUTLIERS + 1)).endswith(
        f" and {MOST_OUTLIERS + 1} more"
    )


def test_two_files_of_one_kind_are_one_text_and_its_warnings_are_said_once(tmp_path, capsys):
    arm = pk.load("ur5e").chain(tip="wrist_3_link")
    made = simulated(arm, 20, tilt=1e-3, shift=1e-3, noise=(1e-5, 1e-5), seed=0)
    found = pk.calibrate(arm, made.q, made.measurements, folds=0)
    paths = [tmp_path / name for name in ("a.urdf", "b.urdf", "a.csv", "b.csv")]
    with pytest.warns(PoekinWarning, match="wrist_3_link_tool") as caught:
        Outputs(paths, "standard", None).write(found, pk.load("ur5e"), [])
    assert len(caught) == 1
    said = capsys.readouterr().err.splitlines()
    assert said
    assert len(set(said)) == len(said)
    for ending in ("urdf", "csv"):
        assert (tmp_path / f"a.{ending}").read_bytes() == (tmp_path / f"b.{ending}").read_bytes()


def test_an_option_is_said_where_a_keyword_would_be():
    assert command.as_options(
        "the lengths look like millimetres: give metres (divide by 1000)"
    ) == (
        "the lengths look like millimetres: give metres"
        " (divide by 1000, or --mm, which is of sliding joints too)"
    )
