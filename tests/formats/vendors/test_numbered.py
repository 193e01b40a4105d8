"""Files with joint1, joint2, ...: UFACTORY's and Flexiv's, told apart and read as they are meant."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import ModelError, PoekinWarning
from poekin.formats.vendors.known_arms import RIZON
from poekin.formats.vendors.yaml_io import RpyAxes, read_text
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle
from tests.formats.vendors.origins import (
    RIZON_4S,
    RIZON_AXES,
    RIZON_FLANGE,
    UFACTORY,
    urdf,
    yaml,
)
from tests.messages import says

RIZON_YAML = yaml(RIZON_4S, axes=RIZON_AXES, flange=RIZON_FLANGE)
XARM7 = yaml(UFACTORY["xarm7"])
METADATA = """
calibration_metadata:
  robot_sn: "Rizon4s-123456"
  model_name: "Rizon4s"
  robot_software_ver: "v3.9"
  joints_synced: {}
"""
# An Enlight L: config/EnlightL/default_kinematics.yaml of flexiv_description, turns rounded.
ENLIGHT = [
    (0, 0, 0.146, 0, 0, 0),
    (0, -0.037, 0.114, 1.5708, 0, 0),
    (0, 0.181, -0.037, -1.5708, 0, 0),
    (0, 0.037, 0.109, -1.5708, 0, 0),
    (0, -0.156, -0.037, 1.5708, 0, 0),
    (0, -0.0261, 0.124, 1.5708, 0, 0),
    (0, 0.134, -0.0261, -1.5708, 0, 0),
]
SMALL = st.floats(-2e-3, 2e-3)


@st.composite
def measured(draw):
    """Name, rows and joints' axes of an arm whose origins are off by millimetres and mrad."""
    name = draw(st.sampled_from([*UFACTORY, "Rizon4s"]))
    rows = UFACTORY.get(name, RIZON_4S)
    six = st.lists(SMALL, min_size=6, max_size=6)
    return name, [tuple(np.add(row, draw(six)).tolist()) for row in rows]


def poses(oracle, q, base, tip):
    names = [f"joint{i + 1}" for i in range(q.shape[1])]
    return oracle.poses(dict(zip(names, q.T, strict=True)), tip, base)


@settings(max_examples=25)
@given(arm=measured(), seed=st.integers(0, 2**32))
def test_pinocchio_sees_the_same_arm_in_the_urdf_of_the_same_numbers(arm, seed):
    name, rows = arm
    flexiv = name == "Rizon4s"
    axes, base, tip, flange = (), "link_base", "link_eef", (0, 0, 0, 0, 0, 0)
    text = yaml(rows)
    if flexiv:
        axes, base, tip, flange = RIZON_AXES, "base_link", "flange", RIZON_FLANGE
        text = yaml(rows, axes=axes, flange=flange)
    found = read_text(text)
    assert found.vendor == ("Flexiv" if flexiv else "UFACTORY")
    chain = found.to_chain()
    assert (chain.base, chain.tip) == (base, tip)
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, (10, len(rows)))
    oracle = PinocchioOracle(urdf(rows, base=base, tip=tip, axes=axes, flange=flange))
    # The bound of Chain.fk, 8 (n + 1) + 4 sum |x| u, for either: 3e-14 at 7 joints of up to pi.
    u = 2.0**-53
    bound = 2 * (8 * (len(rows) + 1) + 4 * np.abs(q).sum(axis=1).max()) * u * chain.reach
    assert np.abs(chain.fk(q) - poses(oracle, q, base, tip)).max() <= bound


def test_a_calibrated_rizon_4s_is_to_1e14_what_pinocchio_reads_in_its_urdf():
    chain = read_text(RIZON_YAML).to_chain()
    oracle = PinocchioOracle(
        urdf(RIZON_4S, base="base_link", tip="flange", axes=RIZON_AXES, flange=RIZON_FLANGE)
    )
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (100, 7))
    assert np.abs(chain.fk(q) - poses(oracle, q, "base_link", "flange")).max() <= 1e-14


@pytest.mark.parametrize(
    ("name", "flange"),
    [
        ("xarm5", (0.207, 0, 0.112)),
        ("xarm6", (0.207, 0, 0.112)),
        ("xarm7", (0.206, 0, 0.1205)),
        ("lite6", (0.087, 0, 0.15359)),
        ("uf850", (0.15, 0, 0.238)),
    ],
)
def test_the_flange_of_ufactory_s_arms_is_where_their_drawings_have_it(name, flange):
    """A quarter turn of 1.5708 is 3.7e-6 rad off, on lengths of less than 1 m."""
    home = read_text(yaml(UFACTORY[name])).to_chain().home
    np.testing.assert_allclose(home[:3, 3], flange, atol=1e-5)


def test_angles_turn_about_fixed_axes_unless_something_else_is_said():
    text = yaml(UFACTORY["lite6"])
    assert read_text(text) == read_text(text, rpy="fixed") == read_text("rpy: fixed\n" + text)
    moving = read_text(text, rpy="moving")
    assert moving == read_text("rpy: moving\n" + text)
    # (0, 490, 330) mm is where the other reading would have the flange.
    np.testing.assert_allclose(moving.to_chain().home[:3, 3], (0, 0.49, 0.33), atol=1e-2)


