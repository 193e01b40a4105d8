"""`poekin calibrate --exact`: a controller's own forward kinematics in, its arm and a bound out."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk
from poekin.groups import rpy
from poekin.solve.calibration import Poses, from_fk, simulated
from poekin.solve.calibration.measurements import data

UR10E = pk.load("ur10e").chain()
MADE = simulated(UR10E, 40, noise=(0, 0), seed=1)
ARM = ["calibrate", "ur10e"]


@pytest.fixture
def pairs(tmp_path):
    T = MADE.truth.fk(MADE.q)
    T[:, :3, 3] = T[:, :3, 3].round(6)
    path = tmp_path / "pairs.csv"
    data.write(path, UR10E, MADE.q, Poses(T))
    return path


def test_the_arm_is_written_and_the_bound_is_printed(poekin, pairs, tmp_path):
    out_path = tmp_path / "arm.urdf"
    code, out, err = poekin(*ARM, pairs, "--exact", "-o", out_path)
    assert (code, err) == (0, "")
    q, poses = data.read(pairs, UR10E)
    assert isinstance(poses, Poses)
    found = from_fk(UR10E, q, poses.T)
    assert out.endswith(f"\n{found}\n")
    assert "\nthe digits of the pairs are the limit: positions to 0.001 mm\n" in out
    written = pk.load(out_path).chain()
    np.testing.assert_allclose(written.fk(q), found.chain.fk(q), rtol=0, atol=1e-13)


def test_pairs_may_stand_in_several_files_and_json_has_the_bound(poekin, pairs, tmp_path):
    lines = pairs.read_text().splitlines(keepends=True)
    first, second = tmp_path / "1.csv", tmp_path / "2.csv"
    first.write_text("".join(lines[:21]))
    second.write_text("".join([lines[0], *lines[21:]]))
    code, out, err = poekin(*ARM, first, second, "--exact", "--json")
    assert (code, err) == (0, "")
    q, poses = data.read(pairs, UR10E)
    assert isinstance(poses, Poses)
    assert json.loads(out)["exact"] == from_fk(UR10E, q, poses.T).to_dict()


def test_what_goes_with_measurements_alone_is_refused(poekin, pairs, tmp_path):
    place = tmp_path / "arm.toml"
    for option, value in (
        ("--loss", "huber"),
        ("--parameters", "screws"),
        ("--joints", "elbow_joint"),
        ("--prior-angle", "1e-3"),
        ("--on-rank-deficiency", "fix"),
        ("--sigma-angle", "1e-3"),
        ("--sigma-length", "1e-3"),
    ):
        named = {"--prior-angle": "--prior-angle and --prior-length"}.get(option, option)
        code, out, err = poekin(*ARM, pairs, "--exact", option, value, "-o", place)
        assert (code, out) == (2, "")
        assert err == (
            f"poekin: error: {named}: expected without --exact, which takes poses that a "
            "controller calculated, without noise, and fits all axes and the home pose\n"
        )
    assert not place.exists()


def test_pairs_that_are_no_exact_ones_are_refused_and_nothing_is_written(poekin, pairs, tmp_path):
    place = tmp_path / "arm.toml"
    few = tmp_path / "few.csv"
    few.write_text("".join(pairs.read_text().splitlines(keepends=True)[:5]))
    measured = tmp_path / "measured.csv"
    noisy = simulated(UR10E, 40, seed=1)
    data.write(measured, UR10E, noisy.q, noisy.measurements)
    points = tmp_path / "points.csv"
    some = simulated(UR10E, 40, kind="points", seed=1)
    data.write(points, UR10E, some.q, some.measurements)
    for path, begins in (
        (few, "4 pairs for 30 parameters: at least 6 are needed"),
        (measured, "no rigid arm explains these pairs to their digits (no digits that were"),
        (points, "--exact: expected poses of the flange in the base, got Points"),
    ):
        code, out, err = poekin(*ARM, path, "--exact", "-o", place)
        assert (code, out) == (2, "")
        assert err.startswith(f"poekin: error: {begins}")
        assert err.count("\n") == 1
    assert not place.exists()


def test_a_pendant_s_numbers_go_in_as_it_shows_them(poekin, tmp_path):
    arm = pk.load("puma560").chain().coupled("J3 = J2 + J3")
    true = simulated(pk.load("puma560").chain(), 1, seed=1).truth.coupled("J3 = J2 + J3")
    q = arm.random(0, 40)
    T = true.fk(q)
    columns = [np.degrees(q), 1e3 * T[:, :3, 3], np.degrees(rpy.angles(T[:, :3, :3]))]
    table = tmp_path / "pendant.csv"
    names = "q1,q2,q3,q4,q5,q6,x,y,z,w,p,r"
    np.savetxt(table, np.hstack(columns), "%.3f", ",", header=names, comments="")
    units = ("--format", "wpr", "--mm", "--deg")
    said = ("--coupling", "J3 = J2 + J3")
    code, out, err = poekin("calibrate", "puma560", table, "--exact", *units, *said, "--json")
    assert (code, err) == (0, "")
    document = json.loads(out)["exact"]
    assert document["digits"] == (
        "joint angles to 0.001°, positions to 0.001 mm, rotations (roll, pitch, yaw) to 0.001°"
    )
    assert document["worst"]["position"] < 1e-4
