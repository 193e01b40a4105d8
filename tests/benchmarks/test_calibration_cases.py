"""The report's pages on calibration: simulated noise is what it says it is, and each judge sees
what is wrong.
"""

from __future__ import annotations

import csv

import numpy as np
import pytest

import poekin as pk
from benchmarks import simulated
from benchmarks.cases import calibration as ranks
from benchmarks.cases import calibration_coverage as coverage
from benchmarks.cases import calibration_franka as franka
from benchmarks.cases import calibration_outliers as outliers
from benchmarks.cases import calibration_time as timing
from poekin.solve import calibration as cal
from tests.versions import needs

UR5 = pk.load("ur5").chain()


def silent(_: str) -> None:
    """No line of progress."""


def test_simulated_errors_are_those_that_the_calibration_will_see():
    rng = np.random.default_rng(0)
    T, noise = UR5.fk(UR5.random(rng, 20)), simulated.white(rng, 20)
    # log and exp round at 1e-16
    np.testing.assert_allclose(
        cal.Poses(simulated.noisy(T, noise)).errors(T, []), noise, rtol=0, atol=1e-15
    )


def test_a_displaced_arm_has_the_parameters_that_it_is_said_to_have():
    true, p = simulated.displaced(UR5, np.random.default_rng(1))
    q = UR5.random(2, 40)
    found = cal.calibrate(UR5, q, true.fk(q), folds=0)
    np.testing.assert_allclose(
        found.values, p, rtol=0, atol=1e-12
    )  # noise-free: what the calibration is good for
    assert simulated.errors(true, true, q) == (0.0, 0.0)
    position, rotation = simulated.errors(UR5, true, q)
    assert 1e-3 < position < 1e-1
    assert 1e-3 < rotation < 1e-1


@pytest.mark.parametrize("what", ["poses", "point"])
def test_a_chain_that_tells_less_is_counted_as_wrong(what):
    chain, q, point = ranks.random_chain("RRR", np.random.default_rng(3))
    stuck = q * [1.0, 0.0, 1.0]
    good, bad = (ranks.seen(chain, x, point if what == "point" else None) for x in (q, stuck))
    right = ranks.identifiable("RRR", what)
    assert (good.rank, good.identified, good.identifiable) == (right, right, right)
    assert max(bad.rank, bad.identified) < right
    figures = [
        ranks.figure("", "", what, {("RRR", what): every}) for every in ([good, good], [good, bad])
    ]
    assert [(f.value, f.verdict) for f in figures] == [(0, True), (1, False)]


def test_the_formula_counts_joints():
    assert [ranks.identifiable(k, "poses") for k in ranks.KINDS] == [
        10,
        14,
        18,
        30,
        34,
        16,
        12,
        20,
        26,
    ]
    assert [ranks.identifiable(k, "point") for k in ranks.KINDS] == [
        7,
        11,
        15,
        27,
        31,
        13,
        9,
        17,
        23,
    ]


def test_inside_is_the_probability_of_a_nearer_error():
    # 1.96 standard deviations hold 95 % of one normal number; two numbers within r hold 1 -
    # exp(-r^2/2)
    assert coverage.inside(np.array([1.959964 * 3.0]), np.array([[9.0]])) == pytest.approx(
        0.95, abs=1e-6
    )
    C = np.array([[2.0, 0.5], [0.5, 1.0]])
    error = np.linalg.cholesky(C) @ [0.6, 0.8]
    assert coverage.inside(error, C) == pytest.approx(1 - np.exp(-0.5))


def test_covariances_that_are_too_small_miss_the_bar(monkeypatch):
    def found():
        return [
            coverage.simulate("ur5", UR5, coverage.ROWS[0], np.random.default_rng(k))
            for k in range(40)
        ]

    honest = found()
    assert all(f.converged for f in honest)
    # 40 draws: fewer than 33 of them inside are one in 10^3, if 95 % is true
    assert sum(f.parameters < 0.95 for f in honest) >= 33
    noisy = simulated.noisy
    monkeypatch.setattr(simulated, "noisy", lambda T, noise: noisy(T, 1.5 * noise))
    assert coverage.figure("", found(), True).verdict is False


@pytest.mark.parametrize("kind", ["poses", "point", "eye"])
def test_what_is_judged_is_what_can_be_seen(kind):
    directions = coverage.seen(UR5, UR5.random(0, 40), kind)
    # eye in hand, board and camera take up 6 of the home pose and 6 of where the base stands
    assert directions.shape == (30, {"poses": 30, "point": 27, "eye": 18}[kind])
    np.testing.assert_allclose(
        directions.T @ directions, np.eye(directions.shape[1]), rtol=0, atol=1e-14
    )


