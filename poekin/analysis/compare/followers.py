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

    With directions s of the reading, joint i of b is s_i x_i: so the ratio to joint j is s_i F_ij
    s_j there.

    Parameters: C_a, C_b (n, m), the couplings of the chains a and b, which are at rest. Ratios are
    the same where what a turn of the leading joint (or a metre) makes of them is within tolerance.
    Source: none, x = C q.
    """
    F = _ratios(C_a)
    G = reading.directions[:, None] * _ratios(C_b) * reading.directions
    apart = np.abs(F - G)
    slides = prismatic(a)
    small = np.where(slides, tol.position, tol.rotation)
    scales = np.where(slides, 1.0, 2 * math.pi)
    found = []
    for i, errors in enumerate(apart * scales):
        differs = bool((errors > small[i]).any())
        found.append(Following(_words(F, i, a), _words(G, i, b), differs))
    return found


def _ratios(C: Array) -> Array:
    """F (n, n), x = F x but for constants: the first joints that are independent lead, column j
    belongs to leader j.
    """
    n = len(C)
    F = np.zeros((n, n))
    leaders: list[int] = []
    for i, row in enumerate(C):
        lead = C[leaders]
        own = np.linalg.lstsq(lead.T, row, rcond=None)[0]
        rest = np.linalg.norm(row - own @ lead)
        # beside a coordinate of its own where readings are coupled
        F[i, leaders] = np.where(np.abs(own) > 1e-12, own, 0.0)
        if rest > 1e-9 * np.linalg.norm(row):
            leaders.append(i)
            # Its coordinate may be that of a joint off the chain, which it follows by a ratio of
            # its own.
            beside_others = F[i].any()
            F[i, i] = 1.0
            if np.count_nonzero(row) == 1:
                F[i, i] = abs(row.sum())
            elif beside_others:
                F[i, i] = rest
    return F


def _words(F: Array, i: int, chain: Chain) -> str:
    own = F[i, i]
    others = [j for j in np.flatnonzero(F[i]) if j != i]
    terms = [f"{F[i, j]:.6g} × {quote(chain.joint_names[j])}" for j in others]
    if own == 1.0 and not terms:
        return ""
    if own:
        terms.append(f"{own:.6g} × its coordinate")
    if not terms:
        return "does not move"
    return "follows " + " + ".join(terms)
