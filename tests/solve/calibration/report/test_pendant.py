"""Frames as controllers show them: names, order, units, digits, margins, and what is held."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.groups import se3
from poekin.solve.calibration.diagnostics.base_and_tool import FrameEstimate
from poekin.solve.calibration.report import pendant

# unturned, so that each number moves with one motion of the frame: of x y z, and about x y z
PLACE = se3.pose(np.eye(3), [0.1, -0.2, 0.3])
DEVIATIONS = np.array([1e-3, 2e-3, 3e-3, 1e-4, 2e-4, 3e-4])
NOTHING = np.zeros((6, 0))
METRES = ["x 0.100000 ± 0.000196", "y -0.200000 ± 0.000392", "z 0.300000 ± 0.000588"]
MILLIMETRES = ["X 100.000 ± 0.196", "Y -200.000 ± 0.392", "Z 300.000 ± 0.588"]


def frame(held: Any = NOTHING, name: str = "T_base_board") -> FrameEstimate:
    return FrameEstimate(name, PLACE, np.diag(DEVIATIONS**2), np.asarray(held, float))


# 1.96 deviations: 1.96, 3.92 and 5.88 mrad, or 0.1123, 0.2246 and 0.3369 degrees
@pytest.mark.parametrize(("form", "units", "numbers"), [
    ("ur", "m, rad", [*METRES, "rx 0.000000 ± 0.001960", "ry 0.000000 ± 0.003920",
                      "rz 0.000000 ± 0.005880"]),
    ("kuka", "mm, deg", [*MILLIMETRES, "A 0.0000 ± 0.3369", "B 0.0000 ± 0.2246",
                         "C 0.0000 ± 0.1123"]),
    ("fanuc", "mm, deg", [*MILLIMETRES, "W 0.0000 ± 0.1123", "P 0.0000 ± 0.2246",
                          "R 0.0000 ± 0.3369"]),
    ("rpy", "m, rad", [*METRES, "roll 0.000000 ± 0.001960", "pitch 0.000000 ± 0.003920",
                       "yaw 0.000000 ± 0.005880"]),
    ("ros", "m", [*METRES, "qx 0.0000000 ± 0.0009800", "qy 0.0000000 ± 0.0019600",
                  "qz 0.0000000 ± 0.0029399", "qw 1.0000000 ± 0.0000000"]),
])  # fmt: skip
def test_numbers_have_the_controller_s_names_units_and_digits(form, units, numbers):
    assert pendant.units(form) == units
    assert [str(number) for number in pendant.typed(frame(), form)] == numbers


@pytest.mark.parametrize(
    ("form", "names", "limit"),
    [
        ("ur", ("rz", "y"), 0.1),
        ("kuka", ("A", "Y"), 0.1),
        ("fanuc", ("R", "Y"), 0.1),
        ("rpy", ("yaw", "y"), 0.1),
        ("ros", ("qz", "y"), 0.2),  # a quaternion has half the angle
    ],
)
def test_a_number_is_held_that_a_held_motion_changes_by_a_tenth(form, names, limit):
    for axis, name, least in ((2, names[0], limit), (4, names[1], 0.1)):
        for size, seen in ((0.9996, False), (1.0004, True), (-1.0004, True)):
            motions = np.zeros((6, 2))
            motions[axis, 1] = size * least
            held = [n.name for n in pendant.typed(frame(motions), form) if n.held]
            assert held == [name] * seen


def test_a_frame_is_held_where_all_of_its_numbers_are():
    assert pendant.is_held(frame(np.eye(6)))
    assert not pendant.is_held(frame(np.eye(6)[:, 1:]))
    assert not pendant.is_held(frame())


def test_frames_are_told_in_all_forms_with_their_names():
    found: Any = SimpleNamespace(
        nominal=SimpleNamespace(base="floor", tip="flange"),
        tool_and_base=(
            frame(np.eye(6), "base"),
            frame(name="tool"),
            frame(np.eye(6), "tripod"),
            frame(np.eye(6), "arc"),
        ),
    )
    base, tool, *forms, tripod, arc = pendant.lines(found)
    held = ": held, these measurements do not tell it"
    assert base == f"base 'floor' in the frame that was measured in{held}"
    assert tool == "tool in the nominal tip 'flange', to be typed in (± 95 %):"
    assert (tripod, arc) == (f"tripod{held}", f"arc{held}")
    assert [line.partition(":")[0] for line in forms] == [
        "  UR (m, rad)",
        "  KUKA (mm, deg)",
        "  Fanuc (mm, deg)",
        "  ROS xyz rpy (m, rad)",
        "  ROS xyz xyzw (m)",
    ]
    assert forms[1].startswith("  KUKA (mm, deg): X 100.000 ± 0.196  Y -200.000 ± 0.392  Z ")


def test_a_number_that_rounds_to_nothing_has_no_sign_and_one_that_is_held_no_margin():
    number = pendant.TypedNumber("x", -1e-9, 2e-6, "m", False)
    assert str(number) == "x 0.000000 ± 0.000002"
    assert str(number._replace(held=True)) == "x 0.000000 held"


def test_a_variance_that_is_negative_by_rounding_is_none():
    numbers = pendant.typed(frame()._replace(covariance=-1e-40 * np.eye(6)), "kuka")
    assert [number.margin for number in numbers] == [0.0] * 6
