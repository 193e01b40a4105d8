"""Directions in the space of parameters, in words."""

from __future__ import annotations

import numpy as np

from ...errors import harmless
from ...groups.arrays import Array
from .measurement import Indices
from .problem import Problem

_PART = 1e-6  # what is less than this of a direction is rounding
_WHOLE = 1.0 - 1e-9
MOST = 8


def directions(problem: Problem, N: Array) -> list[str]:
    """What the orthonormal directions N (P, k), in rad and reaches, move: parameters alone first, then combinations."""
    if not N.shape[1]:
        return []
    inside = np.sum(N * N, axis=1)  # the part of each single parameter that lies in the space of N
    alone = np.flatnonzero(inside > _WHOLE)
    said = _alone(problem, alone)
    rest = N.copy()
    rest[alone] = 0.0
    left = N.shape[1] - len(alone)
    if left <= 0:
        return said
    rest = np.linalg.svd(rest, full_matrices=False)[0][:, :left]
    involved = np.sum(rest * rest, axis=1)
    owners = list(dict.fromkeys(problem.parameters[j].owner for j in np.flatnonzero(involved > _PART)))
    if len(owners) == 1:
        words = f"{left} combinations" if left > 1 else "a combination"
        return [*said, f"{words} of what moves {_list(owners)}"]
    often = f"{left} directions in which" if left > 1 else "the direction in which"
    joints = {p.owner for p in problem.arm.parameters} - {"home"}
    if len(joints) > 2 and joints <= set(owners):
        owners = ["the arm as a whole", *(o for o in owners if o not in joints and o != "home")]
    return [*said, f"{often} {_list(owners)} move together" + _common(problem, owners)]


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
        what = f"all {every} of {harmless(owner, 60)}" if len(mine) == every > 1 else None
        said.append(what or f"{harmless(owner, 60)}: {', '.join(mine)}")
    return said


def _list(names: list[str]) -> str:
    short = [harmless(name, 60) for name in names[:MOST]]
    if len(names) > MOST:
        return ", ".join(short) + f" and {len(names) - MOST} more"
    return " and ".join([", ".join(short[:-1]), short[-1]] if len(short) > 1 else short)
