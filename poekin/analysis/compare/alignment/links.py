"""Another link beside other differences: the axes behind a joint, and the tool, moved together."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....groups.arrays import Array
from .alignments import Alignments
from .fit import fit
from .hypotheses import Hypothesis, make_hypotheses, still, tool_behind
from .lines import Sides


def with_link(pair: Sides, reading: Hypothesis) -> Hypothesis | None:
    """The reading with its last moved axes explained by one link, or None.

    There have to be two axes or more that moved by one motion, and the tool with them: that is what
    a link of another length or twist does to all that is behind it.
    """
    still_there = np.flatnonzero(~reading.moved)
    first = int(still_there.max(initial=-1)) + 1
    # Where nothing is in front, it is the base that moved.
    front = max(first, 1)
    at = Alignments(_on_centre(pair, reading.base)[None], reading.zeros[None])
    for k in range(front, pair.n - 1):
        behind = np.arange(pair.n) >= k
        fitted = fit(pair, at, False, behind)
        agree = pair.deviations(fitted)[0][behind] <= 1.0
        tool = tool_behind(pair, pair.carriers(fitted)[:, -1])[0]
        if agree.all() and still(tool, pair.tol):
            frames = int(not still(reading.base, pair.tol))
            return replace(reading, tool=tool, frames=frames, link=k)
    return None


def with_front_link(pair: Sides, reading: Hypothesis) -> Hypothesis | None:
    """The reading with its first moved axes explained by one link behind them, or None.

    These, two or more, have to agree with the base where it is: it is what stands behind the link
    that has moved, and that is what the reading had been aligned to.
    """
    agree = np.flatnonzero(~reading.moved)
    k = int(agree.min(initial=pair.n))
    if reading.link or not 2 <= k < pair.n:
        return None
    at = Alignments(_on_centre(pair, reading.base)[None], reading.zeros[None])
    front = np.arange(pair.n) < k
    fitted = fit(pair, at, False, front)
    (found,) = make_hypotheses(pair, fitted)
    if found.moved[front].any() or not still(found.base, pair.tol):
        return None
    if (found.directions != reading.directions).any():
        return None
    own = reading.moved & ~front
    rows = own[:, None]
    return replace(
        found,
        tool=reading.tool,
        moved=found.moved | own,
        offset=reading.offset,
        axes=np.where(rows, reading.axes, found.axes),
        carriers=np.where(rows[..., None], reading.carriers, found.carriers),
        deviations=np.where(own, reading.deviations, found.deviations),
        frames=int(not still(reading.tool, pair.tol)),
        link=k,
        apart=own,
    )


def _on_centre(pair: Sides, base: Array) -> Array:
    """The pose between the arms' centres, of that between their bases."""
    T = base.copy()
    turned = base[:3, :3] @ pair.b.centre
    T[:3, 3] += turned - pair.a.centre
    return T
