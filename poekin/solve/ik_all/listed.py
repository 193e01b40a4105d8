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
from .solution_sets.listing import Listing
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
    arm: SearchedArm,
    T: Array,
    values: Array,
    solvers: Solvers,
    numbers: np.ndarray,
) -> tuple[list[tuple[np.ndarray, Listing]], np.ndarray]:
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
            listing, clear = _list(arm, solver, T[which], values[which])
            left[some] = ~clear
            parts.append((which[clear], listing))
    return parts, left


def _list(
    arm: SearchedArm,
    solver: Solver,
    T: Array,
    values: Array,
) -> tuple[Listing, np.ndarray]:
    from ...engine.kernels.branches import listed_branches as kernel  # which imports Numba

    fast = arm.fast
    N = len(T)
    box = np.column_stack([arm.box.limits, arm.box.periods])
    fixed = (~arm.free).astype(float)
    options = kernel_options(POSE, AIM * fast.chain.reach, AIM, _ITERATIONS)
    rule = _rule(solver)
    q = np.empty((N, solver.most, fast.dof))
    numbers = np.empty((N, solver.most, kernel.ERRORS))
    info = np.empty((N, kernel.INFO))

    def run(T: Array, values: Array, q: Array, numbers: Array, info: Array) -> None:
        for k in range(0, len(T), _UNINTERRUPTED):
            some = slice(k, k + _UNINTERRUPTED)
            rows, margins, doubtful = solver.branches(T[some])
            q[some] = values[some, None]
            q[some, :, arm.free] = rows
            kernel.listed.call(
                fast.hybrid_address, q[some], np.ascontiguousarray(margins), fast.fk(q[some]),
                T[some], box, fixed, options, rule, numbers[some], info[some],
            )  # fmt: skip
            info[some, kernel.IS_CLEAR] *= ~doubtful

    arrays = (np.ascontiguousarray(T), values, q, numbers, info)
    if arm.parallel:
        threads.share_out(run, *arrays, rows=_UNINTERRUPTED)
    else:
        run(*arrays)
    clear = info[:, kernel.IS_CLEAR] != 0.0
    return _listing(q, numbers, info[:, : kernel.IS_CLEAR], clear), clear


def _rule(solver: Solver) -> Array:
    """Margins above which a branch is a solution, and below which none; see `listed_branches`."""
    if isinstance(solver, Elimination):
        return np.array([0.0, 0.0, _MOVED])
    off = solver.margin_bound
    return np.array([max(_CLEAR, off), max(_ABSENT, off), _MOVED + off])


def _listing(q: Array, numbers: Array, info: Array, clear: np.ndarray) -> Listing:
    """The listing of the targets that are clear, numbered as they come."""
    found, within = info[clear].astype(int).T
    # one flat index takes half the time of a mask
    there = np.flatnonzero(np.arange(q.shape[1]) < np.where(clear, info[:, 1], 0.0)[:, None])
    listed = numbers.reshape(-1, numbers.shape[2])[there]
    places = Places(
        q=q.reshape(-1, q.shape[2])[there],
        owner=np.repeat(np.arange(len(within)), within),
        number=whole_numbers(listed[:, 2]),
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
    return Listing(places, listed[:, :2], tally)
