"""A chain against Pinocchio's reading of a text: which joint stands for a coordinate, and how an
error is measured.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from benchmarks.urdf_errors import SAMPLES, pinocchio_errors, values_of
from poekin.formats.urdf_text import to_urdf
from poekin.groups import se3
from poekin.model.chain import Chain

SCREWS = [[0.6, 0, 0.8, 0.4, 0.3, -0.3], [0, 0, 0, 0.36, 0.48, 0.8], [0.48, 0.6, -0.64, 0, 0, 0]]
HOME = se3.exp([0.3, -0.4, 0.5, 1.7, 0.2, -0.6])


@pytest.mark.parametrize(
    ("ratios", "offsets", "expected"),
    [
        ([2, -1, 1, 1], [0, 0, 0.5, 0], ("joint4", 1, 0)),
        ([2, -1, 1, 3], [0, 0, 0.5, 0], ("joint3", 1, 0)),
        ([2, -1, -3, 0], [0, 0.3, 0, 0], ("joint2", 1, 0)),
        ([0, -2, 3, 0.5], [0, 0.25, 0, 0], ("joint2", -2, 0.25)),
        ([1, 1, -1, -1], [0.5, 0.25, 0, 0], ("joint1", 1, 0)),
        ([-2, -1, -1, 0], [0, 0, 0.5, 0], ("joint2", 1, 0)),
        ([3, 1, 1, 0], [0, 0, 0, 0], ("joint2", 1, 0)),
        ([-1, 2, 0, 1], [0, 0, 0, 0.5], ("joint4", 1, 0)),
    ],
)
def test_a_coordinate_is_stood_for_by_the_joint_that_is_most_like_it(ratios, offsets, expected):
    names = [f"joint{k + 1}" for k in range(4)]
    screws = [SCREWS[0]] * 4
    chain = Chain.from_space(
        screws,
        HOME,
        coupling=np.array(ratios)[:, None],
        offset=offsets,
        joint_names=names,
        q_names=["q"],
    )
    assert values_of(chain) == [expected]


def test_a_coordinate_that_moves_nothing_is_stood_for_by_none():
    names = ["a", "b"]
    chain = Chain.from_space(
        SCREWS[:2],
        HOME,
        coupling=[[0, 1.0], [0, 0]],
        offset=[0, 0],
        joint_names=names,
        q_names=["q", "p"],
    )
    assert values_of(chain) == [None, ("a", 1, 0)]


class Off:
    """A chain, one number of whose answers is off by 1e-3."""

    def __init__(self, chain: Chain, name: str, place: tuple[int, int], frame: str = ""):
        self._chain, self._wrong, self.asked = chain, (name, place, frame), []

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._chain, name)
        if name not in ("fk", "jacobian"):
            return value

        def answer(q: np.ndarray, *frame: str) -> np.ndarray:
            self.asked.append(q)
            result, (wrong, (i, j), where) = np.array(value(q, *frame)), self._wrong
            if (wrong, where) == (name, *frame, "")[:2]:
                result[-1, i, j] -= 1e-3
            return result

        return answer


CHAIN = Chain.from_space(
    SCREWS,
    HOME,
    coupling=[[1.0, 0], [0, 1], [-0.5, 0]],
    offset=[0, 0, 0.2],
    q_names=["joint1", "joint2"],
)


def test_an_error_is_measured_in_every_number_of_its_configuration_and_lengths_by_the_reach():
    text, reach = to_urdf(CHAIN), CHAIN.reach
    assert reach != pytest.approx(1, rel=0.1)
    assert pinocchio_errors(CHAIN, text, 0).max() < 1e-13
    for i, j in np.ndindex(3, 4):
        off: Any = Off(CHAIN, "fk", (i, j))
        *others, last = pinocchio_errors(off, text, 0)
        assert max(others) < 1e-13
        assert last == pytest.approx(1e-3 / (reach if j == 3 else 1), rel=1e-9)
    for frame in ("space", "body", "hybrid"):
        for i, j in np.ndindex(6, 2):
            off = Off(CHAIN, "jacobian", (i, j), frame)
            *others, last = pinocchio_errors(off, text, 0)
            assert max(others) < 1e-13
            assert last == pytest.approx(1e-3 / (reach if i >= 3 else 1), rel=1e-9)


def test_configurations_are_five_within_three_radians_by_the_seed():
    seen = []
    for seed in (0, 0, 1):
        off: Any = Off(CHAIN, "", (0, 0))
        pinocchio_errors(off, to_urdf(CHAIN), seed)
        seen.append(off.asked[0])
    assert SAMPLES == 5
    assert seen[0].shape == (5, 2)
    assert np.array_equal(seen[0], seen[1])
    assert not np.array_equal(seen[0], seen[2])
    off = Off(CHAIN, "", (0, 0))
    assert pinocchio_errors(off, to_urdf(CHAIN), 0, samples=400).shape == (400,)
    assert -3 <= off.asked[0].min() < -2.9
    assert 2.9 < off.asked[0].max() <= 3


def test_what_the_text_does_not_have_is_infinitely_wrong_and_what_stands_still_is_not():
    other = Chain.from_space(SCREWS, HOME, joint_names=["a", "b", "c"])
    assert pinocchio_errors(other, to_urdf(CHAIN), 0).max() == math.inf
    still = Chain.from_space(np.zeros((0, 6)), HOME)
    assert pinocchio_errors(still, to_urdf(still), 0).max() < 1e-14
