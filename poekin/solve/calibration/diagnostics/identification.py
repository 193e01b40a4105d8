"""What measurements can tell about an arm: rank, condition, the directions that they cannot see, in
words.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.sampling import half_range
from ..design import indices
from ..model.parameters import Arm
from ..model.problem import Problem, readings, sets_of
from ..model.tsqr import triangle
from . import messages

RANK = 1e-9
"""Singular values below this part of the largest are those of directions that cannot be seen:
rounding is 1e-14.
"""
THERE = 1e-5
"""The same where a fit ended: errors of some mm and mrad in a direction that is seen less do not
come to a micrometre, and rounding of the normal equations is 1e-8."""
# weight of unknown frames where a direction is shared: they give way, and the arm stays nominal
_LIGHT = 1e-6


@dataclass(frozen=True, eq=False)
class Identification:
    """What the measurements at hand can tell, before anything is solved.

    All of it is about the identification matrix at the nominal arm (at the calibrated one, where
    that shows more):
    d errors / d parameters, angles in rad, lengths in reaches, row and column. size: parameters;
    expected: how many combinations of them any measurements of this kind can see; rank: how many
    these can; numbers: how many numbers were measured. held: what no measurement of this kind can
    see, held where it is nominal; unseen: what others of this kind would see. singular_values
    (rank,); condition, smallest (singular value), O1 and amplification: observability on the space
    that is seen, see `indices`.
    """

    size: int
    expected: int
    rank: int
    numbers: int
    held: tuple[str, ...]
    unseen: tuple[str, ...]
    singular_values: Array = field(repr=False)
    condition: float
    smallest: float
    O1: float
    amplification: float

    def __str__(self) -> str:
        lines = [
            f"{self.numbers} numbers for {self.expected} parameters: rank {self.rank} of {self.expected}, "
            f"condition {self.condition:.3g}, smallest singular value {self.smallest:.3g}, O1 {self.O1:.3g}, "
            f"noise amplification index {self.amplification:.3g}"
        ]
        lines += [f"held, as no measurement of this kind sees it: {words}" for words in self.held]
        return "\n".join(
            lines + [f"not seen by these measurements: {words}" for words in self.unseen]
        )


def identify(
    arm: Chain, q: Any, measurements: Any, *, parameters: Sequence[str] = ("screws", "home"),
    joints: Sequence[str] | None = None,
) -> Identification:  # fmt: skip
    """What these measurements can tell about these parameters of the arm. Nothing is solved.

    Parameters: as `calibrate`. Returns: Identification. Raises: as `calibrate`, but never for a
    lack of rank.
    Accuracy: singular values to 1e-14 of the largest. Source: Borm and Menq 1991; Everett and Hsu
    1988 for the count
    4 r + 2 p + 6 of r revolute and p prismatic joints.
    """
    q = readings(arm, q)
    problem = Problem(Arm(arm, parameters, joints), q, sets_of(measurements, len(q)))
    return judged(problem)[0]


def normalised(problem: Problem, q: Array | None = None, p: Array | None = None) -> Array:
    """The identification matrix (M, P) at the nominal arm, or p: angles in rad, lengths in reaches,
    row and column.
    """
    reach = problem.arm.nominal.reach
    rows = []
    for s, slopes in zip(
        problem.sets, problem.slopes(np.zeros(problem.size) if p is None else p, q), strict=True
    ):
        unit = np.array([1.0] * s.angular + [reach] * (s.width - s.angular))
        rows.append((slopes * problem.scale / unit[:, None]).reshape(-1, problem.size))
    return np.concatenate(rows) if rows else np.empty((0, problem.size))


def seen_at(problem: Problem, p: Array) -> int:
    """How many directions these measurements see at p, by the eigenvalues of the normal equations,
    which are quick.
    """
    J = normalised(problem, p=p)
    eigenvalues = np.linalg.eigvalsh(J.T @ J)
    return int(np.sum(eigenvalues > THERE**2 * eigenvalues[-1]))


def movable_at(problem: Problem, p: Array, known: NDArray[np.bool_] | None = None) -> Array:
    """What these measurements can move at p, where a fit ended: a basis (P, k) as of `judged`."""
    _, seen = _space(np.concatenate([normalised(problem, p=p), _told(problem, known)]), THERE)
    return _free(problem, _rest(seen))


def judged(
    problem: Problem, known: NDArray[np.bool_] | None = None, p: Array | None = None
) -> tuple[Identification, Array]:
    """The identification, and a basis (P, k) in rad and reaches of what these measurements can
    move: the rest is held.

    Of a direction in which an unknown frame and the arm move together, the frame's part is free and
    the arm's is held. known (P,): parameters that a prior tells something of, as a measurement of
    each would. p: where a fit ended.
    """
    least, told = RANK if p is None else THERE, _told(problem, known)
    s, seen = _space(np.concatenate([normalised(problem, p=p), told]), least)
    rank, any_seen = seen.shape[1], seen
    if rank < problem.size:
        count = max(1, -(-3 * problem.size // max(sum(m.width for m in problem.sets), 1)))
        anywhere = normalised(problem, _anywhere(problem.arm.nominal, count), p)
        _, any_seen = _space(np.concatenate([anywhere, told]), least)
    seen_by = (
        indices.of_singular_values(s[:rank], max(sum(map(len, problem.sets)), 1)) if rank else None
    )
    blind, unseen = _rest(any_seen), _rest(seen)
    lost = unseen - blind @ (blind.T @ unseen)
    identification = Identification(
        size=problem.size,
        expected=any_seen.shape[1],
        rank=rank,
        numbers=problem.numbers,
        held=tuple(messages.directions(problem, blind)),
        unseen=tuple(messages.unseen(problem, _span(lost, any_seen.shape[1] - rank), blind)),
        singular_values=s[:rank],
        condition=float(seen_by.condition) if seen_by else np.inf,
        smallest=float(seen_by.smallest) if seen_by else 0.0,
        O1=float(seen_by.O1) if seen_by else 0.0,
        amplification=float(seen_by.amplification) if seen_by else 0.0,
    )
    return identification, _free(problem, unseen)


def checked(identification: Identification, deficient: str) -> None:
    """Refuse what cannot be solved. Raises: InputError that says how many measurements more, or
    what is not seen.
    """
    if identification.rank == identification.expected or deficient == "hold":
        return
    if identification.numbers < identification.expected:
        raise InputError(
            f"{identification.numbers} numbers were measured, and {identification.expected} parameters are to be found:"
            f" measure at least {identification.expected} (a pose tells 6, a point 3, a distance 1), better three times"
            " as many; or find less (parameters=, joints=), or hold what is not seen (deficient='hold')"
        )
    words = "; ".join(identification.unseen)
    raise InputError(
        f"these measurements see {identification.rank} of {identification.expected} parameters. Not seen: {words}."
        " Measure with these joints in more positions, or solve the rest only with deficient='hold'"
    )


def _told(problem: Problem, known: NDArray[np.bool_] | None) -> Array:
    """A row for each parameter that a prior tells something of."""
    return np.eye(problem.size)[np.zeros(problem.size, bool) if known is None else known]


def _anywhere(arm: Chain, count: int) -> Array:
    """Configurations with every coordinate moving, within limits or not."""
    half = half_range(arm)
    return np.random.default_rng(0).uniform(-half, half, (count, arm.dof))


def _space(J: Array, least: float) -> tuple[Array, Array]:
    """Singular values, and the right singular vectors (P, rank) of those above `least` of the
    largest.
    """
    _, s, Vt = np.linalg.svd(triangle(J), full_matrices=False)
    rank = int(np.sum(s > least * s[:1]))
    return s, Vt[:rank].T


def _rest(V: Array) -> Array:
    """An orthonormal basis of what is orthogonal to the columns of V (P, k)."""
    P, k = V.shape
    if k in (0, P):  # all or nothing, as where everything is seen
        return np.eye(P)[:, k:]
    return np.linalg.qr(V, mode="complete")[0][:, k:]


def _span(N: Array, count: int) -> Array:
    """An orthonormal basis of the `count` directions that the columns of N mostly point in."""
    return np.linalg.svd(N, full_matrices=False)[0][:, : max(count, 0)]


def _free(problem: Problem, blind: Array) -> Array:
    """What may move when the directions in `blind` are to have no component, the arm's part
    counting most.
    """
    weight = np.where(np.arange(problem.size) < problem.arm_size, 1.0, _LIGHT)
    return _rest(weight[:, None] * blind)
