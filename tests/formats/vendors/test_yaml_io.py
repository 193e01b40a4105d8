"""One reader and one writer for all vendors: what they write comes back, several arms are asked for."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ModelError, PoekinError
from poekin.formats.vendors import FactoryCalibration
from poekin.formats.vendors.naming import UR, flexiv, ufactory
from poekin.formats.vendors.yaml_io import make_text, read_text
from tests.formats.vendors.origins import (
    RIZON_4S,
    RIZON_AXES,
    RIZON_FLANGE,
    UFACTORY,
    UR5E,
    UR_LINKS,
    yaml,
)
from tests.messages import says

XARM6 = read_text(yaml(UFACTORY["xarm6"]))
RIZON = read_text(yaml(RIZON_4S, axes=RIZON_AXES, flange=RIZON_FLANGE))
TWO_ARMS = (
    "kinematics:\n  EXT_AXIS:\n    left_arm_adapter:\n      y: 0.2\n  ARM_1:\n"
    + yaml(RIZON_4S, axes=RIZON_AXES, flange=RIZON_FLANGE, indent="  ")
    + "  ARM_2:\n"
    + yaml(RIZON_4S, axes=RIZON_AXES, indent="  ")
)

small = st.floats(-2e-3, 2e-3)


@settings(max_examples=50)
@given(
    calibration=st.sampled_from([XARM6, RIZON, read_text(yaml(RIZON_4S, axes=RIZON_AXES))]),
    twist=st.lists(small, min_size=6, max_size=6),
    mark=st.text(max_size=20),
    rpy=st.sampled_from(["fixed", "moving"]),
)
def test_a_calibration_comes_back_from_its_file(calibration, twist, mark, rpy):
    tilted = FactoryCalibration(
        calibration.poses @ pk.se3.exp(twist),
        mark,
        calibration.naming,
        calibration.axes,
        calibration.flange,
    )
    again = read_text(make_text(tilted, rpy=rpy))
    assert (again.hash, again.naming) == (mark, tilted.naming)
    assert np.array_equal(again.poses[:, :3, 3], tilted.poses[:, :3, 3])
    assert np.array_equal(again.axes, tilted.axes)
    for mine, theirs in ((again.poses, tilted.poses), (again.flange, tilted.flange)):
        # the bound of rpy.angles and pose, twice
        assert np.abs(mine - theirs).max() <= 1e-15


def test_the_text_is_the_vendor_s_form():
    lines = make_text(XARM6).splitlines()
    assert lines[:3] == ["kinematics:", "  joint1:", "    x: 0.0"]
    assert len(lines) == 1 + 6 * 7
    assert make_text(XARM6, rpy="moving").splitlines()[0] == "rpy: moving"
    rizon = make_text(RIZON).splitlines()
    assert rizon[8] == "    axis: 0.0 0.0 1.0"
    assert rizon[16] == "    axis: 0.0 1.0 0.0"
    assert rizon[-7] == "  link7_to_flange:"
    assert len(rizon) == 1 + 7 * 8 + 7
    assert (
        make_text(FactoryCalibration(np.eye(4)[None].repeat(6, 0))).splitlines()[-1] == '  hash: ""'
    )
    marked = FactoryCalibration(RIZON.poses, "sn-1", RIZON.naming, RIZON.axes, RIZON.flange)
    assert make_text(marked).splitlines()[-1] == '  hash: "sn-1"'


@pytest.mark.parametrize(
    ("axes", "flange"),
    [
        (np.array([[0, 1, 0]] * 6), np.eye(4)),
        (np.array([[0, 0, 1]] * 6), pk.se3.exp([0, 0, 0, 0, 0, 0.1])),
    ],
    ids=["axes", "flange"],
)
@pytest.mark.parametrize("naming", [UR, ufactory(6)], ids=lambda naming: naming.vendor)
def test_what_the_vendor_s_form_has_no_place_for_is_not_written(naming, axes, flange, tmp_path):
    calibration = FactoryCalibration(XARM6.poses, "", naming, axes, flange)
    with pytest.raises(InputError) as caught:
        pk.vendors.write(calibration, tmp_path / "a.yaml")
    assert says(
        caught.value,
        f"write: the form of {naming.vendor} has no place for axes other than z, nor for a flange",
    )
    assert list(tmp_path.iterdir()) == []


def test_of_two_arms_the_one_that_is_named_is_read():
    left = read_text(TWO_ARMS, arm="ARM_1")
    assert left == RIZON
    right = read_text(TWO_ARMS, arm="ARM_2")
    assert right.naming == flexiv(7, flange=False)
    np.testing.assert_array_equal(right.poses, RIZON.poses)


@pytest.mark.parametrize(
    ("text", "arm", "message"),
    [
        (
            TWO_ARMS,
            None,
            "f.yaml:2: kinematics: it has the arms 'ARM_1', 'ARM_2', and none was named: arm= of"
            " pk.vendors.read says which, --arm on the command line",
        ),
        (
            TWO_ARMS,
            "left",
            "f.yaml:2: kinematics: it has the arms 'ARM_1', 'ARM_2', and got 'left': arm= of"
            " pk.vendors.read says which, --arm on the command line",
        ),
        (
            yaml(UFACTORY["xarm6"]),
            "ARM_1",
            "f.yaml:2: kinematics: expected the arm 'ARM_1', and it has one arm, unnamed",
        ),
        (
            "kinematics:\n  ARM_1: 3\n",
            None,
            "f.yaml:2: kinematics: expected shoulder, upper_arm, forearm, wrist_1, wrist_2, wrist_3"
            " and hash, or joint1, joint2, ... below it",
        ),
        (
            "kinematics:\n  axis_1:\n    x: 3\n",
            None,
            "f.yaml:2: kinematics: expected shoulder, upper_arm, forearm, wrist_1, wrist_2, wrist_3"
            " and hash, or joint1, joint2, ... below it",
        ),
    ],
    ids=["none named", "another named", "one arm", "arm of nothing", "no vendor's names"],
)
def test_an_arm_that_is_not_there_is_refused(text, arm, message):
    with pytest.raises(ModelError) as caught:
        read_text(text, "f.yaml", arm=arm)
    assert says(caught.value, message)


def test_a_vendor_that_the_file_is_not_of_is_refused():
    mine = yaml(UR5E, names=UR_LINKS)
    assert read_text(mine, vendor="Universal Robots").naming == UR
    with pytest.raises(InputError) as caught:
        read_text(mine, "f.yaml", vendor="Flexiv")
    assert says(caught.value, "vendor: f.yaml is of Universal Robots, got 'Flexiv'")
    with pytest.raises(InputError) as caught:
        read_text(yaml(UFACTORY["xarm6"]), "f.yaml", vendor="Universal Robots")
    assert says(caught.value, "vendor: f.yaml is of UFACTORY or Flexiv, got 'Universal Robots'")
    nobody = "KUKA"
    with pytest.raises(InputError) as caught:
        read_text(mine, vendor=nobody)  # type: ignore[arg-type]
    assert says(
        caught.value,
        "vendor: expected 'Universal Robots', 'UFACTORY' or 'Flexiv', got 'KUKA'",
    )


def test_a_real_ur5e_is_within_millimetres_of_the_nominal_one():
    calibration = read_text(yaml(UR5E, names=UR_LINKS))
    moved = calibration.to_chain().home[:3, 3] - pk.load("ur5e").chain().home[:3, 3]
    assert 1e-4 < np.linalg.norm(moved) < 5e-3


VENDOR_TEXTS = {
    "Universal Robots": yaml(UR5E, names=UR_LINKS),
    "Flexiv": yaml(RIZON_4S, axes=RIZON_AXES, flange=RIZON_FLANGE),
}


@pytest.mark.parametrize("vendor", VENDOR_TEXTS)
@settings(max_examples=100)
@given(data=st.data())
def test_a_file_with_any_text_in_it_is_read_or_refused_with_an_error_of_ours(vendor, data):
    lines = VENDOR_TEXTS[vendor].splitlines()
    line = data.draw(st.integers(0, len(lines) - 1))
    at = data.draw(st.integers(0, 30))
    junk = data.draw(st.text(max_size=12))
    lines[line] = lines[line][:at] + junk + lines[line][at:]
    said = "printable"
    try:
        read_text("\n".join(lines))
    except PoekinError as refusal:
        said = str(refusal)
    assert said.isprintable()
