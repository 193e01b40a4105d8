"""Comparison of two models of one arm, joint by joint."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...checks import positive, whole
from ...errors import quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ..axis_lines import POSITION, ROTATION, cross, direction, uncoupled_at_zero
from .alignment.hypotheses import Hypothesis, make_hypotheses
from .alignment.lines import lines, sides
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
        positive(tol_position, "tol_position"),
        positive(tol_rotation, "tol_rotation"),
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
    tol_position: float
    tol_rotation: float
    samples: int
    seed: int

    @property
    def tol(self) -> tuple[float, float]:
        """The tolerances of position (m) and rotation (rad)."""
        return self.tol_position, self.tol_rotation


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
    found = droppable(one, other, *asked.tol)
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
        abs(n_a - n_b),
        "more than two must",
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
    return make_hypotheses(pair, base[None], np.zeros((1, pair.n)))[0]


def _names(chain: Chain, ks: tuple[int, ...]) -> tuple[str, ...]:
    return tuple(chain.joint_names[k] for k in ks)


def _joints(
    a: Chain,
    b: Chain,
    reading: Hypothesis,
    tol_rotation: float,
    coupled: list[tuple[str, str, bool]],
) -> tuple[JointComparison, ...]:
    ours = lines(a)
    ways = direction(a.screws, a.kinds)
    their_ways = reading.directions[:, None] * direction(reading.axes, b.kinds)
    feet = cross(reading.axes[:, :3], reading.axes[:, 3:])
    gaps = feet - (ours.places + ours.centre)
    rows = []
    for i, (follows_a, follows_b, coupling_differs) in enumerate(coupled):
        placed = "prismatic" not in (a.kinds[i], b.kinds[i])
        gap = gaps[i] if placed else None
        angle, normal, shift = _apart(ways[i], their_ways[i], gap, tol_rotation)
        zero = float(reading.zeros[i])
        row = JointComparison(
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
            limits=_limits_apart(reading.directions[i] * (b.limits[i] - zero), a.limits[i]),
            axis_differs=bool(reading.moved[i]),
            zero_differs=bool(reading.offset[i]),
            follows_a=follows_a,
            follows_b=follows_b,
            coupling_differs=coupling_differs,
        )
        rows.append(row)
    return tuple(rows)


def _apart(
    w: Array,
    u: Array,
    gap: Array | None,
    tol_rotation: float,
) -> tuple[float, float | None, float | None]:
    """Angle (rad), common normal and distance at a place (m) of two axes, `gap` between their
    places; of axes without a place the angle alone.
    """
    across = cross(w, u)
    angle = math.atan2(float(np.linalg.norm(across)), float(w @ u))
    if gap is None:
        return angle, None, None
    shift = float(np.linalg.norm(gap - u * (u @ gap)))
    if angle <= tol_rotation:
        return angle, shift, shift
    return angle, abs(float(gap @ across)) / float(np.linalg.norm(across)), shift


def _limits_apart(theirs: Array, ours: Array) -> tuple[float, float]:
    """Lower and upper limit of b, in either order, less a's."""
    # Infinite less infinite is no difference.
    low, high = (
        0.0 if p == q else float(p - q) for p, q in zip(np.sort(theirs), ours, strict=True)
    )
    return low, high


def _pose_errors(ours: Array, theirs: Array) -> PoseErrors:
    apart = pose_differences(ours, theirs)
    return PoseErrors(*(float(x) for e in apart for x in (e.max(), e.mean())))


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
    found += differences(joints, *asked.tol, reading.link)
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
