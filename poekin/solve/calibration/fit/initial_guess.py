"""Unknown frames and points out of the measurements alone, by linear algebra: where a calibration
begins.

Each is a least-squares solution that is repeated with weights, so that gross outliers do not pull
it: first nearly least absolute deviations (weights min(1, median/r), r a row's residual), then the
rows within 4 medians, evenly.
It survives outliers as long as they are a minority that does not agree on another solution: two
fifths of the rows, with any rotation and places 1 km off, are tested
(tests/solve/calibration/fit/test_initial_guess.py). The arm is taken as it is described: so this is
as exact as that is true, and a beginning, no result.
Source of the weights: Huber 1964, with the median of the residuals as his constant.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError, ShapeError
from ....groups import so3
from ....groups.arrays import Array, numbers, poses
from ....model.checks import finite

ROUNDS, TRIMS, STEPS = 20, 3, 3
GROSS = 4.0
"""A row whose residual is more than this many medians is left out at the end: 4 sigma of an error
along one axis, and
6 of the length of one in space."""
MISFIT = 0.2
"""rad: rotations that turn more than this and miss by more than this in the median do not belong
together.
"""
FLAT = 1e-6
"""How far a set of points or rotations has to reach out of a line or plane, in units of its length
(rad for angles).
"""
_ROUNDING = 1e-13
_SHORT = 1e-3  # m: of lengths that are all shorter, rounding is taken to be that of one so long

Solution = TypeVar("Solution")


def hand_eye(T_base_tip: ArrayLike, T_fixed_moving: ArrayLike) -> tuple[Array, Array]:
    """X = T_base_fixed and Z = T_tip_moving with T_fixed_moving = X^-1 T_base_tip Z.

    A Z = X B of poses A = T_base_tip, B = T_fixed_moving. The rotations first: with K = sum of w
    R_A kron R_B,
    K vec(R_Z) = sum of w vec(R_X), so that vec(R_X) and vec(R_Z) are the first singular vectors of
    K. Then
    R_A t_Z - t_X = R_X t_B - t_A is linear in the two translations.

    Parameters: T_base_tip, T_fixed_moving (N, 4, 4), m, at least 3 pairs. Returns: X, Z (4, 4).
    Raises: InputError where too little is measured (fewer than 3 poses; a hand that was not turned,
    or about one axis only, or less about a second than the rotations scatter), and where no X and Z
    fit the rotations to 0.2 rad; PoseError, ShapeError. Accuracy: of exact pairs within rounding;
    without a bound otherwise, it is an initial guess. Source: Shah 2013, "Solving the
    robot-world/hand-eye calibration problem using the Kronecker product" (J. Mechanisms and
    Robotics 5), with weights; vec runs along the rows here, which swaps the factors of his
    Kronecker product.
    """
    A = _finite(poses(T_base_tip, "T_base_tip"), "T_base_tip", 4, 4)
    B = _finite(poses(T_fixed_moving, "T_fixed_moving"), "T_fixed_moving", 4, 4)
    _check_counts(3, "two unknown frames", "T_base_tip and T_fixed_moving", A, B)
    R_A, R_B = A[:, :3, :3], B[:, :3, :3]
    (R_X, R_Z), turned, kept = _robust(lambda w: _rotations(R_A, R_B, w), len(A), 3, _ROUNDING)
    _check_turns(R_A[kept], float(np.median(turned)))
    # unknown_frames t_Z, t_X; a design of rotations alone: no row has more leverage than another
    design = np.concatenate([R_A, np.broadcast_to(-np.eye(3), R_A.shape)], axis=2)
    there, here = B[:, :3, 3] @ R_X.T, A[:, :3, 3]
    size = max(float(np.median(np.abs(there))), float(np.median(np.abs(here))), _SHORT)
    t, _, _ = _robust(
        lambda w: _linear(design, there - here, kept * w), len(A), 3, _ROUNDING * size
    )
    return _pose(R_X, t[3:]), _pose(R_Z, t[:3])


def registration(a: ArrayLike, b: ArrayLike) -> Array:
    """T_ab with p_a = T_ab p_b: the pose of b's frame in a's out of the same points in both.

    R = U diag(1, 1, det U det V) V^T of the singular value decomposition of sum of w (a - mean a)(b
    - mean b)^T, the rotation (never the reflection) of least squares, and t = mean a - R mean b.

    Parameters: a, b (N, 3), m, the same N points in the two frames, at least 3. Returns: T_ab (4,
    4).
    Raises: InputError for fewer than 3 points, and for points on a line (or no farther from one
    than they scatter); ShapeError. Accuracy: of exact points within rounding times length ÷ width
    of the set; an initial guess otherwise. Source: Kabsch 1976; Umeyama 1991 (IEEE PAMI 13, no. 4) for
    the sign; without his scale and with weights.
    """
    a, b = _finite(numbers(a, "a"), "a", 3), _finite(numbers(b, "b"), "b", 3)
    _check_counts(3, "the frame of points", "a and b", a, b)
    size = max(float(np.abs(a).max()), float(np.abs(b).max()), _SHORT)
    T, off, kept = _robust(lambda w: _rigid(a, b, w), len(a), 3, _ROUNDING * size)
    for points in (b[kept], a[kept]):
        if _within(_spread(points - points.mean(axis=0)), 1, float(np.median(off))):
            raise InputError(
                "an initial guess of the frame of points needs points that are not on one line, these are "
                f"({_reach(points, 1)}): measure more of them, in other poses of the arm"
            )
    return T


def centre(p: ArrayLike, d: ArrayLike) -> Array:
    """The point c (3,) whose distances to the points p are d: |p_i - c| = d_i.

    Squared, 2 p_i . c - (|c|^2) = |p_i|^2 - d_i^2 is linear in c and in |c|^2, which is taken as a
    fourth unknown;
    each row is divided by 2 d_i, so that its residual is that of the distance. The fourth unknown
    lets outliers hide: from there three Gauss-Newton steps of |p_i - c| = d_i itself are made,
    where that brings the median residual down.

    Parameters: p (N, 3), m, at least 4; d (N,), m. Returns: c (3,), m, in the frame of p.
    Raises: InputError for fewer than 4 points, for a distance below 0, and for points in one plane
    (or no farther from one than the distances scatter), where c and its mirror image fit alike;
    ShapeError.
    Accuracy: of exact distances within rounding times (distance ÷ thickness of the set)^2; a first
    guess otherwise. Source: Beck, Stoica and Li 2008, "Exact and approximate solutions of source
    localization problems" (IEEE Trans. Signal Processing 56), the unconstrained squared-range least
    squares, with weights.
    """
    p, d = _finite(numbers(p, "p"), "p", 3), _finite(numbers(d, "d"), "d")
    _check_counts(4, "the centre of distances", "p and d", p, d)
    if (d < 0).any():
        raise InputError(f"d: expected distances of at least 0 m, got {d.min():g}")
    size = max(float(np.abs(p - p.mean(axis=0)).max()), float(np.median(d)), _SHORT)
    linear = _robust(lambda w: _multilateral(p, d, w), len(p), 4, _ROUNDING * size)
    nearer = _robust(lambda w: _nearer(p, d, w, linear[0]), len(p), 4, _ROUNDING * size)
    c, off, kept = min(linear, nearer, key=lambda guess: float(np.median(guess[1])))
    if _within(_spread(p[kept] - p[kept].mean(axis=0)), 2, float(np.median(off))):
        raise InputError(
            "an initial guess of the centre of distances needs points that are not in one plane, these are "
            f"({_reach(p[kept], 2)}): the centre and its mirror image fit alike; give the centre, or a rough "
            "one (guess=), or measure out of the plane"
        )
    return c


def mean_pose(T: ArrayLike) -> Array:
    """The pose nearest to many: the rotation nearest to the sum of w R, and the sum of w t, weights
    of sum 1.

    Parameters: T (N, 4, 4), m, at least one. Returns: (4, 4). Raises: InputError, PoseError,
    ShapeError.
    Accuracy: an initial guess. Source: Moakher 2002, "Means and averaging in the group of rotations"
    (SIAM J. Matrix Analysis 24), the projected arithmetic mean, with weights.
    """
    T = _finite(poses(T), "T", 4, 4)
    _check_counts(1, "a pose", "T", T)
    R, t = T[:, :3, :3], T[:, :3, 3]

    def turn(w: Array) -> tuple[Array, Array]:
        mean = _rotation(np.tensordot(w, R, 1))
        return mean, _chord(R - mean)

    def place(w: Array) -> tuple[Array, Array]:
        mean = w @ t / w.sum()
        return mean, np.linalg.norm(t - mean, axis=1)

    size = max(float(np.abs(t).max()), _SHORT)
    return _pose(
        _robust(turn, len(T), 1, _ROUNDING)[0], _robust(place, len(T), 1, _ROUNDING * size)[0]
    )


def _robust(
    solve: Callable[[Array], tuple[Solution, Array]], count: int, need: int, floor: float
) -> tuple[Solution, Array, np.ndarray]:
    """solve(weights (N,)) -> (solution, residuals (N,)), repeated: the last of both, and the rows
    that it was made of.

    need: how many rows there have to be; floor: a residual that is none.
    """
    x, r = solve(np.ones(count))
    for _ in range(ROUNDS):
        scale = max(float(np.median(r)), floor)
        x, r = solve(scale / np.maximum(r, scale))
    kept = np.ones(count, bool)
    for _ in range(TRIMS):
        kept = r <= max(
            GROSS * float(np.median(r)), float(np.partition(r, need - 1)[need - 1]), floor
        )
        x, r = solve(kept.astype(float))
    return x, r, kept


def _rotations(R_A: Array, R_B: Array, w: Array) -> tuple[tuple[Array, Array], Array]:
    """R_X, R_Z of R_A R_Z = R_X R_B, and the angle (as a chord) by which each pair misses."""
    K = R_A.reshape(-1, 9).T @ (w[:, None] * R_B.reshape(-1, 9))
    U, _, V = np.linalg.svd(K.reshape(3, 3, 3, 3).swapaxes(1, 2).reshape(9, 9))
    X, Z = U[:, 0].reshape(3, 3), V[0].reshape(3, 3)
    sign = 1.0 if np.linalg.det(X) > 0 else -1.0
    R_X, R_Z = _rotation(sign * X), _rotation(sign * Z)
    return (R_X, R_Z), _chord(R_A @ R_Z - R_X @ R_B)


def _chord(difference: Array) -> Array:
    """2 sin(angle/2) between two rotations, of their difference (N, 3, 3)."""
    return np.sqrt(0.5 * np.square(difference).sum(axis=(1, 2)))


def _rotation(M: Array) -> Array:
    """The rotation nearest to M: U diag(1, 1, det U det V) V^T of its singular value decomposition."""
    U, _, V = np.linalg.svd(M)
    return (U * [1.0, 1.0, 1.0 if np.linalg.det(U) * np.linalg.det(V) > 0 else -1.0]) @ V


def _check_turns(R: Array, scatter: float) -> None:
    w = _spread(so3.log(R[0].T @ R))
    if scatter > MISFIT and w[1] > MISFIT:
        raise InputError(
            f"no two frames fit: they leave {scatter:.2g} rad between the measured rotations and the arm's in the "
            "median; is q in rad, does it belong to these rows, and is each pose that of the frame it is said to be, "
            "not its inverse? Of an arm that is so far off, give both frames"
        )
    if w[1] > max(FLAT, scatter):
        return
    turns = "was not turned" if w[0] <= max(FLAT, scatter) else "was turned about one axis only"
    raise InputError(
        f"an initial guess of two unknown frames needs a hand that is turned about two axes; it {turns} (by {w[0]:.2g} "
        f"rad about its first, {w[1]:.2g} about a second, rms, where the rotations scatter by {scatter:.2g}): turn it "
        "more, or give both frames"
    )


def _linear(design: Array, rhs: Array, w: Array) -> tuple[Array, Array]:
    """x of design x = rhs, (N, 3, k) and (N, 3), and the length of each row's residual."""
    root = np.sqrt(w)[:, None]
    rows, values = (root[:, :, None] * design).reshape(-1, design.shape[2]), (root * rhs).ravel()
    x: Array = np.linalg.lstsq(rows, values, rcond=None)[0].astype(float)
    return x, np.linalg.norm(design @ x - rhs, axis=1)


