"""Solutions at two values are linked where one continues the other, and what is said of the choice."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, UnknownName
from poekin.solve.ik_all.swivel import _chained, _links, redundant_coordinate, sample_values

TURN = 2 * np.pi
SEVEN = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in range(7)],
    np.eye(4),
    joint_names=list("abcdefg"),
)


def linked(
    a: list[list[float]],
    b: list[list[float]],
    slopes: tuple[list[float], list[float]],
    turn: float = TURN,
) -> list[tuple[int, int]]:
    """Links of points (x, y), x the redundant coordinate, along curves of slopes dy / dx."""
    tangents = [np.array([[1.0, slope] for slope in some]) for some in slopes]
    i, j = _links(np.array(a), np.array(b), tangents[0], tangents[1], 0, np.array([0.0, turn]))
    return list(zip(i.tolist(), j.tolist(), strict=True))


@pytest.mark.parametrize(("a", "b", "slopes", "links"), [
    ([[0, 0], [0, 1]], [[0.1, 1.02], [0.1, 0.2]], ([2, 0], [0.4, 2]), [(0, 1), (1, 0)]),
    ([[0, 3.1]], [[0.1, 3.1 + 0.06 - TURN]], ([0.4], [0.8]), [(0, 0)]),
    ([[0, -3.1]], [[0.1, 3.1]], ([TURN - 62] * 1, [TURN - 62]), []),
    # a step may miss what the slopes foretell by half of itself
    ([[0, 0]], [[0.1, 0.05]], ([0], [0]), [(0, 0)]),
    ([[0, 0]], [[0.1, 0.0501]], ([0], [0]), []),
    ([[0, 0]], [[0.1, 0.4]], ([2.5], [2.5]), [(0, 0)]),
    ([[0, 0]], [[0.1, 0.4]], ([1.9], [1.9]), []),
    # each is the other's nearest
    ([[0, 0], [0, 0.01]], [[0.1, 0.008]], ([0, 0], [0]), [(1, 0)]),
    ([[0, 0.008]], [[0.1, 0.01], [0.1, 0]], ([0], [0, 0]), [(0, 0)]),
])  # fmt: skip
def test_a_solution_is_linked_to_that_to_which_its_tangents_lead(a, b, slopes, links):
    assert linked(a, b, slopes) == links


def test_a_slide_is_not_taken_whole_turns_back():
    assert linked([[0, 0]], [[0.1, TURN]], ([TURN / 0.1], [TURN / 0.1]), turn=0.0) == [(0, 0)]
    assert linked([[0, 0]], [[0.1, TURN]], ([0], [0]), turn=0.0) == []
    assert linked([[0, 0]], [[0.1, TURN]], ([0], [0])) == [(0, 0)]


def test_links_are_followed_to_their_end():
    following = np.array([3, -1, 0, 1])
    assert _chained(2, following) == [2, 0, 3, 1]
    assert _chained(1, following) == [1]


def slide(low: float, high: float) -> pk.Chain:
    return pk.Chain.from_space([pk.screw.prismatic([1, 0, 0])], np.eye(4), limits=[[low, high]])


def turning(low: float, high: float) -> pk.Chain:
    return SEVEN.replace(limits=[[low, high]] * 7)


@pytest.mark.parametrize(("chain", "count", "limits", "values"), [
    (slide(1.0, 2.0), 1, True, [1.5]),
    (slide(1.0, 2.0), 3, True, [1, 1.5, 2]),
    (slide(-20.0, 10.0), 4, True, [-20, -10, 0, 10]),
    (turning(1.0, 2.0), 1, True, [1.5]),
    (turning(1.0, 2.0), 2, True, [1, 2]),
    (turning(-np.pi, np.pi), 2, True, [-np.pi, 0]),
    (turning(-8.0, -1.0), 2, True, [-1 - TURN, -1 - TURN / 2]),
    (turning(0.0, TURN), 1, True, [0]),
])  # fmt: skip
def test_values_are_even_over_the_limits_and_of_a_whole_turn_the_end_is_left_out(
    chain, count, limits, values
):
    np.testing.assert_allclose(sample_values(chain, 0, count, limits), values, atol=1e-12)


FREE = np.full(7, np.nan)
TWO_LOCKED = np.array([0.5, *FREE[2:], 0.25])


@pytest.mark.parametrize(("values", "asked", "kind", "words"), [
    (FREE, "x", UnknownName, "redundant: no coordinate 'x'; available: 'a', 'b', 'c', 'd', 'e' and 2 more"),
    (TWO_LOCKED, None, InputError,
     "n_swivel: expected an arm with seven coordinates that may move, got 5 ('b', 'c', 'd', 'e', 'f'); `lock` keeps "
     "others at given values"),
])  # fmt: skip
def test_a_coordinate_that_cannot_be_chosen_is_refused(values, asked, kind, words):
    with pytest.raises(kind, match=f"^{re.escape(words)}$"):
        redundant_coordinate(SEVEN, values, asked)
