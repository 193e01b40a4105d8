"""exp and log of SO(3) and SE(3), whoever computes them, against 60 digits: the cases over angle,
and the judgement.

Everybody gets the same cases. The truth of exp is that of the float64 twist, the truth of log that
of the float64 matrix as it stands; the unit is what float64 can attain
(`poekin.testing.accuracy.error_bounds`). Nobody is blamed falsely: who is far off at an ordinary
angle has another convention than we say, and is not judged; the reference behind a worst case is
confirmed by a matrix exponential that shares no code with the oracle; within 8 u of π both signs
are right.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from poekin.testing.accuracy import error_bounds
from poekin.testing.conform import confirm
from poekin.testing.oracles import exact

from ..accuracy import worst_cases

FUNCTIONS = {
    "exp_so3": "exp SO(3)",
    "log_so3": "log SO(3)",
    "exp_se3": "exp SE(3)",
    "log_se3": "log SE(3)",
}
SHAPES = {"exp_so3": (3, 3), "log_so3": (3,), "exp_se3": (4, 4), "log_se3": (6,)}
ORDINARY = np.array([0.7, -0.5, 0.8, 0.3, -0.2, 0.6])
FOREIGN = 1e6
"""Who errs by more than this at the ordinary twist (1e-10 or so) does not err: it computes
something else.
"""


class Band(NamedTuple):
    """Angles θ from low to high, or π - θ from low to high."""

    low: float
    high: float
    before_pi: bool

    @property
    def place(self) -> float:
        """Its geometric middle: where it stands on a logarithmic axis."""
        return math.sqrt(self.low * self.high)


class Case(NamedTuple):
    """A float64 argument (of a function in FUNCTIONS), its band, the exact result, and what float64
    can attain.
    """

    argument: np.ndarray
    band: Band
    truth: np.ndarray
    bound: error_bounds.Bound

    @property
    def rotation_vector(self) -> np.ndarray:
        """The exact ω that belongs to it."""
        return self.truth[:3] if self.truth.ndim == 1 else exact.exactly(self.argument[:3])

    @property
    def angle(self) -> float:
        """θ."""
        return float(exact.norm(self.rotation_vector))

    @property
    def gap(self) -> float:
        """π - θ, all digits of it."""
        return float(exact.mp.pi - exact.norm(self.rotation_vector))


@dataclass
class Finding:
    """What came of one function of one library: ratio error ÷ attainable of each case (inf: no
    finite result).
    """

    who: str
    function: str
    ratios: np.ndarray
    results: list[Any]
    faults: dict[int, str] = field(default_factory=dict)
    not_judged: str = ""

    @property
    def worst(self) -> int | None:
        """Index of the worst finite result; None where there is none."""
        finite = np.where(np.isfinite(self.ratios), self.ratios, -1.0)
        return int(finite.argmax()) if len(finite) and finite.max() >= 0 else None

    @property
    def figure(self) -> float:
        """The worst ratio of all: inf where a result was NaN, infinite, of a wrong shape, or an
        exception.
        """
        return float(self.ratios.max()) if len(self.ratios) else math.inf

    def curve(self, cases: list[Case], bands: Iterable[Band]) -> list[float]:
        """The worst ratio in each band; NaN where it holds no case."""
        found: dict[Band, float] = {}
        for case, ratio in zip(cases, self.ratios, strict=True):
            found[case.band] = max(found.get(case.band, 0.0), float(ratio))
        return [found.get(band, math.nan) for band in bands]


def bands(per_decade: int = 3) -> list[Band]:
    """Angles from 1e-12 to π, then the gap π - θ from 1 down to 1e-15."""
    up = np.geomspace(1e-12, math.pi, round(12.5 * per_decade) + 1)
    down = np.geomspace(1.0, 1e-15, 15 * per_decade + 1)
    rising = [Band(float(a), float(b), False) for a, b in pairwise(up)]
    return rising + [Band(float(b), float(a), True) for a, b in pairwise(down)]


def band_of(angle: float, among: Iterable[Band]) -> Band | None:
    """The band of angles, not of gaps, that holds an angle."""
    return next(
        (band for band in among if not band.before_pi and band.low <= angle <= band.high), None
    )


def twists(
    rng: np.random.Generator, among: Iterable[Band], count: int
) -> Iterator[tuple[Band, np.ndarray]]:
    """count random twists in each band; the length of v is 0.01 to 100, whatever the angle is."""
    for band in among:
        x = np.exp(rng.uniform(math.log(band.low), math.log(band.high), count))
        angles = math.pi - x if band.before_pi else x
        v = rng.normal(size=(count, 3))
        v *= 10.0 ** rng.uniform(-2, 2, (count, 1)) / np.linalg.norm(v, axis=1, keepdims=True)
        yield from (
            (band, x)
            for x in np.concatenate([angles[:, None] * worst_cases.axes(rng, count), v], axis=1)
        )


def referenced(some: Iterable[tuple[Band, np.ndarray]]) -> dict[str, list[Case]]:
    """The cases of each function, from the same twists: exp takes the twist, log its exponential,
    rounded once.
    """
    cases: dict[str, list[Case]] = {name: [] for name in FUNCTIONS}
    for band, xi in some:
        found = of_twist(xi, band)
        for name, case in (found | of_pose(exact.rounded(found["exp_se3"].truth), band)).items():
            cases[name].append(case)
    return cases


def of_twist(xi: np.ndarray, band: Band) -> dict[str, Case]:
    """The two cases of exp at a twist (6,)."""
    T, bound = exact.exp(xi), error_bounds.exp_bound(xi)
    return {
        "exp_so3": Case(xi[:3], band, T[:3, :3], bound._replace(linear=exact.mp.zero)),
        "exp_se3": Case(xi, band, T, bound),
    }


def of_pose(T: np.ndarray, band: Band) -> dict[str, Case]:
    """The two cases of log at a pose (4, 4), as it stands."""
    xi = exact.log(T)
    bound = error_bounds.log_bound(xi)
    return {
        "log_so3": Case(T[:3, :3].copy(), band, xi[:3], bound._replace(linear=exact.mp.zero)),
        "log_se3": Case(T, band, xi, bound),
    }


def judged(
    who: str,
    offered: Mapping[str, Callable[[np.ndarray], Any]],
    cases: Mapping[str, list[Case]],
    before: Mapping[str, Finding] | None = None,
) -> dict[str, Finding]:
    """A finding for each function that a library offers; an exception is a finding too, and the run
    goes on.

    before: findings of the first of these cases, which go on from there.
    """
    findings = dict(before or {})
    for name in FUNCTIONS:
        if name not in offered:
            continue
        if name not in findings:
            foreign = _foreign(name, offered[name])
            findings[name] = foreign or Finding(who, name, np.empty(0), [])
            findings[name].who = who
        if not findings[name].not_judged:
            _continue(findings[name], offered[name], cases[name])
    return findings


def other_sign(case: Case, result: np.ndarray) -> bool:
    """Whether a wrong logarithm is near the one with the opposite ω, which is one turn the other
    way round.
    """
    if case.truth.ndim != 1:
        return False
    truth, w = exact.rounded(case.truth[:3]), np.asarray(result)[:3]
    return bool(np.linalg.norm(w + truth) < 0.1 < np.linalg.norm(w - truth))


def ratio(case: Case, result: np.ndarray) -> float:
    """Error ÷ attainable error of a finite result, the worse of the angular and the linear part."""
    if case.truth.ndim == 1 and case.gap < error_bounds.BOTH_SIGNS:
        return error_bounds.ratio_to(case.truth, result)
    E = exact.exactly(result) - case.truth
    size = len(case.truth)
    angular, linear = (E[:3], E[3:]) if E.ndim == 1 else (E[:3, :3], E[:3, 3:])
    worst = _quotient(exact.norm(angular), case.bound.angular)
    worst = max(worst, _quotient(exact.norm(linear), case.bound.linear)) if linear.size else worst
    return math.inf if E.ndim == 2 and size == 4 and np.any(E[3] != 0) else worst


def confirmed(case: Case) -> bool:
    """Whether the exact result of a case stands against mpmath's own matrix exponential: no code of
    the oracle's.

    exp: they agree. log: |ω| <= π, the exponential of the logarithm has the translation of the
    argument and is its polar factor P (Pᵀ R is symmetric, and P is near R).
    """
    judge = confirm.is_exp if case.truth.ndim == 2 else confirm.is_log
    return judge(case.argument, case.truth)


def _continue(finding: Finding, function: Callable[[np.ndarray], Any], cases: list[Case]) -> None:
    """Judge the cases that a finding does not have yet."""
    ratios = []
    for case in cases[len(finding.results) :]:
        result, fault = _called(function, case.argument, SHAPES[finding.function])
        if fault:
            finding.faults[len(finding.results)] = fault
        finding.results.append(result)
        ratios.append(math.inf if fault else ratio(case, result))
    finding.ratios = np.concatenate([finding.ratios, ratios])


def _foreign(name: str, function: Callable[[np.ndarray], Any]) -> Finding | None:
    """A finding "not judged" for who does not even know the ordinary twist."""
    ordinary = referenced([(Band(1.0, 2.0, False), ORDINARY)])[name][0]
    result, fault = _called(function, ordinary.argument, SHAPES[name])
    if not fault and ratio(ordinary, result) < FOREIGN:
        return None
    reason = fault or "another convention than its adapter says"
    return Finding(
        "",
        name,
        np.array([]),
        [],
        not_judged=f"{reason}, at the ordinary angle {ordinary.angle:.2f} rad",
    )


def _called(
    function: Callable[[np.ndarray], Any], argument: np.ndarray, shape: tuple[int, ...]
) -> tuple[Any, str]:
    """Result and fault; the argument is a copy, so that nobody can change the next one's."""
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            result = np.asarray(function(argument.copy()), dtype=float)
    except Exception as error:  # noqa: BLE001  a peer may raise whatever it likes: that is what is reported
        return None, f"{type(error).__name__}: {error}"
    if result.shape != shape:
        return result, f"shape {result.shape}"
    if np.isnan(result).any():
        return result, "NaN"
    return result, "" if np.isfinite(result).all() else "infinite"


def _quotient(error: Any, bound: Any) -> float:
    return float(error / bound) if bound else (0.0 if error == 0 else math.inf)
