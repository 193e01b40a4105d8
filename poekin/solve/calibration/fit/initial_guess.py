"""Initial guesses of unknown frames and points, by linear algebra on the measurements alone.

Each is a least-squares solution that is repeated with weights (`reweighted`). It survives outliers
as long as they are a minority that does not agree on another solution: two fifths of the rows, with
any rotation and places 1 km off, are tested (tests/solve/calibration/fit/test_initial_guess.py).
The arm is taken as it is described, so a guess is as exact as that is true.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ....errors import InputError
from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import applied, normalised_or_zero, norms, rotation_part, translation_part
from ..model.tsqr import least_squares
from .flatness import FLAT, describe, extents, is_flat
from .reweighted import Weighted, reweighted

FOURS = 100
STEPS = 3
MISFIT = 0.2
"""rad: rotations that turn more than this and miss by more than this in the median do not belong
together.
"""
_TINY = np.finfo(float).tiny
_ROUNDING = 1e-13
_SHORT = 1e-3  # m: of lengths that are all shorter, rounding is taken to be that of one so long


class _Turns(NamedTuple):
    """Rotations R_base_fixed and R_tip_moving."""

    X: Array
    Z: Array


def hand_eye(A: Array, B: Array) -> tuple[Array, Array]:
    """X = T_base_fixed and Z = T_tip_moving (4, 4) with B = X^-1 A Z, of at least 3 pairs (N, 4, 4)
    of A = T_base_tip and B = T_fixed_moving, m.

    A Z = X B; the rotations first: with K = sum of w R_A kron R_B, K vec(R_Z) = sum of w vec(R_X),
    so that vec(R_X) and vec(R_Z) are the first singular vectors of K. Then R_A t_Z - t_X = R_X t_B
    - t_A is linear in the two translations.

    Raises: InputError where too little is measured (fewer than 3 poses; a hand that was not turned,
    or about one axis only, or less about a second than the rotations scatter), and where no X and Z
    fit the rotations to 0.2 rad.
    Source: Shah 2013, "Solving the robot-world/hand-eye calibration problem using the Kronecker
    product" (J. Mechanisms and Robotics 5), with weights; vec runs along the rows here, which swaps
    the factors of his Kronecker product.
    """
    count = len(A)
    _check_count(count, 3, "two unknown frames")
    R_A = rotation_part(A)
    R_B = rotation_part(B)
    turned = reweighted(
        partial(_rotations, R_A, R_B),
        count,
        3,
        _ROUNDING,
    )
    R_X, R_Z = turned.value
    _check_turns(R_A[turned.kept], turned.median)
    # unknowns t_Z, t_X; a design of rotations alone: no row has more leverage than another
    fixed = np.broadcast_to(-np.eye(3), R_A.shape)
    design = np.concatenate([R_A, fixed], axis=2)
    there = translation_part(B) @ R_X.T
    here = translation_part(A)
    floor = _rounding(
        np.median(np.abs(there)),
        np.median(np.abs(here)),
    )
    placed = reweighted(
        lambda w: _linear(design, there - here, turned.kept * w),
        count,
        3,
        floor,
    )
    t_Z, t_X = np.split(placed.value, 2)
    return se3.pose(R_X, t_X), se3.pose(R_Z, t_Z)


def registration(a: Array, b: Array) -> Array:
    """T_ab (4, 4) with p_a = T_ab p_b: the pose of b's frame in a's out of the same points (N, 3)
    in both, m, at least 3.

    R = U diag(1, 1, det U det V) V^T of the singular value decomposition of sum of w (a - mean a)(b
    - mean b)^T, the rotation (never the reflection) of least squares, and t = mean a - R mean b.

    Raises: InputError for fewer than 3 points, and for points on a line (or no farther from one
    than they scatter). Accuracy: of exact points within rounding times length ÷ width of the set.
    Source: Kabsch 1976; Umeyama 1991 (IEEE PAMI 13, no. 4) for the sign; without his scale and with
    weights.
    """
    _check_count(len(a), 3, "the frame of points")
    floor = _rounding(
        np.abs(a).max(),
        np.abs(b).max(),
    )
    found = reweighted(
        partial(_rigid, a, b),
        len(a),
        3,
        floor,
    )
    for points in (b[found.kept], a[found.kept]):
        sizes = extents(points - points.mean(axis=0))
        if is_flat(sizes, 1, found.median):
            raise InputError(
                "an initial guess of the frame of points needs points that are not on one line, "
                f"these are ({describe(sizes, 1)}): measure more of them, in other poses of the arm"
            )
    return found.value


def centre(p: Array, d: Array) -> Array:
    """The point c (3,), m, whose distances to the points p (N, 3) are d (N,): |p_i - c| = d_i.

    Squared, 2 p_i . c - (|c|^2) = |p_i|^2 - d_i^2 is linear in c and in |c|^2, which is taken as a
    fourth unknown; each row is divided by 2 d_i, so that its residual is that of the distance. The
    fourth unknown lets outliers hide: from there, and from the best of many solutions out of four
    distances each, three Gauss-Newton steps of |p_i - c| = d_i itself are made, where that brings
    the median residual down.

    Raises: InputError for fewer than 4 points, and for points in one plane (or no farther from one
    than the distances scatter), where c and its mirror image fit alike. Accuracy: of exact
    distances within rounding times (distance ÷ thickness of the set)^2. Source: Beck, Stoica and Li
    2008, "Exact and approximate solutions of source localization problems" (IEEE Trans. Signal
    Processing 56), the unconstrained squared-range least squares, with weights; Rousseeuw 1984,
    "Least median of squares regression" (J. Am. Stat. Assoc. 79), for the fours.
    """
    count = len(p)
    _check_count(count, 4, "the centre of distances")
    from_mean = p - p.mean(axis=0)
    spread = np.abs(from_mean).max()
    floor = _rounding(spread, np.median(d))
    linear = reweighted(
        partial(_multilateral, p, d),
        count,
        4,
        floor,
    )
    of_fours = _of_fours(p, d)
    every = [linear]
    for start, first in ((linear.value, None), (of_fours.value, of_fours)):
        nearer = partial(_nearer, p, d, start)
        every.append(reweighted(nearer, count, 4, floor, first))
    found = min(every, key=lambda guess: guess.median)
    kept = p[found.kept]
    sizes = extents(kept - kept.mean(axis=0))
    if is_flat(sizes, 2, found.median):
        raise InputError(
            "an initial guess of the centre of distances needs points that are not in one plane, "
            f"these are ({describe(sizes, 2)}): the centre and its mirror image fit alike; give the "
            "centre, or a rough one (guess=), or measure out of the plane"
        )
    return found.value


def mean_pose(T: Array) -> Array:
    """The pose (4, 4) nearest to poses (N, 4, 4), m: the rotation nearest to the sum of w R, and
    the sum of w t, weights of sum 1.

    Source: Moakher 2002, "Means and averaging in the group of rotations" (SIAM J. Matrix Analysis
    24), the projected arithmetic mean, with weights.
    """
    R = rotation_part(T)
    t = translation_part(T)
    count = len(T)
    turned = reweighted(
        partial(_mean_rotation, R),
        count,
        1,
        _ROUNDING,
    )
    floor = _rounding(np.abs(t).max())
    placed = reweighted(
        partial(_mean_place, t),
        count,
        1,
        floor,
    )
    return se3.pose(turned.value, placed.value)


def mean_position(p: Array) -> Array:
    """The mean (3,) of positions (N, 3), m, by weights of sum 1."""
    floor = _rounding(np.abs(p).max())
    return reweighted(partial(_mean_place, p), len(p), 1, floor).value


def device_and_points(T: Array, p: Array) -> tuple[Array, Array]:
    """X = T_base_device (4, 4) and points y (k, 3) in the tip frame with X p = T y, of poses T (N, 4, 4)
    of the tip and measured positions p (N, k, 3), m.

    R_X p + t_X - R_T y = t_T is linear in all; the rotation nearest to the matrix that solves it is
    kept, and the rest solved again.

    Raises: InputError for fewer equations than unknowns. Source: as of `hand_eye`, its second half;
    Kabsch 1976 for the rotation.
    """
    N, k, _ = p.shape
    unknown = 12 + 3 * k
    _check_count(N, -(-unknown // (3 * k)), "a device's frame and of points of the tool")
    middle = p.mean(axis=(0, 1))
    p = p - middle
    of_points = np.kron(np.eye(k), -rotation_part(T))
    of_origin = np.tile(np.eye(3), (N, k, 1))
    of_rotation = np.kron(np.eye(3), p[:, :, None])
    blocks = [of_rotation.reshape(N, 3 * k, 9), of_origin, of_points]
    design = np.concatenate(blocks, axis=2, dtype=float)
    goal = np.tile(translation_part(T), k)
    floor = _rounding(np.abs(p).max(), np.abs(goal).max())
    solve = partial(_linear, design, goal)
    M = reweighted(solve, N, 3, floor).value[:9]
    R = _rotation(M.reshape(3, 3))
    turned = p @ R.T
    solve = partial(_linear, design[..., 9:], goal - turned.reshape(N, -1))
    t, y = np.split(reweighted(solve, N, 3, floor).value, [3])
    return se3.pose(R, t - R @ middle), y.reshape(k, 3)


def _rounding(*lengths: float) -> float:
    """Residual in m that is rounding, of measured lengths."""
    return _ROUNDING * max(*map(float, lengths), _SHORT)


def _mean_rotation(R: Array, w: Array) -> Weighted[Array]:
    mean = _rotation(np.tensordot(w, R, 1))
    return Weighted(mean, _chord(R - mean))


def _mean_place(t: Array, w: Array) -> Weighted[Array]:
    mean = w @ t / w.sum()
    return Weighted(mean, norms(t - mean))


def _rotations(R_A: Array, R_B: Array, w: Array) -> Weighted[_Turns]:
    """R_X, R_Z of R_A R_Z = R_X R_B, and the angle (as a chord) by which each pair misses."""
    weighted = w[:, None] * R_B.reshape(-1, 9)
    K = R_A.reshape(-1, 9).T @ weighted
    kron = K.reshape(3, 3, 3, 3).swapaxes(1, 2)
    U, _, V = np.linalg.svd(kron.reshape(9, 9))
    both = np.reshape([U[:, 0], V[0]], (2, 3, 3))
    sign = np.copysign(1.0, np.linalg.det(both[0]))  # the singular vectors are those of both signs
    R_X, R_Z = _rotation(sign * both)
    misses = R_A @ R_Z - R_X @ R_B
    return Weighted(_Turns(R_X, R_Z), _chord(misses))


def _chord(difference: Array) -> Array:
    """2 sin(angle/2) between two rotations, of their difference (N, 3, 3)."""
    squared = np.square(difference).sum(axis=(1, 2))
    return np.sqrt(0.5 * squared)


def _rotation(M: Array) -> Array:
    """The rotation nearest to each M (..., 3, 3): U diag(1, 1, det U V^T) V^T of its singular value
    decomposition.
    """
    U, _, V = np.linalg.svd(M)
    U[..., 2] *= np.linalg.det(U @ V).round()[..., None]
    return U @ V


def _check_turns(R: Array, scatter: float) -> None:
    turns_from_first = so3.log(R[0].T @ R)
    first, second, _ = extents(turns_from_first).tolist()
    if scatter > MISFIT and second > MISFIT:
        raise InputError(
            f"no two frames fit: they leave {scatter:.2g} rad between the measured rotations and "
            "the arm's in the median; is q in rad, does it belong to these rows, and is each pose "
            "that of the frame it is said to be, not its inverse? Of an arm that is so far off, "
            "give both frames"
        )
    least = max(FLAT, scatter)
    if second > least:
        return
    turns = "was not turned"
    if first > least:
        turns = "was turned about one axis only"
    raise InputError(
        "an initial guess of two unknown frames needs a hand that is turned about two axes; it "
        f"{turns} (by {first:.2g} rad about its first, {second:.2g} about a second, rms, where the "
        f"rotations scatter by {scatter:.2g}): turn it more, or give both frames"
    )


def _linear(design: Array, rhs: Array, w: Array) -> Weighted[Array]:
    """x of design x = rhs, (N, 3, k) and (N, 3), and the length of each row's residual."""
    root = np.sqrt(w)[:, None]
    rows = root[:, :, None] * design
    x = least_squares(
        rows.reshape(-1, design.shape[2]),
        (root * rhs).ravel(),
    )
    misses = design @ x - rhs
    return Weighted(x, norms(misses))


