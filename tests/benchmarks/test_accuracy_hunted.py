"""The hunt for the worst error of exp and log: its measure is that of 60 digits, and what is
planted is found.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks import hunt, peers
from benchmarks.accuracy import worst_cases
from benchmarks.accuracy.worst_errors import REPORT_BAR
from benchmarks.cases import accuracy_hunted
from benchmarks.cases.accuracy_hunted import Hunted
from benchmarks.hunt import QUANTITIES, Effort, Worst
from poekin import se3
from poekin.testing.accuracy import error_bounds

SOME = Effort(300, 3)
NAMES = [quantity.name for quantity in QUANTITIES]
R_OF_EXP, P_OF_EXP, W_OF_LOG, _ = QUANTITIES


def rng():
    return np.random.default_rng(5)


def found(name, *ratios):  # type: ignore[no-untyped-def]
    return Hunted(
        name, {q: Worst(r / 2, r, np.ones(6), 7) for q, r in zip(NAMES, ratios, strict=True)}
    )


def test_a_ratio_is_that_of_60_digits():
    for xi in worst_cases.twists(rng(), 12, 3.0):
        T, off = se3.exp(xi), 1 + 1e-14
        wrong, log = T * np.where(np.eye(4)[3], 1.0, off), se3.log(T) * off
        # extended precision is good to some 0.01 of what float64 can attain
        for got, exact in (
            (hunt.exp_ratios(xi[None], wrong[None]), error_bounds.ratio_exp(xi, wrong)),
            (hunt.log_ratios(T[None], log[None]), error_bounds.ratio_log(T, log)),
        ):
            assert max(*got)[0] == pytest.approx(exact, rel=1e-3, abs=0.02)


def test_the_worst_linear_ratio_of_many_is_among_those_that_are_measured():
    xi = worst_cases.twists(rng(), 200, 3.0)
    T = se3.exp(xi)
    each = [hunt.exp_ratios(xi[k : k + 1], T[k : k + 1]).linear[0] for k in range(len(xi))]
    assert hunt.exp_ratios(xi, T).linear.max() == pytest.approx(max(each), rel=1e-9)


def test_climbing_finds_an_error_that_grows_towards_a_place_that_no_random_case_meets():
    place = np.array([1.1, -1.4, 0.9])

    def exp(xi):
        near = np.exp(-3 * np.linalg.norm(xi[:, :3] - place, axis=1))
        return se3.exp(xi) * (1 + 1e-12 * near)[:, None, None]

    worst = hunt.hunt(P_OF_EXP, exp, Effort(1500, 40), rng())
    assert worst.hunted > 2 * worst.random
    assert np.linalg.norm(worst.twist[:3] - place) < 0.1
    assert worst.cases == 1500 + 40 * 300


@pytest.mark.parametrize("quantity", QUANTITIES, ids=NAMES)
def test_who_raises_or_returns_nan_is_infinitely_wrong(quantity):
    own = accuracy_hunted.OWN[quantity.function]

    def raises_sometimes(x):
        if np.any(x[:, 0].ravel()[:: max(x[0].size // 4, 1)] > 0.9):
            raise ValueError("too large")
        return own(x)

    assert hunt.hunt(quantity, raises_sometimes, SOME, rng()).hunted == math.inf
    assert hunt.hunt(quantity, lambda x: own(x) * math.nan, SOME, rng()).random == math.inf


def test_a_hunt_is_the_same_for_the_same_seed():
    first, again = (hunt.hunt(W_OF_LOG, se3.log, SOME, rng()) for _ in range(2))
    assert first.hunted == again.hunted


def test_the_bars_are_the_report_s_and_the_best_peer():
    own, worse, better = (
        found(name, *4 * [r]) for name, r in (("poekin", 1.2), ("slow", 9.0), ("fine", 1.6))
    )
    topic = accuracy_hunted.report(
        [own, own, worse, better, Hunted("absent", {}, "is not installed")]
    )
    assert [f.bar for f in topic.figures] == 4 * [REPORT_BAR] + 4 * [1]
    assert all(f.verdict for f in topic.figures)
    assert "1.6 of fine" in topic.figures[-1].note
    assert ("absent", "", "", "", "", "is not installed") in topic.tables[0].rows
    topic = accuracy_hunted.report([own, own, found("first", 1.1, 2, 2, 2)])
    assert [f.verdict for f in topic.figures[4:]] == [False, True, True, True]
    topic = accuracy_hunted.report([found("poekin", 1.2, 1.6, 1.2, 1.2), own])
    assert [f.verdict for f in topic.figures] == [True, False, True, True, None, None, None, None]


def test_the_topic_hunts_poekin_and_a_peer(monkeypatch):
    chosen = [peer for peer in peers.find([*peers.STANDARD.values()]) if peer.peer.name == "SciPy"]
    monkeypatch.setattr(accuracy_hunted.peers, "chosen", lambda: chosen)
    said: list[str] = []
    topic = accuracy_hunted.topic(True, said.append)
    assert len(said) == 2
    assert all(figure.verdict for figure in topic.figures if figure.bar == REPORT_BAR)


def test_the_command_says_the_worst_of_each(capsys):
    hunt.main(["100"])
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in lines] == NAMES


def test_too_few_cases_are_refused(capsys):
    with pytest.raises(SystemExit) as ended:
        hunt.main(["4"])
    assert ended.value.code == 2
    assert (
        "cases: expected 5 or more, of which a fifth are hunted, got 4" in capsys.readouterr().err
    )
