"""`--coupling`: readings that several joints follow, in every command that takes a model."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk
from poekin.solve.motion.trajectory.trajectory import Trajectory

ARM = pk.load("puma560").chain()
SAID = ("--coupling", "J3 = J2 + J3")
READINGS = [0.1, 0.5, -0.2, 0.3, 0.4, 0.2]
JOINTS = [0.1, 0.5, 0.3, 0.3, 0.4, 0.2]


def test_readings_go_in_and_come_out(poekin):
    code, out, err = poekin("fk", "puma560", *READINGS, *SAID, "--json")
    assert (code, err) == (0, "")
    T = np.array(json.loads(out)["T"])
    np.testing.assert_allclose(T, ARM.fk(JOINTS), rtol=0, atol=1e-15)
    code, out, err = poekin("jacobian", "puma560", *READINGS, *SAID, "--frame", "body", "--json")
    assert (code, err) == (0, "")
    coupled = ARM.coupled("J3 = J2 + J3")
    J = np.array(json.loads(out)["J"])
    np.testing.assert_allclose(J, coupled.jacobian(READINGS, "body"), rtol=0, atol=1e-15)


def test_a_file_s_own_coupling_needs_no_option_and_takes_no_other(poekin, tmp_path):
    path = tmp_path / "fanuc.csv"
    code, _, err = poekin("dh", "puma560", *SAID, "--output", path)
    assert (code, err) == (0, "")
    code, out, err = poekin("fk", path, *READINGS, "--json")
    assert (code, err) == (0, "")
    T = np.array(json.loads(out)["T"])
    np.testing.assert_allclose(T, ARM.fk(JOINTS), rtol=0, atol=1e-14)
    code, out, err = poekin("fk", path, *READINGS, *SAID)
    assert (code, out) == (2, "")
    assert err == (
        "poekin: error: --coupling: the readings of robot 'fanuc' are coupled already: joint3 = "
        "joint2 + joint3; leave --coupling out\n"
    )


def test_of_two_models_the_one_is_coupled_that_is_not_yet(poekin, tmp_path):
    path = tmp_path / "fanuc.csv"
    poekin("dh", "puma560", *SAID, "--output", path)
    for pair in ((path, "puma560"), ("puma560", path)):
        code, out, err = poekin("compare", *pair, *SAID)
        assert (code, err) == (0, "")
        assert out.endswith("The models are the same\n")
        for other in ((), ("--coupling", "J3 = J3 - J2")):
            code, _, _ = poekin("compare", *pair, *other)
            assert code == 1


def test_of_two_models_that_are_coupled_both_neither_is_coupled_again(poekin, tmp_path):
    path = tmp_path / "fanuc.csv"
    poekin("dh", "puma560", *SAID, "--output", path)
    code, out, err = poekin("compare", path, path, *SAID)
    assert (code, out) == (2, "")
    assert err.endswith("coupled already: joint3 = joint2 + joint3; leave --coupling out\n")


def test_it_is_shown_by_dh_and_info(poekin):
    _, out, _ = poekin("dh", "puma560", *SAID)
    assert "\nCoupling: joint3 = joint2 + joint3\n" in out
    _, out, _ = poekin("info", "puma560", *SAID)
    lines = [line for line in out.splitlines() if line.startswith("joint3")]
    assert lines[0].split()[2:5] == ["joint2", "+", "joint3"]
    lower, upper = ARM.coupled("J3 = J2 + J3").limits[2]
    assert lines[0].split()[-2:] == [f"{lower:.6g}", f"{upper:.6g}"]
    _, one, _ = poekin("info", "puma560", *SAID, "--tip", "tool")
    _, alone, _ = poekin("info", "puma560")
    says = "\nLimits are those of each coordinate alone; solvers keep the joints' own, too\n"
    assert [says in text for text in (out, one, alone)] == [True, True, False]


def test_emitted_code_says_of_which_coordinates_it_is_a_function(poekin, tmp_path):
    arm = tmp_path / "arm.py"
    code, _, _ = poekin("emit", "puma560", *SAID, "--lang", "python", "--output", arm)
    assert code == 0
    assert "sums of coordinates:\n  'joint3 = joint2 + joint3'\n" in arm.read_text()
    arm.unlink()
    poekin("emit", "puma560", "--lang", "python", "--output", arm)
    assert "sums of coordinates" not in arm.read_text()


@pytest.mark.parametrize("ending", ["csv", "json", "yaml"])
def test_the_fastest_trajectory_of_a_coupled_arm_is_one_of_its_readings(poekin, tmp_path, ending):
    coupled = ARM.coupled("J3 = J2 + J3")
    q = np.array(READINGS) - np.linspace(0, 0.3, 5)[:, None]
    poses = tmp_path / "T.csv"
    np.savetxt(poses, coupled.fk(q).reshape(5, 16), delimiter=",")
    place = tmp_path / f"trajectory.{ending}"
    asked = ("--format", "matrix", "--fastest", "--acceleration", 5, "--speed", 1)
    words = (*SAID, "--q0", ",".join(map(str, READINGS)), "--output", place, "--json")
    code, out, err = poekin("follow", "puma560", "--input", poses, *asked, *words)
    assert (code, err) == (0, "")
    assert json.loads(out)["trajectory"]["beyond_limits"] == [0.0] * 6
    assert "joint3" in place.read_text()


def test_a_trajectory_with_a_joint_beyond_its_own_limits_is_exit_code_1(
    poekin, tmp_path, monkeypatch
):
    coupled = ARM.coupled("J3 = J2 + J3")
    q = np.array(READINGS) - np.linspace(0, 0.3, 5)[:, None]
    poses = tmp_path / "T.csv"
    np.savetxt(poses, coupled.fk(q).reshape(5, 16), delimiter=",")
    monkeypatch.setattr(Trajectory, "joints_beyond_limits", np.array([0, 0, 0.1, 0, 0, 0]))
    asked = ("--format", "matrix", "--fastest", "--acceleration", 5, "--speed", 1)
    words = (*SAID, "--q0", ",".join(map(str, READINGS)), "--output", tmp_path / "t.csv")
    code, out, _ = poekin("follow", "puma560", "--input", poses, *asked, *words)
    assert code == 1
    assert "joint 'joint3' leaves its own limits by 0.1 (rad or m)" in out


def test_two_statements_are_two_options_and_do_not_last(poekin):
    words = ("--coupling", "J3 = J3 - J2", "--coupling", "J5 = J5 + 1/80 J4")
    _, out, _ = poekin("fk", "puma560", *READINGS, *words, "--json")
    joints = [0.1, 0.5, -0.7, 0.3, 0.4 + 0.3 / 80, 0.2]
    np.testing.assert_allclose(json.loads(out)["T"], ARM.fk(joints), rtol=0, atol=1e-15)
    _, out, _ = poekin("fk", "puma560", *READINGS, "--json")
    np.testing.assert_allclose(json.loads(out)["T"], ARM.fk(READINGS), rtol=0, atol=1e-15)


def test_a_calibration_of_coupled_readings_is_written_in_each_format(poekin, tmp_path):
    pytest.importorskip("tomli_w")
    coupled = ARM.coupled("J3 = J2 + J3")
    true = pk.calibration.simulated(ARM, 1, seed=1).truth.coupled("J3 = J2 + J3")
    q = coupled.random(0, 40)
    pairs = tmp_path / "pairs.csv"
    pk.calibration.write(pairs, coupled, q, pk.calibration.Poses(true.fk(q)))
    outputs = [tmp_path / f"arm.{ending}" for ending in ("toml", "csv", "urdf")]
    words = [word for path in outputs for word in ("-o", path)]
    code, _, err = poekin("calibrate", "puma560", pairs, "--exact", *SAID, *words)
    assert code == 0
    assert "a URDF has the joints' own values, without the coupling of its readings" in err
    for path in outputs[:2]:
        written = pk.load(path).chain()
        np.testing.assert_allclose(written.fk(q), true.fk(q), rtol=0, atol=1e-12)
    x = q @ coupled.coupling.T
    written = pk.load(outputs[2]).chain()
    np.testing.assert_allclose(written.fk(x), true.fk(q), rtol=0, atol=1e-12)


def test_coupled_pairs_without_the_option_are_told_which(poekin, tmp_path):
    coupled = ARM.coupled("J3 = J3 - J2")
    q = coupled.random(0, 40)
    pairs = tmp_path / "pairs.csv"
    pk.calibration.write(pairs, coupled, q, pk.calibration.Poses(coupled.fk(q)))
    code, out, err = poekin("calibrate", "puma560", pairs, "--exact")
    assert (code, out) == (2, "")
    assert "; with --coupling 'joint3 = joint3 - joint2', the nominal arm is off by " in err


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("J3 = J2 + 3", "'J3 = J2 + 3': expected the name of a reading, got nothing; available: "),
        ("J3 = J2", "'J3 = J2': different readings give the same values of the joints, "),
        ("", "'': expected the name of a joint, got nothing; available: "),
        ("joint9 = J2", "'joint9 = J2': expected the name of a joint, got 'joint9'; did you mean "),
    ],
)
def test_what_is_no_coupling_is_refused_and_nothing_is_written(
    poekin, tmp_path, statement, message
):
    place = tmp_path / "T.csv"
    code, out, err = poekin("fk", "puma560", *READINGS, "--coupling", statement, "--output", place)
    assert (code, out) == (2, "")
    assert err.startswith(f"poekin: error: --coupling: {message}")
    assert err.count("\n") == 1
    assert not place.exists()


def test_joints_beyond_their_own_limits_are_told_where_readings_are_within_theirs(poekin):
    beyond = [0.1, -0.5, 1.5, 0.3, 0.4, 0.2]  # joint 3 is at 1.0, of at most 0.785
    code, _, err = poekin("fk", "puma560", *beyond, *SAID)
    assert (code, err) == (
        0,
        "poekin: warning: joint joint3 = 1 rad is outside its own limits, -3.92699 to 0.785398\n",
    )
    assert poekin("fk", "puma560", *READINGS, *SAID)[2] == ""
    degrees = np.degrees(beyond).round(9)
    err = poekin("fk", "puma560", *degrees, *SAID, "--deg")[2]
    assert err.endswith("joint joint3 = 57.2958 deg is outside its own limits, -225 to 45\n")
