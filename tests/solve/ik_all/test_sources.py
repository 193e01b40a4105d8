"""Which solvers an arm is given to, by the method that is asked for, and what is searched again."""

from __future__ import annotations

import re
from types import SimpleNamespace
from typing import Any, get_args

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.ik_all import sources
from poekin.solve.ik_all.ik_all_search import Rule
from poekin.solve.ik_all.solution_sets.evidence import SolverUsed
from poekin.solve.ik_all.solution_sets.found import Found
from poekin.solve.ragged import Ragged
from tests.solve.ik_all.perturbed import perturbed

UR5E = pk.load("ur5e").chain()
NEARLY = perturbed(UR5E, 0, 1e-7, 1e-7)
Z = [0, 0, 1.0]
HELICAL = pk.Chain.from_space([pk.screw.helical(Z, [0, 0, 0], 0.1)], np.eye(4))
TWO = pk.Chain.from_space([pk.screw.revolute(Z, [x, 0, 0]) for x in (0, 1)], np.eye(4))
SKEW = pk.Chain.from_space(
    [pk.screw.revolute(w / np.linalg.norm(w), p) for w, p in np.random.default_rng(1).normal(size=(6, 2, 3))],
    np.eye(4),
)  # fmt: skip


@pytest.mark.parametrize(("chain", "method", "solvers"), [
    (UR5E, "auto", ["closed form"]),
    (UR5E, "closed", ["closed form"]),
    (UR5E, "elimination", ["elimination"]),
    (NEARLY, "auto", ["closed form", "elimination"]),
    (NEARLY, "closed", ["closed form"]),
    (NEARLY, "elimination", ["elimination"]),
    (SKEW, "auto", ["elimination"]),
    (TWO, "auto", ["closed form"]),
    (HELICAL, "auto", []),
])  # fmt: skip
def test_an_arm_is_solved_in_closed_form_and_by_elimination_where_that_is_of_a_near_arm(
    chain, method, solvers
):
    assert [one.method for one in sources.solvers_of(chain, method)] == solvers


@pytest.mark.parametrize(("chain", "method", "words"), [
    (SKEW, "closed", f"ik_all: {SKEW!r} has no closed form (no three neighbouring axes meet or are parallel, of five "
     "joints no two); method='elimination' or 'search' finds the solutions"),
    (TWO, "elimination", f"ik_all: {TWO!r} is not solved by elimination (it takes six revolute joints whose loops do "
     "not all degenerate); method='search' finds the solutions"),
    (HELICAL, "closed", "closed form: expected revolute and prismatic joints only, 'joint1' is helical"),
])  # fmt: skip
def test_a_method_that_does_not_solve_an_arm_says_so(chain, method, words):
    with pytest.raises(InputError, match=f"^{re.escape(words)}$"):
        sources.solvers_of(chain, method)
    assert method in get_args(sources.Method)


def test_each_value_of_what_is_locked_between_has_its_own_solver():
    free = np.arange(6) != 2
    values = np.full((3, 6), np.nan)
    values[:, 2] = [0.7, 0.2, 0.7]
    [stage] = sources.solvers_for(UR5E, values, free, "auto")
    assert stage.which.tolist() == [1, 0, 1]
    assert len(stage.solvers) == 2
    assert stage.is_exact
    assert stage.chosen(np.array([2, 1])).which.tolist() == [1, 0]
    assert sources.solvers_for(UR5E, values, free, "search") == []


def test_what_is_locked_at_an_end_needs_no_solver_of_its_own():
    free = np.arange(6) != 5
    values = np.full((3, 6), np.nan)
    values[:, 5] = [0.7, 0.2, 0.7]
    [stage] = sources.solvers_for(UR5E, values, free, "auto")
    assert (stage.which.tolist(), len(stage.solvers)) == ([0, 0, 0], 1)


def solver(name: str, position: float, rotation: float) -> Any:
    return SimpleNamespace(
        method="closed form",
        position_bound=position,
        rotation_bound=rotation,
        is_exact=not position and not rotation,
        said=lambda: name,
    )


def test_the_solver_that_is_farthest_from_its_arm_is_told():
    exact, turned, moved = solver("a", 0, 0), solver("b", 0, 3e-6), solver("c", 2e-6, 1e-7)
    where = np.zeros(1, int), UR5E, np.ones(6, bool)
    for some, word in (([exact, moved, turned], "b"), ([exact, moved], "c"), ([exact], "a")):
        stage = sources.Solvers(some, *where)
        assert stage.used() == SolverUsed("closed form", word)
        assert stage.is_exact == (word == "a")


def test_what_is_singular_or_unsure_is_searched_again_from_its_starts(monkeypatch):
    asked: list[Any] = []

    def search(arm: Any, T: np.ndarray, values: np.ndarray, starts: Ragged, rule: Rule) -> Found:
        asked.append((T[:, 0, 3].tolist(), values.tolist(), [s.tolist() for s in starts], rule))
        counts = np.ones(len(T), int)
        q = np.full((len(T), 1), len(asked), float)
        none = 0 * counts
        return Found(Ragged(q, counts), none + 1.0, none, none, none > 0, T[:, 0, 3] == 2)

    def starts(T: np.ndarray) -> Any:
        return (
            np.arange(4.0)[:, None],
            np.array([1, 0, 2, 1]),
            np.array([False, True, True, False]),
        )

    monkeypatch.setattr(sources, "search", search)
    T = np.tile(np.eye(4), (4, 1, 1))
    T[:, 0, 3] = np.arange(4)
    values = np.full((4, 1), 9.0)
    whole = np.ones(1, bool)
    one: Any = SimpleNamespace(starts=starts)
    stage: Any = sources.Solvers([one], np.zeros(4, int), TWO, whole)
    monkeypatch.setattr(sources.Solvers, "targets", lambda self, T, values: T)
    arm: Any = SimpleNamespace(fast=SimpleNamespace(dof=1))
    rule = Rule(3, 40, 50, 6, 7)
    found = sources.find(arm, T, values, stage, rule)
    assert asked == [
        ([0, 1, 2, 3], [[9]] * 4, [[[0]], [], [[1], [2]], [[3]]], Rule(1, 0, 50)),
        ([1, 2], [[9]] * 2, [[], [[1], [2]]], rule),
    ]
    assert found.q.rows.ravel().tolist() == [1, 2, 2, 1]
    alone = sources.find(arm, T[:2], values[:2], None, rule)
    assert asked[2] == ([0, 1], [[9]] * 2, [[], []], rule)
    assert alone.q.rows.ravel().tolist() == [3, 3]
    sure = SimpleNamespace(starts=lambda T: (np.zeros((1, 1)), np.ones(1, int), np.zeros(1, bool)))
    sources.find(
        arm, T[:1], values[:1], stage._replace(solvers=[sure], which=np.zeros(1, int)), rule
    )
    assert len(asked) == 4
