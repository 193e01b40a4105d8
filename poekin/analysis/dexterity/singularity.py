"""singularity: how near an arm is to a configuration in which its tool cannot move some way, and
which way that is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np

from ...checks import choice, is_real, positive
from ...errors import InputError, quote, safe_repr
from ...groups.arrays import Array
from ...groups.vectors import norm
from ...model.chain import Chain
from ...model.coordinates import coordinates
from ...model.kinematics.arm import Arm
from ...model.sampling import angle_mask, joint_ratios
from ...results import Result
from .jacobian_part import ROWS, TOLERANCE, Part, generic_rank, moving_chain, scaled, svd
from .messages import motion_words, rate_words

Unit = Literal["rad", "m", "rad and m"]

ZERO = 1e-12
"""Quotient of a singular value and the largest, below which it is zero but for rounding."""


@dataclass(frozen=True, eq=False)
class Singularity(Result):
    """Singular values and lost motions of an arm at one configuration; the result of `singularity`.

    g below is `generic_rank`; a unit twist has the size |(ω; v / length)| = 1, and rates of size 1
    are |joint_ratios · dq| = 1, so that the unit of a coordinate does not matter.

    Attributes
    ----------
    singular : bool
        Whether the rank is below `generic_rank`.
    tolerance : float
        Quotient of a singular value and the largest, up to which a motion is lost.
    part : {"pose", "translation", "rotation"}
        Part of the tool's motion that was judged.
    length : float
        Length by which v is divided, m.
    singular_values : tuple of float
        All singular values of that part of the Jacobian per rad or m of the joints, descending.
    rank : int
        Number of singular values above the tolerance, `generic_rank` at most.
    generic_rank : int
        Largest rank at any configuration: the number of motions that the arm has at all.
    singular_direction : (6,) ndarray
        Unit twist (ω; v), base axes and the tool's origin, that the arm moves worst of those that
        it has at all; lost for good at the singularity itself. Determined up to its sign.
    singular_subspace : (g - rank, 6) ndarray
        Unit twists that are lost within tolerance.
    joint_direction : (m,) ndarray
        Rates of size 1 that move the tool least: by `smallest`, as a twist of that size.
    distance : float
        Distance of the singularity, |joint_ratios · dq| in rad (m of coordinates that slide), to
        first order: smallest ÷ |its gradient|; infinite where the gradient is zero.
    gradient_direction : (m,) ndarray
        Direction of size 1 that leads there.
    joint_ratios : (m,) ndarray
        Rad or m of the joint that each coordinate moves most, per unit of the coordinate.
    q_names : tuple of str
        Names of the coordinates.
    unit : {"rad", "m", "rad and m"}
        Unit of `distance`, and of the coordinates that are those of their joints.
    chain : Chain
        The arm.
    q : (m,) ndarray
        The configuration, rad or m.
    """

    derived: ClassVar = ("smallest", "condition")
    left_out: ClassVar = ("chain", "q")

    singular: bool
    tolerance: float
    part: Part
    length: float
    singular_values: tuple[float, ...]
    rank: int
    generic_rank: int
    singular_direction: Array
    singular_subspace: Array
    joint_direction: Array
    distance: float
    gradient_direction: Array
    joint_ratios: Array
    q_names: tuple[str, ...]
    unit: Unit
    chain: Chain = field(repr=False)
    q: Array = field(repr=False)

    @property
    def smallest(self) -> float:
        """Smallest singular value s_g of the motions that the arm has at all."""
        return self.singular_values[max(self.generic_rank, 1) - 1]

    @property
    def condition(self) -> float:
        """Condition number s_1 / s_g, infinite where s_g is zero."""
        if not self.smallest:
            return math.inf
        return self.singular_values[0] / self.smallest

    def summary(self) -> str:
        """Sentences with the lost motion, the rates that it belongs to, and the distance.

        Returns
        -------
        text : str
            One line; distances in rad and m as the coordinates are.
        """
        if not self.generic_rank:
            return (
                f"regular: the arm has no motion of this part ({self.part}) at any configuration."
            )
        largest = self.singular_values[0]
        ratio = 0.0
        if largest:
            ratio = self.smallest / largest + 0.0
        quotient = f"smallest ÷ largest singular value {ratio:.3g}, tolerance {self.tolerance:g}"
        rates = rate_words(self.q_names, self.joint_direction, self.joint_ratios)
        if self.singular:
            lost = "; and ".join(motion_words(motion) for motion in self.singular_subspace)
            nearly = ""
            if self.smallest > ZERO * largest:
                nearly = ", nearly"
            return (
                f"singular ({quotient}): the tool cannot move by {lost}. "
                f"The rates {rates} leave it where it is{nearly}."
            )
        unit = {"rad and m": "(rad and m)"}.get(self.unit, self.unit)
        near = f"to first order no singularity is within 1 {unit}"
        if self.distance <= 1:
            shares = np.abs(self.gradient_direction * self.joint_ratios)
            lead = self.q_names[int(np.argmax(shares))]
            near = (
                f"the nearest singularity is about {self.distance:.2g} {unit} away, "
                f"most of it in {quote(lead)}"
            )
        lost = f"What would be lost there: {motion_words(self.singular_direction)}"
        return f"regular ({quotient}): {near}. {lost}; the rates for it: {rates}."


def singularity(
    chain: Arm,
    q: Any,
    *,
    part: Part | None = None,
    tolerance: float = TOLERANCE,
    length: float | None = None,
) -> Singularity:
    """Singular values of the Jacobian at q, the motion that is lost, and how far off that is.

    An arm is judged by what it can do at all: it is singular where the rank of its Jacobian drops
    below the largest rank that it has at any configuration. So a planar arm of two links is
    singular where it is stretched, though it never has six motions.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Arm to judge.
    q : (m,) array_like or dict
        One finite configuration, rad or m.
    part : {"pose", "translation", "rotation"}, optional
        Part of the tool's motion. By default "translation" where the position of the tool's origin
        alone takes all coordinates (a planar arm of two links, an elbow of three joints, a gantry),
        else "pose".
    tolerance : float, default 1e-3
        Quotient of a singular value and the largest, up to which a motion is lost.
    length : float, optional
        Length by which v is divided, m; by default the chain's reach, so that the size of a large
        arm does not matter.

    Returns
    -------
    found : Singularity
        Rank, lost motions, and the distance to the singularity.

    Raises
    ------
    InputError
        If `chain` is no Chain or has no coordinate, `q` is not one finite configuration, there is
        no such `part`, `tolerance` is not between 0 and 1, or `length` is not positive.
    ShapeError
        If `q` has not m coordinates.
    UnknownName
        If a dict `q` names a coordinate that the chain has not.

    See Also
    --------
    manipulability : Yoshikawa's measure and condition numbers of many configurations.

    Notes
    -----
    The hybrid Jacobian per rad or m of the joints is J = Σ s_a u_a v_aᵀ, with v ÷ length in the rows
    of translation; the ratios of gears or degrees do not change the verdict. g is the
    largest rank of J, found at random configurations. u_g is the tool's motion that costs most, v_g
    the rates it takes, and ds_g/dq_j = u_gᵀ (dJ/dq_j) v_g, by `Chain.hessian`, says how far q is
    from s_g = 0, where no motion of the arm has a component along u_g. At s_g = 0 an arm of g < 6
    lacks more motions than are lost there: lost are those that it gets back first as q moves on.

    Accuracy: singular values within 1e-14 of the largest; `singular_direction` and
    `joint_direction` as well as the gap to the next singular value allows
    (tests/analysis/dexterity/test_singularity.py). Source: Yoshikawa 1985; Park 1994, Section III.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> joints = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 0.5)]
    >>> links = pk.Chain.from_space(joints, pk.se3.exp([0, 0, 0, 1, 0, 0]))
    >>> stretched = pk.singularity(links, [0.0, 0.0])
    >>> stretched.singular, stretched.rank, stretched.generic_rank
    (True, 1, 2)
    >>> pk.singularity(links, [0.0, 1.2]).singular
    False
    """
    chain = moving_chain(chain)
    L = chain.reach if length is None else positive(length, "length")
    if part is None:
        part = _default_part(chain)
    choice(part, ROWS, "part")
    if not is_real(tolerance) or not 0 < tolerance < 1:
        raise InputError(
            f"tolerance: expected a number between 0 and 1, got {safe_repr(tolerance)}"
        )
    q = _configuration(chain, q)
    ratios = joint_ratios(chain)
    J = scaled(chain.jacobian(q, "hybrid") / ratios, -2, part, L)
    H = chain.hessian(q, "hybrid") / np.outer(ratios, ratios)
    H = scaled(H, -3, part, L)
    U, s, V = svd(J)
    g = generic_rank(chain, part, min(float(tolerance), TOLERANCE))
    last = max(g, 1) - 1
    rank = min(int((s > tolerance * s[0]).sum()), g)
    if rank < g < len(J):
        U = _with_lost_motions(U, s, J, H, g)
    slope = np.einsum("r,rij,i->j", U[:, last], H, V[last])
    steep = norm(slope)
    motions = np.array([_positive(_twist(u, part, L)) for u in U.T])
    return Singularity(
        singular=rank < g,
        tolerance=float(tolerance),
        part=part,
        length=L,
        singular_values=tuple(map(float, s)),
        rank=rank,
        generic_rank=g,
        singular_direction=motions[last],
        singular_subspace=motions[rank:g],
        joint_direction=_positive(V[last]) / ratios,
        distance=_distance(s[last], s[0], steep),
        gradient_direction=-slope / steep / ratios if steep else np.zeros(chain.dof),
        joint_ratios=ratios,
        q_names=chain.q_names,
        unit=_unit(chain),
        chain=chain,
        q=q,
    )


def _configuration(chain: Chain, q: Any) -> Array:
    q = coordinates(q, chain.q_names)
    if q.ndim != 1 or not np.isfinite(q).all():
        raise InputError(
            f"q: expected one finite configuration ({chain.dof},), got {safe_repr(q.tolist())}"
        )
    return q


def _default_part(chain: Chain) -> Part:
    """The translation of an arm whose coordinates all go into the position of its tool's origin."""
    if chain.dof <= 3 and generic_rank(chain, "translation") == chain.dof:
        return "translation"
    return "pose"