def _rigid(a: Array, b: Array, w: Array) -> Weighted[Array]:
    w = w / w.sum()
    mean_a = w @ a
    mean_b = w @ b
    weighted = w[:, None] * (b - mean_b)
    R = _rotation((a - mean_a).T @ weighted)
    t = mean_a - R @ mean_b
    misses = b @ R.T + t - a
    return Weighted(se3.pose(R, t), norms(misses))


def _multilateral(p: Array, d: Array, w: Array) -> Weighted[Array]:
    mean = w @ p / w.sum()
    # a point that the centre may stand on has d = 0: its row is divided by what is usual
    usual = 0.1 * np.median(d)
    divisor = 2 * np.maximum(d, usual + _TINY)
    row = np.sqrt(w) / divisor
    design, rhs = _squared(p - mean, d)
    solution = least_squares(design * row[:, None], rhs * row)
    c = mean + solution[:3]
    return Weighted(c, _misses(p, d, c))


def _squared(x: Array, d: Array) -> tuple[Array, Array]:
    """Rows (..., N, 4) and right sides (..., N) of 2 x_i . c - |c|^2 = |x_i|^2 - d_i^2."""
    squares = x * x
    # brings the fourth column to the size of the others
    length = np.sqrt(squares.mean(axis=(-2, -1), keepdims=True)) + _TINY
    constant = np.broadcast_to(-length, (*d.shape, 1))
    design = np.concatenate([2 * x, constant], axis=-1)
    return design, squares.sum(axis=-1) - d * d


