"""Joints that follow others, in two models: whether they do so in the same way."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...errors import quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ..axis_lines import Tolerances, prismatic
from .alignment.hypotheses import Hypothesis

_NOTHING = 1e-12  # as a ratio, and of a row of C
_INDEPENDENT = 1e-9  # of a row of C


class Following(NamedTuple):
    """Text on what a joint follows in a and in b, "" where it moves by itself, and whether they
    differ.
    """

    follows_a: str
    follows_b: str
    coupling_differs: bool


def follows(
    C_a: Array,
    C_b: Array,
    a: Chain,
    b: Chain,
    reading: Hypothesis,
    tol: Tolerances,
) -> list[Following]:
    """The earlier joints that each joint follows, in both models.

    With directions s of the reading, joint i of b is s_i x_i, and its coordinate s_i q_i: so the
    ratio to joint j is s_i F_ij s_j there.

    Parameters: C_a, C_b (n, m), the couplings of the chains a and b, which are at rest. Ratios are
    the same where what a turn of the leading joint (or a metre) makes of them is within tolerance.
    Source: none, x = C q.
    """
    spare = max(C_a.shape[1], C_b.shape[1])
    F = _relations(C_a, spare)
    G = _relations(C_b, spare)
    s = reading.directions
    G = s[:, None] * G * np.concatenate([s, s, np.ones(spare)])
    slides = prismatic(a)
    small = np.where(slides, tol.position, tol.rotation)
    leading = np.where(slides, 1.0, 2 * math.pi)
    scales = np.concatenate([leading, leading, np.full(spare, 2 * math.pi)])
    apart = np.abs(F - G) * scales
    differ = np.any(apart > small[:, None], axis=1)
    ours = [_words(terms, i, a) for i, terms in enumerate(F)]
    theirs = [_words(terms, i, b) for i, terms in enumerate(G)]
    return [Following(*each) for each in zip(ours, theirs, differ.tolist(), strict=True)]


def _relations(C: Array, spare: int) -> Array:
    """F (n, 2 n + spare), x = F (x, q) but for constants: the first joints that are independent
    lead, column j belongs to leader j, column n + j to the coordinate of the same number, and the
    last ones to coordinates beyond the number of leaders.
    """
    n = len(C)
    F = np.zeros((n, 2 * n + spare))
    beside = np.zeros_like(C)
    leaders: list[int] = []
    for i, row in enumerate(C):
        lead = C[leaders]
        ratios = np.linalg.lstsq(lead.T, row, rcond=None)[0]
        ratios[np.abs(ratios) <= _NOTHING] = 0.0
        F[i, leaders] = ratios
        rest = row - ratios @ lead
        size = np.linalg.norm(row)
        if np.linalg.norm(rest) > _INDEPENDENT * size:
            leaders.append(i)
            beside[i] = np.where(np.abs(rest) > _NOTHING * size, rest, 0.0)
    moving = np.flatnonzero(C.any(axis=0))
    columns = [n + i for i in leaders] + list(range(2 * n, 2 * n + spare))
    F[:, columns[: len(moving)]] = beside[:, moving]
    return F


def _words(terms: Array, i: int, chain: Chain) -> str:
    """Text on row i of F."""
    moved_by = np.flatnonzero(terms)
    if moved_by.tolist() == [len(chain.screws) + i] and terms[moved_by] == 1.0:
        return ""
    names = [quote(name) for name in chain.joint_names]
    whose = [f"the coordinate of {name}" for name in names]
    whose[i] = "its coordinate"
    whose += ["another coordinate"] * len(terms)
    found = [f"{terms[j]:.6g} × {(names + whose)[j]}" for j in moved_by]
    if not found:
        return "does not move"
    return "follows " + " + ".join(found)
