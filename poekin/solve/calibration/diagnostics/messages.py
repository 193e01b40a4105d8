"""Directions in the space of parameters, in words."""

from __future__ import annotations

import numpy as np

from ....errors import escape_unprintable
from ....groups.arrays import Array
from ..measurements.measurement import Rows
from ..model.problem import Problem

_PART = 1e-6  # what is less than this of a direction is rounding
_WHOLE = 1.0 - 1e-9
_STILL = 1e-9  # rad or m: a reading that changes by less does not move
MOST = 8


def directions(
    problem: Problem,
    N: Array,
    unidentifiable: Array | None = None,
) -> list[str]:
    """Words for the orthonormal directions N (P, k), in rad and reaches: parameters alone first,
    then combinations.

    unidentifiable (P, b): directions orthogonal to N that make no difference, so that N is told up
    to them.
    """
    # the part of each single parameter that lies in the space of N, of what of it makes a
    # difference
    left = np.ones(len(N))
    if unidentifiable is not None:
        lost = np.sum(unidentifiable * unidentifiable, axis=1)
        left = np.maximum(1.0 - lost, _PART)
    parts = np.sum(N * N, axis=1)
    alone = np.flatnonzero(parts > _WHOLE * left)
    words = _alone(problem, alone)
    _, s, Vt = np.linalg.svd(N[alone])
    rest = N @ Vt[np.sum(s > _PART) :].T
    if rest.shape[1]:
        words.append(_combined(problem, rest))
    return words


def _combined(problem: Problem, rest: Array) -> str:
    """Words for directions (P, k) each of which moves several parameters."""
    parts = np.sum(rest * rest, axis=1)
    involved = np.flatnonzero(parts > _PART)
    owners = list(dict.fromkeys(problem.parameters[j].owner for j in involved))
    count = rest.shape[1]
    if len(owners) == 1:
        combinations = "a combination"
        if count > 1:
            combinations = f"{count} combinations"
        return f"{combinations} of the parameters of {_list(owners)}"
    joints = {p.owner for p in problem.model.parameters} - {"home"}
    if len(joints) > 2 and joints <= set(owners):
        others = [o for o in owners if o not in joints and o != "home"]
        owners = ["the arm as a whole", *others]
    changes = "a combined change"
    cancel = "that cancels out"
    if count > 1:
        changes = f"{count} combined changes"
        cancel = "that cancel out"
    words = f"{changes} of {_list(owners)} {cancel}"
    frames = [o for o in owners if o in problem.frame_names]
    if frames:
        words += f": {_list(frames)} may move, the arm does not"
    return words


def unobserved(problem: Problem, N: Array, unidentifiable: Array) -> list[str]:
    """Words for the directions N that these measurements leave unobserved, and which coordinates
    did not change in them.
    """
    words = directions(problem, N, unidentifiable)
    if not words:
        return words
    rows = np.unique(np.concatenate(problem.rows))
    used = problem.q[rows]
    pairs = zip(problem.model.nominal.q_names, used.T, strict=True)
    still = [name for name, column in pairs if np.ptp(column) <= _STILL]
    if still:
        are = "are"
        if len(still) == 1:
            are = "is"
        words[-1] += f" ({_list(still)} {are} the same in all readings)"
    return words


def _alone(problem: Problem, alone: Rows) -> list[str]:
    """Words for single parameters, by their owner."""
    words: list[str] = []
    told = [problem.parameters[j] for j in alone]
    for owner in dict.fromkeys(p.owner for p in told):
        mine = [p.what for p in told if p.owner == owner]
        count = sum(p.owner == owner for p in problem.parameters)
        name = escape_unprintable(owner, 60)
        if len(mine) == count > 1:
            words.append(f"all {count} parameters of {name}")
        else:
            words.append(f"{name}: {', '.join(mine)}")
    return words


def _list(names: list[str]) -> str:
    short = [escape_unprintable(name, 60) for name in names[:MOST]]
    if len(names) > MOST:
        return ", ".join(short) + f" and {len(names) - MOST} more"
    if len(short) > 1:
        short = [", ".join(short[:-1]), short[-1]]
    return " and ".join(short)
