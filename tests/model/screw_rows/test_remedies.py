"""Screws that were misread are refused with the expression that reads them, and that works."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import ScrewError, ShapeError
from poekin.model.screw_rows import remedies
from poekin.testing.strategies import chain_strategies

UR5E = pk.load("ur5e").chain()
FIVE = UR5E.screws[:5]
HOME = np.eye(4)
ROUNDED = np.round(UR5E.screws @ np.diag([1, 1, 1, 1, 1, 1]), 4)
AXES = [[0, 0.5, 0.866, 0, 0, 0], [0.7071, 0.7071, 0, 0.1, -0.1, 0.5]]


def remedy(screws):
    """The expression that a message tells to pass."""
    with pytest.raises((ScrewError, ShapeError)) as caught:
        pk.Chain.from_space(screws, HOME)
    return str(caught.value).rpartition(": pass ")[2]


def swapped(S):
    return np.roll(S, 3, axis=-1)


MISREAD = {
    "a Slist": (FIVE.T, "screws.T", FIVE),
    "a Slist of six": (UR5E.screws.T, "screws.T", UR5E.screws),
    "halves swapped": (swapped(FIVE), "pk.se3.linear_first(screws)", FIVE),
    "a Slist with its halves swapped": (swapped(FIVE).T, "pk.se3.linear_first(screws.T)", FIVE),
    "rounded axes": (np.array(AXES), "pk.screw.normalised(screws)", AXES),
    "rounded axes, a Slist": (np.array(AXES).T, "pk.screw.normalised(screws.T)", AXES),
    "rounded axes, swapped": (
        swapped(np.array([AXES[1]])), "pk.screw.normalised(pk.se3.linear_first(screws))", [AXES[1]]
    ),
    "dust": (np.array([[1e-12, 0, 0, 0, 1, 0]]), "pk.screw.normalised(screws)", [[0, 0, 0, 0, 1, 0]]),
    "one row of two swapped": (
        np.array([FIVE[1], swapped(FIVE[2])]), "pk.se3.linear_first(screws[1])", None
    ),
    "one row of two rounded": (
        np.array([[0, 0, 3, 0, 0, 0], AXES[1]])[::-1], "pk.screw.normalised(screws[0])", None
    ),
}  # fmt: skip


@pytest.mark.parametrize("screws, expression, meant", MISREAD.values(), ids=MISREAD)
def test_the_message_has_the_expression_that_makes_the_screws_that_were_meant(
    screws, expression, meant
):
    assert remedy(screws) == expression
    found = eval(expression, {"pk": pk, "screws": screws})
    if meant is not None:
        chain = pk.Chain.from_space(found, HOME)
        assert np.abs(chain.screws - meant).max() < 1e-3


BOTH = (
    "; its {0} are unit screws{2} but for rounding: pass pk.screw.normalised({1})"
    "; or its {0} are unit screws in the order (v; omega): pass pk.se3.linear_first({1})"
)
AMBIGUOUS = np.array([[0.866, 0.5, 0, 0, 0, 1]])


@pytest.mark.parametrize(
    "screws, words",
    [
        (AMBIGUOUS, BOTH.format("rows", "screws", "")),
        (AMBIGUOUS.T, BOTH.format("columns", "screws.T", ", as in a Slist")),
        (np.array([[0, 0, 2, 0, 0, 0], AMBIGUOUS[0]])[::-1], BOTH.format("rows", "screws[0]", "")),
    ],
    ids=["rows", "columns", "one row"],
)
def test_where_rounding_and_another_order_both_fit_both_are_named_rounding_first(screws, words):
    with pytest.raises((ScrewError, ShapeError)) as caught:
        pk.Chain.from_space(screws, HOME)
    assert str(caught.value).endswith(words)


@given(chain_strategies.chains())
def test_screws_that_are_sound_are_never_refused(chain):
    assert pk.Chain.from_space(chain.screws, chain.home, pitches=chain.pitches).dof == len(
        chain.screws
    )


@given(st.lists(st.floats(0.05, 0.9), min_size=1, max_size=4))
def test_a_length_that_is_no_rounding_has_no_remedy(lengths):
    with pytest.raises(ScrewError) as caught:
        pk.Chain.from_space([[0, 0, x, 0, 0, 0] for x in lengths], HOME)
    assert "pass" not in str(caught.value)


MATRICES = {
    "a pose among rows": (
        [FIVE[0], HOME], "the (4, 4) matrix at 1 is no screw; the home pose is an argument of its own"
    ),
    "a pose": (HOME, "the (4, 4) matrix at 0 is no screw; the home pose is an argument of its own"),
    "a turn without its last row": (
        [np.diag([1.0, 1.0, 1.0, 0.0])],
        "the (4, 4) matrix at 0 is no screw; the home pose is an argument of its own",
    ),
    "a last row without a turn": (
        [np.diag([0.0, 0.0, 0.0, 1.0])],
        "the (4, 4) matrix at 0 is no screw; the home pose is an argument of its own",
    ),
    "twists as matrices": (
        [pk.se3.hat(S) for S in FIVE], "the (4, 4) matrix at 0 is [A] of a twist: pass pk.se3.vee of it"
    ),
    "one twist as a matrix": (
        [*FIVE, pk.se3.hat(FIVE[0])], "the (4, 4) matrix at 5 is [A] of a twist: pass pk.se3.vee of it"
    ),
}  # fmt: skip


@pytest.mark.parametrize("screws, words", MATRICES.values(), ids=MATRICES)
def test_a_matrix_where_a_row_belongs_is_named(screws, words):
    with pytest.raises(ShapeError) as caught:
        pk.Chain.from_space(screws, HOME)
    assert str(caught.value).endswith(f"; {words}")


@pytest.mark.parametrize("screws", [5, "abc", np.zeros((2, 3)), np.zeros((2, 1, 6)), [[1], [1, 2]]])
def test_what_no_reading_makes_screws_of_has_no_remedy(screws):
    with pytest.raises(pk.errors.InputError) as caught:
        pk.Chain.from_space(screws, HOME)
    assert not any(word in str(caught.value) for word in ("pass", "matrix"))


def test_lengths_are_those_of_the_part_that_counts():
    S = np.array(
        [[0, 0, 1, 5, 5, 5], [0, 0, 0, 0, 2, 0], [0, 0, 1e-9, 0, 1, 0], [0, 0, 1e-8, 0, 1, 0]]
    )
    assert remedies.length_errors(S).tolist() == [0, 1, 0, 1 - 1e-8]
    assert remedies.length_errors(np.full((1, 6), 1e200)).tolist() == [np.inf]
