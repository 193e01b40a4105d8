"""singularity: how near an arm is to a configuration in which its tool cannot move some way, and
which way that is.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import InputError, quote, safe_repr
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.coordinates import coordinates
from .manipulability import check, check_part, scaled, svd

__all__ = ["Singularity", "singularity"]

TOLERANCE = 1e-3
"""Least quotient of the smallest and the largest singular value at which an arm counts as regular.
"""


@dataclass(frozen=True, eq=False)
class Singularity:
    """Singular values and lost motions of an arm at one configuration.

    Attributes: singular, whether smallest ≤ tolerance · largest; tolerance; part, length (m, by
    which v is divided); singular_values (r), descending; rank, of those above the tolerance.
    singular_direction (6): the twist (omega; v), base axes and the tool's origin, that the arm moves worst, with
    the unit size |(omega; v / length)| = 1: lost for good at the singularity itself. It is
    determined up to its sign.
    singular_subspace (r - rank, 6): every such twist that is lost within tolerance.
    joint_direction (m): the rates (|joint_direction| = 1) that move the tool least: by `smallest` as a twist of that
    size.
    distance: how far the singularity is, sqrt(Σ dq²) in rad (m for coordinates that slide), to
    first order:
    smallest ÷ |its gradient|; infinite where the gradient is zero. gradient_direction (m): the unit direction
    that leads there. words: all this in sentences.
    """

    singular: bool
    tolerance: float
    part: str
    length: float
    singular_values: tuple[float, ...]
    rank: int
    singular_direction: Array
    singular_subspace: Array
    joint_direction: Array
    distance: float
    gradient_direction: Array
    words: str

    @property
    def smallest(self) -> float:
        """s_r, the smallest singular value."""
        return self.singular_values[-1]

    @property
    def condition(self) -> float:
        """s_1 / s_r, infinite where s_r is zero."""
        if not self.smallest:
            return math.inf
        return self.singular_values[0] / self.smallest

    def as_dict(self) -> dict[str, object]:
        """Everything as plain dicts, lists, strings and numbers; an infinite number is None."""
        arrays = {
            name: getattr(self, name).tolist()
            for name in (
                "singular_direction",
                "singular_subspace",
                "joint_direction",
                "gradient_direction",
            )
        }
        numbers = {name: _finite(getattr(self, name)) for name in ("condition", "distance")}
        plain = {
            name: getattr(self, name)
            for name in ("singular", "tolerance", "part", "length", "rank", "smallest")
        }
        return {
            **plain,
            "singular_values": list(self.singular_values),
            **numbers,
            **arrays,
            "words": self.words,
        }

    def to_json(self) -> str:
        """`as_dict` as JSON text."""
        return json.dumps(self.as_dict(), indent=2, allow_nan=False)

    def __str__(self) -> str:
        return self.words


def singularity(
    chain: Chain,
    q: Any,
    *,
    part: str = "pose",
    tolerance: float = TOLERANCE,
    length: float | None = None,
) -> Singularity:
    """Singular values of the hybrid Jacobian at q, the motion that is or gets lost, and how far off
    that is.

    J = Σ s_a u_a v_a^T with v ÷ length in the rows of translation: u_r is the tool's motion that
    costs most, v_r the rates it takes, and ds_r/dq_j = u_r^T (dJ/dq_j) v_r by `Chain.hessian` says
    how far q is from s_r = 0. No motion of the arm has a component along u_r at s_r = 0. With fewer
    coordinates than rows r = m: what the arm can never do does not count as lost, but at s_r = 0
    itself u_r is then only one of the motions that it has not.

    Parameters: chain; q (m,) or a dict, one finite configuration; part "pose", "translation" or
    "rotation" (of the tool's origin, for arms that are only asked for that); tolerance, of smallest
    ÷ largest; length, m, the chain's reach when it is not given, so that the size of a large arm
    does not matter.
    Returns: Singularity. Raises: InputError (also for a chain without coordinates), ShapeError,
    UnknownName.
    Accuracy: singular values within 1e-14 of the largest; singular_direction and joint_direction as
    well as the gap to the next singular value allows (tests/analysis/dexterity/test_singularity.py). Source: Yoshikawa
    1985; Park 1994, Section III.
    """
    check(chain, 1.0 if length is None else length)
    check_part(part)
    if not isinstance(tolerance, (int, float, np.floating)) or not 0 < tolerance < 1:
        raise InputError(
            f"tolerance: expected a number between 0 and 1, got {safe_repr(tolerance)}"
        )
    q = coordinates(q, chain.q_names)
    if q.ndim != 1 or not np.isfinite(q).all():
        raise InputError(
            f"q: expected one finite configuration ({chain.dof},), got {safe_repr(q.tolist())}"
        )
    L = float(chain.reach if length is None else length)
    U, s, V = svd(scaled(chain.jacobian(q, "hybrid"), -2, part, L))
    H = scaled(chain.hessian(q, "hybrid"), -3, part, L)
    rank = int((s > tolerance * s[0]).sum())
    slope = np.einsum("r,rij,i->j", U[:, -1], H, V[-1])
    steep = float(np.linalg.norm(slope))
    distance = math.inf
    # s_r is known to some u of s_1: below that, q is where s_r is zero
    if s[-1] <= 1e-15 * s[0]:
        distance = 0.0
    elif steep:
        distance = float(s[-1] / steep)
    motions = np.array([_positive(_twist(u, part, L)) for u in U.T])
    lost = motions[-1]
    idle = _positive(V[-1])
    towards = np.zeros(chain.dof)
    if steep:
        towards = -slope / steep
    told = motions[min(rank, len(s) - 1) :]
    words = _words(chain, told, s, rank, idle, distance, towards, tolerance)
    return Singularity(
        singular=rank < len(s),
        tolerance=float(tolerance),
        part=part,
        length=L,
        singular_values=tuple(map(float, s)),
        rank=rank,
        singular_direction=lost,
        singular_subspace=motions[rank:],
        joint_direction=idle,
        distance=distance,
        gradient_direction=towards,
        words=words,
    )


def _twist(u: Array, part: str, length: float) -> Array:
    """The twist (6,) that a left singular vector stands for."""
    if part == "rotation":
        return np.concatenate([u, np.zeros(3)])
    if part == "translation":
        return np.concatenate([np.zeros(3), length * u])
    return u * np.repeat([1.0, length], 3)


def _positive(x: Array) -> Array:
    """x or -x: the one whose largest component is positive."""
    if x[np.argmax(np.abs(x))] < 0:
        x = -x
    return x + 0.0


def _words(
    chain: Chain,
    motions: Array,
    s: Array,
    rank: int,
    idle: Array,
    distance: float,
    towards: Array,
    tolerance: float,
) -> str:
    ratio = 0.0
    if s[0]:
        ratio = s[-1] / s[0] + 0.0
    quotient = f"smallest ÷ largest singular value {ratio:.3g}, tolerance {tolerance:g}"
    how = [motion_words(motion) for motion in motions]
    names = [
        (name, abs(rate)) for name, rate in zip(chain.q_names, idle, strict=True) if abs(rate) > 0.1
    ]
    rates = ", ".join(
        f"{quote(n)} {idle[chain.q_names.index(n)]:+.2f}"
        for n, _ in sorted(names, key=lambda x: -x[1])
    )
    if rank < len(s):
        lost = "; and ".join(how)
        nearly = ""
        if s[-1] > 1e-12 * s[0]:
            nearly = ", nearly"
        return (
            f"singular ({quotient}): the tool cannot move by {lost}. "
            f"The rates {rates} leave it where it is{nearly}."
        )
    near = f"to first order no singularity is within 1 {_unit(chain)}"
    if distance <= 1:
        lead = chain.q_names[int(np.argmax(np.abs(towards)))]
        near = f"the nearest singularity is about {distance:.2g} {_unit(chain)} away, most of it in {quote(lead)}"
    return f"regular ({quotient}): {near}. What would be lost there: {how[0]}; the rates for it: {rates}."


def motion_words(V: Array) -> str:
    """A twist (6,) in base axes at the tool's origin, as the end of a sentence: "turning about the
    base's z axis".
    """
    w = np.linalg.norm(V[:3])
    v = np.linalg.norm(V[3:])
    # 2 cm per rad, and 1/50 rad per m, are too little to be told
    if v <= 0.02 * w:
        return f"turning about {_direction(V[:3])}"
    if w <= 0.02 * v:
        return f"moving along {_direction(V[3:])}"
    turning = f"turning about {_direction(V[:3])}"
    moving = f"moving along {_direction(V[3:])}"
    if v > w:
        return f"{moving} while {turning} by {w / v:.3g} rad per m"
    return f"{turning} while its origin is {moving} by {v / w:.3g} m per rad"


def _direction(x: Array) -> str:
    """An axis of the base, where x is within a degree of one, or x as a unit vector."""
    e = x / np.linalg.norm(x)
    k = int(np.argmax(np.abs(e)))
    if abs(e[k]) >= math.cos(math.radians(1)):
        return f"the base's {'xyz'[k]} axis"
    return "({})".format(", ".join(f"{value + 0.0:.2f}" for value in np.round(e, 2)))


def _unit(chain: Chain) -> str:
    kinds = {"rad" if chain.is_angle(k) else "m" for k in range(chain.dof)}
    return kinds.pop() if len(kinds) == 1 else "(rad and m)"


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
