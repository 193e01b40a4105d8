"""--point unknown and --separations of calibrate: reflectors of which nobody knows where they are."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk
from poekin.groups import se3
from tests.solve.calibration.measurements.test_unknown_points import (
    APART,
    ARM,
    DEVICE,
    MADE,
    NOISE,
    TOOL,
    Q,
    T,
    seen,
)

WORDS = ["calibrate", "ur5", "--point", "unknown", "--folds", 0]
NAMES = [f"point {k} of 'tool'" for k in (1, 2, 3)]
LINES = ["1,2", "1,3", "3,2"]


def write(path, p, q=Q, names="xyz"):
    count = p.shape[1]
    measured = [f"{axis}{k + 1}" for k in range(count) for axis in "xyz"]
    head = ",".join([*(f"q{k + 1}" for k in range(6)), *(measured if count > 1 else "xyz")])
    rows = np.column_stack([q, p.reshape(len(p), -1)])
    np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.17g")
    return path


@pytest.fixture
def file(tmp_path):
    noise = NOISE * np.random.default_rng(0).normal(size=(40, 3, 3))
    return write(tmp_path / "a.csv", seen(T) + noise)


@pytest.fixture
def plate(tmp_path):
    """Distances between the points, in mm."""
    pairs = [tuple(int(k) - 1 for k in pair.split(",")) for pair in LINES]
    lines = [f"{i + 1},{j + 1},{1e3 * APART[i, j]:.17g},0.001" for i, j in pairs]
    path = tmp_path / "plate.csv"
    path.write_text("\n".join(["from,to,distance [mm],sigma [mm]", *lines]))
    return path


def test_points_are_found_and_told_with_their_deviations(poekin, file, tmp_path):
    out = tmp_path / "a.toml"
    code, text, err = poekin(*WORDS, file, "-o", out)
    assert (code, err) == (0, "")
    found = pk.calibration.load(out)
    assert list(found.frames) == NAMES
    told = [line for line in text.splitlines() if line.startswith("point ")]
    for line, name, place in zip(told, NAMES, found.frames.values(), strict=True):
        mine = [k for k, p in enumerate(found.parameters) if p.owner == name]
        sigma = np.sqrt(np.diag(found.covariance)[mine])
        x, y, z = 1e3 * place
        a, b, c = 1e3 * sigma
        assert line == (
            f"{name} at ({x:.3f}, {y:.3f}, {z:.3f}) mm in 'tool', standard deviations ({a:.4f}, {b:.4f}, "
            f"{c:.4f}) mm while what is unidentifiable is fixed"
        )
        # of 120 numbers with noise 0.1 mm each, and the home pose held
        assert (sigma > 0.1 * NOISE).all()
        assert (sigma < NOISE).all()
    # a rigid motion of all points with the home pose is not told by the data: distances are
    places = np.array(list(found.frames.values()))
    apart = np.linalg.norm(places[:, None] - places, axis=-1)
    np.testing.assert_allclose(apart, APART, rtol=0, atol=5 * NOISE)


def test_separations_hold_the_points_at_their_distances(poekin, file, plate, tmp_path):
    out = tmp_path / "a.toml"
    code, text, err = poekin(
        *WORDS, file, "--separations", plate, "-o", out, "--report", tmp_path / "a.html"
    )
    assert (code, err) == (0, "")
    assert "point 3 of 'tool' at (" in text
    places = np.array(list(pk.calibration.load(out).frames.values()))
    apart = np.linalg.norm(places[:, None] - places, axis=-1)
    # 1 um each, against some 15 um that the measurements tell of them
    np.testing.assert_allclose(apart, APART, rtol=0, atol=3e-6)
    assert np.abs(apart - APART).max() > 1e-9


def test_units_of_separations_are_those_of_the_options(as_json, file, plate):
    told = as_json(*WORDS, file, "--separations", plate)
    p = np.loadtxt(file, delimiter=",", skiprows=1)
    write(file, 1e3 * p[:, 6:].reshape(40, 3, 3))
    plate.write_text(plate.read_text().replace(" [mm]", ""))
    in_mm = as_json(*WORDS, file, "--separations", plate, "--mm")
    for name in NAMES:
        np.testing.assert_allclose(in_mm["frames"][name], told["frames"][name], rtol=0, atol=1e-9)


def test_files_have_their_points_in_common(as_json, tmp_path):
    first = write(tmp_path / "a.csv", seen(T[:30], device=DEVICE), Q[:30])
    second = write(tmp_path / "b.csv", seen(T[30:], device=se3.inverse(DEVICE)), Q[30:])
    found = as_json(*WORDS, first, second, "--frame", "unknown")
    devices = [f"T_base_device of measurement set {k}" for k in (0, 1)]
    assert sorted(found["frames"]) == sorted([*devices, *NAMES])
    between = se3.inverse(np.array(found["frames"][devices[0]])) @ found["frames"][devices[1]]
    expected = se3.inverse(DEVICE) @ se3.inverse(DEVICE)
    np.testing.assert_allclose(between, expected, rtol=0, atol=1e-10)


def test_files_of_other_points_are_refused(refused, file, tmp_path):
    other = write(tmp_path / "b.csv", seen(T, TOOL[:2]))
    assert said(refused(*WORDS, file, other)) == (
        f"'{other}': 2 points a line, and 3 in '{file}': --point unknown is of the same points in all files"
    )


def said(message):
    return " ".join(message.replace("poekin: error: ", "").split())


OPTIONS = [
    (["--point", "unknown", "--point", "0,0,0"],
     "--point unknown: expected once and alone, for all points of the files"),
    (["--separations", "PLATE"], "--separations: expected with --point unknown only"),
    ([], "--point: the file has 3 points a line; say where they are in the tip frame, (k, 3), or --point unknown"),
    (["--point", "unknown", "--kind", "distances"], "kind is 'distances'"),
]  # fmt: skip


@pytest.mark.parametrize(("words", "message"), OPTIONS)
def test_options_that_do_not_fit_are_refused(refused, file, plate, words, message):
    words = [plate if word == "PLATE" else word for word in words]
    assert said(refused("calibrate", "ur5", file, *words)).endswith(message)


def test_unknown_points_of_poses_are_refused(refused, tmp_path):
    path = tmp_path / "a.csv"
    pk.calibration.write(path, ARM, MADE.q, MADE.measurements)
    message = "--point: expected with points or distances only, got poses"
    assert said(refused(*WORDS, path)) == message
    distances = pk.calibration.Distances(np.ones(len(Q)))
    pk.calibration.write(path, ARM, Q, distances)
    message = "--point unknown: expected with points only, got distances"
    assert said(refused(*WORDS, path)) == message


FAULTS = [
    ("1,4,100,0.1", "expected the number of a point, 1 to 3, got 4"),
    ("0,1,100,0.1", "expected the number of a point, 1 to 3, got 0"),
    ("1.5,1,100,0.1", "expected the number of a point, 1 to 3, got 1.5"),
    ("3,3,100,0.1", "expected two different points, got 3 twice"),
    ("2,2,100,0.1", "expected two different points, got 2 twice"),
    ("2,1,100,0.1", "the distance of 2 and 1 is there twice"),
    ("1,2,100,0.1", "the distance of 1 and 2 is there twice"),
    ("2,3,-1,0.1", "expected a distance above 0, got -0.001 m"),
    ("2,3,1,0", "expected a sigma above 0, got 0 m"),
    ("2,3,1,inf", "expected a sigma above 0, got inf m"),
]


@pytest.mark.parametrize(("line", "message"), FAULTS)
def test_a_fault_of_separations_is_named_with_file_and_line(refused, file, plate, line, message):
    plate.write_text("\n".join([*plate.read_text().splitlines()[:2], line]))
    assert said(refused(*WORDS, file, "--separations", plate)) == f"'{plate}':3: {message}"


def test_separations_that_are_none_are_refused(refused, file, plate):
    plate.write_text("from,to,distance,sigma\n")
    message = said(refused(*WORDS, file, "--separations", plate))
    assert message == f"'{plate}': expected distances between points, got none"
    plate.write_text("from,to,distance\n1,2,0.1\n")
    assert f"'{plate}':1: " in refused(*WORDS, file, "--separations", plate)


def test_the_document_has_the_points(poekin, file):
    code, text, _ = poekin(*WORDS, file, "--json")
    assert code == 0
    assert np.shape(json.loads(text)["frames"][NAMES[0]]) == (3,)
