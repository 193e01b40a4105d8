"""FactoryCalibration: a value, with the vendor's names, axes and flange."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from poekin.errors import InputError, PoekinError, PoseError, ShapeError
from poekin.formats.vendors import FactoryCalibration
from poekin.formats.vendors.naming import flexiv, ufactory
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be
from tests.messages import says

SIX = np.eye(4)[None].repeat(6, 0)
LIFT = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.1], [0, 0, 0, 1.0]])
Y = np.array([[0.0, 1.0, 0.0]] * 6)


def test_by_default_it_is_universal_robots_with_axes_z_and_the_last_link_s_flange():
    calibration = FactoryCalibration(SIX)
    assert calibration.vendor == "Universal Robots"
    np.testing.assert_array_equal(calibration.axes, [[0, 0, 1]] * 6)
    np.testing.assert_array_equal(calibration.flange, np.eye(4))
    assert calibration.to_robot().name == "ur"
    assert calibration.to_robot("mine").name == "mine"


def test_axes_and_flange_are_those_of_the_robot():
    robot = FactoryCalibration(SIX, "", flexiv(6), Y, LIFT).to_robot()
    assert all(joint.axis == (0, 1, 0) for joint in robot.joints[:-1])
    np.testing.assert_array_equal(robot.joint("link6_to_flange").origin, LIFT)
    assert robot.links == ("base_link", *(f"link{i}" for i in range(1, 7)), "flange")


def test_it_is_equal_where_all_of_it_is():
    naming = flexiv(6)
    whole = FactoryCalibration(SIX, "a", naming, Y, LIFT)
    assert pickle.loads(pickle.dumps(whole)) == whole
    assert hash(FactoryCalibration(SIX, "a", naming, Y, LIFT)) == hash(whole)
    others = [
        FactoryCalibration(SIX @ LIFT, "a", naming, Y, LIFT),
        FactoryCalibration(SIX, "b", naming, Y, LIFT),
        FactoryCalibration(SIX, "a", ufactory(6), Y, LIFT),
        FactoryCalibration(SIX, "a", naming, flange=LIFT),
        FactoryCalibration(SIX, "a", naming, Y),
    ]
    assert all(other != whole for other in others)


def test_its_arrays_are_read_only():
    calibration = FactoryCalibration(SIX, "", flexiv(6), Y, LIFT)
    for array in (calibration.poses, calibration.axes, calibration.flange):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


BAD: list[tuple[dict[str, Any], type[PoekinError], str]] = [
    (
        {"axes": Y[:5]},
        ShapeError,
        "axes: expected shape (6, 3), one axis a joint, got (5, 3)",
    ),
    (
        {"axes": [*Y[:5], Y[5], Y[5]]},
        ShapeError,
        "axes: expected shape (6, 3), one axis a joint, got (7, 3)",
    ),
    (
        {"axes": [*Y[:5], [0, 1, 1e-3]]},
        InputError,
        "axes[5]: expected a unit vector, got [0.0, 1.0, 0.001]",
    ),
    (
        {"axes": [[np.nan, 0, 1], *Y[:5]]},
        InputError,
        "axes[0]: expected a unit vector, got [nan, 0.0, 1.0]",
    ),
    (
        {"flange": 2 * np.eye(4)},
        PoseError,
        "flange is no pose: its last row is [0.0, 0.0, 0.0, 2.0], expected [0, 0, 0, 1]",
    ),
]


@pytest.mark.parametrize(("given", "kind", "message"), BAD)
def test_what_is_no_calibration_is_refused(given, kind, message):
    with pytest.raises(kind) as caught:
        FactoryCalibration(SIX, **given)
    # 1e-3 off y is 5e-7 off unit length
    assert says(caught.value, message)


def test_an_axis_may_be_off_unit_length_by_rounding():
    FactoryCalibration(SIX, axes=np.array([*Y[:5], [0, 1 + 9e-10, 0]]))
    with pytest.raises(InputError):
        FactoryCalibration(SIX, axes=np.array([*Y[:5], [0, 1 + 2e-9, 0]]))


@pytest.mark.parametrize("kind", dataclasses_of("poekin.formats.vendors", "naming calibration"))
def test_a_calibration_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)
