"""What gross outliers do to a calibration: robust losses against least squares without any."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from poekin import Chain, load, so3
from poekin.errors import PoekinWarning
from poekin.solve import calibration as cal
from poekin.solve.calibration.fit.losses import LossName

from .. import simulated
from ..report import Figure, Table, Topic, short

ARMS = {"ur5": None, "panda": "panda_link8", "puma560": None, "stanford": None}
LOSSES = ("linear", "huber", "cauchy", "tukey")
MEASURED, OUTLIERS, FRESH, SEEDS, BAR = 60, 3, 200, 10, 1.3
SIZES = {"1 cm … 0.5 m": (0.01, 0.5), "1 … 5 cm": (0.01, 0.05), "0.1 … 0.5 m": (0.1, 0.5)}
TURNS = (0.05, 3.0)

WORDS = (
    f"Arms off their nominal model by {short(1e3 * simulated.OFF)} mm and mrad, {MEASURED} full poses with normal "
    f"errors of {short(1e3 * simulated.LENGTH)} mm and {short(1e3 * simulated.ANGLE)} mrad; then {OUTLIERS} of them "
    f"(5 %), drawn at random, are shifted by 1 cm to 0.5 m in any direction and turned by {TURNS[0]:g} to {TURNS[1]:g} "
    "rad about any axis (each log-uniform). Error on fresh poses: rms over "
    f"{FRESH} configurations of the true arm, without noise, position and rotation each, pooled over the {SEEDS} draws "
    "of each arm, size and way; ÷ the error of least squares from the same measurements before they were spoilt. So a "
    "robust loss also pays for the good measurements that it trusts less, and for those that are lost. Both with "
    "covariances that are told and with spreads that are estimated."
)


class Errors(NamedTuple):
    """Of one draw: errors on fresh poses by position (m) and rotation (rad), without outliers and
    with them.

    named: outliers that the calibration names among those that are; wrong: those that it names and
    are none.
    """

    clean: tuple[float, float]
    spoilt: tuple[float, float]
    named: int
    wrong: int
    converged: bool


Found = dict[tuple[str, bool, str, str], list[Errors]]
"""By arm, whether the covariance is told, the size of the outliers, the loss."""


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    found: Found = {}
    for number, (name, tip) in enumerate(ARMS.items()):
        nominal = load(name).chain(tip=tip)
        for told, seed in itertools.product((True, False), range(4 if quick else SEEDS)):
            rng = np.random.default_rng([seed, number])
            for (size, loss), errors in draw(nominal, rng, told).items():
                found.setdefault((name, told, size, loss), []).append(errors)
        say(
            f"{name}: "
            + ", ".join(f"{loss} {short(ratio(_of(found, loss, name)))}" for loss in LOSSES)
        )
    return report(found)


def report(found: Found) -> Topic:
    """The topic of what was found."""
    whole = next(iter(SIZES))

    def figure(loss: str, bar: float | None) -> Figure:
        groups = {key: ratio(every) for key, every in found.items() if key[3] == loss}
        (name, told, size, _), value = max(groups.items(), key=lambda item: item[1])
        single = max(_each(e) for e in _of(found, loss))
        return Figure(
            f"5 % gross outliers, {loss.capitalize()}: error on fresh poses ÷ that without, worst of arms, sizes and "
            "ways", value, bar,
            note=f"worst at {name}, outliers {size}, covariance {'told' if told else 'estimated'}; all pooled "
                 f"{short(ratio(_of(found, loss)))}; worst single draw {short(single)}",
        )  # fmt: skip

    return Topic(
        "Gross outliers",
        WORDS,
        figures=[*(figure(loss, BAR) for loss in LOSSES[1:]), figure("linear", None), naming(found)],
        tables=[
            Table(
                f"Error on fresh poses ÷ that without outliers, pooled over draws (outliers {whole}): position, "
                "rotation",
                ("arm", "covariance", "without: position (mm)", "without: rotation (mrad)", *LOSSES),
                [row(found, name, told, whole) for name in ARMS for told in (True, False)],
            ),
            Table(
                "The same by the size of the outliers, all arms and ways", ("outliers", *LOSSES),
                [(size, *(_both([e for key, every in found.items() if key[2:] == (size, loss) for e in every])
                          for loss in LOSSES)) for size in SIZES],
            ),
        ],
    )  # fmt: skip


def naming(found: Found) -> Figure:
    """Whether the outliers are named."""
    every = [e for loss in LOSSES[1:] for e in _of(found, loss)]
    put, named, wrong = (
        OUTLIERS * len(every),
        sum(e.named for e in every),
        sum(e.wrong for e in every),
    )
    good = (MEASURED - OUTLIERS) * len(every)
    return Figure(
        "outliers that a robust calibration names", named / put, shown=f"{named} of {put}",
        note=f"{wrong} of {good} good measurements named as well; not converged: "
             f"{sum(not e.converged for e in every)} of {len(every)} calibrations",
    )  # fmt: skip


def row(found: Found, name: str, told: bool, size: str) -> tuple[str, ...]:
    clean = pooled([e.clean for e in found[name, told, size, LOSSES[0]]])
    ratios = (_both(found[name, told, size, loss]) for loss in LOSSES)
    return (name, "told" if told else "estimated", *(short(1e3 * x) for x in clean), *ratios)


def draw(
    nominal: Chain,
    rng: np.random.Generator,
    told: bool,
    sizes: Mapping[str, tuple[float, float]] = MappingProxyType(SIZES),
) -> dict[tuple[str, str], Errors]:
    """One arm and its measurements, spoilt by outliers of each size, by each loss."""
    true, _ = simulated.displaced(nominal, rng)
    q, fresh = nominal.random(rng, MEASURED), nominal.random(rng, FRESH)
    T = simulated.noisy(true.fk(q), simulated.white(rng, MEASURED))
    C = np.diag(simulated.SPREADS**2) if told else None

    def calibrated(T: np.ndarray, loss: LossName) -> cal.Calibration:
        return cal.calibrate(nominal, q, cal.Poses(T, covariance=C), loss=loss, folds=0)

    clean = simulated.errors(calibrated(T, "linear").chain, true, fresh)
    found = {}
    spoilt = {size: _spoilt(T, rng, lengths) for size, lengths in sizes.items()}
    for size, loss in itertools.product(sizes, LOSSES):
        bad, measured = spoilt[size]
        with warnings.catch_warnings():  # which outliers deserve
            warnings.filterwarnings(
                "ignore", "the Poses: the residuals are .* as large as covariance=", PoekinWarning
            )
            result = calibrated(measured, loss)
        named = {outlier.row for outlier in result.outliers}
        true_ones = len(named & set(bad.tolist()))
        found[size, loss] = Errors(
            clean,
            simulated.errors(result.chain, true, fresh),
            true_ones,
            len(named) - true_ones,
            result.success,
        )
    return found


def _spoilt(
    T: np.ndarray, rng: np.random.Generator, size: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Which of the poses are outliers, and all of them with these moved."""
    bad = rng.choice(len(T), OUTLIERS, replace=False)
    spoilt = T.copy()
    spoilt[bad, :3, :3] = so3.exp(_away(rng, TURNS)) @ T[bad, :3, :3]
    spoilt[bad, :3, 3] += _away(rng, size)
    return bad, spoilt


