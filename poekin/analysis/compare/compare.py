"""Comparison of two models of one arm, joint by joint."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...checks import positive, whole
from ...errors import quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ..axis_lines import (
    POSITION,
    ROTATION,
    Tolerances,
    direction,
    distance_to_line,
    normal_length,
    place,
    prismatic,
    sine,
    uncoupled_at_zero,
)
from .alignment.hypotheses import Hypothesis, as_they_stand
from .alignment.lines import lines
from .alignment.search import search
from .comparison import Comparison, JointComparison, PoseErrors
from .followers import follows
from .length_unit import length_ratio, to_one_unit
from .messages import differences, equivalents, frame_words, unit_words
from .reached import pose_differences
from .unmatched_joints import droppable, without

__all__ = ["compare"]


def compare(
    a: Arm,
    b: Arm,
    *,
    strict: bool = False,
    tol_position: float = POSITION,
    tol_rotation: float = ROTATION,
    samples: int = 200,
    seed: int = 0,
) -> Comparison:
    """Comparison of two models of one arm: which joint differs, and by how much.

    Screws are lines in space, so nothing depends on where link frames stand. Joints are matched in
    order. What is a free choice (base frame, tool frame, zero positions, joint directions) is
    aligned to the largest set of joints that agree, so that one wrong joint is not smeared over its
    neighbours.

    Parameters
    ----------
    a, b : Chain or CompiledChain
        Models to compare.
    strict : bool, default False
        Align nothing: frames, zero positions and directions count as differences.
    tol_position : float, default 1e-5
        Distance up to which two axes, frames or zero positions are the same, m. The place of an
        axis is judged at the point of it nearest to the arm's middle.
    tol_rotation : float, default 1.75e-5
        Angle up to which they are the same, rad (0.001 degrees).
    samples : int, default 200
        Number of random configurations, within a's limits, for the pose errors.
    seed : int, default 0
        Seed of the random configurations.

    Returns
    -------
    comparison : Comparison
        Verdict, joints, alignment and pose errors.

    Raises
    ------
    InputError
        If `a` or `b` is no Chain, a tolerance no positive number, or `samples` below 1.

    See Also
    --------
    axes : Relations of the axes of one arm.
    calibrate : The arm that measured poses belong to.

    Notes
    -----
    Of all alignments the one that implicates the fewest joints is taken, then the one that leaves
    base and tool where they are. Where all axes behind a joint moved together, the verdict names
    the link (`a` or `alpha` of a DH row). A zero offset of the first joint is a turned base, one of
    the last joint a turned tool; `alternatives` says so. With different numbers of joints, the one
    or two are named that can be dropped (each held at some position) so that the rest agree. A
    joint that follows another joint otherwise in the other model differs, however well the axes
    agree. Where one model is in millimetres that were read as metres, the joints are compared in
    one unit, and the verdict says so.

    Accuracy: one tilted or shifted axis, zero offset or flip is named and sized within 1 %
    (tests/analysis). Where all joints differ by much, the alignment is a local optimum.
    Source: none, the geometry of lines.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("panda").chain(tip="panda_hand")
    >>> lifted = arm.screws.copy()
    >>> lifted[3] = pk.se3.adjoint(pk.se3.exp([0, 0, 0, 0, 0, 0.003])) @ lifted[3]
    >>> other = pk.Chain.from_space(lifted, arm.home, joint_names=arm.joint_names)
    >>> result = pk.compare(arm, other)
    >>> result.verdict
    "the models differ; joint 4 ('panda_joint4') has an axis that is 3 mm from the other model's"
    >>> round(result.joints[3].shift, 6)
    0.003
    """
    a = chain_of(a, "a")
    b = chain_of(b, "b")
    asked = _Asked(
        strict,
        Tolerances(
            positive(tol_position, "tol_position"),
            positive(tol_rotation, "tol_rotation"),
        ),
        whole(samples, "samples", 1),
        seed,
    )
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
    tol: Tolerances
    samples: int
    seed: int


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
    pair = _Matched(one, other, a.coupling, b.coupling, x)
    if len(one.screws) == len(other.screws):
        return pair
    found = droppable(one, other, asked.tol)
    if found is None:
        return None
    ks, held = found
    if len(one.screws) < len(other.screws):
        return pair._replace(
            b=without(other, ks, held),
            C_b=np.delete(b.coupling, ks, axis=0),
            extra=("b", *_names(other, ks)),
        )
    return pair._replace(
        a=without(one, ks, held),
        C_a=np.delete(a.coupling, ks, axis=0),
        x=np.delete(x, ks, axis=1),
        extra=("a", *_names(one, ks)),
    )


def _names(
    chain: Chain,
    ks: tuple[int, ...],
) -> tuple[str, ...]:
    return tuple(chain.joint_names[k] for k in ks)


def _unmatched(n_a: int, n_b: int, asked: _Asked) -> Comparison:
    """The comparison of chains whose numbers of joints differ, none of which can be dropped."""
    which = {1: "no one joint can", 2: "no two joints can"}.get(
        abs(n_a - n_b),
        "more than two must",
    )
    end = f"{which} be dropped so that the rest agree"
    verdict = f"the models differ: {n_a} joints against {n_b}, and {end}"
    return _comparison(asked, equal=False, verdict=verdict)


def _comparison(asked: _Asked, **found: Any) -> Comparison:
    return Comparison(
        **found,
        strict=asked.strict,
        tol_position=asked.tol.position,
        tol_rotation=asked.tol.rotation,
        samples=asked.samples,
        seed=asked.seed,
    )


def _compared(
    a: Chain,
    b: Chain,
    ratio: float,
    asked: _Asked,
) -> tuple[Comparison, int]:
    """The comparison of two chains in one length unit, and how many axes or links differ; `ratio`
    is to be told.
    """
    pair = _matched(a, b, asked)
    if pair is None:
        counts = len(a.screws), len(b.screws)
        return _unmatched(*counts, asked), max(counts)
    others: list[Hypothesis] = []
    if asked.strict:
        reading = as_they_stand(pair.a, pair.b, asked.tol)
    else:
        reading, others = search(pair.a, pair.b, asked.tol)
    joints = tuple(_joints(pair, reading, asked.tol))
    moved = int(reading.moved.sum())
    same = pair.extra is None and ratio == 1 and not moved
    same = same and not any(joint.coupling_differs for joint in joints)
    if asked.strict:
        same = same and not (reading.implicated.any() or reading.frames)
    poses = pair.a.fk(pair.x)
    result = _comparison(
        asked,
        equal=same,
        verdict=_verdict(same, joints, reading, pair.extra, ratio, asked),
        joints=joints,
        base=reading.base,
        before=_pose_errors(poses, pair.b.fk(pair.x)),
        unmatched_joints=pair.extra,
        length_ratio=ratio,
    )
    if not asked.strict:
        result = replace(
            result,
            tool=reading.tool,
            after=_pose_errors(poses, reading.poses(pair.b, pair.x)),
            alternatives=tuple(equivalents(pair.a, pair.b, reading, others, asked.tol)),
        )
    return result, 1 if reading.link else moved


def _joints(pair: _Matched, reading: Hypothesis, tol: Tolerances) -> Iterator[JointComparison]:
    a = pair.a
    b = pair.b
    ours = lines(a)
    slides = prismatic(b)
    their_ways = reading.directions[:, None] * direction(reading.axes, slides)
    gaps = place(reading.axes) - (ours.places + ours.centre)
    coupled = follows(pair.C_a, pair.C_b, a, b, reading, tol)
    for i, following in enumerate(coupled):
        gap = gaps[i]
        if ours.slides[i] or slides[i]:
            gap = None
        angle, normal, shift = _apart(ours.ways[i], their_ways[i], gap, tol)
        zero = float(reading.zeros[i])
        limits = reading.directions[i] * (b.limits[i] - zero)
        yield JointComparison(
            number=i + 1,
            name_a=a.joint_names[i],
            name_b=b.joint_names[i],
            kind_a=a.kinds[i],
            kind_b=b.kinds[i],
            angle=angle,
            normal=normal,
            shift=shift,
            zero_offset=zero,
            reversed=bool(reading.directions[i] < 0),
            limits=_limits_apart(limits, a.limits[i]),
            axis_differs=bool(reading.moved[i]),
            zero_differs=bool(reading.offset[i]),
            **following._asdict(),
        )


def _apart(
    w: Array,
    u: Array,
    gap: Array | None,
    tol: Tolerances,
) -> tuple[float, float | None, float | None]:
    """Angle (rad), common normal and distance at a place (m) of two axes, `gap` between their
    places; of axes without a place the angle alone.
    """
    angle = math.atan2(sine(w, u), float(w @ u))
    if gap is None:
        return angle, None, None
    shift = distance_to_line(gap, u)
    if angle <= tol.rotation:
        return angle, shift, shift
    return angle, normal_length(w, u, gap), shift


def _limits_apart(theirs: Array, ours: Array) -> tuple[float, float]:
    """Lower and upper limit of b, in either order, less a's."""
    pairs = zip(np.sort(theirs), ours, strict=True)
    # Infinite less infinite is no difference.
    low, high = (0.0 if p == q else float(p - q) for p, q in pairs)
    return low, high


def _pose_errors(ours: Array, theirs: Array) -> PoseErrors:
    distance, angle = pose_differences(ours, theirs)
    return PoseErrors(
        float(distance.max()),
        float(distance.mean()),
        float(angle.max()),
        float(angle.mean()),
    )


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
    found += differences(joints, asked.tol, reading.link)
    equal = "the models are the same"
    if asked.strict:
        found.append(frame_words("home pose's", reading.tool, asked.tol))
        equal = "the models are the same as they stand"
    else:
        frames = {"base": reading.base, "tool": reading.tool}
        moved = (frame_words(name, T, asked.tol) for name, T in frames.items())
        aligned = " and ".join(filter(None, moved))
        if found or aligned:
            equal = "the models are the same arm, up to free choices"
        if aligned:
            found.append(f"aligned: {aligned}")
    head = "the models differ"
    if same:
        head = equal
    return "; ".join(filter(None, [head, *found]))