def _with_lost_motions(
    U: Array,
    s: Array,
    J: Array,
    H: Array,
    g: int,
) -> Array:
    """U with the motions that come back first to first order, where J has lost some of g for good.

    The left null space of J has those and others that the arm never has. Its block of dJ/dq_j
    between both null spaces says which of them grow.
    """
    rank = int((s > ZERO * s[0]).sum())
    if rank >= g:
        return U
    left, _, right = np.linalg.svd(J)
    growth = np.einsum("ra,rij,bi->ajb", left[:, rank:], H, right[rank:])
    order = np.linalg.svd(growth.reshape(len(growth), -1))[0]
    U = U.copy()
    U[:, rank:g] = left[:, rank:] @ order[:, : g - rank]
    return U


def _distance(smallest: float, largest: float, steep: float) -> float:
    """Distance of s_g = 0 to first order."""
    # s_g is known to some u of s_1: below that, q is where s_g is zero
    if smallest <= 1e-15 * largest:
        return 0.0
    if steep:
        return float(smallest / steep)
    return math.inf


def _twist(u: Array, part: Part, length: float) -> Array:
    """The twist (6,) that a left singular vector stands for."""
    twist = np.zeros(6)
    twist[ROWS[part]] = u
    return twist * np.repeat([1.0, length], 3)


def _positive(x: Array) -> Array:
    """x or -x: the one whose largest component is positive."""
    if x[np.argmax(np.abs(x))] < 0:
        x = -x
    return x + 0.0


def _unit(chain: Chain) -> Unit:
    angles = angle_mask(chain)
    if angles.all():
        return "rad"
    if angles.any():
        return "rad and m"
    return "m"
