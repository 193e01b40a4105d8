"""Comparison of two models of one arm, joint by joint."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...errors import InputError, quote, safe_repr
from ...groups import so3
from ...groups.arrays import Array
from ...model.chain import Chain
from ..tolerances import check_tolerances
from .alignment.hypotheses import Hypothesis, read
from .alignment.lines import cross, direction, sides, uncoupled_at_zero
from .alignment.search import search
from .comparison import Comparison, JointComparison, PoseErrors
from .followers import follows
from .length_unit import length_ratio, to_one_unit
from .messages import differences, equivalents, frame_words, unit_words
from .unmatched_joints import droppable, without

__all__ = ["compare"]


def compare(
    a: Chain,
    b: Chain,
    *,
    strict: bool = False,
    tol_mm: float = 0.01,
    tol_deg: float = 0.001,
    samples: int = 200,
    seed: int = 0,
) -> Comparison:
    """Two models of one arm: which joint differs, by how many millimetres and degrees.

    Screws are lines in space, so nothing depends on where link frames stand. Joints are matched in
    order. What is a free choice (base frame, tool frame, zero positions, joint directions) is
    aligned to the largest set of joints that agree: of all readings the one that blames the fewest
    joints, then the one that leaves base and tool where they are. One bad joint is so not smeared
    over its neighbours. Where all axes behind a joint moved together, the verdict names the link
    (`a` or `alpha` of a DH row); the rows of `joints` then say it of each of these axes. A zero
    offset of the first joint is a turned base and one of the last joint a turned tool; `equivalent`
    says so. With different numbers of joints the one or two are named that can be dropped (each
    held at some position) so that the rest agree. A joint that follows another one otherwise in the
    other model, or there on its own, differs, however well the axes agree. Where one model is in
    millimetres that were read as metres, the verdict says so and the joints are compared in one
    unit.

    Parameters: a, b; strict, align nothing, frames and zero positions included; tol_mm, tol_deg,
    how near is the same (an axis' place is judged at the point of it nearest to the arm's middle);
    samples and seed, random configurations within a's limits for the pose errors.
    Returns: Comparison. Raises: InputError.
    Accuracy: one tilted or shifted axis, zero offset or flip is named and sized within 1 %
    (tests/analysis). Where all joints differ by much the reading is a local one. Source: none, the
    lines' geometry.
    """
    for what, value in (("a", a), ("b", b)):
        if not isinstance(value, Chain):
            raise InputError(
                f"{what}: expected a Chain, as Robot.chain(tip=...) makes it, got {safe_repr(value)}"
            )
    check_tolerances(tol_mm, tol_deg)
    if isinstance(samples, bool) or not isinstance(samples, (int, np.integer)) or samples < 1:
        raise InputError(
            f"samples: a number of configurations of at least 1 expected, got {safe_repr(samples)}"
        )
    asked = _Asked(strict, float(tol_mm), float(tol_deg), int(samples), seed)
    result, moved = _compared(a, b, 1.0, asked)
    if not moved:
        return result
    ratio = length_ratio(a, b)
    if ratio != 1:
        in_one_unit, left = _compared(*to_one_unit(a, b, ratio), ratio, asked)
        # Other arms of unlike size agree in an axis or two by chance.
        if left < moved and 3 * left <= len(in_one_unit.joints):
            return replace(in_one_unit, before=result.before)
    return result


class _Asked(NamedTuple):
    """Tolerances and samples of a comparison, and whether it is strict, as the caller gave them."""

    strict: bool
    tol_mm: float
    tol_deg: float
    samples: int
    seed: int

    @property
    def tol(self) -> tuple[float, float]:
        """The tolerances in m and rad."""
        return self.tol_mm / 1e3, math.radians(self.tol_deg)


class _Matched(NamedTuple):
    """Two chains at rest with equal numbers of joints, the couplings of these, and values x
    (samples, n) of a's; extra, as `Comparison.unmatched_joints`.
    """

    a: Chain
    b: Chain
    C_a: Array
    C_b: Array
    x: Array
    extra: tuple[str, ...] | None = None


def _matched(a: Chain, b: Chain, asked: _Asked) -> _Matched | None:
    """Both chains at rest, the longer one without the joints that can be dropped; None where none
    can.
    """
    one = uncoupled_at_zero(a)
    other = uncoupled_at_zero(b)
    x = a.random(asked.seed, asked.samples) @ a.coupling.T
    if len(one.screws) == len(other.screws):
        return _Matched(one, other, a.coupling, b.coupling, x)
    found = droppable(one, other, asked.tol_mm, asked.tol_deg)
    if found is None:
        return None
    ks, held = found
    if len(one.screws) > len(other.screws):
        extra = ("a", *_names(one, ks))
        left = np.delete(a.coupling, ks, axis=0)
        shorter = without(one, ks, held)
        return _Matched(shorter, other, left, b.coupling, np.delete(x, ks, axis=1), extra)
    extra = ("b", *_names(other, ks))
    left = np.delete(b.coupling, ks, axis=0)
    return _Matched(one, without(other, ks, held), a.coupling, left, x, extra)


def _unmatched(n_a: int, n_b: int, asked: _Asked) -> Comparison:
    """The comparison of chains whose numbers of joints differ, none of which can be dropped."""
    which = {1: "no one joint can", 2: "no two joints can"}.get(
        abs(n_a - n_b), "more than two must"
    )
    end = f"{which} be dropped so that the rest agree"
    verdict = f"the models differ: {n_a} joints against {n_b}, and {end}"
    return Comparison(False, verdict, (), None, None, None, None, (), None, *asked)


def _compared(a: Chain, b: Chain, ratio: float, asked: _Asked) -> tuple[Comparison, int]:
    """The comparison of two chains in one length unit, and how many axes or links differ; `ratio`
    is to be told.
    """
    pair = _matched(a, b, asked)
    if pair is None:
        counts = len(a.screws), len(b.screws)
        return _unmatched(*counts, asked), max(counts)
    one, other, C_a, C_b, x, extra = pair
    others: list[Hypothesis] = []
    if asked.strict:
        reading = _as_it_is(one, other, *asked.tol)
    else:
        reading, others = search(one, other, *asked.tol)
    coupled = follows(C_a, C_b, one, other, reading, *asked.tol)
    joints = _joints(one, other, reading, asked.tol[1], coupled)
    same = (
        extra is None
        and ratio == 1
        and not reading.moved.any()
        and not any(joint.coupling_differs for joint in joints)
        and (not asked.strict or not (reading.implicated.any() or reading.frames))
    )
    result = Comparison(
        same,
        _verdict(same, joints, reading, extra, ratio, asked),
        joints,
        reading.base,
        None,
        _pose_errors(one.fk(x), other.fk(x)),
        None,
        (),
        extra,
        *asked,
        ratio,
    )
    if not asked.strict:
        aligned = other.fk(reading.directions * x + reading.zeros)
        after = _pose_errors(one.fk(x), reading.base @ aligned @ reading.tool)
        said = tuple(equivalents(one, other, reading, others, *asked.tol))
        result = replace(result, tool=reading.tool, after=after, alternatives=said)
    if reading.link:
        return result, 1
    return result, int(reading.moved.sum())


def _as_it_is(a: Chain, b: Chain, tol_m: float, tol_rad: float) -> Hypothesis:
    pair = sides(a, b, tol_m, tol_rad)
    base = np.eye(4)
    base[:3, 3] = pair.b.centre - pair.a.centre
    return read(pair, a, b, base[None], np.zeros((1, pair.n)))[0]


def _names(chain: Chain, ks: tuple[int, ...]) -> tuple[str, ...]:
    return tuple(chain.joint_names[k] for k in ks)


def _joints(
    a: Chain, b: Chain, reading: Hypothesis, tol_rad: float, coupled: list[tuple[str, str, bool]]
) -> tuple[JointComparison, ...]:
    pair = sides(a, b, 1.0, tol_rad)
    ours = direction(a.screws, a.kinds)
    theirs = direction(reading.axes, b.kinds)
    rows = []
    for i in range(pair.n):
        s = float(reading.directions[i])
        across = cross(ours[i], s * theirs[i])
        angle = math.atan2(float(np.linalg.norm(across)), float(ours[i] @ (s * theirs[i])))
        normal = None
        shift = None
        if "prismatic" not in (a.kinds[i], b.kinds[i]):
            foot = cross(reading.axes[i, :3], reading.axes[i, 3:])
            gap = foot - (pair.a.places[i] + pair.a.centre)
            shift = _distance(gap, s * theirs[i])
            normal = shift
            if angle > tol_rad:
                normal = 1e3 * abs(float(gap @ across)) / float(np.linalg.norm(across))
        scale = 1e3 if b.kinds[i] == "prismatic" else 180 / math.pi
        zero = float(reading.zeros[i])
        follows_a, follows_b, coupling_differs = coupled[i]
        row = JointComparison(
            number=i + 1,
            name_a=a.joint_names[i],
            name_b=b.joint_names[i],
            kind_a=a.kinds[i],
            kind_b=b.kinds[i],
            angle=math.degrees(angle),
            normal=normal,
            shift=shift,
            zero_offset=scale * zero,
            reversed=s < 0,
            limits=_limits_apart(s * (b.limits[i] - zero), a.limits[i], scale),
            axis_differs=bool(reading.moved[i]),
            zero_differs=bool(reading.offset[i]),
            follows_a=follows_a,
            follows_b=follows_b,
            coupling_differs=coupling_differs,
        )
        rows.append(row)
    return tuple(rows)


def _limits_apart(theirs: Array, ours: Array, scale: float) -> tuple[float, float]:
    """Lower and upper limit of b, in either order, less a's, times `scale`."""
    # Infinite less infinite is no difference.
    low, high = (
        0.0 if p == q else float(scale * (p - q))
        for p, q in zip(np.sort(theirs), ours, strict=True)
    )
    return low, high


