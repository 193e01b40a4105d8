"""--unit of calibrate and choose-poses: units where the first line of a file says none."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.cli.calibration.options.columns import convention_of
from poekin.errors import InputError

NAMES = ("turn", "slide", "x", "y", "z", "load")


@pytest.fixture
def file(crane, tmp_path):
    """Points in mm, an angle in degrees and a stroke in m, and masses in g under another name."""
    arm = pk.load(crane).chain(tip="hook")
    q = arm.random(4, 30)
    p = arm.fk(q)[:, :3, 3] + np.random.default_rng(2).normal(scale=1e-4, size=(30, 3))
    rows = np.column_stack([np.degrees(q[:, 0]), q[:, 1], 1e3 * p, np.arange(30.0)])
    path = tmp_path / "a.csv"
    np.savetxt(path, rows, delimiter=";", header=";".join(NAMES), comments="")
    return path


UNITS = ["--unit", "deg", "--unit", "x,y,z=mm"]
LOAD = ["--rename", "load=payload", "--unit", "payload=g"]
BRIEF = ["--tip", "hook", "--folds", 0, "--joints", "turn"]


def test_units_of_all_angles_and_of_some_columns_are_said_apart(as_json, poekin, crane, file):
    said = as_json("calibrate", crane, file, *BRIEF, *UNITS, "--ignore", "load")
    assert said["after"]["rms_length"] == pytest.approx(1.7e-4, rel=0.2)  # noise of 0.1 mm in three
    _, _, err = poekin("calibrate", crane, file, *BRIEF, *UNITS, *LOAD)
    assert "nothing depends on payload" in err.replace("\n", " ")
    more = ["--measured", file, "--tip", "hook", "--candidates", 20]
    code, _, err = poekin("choose-poses", crane, 2, *more, *UNITS, *LOAD)
    assert code == 0
    assert "2 of 20 configurations beside 30 measured ones" in err


def test_a_unit_of_all_is_the_option_of_its_own(crane):
    for word, mm, deg in (("mm", True, None), ("m", False, None), ("rad", None, False)):
        found = convention_of(None, None, None, [word], None)
        assert (found.mm, found.deg, found.units) == (mm, deg, {})
    both = convention_of(None, None, True, ["mm, deg"], None)
    assert (both.mm, both.deg) == (True, True)
    assert convention_of(None, None, None, ["a=b, c=h"], None).units == {"a=b": "h", "c": "h"}
    assert convention_of(None, None, None, ["x, y = mm"], None).units == {"x": "mm", "y": "mm"}


REFUSED = [
    (
        ["mm, inch"],
        "--unit: expected 'mm', 'm', 'deg' or 'rad', or columns with their unit as in x,y,z=mm,"
        " got 'inch'",
    ),
    (
        ["x,y=inch"],
        "--unit 'x,y=inch': expected 'mm', 'm', 'deg', 'rad', 'kg', 'g', 'K', 'C', '°C', 's', 'ms',"
        " 'min' or 'h',"
        " got 'inch'",
    ),
    (["m,mm"], "--unit: mm, and another unit of the same numbers was said"),
]


@pytest.mark.parametrize(("words", "message"), REFUSED)
def test_units_that_there_are_not_are_refused_in_words(words, message):
    with pytest.raises(InputError) as caught:
        convention_of(None, None, None, words, None)
    assert str(caught.value) == message


def test_a_unit_of_no_column_and_one_beside_the_header_s_are_refused(refused, crane, file):
    words = ("calibrate", crane, file, *BRIEF, "--ignore", "load")
    said = refused(*words, "--unit", "X=mm").replace("\n", " ")
    assert "a.csv:1: --unit: no column 'X'; did you mean 'x'?" in said
    said = refused(*words, "--deg", "--unit", "rad").replace("\n", " ")
    assert "--unit: rad, and another unit of the same numbers was said" in said
    said = refused(*words, "--unit", "turn=mm").replace("\n", " ")
    assert "a.csv:1: 'turn' in mm; expected rad or deg" in said


def test_six_numbers_of_a_pose_are_asked_about_with_what_they_may_be(refused, crane, tmp_path):
    path = tmp_path / "b.csv"
    path.write_text("turn,slide,x,y,z,rx,ry,rz\n0,0,1,2,3,0.1,0.2,0.3\n")
    said = refused("calibrate", crane, path, *BRIEF).replace("\n", " ")
    assert (
        "the columns x y z rx ry rz make a pose of 'rotvec' (a rotation vector, m and rad), 'ur' (a rotation"
        " vector, m and rad), 'staubli' (angles, mm and deg), 'yaskawa' (angles, mm and deg): format="
        " (--format) says of which"
    ) in said