def test_outliers_ruin_least_squares_and_no_robust_loss():
    found = outliers.draw(UR5, np.random.default_rng(0), told=True, sizes={"large": (0.1, 0.5)})
    assert outliers.ratio([found["large", "linear"]]) > 10
    for loss in outliers.LOSSES[1:]:
        one = found["large", loss]
        assert outliers.ratio([one]) < 2  # one draw; the bar is for many together
        assert (one.named, one.converged) == (outliers.OUTLIERS, True)


def test_the_worst_group_decides_about_outliers():
    good, bad = (
        outliers.Errors((1.0, 1.0), spoilt, 3, 0, True) for spoilt in ((1.1, 1.2), (1.0, 1.4))
    )
    groups = [(name, told, size, loss) for name in outliers.ARMS for told in (True, False)
              for size in outliers.SIZES for loss in outliers.LOSSES]  # fmt: skip
    found = {key: [good, good] for key in groups}
    assert [f.verdict for f in outliers.report(found).figures] == [True, True, True, None, None]
    found["panda", False, "1 … 5 cm", "cauchy"] = [bad, bad]
    page = outliers.report(found)
    assert [f.verdict for f in page.figures] == [True, False, True, None, None]
    assert page.figures[1].value == pytest.approx(1.4)
    assert "panda, outliers 1 … 5 cm, covariance estimated" in page.figures[1].note


def test_without_the_data_the_page_says_so_and_no_bar_is_missed(monkeypatch, tmp_path):
    monkeypatch.setenv(franka.VARIABLE, str(tmp_path / "nothing.csv"))
    page = franka.topic(True, silent)
    assert [f.verdict for f in page.figures] == [None, None]
    assert all("not measured" in f.text and franka.VARIABLE in f.note for f in page.figures)
    assert not any(str(tmp_path) in f.note for f in page.figures)


def test_the_data_is_read_where_it_is_named(monkeypatch, tmp_path):
    arm, rng = pk.load("panda").chain(tip="panda_link8"), np.random.default_rng(0)
    true, _ = simulated.displaced(arm, rng)
    q = arm.random(rng, 60)
    board, camera = pk.se3.exp([[0.1, 0.2, 0.3, 0.5, 0.0, 0.1], [0.0, 0.1, 1.6, 0.1, 0.0, 0.05]])
    T = simulated.noisy(pk.se3.inverse(board) @ true.fk(q) @ camera, simulated.white(rng, 60))
    heads = [*(f"q{k + 1}" for k in range(7)), *(f"T{i}{j}" for i in range(3) for j in range(4))]
    with open(tmp_path / "o.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(
            [heads, *np.concatenate([q, T[:, :3].reshape(60, 12)], axis=1).tolist()]
        )
    monkeypatch.setenv(franka.VARIABLE, str(tmp_path / "o.csv"))
    monkeypatch.setattr(franka, "LOSSES", ("linear", "cauchy"))
    page = franka.topic(True, silent)
    assert [f.verdict for f in page.figures if f.bar is not None] == [True, True]
    before, after = page.figures[:2]
    assert after.value < 1.0 < before.value  # type: ignore[operator]
    assert page.figures[4].text == "0 of 2"


def test_a_draw_of_the_folds_that_misses_one_bar_is_counted():
    found = {("cauchy", k): franka.Kept(0.9, 1.0, 2.0, rms) for k, rms in enumerate((3.9, 4.1))}
    assert franka._misses(found, "cauchy") == 1
    assert franka._misses(found, "linear") == 0


@pytest.mark.parametrize("method", list(timing.METHODS))
def test_scipy_and_poekin_solve_the_same_task(method):
    if method == "lm":
        # Before, MINPACK's own differences: steps of 1.5e-8 |x|, 1e-11 here, and a Jacobian that is
        # off by 3e-5.
        needs("scipy", "1.16")
    task = timing.simulated_task()
    found = timing.minimised(method)(timing.residuals(task))
    own = timing.calibrated(task)
    # differences of 1e-8 in each parameter leave 1e-10 of a step that ends at 1e-8 of the cost
    np.testing.assert_allclose(found.x, own.values, rtol=0, atol=1e-9)
    np.testing.assert_allclose(
        timing.fit_alone(timing.prepared(task)).p, own.values, rtol=0, atol=1e-15
    )
    assert timing.off(task, own.values) < timing.off(task, np.zeros(len(own.values))) / 20