def test_the_flange_s_angles_turn_about_the_axes_that_are_said_as_the_joints_do():
    roll, pitch, yaw = (pk.so3.exp(turn) for turn in np.diag([0.3, 0.4, 0.5]))
    text = yaml(RIZON_4S, axes=RIZON_AXES, flange=(0.1, 0, 0, 0.3, 0.4, 0.5))
    turned: dict[RpyAxes, np.ndarray] = {
        "fixed": yaw @ pitch @ roll,
        "moving": roll @ pitch @ yaw,
    }
    for axes, R in turned.items():
        np.testing.assert_allclose(read_text(text, rpy=axes).flange[:3, :3], R, atol=1e-14)


@pytest.mark.parametrize("name", UFACTORY)
def test_a_file_of_ufactory_is_known_by_its_numbers(name):
    found = read_text(yaml(UFACTORY[name]))
    assert found.vendor == "UFACTORY"
    assert found.naming.joints == tuple(f"joint{i + 1}" for i in range(len(UFACTORY[name])))
    np.testing.assert_array_equal(found.axes, [[0, 0, 1]] * len(found.poses))
    assert found.to_robot().name == "ufactory"


@pytest.mark.parametrize(
    ("rows", "axes"), [(RIZON_4S, RIZON), (ENLIGHT, [[0, 0, 1]] * 7)], ids=["Rizon", "Enlight"]
)
@pytest.mark.parametrize("flange", [None, RIZON_FLANGE], ids=["no flange", "flange"])
def test_a_file_of_flexiv_without_axes_has_those_of_the_arm_that_it_fits(rows, axes, flange):
    found = read_text(yaml(rows, flange=flange))
    assert found.vendor == "Flexiv"
    np.testing.assert_array_equal(found.axes, axes)
    tip = "link7"
    if flange:
        tip = "flange"
    assert found.to_chain().tip == tip
    assert found.to_robot().leaves == (tip,)
    assert found.to_robot().name == "flexiv"


def test_axes_that_are_written_count_and_z_where_only_others_are():
    rows = UFACTORY["xarm7"]
    found = read_text(yaml(rows, axes=("", "0 3 4")))
    assert found.vendor == "Flexiv"
    np.testing.assert_allclose(found.axes[:3], [[0, 0, 1], [0, 0.6, 0.8], [0, 0, 1]], atol=1e-16)


def far(rows):
    """Rows of an arm that nobody knows."""
    return [(row[0], row[1] + 0.1, *row[2:]) for row in rows]


def test_metadata_make_it_flexiv_s_and_name_the_model_and_the_arm():
    found = read_text(yaml(far(RIZON_4S)) + METADATA.format(7))
    assert (found.vendor, found.hash) == ("Flexiv", "Rizon4s-123456")
    np.testing.assert_array_equal(found.axes, RIZON)
    marked = read_text(yaml(RIZON_4S) + "  hash: mine\n" + METADATA.format(7))
    assert marked.hash == "mine"


@pytest.mark.parametrize(("synced", "said"), [("6", True), ("7", False), ("many", False)])
def test_joints_that_are_not_measured_are_said(synced, said):
    text = RIZON_YAML + METADATA.format(synced)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        read_text(text, "f.yaml")
    line = text[: text.index("joints_synced")].count("\n") + 1
    expected = [f"f.yaml:{line}: only 6 of 7 joints are measured, the others are nominal"]
    assert [str(w.message) for w in caught] == (expected if said else [])
    assert all(issubclass(w.category, PoekinWarning) for w in caught)


def test_the_vendor_of_an_arm_that_nobody_knows_must_be_said():
    text = yaml(far(UFACTORY["xarm7"]))
    with pytest.raises(ModelError) as caught:
        read_text(text, "f.yaml")
    assert re.fullmatch(
        r"f\.yaml: expected an arm of UFACTORY or Flexiv, and this is near none that is known: of the"
        r" nearest, '[\w -]+', 'joint\d' is [\d.e+]+ mm and [\d.]+° off; vendor='UFACTORY' or"
        r" vendor='Flexiv' of pk\.vendors\.read says which it is",
        str(caught.value),
    )
    assert read_text(text, vendor="UFACTORY").vendor == "UFACTORY"
    assert read_text(yaml(far(UFACTORY["xarm6"]))).vendor == "UFACTORY"
    with pytest.raises(ModelError) as caught:
        read_text(text, "f.yaml", vendor="Flexiv")
    assert says(
        caught.value,
        "f.yaml: no joint states its axis, and it is near no arm of Flexiv that is known: write"
        " axis: 0 1 0 below each joint that turns about y, and axis: 0 0 1 below one that turns about z",
    )


def test_a_rizon_has_seven_joints():
    text = yaml(UFACTORY["xarm6"]) + METADATA.format(7)
    with pytest.raises(ModelError, match="no joint states its axis"):
        read_text(text)


