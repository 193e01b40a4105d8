"""Hints at readings that are coupled by a little, and at pairs that stand out: where they begin."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.exact.bounds import Propagation
from poekin.solve.calibration.exact.other_readings import odd_pairs, slight_coupling

CHAIN = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in (0, 1)], np.eye(4), joint_names=["a", "b"]
)
# readings that have nothing in common with one another
Q = np.array([[1.0, 1], [-1, 1], [1, -1], [-1, -1]])
DEVIATIONS = np.array([0.5, 1, 1, 1, 1, 2.0])


def hint(joint: int, reading: int, ratio: float, left: float) -> str:
    """The hint where joint k moves the number k of a pose, and follows a reading by a ratio; a part
    of the squares is left to what no joint moves.
    """
    J = np.zeros((4, 6, 2))
    J[:, [0, 1], [0, 1]] = 1.0
    errors = np.zeros((4, 6))
    errors[:, joint] = -ratio * Q[:, reading]
    explained = np.sum((errors / DEVIATIONS) ** 2)
    errors[0, 5] = 2.0 * np.sqrt(explained * left / (1 - left))
    # the parameters have taken up nothing
    fit = Propagation(errors, np.zeros((4, 6, 1)), np.zeros((1, 4, 6)), J, DEVIATIONS)
    return slight_coupling(CHAIN, Q, fit)


@pytest.mark.parametrize(("joint", "reading", "ratio", "words"), [
    (0, 1, 0.0025, "a = a + 0.0025 b"),
    (1, 0, -0.00125, "b = b - 0.00125 a"),
    (0, 0, 0.0025, "a went 1.0025 times its reading"),
    (1, 1, -0.25, "b went 0.75 times its reading"),
])  # fmt: skip
def test_a_joint_that_follows_a_reading_by_a_little_is_named_with_its_ratio(
    joint, reading, ratio, words
):
    assert hint(joint, reading, ratio, 0.01) == f"; most of it is as if {words}"
    # four times better is a sixteenth of the squares
    assert hint(joint, reading, ratio, 0.0624)
    assert hint(joint, reading, ratio, 0.0626) == ""


def test_what_the_parameters_took_up_is_no_coupling():
    J = np.zeros((4, 6, 2))
    J[:, [0, 1], [0, 1]] = 1.0
    errors = np.zeros((4, 6))
    errors[:, 1] = 0.1 * Q[:, 0]
    errors[:, 0] = 0.1 * Q[:, 1]
    # a parameter that moves the second number as b's follower of a would
    design, gain = np.zeros((4, 6, 1)), np.zeros((1, 4, 6))
    design[:, 1, 0], gain[0, :, 1] = Q[:, 0], 0.25 * Q[:, 0]
    errors[:, 1] = 0.0
    fit = Propagation(errors, design, gain, J, DEVIATIONS)
    assert slight_coupling(CHAIN, Q, fit) == "; most of it is as if a = a - 0.1 b"


def odd(length: list[float], angle: list[float], count: int) -> str:
    after = SimpleNamespace(length=np.array(length), angle=np.array(angle))
    found: Any = SimpleNamespace(after=after, nominal=SimpleNamespace(reach=2.0))
    return odd_pairs(found, count)


def test_pairs_that_miss_by_thirty_times_the_median_stand_out():
    fits = "stand out (rows of q, from 0), the others fit better without them"
    length, angle = [1e-3] * 9, [5e-4] * 9  # 1e-3 of both together, by the reach
    length[4] = 2 * 30.1e-3 - 1e-3
    assert odd(length, angle, 9) == f"; pairs 4 {fits}"
    length[4] = 2 * 29.9e-3 - 1e-3
    assert odd(length, angle, 9) == ""
    angle[2], angle[7] = 1.0, 1.0
    assert odd(length, angle, 9) == f"; pairs 2, 7 {fits}"
    assert odd(length, angle, 8) == f"; pairs 2, 7 {fits}"
    assert odd(length, angle, 7) == "", "a quarter of all is too much to be odd"
