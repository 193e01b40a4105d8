"""Comparison of two models of one arm, joint by joint."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...checks import positive, whole
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ..axis_lines import POSITION, ROTATION, uncoupled_at_zero
from .alignment.diagnosis import Diagnosis, diagnose
from .alignment.hypotheses import Hypothesis, as_they_stand
from .comparison import Comparison, PoseDifferences
from .differences.conventions import BUT_NAMES, Asked, Convention, checked, judged
from .differences.end_zeros import with_end_zeros
from .differences.findings import headline, make_findings
from .differences.joint_rows import joint_rows
from .differences.matching import Matched, matched
from .length_unit import length_ratio, to_one_unit
from .messages import ZERO_DEGREES, count_words, degree_words, equivalents, mirror_words, unit_words
from .mistakes.mirror import mirror_of, mirrored
from .mistakes.rpy_degrees import in_degrees, zeros_in_degrees
from .reached import near, pose_differences
from .unmatched_joints import MOST


def compare(
    a: Arm,
    b: Arm,
    *,
    same: Collection[Convention] = BUT_NAMES,
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
    neighbours. The diagnosis does so; the outcome does not: what was aligned counts, unless `same`
    leaves it out.

    Parameters
    ----------
    a, b : Chain or CompiledChain
        Models to compare.
    same : tuple of {"base", "tool", "zeros", "directions", "limits", "names"}, optional
        What may not differ, beside the axes: all but "names" where it is left out. What is not
        named is a free choice, on which the outcome does not depend.
    strict : bool, default False
        Show joints as they stand, not aligned; outcome and verdict are the same.
    tol_position : float, default 1e-5
        Distance up to which two axes, frames or zero positions are the same, m. The place of an
        axis is judged at the point of it nearest to the arm's middle.
    tol_rotation : float, default π/180000
        Angle up to which they are the same, rad (0.001 degrees).
    samples : int, default 200
        Number of random configurations, within a's limits, for the pose errors.
    seed : int, default 0
        Seed of the random configurations.

    Returns
    -------
    comparison : Comparison
        Outcome, verdict, joints, alignment and pose errors.

    Raises
    ------
    InputError
        If `a` or `b` is no Chain, `same` holds another word, a tolerance is no positive number,
        `samples` is below 1 or `seed` below 0.

    See Also
    --------
    axes : Relations of the axes of one arm.
    calibrate : The arm that measured poses belong to.

    Notes
    -----
    Of all alignments the one that implicates the fewest joints is taken, then the one that leaves
    base and tool where they are. Where fewer than half of the axes agree under any, as on a
    calibrated arm, or where the poses would be worse than as the models stand, base and tool are
    aligned to all axes by robust least squares if this halves the pose errors, and else not at
    all; `aligned_to` and the verdict say which. One joint's zero is offset beside that if it leaves
    a quarter of the errors or less. compare(a, b) and compare(b, a) implicate the same
    joints.

    Where all axes behind a joint moved together, the verdict names the link (`a` or `alpha` of a DH
    row). A zero offset of the first joint is a turned base, one of the last joint a turned tool;
    its limits tell them apart where they have moved by as much, else `alternatives` says so. With
    different numbers of joints, the one or two are named that can be dropped (each held at some
    position) so that the rest agree, or any number at the ends, as of a longer base. A joint that
    follows another joint otherwise in the other model differs, however well the axes agree.

    Mistakes in a whole file are named in `mistake`: millimetres that were read as metres and
    left-handed coordinates, which are put right before joints are compared, and degrees in rpy.

    Accuracy: one tilted or shifted axis, zero offset or flip is named and sized within 1 %
    (tests/analysis). Where all joints differ by much, the alignment is a local optimum.
    Source: the geometry of lines; P. W. Holland and R. E. Welsch, "Robust regression using
    iteratively reweighted least-squares", Comm. Statist. A6 (1977), for the weights.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("panda").chain(tip="panda_hand")
    >>> lifted = arm.screws.copy()
    >>> lifted[3] = pk.se3.adjoint(pk.se3.exp([0, 0, 0, 0, 0, 0.003])) @ lifted[3]
    >>> result = pk.compare(arm, arm.replace(screws=lifted))
    >>> result.findings[0]
    "joint 4 ('panda_joint4') has an axis that is 3 mm from the other model's: 6 mm at the tool"
    >>> round(result.joints[3].shift, 6)
    0.003
    >>> pk.compare(arm, arm.rebased(pk.se3.exp([0, 0, 1, 0, 0, 0]))).outcome
    'conventions'
    """
    a = chain_of(a, "a")
    b = chain_of(b, "b")
    asked = Asked(
        checked(same),
        strict,
        positive(tol_position, "tol_position"),
        positive(tol_rotation, "tol_rotation"),
        whole(samples, "samples", 1),
        whole(seed, "seed", 0),
    )
    rescaled = _in_one_unit(a, b, asked)
    if rescaled is not None and rescaled.simple:
        # No comparison in two units, in which nothing agrees and which takes long, says more.
        return replace(rescaled.result, before=_before(matched(a, b, asked)))
    found = _compared(a, b, asked)
    if found.simple:
        return found.result
    if rescaled is not None:
        # Other arms of unlike size agree in an axis or two by chance.
        most = min(found.moved - 1, len(rescaled.result.joints) / 3)
        if rescaled.moved <= most:
            return replace(rescaled.result, before=found.result.before)
    axis = None
    if len(a.screws) == len(b.screws):
        one = uncoupled_at_zero(a)
        other = uncoupled_at_zero(b)
        axis = mirror_of(one, other, asked.tol, moved=bool(found.moved))
    if axis is not None:
        said = _Mistake("mirrored", mirror_words(axis))
        result = _compared(a, mirrored(b, axis), asked, said).result
        return replace(result, before=found.result.before)
    return found.result