def _rigid(a: Array, b: Array, w: Array) -> tuple[Array, Array]:
    w = w / w.sum()
    mean_a, mean_b = w @ a, w @ b
    R = _rotation((a - mean_a).T @ (w[:, None] * (b - mean_b)))
    t = mean_a - R @ mean_b
    return _pose(R, t), np.linalg.norm(b @ R.T + t - a, axis=1)


def _multilateral(p: Array, d: Array, w: Array) -> tuple[Array, Array]:
    mean = w @ p / w.sum()
    x = p - mean
    # a point that the centre may stand on has d = 0: its row is divided by what is usual
    row = np.sqrt(w) / (2 * np.maximum(d, 0.1 * np.median(d) + np.finfo(float).tiny))
    length = (
        np.sqrt(np.mean(x * x)) + np.finfo(float).tiny
    )  # brings the fourth column to the size of the others
    design = np.column_stack([2 * x, np.full(len(x), -length)]) * row[:, None]
    c = np.linalg.lstsq(design, ((x * x).sum(axis=1) - d * d) * row, rcond=None)[0][:3]
    return c + mean, np.abs(np.linalg.norm(x - c, axis=1) - d)


def _nearer(p: Array, d: Array, w: Array, c: Array) -> tuple[Array, Array]:
    """Gauss-Newton steps from c: the distance to it changes along u, the unit vector from a point
    to c.
    """
    root = np.sqrt(w)
    for _ in range(STEPS):
        away = c - p
        length = np.linalg.norm(away, axis=1)
        u = np.divide(away, length[:, None], out=np.zeros_like(away), where=length[:, None] > 0)
        c = c - np.linalg.lstsq(u * root[:, None], (length - d) * root, rcond=None)[0]
    return c, np.abs(np.linalg.norm(p - c, axis=1) - d)


