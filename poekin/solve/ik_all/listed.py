"""Solutions of targets whose branches, in closed form or by elimination, are clear of one another: by
one kernel.
"""

from __future__ import annotations

import numpy as np

from ...engine.jit import threads
from ...engine.kernels.branches import closed_arm
from ...groups.arrays import Array
from ..ik.ik_problem import kernel_options
from .closed_form import ClosedForm
from .elimination import Elimination
from .ik_all_search import AIM, POSE, SearchedArm
from .solution_sets.found import Tally
from .solution_sets.listing import ListedPart, Listing
from .solution_sets.places import Places, whole_numbers
from .sources import Solver, Solvers

# a margin of more than some 100 times rounding is of an isolated solution, as it is 0 of double ones and
# where there are infinitely many; out of reach by less than is accepted is not out of reach
_CLEAR = 1e-12
_ABSENT = closed_arm.DOUBLE
_MOVED = 1e-3  # rad or m: how far Newton's rule moves a solution at most
_ITERATIONS = 8
_LEAST_DOF = 6  # of fewer joints those that are added may be anywhere
_AT_ONCE = 16384  # targets whose solutions are in memory with all their room
_UNINTERRUPTED = 256  # targets between which an interrupt is seen


def list_clear(
    arm: SearchedArm, T: Array, values: Array, solvers: Solvers, numbers: np.ndarray
) -> tuple[list[ListedPart], np.ndarray]:
    """Solutions of those targets that are clear, in parts, with the numbers of each one's; and which
    targets are left (n,).

    T (N, 4, 4) are targets, `values` (N, m) those of what is locked, `numbers` (n,) which of them
    are wanted, for each of which there is a solver.
    """
    parts = []
    left = np.ones(len(numbers), bool)
    for k, solver in enumerate(solvers.solvers):
        if isinstance(solver, ClosedForm) and solver.dof < _LEAST_DOF:
            continue
        own = np.flatnonzero(solvers.which == k)
        for first in range(0, len(own), _AT_ONCE):
            some = own[first : first + _AT_ONCE]
            which = numbers[some]
            own_values = values[which]
            reduced = solvers.targets(T[which], own_values)
            listing, clear = _list(arm, solver, T[which], reduced, own_values)
            left[some] = ~clear
            parts.append(ListedPart(which[clear], listing))
    return parts, left


def _list(
    arm: SearchedArm,
    solver: Solver,
    T: Array,
    reduced: Array,
    values: Array,
) -> tuple[Listing, np.ndarray]:
    """The listing of those targets T (N, 4, 4) that are clear, and which these are; `reduced` are the
    solver's targets.
    """
    from ...engine.kernels.branches import listed_branches as kernel  # which imports Numba

    fast = arm.fast
    N = len(T)
    box = np.column_stack([arm.box.limits, arm.box.periods])
    fixed = (~arm.free).astype(float)
    options = kernel_options(POSE, AIM * fast.chain.reach, AIM, _ITERATIONS)
    rule = _rule(solver)
    q = np.empty((N, solver.most, fast.dof))
    errors = np.empty((N, solver.most, kernel.ERRORS))
    info = np.empty((N, kernel.INFO))

    def run(T: Array, reduced: Array, values: Array, q: Array, errors: Array, info: Array) -> None:
        for k in range(0, len(T), _UNINTERRUPTED):
            some = slice(k, k + _UNINTERRUPTED)
            free = solver.branches(reduced[some])
            branches = _with_locked(free, values[some], arm.free)
            solutions = (_flat(q[some]), _flat(errors[some]), info[some])
            asked = (T[some], box, fixed, options, rule)
            kernel.listed.call(fast.hybrid_address, branches, *asked, *solutions)

    arrays = (np.ascontiguousarray(T), reduced, values, q, errors, info)
    if arm.parallel:
        threads.share_out(run, *arrays, rows=_UNINTERRUPTED)
    else:
        run(*arrays)
    clear = info[:, kernel.IS_CLEAR] != 0.0
    counts = info[:, : kernel.IS_CLEAR].astype(int)
    return _listing(q, errors, counts, clear), clear


def _with_locked(branches: Array, values: Array, free: np.ndarray) -> Array:
    """Branches (N, B, m' + 1) of the free coordinates and their margins, with those of all."""
    if free.all():
        return branches
    targets, count, _ = branches.shape
    whole = np.empty((targets, count, len(free) + 1))
    whole[:, :, :-1] = values[:, None]
    whole[:, :, np.append(free, True)] = branches
    return whole


def _flat(rows: Array) -> Array:
    """The rows (N, B, m) of all targets, one after the other."""
    return rows.reshape(-1, rows.shape[2])


def _rule(solver: Solver) -> Array:
    """Margins above which a branch is a solution, and below which none; see `listed_branches`."""
    if isinstance(solver, Elimination):
        return np.array([0.0, 0.0, _MOVED, 0.0])
    off = solver.margin_bound
    solution = max(_CLEAR, off)
    none = max(_ABSENT, off)
    return np.array([solution, none, _MOVED + off, -solver.none_below])


def _listing(q: Array, errors: Array, counts: np.ndarray, clear: np.ndarray) -> Listing:
    """The listing of the targets that are clear, numbered as they come; each part of a call's
    targets has its solutions at its beginning.
    """
    from ...engine.kernels.branches import listed_branches as kernel  # which imports Numba

    rows = []
    numbers = []
    for k in range(0, len(q), _UNINTERRUPTED):
        some = slice(k, k + _UNINTERRUPTED)
        there = slice(counts[some, kernel.WITHIN].sum())
        rows.append(_flat(q[some])[there])
        numbers.append(_flat(errors[some])[there])
    listed = np.concatenate(numbers)
    found, within = counts[clear].T
    places = Places(
        q=np.concatenate(rows),
        owner=np.repeat(np.arange(len(within)), within),
        number=whole_numbers(listed[:, kernel.PLACES]),
        within=within,
    )
    tally = Tally(
        found=found,
        least_hits=(found > 0).astype(float),
        ends=found,
        restarts=np.zeros(len(found), int),
        full=np.zeros(len(found), bool),
        sure=np.ones(len(found), bool),
        self_motion={},
    )
    return Listing(places, listed[:, : kernel.PLACES], tally)