class _Mistake(NamedTuple):
    """A mistake in a whole file that has been put right: its name, and the sentence on it."""

    name: str = ""
    words: str = ""
    length_ratio: float = 1.0


class _Compared(NamedTuple):
    """A comparison, how many axes or links differ, and whether it needs no other explanation."""

    result: Comparison
    moved: int
    simple: bool


RIGHT = _Mistake()


def _in_one_unit(
    a: Chain,
    b: Chain,
    asked: Asked,
) -> _Compared | None:
    """The comparison with both models in one unit of length; None where they seem to be in one."""
    ratio = length_ratio(a, b)
    if ratio == 1:
        return None
    mistake = _Mistake("millimetres", unit_words(ratio), ratio)
    return _compared(*to_one_unit(a, b, ratio), asked, mistake)


def _unmatched(a: Chain, b: Chain, asked: Asked) -> _Compared:
    """The comparison of chains whose numbers of joints differ, none of which can be dropped."""
    n_a = len(a.screws)
    n_b = len(b.screws)
    more = abs(n_a - n_b)
    which = count_words(more)
    if more > MOST:
        which += " at the ends"
    end = f"no {which} can be dropped so that the rest agree"
    verdict = f"the models differ: {n_a} joints against {n_b}, and {end}"
    b = uncoupled_at_zero(b)
    result = _comparison(asked, outcome="differ", verdict=verdict, a=a, b=b)
    return _Compared(result, max(n_a, n_b), False)


def _comparison(asked: Asked, **found: Any) -> Comparison:
    return Comparison(**found, **asked._asdict())


def _compared(
    a: Chain,
    b: Chain,
    asked: Asked,
    mistake: _Mistake = RIGHT,
) -> _Compared:
    """The comparison of two chains of which a mistake has been put right."""
    pair = matched(a, b, asked)
    if pair is None:
        return _unmatched(a, b, asked)
    found = _diagnosis(pair, asked)
    reading = found.reading
    joints = tuple(joint_rows(pair, reading, asked.tol))
    alike = pair.extra is None and not mistake.name
    judgement = judged(joints, reading, alike, asked.same, asked.tol)
    poses = pair.a.fk(pair.x)
    if not mistake.name:
        mistake = _degrees(pair, reading)
    findings = make_findings(pair, joints, found, poses, asked, mistake.words)
    first = headline(judgement.outcome, bool(findings))
    result = _comparison(
        asked,
        outcome=judgement.outcome,
        verdict="; ".join([first, *findings]),
        findings=findings,
        same_arm=judgement.same_arm,
        joints=joints,
        base=reading.base,
        before=_before(pair),
        alternatives=tuple(
            equivalents(pair.a, pair.b, pair.numbers, reading, found.others, asked.tol)
        ),
        unmatched_joints=pair.extra,
        aligned_to=found.aligned_to,
        mistake=mistake.name,
        length_ratio=mistake.length_ratio,
        a=a,
        b=pair.b,
    )
    if asked.strict:
        stand = as_they_stand(pair.a, pair.b, asked.tol)
        result = replace(
            result,
            joints=tuple(joint_rows(pair, stand, asked.tol)),
            base=stand.base,
            aligned_to="nothing",
        )
    else:
        after = _pose_errors(poses, reading.poses(pair.b, pair.x))
        result = replace(result, tool=reading.tool, after=after)
    moved = int(reading.beside_link.sum()) + bool(reading.link)
    simple = not moved and int(reading.changes.sum()) < 2
    if mistake.length_ratio != 1:
        simple = not moved or near(pair.a, pair.b, reading)
    return _Compared(result, moved, simple)


def _diagnosis(pair: Matched, asked: Asked) -> Diagnosis:
    found = diagnose(pair.a, pair.b, asked.tol, pair.both)
    reading = with_end_zeros(pair, found.reading, asked.tol)
    found = found._replace(reading=reading)
    if asked.strict and not (reading.implicated.any() or reading.frames):
        # Within tolerance once aligned, which is not within tolerance as they stand.
        stand = as_they_stand(pair.a, pair.b, asked.tol)
        return found._replace(reading=stand)
    return found


def _degrees(pair: Matched, reading: Hypothesis) -> _Mistake:
    """The mistake of degrees for radians, which is said only."""
    if reading.moved.any():
        model = in_degrees(pair.a, pair.b)
        if model:
            return _Mistake("degrees", degree_words(model))
    revolute = np.array([kind == "revolute" for kind in pair.a.kinds], bool)
    if zeros_in_degrees(reading, revolute):
        return _Mistake("degrees", ZERO_DEGREES)
    return RIGHT


def _before(pair: Matched | None) -> PoseDifferences | None:
    """Pose errors at the same coordinates, as the models stand."""
    if pair is None:
        return None
    return _pose_errors(pair.a.fk(pair.x), pair.b.fk(pair.y))


def _pose_errors(ours: Array, theirs: Array) -> PoseDifferences:
    distance, angle = pose_differences(ours, theirs)
    return PoseDifferences(
        float(distance.max()),
        float(distance.mean()),
        float(angle.max()),
        float(angle.mean()),
    )
