"""`poekin choose-poses`: where to measure, out of a box, a cone, or beside what was measured."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration import Distances, Points, Poses, ViewCone, WorkspaceBox
from poekin.solve.calibration.measurements import data

N, K = 8, 40
POINT = np.array([0.1, 0.0, 0.2])


@pytest.fixture
def arm(crane):
    return pk.load(crane).chain(tip="hook")


@pytest.fixture
def words(crane):
    return ["choose-poses", crane, N, "--tip", "hook", "--candidates", K]


def table(text):  # type: ignore[no-untyped-def]
    """Header and rows of a CSV text."""
    head, *rows = text.splitlines()
    return head, np.array([line.split(",") for line in rows], float)


def test_without_a_file_the_configurations_are_a_table_and_the_gain_is_said_beside_it(
    poekin, words, arm
):
    code, out, err = poekin(*words)
    expected = pk.choose_poses(arm, N, K)
    assert code == 0
    assert err == f"poekin: {expected}\n"
    head, q = table(out)
    assert head == "turn,slide"
    assert np.array_equal(q, expected.q)


def test_the_file_is_one_of_configurations_in_the_units_that_are_said(
    poekin, words, arm, crane, tmp_path
):
    path, array = tmp_path / "poses.csv", tmp_path / "poses.npy"
    code, out, err = poekin(*words, "--deg", "--mm", "--seed", 3, "-o", path)
    expected = pk.choose_poses(arm, N, K, seed=3)
    assert (code, out, err) == (0, f"{expected}\nwritten: '{path}'\n", "")
    head, q = table(path.read_text())
    assert head == "turn [deg],slide [mm]"
    # two conversions of each number
    np.testing.assert_allclose(q * [np.pi / 180, 1e-3], expected.q, rtol=1e-15)
    assert poekin("fk", crane, "--tip", "hook", "--input", path)[0] == 0
    again = [*words[:-1], path, "--deg", "--mm", "-o", array]
    assert poekin(*again)[0] == 0
    np.testing.assert_allclose(np.load(array), q, rtol=1e-15)


def test_json_has_the_choice_and_what_was_written(as_json, words, arm, tmp_path):
    path = tmp_path / "poses.csv"
    said = as_json(*words, "-o", path)
    expected = pk.choose_poses(arm, N, K)
    assert said["q"] == expected.q.tolist()
    assert (said["robot"], said["q_names"], said["written"]) == (
        "crane",
        ["turn", "slide"],
        [str(path)],
    )
    assert said["metrics"] == json.loads(expected.to_json())["metrics"]
    assert as_json(*words)["written"] == []


OPTIONS = {
    "kind": (["--kind", "poses"], {}),
    "criterion": (["--criterion", "O1"], {"criterion": "O1"}),
    "parameters": (["--parameters", "screws", "--joints", "turn"], {"parameters": ["screws"], "joints": ["turn"]}),
    "points of nothing else": (["--kind", "points"], {"measurements": Points([[0, 0, 0]])}),
    "point": (["--point", "0.1,0,0.2"], {"measurements": Points([[0, 0, 0]], points=POINT)}),
    "points": (
        ["--point", "0.1,0,0.2", "--point", "0 .1 0"],
        {"measurements": Points([np.zeros((2, 3))], points=[POINT, [0, 0.1, 0]])},
    ),
    "point in mm": (["--point", "100,0,200", "--mm"], {"measurements": Points([[0, 0, 0]], points=POINT)}),
    "noise": (
        ["--sigma-angle", 1e-4, "--sigma-length", 1e-3],
        {"measurements": Poses(np.eye(4)[None], np.diag(np.repeat([1e-8, 1e-6], 3)))},
    ),
    "distances": (
        ["--kind", "distances", "--centre", "2,0,0", "--point", "0.1,0,0.2"],
        {"measurements": Distances([1.0], centre=[2, 0, 0], point=POINT)},
    ),
    "box": (["--box", "-2,-2,0.5,2,0.2,3"], {"allowed": WorkspaceBox([-2, -2, 0.5], [2, 0.2, 3])}),
    "corners": (["--box", "2,0.2,3,-2,-2,0.5"], {"allowed": WorkspaceBox([-2, -2, 0.5], [2, 0.2, 3])}),
    "box in mm": (["--box", "-2e3,-2e3,0,2e3,200,3e3", "--mm"], {"allowed": WorkspaceBox([-2, -2, 0], [2, 0.2, 3])}),
    "cone": (["--cone", "3,0,1,-1,0,0,0.5"], {"allowed": ViewCone([3, 0, 1], [-1, 0, 0], 0.5)}),
    "cone in degrees": (
        ["--cone", "3000,0,1000,-1,0,0,30", "--deg", "--mm"],
        {"allowed": ViewCone([3, 0, 1], [-1, 0, 0], np.pi / 6)},
    ),
    "box of the point": (
        ["--point", "0.1,0,0.2", "--box", "-2,-2,0.5,2,0.2,3"],
        {
            "measurements": Points([[0, 0, 0]], points=POINT),
            "allowed": WorkspaceBox([-2, -2, 0.5], [2, 0.2, 3], POINT),
        },
    ),
    "workspace": (["--workspace", "0,0,0,2,2,3"], {"workspace": WorkspaceBox([0, 0, 0], [2, 2, 3])}),
    "its size in mm": (["--workspace", "0,0,0,500,2e3,3e3", "--mm"], {"workspace": WorkspaceBox([0] * 3, [0.5, 2, 3])}),
}  # fmt: skip


@pytest.mark.parametrize("case", OPTIONS)
def test_options_are_the_arguments_of_choose_poses(case, as_json, words, arm):
    options, arguments = OPTIONS[case]
    n = 20 if case == "distances" else N
    words[2] = n
    said = as_json(*words, *options)
    expected = pk.choose_poses(arm, n, K, **arguments)
    assert said["rows"] == expected.rows.tolist()
    assert said["metrics"] == json.loads(expected.to_json())["metrics"]


def test_the_next_poses_are_those_that_help_beside_a_file_of_measurements(
    poekin, words, arm, tmp_path
):
    q = arm.random(2, 9)
    p = (arm.fk(q) @ np.append(POINT, 1))[:, :3]
    points = Points(p, points=POINT)
    path = tmp_path / "measured.csv"
    data.write(path, arm, q, points)
    words[2] = 2
    code, out, err = poekin(*words, "--measured", path, "--point", "0.1,0,0.2")
    expected = pk.choose_poses(arm, 2, K, measured=q, measurements=points)
    assert (code, err) == (0, f"poekin: {expected}\n")
    assert np.array_equal(table(out)[1], expected.q)


REFUSED = {
    "few": ([], 2, "N: 2 configurations of 6 equations each are too few for "),
    "many": ([], 41, "N: expected at most the 40 candidates, got 41"),
    "no box": (["--box", "1,2,3"], N, "--box: 6 numbers expected (two corners, x,y,z,x,y,z), got 3"),
    "no number": (["--box", "a,2,3"], N, "--box: number 1: a number expected, got 'a'"),
    "no cone": (
        ["--cone", "1,2,3"],
        N,
        "--cone: 7 numbers expected (a place, a direction and an angle), got 3",
    ),
    "no angle": (
        ["--cone", "0,0,0,0,0,1,30"],
        N,
        "--cone: half_angle: expected a number from 0 to 3.14159, got 30.0",
    ),
    "nothing in the box": (
        ["--box", "9,9,9,9,9,9"],
        N,
        "--box, --cone: 0 of 4000 configurations drawn within the limits are allowed, 40 are needed: "
        "expected a larger one, or --candidates that it allows",
    ),
    "nothing in the workspace": (
        ["--workspace", "9,9,9,9,9,9"],
        N,
        "--workspace: 0 of 100000 configurations drawn within the limits are allowed, 1000 are needed: ",
    ),
    "camera": (
        ["--kind", "eye-in-hand"],
        N,
        "--kind: expected poses, points or distances, got eye-in-hand: where its camera and board are "
        "roughly is told in Python, poekin.choose_poses(measurements=...)",
    ),
    "kind": (["--kind", "angles"], N, "--kind: expected 'poses', 'points' or 'distances', got 'angles'"),
    "centre": (["--kind", "distances"], N, "--centre: expected with distances, roughly where it is: "),
    "centre of poses": (["--centre", "1,2,3"], N, "--centre: expected with distances only, got poses"),
    "criterion": (["--criterion", "E"], N, "--criterion: expected 'prediction', 'O1', "),
    "output": (["-o", "poses.json"], N, "cannot write 'poses.json': a name that ends in .csv or .npy expected"),
    "no file": (["--candidates", "none.csv"], N, "cannot read 'none.csv'"),
    "none": (["--candidates", "0"], N, "--candidates: expected configurations (K, 2), or how many to draw, got 0"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_chosen_from_is_refused_with_the_option(case, refused, words):
    options, n, message = REFUSED[case]
    words[2] = n
    assert refused(*words, *options).startswith(f"poekin: error: {message}")


def test_candidates_beyond_the_limits_are_refused_with_their_row(refused, words, tmp_path):
    path = tmp_path / "some.csv"
    path.write_text("turn,slide\n" + "0.1,0.2\n" * 20 + "0.1,7\n")
    said = refused(*words[:-1], path)
    assert "--candidates, row [20]: 'slide' = 7 is outside its limits 0 to 1" in said


def test_measurements_of_a_camera_and_unknown_columns_are_refused(refused, words, arm, tmp_path):
    q = arm.random(2, 9)
    path = tmp_path / "seen.csv"
    data.write(path, arm, q, Poses(arm.fk(q)))
    said = refused(*words, "--measured", path, "--kind", "eye-to-hand")
    assert said.startswith(
        "poekin: error: --measured: expected poses, points or distances, got EyeToHand"
    )
    path.write_text("turn,slide,x,y,z,humidity\n")
    assert "--ignore humidity passes it over" in refused(*words, "--measured", path)
    path.write_text("turn,slide,x,y,z\n")
    assert "Points: expected one or more as an example, got none" in refused(
        *words, "--measured", path
    )
