"""--rename of calibrate and choose-poses: columns of the file under the names that they are to have."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.cli.calibration.options.columns import renamed_columns


@pytest.fixture
def tracker(crane, tmp_path):
    """A file of a tracker: points in mm, joints in degrees and mm, a column of names."""
    arm = pk.load(crane).chain(tip="hook")
    q = arm.random(4, 30)
    p = arm.fk(q)[:, :3, 3] + np.random.default_rng(2).normal(scale=1e-4, size=(30, 3))
    lines = ["# tracker", "name;J1;J2;X meas;Y meas;Z meas"]
    for k in range(30):
        row = [np.degrees(q[k, 0]), 1e3 * q[k, 1], *(1e3 * p[k])]
        lines.append(";".join([f"P{k}", *(f"{x:.9f}".replace(".", ",") for x in row)]))
    path = tmp_path / "tracker.csv"
    path.write_text("\n".join(lines) + "\n")
    return path


NAMES = ["--rename", "X meas=x", "--rename", "Y meas=y", "--rename", "Z meas=z"]
UNITS = ["--deg", "--mm", "--ignore", "name"]


def test_a_tracker_s_file_is_calibrated_from_as_it_came(as_json, crane, tracker):
    said = as_json(
        "calibrate", crane, tracker, "--tip", "hook", "--folds", 0, "--joints", "turn", *NAMES, *UNITS
    )  # fmt: skip
    assert said["after"]["rms_length"] == pytest.approx(1.7e-4, rel=0.2)  # noise of 0.1 mm in three


def test_the_next_configurations_are_chosen_beside_a_tracker_s_file(poekin, crane, tracker):
    words = ["choose-poses", crane, 2, "--tip", "hook", "--candidates", 20, "--measured", tracker]
    code, _, err = poekin(*words, *NAMES, *UNITS)
    assert code == 0
    assert "2 of 20 configurations beside 30 measured ones" in err


@pytest.mark.parametrize("command", ["calibrate", "choose-poses"])
def test_columns_that_nothing_is_known_of_are_refused_with_the_option(
    command, refused, crane, tracker
):
    file = [tracker] if command == "calibrate" else [2, "--measured", tracker]
    words = [command, crane, *file, "--tip", "hook", "--ignore", "name"]
    said = refused(*words)
    assert ":2: 'X meas' is neither a coordinate nor part of a measurement" in said
    assert "; --rename says what it is, --ignore 'X meas' passes it over" in said
    said = refused(*words, "--rename", "X=x")
    assert ":2: --rename: no column 'X'; available: 'name', 'J1'" in said


@pytest.mark.parametrize("word", ["x", "=x", "x="])
def test_a_name_alone_renames_nothing(word, refused, crane, tracker):
    said = refused("calibrate", crane, tracker, "--tip", "hook", "--rename", word)
    assert said == (
        "poekin: error: --rename: expected the column's name in the file, = and the name that it is to have, "
        f"as x_t=x; got '{word}'\n"
    )


def test_the_first_equals_sign_parts_the_names():
    assert renamed_columns(["a=b=c", "d=e [mm]"]) == {"a": "b=c", "d": "e [mm]"}
    assert renamed_columns(None) == {}