def test_an_arm_of_ufactory_is_no_guide_to_the_axes_of_flexiv_s():
    with pytest.raises(ModelError, match="no joint states its axis"):
        read_text(XARM7, vendor="Flexiv")


ONLY = "only joint1, joint2, joint3, joint4, joint5, joint6, link6_to_flange, hash"
XARM6 = yaml(UFACTORY["xarm6"])
BAD = {
    "four joints": (
        yaml(UFACTORY["xarm5"][:4]),
        "f.yaml:2: kinematics: expected joint1 to joint5, joint6 or joint7, got 'joint1', 'joint2',"
        " 'joint3', 'joint4'",
    ),
    "eight joints": (
        yaml([*UFACTORY["xarm7"], (0, 0, 0, 0, 0, 0)]),
        "f.yaml:2: kinematics: expected joint1 to joint5, joint6 or joint7, got 'joint1', ...",
    ),
    "misspelt joint": (
        yaml(UFACTORY["xarm7"]).replace("joint3", "jiont3"),
        f"f.yaml:16: kinematics: 'jiont3' is not expected, {ONLY}; did you mean 'joint3' or ...",
    ),
    "a joint left out": (
        yaml(UFACTORY["xarm7"]).replace("joint3", "joint8"),
        "f.yaml:16: kinematics: 'joint8' is not expected, only joint1, ...",
    ),
    "a joint missing": (
        yaml(UFACTORY["xarm6"]).replace("joint4", "joint04"),
        "f.yaml:23: kinematics: 'joint04' is not expected, only joint1, ...",
    ),
    "flange of another joint": (
        XARM6 + "  link7_to_flange:\n    x: 0\n",
        f"f.yaml:44: kinematics: 'link7_to_flange' is not expected, {ONLY}; did you mean ...",
    ),
    "joint is a number": (
        "kinematics:\n  joint1: 3\n" + XARM6[XARM6.index("  joint2") :],
        "f.yaml:2: joint1: expected x, y, z, roll, pitch, yaw below it, got '3'",
    ),
    "key missing": (
        XARM6.replace("    yaw: 0\n", "", 1),
        "f.yaml:3: joint1: yaw missing; expected are x, y, z, roll, pitch, yaw, axis",
    ),
    "degrees": (
        XARM6.replace("-1.5708", "-90 deg", 1),
        "f.yaml:13: joint2: roll: expected a finite number, got '-90 deg'",
    ),
    "two numbers": (
        yaml(UFACTORY["xarm6"], axes=("0 1",)),
        "f.yaml:9: joint1: axis: expected three numbers, as 0 1 0, got '0 1'",
    ),
    "a word": (
        yaml(UFACTORY["xarm6"], axes=("0 1 z",)),
        "f.yaml:9: joint1: axis: expected three numbers, as 0 1 0, got '0 1 z'",
    ),
    "three zeros": (
        yaml(UFACTORY["xarm6"], axes=("0 0 0",)),
        "f.yaml:9: joint1: axis: expected three numbers, as 0 1 0, got '0 0 0'",
    ),
    "no numbers": (
        yaml(UFACTORY["xarm6"], axes=("nan 0 1",)),
        "f.yaml:9: joint1: axis: expected three numbers, as 0 1 0, got 'nan 0 1'",
    ),
    "huge": (
        yaml(UFACTORY["xarm6"], axes=("1e999 0 1",)),
        "f.yaml:9: joint1: axis: expected three numbers, as 0 1 0, got '1e999 0 1'",
    ),
    "axis of keys": (
        yaml(UFACTORY["xarm6"], axes=("{x: 1}",)),
        "f.yaml:9: axis: expected a text",
    ),
    "axis of the flange": (
        RIZON_YAML + "    axis: 0 0 1\n",
        f"f.yaml:{RIZON_YAML.count(chr(10)) + 1}: link7_to_flange: 'axis' is not expected, only x, ...",
    ),
    "metadata of nothing": (
        RIZON_YAML + "calibration_metadata: 7\n",
        f"f.yaml:{RIZON_YAML.count(chr(10)) + 1}: calibration_metadata: expected keys below it",
    ),
    "model of keys": (
        yaml(far(RIZON_4S)) + METADATA.format(7).replace('"Rizon4s"', "{a: 1}"),
        f"f.yaml:{yaml(RIZON_4S).count(chr(10)) + 4}: model_name: expected a text",
    ),
    "far away": (
        XARM6.replace("0.267", "1e200"),
        "f.yaml: pose of joint1: expected lengths of at most 1e+100 m, got 1e+200 in row 2",
    ),
}


@pytest.mark.parametrize(("text", "message"), BAD.values(), ids=BAD)
def test_a_fault_in_a_file_is_said_with_its_line(text, message):
    with pytest.raises(ModelError) as caught:
        read_text(text, "f.yaml")
    assert says(caught.value, message)


def test_load_reads_them(tmp_path):
    path = tmp_path / "kinematics.yaml"
    path.write_text(RIZON_YAML, encoding="utf-8")
    assert pk.load(path).q_names == tuple(f"joint{i + 1}" for i in range(7))
