"""Every solution of an arm for a pose."""

from __future__ import annotations

import itertools
from functools import lru_cache
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from ...checks import KERNEL_INT, choice, true_or_false, whole
from ...errors import InputError, MissingExtra, join_names
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, compiled
from ...model.kinematics.compiled import CompiledChain
from ...model.readings.coupled import beyond_own_limits
from ...model.sampling import joint_ratios
from ..ik.task import pose_errors, targets
from ..joint_units import bounds, joint_units, periods
from .all_solutions import AllSolutions, MethodUsed, in_words, missing_probability
from .closed_form import ClosedForm, closed_form
from .ik_all_search import POSE, Found, Rule, accepted, joined, search, turns_within

Method = Literal["auto", "closed", "search"]

MOST = 4096
"""The most places that `all_revolutions=True` lists for one target."""

_BAD_TARGET = "0 solutions: bad target, it is not made of finite numbers"
_MANY = 2**63 - 1  # the largest number of `n_revolutions`
_MAX_MISSES = 200  # tries without any solution, after which a search gives up


def ik_all(  # noqa: PLR0913 - options by keyword
    chain: Arm,
    T: ArrayLike,
    *,
    limits: bool = True,
    method: Method = "auto",
    all_revolutions: bool = False,
    min_hits: int = 14,
    restarts: int = 2000,
    iterations: int = 200,
    seed: int = 0,
) -> AllSolutions:
    """Every solution q of f(q) = T, of an arm of up to six coordinates, for one target or a batch.

    In closed form by EAIK where it is installed (extra `ik`) and the arm's axes allow it, each
    solution tried down to the target again; else by search: from random starts until each solution
    was found `min_hits` times.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The arm.
    T : (..., 4, 4) array_like
        Target poses of the tip in the base frame, m.
    limits : bool, default True
        Whether only solutions within the chain's limits are listed.
    method : {"auto", "closed", "search"}, default "auto"
        "closed" refuses an arm without a closed form; "search" does without EAIK.
    all_revolutions : bool, default False
        Whether all places within the limits that are whole turns apart are listed; else the one
        nearest to 0 of each solution.
    min_hits : int, default 14
        How often the search finds each solution before it ends; 14 leaves a chance of about 1e-3
        that one is missing, see `AllSolutions.p_missing`.
    restarts : int, default 2000
        Largest number of starts of the search.
    iterations : int, default 200
        Largest number of steps from each start.
    seed : int, default 0
        Seed of the starts; the same seed gives the same result.

    Returns
    -------
    solutions : AllSolutions
        All solutions; `complete` says how sure it is that these are all. Of infinitely many, at
        some singular poses, one is listed. A target that is not finite has none, and of one without
        solutions `ik` says why.

    Raises
    ------
    InputError
        If the arm has more than six coordinates, and so infinitely many solutions, or none; if it
        has no closed form and "closed" is asked; if an option is none of those above.
    MissingExtra
        If "closed" is asked and EAIK is not installed.
    PoseError
        If an element of T is no pose.
    ShapeError
        If T has another shape.

    See Also
    --------
    ik : One solution, and the reason where there is none.

    Notes
    -----
    Accuracy: every solution is within 1e-10 m and 1e-10 rad of its target by `Chain.fk` (of arms
    with a reach of more than 100 m, within 1e-12 of that); solutions that rounding cannot tell
    apart are one (tests/solve/ik_all/test_ik_all.py).
    Source: Ostermeier, Külz and Althoff 2025 (closed form, EAIK).

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> every = pk.ik_all(arm, arm.fk([0.4, -1.2, 1.5, -0.3, 0.8, 0.0]), method="search")
    >>> len(every.solutions), every.method
    (8, 'search')
    """
    compiled_chain = compiled(chain)
    given = compiled_chain.chain
    units = joint_units(compiled_chain)
    fast = units.fast
    _check_chain(given)
    true_or_false(limits, "limits")
    true_or_false(all_revolutions, "all_revolutions")
    choice(method, get_args(Method), "method")
    whole(min_hits, "min_hits", 1, KERNEL_INT)
    whole(restarts, "restarts", 1, KERNEL_INT)
    whole(iterations, "iterations", 1, KERNEL_INT)
    whole(seed, "seed", 0, KERNEL_INT)
    wanted = targets(T, "T")
    rows = np.ascontiguousarray(wanted.reshape(-1, 4, 4))
    finite = np.asarray(np.isfinite(rows).all(axis=(1, 2)))
    solver = _solver(fast.chain, method)
    rule = Rule(min_hits, restarts, iterations, _MAX_MISSES, int(seed))
    found = _found(fast, rows[finite], solver, rule, limits)
    every = _of_every_target(found, finite, fast.dof)
    places = _places(fast.chain, every, limits, all_revolutions)
    q = units.coordinates(places.q, bounds(given, limits))
    order = _order(q * joint_ratios(given), places.owner)
    places = _Places(q[order], places.owner[order], places.number[order], places.within)
    closed = None if solver is None else solver.said()
    complete = [
        in_words(f, int(inside), closed) if known else _BAD_TARGET
        for f, inside, known in zip(every, places.within, finite, strict=True)
    ]
    method_used = "search" if solver is None else "closed form"
    return _result(given, wanted, every, places, complete, method_used)


