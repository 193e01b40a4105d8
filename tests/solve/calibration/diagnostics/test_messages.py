"""Directions of parameters in words: what is alone, what goes together, of whom, and how many."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.solve.calibration.diagnostics.messages import _list, directions, unobserved
from poekin.solve.calibration.model.parameters import Parameter

ARM = [Parameter(owner, what, "rad") for owner in ("a", "b", "c") for what in ("tilt", "shift")]
HOME, BOARD = [Parameter("home", "turn", "rad")], [Parameter("T_base_board", "turn about x", "rad")]


def problem(*parameters, q=None, rows=None) -> Any:
    arm = [p for p in parameters if p.owner != "T_base_board"]
    q = np.array([[0.0, 0, 0], [1, 1, 1]]) if q is None else q
    nominal = SimpleNamespace(q_names=("qa", "qb", "qc"))
    return SimpleNamespace(
        parameters=parameters, model=SimpleNamespace(parameters=arm, nominal=nominal), frame_names=["T_base_board"],
        q=q, rows=[np.arange(len(q))] if rows is None else rows,
    )  # fmt: skip


def together(*numbers, size=8):
    """The unit direction in which these parameters change alike."""
    return np.isin(np.arange(size), numbers) / np.sqrt(len(numbers))


ALL = problem(*ARM, *HOME, *BOARD)


@pytest.mark.parametrize("columns, words", [
    ([], []),
    ([together(1)], ["a: shift"]),
    ([together(0), together(1)], ["all 2 parameters of a"]),
    ([together(0), together(1), together(6)], ["all 2 parameters of a", "home: turn"]),
    ([together(0), together(3)], ["a: tilt", "b: shift"]),
    ([together(0, 1)], ["a combination of the parameters of a"]),
    ([together(0, 2)], ["a combined change of a and b that cancels out"]),
    ([together(0, 2), together(1, 3)], ["2 combined changes of a and b that cancel out"]),
    ([together(0, 7)], ["a combined change of a and T_base_board that cancels out: T_base_board may move, the arm does "
                        "not"]),
    ([together(6), together(0, 2)], ["home: turn", "a combined change of a and b that cancels out"]),
    ([together(0, 2, 4, 6, 7)], ["a combined change of the arm as a whole and T_base_board that cancels out: "
                                 "T_base_board may move, the arm does not"]),
    ([together(0, 2, 4)], ["a combined change of the arm as a whole that cancels out"]),
    ([together(0, 2) + 1e-4 * together(4)], ["a combined change of a and b that cancels out"]),
    ([together(0, 2) + 1e-2 * together(4)], ["a combined change of the arm as a whole that cancels out"]),
])  # fmt: skip
def test_directions_name_their_owners(columns, words):
    N = np.array(columns).reshape(len(columns), 8).T
    assert directions(ALL, N) == words
    # Other axes of the same space are the same directions.
    turn = (
        np.linalg.qr(np.random.default_rng(0).normal(size=(len(columns),) * 2))[0]
        if columns
        else np.empty((0, 0))
    )
    assert directions(ALL, N @ turn) == words


def test_several_combinations_of_one_joint_are_counted():
    one = problem(*(Parameter("a", str(k), "rad") for k in range(4)))
    assert directions(one, np.array([[1, 1, 0, 0], [0, 0, 1, 1]]).T / np.sqrt(2)) == [
        "2 combinations of the parameters of a"
    ]
    two = problem(*(Parameter(owner, str(k), "rad") for owner in "ab" for k in range(2)))
    assert directions(two, together(0, 2, size=4)[:, None]) == [
        "a combined change of a and b that cancels out"
    ]


def test_a_parameter_that_differs_by_what_makes_no_difference_is_seen_alone():
    blind = together(0, 7)[:, None]
    N = (together(0) - together(0, 7) * (together(0) @ together(0, 7)))[:, None] * np.sqrt(2)
    assert directions(ALL, N)[0].startswith("a combined change")
    assert directions(ALL, N, blind) == ["a: tilt", "T_base_board: turn about x"]


def test_what_makes_no_difference_elsewhere_changes_no_words():
    N = together(0, 2)[:, None]
    for blind in (together(5, 7), together(5)):
        assert directions(ALL, N, blind[:, None]) == directions(ALL, N)


@pytest.mark.parametrize("column, same", [
    ([0.3, 0.3, 0.3], True), ([0.3, 0.3 + 0.9e-9, 0.3], True), ([0.3, 0.3 + 1.2e-9, 0.3], False),
])  # fmt: skip
def test_coordinates_that_did_not_change_are_told_beside_what_is_unseen(column, same):
    q = np.stack([np.arange(3.0), column, np.arange(3.0)], axis=1)
    arm, none = problem(*ARM, q=q), np.zeros((6, 0))
    N = together(2, size=6)[:, None]
    assert unobserved(arm, N, none) == ["b: tilt" + " (qb is the same in all readings)" * same]
    assert unobserved(arm, np.zeros((6, 0)), none) == []
    # Only the readings at which something was measured count.
    few = problem(*ARM, q=q, rows=[np.array([2]), np.array([2])])
    assert unobserved(few, N, none) == ["b: tilt (qa, qb and qc are the same in all readings)"]


def test_a_list_names_eight_and_counts_the_rest():
    names = [f"j{k}" for k in range(1, 11)]
    assert _list([]) == ""
    assert _list(names[:1]) == "j1"
    assert _list(names[:2]) == "j1 and j2"
    assert _list(names[:8]) == "j1, j2, j3, j4, j5, j6, j7 and j8"
    assert _list(names[:9]) == "j1, j2, j3, j4, j5, j6, j7, j8 and 1 more"
    assert _list(2 * names[:9]).endswith(", j8 and 10 more")
    assert _list(names) == "j1, j2, j3, j4, j5, j6, j7, j8 and 2 more"
    assert _list(["a\x1b" + "x" * 70, "b"]) == _list(["a\x1b" + "x" * 70]) + " and b"
    assert len(_list(["x" * 70])) <= 60


def test_an_arm_of_one_joint_is_called_by_it_and_frames_stand_beside_an_arm():
    one: Any = problem(*ARM[:2], *BOARD)
    (words,) = directions(one, together(0, 2, size=3)[:, None])
    assert words.startswith(
        "a combined change of a and T_base_board that cancels out: T_base_board"
    )
    made: Any = problem(*ARM, *HOME, Parameter("where", "turn", "rad"))
    made.model.parameters = [*ARM, *HOME]
    made.frame_names = ["where"]
    (words,) = directions(made, together(0, 2, 4, 6, 7)[:, None])
    assert words == (
        "a combined change of the arm as a whole and where that cancels out: where may move, the "
        "arm does not"
    )


def test_what_stands_still_is_told_at_the_end():
    q = np.array([[0.0, 1, 2], [1, 1, 3]])
    N = np.column_stack([together(0, size=6), together(2, 4, size=6)])
    assert unobserved(problem(*ARM, q=q), N, np.zeros((6, 0))) == [
        "a: tilt",
        "a combined change of b and c that cancels out (qb is the same in all readings)",
    ]


@pytest.mark.parametrize(("length", "whole"), [(60, True), (61, False)])
def test_names_of_more_than_sixty_characters_are_shortened(length, whole):
    name = length * "x"
    made = problem(Parameter(name, "tilt", "rad"), Parameter(name, "shift", "m"))
    (words,) = directions(made, together(0, size=2)[:, None])
    assert (words == f"{name}: tilt") == whole
    assert len(words) <= 60 + len(": tilt")
    assert (_list([name]) == name) == whole
