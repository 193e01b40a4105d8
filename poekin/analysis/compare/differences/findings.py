"""Clauses of a verdict: mistakes, joints and frames that differ."""

from __future__ import annotations

import numpy as np

from ....errors import quote
from ....groups.arrays import Array
from ..alignment.diagnosis import Diagnosis
from ..comparison import JointComparison, Outcome
from ..messages import Said, alignment_words, count_words, frame_words, joint_findings
from .conventions import Asked, limits_differ
from .effects import base_effect
from .matching import Matched

NOT_ALIGNED = "left as they stand, as no alignment of base and tool halves the pose errors"


def headline(outcome: Outcome, found: bool) -> str:
    """The outcome as the first clause of a verdict; `found`, whether others follow."""
    if outcome == "differ":
        return "the models differ"
    if outcome == "conventions":
        return "the models are the same arm in other conventions"
    if found:
        return "the models are the same but for what may differ"
    return "the models are the same"


def make_findings(
    pair: Matched,
    joints: tuple[JointComparison, ...],
    found: Diagnosis,
    poses: Array,
    asked: Asked,
    mistake: str,
) -> tuple[str, ...]:
    """Clauses of the verdict, one for each mistake, joint and frame; poses (m, 4, 4), those of a."""
    findings = [mistake, _extra_words(pair)]
    limited = _limited(joints, asked)
    missing = _without_limits(pair)
    if limited and missing:
        findings.append(f"model {missing} states no limits")
        limited = frozenset()
    numbers = pair.numbers[np.flatnonzero(found.reading.apart)]
    said = Said(limited, "names" in asked.same, frozenset(numbers.tolist()))
    findings += joint_findings(joints, asked.tol, said, found.reading.link)
    findings += _frames(found, poses, asked)
    if found.aligned_to == "nothing":
        findings.append(NOT_ALIGNED)
    return tuple(filter(None, findings))


def _frames(
    found: Diagnosis,
    poses: Array,
    asked: Asked,
) -> list[str]:
    reading = found.reading
    effect = base_effect(reading.base, poses)
    frames = [
        frame_words("base", reading.base, asked.tol, effect),
        frame_words("tool", reading.tool, asked.tol),
    ]
    moved = filter(None, frames)
    if asked.strict:
        return list(moved)
    how = alignment_words(found.aligned_to)
    return [f"{how}: {words}" for words in moved]


def _limited(joints: tuple[JointComparison, ...], asked: Asked) -> frozenset[int]:
    """Numbers of the joints whose limits differ where these count."""
    if "limits" not in asked.same:
        return frozenset()
    return frozenset(j.number for j in joints if limits_differ(j, asked.same, asked.tol))


def _without_limits(pair: Matched) -> str:
    """The model that bounds no joint, or empty."""
    for model, chain in (("a", pair.a), ("b", pair.b)):
        if len(chain.limits) and not np.isfinite(chain.limits).any():
            return model
    return ""


def _extra_words(pair: Matched) -> str:
    """The sentence on joints that one model has more."""
    if pair.extra is None:
        return ""
    model, *names = pair.extra
    named = " and ".join(map(quote, names))
    return f"model {model} has {count_words(len(names))} more, {named}"
