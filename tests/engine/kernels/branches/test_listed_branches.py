"""The kernel that lists solutions: which branches it takes, and which targets it leaves to a search."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.engine.kernels.branches import listed_branches as kernel
from poekin.solve.ik.ik_problem import kernel_options
from poekin.solve.ik_all.closed_form import closed_form
from poekin.solve.ik_all.ik_all_search import POSE
from poekin.solve.ik_all.solution_sets.places import Box, make_places
from poekin.solve.ragged import Ragged
from tests.engine.kernels.branches.four_at_once import plain

TURN = 2 * np.pi
Q = np.array([0.4, -1.2, 1.5, -0.3, 0.8, 0.2])
RULE = np.array([1e-12, 1e-9, 1e-4, np.inf])
ANYWHERE = np.tile([-np.inf, np.inf, TURN], (6, 1))


def branches() -> tuple[pk.Chain, np.ndarray, np.ndarray, np.ndarray]:
    """An arm, a target, its branches and their margins."""
    chain = pk.load("ur5").chain()
    found = closed_form(chain)
    assert found is not None
    T = chain.fk(Q)[None]
    rows, margins = found.rows(T)
    return chain, T, rows.copy(), margins.copy()


def listed(chain, T, rows, margins, box=ANYWHERE, rule=RULE, compiled=False):
    """Solutions, their errors and places, and the counts."""
    branches = np.concatenate([rows, margins[:, :, None]], axis=2)
    room = len(rows) * rows.shape[1]
    q = np.full((room, 6), np.nan)
    errors = np.full((room, kernel.ERRORS), np.nan)
    info = np.full((len(rows), kernel.INFO), np.nan)
    options = kernel_options(POSE, 1e-13, 1e-13, 8)
    rest = (branches, T, box, np.zeros(6), options, rule, q, errors, info)
    if compiled:
        kernel.listed.call(chain.compile().hybrid_address, *rest)
    else:
        with plain():
            kernel.listed.function(chain, *rest)
    within = int(info[:, kernel.WITHIN].sum())
    return q[:within], errors[:within], info if len(rows) > 1 else info[0]


@pytest.mark.parametrize("compiled", [False, True])
def test_branches_clear_of_one_another_are_listed_in_order_with_their_errors(compiled):
    arm, T, rows, margins = branches()
    q, errors, info = listed(arm, T, rows, margins, compiled=compiled)
    assert info.tolist() == [8, 8, 1]
    assert q.round(9).tolist() == sorted(q.round(9).tolist())
    assert (errors[:, : kernel.PLACES] < 1e-13).all()
    assert (errors[:, kernel.PLACES] == 1).all()


def test_a_branch_that_is_off_is_sharpened():
    arm, T, rows, margins = branches()
    exact, *_ = listed(arm, T, rows, margins)
    q, errors, info = listed(arm, T, rows + 1e-6, margins)
    assert info.tolist() == [8, 8, 1]
    np.testing.assert_allclose(q, exact, atol=1e-11)
    assert (errors[:, : kernel.PLACES] < 1e-13).all()


@pytest.mark.parametrize("fault", ["far off", "double", "listed twice", "nowhere", "no number"])
def test_a_target_with_any_branch_that_is_not_clear_is_left_to_the_search(fault):
    arm, T, rows, margins = branches()
    if fault == "far off":
        rows[0, 3] += 1e-3
    elif fault == "double":
        margins[0, 3] = 1e-13
    elif fault == "listed twice":
        rows[0, 3] = rows[0, 4] + 1e-8
    elif fault == "nowhere":
        margins[:] = -1.0
    else:
        rows[0, 3, 2] = np.nan
    # plain Python has no integer of a NaN
    *_, info = listed(arm, T, rows, margins, compiled=fault == "no number")
    assert not info[kernel.IS_CLEAR]


def test_a_target_without_solutions_is_clear_where_all_of_its_margins_tell_so():
    arm, T, rows, margins = branches()
    rule = RULE.copy()
    rule[kernel.HOPELESS] = 0.01
    margins[:] = -0.02
    margins[0, 6:] = np.nan
    *_, info = listed(arm, T, rows, margins, rule=rule)
    assert info.tolist() == [0, 0, 1]
    margins[0, 2] = -0.005
    *_, info = listed(arm, T, rows, margins, rule=rule)
    assert info.tolist() == [0, 0, 0]


@pytest.mark.parametrize("compiled", [False, True])
def test_targets_are_listed_one_after_the_other_without_those_that_are_not_clear(compiled):
    arm, T, rows, margins = branches()
    T = np.repeat(T, 3, axis=0)
    rows = np.repeat(rows, 3, axis=0)
    margins = np.repeat(margins, 3, axis=0)
    margins[0, 2] = np.nan
    rows[1, 5] += 1.0
    q, errors, info = listed(arm, T, rows, margins, compiled=compiled)
    assert info.tolist() == [[7, 7, 1], [8, 0, 0], [8, 8, 1]]
    assert len(q) == 15
    first, *_ = listed(arm, T[:1], rows[:1], margins[:1], compiled=compiled)
    last, *_ = listed(arm, T[2:], rows[2:], margins[2:], compiled=compiled)
    np.testing.assert_array_equal(q, np.concatenate([first, last]))
    assert (errors[:, : kernel.PLACES] < 1e-13).all()


@pytest.mark.parametrize("margin", [-1.0, -1e-8, np.nan])
def test_a_branch_that_is_no_solution_is_left_out(margin):
    arm, T, rows, margins = branches()
    margins[0, 3] = margin
    q, _, info = listed(arm, T, rows, margins)
    assert info.tolist() == [7, 7, 1]
    assert np.abs(q - rows[0, 3]).max(axis=1).min() > 0.1


def test_so_many_turns_away_that_rounding_moves_the_tool_a_search_has_to_look():
    arm, T, rows, margins = branches()
    box = ANYWHERE.copy()
    box[0, :2] = 100 * TURN, 101 * TURN
    *_, info = listed(arm, T, rows, margins, box)
    assert not info[kernel.IS_CLEAR]


bounds = st.floats(-20.0, 20.0)


@given(
    q=st.lists(st.floats(-4.0, 4.0), min_size=3, max_size=3),
    low=st.tuples(bounds, bounds, bounds),
    width=st.tuples(*[st.floats(0.0, 20.0) | st.just(np.inf)] * 3),
    turns=st.tuples(st.booleans(), st.booleans(), st.booleans()),
)
def test_the_place_of_a_solution_and_the_number_of_its_places_are_those_of_make_places(
    q, low, width, turns
):
    limits = np.column_stack([low, np.add(low, width)])
    limits[np.isinf(limits[:, 1]), 0] = -np.inf
    periods = np.where(turns, TURN, 0.0)
    box = np.column_stack([limits, periods])
    one = np.array([q])
    number = kernel.placed(one, 0, box)
    # chain and limits of joints are not asked for where these do not count
    chain = pk.load("ur5").chain()
    found = Ragged(np.array([q]), np.array([1]))
    places = make_places(chain, found, Box(limits, periods), False, False)
    assert number == (places.number[0] if len(places.q) else 0)
    if number:
        np.testing.assert_array_equal(one[0], places.q[0])
