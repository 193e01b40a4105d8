"""What `poekin fk` prints of a pose: to nine digits, and of what is less than 1e-12 nothing."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.cli.formats.units import SI, SaidUnits
from poekin.cli.kinematics import arm, fk
from poekin.formats.poses.layout import layout

CHAIN = pk.Chain.from_space([pk.screw.prismatic([0, 0, 1])], np.eye(4), base="floor", tip="hand")
P = [4e-13, 6e-13, 0.12345678949]
GIVEN = arm.ChainArguments("lift", CHAIN, np.array([[0.98765432109]]), True)


def shown(units, format, capsys) -> list[str]:
    """Lines that are shown of a pose at P, without a turn."""
    T = pk.se3.pose(np.eye(3), P)[None]
    chosen = layout(format) if format else None
    entries = layout("matrix").columns
    fk.PoseResults(T, "T", "pose of hand in floor (m)", entries, units=units, layout=chosen).show(
        GIVEN
    )
    return capsys.readouterr().out.splitlines()


@pytest.mark.parametrize(
    ("units", "scale", "length", "angle"),
    [
        (SI, 1, "m", "deg"),
        (SaidUnits(mm=True), 1000, "mm", "deg"),
        (SaidUnits(deg=True), 1, "m", "deg"),
        (SaidUnits(deg=False), 1, "m", "rad"),
    ],
)
def test_position_quaternion_and_angles_have_nine_digits_and_twelve_decimals(
    units, scale, length, angle, capsys
):
    lines = shown(units, None, capsys)
    assert lines[0] == "pose of hand in floor (m), at"
    assert lines[1].startswith("  joint1 = 0.987654321")
    x, y = {1: ("0", "1e-12"), 1000: ("4e-10", "6e-10")}[scale]
    z = {1: "0.123456789", 1000: "123.456789"}[scale]
    assert [" ".join(line.split()) for line in lines[-3:]] == [
        f"position {x} {y} {z} (x y z, {length})",
        "quaternion 1 0 0 0 (w x y z)",
        f"rpy 0 0 0 (roll pitch yaw, {angle})",
    ]


def test_numbers_of_a_format_have_twelve_decimals(capsys):
    lines = shown(SI, "rpy", capsys)
    assert lines[0] == f"pose of hand in floor ({layout('rpy').describe()}), at"
    numbers = [float(word) for word in lines[-1].replace(",", " ").split()]
    assert numbers == [0, 1e-12, P[2], 0, 0, 0]
