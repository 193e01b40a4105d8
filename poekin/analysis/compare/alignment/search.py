"""The reading of two models' difference that blames the fewest joints.

Each hypothesis, nothing differs, one zero offset, one axis, one joint, one link, all zero offsets,
all of them and one axis, is fitted by least squares over the axes that it holds to agree. What is
then beyond tolerance is implicated; the fewest implicated joints win, then the base and tool that stay
where they are, then the fewest changes. So one bad joint is not smeared over its neighbours.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np

from ....model.chain import Chain
from ...axis_lines import Marks, Tolerances, wrapped
from ..reached import poses_agree
from .alignment_seeds import PairPoses, best, one_by_one, one_turn, rigid_poses
from .alignments import Alignments, Rows
from .fit import fit
from .hypotheses import COSTS, Hypothesis, frames_moved, make_hypotheses, tool_behind
from .lines import Sides, sides
from .links import with_front_link, with_link

_cost = attrgetter("cost")

MOST_LINKED = 12
"""So many readings are tried with another link."""


@dataclass(frozen=True, eq=False)
class _Start(Rows):
    """Starts of a fit, with the zero offsets that are `free` and the axes that are `used` (m, n)."""

    at: Alignments
    free: Marks
    used: Marks

    def fitted(self, pair: Sides) -> Alignments:
        """The alignments to which these starts lead."""
        return fit(pair, self.at, self.free, self.used)


def search(
    a: Chain,
    b: Chain,
    tol: Tolerances,
) -> tuple[Hypothesis, list[Hypothesis]]:
    """The best reading of the difference of two chains at rest, and the others that blame one joint
    only.
    """
    pair = sides(a, b, tol)
    n = pair.n
    found = make_hypotheses(pair, pair.as_they_stand)
    (unmoved,) = found
    # Alike as they stand: nothing is to be aligned.
    if not unmoved.cost[0] and not unmoved.frames:
        return unmoved, []
    poses = rigid_poses(pair)
    starts = best(pair, poses.at)
    found += _rigid(pair, starts, True)
    first = min(found, key=_cost)
    if first.cost[0] == 0:
        return first, []
    two = starts[:2]
    alone = np.eye(n, dtype=bool)
    all_but_one = ~alone.repeat(len(two), 0)
    found += _rigid(pair, two.tiled(n), all_but_one)
    if n > 2:
        found += _one_joint(pair, poses)
    found += _links(pair, poses.at)
    # Where several axes differ, those that most starts agree on; one bad axis is looked for above.
    readings = make_hypotheses(pair, starts)
    found += [r for r in readings if r.moved.sum() > 1]
    miss = pair.deviations(starts)
    agree = np.concatenate([miss <= 10.0, miss <= 1.0])
    found += _rigid(pair, starts.tiled(2), agree)
    if min(found, key=_cost).cost[0] > COSTS.one_change:
        found += _conventions(pair)
        found += _other_links(pair, found)
    # The reading of the models as they stand holds, and so there is one that does.
    found.sort(key=_cost)
    found = [r for r in found if r.moved.any() or poses_agree(pair, a, b, r)]
    first = _across_a_slide(pair, found[0])
    return _simpler(first, found), _others(first, found)


def agreeing(a: Chain, b: Chain, tol: Tolerances) -> Hypothesis | None:
    """The best reading of two chains at rest under which all axes agree, or None: `search` without
    what differs.
    """
    pair = sides(a, b, tol)
    rigid = rigid_poses(pair).at
    found = make_hypotheses(pair, rigid[:1])
    found += _rigid(pair, best(pair, rigid), True)
    if min(found, key=_cost).cost[0]:
        starts = _other_zeros(pair)
        found += _simplest(pair, _all_zeros_free(pair, starts))
    found.sort(key=_cost)
    for reading in found:
        if not reading.moved.any() and poses_agree(pair, a, b, reading):
            return reading
    return None


def _rigid(
    pair: Sides,
    starts: Alignments,
    used: Marks | bool,
) -> list[Hypothesis]:
    """Readings of starts fitted to the axes in `used`, zero offsets as they are."""
    fitted = fit(pair, starts, False, used)
    return make_hypotheses(pair, fitted)


def _one_joint(pair: Sides, poses: PairPoses) -> list[Hypothesis]:
    """Readings in which one inner joint alone has a zero offset, its axis agreeing, or held to be
    wrong.
    """
    alone = np.eye(pair.n, dtype=bool)
    inner = range(1, pair.n - 1)
    starts = [one_turn(pair, poses, k) for k in inner]
    # Of each joint all the starts with its axis, then the two best without it, then the two with
    # what agrees alone.
    tries = []
    for k, at in zip(inner, starts, strict=True):
        own = alone[k]
        tries.append(_start(at, own, True))
        tries.append(_start(at[:2], own, ~own))
    for k, at in zip(inner, starts, strict=True):
        two = at[:2]
        agree = pair.deviations(two) <= 1.0
        tries.append(_start(two, alone[k], agree))
    first, *others = tries
    together = first.joined(*others)
    return make_hypotheses(pair, together.fitted(pair))


def _start(at: Alignments, free: Marks, used: Marks | bool) -> _Start:
    """Starts with the same joints free, and the same or their own axes used."""
    shape = at.z.shape
    free = np.broadcast_to(free, shape)
    used = np.broadcast_to(used, shape)
    return _Start(at, free, used)


def _simpler(first: Hypothesis, found: list[Hypothesis]) -> Hypothesis:
    """The best reading, or one that leaves base and tool where they are, which it does not, and
    blames fewer joints or, all axes agreeing, changes fewer conventions, frames among them.
    """
    if not first.frames or first.link:
        return first
    in_place = (r for r in found if not r.frames)
    most = first.implicated.sum()
    conventions = first.changes.sum() + first.frames
    for r in in_place:
        if r.moved.any() and r.implicated.sum() < most:
            return r
        no_axis = not r.moved.any()
        if no_axis and r.changes.sum() < conventions:
            return r
    return first


def _links(pair: Sides, rigid: Alignments) -> list[Hypothesis]:
    """Readings in which one link is another: the axes before it agree under one pose, those behind
    under another.
    """
    found = []
    b = pair.transformed(rigid)
    near = b.deviations <= 1.0
    agree = near & (b.signs > 0)
    for k in range(2, pair.n - 1):
        before = rigid[agree[:, :k].all(1)]
        behind = rigid[agree[:, k:].all(1)]
        if not len(before) or not len(behind):
            continue
        (reading,) = make_hypotheses(pair, before[:1])
        if reading.implicated.sum() > 1:
            tool = tool_behind(pair, behind.P[0])
            frames = int(frames_moved(pair, reading.base, tool))
            found.append(replace(reading, tool=tool, frames=frames, link=k))
    return found


def _other_links(pair: Sides, found: list[Hypothesis]) -> list[Hypothesis]:
    """The best readings of several moved axes, and that in which the tool stays, with another link in
    place of the last or the first axes.
    """
    several = [r for r in found if r.moved.sum() > 1]
    unlinked = sorted((r for r in several if not r.link), key=_cost)
    few = unlinked[:MOST_LINKED]
    few += make_hypotheses(pair, pair.tool_as_it_stands)
    in_front = [with_front_link(pair, reading) for reading in few]
    return with_link(pair, few) + [r for r in in_front if r is not None]


def _across_a_slide(pair: Sides, reading: Hypothesis) -> Hypothesis:
    """The reading, or the link that says the same as its one moved axis and the tool or base that
    moved with it, between which a slide shows no motion.
    """
    if not reading.frames or reading.moved.sum() != 1:
        return reading
    behind = with_link(pair, [reading])
    if behind:
        return behind[0]
    return with_front_link(pair, reading) or reading


def _conventions(pair: Sides) -> list[Hypothesis]:
    """Readings in which every zero offset is free: with no bad axis, with each one, and with those
    that then miss.
    """
    starts = _other_zeros(pair)
    fitted = _all_zeros_free(pair, starts)
    found = _simplest(pair, fitted)
    first = min(found, key=_cost)
    if not first.moved.any():
        return found
    two = best(pair, starts.joined(fitted), 2)
    tried = starts[:4].joined(two)
    suspects = ~pair.alike
    if pair.alike.all():
        suspects = pair.alike
    used = ~np.eye(pair.n, dtype=bool)[suspects]
    every_start = tried.tiled(len(used))
    found += _fitting(pair, every_start, used.repeat(len(tried), 0))
    for k in np.flatnonzero(suspects):
        held = replace(pair, suspect_joint=int(k))
        readings = _fitting(held, tried, np.arange(pair.n) != k)
        # Zero offsets about a's axis k say nothing of b's, unless that is another one.
        found += [r for r in readings if r.moved[k]]
    return found


def _fitting(pair: Sides, starts: Alignments, used: Marks) -> list[Hypothesis]:
    """Readings of starts fitted with their zero offsets free, of which the axes in `used` then agree."""
    trial = fit(pair, starts, _inner(pair), used)
    miss = pair.deviations(trial)
    lost = used & (miss > 1.0)
    return _simplest(pair, trial[~lost.any(1)])


def _inner(pair: Sides) -> Marks:
    """The joints (n,) whose zero offsets are no turn of the base or the tool."""
    k = np.arange(pair.n)
    return (k > 0) & (k < pair.n - 1)


def _other_zeros(pair: Sides) -> Alignments:
    """Alignments with zero offsets found joint after joint."""
    return one_by_one(pair)[:8]


def _all_zeros_free(pair: Sides, starts: Alignments) -> Alignments:
    """Starts fitted to all axes with their zero offsets free."""
    return fit(pair, starts, _inner(pair), True)


def _simplest(pair: Sides, at: Alignments) -> list[Hypothesis]:
    """The readings of alignments with as many zero offsets put back to 0, least first, as the
    agreeing axes allow.
    """
    z = wrapped(at.z, pair.b.revolute)
    at = Alignments(at.P.copy(), z)
    size = abs(z)
    agree = pair.deviations(at) <= 1.0
    kept = _Start(at, size > 0, agree)
    least_first = np.argsort(size, axis=1)
    for k in least_first.T[..., None]:
        free = np.take_along_axis(kept.free, k, 1)
        (row,) = np.nonzero(free[:, 0])
        trial = kept[row]
        np.put_along_axis(trial.free, k[row], False, 1)
        np.put_along_axis(trial.at.z, k[row], 0.0, 1)
        trial = replace(trial, at=trial.fitted(pair))
        miss = pair.deviations(trial.at)
        lost = (miss > 1.0) & trial.used
        fits = ~lost.any(1)
        kept[row[fits]] = trial[fits]
    return make_hypotheses(pair, kept.at)


def _others(first: Hypothesis, found: Iterable[Hypothesis]) -> list[Hypothesis]:
    """The readings beside the first that are as short and blame another joint, or it for something
    else; each once.
    """
    kept: list[Hypothesis] = []
    if first.implicated.sum() != 1:
        return kept
    seen = {first.changes.tobytes()}
    for reading in found:
        signature = reading.changes.tobytes()
        if reading.changes.sum() == 1 and signature not in seen:
            seen.add(signature)
            kept.append(reading)
    return kept
