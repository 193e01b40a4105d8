"""Solutions nearest to a given configuration: of all where they are known, else of several tries."""

from __future__ import annotations

import itertools

import numpy as np

from ....engine.kernels import ik_codes as codes
from ....groups.arrays import Array
from ....groups.vectors import norms
from ...joint_units import bounds
from ..ik_problem import IKProblem
from .every_solution import every_solution

NEAREST_OF = 48
"""Number of tries for each target after the first."""

NEAREST_TRIES = tuple(itertools.product((True, False), repeat=2))
"""Whether each of them is made with limits, and whether it starts not far away; they take turns.
More of those without limits arrive, and many of these within the limits but for whole turns."""

CLOSE = 0.25
"""Share of the way to a random start at which a try that starts not far away begins."""


def nearest(
    problem: IKProblem,
    targets: Array,
    indices: Array,
    q0: Array,
    near: Array,
) -> tuple[Array, Array]:
    """q and info of the solution nearest to the configuration `near`, for each target.

    It is the nearest of all where these are known, else of several tries, see `nearest_of_tries`.
    """
    every = every_solution(problem, targets, near)
    if every is None:
        return nearest_of_tries(problem, targets, indices, q0, near)
    solved, first = np.unique(every.owner, return_index=True)
    best = near.copy()
    best[solved] = every.u[first]
    best, info = problem.solve(targets, indices, best, restarts=0)
    distance = np.full(len(near), np.inf)
    distance[solved] = _distance(best, near, info)[solved]
    rest = np.flatnonzero(~(every.complete & np.isfinite(distance)))
    if len(rest):
        asked = (targets[rest], indices[rest], q0[rest], near[rest])
        other, told = nearest_of_tries(problem, *asked)
        nearer = ~(distance[rest] < _distance(other, near[rest], told))
        best[rest[nearer]] = other[nearer]
        info[rest[nearer]] = told[nearer]
    return best, info


def nearest_of_tries(
    problem: IKProblem,
    targets: Array,
    indices: Array,
    q0: Array,
    near: Array,
) -> tuple[Array, Array]:
    """q and info of the nearest solution that several tries find, for each target.

    The first of them starts from q0 or, where that is anywhere, from `near` within the limits.
    """
    domain = problem.domain
    within = domain.held(np.clip(near, *domain.limits.T))
    first = np.where(np.isnan(q0), within, q0)
    q, kept = problem.solve(targets, indices, first)
    best = domain.wrapped(q, near)
    distance = _distance(best, near, kept)
    rng = np.random.default_rng(problem.settings.seed)
    low, high = domain.ranges.T
    anywhere = bounds(problem.fast.chain, False)
    for limited, close in itertools.islice(itertools.cycle(NEAREST_TRIES), NEAREST_OF):
        start = domain.held(low + (high - low) * rng.random(near.shape))
        if close:
            start = within + CLOSE * (start - within)
        limits = None if limited else anywhere
        other, info = problem.solve(targets, indices, start, restarts=0, limits=limits)
        other = domain.wrapped(other, near)
        far = _distance(other, near, info)
        far[~problem.contains(other)] = np.inf
        nearer = far < distance
        best[nearer] = other[nearer]
        distance[nearer] = far[nearer]
        kept[:, codes.AT_ITERATIONS] += info[:, codes.AT_ITERATIONS]
    return best, kept


def _distance(q: Array, near: Array, info: Array) -> Array:
    """Distance of solutions from a configuration; infinite where there is no solution."""
    solved = info[:, codes.AT_STATE] == codes.SOLVED
    distance = norms(q - near)
    return np.where(solved, distance, np.inf)
