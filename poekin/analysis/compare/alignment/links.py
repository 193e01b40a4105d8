"""Another link beside other differences: the axes behind a joint, and the tool, moved together."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....groups import se3
from .alignments import Alignments
from .fit import fit
from .hypotheses import Hypothesis, make_hypotheses, still, tool_behind
from .lines import Sides


def with_link(pair: Sides, readings: list[Hypothesis]) -> list[Hypothesis]:
    """Readings with their last moved axes explained by one link; those of which that can be.

    There have to be two axes or more that moved by one motion, and the tool with them: that is what
    a link of another length or twist does to all that is behind it. A slide, which has no place, may
    be among them though it seems unmoved.
    """
    # Where nothing is in front, it is the base that moved.
    tries = []
    for reading in readings:
        differs = reading.moved | pair.a.slides
        tries += [(reading, k) for k in range(1, pair.n - 1) if differs[k:].all()]
    at = _alignments(pair, [reading for reading, _ in tries])
    # What the axes leave free stays where it starts: with the tool where it is.
    last = pair.carriers(at)[:, -1]
    back = se3.inverse(last)
    at.P[:] = pair.tool_as_it_stands.P @ back @ at.P
    ks = np.array([k for _, k in tries], int)[:, None]
    behind = np.arange(pair.n) >= ks
    fitted = fit(pair, at, False, behind)
    tools = tool_behind(pair, pair.carriers(fitted)[:, -1])
    apart = behind & (pair.deviations(fitted) > 1.0)
    fits = still(tools, pair.tol) & ~apart.any(1)
    found: dict[int, Hypothesis] = {}
    rows = zip(tries, tools, fits, strict=True)
    for (reading, k), tool, fitting in rows:
        if fitting:
            frames = int(not still(reading.base, pair.tol))
            linked = replace(reading, tool=tool, frames=frames, link=k)
            found.setdefault(id(reading), linked)
    return list(found.values())


def with_front_link(pair: Sides, reading: Hypothesis) -> Hypothesis | None:
    """The reading with its first moved axes explained by one link behind them, or None.

    These, two or more, slides that seem unmoved among them, have to agree with the base where it is:
    it is what stands behind the link that has moved, and that is what the reading had been aligned
    to.
    """
    first = np.logical_and.accumulate(reading.moved | pair.a.slides)
    last_moved = np.flatnonzero(first & reading.moved).max(initial=-1)
    k = 1 + int(last_moved)
    if reading.link or not 2 <= k < pair.n:
        return None
    at = _alignments(pair, [reading])
    at.P[:] = pair.as_they_stand.P
    front = np.arange(pair.n) < k
    fitted = fit(pair, at, False, front)
    (found,) = make_hypotheses(pair, fitted)
    moved_in_front = found.moved[front].any()
    if moved_in_front or not still(found.base, pair.tol):
        return None
    if (found.directions != reading.directions).any():
        return None
    own = reading.moved & ~front
    rows = own[:, None]
    matrices = own[:, None, None]
    return replace(
        found,
        tool=reading.tool,
        moved=found.moved | own,
        offset=reading.offset,
        axes=np.where(rows, reading.axes, found.axes),
        carriers=np.where(matrices, reading.carriers, found.carriers),
        deviations=np.where(own, reading.deviations, found.deviations),
        frames=int(not still(reading.tool, pair.tol)),
        link=k,
        apart=own,
    )


def _alignments(pair: Sides, readings: list[Hypothesis]) -> Alignments:
    """The alignments, about the arms' centres, that readings stand for."""
    bases = [reading.base for reading in readings]
    zeros = [reading.zeros for reading in readings]
    P = np.reshape(bases, (-1, 4, 4))
    z = np.reshape(zeros, (-1, pair.n))
    return Alignments(pair.on_centre(P), z)