def _spread(x: Array) -> Array:
    """Root mean square (3,) of vectors (N, 3) along their principal directions, the largest first."""
    return np.linalg.svd(x, full_matrices=False, compute_uv=False) / np.sqrt(len(x))


def _within(spread: Array, k: int, scatter: float) -> bool:
    """Whether a set of points reaches along its direction k no farther than rounding, or than its
    points scatter.

    Points that do not fit at all, as in other units, are not called flat for it.
    """
    return spread[k] <= FLAT * spread[0] or spread[k] <= scatter < 0.1 * spread[0]


def _reach(points: Array, k: int) -> str:
    """Words for points that are in a line (k = 1) or plane (k = 2)."""
    spread = _spread(points - points.mean(axis=0))
    return f"{spread[0]:.2g} m along it and {spread[k]:.2g} m out of it, rms"


def _finite(array: Array, name: str, *tail: int) -> Array:
    """The array, finite and with rows of this shape."""
    if array.ndim != 1 + len(tail) or array.shape[1:] != tail:
        raise ShapeError(
            f"{name}: expected shape ({', '.join(['N', *map(str, tail)])}), got {array.shape}"
        )
    return finite(array, name)


def _check_counts(need: int, what: str, names: str, *arrays: Array) -> None:
    counts = [len(array) for array in arrays]
    if len(set(counts)) > 1:
        raise ShapeError(
            f"{names}: expected as many rows in both, got {' and '.join(map(str, counts))}"
        )
    if counts[0] < need:
        raise InputError(
            f"an initial guess of {what} needs {need} measurements or more, got {counts[0]}"
        )


def _pose(R: Array, t: Array) -> Array:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, t
    return T
