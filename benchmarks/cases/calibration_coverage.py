"""Whether a calibration knows how well it knows: true parameters inside the 95 % ellipsoids of
simulated ones.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.stats import binom, chi2

from poekin import Chain, load, se3, so3
from poekin.solve import calibration as cal
from poekin.solve.calibration.diagnostics.identification import identify_directions
from poekin.solve.calibration.fit.losses import LossName
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem

from .. import simulated
from ..report import Figure, Table, Topic, short

ARMS = {"ur5": None, "panda": "panda_link8", "puma560": None, "stanford": None}
MEASURED, WHOLE = 50, 1000
SHARE, LEAST, MOST = 0.95, 0.93, 0.97
LEVELS = (0.5, 0.8, 0.9, 0.95, 0.99)
POINT = np.array([0.03, -0.05, 0.12])

WORDS = (
    f"{WHOLE} calibrations from full poses, as many of each of four arms, and fewer of each other kind: the figures "
    "say of how many. Each: a true arm whose parameters are off the nominal ones by "
    f"{short(1e3 * simulated.OFF)} mm and mrad (normal), {MEASURED} configurations within the limits, "
    "measurements with normal errors of a covariance of their own, in which angles and lengths depend on each other, "
    f"about {short(1e3 * simulated.ANGLE)} mrad and {short(1e3 * simulated.LENGTH)} mm; the calibration is told the "
    "covariance. Inside: (p − p_true)ᵀ C⁻¹ (p − p_true) is below the 95 % point of chi-square, C the covariance that "
    "the calibration gives for all its parameters together. What a kind of measurement cannot see is nominal in the "
    "true arm, and the ellipsoid is that of what is left. Poses foretold: at one fresh configuration, the error of "
    "the calibrated arm's pose in the 95 % ellipsoid of `pose_covariance`. Chance: where a share lies in 95 of 100 "
    "such reports, if 95 % is true. Where the covariance is not told, it is the jackknife's, by configuration: of 50 "
    "of them its intervals hold, and nearly the six numbers of a pose, but no ellipsoid of all 34 parameters."
)


class Row(NamedTuple):
    """What is simulated: words; kind of measurement; loss; whether the covariance is told; how many
    of `WHOLE`.
    """

    words: str
    kind: str = "poses"
    loss: LossName = "linear"
    told: bool = True
    part: float = 1.0
    bar: bool = False


ROWS = (
    Row("full poses", bar=True),
    Row("one point of the tool", "point", part=0.2),
    Row("eye in hand, the arm's parameters", "eye", part=0.2),
    Row("full poses, covariance not told", told=False, part=0.2),
    Row("full poses, Huber", loss="huber", part=0.1),
    Row("full poses, Cauchy", loss="cauchy", part=0.1),
    Row("full poses, Tukey", loss="tukey", part=0.1),
    Row("full poses, Cauchy, covariance not told", loss="cauchy", told=False, part=0.1),
)


class Found(NamedTuple):
    """Of one calibration: its arm, probability of a smaller distance of the parameters, and of the
    pose foretold.
    """

    arm: str
    parameters: float
    pose: float
    converged: bool


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    arms = {name: load(name).chain(tip=tip) for name, tip in ARMS.items()}
    found = {}
    for row in ROWS:
        each = int(WHOLE * row.part * (0.1 if quick else 1)) // len(arms)
        found[row.words] = [
            simulate(name, nominal, row, np.random.default_rng([seed, number]))
            for number, (name, nominal) in enumerate(arms.items())
            for seed in range(each)
        ]
        say(f"{row.words}: {_percent(found[row.words])}")
    return report(found)


def report(found: dict[str, list[Found]]) -> Topic:
    """The topic of what was found, by the words of `ROWS`."""
    bars = {row.words for row in ROWS if row.bar}
    return Topic(
        "Does a calibration know how well it knows?",
        WORDS,
        figures=[figure(words, every, words in bars) for words, every in found.items()],
        tables=[
            Table("By arm", ("measurements", "arm", "calibrations", "parameters inside", "pose foretold",
                             "not converged"),
                  [by_arm(words, name, [f for f in every if f.arm == name])
                   for words, every in found.items() for name in ARMS]),
            Table("The same for other ellipsoids: share of true parameters inside",
                  ("measurements", *(f"{100 * level:g} %" for level in LEVELS)),
                  [(words, *(_percent(every, level=level) for level in LEVELS)) for words, every in found.items()]),
        ],
    )  # fmt: skip


def by_arm(words: str, name: str, mine: list[Found]) -> tuple[str | int, ...]:
    """A row of the table."""
    lost = sum(not f.converged for f in mine)
    return (words, name, len(mine), _percent(mine), _percent(mine, "pose"), lost)


def figure(words: str, every: list[Found], bar: bool) -> Figure:
    """The share of parameters inside, with that of poses beside it."""
    share = np.mean([f.parameters < SHARE for f in every])
    return Figure(
        f"{words}: true parameters inside their 95 % ellipsoid", float(share), shown=_percent(every),
        bar_shown="93 … 97 %" if bar else "", holds=bool(LEAST <= share <= MOST) if bar else None,
        note=f"{len(every)} calibrations, chance {_chance(len(every))}; fresh poses inside that of "
        f"`pose_covariance`: {_percent(every, 'pose')}",
    )  # fmt: skip


def simulate(name: str, nominal: Chain, row: Row, rng: np.random.Generator) -> Found:
    """One calibration, judged."""
    q = nominal.random(rng, MEASURED + 1)
    q, fresh = q[:-1], q[-1:]
    directions = seen(nominal, q, row.kind)
    true, p = simulated.displaced(nominal, rng, directions)
    C = simulated.correlated(rng) if row.told else np.diag(simulated.SPREADS**2)
    noise = rng.multivariate_normal(np.zeros(6), C, MEASURED)
    taken = measured(true.fk(q), noise, C if row.told else None, row.kind)
    result = cal.calibrate(nominal, q, taken, loss=row.loss, folds=0)
    n, scale = len(p), simulated.scales(nominal)
    off = directions.T @ ((result.values[:n] - p) / scale)
    spread = directions.T @ (result.covariance[:n, :n] / np.outer(scale, scale)) @ directions
    T, expected = result.chain.fk(fresh)[0], true.fk(fresh)[0]
    error = np.concatenate([so3.log(T[:3, :3] @ expected[:3, :3].T), T[:3, 3] - expected[:3, 3]])
    foretold = result.pose_covariance(fresh[0])
    if (
        row.kind == "point"
    ):  # turns about the point are not seen: the point's own error, and its covariance
        arm = T[:3, :3] @ POINT
        carry = np.concatenate([-so3.hat(arm), np.eye(3)], axis=1)
        error, foretold = (
            T[:3, 3] + arm - expected[:3, 3] - expected[:3, :3] @ POINT,
            carry @ foretold @ carry.T,
        )
    return Found(name, inside(off, spread), inside(error, foretold), result.success)


def inside(error: np.ndarray, C: np.ndarray) -> float:
    """The probability that a normal error of covariance C is nearer than this one."""
    return float(chi2.cdf(error @ np.linalg.solve(C, error), len(error)))


def seen(nominal: Chain, q: np.ndarray, kind: str) -> np.ndarray:
    """Orthonormal directions (P, k), in rad and reaches, of the arm's parameters that such
    measurements can see.
    """
    exact = measured(nominal.fk(q), np.zeros((len(q), 6)), None, kind)
    problem = Problem(ErrorModel(nominal, simulated.KINDS, None), q, [exact])
    free = identify_directions(problem)[1][: problem.model_size]
    U, s, _ = np.linalg.svd(free, full_matrices=False)
    return U[:, s > 1e-3]


def measured(T: np.ndarray, noise: np.ndarray, C: np.ndarray | None, kind: str) -> cal.Measurement:
    """Measurements of the poses T with this noise; C of a point is that of its position."""
    if kind == "poses":
        return cal.Poses(simulated.noisy(T, noise), covariance=C)
    if kind == "point":
        y = T[:, :3, :3] @ POINT + T[:, :3, 3] - noise[:, 3:]
        return cal.Points(y, points=POINT, covariance=None if C is None else C[3:, 3:])
    board = se3.exp([0.1, -0.2, 0.3, 0.5, 0.1, 0.0])
    camera = se3.exp([0.05, 0.02, 1.6, 0.06, -0.01, 0.04])
    return cal.EyeInHand(simulated.noisy(se3.inverse(board) @ T @ camera, noise), covariance=C)


def _percent(every: list[Found], what: str = "parameters", level: float = SHARE) -> str:
    return f"{100 * np.mean([getattr(f, what) < level for f in every]):.1f} %"


def _chance(count: int) -> str:
    """Where the share of so many lies in 95 of 100 reports, if 95 % is true."""
    low, high = 100 * binom.ppf([0.025, 0.975], count, SHARE) / count
    return f"{low:.1f} … {high:.1f} %"
