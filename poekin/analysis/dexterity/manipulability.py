"""manipulability: how well an arm can move its tool where it stands, in numbers, and how that
changes with q.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...checks import choice, positive
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.arm import Arm
from ...results import Result
from .jacobian_part import ROWS, Part, generic_rank, moving_chain, scaled, svd


@dataclass(frozen=True, eq=False)
class Measures(Result):
    """Measures of one part of the Jacobian, by its g largest singular values s_1 ≥ … ≥ s_g.

    g is the largest rank that this part has at any configuration.

    Attributes
    ----------
    yoshikawa : (...) ndarray
        Product of the singular values, sqrt(det J Jᵀ) where g is the number of rows.
    condition : (...) ndarray
        Condition number s_1 / s_g, infinite at a singularity.
    smallest : (...) ndarray
        Smallest of them, s_g: rad/s or m/s of the tool for rates of size 1.
    """

    yoshikawa: Array
    condition: Array
    smallest: Array

    def summary(self) -> str:
        """The three measures, of a batch the worst of each.

        Returns
        -------
        text : str
            Line such as "yoshikawa 0.12, condition 3.4, smallest 0.2".
        """
        if not np.size(self.smallest):
            return "no configuration"
        measures = (
            np.min(self.yoshikawa),
            np.max(self.condition),
            np.min(self.smallest),
        )
        w, condition, smallest = (f"{float(x) + 0.0:.4g}" for x in measures)
        return f"yoshikawa {w}, condition {condition}, smallest {smallest}"


@dataclass(frozen=True, eq=False)
class Manipulability(Result):
    """Measures of an arm's Jacobian at one or many configurations; the result of `manipulability`.

    Attributes
    ----------
    pose : Measures
        Measures of all six rows, in rad/s and lengths per second.
    translation : Measures
        Measures of the rows of the tool origin's velocity, m/s.
    rotation : Measures
        Measures of the rows of the angular velocity, rad/s.
    """

    pose: Measures
    translation: Measures
    rotation: Measures

    def summary(self) -> str:
        """One line a part.

        Returns
        -------
        text : str
            Lines such as "translation: yoshikawa 0.12, condition 3.4, smallest 0.2".
        """
        return "\n".join(f"{part}: {measures}" for part, measures in vars(self).items())


def manipulability(
    chain: Chain,
    q: Any,
    *,
    length: float = 1.0,
) -> Manipulability:
    """Yoshikawa's measure, condition number and smallest singular value of the hybrid Jacobian.

    The rows are (ω; v), in base axes, with v the velocity of the tool's origin. An arm with fewer
    than six coordinates, or a planar one, is judged by what it can do at all: only as many singular
    values count as the Jacobian has at a general configuration.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Arm to judge.
    q : (..., m) array_like or dict
        Configurations, rad or m.
    length : float, default 1.0
        Length by which v is divided in the measures of the pose, m, as these mix rad and m;
        1 leaves SI units, as most tools do. Translation and rotation apart are not divided.

    Returns
    -------
    measures : Manipulability
        Measures of pose, translation and rotation, each number of shape (...); NaN for a
        configuration with NaN.

    Raises
    ------
    InputError
        If `chain` is no Chain or has no coordinate, or `length` is not positive.
    ShapeError
        If `q` has not m coordinates.
    UnknownName
        If a dict `q` names a coordinate that the chain has not.

    See Also
    --------
    manipulability_gradient : Gradient of Yoshikawa's measure.
    singularity : Motion that is lost, and how far away that is.

    Notes
    -----
    With m ≥ 6 Yoshikawa's measure of the pose is the same in every frame; all others belong to the
    tool's origin. Accuracy: singular values within 1e-14 reach; their product and quotient follow
    (tests/analysis/dexterity/test_manipulability.py). Source: Yoshikawa 1985.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> found = pk.manipulability(arm, [0.0, -1.0, 1.5, -2.0, -1.5, 0.0])
    >>> round(float(found.translation.yoshikawa), 3)
    0.16
    >>> pk.manipulability(arm, np.zeros((10, 6))).pose.condition.shape
    (10,)
    """
    chain = moving_chain(chain)
    length = positive(length, "length")
    J = chain.jacobian(q, "hybrid")
    return Manipulability(**{part: _measures(chain, J, part, length) for part in ROWS})


def manipulability_gradient(
    chain: Arm,
    q: Any,
    *,
    part: Part = "pose",
    length: float = 1.0,
) -> Array:
    """Gradient of Yoshikawa's measure with respect to q.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Arm to judge.
    q : (..., m) array_like or dict
        Configurations, rad or m.
    part : {"pose", "translation", "rotation"}
        Part of the tool's motion.
    length : float, default 1.0
        Length by which v is divided in the pose, m.

    Returns
    -------
    gradient : (..., m) ndarray
        Derivatives by the coordinates, per rad or m.

    Raises
    ------
    InputError
        If `chain` is no Chain or has no coordinate, `length` is not positive, or there is no such
        `part`.
    ShapeError
        If `q` has not m coordinates.
    UnknownName
        If a dict `q` names a coordinate that the chain has not.

    Notes
    -----
    dw/dq_j is the sum over a of (product of the other s_b) u_aᵀ (dJ/dq_j) v_a, with J = Σ s_a u_a
    v_aᵀ and dJ/dq_j from `Chain.hessian` (hybrid frame). Where m is at least the number of rows
    this is w tr(J⁺ dJ/dq_j) without a division, so it holds at a singularity too: there w = |…| has
    a kink, and this is the slope on the side that the signs of u and v say. Accuracy: within 1e-12
    of the measure's size (tests/analysis/dexterity/test_manipulability.py). Source: Yoshikawa 1985;
    Park 1994, Section III, for dJ/dq.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> pk.manipulability_gradient(arm, [0.0, -1.0, 1.5, -2.0, -1.5, 0.0]).shape
    (6,)
    """
    chain = moving_chain(chain)
    length = positive(length, "length")
    choice(part, ROWS, "part")
    J = scaled(chain.jacobian(q, "hybrid"), -2, part, length)
    H = scaled(chain.hessian(q, "hybrid"), -3, part, length)
    U, s, V = svd(J)
    g = _counted(chain, part)
    counted = s[..., :g]
    others = [np.delete(counted, a, -1).prod(axis=-1) for a in range(g)]
    return np.einsum(
        "...a,...ra,...rij,...ai->...j",
        np.stack(others, axis=-1),
        U[..., :g],
        H,
        V[..., :g, :],
        optimize=True,
    )


def _counted(chain: Chain, part: Part) -> int:
    """Number of singular values that count; one, which is zero, of an arm that has none."""
    return max(generic_rank(chain, part), 1)


def _measures(
    chain: Chain,
    J: Array,
    part: Part,
    length: float,
) -> Measures:
    _, s, _ = svd(scaled(J, -2, part, length))
    s = s[..., : _counted(chain, part)]
    smallest = s[..., -1]
    condition = np.full(s.shape[:-1], np.inf)
    np.divide(s[..., 0], smallest, out=condition, where=smallest != 0)
    return Measures(np.prod(s, axis=-1), condition, smallest)