def _distance(gap: Array, u: Array) -> float:
    """Distance (mm) of a point from a line along u, `gap` (m) away at some point of it."""
    return 1e3 * float(np.linalg.norm(gap - u * (u @ gap)))


def _pose_errors(ours: Array, theirs: Array) -> PoseErrors:
    mm = 1e3 * np.linalg.norm(ours[:, :3, 3] - theirs[:, :3, 3], axis=1)
    deg = np.degrees(
        np.linalg.norm(so3.log(np.swapaxes(ours[:, :3, :3], 1, 2) @ theirs[:, :3, :3]), axis=1)
    )
    return PoseErrors(float(mm.max()), float(mm.mean()), float(deg.max()), float(deg.mean()))


def _verdict(
    same: bool,
    joints: tuple[JointComparison, ...],
    reading: Hypothesis,
    extra: tuple[str, ...] | None,
    ratio: float,
    asked: _Asked,
) -> str:
    found = []
    if ratio != 1:
        found.append(unit_words(ratio))
    if extra is not None:
        model, *names = extra
        count = "one joint" if len(names) == 1 else "two joints"
        found.append(f"model {model} has {count} more, {' and '.join(map(quote, names))}")
    found += differences(joints, asked.tol_mm, asked.tol_deg, reading.link)
    if asked.strict:
        found.append(frame_words("home pose's", reading.tool, *asked.tol))
        head = "the models differ"
        if same:
            head = "the models are the same as they stand"
        return "; ".join(words for words in (head, *found) if words)
    frames = [
        frame_words("base", reading.base, *asked.tol),
        frame_words("tool", reading.tool, *asked.tol),
    ]
    aligned = " and ".join(words for words in frames if words)
    if not same:
        head = "the models differ"
    elif found or aligned:
        head = "the models are the same arm, up to free choices"
    else:
        head = "the models are the same"
    if aligned:
        found.append(f"aligned: {aligned}")
    return "; ".join([head, *found])
