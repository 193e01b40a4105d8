"""What is put right between one line and the next is said of the right axes, with its size, and
costs what it moves.
"""

from __future__ import annotations

import math
from dataclasses import replace
from decimal import Decimal

import numpy as np
import pytest

import poekin as pk
from poekin.formats import dh
from poekin.formats.dh import Row, Table
from poekin.model.geometry.axis_walk import _cosine, _floats

TOL, OFF = 1e-5, 2e-6
RIGHT = math.pi / 2
ROWS = (
    Row(0.0, 0.4, 0.0, 0.0),
    Row(math.pi / 4, 0.0, 0.5, RIGHT),
    Row(0.0, 0.3, 0.0, math.pi / 3),
    Row(0.0, 0.25, 0.75, 0.0),
)
TOOL = 0.125
BEHIND = 0.3 + 0.75 + 0.25 + TOOL
"""All lengths behind joint 2, one after the other [m]."""


def off_by(number: int, column: str) -> pk.Chain:
    """The arm of ROWS with one parameter off."""
    rows = [replace(r, **{column: getattr(r, column) + OFF * (r is ROWS[number])}) for r in ROWS]
    return dh.to_chain(Table("modified", rows, tool=pk.se3.exp([0, 0, 0, 0, 0, TOOL])))


@pytest.mark.parametrize("number, column, words, lever", [
    (0, "theta", "axis of 'joint2' turned by 2e-06 rad about axis of 'joint1', to 0° from the normal before it",
     0.5 + BEHIND),
    (0, "a", "axis of 'joint1' moved by 2e-06 m to be one line with the base's z axis", 1),
    (0, "alpha", "axis of 'joint1' turned by 2e-06 rad to be parallel to the base's z axis",
     math.hypot(0.4, 0.5) + BEHIND),
    (1, "theta", "axis of 'joint3' turned by 2e-06 rad about axis of 'joint2', to 45° from the normal before it",
     BEHIND),
    (1, "alpha", "axis of 'joint2' turned by 2e-06 rad to be perpendicular to axis of 'joint1'", None),
    (2, "a", "axis of 'joint3' moved by 2e-06 m to meet axis of 'joint2'", 1),
    (2, "alpha", "axis of 'joint3' turned by 2e-06 rad to be at 60° to axis of 'joint2'", BEHIND),
    (1, "d", "axis of 'joint3' moved by 2e-06 m along axis of 'joint2', to where the normal before it is", None),
    (3, "theta", "the tool turned by 2e-06 rad about its z axis, to 0° from the normal before it", 0),
    (1, "a", None, 0), (2, "d", None, 0), (3, "a", None, 0), (3, "d", None, 0),
])  # fmt: skip
def test_one_wrong_parameter_of_a_table_is_named_with_its_size_and_its_lever(
    number, column, words, lever
):
    result = off_by(number, column).idealised(TOL)
    assert result.changes == (() if words is None else (words,))
    if lever is not None:
        assert result.position_bound == pytest.approx(OFF * lever, rel=1e-6, abs=1e-12)
    if words is not None:
        assert result.rotation_bound == pytest.approx(
            OFF if " rad " in words else 0, rel=1e-6, abs=1e-12
        )


def about_z(turn: float) -> np.ndarray:
    return pk.se3.exp([0, 0, turn, 0, 0, 0])


def leaning(x: float, y: float) -> list[float]:
    """A revolute axis through the origin whose direction has these x and y."""
    return [x, y, math.sqrt(1 - x * x - y * y), 0, 0, 0]


TURN = [0, 0, 1, 0, 0, 0]
ACROSS = pk.se3.exp([RIGHT, 0, 0, 0, 0, 0])


@pytest.mark.parametrize("screw, home, words", [
    (leaning(0.05, OFF), np.eye(4), "axis of 'joint1' turned by 2e-06 rad to lie in a plane of the frame on the base's"
                                    " z axis"),
    (leaning(OFF, 0.05), np.eye(4), "axis of 'joint1' turned by 2e-06 rad to lie in a plane of the frame on the base's"
                                    " z axis"),
    (pk.screw.revolute([0, 0, 1], [0.5, OFF, 0]), np.eye(4),
     "axis of 'joint1' moved by 2e-06 m into a plane of the frame on the base's z axis"),
    (pk.screw.revolute([0, 0, 1], [-OFF, 0.5, 0]), np.eye(4),
     "axis of 'joint1' moved by 2e-06 m into a plane of the frame on the base's z axis"),
    (TURN, ACROSS @ pk.se3.exp([0, 0, 0, 0.5, 0, OFF]),
     "the tool moved by 2e-06 m along its z axis, to where the normal before it is"),
    *((TURN, about_z(math.radians(angle) + OFF),
       f"the tool turned by 2e-06 rad about its z axis, to {angle}° from the normal before it")
      for angle in (-165, -90, -15, 15, 90, 165, 180)),
])  # fmt: skip
def test_planes_and_angles_from_minus_165_to_180_degrees_are_named(screw, home, words):
    assert pk.Chain.from_space([screw], home).idealised(TOL).changes[0] == words


@pytest.mark.parametrize("off, listed", [(3e-15, 0), (3e-14, 1)])
def test_what_rounding_makes_is_put_right_and_not_listed(off, listed):
    turned = pk.Chain.from_space([TURN], about_z(off)).idealised(TOL)
    moved = pk.Chain.from_space([TURN], pk.se3.exp([0, 0, 0, off, 0, 0])).idealised(TOL)
    screws = np.array([TURN, pk.screw.revolute([1, 0, 0], [0, off, 20.0])])
    far = pk.Chain.from_space(screws, np.eye(4)).idealised(TOL)
    assert [len(result.changes) for result in (turned, moved)] == [listed] * 2
    assert far.changes == ()  # lengths are seen beside the reach, 20 m
    # axis and tool are moved by `off`; the numbers are rounded beside the 40 m to joint 2 and from
    # there to the tip
    assert far.position_bound == pytest.approx(2 * off + 8 * 2.0**-53 * 4 * 40, rel=0.02)
    for result in (turned, moved):
        np.testing.assert_array_equal(result.chain.home, np.eye(4))


def test_a_joint_s_name_in_braces_is_said_as_it_is():
    named = pk.Chain.from_space([leaning(OFF, 0)], np.eye(4), joint_names=["{0}"])
    assert (
        named.idealised(TOL).changes[0]
        == "axis of '{0}' turned by 2e-06 rad to be parallel to the base's z axis"
    )


@pytest.mark.parametrize("k", range(-12, 25))
def test_cosines_of_multiples_of_15_degrees_are_exact(k):
    assert float(_cosine(k)) == pytest.approx(math.cos(k * math.pi / 12), abs=5e-16)


@pytest.mark.parametrize(
    "size, least", [("0", "1e-35"), ("0.5", "1e-35"), ("1e30", "1e-5"), ("1e99", "1e64")]
)
def test_of_a_vector_s_numbers_what_is_rounding_of_its_size_is_zero(size, least):
    nothing = Decimal(least)
    given = nothing * Decimal("0.9"), -nothing * Decimal("0.9"), nothing * Decimal("1.1")
    assert _floats(given, Decimal(size)).tolist() == [0, 0, float(given[2])]
    assert _floats((-given[2], Decimal(0), given[2]), Decimal(size)).tolist() == [
        -float(given[2]),
        0,
        float(given[2]),
    ]
