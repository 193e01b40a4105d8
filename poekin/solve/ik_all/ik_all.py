"""Every solution of an arm for a pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import get_args

import numpy as np
from numpy.typing import ArrayLike

from ...checks import KERNEL_INT, choice, true_or_false, whole
from ...errors import InputError, join_names
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, compiled
from ...model.kinematics.compiled import CompiledChain
from ...model.sampling import joint_ratios
from ..chain_cache import ChainCache
from ..ik.task import pose_errors, targets
from ..joint_units import JointUnits, bounds, joint_units, periods
from ..lock import items, locked_rows
from ..ragged import Ragged
from .all_solutions import AllSolutions
from .ik_all_search import POSE, Rule, SearchedArm, accepted
from .listed import list_clear
from .solution_sets.evidence import Evidence, Sampling, SolverUsed, missing_probability
from .solution_sets.found import reduce_parts
from .solution_sets.listing import ListedPart, Listing, gathered
from .solution_sets.places import Box, Places, in_order, make_places
from .solution_sets.self_motion import directions
from .sources import Method, Solvers, find, solvers_for
from .swivel import N_SWIVEL, redundant_coordinate, sample_values

_PERIODS: ChainCache[Array] = ChainCache()
_MAX_MISSES = 200  # tries without any solution, after which a search gives up


def ik_all(  # noqa: PLR0913 - options by keyword
    chain: Arm,
    T: ArrayLike,
    *,
    limits: bool = True,
    method: Method = "auto",
    all_revolutions: bool = False,
    lock: Mapping[str, ArrayLike] | None = None,
    n_swivel: int | None = None,
    redundant: str | None = None,
    min_hits: int = 14,
    restarts: int = 2000,
    iterations: int = 200,
    seed: int = 0,
    parallel: bool = False,
) -> AllSolutions:
    """Every solution q of f(q) = T, of an arm of up to six coordinates, for one target or a batch.

    In closed form where the arm's axes allow it, by elimination for six other revolute joints, of a
    calibrated arm too, each solution tried down to the target again; else by search: from random
    starts until each solution was found `min_hits` times. An arm of more
    coordinates has infinitely many solutions: `lock` keeps some of them at given values, `n_swivel`
    gives one of seven as many values.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The arm.
    T : (..., 4, 4) array_like
        Target poses of the tip in the base frame, m.
    limits : bool, default True
        Whether only solutions within the chain's limits are listed.
    method : {"auto", "closed", "elimination", "search"}, default "auto"
        "closed" refuses an arm without a closed form, "elimination" one that it does not take;
        "auto" takes the first of the three that serves.
    all_revolutions : bool, default False
        Whether all places within the limits that are whole turns apart are listed; else the one
        nearest to 0 of each solution.
    lock : dict of str to float or array_like, optional
        Names of coordinates and the values that they keep, rad or m; an array (...) has a value for
        each target.
    n_swivel : int, optional
        Number of values of the redundant coordinate of an arm with seven free coordinates, evenly
        over its limits or over a whole turn. All solutions with any of these values are listed, in
        their order; `AllSolutions.families` links them to curves.
    redundant : str, optional
        Name of that coordinate; `n_swivel` is 64 then, if it is not given. By default joint 3 of an
        arm with a spherical shoulder and a spherical wrist, where it gives the arm angle; else the
        last joint that leaves an arm with a closed form when it is locked (joint 7 of the Panda);
        else the one that moves most along self-motions.
    min_hits : int, default 14
        How often the search finds each solution before it ends; 14 leaves a chance of about 1e-3
        that one is missing, see `AllSolutions.p_missing`.
    restarts : int, default 2000
        Largest number of starts of the search.
    iterations : int, default 200
        Largest number of steps from each start.
    seed : int, default 0
        Seed of the starts; the same seed gives the same result.
    parallel : bool, default False
        Whether a long batch is shared out among threads.

    Returns
    -------
    solutions : AllSolutions
        All solutions; `complete` says whether these are surely all, `explanation` why. Of
        infinitely many, at some singular poses, one is listed. A target that is not finite has
        none, and of one without solutions `ik` says why.

    Raises
    ------
    InputError
        If more than six coordinates are free without `n_swivel`, so that there are infinitely many
        solutions, or none; if `n_swivel` is asked of an arm that has not seven; if the method that
        is asked does not solve the arm; if an option is none of those above.
    PoseError
        If an element of T is no pose.
    ShapeError
        If T has another shape, or a value of `lock` does not fit it.
    UnknownName
        If `lock` or `redundant` name a coordinate that the chain has not.

    See Also
    --------
    ik : One solution, and the reason where there is none.

    Notes
    -----
    Accuracy: every solution is within 1e-10 m and 1e-10 rad of its target by `Chain.fk` (of arms
    with a reach of more than 100 m, within 1e-12 of that); solutions that rounding cannot tell
    apart are one (tests/solve/ik_all/test_ik_all.py).
    Source: Elias and Wen 2025; Murray, Li and Sastry 1994, Chapter 3 (closed form); Raghavan and
    Roth 1993 (elimination).

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> every = pk.ik_all(arm, arm.fk([0.4, -1.2, 1.5, -0.3, 0.8, 0.0]), method="search")
    >>> len(every.solutions), every.method
    (8, 'search')

    An arm of seven joints, one of them locked:

    >>> arm = pk.load("panda").chain(tip="panda_hand")
    >>> q = [0.1, -0.5, 0.2, -2.0, 0.3, 1.6, 0.8]
    >>> every = pk.ik_all(arm, arm.fk(q), lock={"panda_joint7": 0.8})
    >>> bool(abs(every.solutions - q).max(axis=1).min() < 1e-6)
    True
    """
    compiled_chain = compiled(chain)
    choice(method, get_args(Method), "method")
    for value, what in (
        (limits, "limits"),
        (all_revolutions, "all_revolutions"),
        (parallel, "parallel"),
    ):
        true_or_false(value, what)
    for number, what in (
        (min_hits, "min_hits"),
        (restarts, "restarts"),
        (iterations, "iterations"),
    ):
        whole(number, what, 1, KERNEL_INT)
    whole(seed, "seed", 0, KERNEL_INT)
    if n_swivel is None and redundant is not None:
        n_swivel = N_SWIVEL
    if n_swivel is not None:
        whole(n_swivel, "n_swivel", 1, KERNEL_INT)
    wanted = targets(T, "T")
    rule = Rule(min_hits, restarts, iterations, _MAX_MISSES, int(seed))
    batch = wanted.shape[:-2]
    question = _question(compiled_chain, batch, items(lock), limits, (n_swivel, redundant))
    return _solved(question, wanted, method, rule, all_revolutions, parallel)


@dataclass(frozen=True, eq=False)
class _Question:
    """Question to an arm: given, the user's chain; units, its joint units; box, where solutions
    are wanted; values (N, m), those of locked coordinates in joint units, `n_swivel` times as many
    rows as targets; free (m,), what may move; lock, names of what is locked, with the user's values
    for each target of the batch; redundant, the coordinate that is given values, or None.
    """

    given: Chain
    units: JointUnits
    limits: bool
    box: Box
    values: Array
    free: np.ndarray
    lock: tuple[tuple[str, ArrayLike], ...]
    batch: tuple[int, ...]
    n_swivel: int = 1
    redundant: int | None = None

    @property
    def is_plain(self) -> bool:
        """Whether the user's coordinates are those of the solvers, with their limits alone."""
        return self.units.scale is None and not self.by_joints

    @property
    def by_joints(self) -> bool:
        """Whether joints have limits of their own that count."""
        return self.limits and bool(np.isfinite(self.units.fast.chain.joint_limits).any())

    def coordinates(self, places: Places) -> Places:
        """Places in the user's coordinates, what is locked to the last digit."""
        q = self.units.coordinates(places.q, bounds(self.given, self.limits))
        for name, value in self.lock:
            values = np.broadcast_to(np.asarray(value, float), self.batch).ravel()
            q[:, self.given.q_names.index(name)] = values[places.owner // self.n_swivel]
        return places._replace(q=q)


def _question(
    fast: CompiledChain,
    batch: tuple[int, ...],
    lock: tuple[tuple[str, ArrayLike], ...] | None,
    limits: bool,
    swivel: tuple[int | None, str | None],
) -> _Question:
    """Raises: InputError, ShapeError, UnknownName."""
    n_swivel, asked = swivel
    lock = lock or ()
    units = joint_units(fast, bool(lock) or n_swivel is not None)
    chain = units.fast.chain
    within = bounds(chain, limits)
    values = locked_rows(units, lock, within, batch)
    locked = [name for name, _ in lock]
    free = np.array([name not in locked for name in chain.q_names], bool)
    turn = _PERIODS.get(units.fast)
    if turn is None:
        turn = _PERIODS.keep(units.fast, periods(chain))
    turn = np.where(free, turn, 0.0)
    box = Box(within, turn)
    if n_swivel is None:
        _check_free(chain, free)
        return _Question(fast.chain, units, limits, box, values, free, lock, batch)
    some = values[0] if len(values) else np.where(free, np.nan, 0.0)
    k = redundant_coordinate(chain, some, asked)
    samples = sample_values(chain, k, n_swivel, limits)
    count = len(values)
    values = np.repeat(values, n_swivel, axis=0)
    values[:, k] = np.tile(samples, count)
    free[k] = False
    return _Question(fast.chain, units, limits, box, values, free, lock, batch, n_swivel, k)


def _check_free(chain: Chain, free: np.ndarray) -> None:
    m = int(free.sum())
    if m > 6:
        names = join_names(np.array(chain.q_names)[free])
        raise InputError(
            f"ik_all: expected an arm of up to six coordinates, got {m} ({names}): it has infinitely "
            "many solutions; ik finds one of your choice; here `lock` keeps coordinates at given "
            "values, and `n_swivel=64` gives one of seven 64 values"
        )
    if m == 0:
        which = "all of them are locked" if len(free) else "the chain has none"
        raise InputError(f"ik_all: expected an arm of one to six coordinates, {which}")


def _solved(
    question: _Question,
    wanted: Array,
    method: Method,
    rule: Rule,
    all_revolutions: bool,
    parallel: bool,
) -> AllSolutions:
    fast = question.units.fast
    rows = np.repeat(wanted.reshape(-1, 4, 4), question.n_swivel, axis=0)
    finite = np.asarray(np.isfinite(rows).all(axis=(1, 2)))
    numbers = np.flatnonzero(finite)
    stages = solvers_for(fast.chain, question.values[finite], question.free, method)
    arm = SearchedArm(fast, question.box, question.free, parallel)
    parts: list[ListedPart] = []
    left = np.arange(len(numbers))
    if question.is_plain and not all_revolutions:
        for stage in stages:
            clear, unclear = list_clear(
                arm, rows, question.values, stage.chosen(left), numbers[left]
            )
            parts += clear
            left = left[unclear]
    if len(left) or not parts:
        last = stages[-1].chosen(left) if stages else None
        rest = _searched(question, arm, rows, numbers[left], last, rule, all_revolutions)
        parts.insert(0, rest)
    listing = gathered(parts, len(rows))
    used = stages[0].used() if stages else None
    return _result(question, wanted, listing, _evidence(question, listing, finite, used))


def _searched(
    question: _Question,
    arm: SearchedArm,
    rows: Array,
    numbers: np.ndarray,
    solvers: Solvers | None,
    rule: Rule,
    all_revolutions: bool,
) -> ListedPart:
    """The listing of the targets of these numbers, among all of them."""
    found = find(arm, rows[numbers], question.values[numbers], solvers, rule)
    found = found.placed(numbers, len(rows))
    chain = question.units.fast.chain
    places = make_places(chain, found.q, question.box, question.by_joints, all_revolutions)
    places = in_order(question.coordinates(places), joint_ratios(question.given))
    errors = pose_errors(question.given, POSE, places.q, rows[places.owner])
    reached = (errors <= accepted(question.given)).all(axis=1)
    if not reached.all():
        errors = errors[reached]
        places = places.chosen(np.flatnonzero(reached))
    exact = solvers is not None and solvers.is_exact
    listing = Listing(places, errors, found.tally(exact))
    return ListedPart(np.arange(len(rows)), listing)


def _evidence(
    question: _Question,
    listing: Listing,
    finite: np.ndarray,
    used: SolverUsed | None,
) -> Evidence:
    """Evidence on the solutions of each target, its samples taken together."""
    tally = listing.tally
    chance = np.where(finite, missing_probability(tally), np.nan)
    n = question.n_swivel
    k = question.redundant
    sampling = None
    self_motion = dict(tally.self_motion)
    if k is not None:
        sampling = Sampling(question.given.q_names[k], n)
        chance = 1.0 - (1.0 - chance).reshape(-1, n).prod(axis=1)
        self_motion = {}
    return Evidence(
        finite=finite[::n],
        found=tally.found.reshape(-1, n).sum(axis=1),
        within=listing.places.within.reshape(-1, n).sum(axis=1),
        least_hits=tally.least_hits.reshape(-1, n).min(axis=1),
        ends=tally.ends.reshape(-1, n).sum(axis=1),
        restarts=tally.restarts.reshape(-1, n).sum(axis=1),
        full=np.asarray(tally.full.reshape(-1, n).any(axis=1)),
        sure=np.asarray(tally.sure.reshape(-1, n).all(axis=1)),
        p_missing=chance,
        self_motion=self_motion,
        free=int(question.free.sum()),
        solver=used,
        sampling=sampling,
    )


def _result(
    question: _Question,
    T: Array,
    listing: Listing,
    evidence: Evidence,
) -> AllSolutions:
    batch = T.shape[:-2]
    places = listing.places
    errors = listing.errors
    counts = np.bincount(places.owner // question.n_swivel, minlength=len(evidence.finite))
    position, rotation = reduce_parts(np.maximum, errors, Ragged(errors, counts), np.nan).T
    complete = evidence.complete.reshape(batch)
    k = question.redundant
    moving = evidence.self_motion
    return AllSolutions(
        q=places.q,
        revolutions=places.number,
        counts=counts.reshape(batch),
        method="search" if evidence.solver is None else evidence.solver.method,
        anywhere=evidence.found.reshape(batch),
        continuum=evidence.continuum.reshape(batch),
        complete=complete if batch else bool(complete),
        p_missing=evidence.p_missing.reshape(batch),
        position_error=position.reshape(batch),
        rotation_error=rotation.reshape(batch),
        self_motion_coordinates={k: one.names for k, one in moving.items()},
        self_motion_directions=directions(question.units, question.free, places, moving),
        redundant=None if k is None else question.given.q_names[k],
        sample=None if k is None else places.owner % question.n_swivel,
        evidence=evidence,
        chain=question.given,
        target=T,
        limits=question.limits,
    )
