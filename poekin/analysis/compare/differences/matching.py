"""Joints of two models matched in order, the longer one without those that can be dropped."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....model.chain import Chain
from ...axis_lines import uncoupled_at_zero
from ..unmatched_joints import droppable, without
from .conventions import Asked

LEAST = 60
"""Configurations within the limits of either model at which alignments are weighed, or as many as
pose errors are told of, where an alignment is not to be the worse one.
"""


class Matched(NamedTuple):
    """Two chains at rest with equal numbers of joints, the couplings of these, values x (samples,
    n) within a's limits, b's values y at the same coordinates, others within a's and within b's;
    numbers (n,) that the joints have in the first chain as it was given, from 1; extra, as
    `Comparison.unmatched_joints`.
    """

    a: Chain
    b: Chain
    C_a: Array
    C_b: Array
    x: Array
    y: Array
    both: tuple[Array, Array]
    numbers: np.ndarray
    extra: tuple[str, ...] | None = None


def matched(a: Chain, b: Chain, asked: Asked) -> Matched | None:
    """Both chains at rest, the longer one without the joints that can be dropped, b's joints in the
    directions that its coordinates have in a's; None where none can.
    """
    found = _in_order(a, b, asked)
    if found is None:
        return None
    signs = leading_signs(found.C_a) * leading_signs(found.C_b)
    if (signs > 0).all():
        return found
    limits = np.sort(signs[:, None] * found.b.limits)
    screws = signs[:, None] * found.b.screws
    b = found.b.replace(screws=screws, limits=limits, pitches=found.b.pitches)
    x_a, x_b = found.both
    return found._replace(
        b=b, C_b=signs[:, None] * found.C_b, y=signs * found.y, both=(x_a, signs * x_b)
    )


def leading_signs(C: Array) -> Array:
    """1 or -1 (n,) for each joint: the sign by which it follows the first of the coordinates that no
    joint before it follows; 1 where there are none.
    """
    first = np.cumsum(C != 0, axis=0) == 1
    signs = np.ones(len(C))
    # the first column last, as it is the one that stays
    for k in reversed(range(C.shape[1])):
        signs = np.where(first[:, k] & (C[:, k] != 0), np.sign(C[:, k]), signs)
    return signs


def _in_order(a: Chain, b: Chain, asked: Asked) -> Matched | None:
    one = uncoupled_at_zero(a)
    other = uncoupled_at_zero(b)
    count = max(LEAST, asked.samples)
    q = a.random(asked.seed, count)
    ours = q @ a.coupling.T
    theirs = b.random(asked.seed, count) @ b.coupling.T
    x = ours[: asked.samples]
    y = x
    if a.coupling.shape == b.coupling.shape:
        y = q[: asked.samples] @ b.coupling.T
    numbers = np.arange(len(one.screws)) + 1
    pair = Matched(one, other, a.coupling, b.coupling, x, y, (ours, theirs), numbers)
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
            both=(ours, np.delete(theirs, ks, axis=1)),
            extra=("b", *_names(other, ks)),
        )
    return pair._replace(
        a=without(one, ks, held),
        C_a=np.delete(a.coupling, ks, axis=0),
        x=np.delete(x, ks, axis=1),
        y=np.delete(y, ks, axis=1),
        both=(np.delete(ours, ks, axis=1), theirs),
        numbers=np.delete(numbers, ks),
        extra=("a", *_names(one, ks)),
    )


def _names(
    chain: Chain,
    ks: tuple[int, ...],
) -> tuple[str, ...]:
    return tuple(chain.joint_names[k] for k in ks)