def _check_chain(chain: Chain) -> None:
    m = chain.dof
    if m > 6:
        raise InputError(
            f"ik_all: expected an arm of up to six coordinates, got {m} "
            f"({join_names(chain.q_names)}): it has infinitely many solutions; ik finds one: with "
            "`nearest_to` or `secondary_objective` one of your choice, with `lock` at given values "
            "of some coordinates"
        )
    if m == 0:
        raise InputError("ik_all: expected an arm of one to six coordinates, the chain has none")


def _solver(chain: Chain, method: Method) -> ClosedForm | None:
    """The closed form to use, or None for the search."""
    if method == "search":
        return None
    try:
        solver = _closed_form(chain)
    except (MissingExtra, InputError):  # of joints that slide, or are coupled
        if method == "closed":
            raise
        return None
    if solver is None and method == "closed":
        raise InputError(
            f"ik_all: {chain!r} has no closed form that EAIK knows (no three axes that meet, or are parallel, where it "
            "needs them); method='search' finds the solutions"
        )
    return solver


def _found(
    fast: CompiledChain,
    T: Array,
    solver: ClosedForm | None,
    rule: Rule,
    limits: bool,
) -> list[Found]:
    """Solutions of targets (N, 4, 4), by the closed form where there is one, else by search."""
    if solver is None:
        none = np.empty((0, fast.dof))
        starts = [none] * len(T)
        return search(fast, T, starts, rule, limits)
    starts, given_up = _starts(solver, T)
    these_alone = Rule(1, 0, rule.iterations)
    found = search(fast, T, starts, these_alone, limits)
    # where solutions become one or infinitely many, a closed form may lose them
    unsure = [k for k, f in enumerate(found) if f.singular or k in given_up]
    given = [starts[k] for k in unsure]
    again = search(fast, T[unsure], given, rule, limits)
    for k, f in zip(unsure, again, strict=True):
        found[k] = f
    return found


def _of_every_target(
    found: list[Found],
    finite: np.ndarray,
    dof: int,
) -> list[Found]:
    """Solutions of all targets, none of those that are not finite."""
    nothing = Found(
        solutions=np.empty((0, dof)),
        hits=np.empty(0),
        ends=0,
        restarts=1,
        full=False,
    )
    every = [nothing] * len(finite)
    numbers = np.flatnonzero(finite)
    for k, f in zip(numbers, found, strict=True):
        every[k] = f
    return every


def _starts(solver: ClosedForm, T: Array) -> tuple[list[Array], set[int]]:
    """The closed form's solutions of each target, and the numbers of those for which it gives up."""
    starts: list[Array] = []
    given_up = set()
    for k, target in enumerate(T):
        try:
            starts.append(solver.starts(target))
        except RuntimeError:
            starts.append(np.empty((0, 6)))
            given_up.add(k)
    return starts, given_up


_closed_form = lru_cache(maxsize=32)(closed_form)


class _Places(NamedTuple):
    """Configurations q (S, m) within the limits, and the target of each.

    `number` says for how many places within the limits each stands, `within` how many solutions
    each target has there.
    """

    q: Array
    owner: np.ndarray
    number: np.ndarray
    within: np.ndarray


