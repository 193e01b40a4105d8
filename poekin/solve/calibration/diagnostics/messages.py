"""Directions in the space of parameters, in words."""

from __future__ import annotations

import numpy as np

from ....errors import escape_unprintable
from ....groups.arrays import Array
from ..measurements.measurement import Indices
from ..model.problem import Problem

_PART = 1e-6  # what is less than this of a direction is rounding
_WHOLE = 1.0 - 1e-9
_STILL = 1e-9  # rad or m: a reading that changes by less does not move
MOST = 8


def directions(problem: Problem, N: Array, blind: Array | None = None) -> list[str]:
    """What the orthonormal directions N (P, k), in rad and reaches, move: parameters alone first,
    then combinations.

    blind (P, b): directions orthogonal to N that make no difference, so that N is told up to them.
    """
    if not N.shape[1]:
        return []
    # the part of each single parameter that lies in the space of N, of what of it makes a
    # difference
    left = 1.0 if blind is None else np.maximum(1.0 - np.sum(blind * blind, axis=1), _PART)
    alone = np.flatnonzero(np.sum(N * N, axis=1) > _WHOLE * left)
    said = _alone(problem, alone)
    _, s, Vt = np.linalg.svd(N[alone])
    rest = N @ Vt[np.sum(s > _PART) :].T
    if not rest.shape[1]:
        return said
    involved = np.sum(rest * rest, axis=1)
    owners = list(
        dict.fromkeys(problem.parameters[j].owner for j in np.flatnonzero(involved > _PART))
    )
    count = rest.shape[1]
    if len(owners) == 1:
        words = f"{count} combinations" if count > 1 else "a combination"
        return [*said, f"{words} of the parameters of {_list(owners)}"]
    joints = {p.owner for p in problem.arm.parameters} - {"home"}
    if len(joints) > 2 and joints <= set(owners):
        owners = ["the arm as a whole", *(o for o in owners if o not in joints and o != "home")]
    words = f"{count} combined changes" if count > 1 else "a combined change"
    cancel = f"that cancel{'s' * (count == 1)} out"
    return [*said, f"{words} of {_list(owners)} {cancel}" + _common(problem, owners)]


def unseen(problem: Problem, N: Array, blind: Array) -> list[str]:
    """The same of what these measurements leave unseen, and which coordinates did not change in
    them.
    """
    said, arm = directions(problem, N, blind), problem.arm.nominal
    used = problem.q[np.unique(np.concatenate(problem.rows))]
    still = [
        name for name, column in zip(arm.q_names, used.T, strict=True) if np.ptp(column) <= _STILL
    ]
    if said and still:
        said[-1] += (
            f" ({_list(still)} {'is' if len(still) == 1 else 'are'} the same in all readings)"
        )
    return said


def _common(problem: Problem, owners: list[str]) -> str:
    """What holding them means, where unknown frames take part."""
    frames = [o for o in owners if o in problem.place_names]
    return f": {_list(frames)} may move, the arm does not" if frames else ""


def _alone(problem: Problem, alone: Indices) -> list[str]:
    """Parameters that are not seen at all, by their owner."""
    said: list[str] = []
    for owner in dict.fromkeys(problem.parameters[j].owner for j in alone):
        mine = [problem.parameters[j].what for j in alone if problem.parameters[j].owner == owner]
        every = sum(p.owner == owner for p in problem.parameters)
        what = (
            f"all {every} parameters of {escape_unprintable(owner, 60)}"
            if len(mine) == every > 1
            else None
        )
        said.append(what or f"{escape_unprintable(owner, 60)}: {', '.join(mine)}")
    return said


def _list(names: list[str]) -> str:
    short = [escape_unprintable(name, 60) for name in names[:MOST]]
    if len(names) > MOST:
        return ", ".join(short) + f" and {len(names) - MOST} more"
    return " and ".join([", ".join(short[:-1]), short[-1]] if len(short) > 1 else short)
