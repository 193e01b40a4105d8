"""`python -m benchmarks.hunt [CASES] [--seed SEED]`: the worst error ÷ attainable of exp and log on
SE(3), hunted.

Random cases first, then hill climbing: the worst cases so far are changed a little, by relative
steps of 1e-16 to 0.1, and what is worse is kept. Errors are those of
`poekin.testing.accuracy.error_bounds`, in extended precision: a hunt judges many more cases than 60
digits allow. Angles are those where that is enough: up to 10 rad for exp, 0.05 rad to π for log.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from poekin import se3
from poekin.testing.accuracy.error_bounds import UNIT

from .accuracy import longdouble_oracle, worst_cases

Function = Callable[[np.ndarray], np.ndarray]
"""exp: twists (N, 6) -> poses (N, 4, 4); log: poses -> twists."""
SMALLEST = {"exp": 1e-10, "log": 0.05}
LARGEST_EXP = 10.0
GAP = 1e-9
"""log is hunted up to π minus this: closer, either sign may be right."""
CHUNK = 20_000
KEPT = 300
"""How many of the worst cases are changed."""


class Ratios(NamedTuple):
    """Error ÷ attainable of each case (N,): of the angular part, R or ω, and of the linear part, t
    or v.
    """

    angular: np.ndarray
    linear: np.ndarray


@dataclass(frozen=True)
class Quantity:
    """What is hunted: its name, whether it is exp's or log's, and which field of `Ratios`."""

    name: str
    function: str
    part: int


QUANTITIES = (
    Quantity("R of exp", "exp", 0),
    Quantity("p of exp", "exp", 1),
    Quantity("ω of log", "log", 0),
    Quantity("v of log", "log", 1),
)


class Effort(NamedTuple):
    """Random cases of each quantity, and rounds of a fifth as many hunted ones (at most CHUNK)."""

    cases: int
    rounds: int


@dataclass
class Worst:
    """The worst ratio of random cases, that of hunted ones too, its twist (6,), and how many cases
    were judged.
    """

    random: float
    hunted: float
    twist: np.ndarray
    cases: int


def ratios(
    quantity: Quantity, function: Function, xi: np.ndarray, rng: np.random.Generator
) -> Ratios:
    """The ratios of exp at twists (N, 6), or of log at their exponentials, some with entries that
    are off by an ulp.
    """
    if quantity.function == "exp":
        return exp_ratios(xi, _called(function, xi, (4, 4)))
    T = longdouble_oracle.exp(xi).astype(float)
    off = (
        rng.integers(-2, 3, (len(xi), 3, 3))
        * (rng.random((len(xi), 3, 3)) < 0.3)
        * (rng.random((len(xi), 1, 1)) < 0.4)
    )
    T[:, :3, :3] *= 1 + UNIT * off
    return log_ratios(T, _called(function, T, (6,)))


def exp_ratios(xi: np.ndarray, T: np.ndarray) -> Ratios:
    """Of results T (N, 4, 4) at xi (N, 6); inf where a result is not finite."""
    truth = longdouble_oracle.exp(xi)
    theta, t = _norm(xi[:, :3]), truth[:, :3, 3]
    R = _norm((T - truth)[:, :3, :3].reshape(-1, 9)) / (1 + math.sqrt(2) * theta)
    size = _norm(t) + _norm(xi[:, 3:])
    return _finished(
        R,
        _norm(T[:, :3, 3] - t),
        size,
        lambda k: theta[k] * _norm(_slope(xi[k], t[k]).reshape(-1, 9)),
    )


def log_ratios(T: np.ndarray, xi: np.ndarray) -> Ratios:
    """Of results xi (N, 6) at T (N, 4, 4); inf where a result is not finite."""
    truth = longdouble_oracle.log(T)
    theta, t = _norm(truth[:, :3]), T[:, :3, 3]
    kappa = theta / 2 / np.sin(theta / 2)
    w = _norm((xi - truth)[:, :3]) / (theta * (1 + 1.22 * kappa * np.minimum(1, 1 / theta)))
    size = _norm(truth[:, 3:]) + kappa * _norm(t)

    def slope(k: np.ndarray) -> np.ndarray:
        inverse = longdouble_oracle.left_jacobian_inverse(truth[k])[:, :3, :3]
        return theta[k] * _norm((inverse @ _slope(truth[k], t[k])).reshape(-1, 9))

    return _finished(w, _norm((xi - truth)[:, 3:]), size, slope)


def hunt(quantity: Quantity, function: Function, effort: Effort, rng: np.random.Generator) -> Worst:
    """The worst of so many random cases, and of so many rounds of hunted ones."""
    largest = LARGEST_EXP if quantity.function == "exp" else math.pi - GAP
    population, found = np.empty((0, 6)), np.empty(0)
    size = min(effort.cases // 5, CHUNK)
    for begin in range(0, effort.cases, CHUNK):
        xi = _drawn(quantity, largest, min(CHUNK, effort.cases - begin), rng)
        population, found = _worst(quantity, function, xi, population, found, rng)
    random = float(found[-1])
    for _ in range(effort.rounds):
        parents = population[rng.integers(len(population), size=size)]
        children = _changed(parents, rng)
        theta = _norm(children[:, :3])
        fit = (theta > SMALLEST[quantity.function]) & (theta < largest)
        children = np.where(fit[:, None], children, parents)
        population, found = _worst(quantity, function, children, population, found, rng)
    return Worst(random, float(found[-1]), population[-1], effort.cases + effort.rounds * size)


def _worst(
    quantity: Quantity,
    function: Function,
    xi: np.ndarray,
    population: np.ndarray,
    found: np.ndarray,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray]:
    """The worst twists of a population and of more, in rising order, and their ratios."""
    got = ratios(quantity, function, xi, rng)[quantity.part]
    population, found = np.concatenate([population, xi]), np.concatenate([found, got])
    best = np.argsort(found, kind="stable")[-KEPT:]
    return population[best], found[best]


def _drawn(quantity: Quantity, largest: float, count: int, rng: np.random.Generator) -> np.ndarray:
    """Random twists; for exp, a third of the angles are small."""
    xi = worst_cases.twists(rng, count, largest)
    if quantity.function == "exp":
        xi[:, :3] *= np.where(
            rng.random((count, 1)) < 1 / 3, 10.0 ** rng.uniform(-8, 0, (count, 1)), 1.0
        )
    return xi


def _changed(xi: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Twists with half of their numbers changed by a relative step, a third also by one in
    proportion to ω or v.
    """
    steps = 10.0 ** rng.uniform(-16.2, -1, (len(xi), 1)) * (rng.random(xi.shape) < 0.5)
    sizes = np.repeat([_norm(xi[:, :3]), _norm(xi[:, 3:])], 3, axis=0).T
    beside = 10.0 ** rng.uniform(-17, -1, (len(xi), 1)) * (rng.random((len(xi), 1)) < 1 / 3)
    return xi * (1 + steps * rng.normal(size=xi.shape)) + beside * sizes * rng.normal(size=xi.shape)


