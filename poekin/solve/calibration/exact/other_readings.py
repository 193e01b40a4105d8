"""Pairs read otherwise: another base and tool, coupled readings, reversed joints, another order."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....errors import InputError, escape_unprintable, quote
from ....groups import se3
from ....groups.arrays import Array
from ....groups.vectors import norms
from ....model.chain import Chain
from ..calibration import Calibration
from ..causes.readings import other_readings
from ..diagnostics.explanation import Size, far, size_of
from ..diagnostics.messages import MOST
from ..fit import initial_guess
from ..measurements.poses import Poses, pose_errors
from .bounds import Propagation

_BETTER = 4.0  # how many times better another reading of the pairs has to explain them
_ODD = 30.0  # times the median: a pair that misses by more stands out


class Aligned(NamedTuple):
    """An arm in the base and tool frames of poses, and the move in words, "" for none."""

    chain: Chain
    moved: str = ""


def aligned(chain: Chain, q: Array, poses: Poses) -> Aligned:
    """The arm in the frames of the poses (N, 4, 4) where it is near them in no others.

    Source: hand-eye calibration, T = X^-1 f(q) Z.
    """
    as_given = _miss(chain.fk(q), poses.T)
    if not far(as_given, chain.reach):
        return Aligned(chain)
    frames = _frames(chain, q, poses)
    if frames is None:
        return Aligned(chain)
    X, Z = frames
    moved = chain.rebased(se3.inverse(X)).retooled(Z)
    miss = _miss(moved.fk(q), poses.T)
    if far(miss, chain.reach):
        return Aligned(chain)
    return Aligned(
        moved,
        f"the controller's frames are others: its base is moved by {size_of(X)} from "
        f"{quote(chain.base)}, its flange by {size_of(Z)} from {quote(chain.tip)}, by the nominal arm",
    )


def hint(chain: Chain, q: Array, poses: Poses) -> str:
    """End of a message: the reading of the pairs that explains them much better, "" for none."""
    as_given = _missed(chain, q, poses)
    length = np.inf
    words = ""
    for other in other_readings(chain, q):
        missed = _missed(chain, other.q, poses)
        if missed < length:
            length = missed
            words = other.words
    if not length * _BETTER < as_given:
        return ""
    return f"; with {words}, the nominal arm is off by {1e3 * length:.3g} mm only (median)"


def slight_coupling(chain: Chain, q: Array, fit: Propagation) -> str:
    """End of a message: the readings that a joint follows by a small ratio, or is off from its own
    by, where that explains most of what a fit leaves; "" for none.

    The residuals r are regressed on what is left of J_h,j q_i, for each pair of readings, when the
    parameters have taken up their part.
    """
    r = (fit.errors / fit.deviations).ravel()
    moved = fit.jacobian[..., None] * q[:, None, None, :]
    columns = moved.reshape(len(q) * 6, -1)
    gain = fit.gain.reshape(len(fit.gain), -1)
    design = fit.design.reshape(len(columns), -1)
    columns = columns - design @ (gain @ columns)
    deviations = np.tile(fit.deviations, len(q))
    columns /= deviations[:, None]
    squares = np.sum(columns**2, axis=0)
    products = r @ columns
    positive = np.maximum(squares, np.finfo(float).tiny)
    gains = products**2 / positive
    best = int(np.argmax(gains))
    left = 1.0 - gains[best] / (r @ r)
    if not left < 1.0 / _BETTER**2:
        return ""
    j, i = divmod(best, chain.dof)
    ratio = -products[best] / squares[best]
    joint = escape_unprintable(chain.q_names[j], 40)
    reading = escape_unprintable(chain.q_names[i], 40)
    if i == j:
        return f"; most of it is as if {joint} went {1.0 + ratio:.9g} times its reading"
    sign = "-" if ratio < 0 else "+"
    return f"; most of it is as if {joint} = {joint} {sign} {abs(ratio):.4g} {reading}"


def odd_pairs(found: Calibration, count: int) -> str:
    """End of a message: the pairs that stand out where a robust fit explains the others; "" for
    none.
    """
    size = found.after.length / found.nominal.reach + found.after.angle
    odd = np.flatnonzero(size > _ODD * np.median(size))
    if not 0 < len(odd) <= count // 4:
        return ""
    named = odd[:MOST].tolist()
    rows = ", ".join(map(str, named))
    return f"; pairs {rows} stand out (rows of q, from 0), the others fit better without them"


def _missed(chain: Chain, q: Array, poses: Poses) -> float:
    """Median distance, m, with base and tool free; infinite where the rotations fit none."""
    frames = _frames(chain, q, poses)
    if frames is None:
        return np.inf
    X, Z = frames
    in_frames = se3.inverse(X) @ chain.fk(q) @ Z
    miss = _miss(in_frames, poses.T)
    if far(miss, chain.reach):
        return np.inf
    return miss.length


def _frames(chain: Chain, q: Array, poses: Poses) -> tuple[Array, Array] | None:
    """Base X and tool Z of T = X^-1 f(q) Z; None where the rotations are those of no two frames."""
    try:
        return initial_guess.hand_eye(chain.fk(q), poses.T)
    except InputError:
        return None


def _miss(T: Array, measured: Array) -> Size:
    """Median distance and angle between poses (N, 4, 4)."""
    errors = pose_errors(T, measured)
    sizes = norms(errors.reshape(-1, 2, 3))
    angle, length = np.median(sizes, axis=0).tolist()
    return Size(length, angle)
