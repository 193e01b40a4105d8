"""Paths between two poses or two configurations, over s: 0 at the one, 1 at the other."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from ...checks import choice
from ...errors import ShapeError
from ...groups import se3, so3
from ...groups.arrays import Array, numbers, poses
from ...groups.so3.exp_log import exp_of_vectors
from ...groups.vectors import angular_part, linear_part, norms, rotation_part, translation_part

Path = Literal["line", "screw"]


def screw(T_s0: ArrayLike, T_s1: ArrayLike, s: ArrayLike) -> Array:
    """Screw motion T(s) = T_s0 e^{s ξ}, ξ = log(T_s0⁻¹ T_s1), of constant body twist ξ per unit of s.

    The tool turns about one axis and slides along it, all the time; its origin runs on a helix, on
    a straight line only where the two poses have the same rotation (`line`).

    Parameters
    ----------
    T_s0, T_s1 : (..., 4, 4) array_like
        Poses of the tool in one frame, m.
    s : (...) array_like
        Parameter of the path, also outside 0 ... 1, broadcast against the leading axes: two poses
        and s (N,) give (N, 4, 4).

    Returns
    -------
    T : (..., 4, 4) ndarray
        Poses, T_s0 and T_s1 themselves at s = 0 and 1. Of the two ways round at half a turn, that
        of `se3.log`. NaN in an element gives NaN in that element.

    Raises
    ------
    PoseError
        If an element of T_s0 or T_s1 is no pose.
    ShapeError
        If the shapes do not fit.
    InputError
        If an argument is no array of numbers.

    Notes
    -----
    Accuracy: that of `se3.log` and `se3.exp` (tests/solve/test_motions.py).
    Source: Park 1994, Lemmas 2 and 4.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> T = pk.motion.screw(np.eye(4), pk.se3.exp([0, 0, 1, 0.5, 0, 0]), [0, 0.5, 1])
    >>> [round(float(w[2]), 6) for w in pk.se3.log(T)]
    [0.0, 0.5, 1.0]
    """
    T_s0, T_s1, s = _together(T_s0, T_s1, s)
    start = _exact(T_s0)
    xi = se3.log(se3.inverse(start) @ _exact(T_s1))
    T = start @ se3.exp(s[..., None] * xi)
    return _with_ends(T, T_s0, T_s1, s)


def line(T_s0: ArrayLike, T_s1: ArrayLike, s: ArrayLike) -> Array:
    """Straight line of the tool's origin, with an even turn about one axis beside it.

    p(s) = p_0 + s (p_1 - p_0) and R(s) = R_0 e^{s w}, w = log(R_0ᵀ R_1): of constant velocity and
    angular velocity per unit of s.

    Parameters
    ----------
    T_s0, T_s1 : (..., 4, 4) array_like
        Poses of the tool in one frame, m.
    s : (...) array_like
        Parameter of the path, as in `screw`.

    Returns
    -------
    T : (..., 4, 4) ndarray
        Poses, as of `screw`.

    Raises
    ------
    PoseError, ShapeError, InputError
        As `screw`.

    Notes
    -----
    Accuracy: that of `screw`. Source: Park 1994, Lemmas 1 and 3.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> T = pk.motion.line(np.eye(4), pk.se3.exp([0, 0, 0, 0.5, 0, 0]), np.linspace(0, 1, 3))
    >>> [round(float(x), 6) for x in T[:, 0, 3]]
    [0.0, 0.25, 0.5]
    """
    T_s0, T_s1, s = _together(T_s0, T_s1, s)
    R_0 = rotation_part(_exact(T_s0))
    R_1 = rotation_part(_exact(T_s1))
    T = T_s0.copy()
    R_01 = np.swapaxes(R_0, -1, -2) @ R_1
    w = so3.log(R_01)
    way = translation_part(T_s1) - translation_part(T_s0)
    turned = exp_of_vectors(s[..., None] * w)
    T[..., :3, :3] = R_0 @ turned
    T[..., :3, 3] += s[..., None] * way
    return _with_ends(T, T_s0, T_s1, s)


def joint(q_0: ArrayLike, q_1: ArrayLike, s: ArrayLike) -> Array:
    """Straight line q(s) = q_0 + s (q_1 - q_0) in the space of the coordinates; no turns are taken off.

    Parameters
    ----------
    q_0, q_1 : (..., m) array_like
        Configurations, rad or m.
    s : (...) array_like
        Parameter of the path, broadcast against their leading axes.

    Returns
    -------
    q : (..., m) ndarray
        Configurations, q_0 and q_1 themselves at s = 0 and 1.

    Raises
    ------
    ShapeError
        If the shapes do not fit.
    InputError
        If an argument is no array of numbers.

    Notes
    -----
    Accuracy: three roundings. Source: none, a line.
    """
    q_0 = numbers(q_0, "q_0")
    q_1 = numbers(q_1, "q_1")
    s = numbers(s, "s")[..., None]
    scalar = not q_0.ndim or not q_1.ndim
    if scalar or q_0.shape[-1] != q_1.shape[-1]:
        raise ShapeError(
            f"q_0, q_1: expected (..., m) with the same m, got {q_0.shape} and {q_1.shape}"
        )
    try:
        q = q_0 + s * (q_1 - q_0)
        return np.where(s == 1, q_1, q)
    except ValueError as error:
        shapes = f"{q_0.shape}, {q_1.shape} and s {s.shape[:-1]}"
        raise ShapeError(f"q_0, q_1: the leading axes do not broadcast: {shapes}") from error


def path_lengths(T_s0: ArrayLike, T_s1: ArrayLike, along: Path = "line") -> Array:
    """Lengths of a path between two poses: the way of the tool's origin and the angle turned.

    Both are passed evenly in s, so |p'| = length s' and |ω| = angle s': what `minimum_time` needs.

    Parameters
    ----------
    T_s0, T_s1 : (..., 4, 4) array_like
        Poses of the tool in one frame, m.
    along : {"line", "screw"}, default "line"
        Path: the straight line, |p_1 - p_0|, or the helix of the screw motion, |v| of ξ = (ω; v).

    Returns
    -------
    lengths : (..., 2) ndarray
        Length and angle, m and rad.

    Raises
    ------
    PoseError, ShapeError
        As `screw`.
    InputError
        If `along` is neither, or an argument is no array of numbers.

    Notes
    -----
    Accuracy: that of `se3.log`. Source: none, norms.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> pk.motion.path_lengths(np.eye(4), pk.se3.exp([0, 0, 0.5, 0, 0, 0.2])).round(6).tolist()
    [0.2, 0.5]
    """
    choice(along, get_args(Path), "along")
    T_s0, T_s1, _ = _together(T_s0, T_s1, 0.0)
    start = _exact(T_s0)
    end = _exact(T_s1)
    xi = se3.log(se3.inverse(start) @ end)
    way = translation_part(end) - translation_part(start)
    if along == "screw":
        way = linear_part(xi)
    lengths = [
        norms(way),
        norms(angular_part(xi)),
    ]
    return np.stack(lengths, axis=-1)


def _together(
    T_s0: ArrayLike,
    T_s1: ArrayLike,
    s: ArrayLike,
) -> tuple[Array, Array, Array]:
    """Two arrays of poses and s, of the same leading axes."""
    T_s0 = poses(T_s0, "T_s0")
    T_s1 = poses(T_s1, "T_s1")
    s = numbers(s, "s")
    try:
        batch = np.broadcast_shapes(
            T_s0.shape[:-2],
            T_s1.shape[:-2],
            s.shape,
        )
    except ValueError as error:
        shapes = f"T_s0 {T_s0.shape}, T_s1 {T_s1.shape} and s {s.shape}"
        raise ShapeError(f"the leading axes do not broadcast: {shapes}") from error
    T_s0 = np.broadcast_to(T_s0, (*batch, 4, 4))
    T_s1 = np.broadcast_to(T_s1, (*batch, 4, 4))
    return T_s0, T_s1, np.broadcast_to(s, batch)


def _exact(T: Array) -> Array:
    """The poses with rotations to rounding: two that each miss by what is accepted would miss by
    more together.
    """
    T = T.copy()
    w = so3.log(rotation_part(T))
    T[..., :3, :3] = exp_of_vectors(w)
    return T


def _with_ends(
    T: Array,
    T_s0: Array,
    T_s1: Array,
    s: Array,
) -> Array:
    """The path with the poses as they were given at its ends."""
    s = s[..., None, None]
    T = np.where(s == 1, T_s1, T)
    return np.where(s == 0, T_s0, T)
