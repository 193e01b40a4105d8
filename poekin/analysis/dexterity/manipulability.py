"""manipulability: how well an arm can move its tool where it stands, in numbers, and how that
changes with q.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError, safe_repr
from ...groups.arrays import Array
from ...model.chain import Chain

__all__ = ["Manipulability", "Measures", "manipulability", "manipulability_gradient"]

ROWS = {"pose": [0, 1, 2, 3, 4, 5], "translation": [3, 4, 5], "rotation": [0, 1, 2]}


class Measures(NamedTuple):
    """Measures of one part of the Jacobian, of its singular values s_1 >= ... >= s_r, r the
    smaller of its rows and of m.

    yoshikawa: their product, sqrt(det J J^T) where m is at least the number of rows; condition: s_1
    / s_r, infinite at a singularity; smallest: s_r. Arrays of the batch's shape.
    """

    yoshikawa: Array
    condition: Array
    smallest: Array


class Manipulability(NamedTuple):
    """Measures of all six rows, `pose`, of the three of translation (m/s), and of the three of
    rotation (rad/s).
    """

    pose: Measures
    translation: Measures
    rotation: Measures


def manipulability(chain: Chain, q: Any, *, length: float = 1.0) -> Manipulability:
    """Yoshikawa's measure, condition number and smallest singular value of the hybrid Jacobian at
    q.

    Rows (omega; v), base axes, velocity of the tool's origin. Those of all six mix rad and m: v is
    divided by `length` first (m); 1 leaves it in SI units, as most tools do. Translation and
    rotation apart have no such choice and are not divided. Yoshikawa's measure of the six is the
    same in every frame where m >= 6; the others belong to the tool's origin.

    Parameters: chain; q (..., m) or a dict; length, m. Returns: Manipulability, each number of
    shape (...); NaN for a configuration with NaN. Raises: InputError (also for a chain without
    coordinates), ShapeError, UnknownName. Accuracy: singular values within 1e-14 reach; their
    product and quotient follow (tests/analysis/dexterity/test_manipulability.py). Source: Yoshikawa
    1985.
    """
    check(chain, length)
    J = chain.jacobian(q, "hybrid")
    return Manipulability(*(_measures(scaled(J, -2, part, length)) for part in ROWS))


def manipulability_gradient(
    chain: Chain, q: Any, *, part: str = "pose", length: float = 1.0
) -> Array:
    """d/dq of Yoshikawa's measure: dw/dq_j = sum over a of (product of the other s_b) u_a^T
    (dJ/dq_j) v_a.

    J = sum s_a u_a v_a^T, dJ/dq_j from `Chain.hessian`. Where m is at least the number of rows this
    is
    w tr(J^+ dJ/dq_j) without a division, so it holds at a singularity too: there w = |...| has a
    kink, and this is the slope on the side that the signs of u and v say.

    Parameters: chain; q (..., m) or a dict; part "pose", "translation" or "rotation"; length, m, as
    `manipulability`. Returns: (..., m), per rad or m. Raises: as `manipulability`. Accuracy: within
    1e-12 of the measure's size (tests/analysis/dexterity/test_manipulability.py). Source: Yoshikawa
    1985; Park 1994, Section III, for dJ/dq.
    """
    check(chain, length)
    check_part(part)
    J = scaled(chain.jacobian(q, "hybrid"), -2, part, length)
    H = scaled(chain.hessian(q, "hybrid"), -3, part, length)
    U, s, V = svd(J)
    others = np.stack([np.prod(np.delete(s, a, -1), axis=-1) for a in range(s.shape[-1])], axis=-1)
    return np.einsum("...a,...ra,...rij,...ai->...j", others, U, H, V, optimize=True)


def check(chain: object, length: float) -> None:
    """Raises InputError where there is no arm to judge, or no length to measure it by."""
    if not isinstance(chain, Chain):
        raise InputError(
            f"expected a Chain, as Robot.chain(tip=...) makes it, got {safe_repr(chain)}"
        )
    if not chain.dof:
        raise InputError("the chain has no coordinate: nothing moves its tool")
    if not isinstance(length, (int, float, np.integer, np.floating)) or not 0 < length < math.inf:
        raise InputError(f"length: expected a positive number of metres, got {safe_repr(length)}")


def check_part(part: object) -> None:
    """Raises InputError for what is no part of a twist."""
    if not isinstance(part, str) or part not in ROWS:
        raise InputError(
            f"part: expected one of {', '.join(map(repr, ROWS))}, got {safe_repr(part)}"
        )


def scaled(X: Array, axis: int, part: str, length: float) -> Array:
    """The rows of a part, along an axis of J (-2) or of its Hessian (-3); in the whole, v ÷ length."""
    if part != "pose":
        return np.take(X, ROWS[part], axis)
    return X * np.repeat([1.0, 1.0 / length], 3).reshape(6, *[1] * (-1 - axis))


def svd(J: Array) -> tuple[Array, Array, Array]:
    """The factors U (..., k, r), s (..., r) and V^T (..., r, m) of J = U diag(s) V^T.

    Where an entry of J is NaN, s is.
    """
    bad = np.asarray(~np.isfinite(J).all(axis=(-2, -1), keepdims=True))
    U, s, V = np.linalg.svd(np.where(bad, 0.0, J), full_matrices=False)
    return U, np.where(bad[..., 0], np.nan, s), V


def _measures(J: Array) -> Measures:
    s = svd(J)[1]
    largest = s[..., 0]
    smallest = s[..., -1]
    condition = np.divide(largest, smallest, out=np.full(s.shape[:-1], np.inf), where=smallest != 0)
    return Measures(np.prod(s, axis=-1), condition, smallest)
