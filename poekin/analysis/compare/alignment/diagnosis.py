"""The reading of two models' difference that is told: of the axes that agree where these are half
of them or more, else of all axes or of the models as they stand.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from ....groups import se3
from ....groups.arrays import Array
from ....model.chain import Chain
from ...axis_lines import Tolerances
from ..reached import pose_differences
from .alignments import Alignments
from .fit import fit
from .hypotheses import Hypothesis, frames_moved, make_hypotheses
from .lines import Sides, sides
from .links import with_link
from .robust import robust_alignments
from .search import search

AlignedTo = Literal["agreeing axes", "all axes", "nothing"]

HALF = 0.5
"""Share of the axes that have to agree, and of the pose errors that an alignment to all axes may
leave: one that explains less is no alignment.
"""
QUARTER = 0.25
"""Share of the pose errors that another zero of one joint may leave where all axes differ: beside an
industrial arm's calibration of some 0.1 degrees and 1 mm, a zero that is wrong by 3 degrees.
"""


class Diagnosis(NamedTuple):
    """The reading that is told, others that blame one joint only, and what was aligned."""

    reading: Hypothesis
    others: list[Hypothesis]
    aligned_to: AlignedTo


class _Case(NamedTuple):
    """Two chains at rest, side by side, and the configurations (m, n) at which poses are compared."""

    a: Chain
    b: Chain
    pair: Sides
    samples: tuple[Array, ...]


def diagnose(
    a: Chain,
    b: Chain,
    tol: Tolerances,
    samples: tuple[Array, ...],
) -> Diagnosis:
    """The reading of the difference of two chains at rest, whichever comes first.

    Parameters: samples, several sets (m, n) of joint values; an alignment that makes the poses
    worse in any of them is none.
    """
    # One order for both, as b seen from a and a seen from b are told apart by rounding.
    if _order(b) < _order(a):
        found = _diagnose(b, a, tol, samples)
        others = [other.swapped(b) for other in found.others]
        return found._replace(reading=found.reading.swapped(b), others=others)
    return _diagnose(a, b, tol, samples)


def _order(chain: Chain) -> list[float]:
    return [*chain.screws.ravel(), *chain.pitches, *chain.home.ravel()]


def _diagnose(
    a: Chain,
    b: Chain,
    tol: Tolerances,
    samples: tuple[Array, ...],
) -> Diagnosis:
    first, others = search(a, b, tol)
    case = _Case(a, b, sides(a, b, tol), samples)
    if not first.moved.any() or _holds(case, first):
        return Diagnosis(first, others, "agreeing axes")
    stand, *readings = _of_all_axes(case)
    best = stand
    errors = _errors(case, best)
    for reading in readings:
        tried = _errors(case, reading)
        share = HALF
        if reading.offset.sum() > best.offset.sum():
            share = QUARTER
        # Of two that change as much the better one, but none for nothing.
        elif best is not stand and reading.frames == best.frames:
            share = 1.0
        if (tried <= share * errors).all():
            best = reading
            errors = tried
    aligned_to: AlignedTo = "nothing"
    if best.frames:
        aligned_to = "all axes"
    (best,) = with_link(case.pair, [best]) or [best]
    return Diagnosis(best, [], aligned_to)


def _holds(case: _Case, reading: Hypothesis) -> bool:
    """Whether half of the axes or more agree, and the poses are not worse than as they stand."""
    if reading.beside_link.sum() > HALF * case.pair.n:
        return False
    for x in case.samples:
        ours = case.a.fk(x)
        before, _ = pose_differences(ours, case.b.fk(x))
        after, _ = pose_differences(ours, reading.poses(case.b, x))
        room = case.pair.tol.position
        if after.max() > before.max() + room and after.mean() > before.mean() + room:
            return False
    return True


def _of_all_axes(case: _Case) -> list[Hypothesis]:
    """Readings that move no frame, the base, the tool, and both; each as zeros are, then with another
    zero of one joint.
    """
    pair = case.pair
    stand = pair.as_they_stand
    robust = stand.joined(robust_alignments(pair))
    alone = np.eye(pair.n, dtype=bool)[1:-1]
    free = alone.repeat(len(robust), 0)
    turned = fit(pair, robust.tiled(len(alone)), free, True)
    here = Alignments(stand.P.repeat(len(turned), 0), turned.z)
    aligned = make_hypotheses(pair, robust.joined(here, turned))
    found = [replace(reading, tool=np.eye(4)) for reading in aligned]
    found += [replace(reading, tool=_tool(case, reading)) for reading in aligned]
    return [replace(r, frames=int(frames_moved(pair, r.base, r.tool))) for r in found]


def _tool(case: _Case, reading: Hypothesis) -> Array:
    """The tool that brings the poses nearest: the mean of those that each configuration asks for."""
    x = np.concatenate(case.samples)
    asked = se3.inverse(reading.poses(case.b, x)) @ case.a.fk(x)
    mean = np.eye(4)
    for _ in range(3):
        steps = se3.log(se3.inverse(mean) @ asked)
        mean = mean @ se3.exp(steps.mean(0))
    return reading.tool @ mean


def _errors(case: _Case, reading: Hypothesis) -> Array:
    """The largest pose error of each set, in tolerances of position and rotation together."""
    tol = case.pair.tol
    worst = []
    for x in case.samples:
        moved, turned = pose_differences(case.a.fk(x), reading.poses(case.b, x))
        worst.append(moved.max() / tol.position + turned.max() / tol.rotation)
    return np.array(worst)