def _called(function: Function, x: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """The results; NaN for each case that raises where all of them at once do."""
    try:
        return np.asarray(function(x), dtype=float)
    except Exception:  # noqa: BLE001  a peer may raise whatever it likes: such a case counts as infinitely wrong
        return np.stack([_one(function, row, shape) for row in x])


def _one(function: Function, row: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    try:
        return np.asarray(function(row[None]), dtype=float)[0]
    except Exception:  # noqa: BLE001  as above
        return np.full(shape, math.nan)


def _slope(xi: np.ndarray, t: np.ndarray) -> np.ndarray:
    """∂t/∂ω of exp at fixed v, as in `error_bounds`."""
    J = longdouble_oracle.left_jacobian(xi)
    return J[:, 3:, :3] - longdouble_oracle.hat(t) @ J[:, :3, :3]


def _finished(
    angular: np.ndarray,
    linear: np.ndarray,
    size: np.ndarray,
    slope: Callable[[np.ndarray], np.ndarray],
) -> Ratios:
    """Both ratios; the linear one is 0 where even without the slope's part of its bound it is not
    among the worst.
    """
    rough = np.nan_to_num(linear / size, nan=np.inf, posinf=np.inf)
    exact = np.zeros_like(rough)
    worst = np.argsort(rough)[-(len(rough) // 10 + 1) :]
    while len(worst):
        exact[worst] = linear[worst] / (size[worst] + slope(worst))
        worst = np.flatnonzero((exact == 0) & (rough > exact.max()))
    return Ratios(
        *(
            np.nan_to_num((x / UNIT).astype(float), nan=np.inf, posinf=np.inf)
            for x in (angular, exact)
        )
    )


def _norm(x: np.ndarray) -> np.ndarray:
    return np.sqrt(np.sum(x * x, axis=-1))


def main(arguments: Sequence[str] | None = None) -> None:
    """Say the worst of each quantity of poekin."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.hunt", description="Hunt for poekin's worst errors."
    )
    parser.add_argument(
        "cases", type=int, nargs="?", default=1_000_000, help="random cases of each quantity"
    )
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(arguments)
    if options.cases < 5:
        parser.error(f"cases: expected 5 or more, of which a fifth are hunted, got {options.cases}")
    for quantity in QUANTITIES:
        rng = np.random.default_rng(options.seed)
        worst = hunt(quantity, getattr(se3, quantity.function), Effort(options.cases, 25), rng)
        print(
            f"{quantity.name}: random {worst.random:.3f}, hunted {worst.hunted:.3f} of {worst.cases} cases, "
            f"at {worst.twist.tolist()}",
            flush=True,
        )


if __name__ == "__main__":
    main()