def _misses(p: Array, d: Array, c: Array) -> Array:
    return np.abs(norms(p - c) - d)


def _of_fours(p: Array, d: Array) -> Weighted[Array]:
    """The centre out of four distances that leaves the least median residual, of `FOURS` draws:
    with two fifths of outliers all draws have one once in a million times.
    """
    rng = np.random.default_rng(0)
    fours = np.array([rng.choice(len(p), 4, replace=False) for _ in range(FOURS)])
    points = p[fours]
    means = points.mean(axis=1)
    design, rhs = _squared(points - means[:, None], d[fours])
    inverses: Any = np.linalg.pinv(design)
    solutions = applied(inverses, rhs)
    centres = means + solutions[:, :3]
    return min((Weighted(c, _misses(p, d, c)) for c in centres), key=lambda guess: guess.median)


def _nearer(
    p: Array,
    d: Array,
    c: Array,
    w: Array,
) -> Weighted[Array]:
    """Gauss-Newton steps from c: the distance to it changes along u, the unit vector from a point
    to c.
    """
    root = np.sqrt(w)
    for _ in range(STEPS):
        away = c - p
        rows = normalised_or_zero(away) * root[:, None]
        c = c - least_squares(rows, (norms(away) - d) * root)
    return Weighted(c, _misses(p, d, c))


def _check_count(count: int, need: int, what: str) -> None:
    if count < need:
        raise InputError(
            f"an initial guess of {what} needs {need} measurements or more, got {count}"
        )
