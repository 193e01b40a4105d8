"""Numbers of options in the units that are said, and how many of many poses are told of."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.cli.formats.units import SaidUnits
from poekin.cli.kinematics import follow, ik, poses
from poekin.errors import InputError

CHAIN = pk.load("stanford").chain()
SLIDES = np.array([kind == "prismatic" for kind in CHAIN.kinds])


@pytest.mark.parametrize(
    ("units", "angle", "length"),
    [
        (SaidUnits(deg=True), np.pi / 180, 1.0),
        (SaidUnits(mm=True), 1.0, 1e-3),
        (SaidUnits(mm=True, deg=True), np.pi / 180, 1e-3),
    ],
)
def test_one_number_for_all_coordinates_is_in_the_unit_of_each(units, angle, length):
    each = np.where(SLIDES, length, angle)
    found = poses.for_each("30", CHAIN, "--speed", units)
    assert found is not None
    np.testing.assert_allclose(found, 30 * each, rtol=1e-15)
    numbers = np.arange(1.0, 7.0)
    for read in (poses.for_each, poses.coordinates):
        found = read(", ".join(map(str, numbers)), CHAIN, "--speed", units)
        assert found is not None
        np.testing.assert_allclose(found, numbers * each, rtol=1e-15)


def test_in_radians_and_metres_one_number_stays_one():
    for units in (SaidUnits(), SaidUnits(False, False)):
        assert poses.for_each("30", CHAIN, "--speed", units) == 30.0


@pytest.mark.parametrize("count", [1, 19, 20, 21, 22])
def test_twenty_poses_are_told_of_and_the_others_counted(count, capsys):
    assert ik.MOST_TOLD == 20
    ik._complain({k: f"why {k}" for k in range(0, 2 * count, 2)}, count, False)
    lines = capsys.readouterr().err.splitlines()
    assert lines[:20] == [f"poekin: pose {2 * k}: why {2 * k}" for k in range(min(count, 20))]
    more = [f"poekin: and {count - 20} more poses; --json tells of each"] if count > 20 else []
    assert lines[20:] == more


def test_a_pose_alone_has_no_number(capsys):
    ik._complain({0: "why"}, 1, True)
    assert capsys.readouterr().err == "poekin: the pose: why\n"


@pytest.mark.parametrize("said", [(), ("--no-limits",)])
@pytest.mark.parametrize("name", ["ik", "follow"])
def test_limits_hold_unless_the_option_leaves_them(name, said, refused, monkeypatch, tmp_path):
    """What the library is asked for; nothing is solved."""
    asked = []

    def solve(*_, limits, **__):
        asked.append(limits)
        raise InputError("that is all")

    command = {"ik": ik, "follow": follow}[name]
    monkeypatch.setattr(command, name, solve)
    (tmp_path / "T.csv").write_text("0.1,0.2,0.3,0,0,0\n")
    given = ("--format", "rpy", "--input", tmp_path / "T.csv")
    assert "that is all" in refused(name, "stanford", *given, *said)
    assert asked == [not said]


def test_the_configuration_to_be_near_is_in_the_units_that_are_said(refused, monkeypatch):
    asked = []

    def solve(*_, q0, nearest_to, **__):
        asked.extend([q0, nearest_to])
        raise InputError("that is all")

    monkeypatch.setattr(ik, "ik", solve)
    numbers = "180,180,1000,180,180,180"
    words = ("--q0", numbers, "--nearest-to", numbers, "--deg", "--mm")
    assert "that is all" in refused("ik", "stanford", "--format", "rpy", *range(6), *words)
    np.testing.assert_array_equal(asked, 2 * [np.where(SLIDES, 1.0, np.pi)])


def test_the_start_and_the_limits_of_a_path_are_in_the_units_that_are_said(
    refused, monkeypatch, tmp_path
):
    asked = []

    def solve(*_, q0, speed, acceleration, **__):
        asked.extend([q0, speed, acceleration])
        raise InputError("that is all")

    monkeypatch.setattr(follow, "follow", solve)
    (tmp_path / "T.csv").write_text("100,200,300,0,0,0\n" * 2)
    numbers = "180,180,1000,180,180,180"
    words = ("--q0", numbers, "--speed", numbers, "--acceleration", numbers, "--duration", 1)
    given = ("--format", "rpy", "--input", tmp_path / "T.csv", "--deg", "--mm")
    assert "that is all" in refused("follow", "stanford", *given, *words)
    np.testing.assert_array_equal(asked, 3 * [np.where(SLIDES, 1.0, np.pi)])
