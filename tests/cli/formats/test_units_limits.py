"""Sentences on configurations beyond the limits: which is told of, in which units, from where on."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.cli.formats.units import SaidUnits, beyond_limits

SI = SaidUnits()


def arm(**changes: object) -> pk.Chain:
    """A turn and a slide, each between -1 and 2."""
    A = [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([1, 0, 0])]
    chain = pk.Chain.from_space(A, np.eye(4)).replace(limits=[[-1.0, 2.0]] * 2)
    return chain.replace(q_names=("turn", "slide"), joint_names=("turn", "slide")).replace(
        **changes
    )


SUMS = arm(coupling=[[1.0, 0.0], [1.0, 1.0]], offset=None, joint_limits=[[-1.0, 2.0], [-1.5, 2.5]])
"""The second joint is the sum of both coordinates, and has limits of its own."""


@pytest.mark.parametrize(
    ("q", "told"),
    [
        ([2.0 + 0.9e-9, 0.0], ""),
        ([2.0 + 1.1e-9, 0.0], "turn = 2 rad is outside its limits, -1 to 2"),
        ([-1.0 - 0.9e-9, 0.0], ""),
        ([-1.0 - 1.1e-9, 0.0], "turn = -1 rad is outside its limits, -1 to 2"),
        ([0.0, 2.5], "slide = 2.5 m is outside its limits, -1 to 2"),
        ([90.0, 250.0], "turn = 90 rad is outside its limits, -1 to 2; are these degrees? --deg"),
        ([0.0, 250.0], "slide = 250 m is outside its limits, -1 to 2; are these mm? --mm says so"),
        ([0.0, np.nan], ""),
    ],
)
def test_a_coordinate_is_told_of_beyond_a_billionth_and_the_first_of_several(q, told):
    said = beyond_limits(arm(), np.array([q]), SI)
    assert said.startswith(told)
    assert bool(said) is bool(told)


@pytest.mark.parametrize(
    ("units", "q", "told"),
    [
        (SaidUnits(deg=True), [-np.pi, 0], "turn = -180 deg is outside its limits, -57.2958 to 114.592"),
        (SaidUnits(deg=False), [-30, 0], "turn = -30 rad is outside its limits, -1 to 2"),
        (SaidUnits(mm=True), [-9, 0], "turn = -9 rad is outside its limits, -1 to 2; are these degrees? --deg says so"),
        (SaidUnits(mm=True), [0, 3], "slide = 3000 mm is outside its limits, -1000 to 2000"),
        (SaidUnits(mm=False), [0, 30], "slide = 30 m is outside its limits, -1 to 2"),
        (SaidUnits(deg=True), [0, 30], "slide = 30 m is outside its limits, -1 to 2; are these mm? --mm says so"),
    ],
)  # fmt: skip
def test_the_numbers_are_in_the_units_that_were_said_and_the_cure_is_one_that_was_not(
    units, q, told
):
    assert beyond_limits(arm(), np.array([q]), units) == told


def test_zero_is_told_without_a_sign():
    for zero in (0.0, -0.0):
        said = beyond_limits(arm(limits=[[1.0, 2.0]] * 2), np.array([[zero, 1.0]]), SI)
        assert said == "turn = 0 rad is outside its limits, 1 to 2"


@pytest.mark.parametrize("k", [0, 1])
def test_no_more_than_a_turn_or_as_many_metres_is_taken_as_it_stands(k):
    for value, is_asked in ((2 * np.pi, False), (6.3, True)):
        q = value * np.eye(2)[k]
        assert ("are these" in beyond_limits(arm(), q[None], SI)) is is_asked


def test_of_many_the_first_row_is_named_and_they_are_counted():
    q = np.array([[0, 0], [0, 2.5], [5, 0], [0, 0]])
    assert beyond_limits(arm(), q, SaidUnits(True, True)) == (
        "2 of 4 configurations are beyond limits; in the first, row 1, slide = 2500 mm is outside"
        " its limits, -1000 to 2000"
    )


@pytest.mark.parametrize(
    ("q", "told"),
    [
        ([1.0, 1.0], ""),
        ([1.0, 1.5], ""),  # at its own limit
        ([1.5, 1.5], "joint slide = 3 m is outside its own limits, -1.5 to 2.5"),
        ([1.5, 2.25], "slide = 2.25 m is outside its limits, -1 to 2"),
        ([-1.0, -0.75], "joint slide = -1.75 m is outside its own limits, -1.5 to 2.5"),
    ],
)
def test_a_joint_beyond_its_own_limits_is_told_of_where_the_coordinates_are_within_theirs(q, told):
    assert beyond_limits(SUMS, np.array([q]), SaidUnits(False, False)) == told


def test_of_many_joints_beyond_their_own_limits_the_first_row_is_named():
    q = np.array([[0, 0], [1.5, 1.5]])
    assert beyond_limits(SUMS, q, SaidUnits(mm=True)) == (
        "1 of 2 configurations are beyond limits; in the first, row 1, joint slide = 3000 mm"
        " is outside its own limits, -1500 to 2500"
    )
