"""compare: where two models of one arm differ, joint by joint."""

from __future__ import annotations

import math
from dataclasses import replace

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
    a: Chain, b: Chain, *, strict: bool = False, tol_mm: float = 0.01, tol_deg: float = 0.001,
    samples: int = 200, seed: int = 0,
) -> Comparison:  # fmt: skip
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
    options = strict, float(tol_mm), float(tol_deg), int(samples), seed
    result, moved = _compared(a, b, 1.0, *options)
    ratio = length_ratio(a, b) if moved else 1.0
    if ratio != 1:
        in_one_unit, left = _compared(*to_one_unit(a, b, ratio), ratio, *options)
        # Other arms of unlike size agree in an axis or two by chance.
        if left < moved and 3 * left <= len(in_one_unit.joints):
            return replace(in_one_unit, before=result.before)
    return result


def _compared(
    a: Chain,
    b: Chain,
    ratio: float,
    strict: bool,
    tol_mm: float,
    tol_deg: float,
    samples: int,
    seed: int,
) -> tuple[Comparison, int]:
    """The comparison of two chains in one length unit, and how many axes or links differ; `ratio`
    is to be told.
    """
    tol_m = tol_mm / 1e3
    tol_rad = math.radians(tol_deg)
    one = uncoupled_at_zero(a)
    other = uncoupled_at_zero(b)
    x = a.random(seed, samples) @ a.coupling.T
    extra = None
    dropped = ()
    if len(one.screws) != len(other.screws):
        found = droppable(one, other, tol_mm, tol_deg)
        if found is None:
            counts = len(one.screws), len(other.screws)
            told_apart = f"{counts[0]} joints against {counts[1]}"
            which = {1: "no one joint can", 2: "no two joints can"}.get(
                abs(counts[0] - counts[1]), "more than two must"
            )
            end = f"{which} be dropped so that the rest agree"
            return Comparison(
                False, f"the models differ: {told_apart}, and {end}", (), None, None, None, None, (), None, strict,
                tol_mm, tol_deg, samples, seed,
            ), max(counts)  # fmt: skip
        ks, held = found
        if len(one.screws) > len(other.screws):
            extra = ("a", *_names(one, ks))
            one = without(one, ks, held)
            x = np.delete(x, ks, axis=1)
        else:
            extra = ("b", *_names(other, ks))
            other = without(other, ks, held)
        dropped = ks
    if strict:
        reading = _as_it_is(one, other, tol_m, tol_rad)
        others = []
    else:
        reading, others = search(one, other, tol_m, tol_rad)
    C_a, C_b = (
        np.delete(c.coupling, dropped, axis=0) if extra and extra[0] == which else c.coupling
        for which, c in (("a", a), ("b", b))
    )
    joints = _joints(
        one, other, reading, tol_rad, follows(C_a, C_b, one, other, reading, tol_m, tol_rad)
    )
    same = (
        not reading.moved.any()
        and not any(joint.coupling_differs for joint in joints)
        and (not strict or not (reading.implicated.any() or reading.frames))
    )
    return Comparison(
        equal=same and extra is None and ratio == 1,
        verdict=_verdict(same, joints, reading, extra, ratio, strict, tol_mm, tol_deg),
        joints=joints,
        base=reading.base,
        tool=None if strict else reading.tool,
        before=_pose_errors(one.fk(x), other.fk(x)),
        after=None if strict else _pose_errors(
            one.fk(x), reading.base @ other.fk(reading.directions * x + reading.zeros) @ reading.tool
        ),
        alternatives=tuple(() if strict else equivalents(one, other, reading, others, tol_m, tol_rad)),
        unmatched_joints=extra,
        strict=strict, tol_mm=tol_mm, tol_deg=tol_deg, samples=samples, seed=seed, length_ratio=ratio,
    ), 1 if reading.link else int(reading.moved.sum())  # fmt: skip


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
        w = ours[i]
        u = s * theirs[i]
        across = cross(w, u)
        angle = math.atan2(float(np.linalg.norm(across)), float(w @ u))
        normal = shift = None
        if "prismatic" not in (a.kinds[i], b.kinds[i]):
            place = pair.a.places[i] + pair.a.centre
            foot = cross(reading.axes[i, :3], reading.axes[i, 3:])
            gap = foot - place
            shift = 1e3 * float(np.linalg.norm(gap - u * (u @ gap)))
            normal = (
                shift
                if angle <= tol_rad
                else 1e3 * abs(float(gap @ across)) / float(np.linalg.norm(across))
            )
        scale = 1e3 if b.kinds[i] == "prismatic" else 180 / math.pi
        zero = float(reading.zeros[i])
        mapped = np.sort(s * (b.limits[i] - zero))
        # Infinite less infinite is no difference.
        limits = [
            0.0 if p == q else float(scale * (p - q))
            for p, q in zip(mapped, a.limits[i], strict=True)
        ]
        rows.append(JointComparison(
            i + 1, a.joint_names[i], b.joint_names[i], a.kinds[i], b.kinds[i], math.degrees(angle), normal, shift,
            scale * zero, s < 0, (limits[0], limits[1]), bool(reading.moved[i]), bool(reading.offset[i]),
            *coupled[i],
        ))  # fmt: skip
    return tuple(rows)


def _pose_errors(ours: Array, theirs: Array) -> PoseErrors:
    mm = 1e3 * np.linalg.norm(ours[:, :3, 3] - theirs[:, :3, 3], axis=1)
    deg = np.degrees(
        np.linalg.norm(so3.log(np.swapaxes(ours[:, :3, :3], 1, 2) @ theirs[:, :3, :3]), axis=1)
    )
    return PoseErrors(float(mm.max()), float(mm.mean()), float(deg.max()), float(deg.mean()))


def _verdict(
    same: bool, joints: tuple[JointComparison, ...], reading: Hypothesis, extra: tuple[str, ...] | None, ratio: float,
    strict: bool, tol_mm: float, tol_deg: float,
) -> str:  # fmt: skip
    tol = tol_mm / 1e3, math.radians(tol_deg)
    found = differences(joints, tol_mm, tol_deg, reading.link)
    tool = frame_words("home pose's" if strict else "tool", reading.tool, *tol)
    if extra is not None:
        model, *names = extra
        count = "one joint" if len(names) == 1 else "two joints"
        found.insert(0, f"model {model} has {count} more, {' and '.join(map(quote, names))}")
    same = same and extra is None and ratio == 1
    if ratio != 1:
        found.insert(0, unit_words(ratio))
    if strict:
        return "; ".join(["the models are the same as they stand" if same else "the models differ",
                          *found, *([tool] if tool else [])])  # fmt: skip
    aligned = [words for words in (frame_words("base", reading.base, *tol), tool) if words]
    if not same:
        head = "the models differ"
    elif found or aligned:
        head = "the models are the same arm, up to free choices"
    else:
        head = "the models are the same"
    return "; ".join([head, *found, *([f"aligned: {' and '.join(aligned)}"] if aligned else [])])
