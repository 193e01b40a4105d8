"""Identification: rank and condition of a calibration, and the directions that cannot be estimated,
in words.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np

from ....errors import InputError
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.sampling import half_range
from ....results import Result
from ..design import observability
from ..measurements.inputs import parse_measurements, parse_readings
from ..measurements.measurement import per_error
from ..model.error_model import ErrorModel
from ..model.parameters import Mask, ParameterKind
from ..model.problem import Problem
from ..model.tsqr import qr_r
from . import messages

OnRankDeficiency = Literal["raise", "fix"]
RANK = 1e-9
"""Singular values below this part of the largest are those of directions that cannot be identified:
rounding is 1e-14.
"""
THERE = 1e-5
"""The same where a fit ended: errors of some mm and mrad in a direction that is seen less do not
come to a micrometre, and rounding of the normal equations is 1e-8."""
# weight of unknown frames where a direction is shared: they give way, and the arm stays nominal
_LIGHT = 1e-6


@dataclass(frozen=True, eq=False)
class Identification(Result):
    """Identifiability of the parameters from the measurements, before anything is solved.

    It is about the identification matrix at the nominal arm (at the calibrated one, where that
    shows more): d errors / d parameters, angles in rad and lengths in reaches, row and column.

    Attributes
    ----------
    size : int
        Number of parameters.
    identifiable : int
        Number of combinations of them that measurements of this kind can identify anywhere.
    rank : int
        Number that these measurements identify.
    n_equations : int
        Number of measured values.
    unidentifiable : tuple of str
        Directions that no measurement of this kind identifies, fixed at nominal values.
    unobserved : tuple of str
        Directions that other measurements of this kind would identify.
    singular_values : (rank,) ndarray
        Singular values of the identified directions.
    condition, smallest, O1, amplification : float
        Observability on the identified space, see `observability_indices`.
    """

    size: int
    identifiable: int
    rank: int
    n_equations: int
    unidentifiable: tuple[str, ...]
    unobserved: tuple[str, ...]
    singular_values: Array = field(repr=False)
    condition: float
    smallest: float
    O1: float
    amplification: float

    def summary(self) -> str:
        """Rank, condition and the directions that are not identified, as text."""
        lines = [
            f"{self.n_equations} equations for {self.identifiable} identifiable parameters: "
            f"rank {self.rank} of {self.identifiable}, condition {self.condition:.3g}, "
            f"smallest singular value {self.smallest:.3g}, O1 {self.O1:.3g}, "
            f"noise amplification index {self.amplification:.3g}"
        ]
        for words in self.unidentifiable:
            lines.append(f"unidentifiable from measurements of this kind, fixed: {words}")
        for words in self.unobserved:
            lines.append(f"unobserved by these measurements: {words}")
        return "\n".join(lines)


class RowSpace(NamedTuple):
    """Singular values (k,) of a matrix, its rank, and an orthonormal basis (P, rank) of its rows."""

    singular_values: Array
    basis: Array

    @property
    def rank(self) -> int:
        """Number of directions in the basis."""
        return self.basis.shape[1]


def identify(
    chain: Chain,
    q: Any,
    measurements: Any,
    *,
    parameters: ParameterKind | Sequence[ParameterKind] = ("screws", "home"),
    joints: Sequence[str] | None = None,
) -> Identification:
    """Identifiability of these parameters of the arm from these measurements; nothing is solved.

    Parameters
    ----------
    chain : Chain
        The nominal arm.
    q : (N, m) array_like or dict
        Joint readings, rad or m.
    measurements : Measurement, sequence of Measurement, or array_like
        As of `calibrate`.
    parameters, joints : sequence of str, optional
        As of `calibrate`.

    Returns
    -------
    identification : Identification
        Rank, observability and what is not identified, in words.

    Raises
    ------
    ShapeError, InputError, UnknownName
        As `calibrate`, but never for a lack of rank.

    Notes
    -----
    Accuracy: singular values to 1e-14 of the largest. Source: Borm and Menq 1991; Everett and Hsu
    1988 for the count 4 r + 2 p + 6 of r revolute and p prismatic joints.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> made = pk.calibration.simulated(arm, 20)
    >>> found = pk.calibration.identify(arm, made.q, made.measurements)
    >>> found.n_equations, found.identifiable, found.rank
    (120, 30, 30)
    """
    q = parse_readings(chain, q)
    sets = parse_measurements(measurements, len(q))
    problem = Problem(ErrorModel(chain, parameters, joints), q, sets)
    return identify_directions(problem)[0]


def identification_matrix(
    problem: Problem,
    q: Array | None = None,
    p: Array | None = None,
) -> Array:
    """The identification matrix (M, P) at the nominal arm, or p: angles in rad, lengths in reaches,
    row and column.
    """
    parts = scaled_jacobians(problem, q, p)
    return np.concatenate([part.reshape(-1, problem.size) for part in parts])


def scaled_jacobians(
    problem: Problem, q: Array | None = None, p: Array | None = None
) -> list[Array]:
    """The identification matrix by sets (N, d, P)."""
    if p is None:
        p = np.zeros(problem.size)
    reach = problem.model.nominal.reach
    units = [per_error(s, 1.0, reach)[:, None] for s in problem.sets]
    pairs = zip(problem.jacobians(p, q), units, strict=True)
    return [jacobian * problem.scale / unit for jacobian, unit in pairs]


def rank_at(problem: Problem, p: Array) -> int:
    """Number of directions that these measurements identify at p, by the eigenvalues of the normal
    equations, which are quick.
    """
    J = identification_matrix(problem, p=p)
    eigenvalues = np.linalg.eigvalsh(J.T @ J)
    return int(np.sum(eigenvalues > THERE**2 * eigenvalues[-1]))


def free_directions_at(
    problem: Problem,
    p: Array,
    known: Mask | None = None,
) -> Array:
    """Basis (P, k) as of `identify_directions` of what is identified at p, where a fit ended."""
    J = identification_matrix(problem, p=p)
    seen = row_space(np.concatenate([J, _prior_rows(problem, known)]), THERE)
    return _free(problem, _complement(seen.basis))


def identify_directions(
    problem: Problem,
    known: Mask | None = None,
    p: Array | None = None,
) -> tuple[Identification, Array]:
    """The identification, and a basis (P, k) in rad and reaches of what these measurements can
    move: the rest is fixed.

    Of a direction in which an unknown frame and the arm move together, the frame's part is free and
    the arm's is fixed. known (P,): parameters that a prior tells something of, as a measurement of
    each would. p: where a fit ended.
    """
    least = THERE
    if p is None:
        least = RANK
    prior = _prior_rows(problem, known)
    here = identification_matrix(problem, p=p)
    observed = row_space(np.concatenate([here, prior]), least)
    identifiable = observed
    if observed.rank < problem.size:
        width = sum(s.width for s in problem.sets)
        q = _random_configurations(problem.model.nominal, math.ceil(3 * problem.size / width))
        anywhere = identification_matrix(problem, q, p)
        identifiable = row_space(np.concatenate([anywhere, prior]), least)
    unidentifiable = _complement(identifiable.basis)
    rest = _complement(observed.basis)
    lost = rest - unidentifiable @ (unidentifiable.T @ rest)
    unobserved = _span(lost, identifiable.rank - observed.rank)
    sigma = observed.singular_values[: observed.rank]
    indices = observability.UNOBSERVED
    if len(sigma):
        indices = observability.from_singular_values(sigma, sum(map(len, problem.sets)))
    identification = Identification(
        size=problem.size,
        identifiable=identifiable.rank,
        rank=observed.rank,
        n_equations=problem.n_equations,
        unidentifiable=tuple(messages.directions(problem, unidentifiable)),
        unobserved=tuple(messages.unobserved(problem, unobserved, unidentifiable)),
        singular_values=sigma,
        **indices._asdict(),
    )
    return identification, _free(problem, rest)


def check_rank(identification: Identification, on_rank_deficiency: OnRankDeficiency) -> None:
    """Refuse a rank deficient problem. Raises: InputError that says how many measurements more, or
    what is unobserved.
    """
    needed = identification.identifiable
    if identification.rank == needed or on_rank_deficiency == "fix":
        return
    if identification.n_equations < needed:
        raise InputError(
            f"{identification.n_equations} equations for {needed} identifiable parameters: measure "
            f"at least {needed} (a pose gives 6, a point 3, a distance 1), better three times as "
            "many; or calibrate fewer parameters (parameters=, joints=), or fix what is unobserved "
            "(on_rank_deficiency='fix')"
        )
    words = "; ".join(identification.unobserved)
    raise InputError(
        f"these measurements identify {identification.rank} of {needed} parameters. Unobserved: "
        f"{words}. Measure with these joints in more positions, or estimate the rest only with "
        "on_rank_deficiency='fix'"
    )


def _prior_rows(problem: Problem, known: Mask | None) -> Array:
    """A row for each parameter that a prior tells something of."""
    if known is None:
        return np.empty((0, problem.size))
    return np.eye(problem.size)[known]


def _random_configurations(chain: Chain, count: int) -> Array:
    """Configurations with every coordinate moving, within limits or not."""
    half = half_range(chain)
    return np.random.default_rng(0).uniform(-half, half, (count, chain.dof))


def row_space(J: Array, least: float = RANK) -> RowSpace:
    """Row space of J (M, P), by the singular values above `least` of the largest."""
    _, s, Vt = np.linalg.svd(qr_r(J), full_matrices=False)
    rank = int(np.sum(s > least * s[:1]))
    return RowSpace(s, Vt[:rank].T)


def _complement(V: Array) -> Array:
    """An orthonormal basis of what is orthogonal to the columns of V (P, k)."""
    P, k = V.shape
    if k == P:  # nothing, as where everything is identified
        return np.empty((P, 0))
    Q, _ = np.linalg.qr(V, mode="complete")
    return Q[:, k:]


def _span(N: Array, count: int) -> Array:
    """An orthonormal basis of the `count` directions that the columns of N mostly point in."""
    U, _, _ = np.linalg.svd(N, full_matrices=False)
    return U[:, : max(count, 0)]


def _free(problem: Problem, fixed: Array) -> Array:
    """Basis of what may move when the directions in `fixed` are to have no component, the arm's
    part counting most.
    """
    weight = np.where(np.arange(problem.size) < problem.model_size, 1.0, _LIGHT)
    return _complement(weight[:, None] * fixed)
