"""Words of `poekin calibrate` and `from-circles`: keywords as options, and what options say."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.cli.calibration import calibrate as command
from poekin.cli.calibration.circles import sweep_files
from poekin.errors import InputError

WORDS = [
    ("on_rank_deficiency='fix'", "--on-rank-deficiency fix"),
    ("with the readings coupled, 'a = b'", "with --coupling 'a = b'"),
    ("covariance=", "--sigma-angle and --sigma-length"),
    ("folds=0", "--folds 0"),
    ("give radians (numpy.deg2rad)", "--deg says so"),
    ("points: 3", "--point: 3"),
    ("points=None", "--point unknown"),
    ("points=(k, 3)", "--point (k, 3)"),
    ("frame='unknown'", "--frame unknown"),
    ("centre=None", "no --centre"),
    ("loss='huber'", "--loss huber"),
    ("prior={'rad': 1}", "--prior-angle and --prior-length {'rad': 1}"),
    ("rename=", "--rename"),
    ("rename: x", "--rename: x"),
    ("units: x", "--unit: x"),
    ("parameters=", "--parameters"),
    ("conditions['gravity']", "--gravity"),
    ("joints=", "--joints"),
    ("prior['rad']", "--prior-angle"),
    ("prior['m']", "--prior-length"),
    ("ignore=['a b', 'c'] passes it over", "--ignore 'a b', 'c' passes it over"),
    ("ignore=['x_t/[kg]'] passes it over", "--ignore 'x_t/[kg]' passes it over"),
    ("ignore=['a.b:c/+-1'] passes it over", "--ignore a.b:c/+-1 passes it over"),
]


@pytest.mark.parametrize(("keyword", "option"), WORDS)
def test_a_keyword_of_the_library_is_told_as_an_option(keyword, option):
    assert command.as_options(f"use {keyword}, or not") == f"use {option}, or not"


def test_deviations_before_the_measurement_are_by_unit():
    assert command._prior(None, None) is None
    assert command._prior(0.0, None) == {"rad": 0.0}
    assert command._prior(None, 2.0) == {"m": 2.0}
    assert command._prior(1.0, 2.0) == {"rad": 1.0, "m": 2.0}


def test_kinds_of_parameters_are_screws_and_home_or_those_that_are_said():
    assert command._kinds(None) == ("screws", "home")
    assert command._kinds(["home,offsets", "screws"]) == ("home", "offsets", "screws")
    assert command._kinds(["auto"]) == "auto"


@pytest.mark.parametrize(
    ("given", "terms", "parameters", "told"),
    [
        ({"time": 1, "payload": 2}, (), ("screws",), "time, payload"),
        ({"time": 1}, ("drift",), ("screws",), ""),
        ({"time": 1}, (), "auto", ""),
        ({}, (), ("screws",), ""),
        (None, (), ("screws",), ""),
    ],
)
def test_conditions_that_no_parameter_depends_on_are_told(given, terms, parameters, told, capsys):
    found: Any = SimpleNamespace(error_model=SimpleNamespace(terms=terms))
    command._complain_of_unread(found, {"conditions": given, "parameters": parameters})
    expected = ""
    if told:
        expected = f"poekin: nothing depends on {told}: --parameters auto, or the name of a term, takes it\n"
    assert capsys.readouterr().err == expected


ARM = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([1, 0, 0]), pk.screw.prismatic([0, 1, 0])],
    np.eye(4),
    joint_names=["turn", "slide", "lift"],
)  # fmt: skip
SOURCES = ["a.csv:2", "a.csv:3"]


@pytest.mark.parametrize(
    ("row", "other", "joint", "said"),
    [
        (0, 0, 1, "a.csv:2: turn is off by 0.0123 rad from where it stands; expected slide alone"),
        (1, 0, 2, "a.csv:3: turn is off by 0.0123 rad from where it stands; expected lift alone"),
        (1, 1, 0, "a.csv:3: slide is off by 0.0123 m from where it stands; expected turn alone"),
        (0, 2, 1, "a.csv:2: lift is off by 0.0123 m from where it stands; expected slide alone"),
    ],
)
def test_a_joint_that_does_not_stand_is_told_in_its_unit(row, other, joint, said):
    off = np.full((2, 3), 0.5 * sweep_files.HELD)
    sweep_files._check_stands(off, SOURCES, ARM, joint)
    off[row, other] = sweep_files.HELD
    sweep_files._check_stands(off, SOURCES, ARM, joint)
    off[row, other] = 0.012345
    with pytest.raises(InputError) as refused:
        sweep_files._check_stands(off, SOURCES, ARM, joint)
    assert str(refused.value) == f"{said} to move, the others within {sweep_files.HELD:g}"


def test_a_joint_that_slides_and_is_none_is_told_with_one_that_is_like_it():
    arm = sweep_files._arm(["turn", "slide"], ["slide"])
    assert (arm.joint_names, arm.kinds) == (("turn", "slide"), ("revolute", "prismatic"))
    with pytest.raises(pk.errors.UnknownName) as refused:
        sweep_files._arm(["turn", "slide"], ["turn", "slid"])
    assert str(refused.value).partition("did you mean")[::2] == (
        "--prismatic: no joint 'slid'; ",
        " 'slide'?",
    )
