"""Sources of solutions: the closed form where an arm has one, else elimination, else a search."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Literal, NamedTuple

import numpy as np

from ...errors import InputError
from ...groups.arrays import Array
from ...model.chain import Chain
from ..lock import at_ends, brought_back, free_chain
from ..ragged import Ragged
from .closed_form import ClosedForm, closed_form
from .elimination import Elimination, elimination
from .ik_all_search import Rule, SearchedArm, search
from .solution_sets.evidence import SolverUsed
from .solution_sets.found import Found, replaced

Method = Literal["auto", "closed", "elimination", "search"]
Solver = ClosedForm | Elimination

_closed_form = lru_cache(maxsize=256)(closed_form)
_elimination = lru_cache(maxsize=256)(elimination)


class Solvers(NamedTuple):
    """Solvers of the arms that locked values leave, and which of them serves each target (N,).

    One arm serves all values of what is locked before or behind the joints that move: its targets
    are brought there. `chain` is the whole arm, `free` (m,) what may move.
    """

    solvers: Sequence[Solver]
    which: np.ndarray
    chain: Chain
    free: np.ndarray

    @property
    def is_exact(self) -> bool:
        """Whether all of them are solvers of the arms themselves, and of no near ones."""
        return all(one.is_exact for one in self.solvers)

    def chosen(self, rows: np.ndarray) -> Solvers:
        """The solvers of some of the targets, by their numbers or a mask."""
        return self._replace(which=self.which[rows])

    def targets(self, T: Array, values: Array) -> Array:
        """The solvers' targets for those of the whole arm, with `values` (N, m) of what is locked."""
        return brought_back(self.chain, T, values, self.free)

    def used(self) -> SolverUsed:
        """The solver whose arm is the farthest from the given one."""
        far = max(self.solvers, key=lambda one: max(one.position_bound, one.rotation_bound))
        return SolverUsed(far.method, far.said())


def solvers_for(
    chain: Chain,
    values: Array,
    free: np.ndarray,
    method: Method,
) -> list[Solvers]:
    """Solvers for targets whose locked coordinates have `values` (N, m): those that are asked first,
    and those that are asked where these are not sure; none for the search. Raises: InputError.
    """
    if method == "search":
        return []
    ends = at_ends(chain, free)
    between = ~free & ~ends
    rows = values[:1, between]
    which = np.zeros(len(values), int)
    if between.any():
        rows, which = np.unique(values[:, between], axis=0, return_inverse=True)
    each = []
    for row in rows:
        locked = np.where(ends, 0.0, np.nan)
        locked[between] = row
        each.append(solvers_of(free_chain(chain, locked), method))
    # of an arm that needs a search all do
    return [Solvers(stage, which.ravel(), chain, free) for stage in zip(*each, strict=False)]


def solvers_of(chain: Chain, method: Method) -> tuple[Solver, ...]:
    """The closed form or elimination to use: where the closed form is that of a near arm, both; none
    for the search. Raises: InputError.
    """
    closed = None
    eliminated = None
    try:
        if method != "elimination":
            closed = _closed_form(chain)
        if method != "closed" and not (closed and closed.is_exact):
            eliminated = _elimination(chain)
    except InputError:  # of joints that are helical or coupled, or that elimination does not take
        if method != "auto":
            raise
    if method == "closed" and closed is None:
        raise InputError(
            f"ik_all: {chain!r} has no closed form (no three neighbouring axes meet or are parallel, of five joints "
            "no two); method='elimination' or 'search' finds the solutions"
        )
    if method == "elimination" and eliminated is None:
        raise InputError(
            f"ik_all: {chain!r} is not solved by elimination (it takes six revolute joints whose loops "
            "do not all degenerate); method='search' finds the solutions"
        )
    return tuple(one for one in (closed, eliminated) if one is not None)


def find(
    arm: SearchedArm,
    T: Array,
    values: Array,
    solvers: Solvers | None,
    rule: Rule,
) -> Found:
    """Solutions of targets (N, 4, 4), by the solvers where there are any, else by search."""
    m = arm.fast.dof
    if solvers is None:
        none = Ragged(np.empty((0, m)), np.zeros(len(T), int))
        return search(arm, T, values, none, rule)
    starts, unsure = starts_of(solvers, T, values)
    these_alone = Rule(1, 0, rule.iterations)
    found = search(arm, T, values, starts, these_alone)
    # where solutions become one or infinitely many, a closed form may lose them, and elimination is not sure
    unsure = np.flatnonzero(found.singular | unsure)
    if not len(unsure):
        return found
    again = search(arm, T[unsure], values[unsure], starts.chosen(unsure), rule)
    return replaced(found, unsure, again)


def starts_of(solvers: Solvers, T: Array, values: Array) -> tuple[Ragged, np.ndarray]:
    """The solvers' solutions of each target, and where there may be more of them (N,)."""
    free = solvers.free
    parts = [np.empty((0, int(free.sum())))]
    owners = [np.empty(0, int)]
    counts = np.zeros(len(T), int)
    unsure = np.zeros(len(T), bool)
    T = solvers.targets(T, values)
    for k, solver in enumerate(solvers.solvers):
        own = np.flatnonzero(solvers.which == k)
        q, counts[own], unsure[own] = solver.starts(T[own])
        parts.append(q)
        owners.append(np.repeat(own, counts[own]))
    in_order = np.argsort(np.concatenate(owners), kind="stable")
    rows = np.repeat(values, counts, axis=0)
    rows[:, free] = np.concatenate(parts)[in_order]
    return Ragged(rows, counts), unsure