def _away(rng: np.random.Generator, size: tuple[float, float]) -> np.ndarray:
    """Vectors (OUTLIERS, 3) in any direction, of log-uniform length."""
    u = rng.normal(size=(OUTLIERS, 3))
    least, most = np.log(size)
    lengths = np.exp(rng.uniform(least, most, OUTLIERS))
    return lengths[:, None] * u / np.linalg.norm(u, axis=1, keepdims=True)


def pooled(pairs: list[tuple[float, float]]) -> np.ndarray:
    """Root mean squares (position, rotation)."""
    return np.sqrt(np.mean(np.square(pairs), axis=0))


def ratios(every: list[Errors]) -> np.ndarray:
    """Errors with outliers ÷ without, pooled: of position and of rotation."""
    return pooled([e.spoilt for e in every]) / pooled([e.clean for e in every])


def ratio(every: list[Errors]) -> float:
    """The larger of the two."""
    return float(ratios(every).max())


def _each(errors: Errors) -> float:
    return ratio([errors])


def _of(found: Found, loss: str, name: str | None = None) -> list[Errors]:
    return [
        e
        for key, every in found.items()
        if key[3] == loss and name in (None, key[0])
        for e in every
    ]


def _both(every: list[Errors]) -> str:
    return ", ".join(short(float(x)) for x in ratios(every))