def _places(
    chain: Chain,
    found: list[Found],
    limits: bool,
    all_revolutions: bool,
) -> _Places:
    """The solutions within the limits; of those that are whole turns apart the one nearest to 0, or
    all.
    """
    Q, owner = joined(found, chain.dof)
    first, last = turns_within(chain, Q, limits)
    kept = (first <= last).all(axis=1)
    Q = Q[kept]
    owner = owner[kept]
    first = first[kept]
    last = last[kept]
    turns = np.clip(0.0, first, last)
    bounded = np.isfinite(first) & np.isfinite(last)
    first = np.where(bounded, first, turns)
    last = np.where(bounded, last, turns)
    with np.errstate(over="ignore"):
        number = (last - first + 1).prod(axis=1)
    row = np.arange(len(Q))
    by_joints = limits and np.isfinite(chain.joint_limits).any()
    if all_revolutions or by_joints:
        places = np.bincount(owner, number, minlength=1)
        most = places.max(initial=0)
        if most > MOST:
            raise InputError(
                f"all_revolutions: {most:.0f} places for one target, more than {MOST}; "
                "`n_revolutions` of the result tells"
            )
        turns = _turns_between(first, last)
        row = np.repeat(row, number.astype(int))
    q = np.clip(Q[row] + periods(chain) * turns, *bounds(chain, limits).T) + 0.0
    if by_joints:
        kept = np.flatnonzero(~beyond_own_limits(chain, q).any(axis=1))
        number = np.bincount(row[kept], minlength=len(Q))
        if not all_revolutions:
            kept = kept[np.unique(row[kept], return_index=True)[1]]
        q = q[kept]
        row = row[kept]
    within = np.bincount(owner[np.unique(row)], minlength=len(found))
    if all_revolutions:
        number = np.ones(len(Q))
    counts = np.array([int(min(n, _MANY)) for n in number[row]], np.int64)
    return _Places(q, owner[row], counts, within)


def _turns_between(first: Array, last: Array) -> Array:
    """All whole turns (S, m) from the first to the last ones (s, m), row after row, the fewest first."""
    turns = [
        product
        for f, g in zip(first, last, strict=True)
        for product in sorted(itertools.product(*map(np.arange, f, g + 1)), key=np.linalg.norm)
    ]
    return np.array(turns, float).reshape(-1, first.shape[1])


def _order(q: Array, owner: np.ndarray) -> np.ndarray:
    """The order of solutions (S, m): target by target, sorted; what differs by rounding alone, by
    later coordinates.
    """
    columns = np.round(q, 9).T
    return np.lexsort((*columns[::-1], owner))


def _result(
    chain: Chain,
    T: Array,
    found: list[Found],
    places: _Places,
    complete: list[str],
    method: MethodUsed,
) -> AllSolutions:
    """The result, of places in order, every solution looked at by `Chain.fk`."""
    batch = T.shape[:-2]
    wanted = T.reshape(-1, 4, 4)[places.owner]
    errors = pose_errors(chain, POSE, places.q, wanted)
    reached = (errors <= accepted(chain)).all(axis=1)
    good = np.flatnonzero(reached)
    numbers = np.arange(len(found) + 1)
    ends = np.searchsorted(places.owner[good], numbers)
    own = [good[a:b] for a, b in itertools.pairwise(ends)]
    nothing = (np.nan, np.nan)
    worst = [errors[k].max(axis=0) if len(k) else nothing for k in own]
    position, rotation = np.reshape(worst, (-1, 2)).T
    moving = [len(f.self_motion_coordinates) > 0 for f in found]
    counts = [len(f.solutions) for f in found]
    missing = [missing_probability(f) for f in found]
    lists: dict[str, Any] = {
        "solutions": [places.q[k] for k in own],
        "n_revolutions": [places.number[k] for k in own],
        "complete": complete,
    }
    if not batch:
        lists = {name: one for name, (one,) in lists.items()}
    return AllSolutions(
        **lists,
        method=method,
        count=np.diff(ends).reshape(batch),
        anywhere=np.array(counts, int).reshape(batch),
        continuum=np.array(moving, bool).reshape(batch),
        p_missing=np.array(missing).reshape(batch),
        position_error=position.reshape(batch),
        rotation_error=rotation.reshape(batch),
        chain=chain,
        target=T,
    )
