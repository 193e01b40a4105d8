"""Reasons not to use a calibration: from where on each is given, and in which words."""

from __future__ import annotations

import ast
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration import Calibration, CrossValidation, Residuals, calibrate, simulated
from poekin.solve.calibration.diagnostics import verdict
from poekin.solve.calibration.diagnostics.misfit import Contradiction

ARM = pk.load("ur5").chain()
MADE = simulated(ARM, 40, seed=2)
FOUND = calibrate(ARM, MADE.q, MADE.measurements.T, folds=3)  # type: ignore[attr-defined]


class Set(list):
    """A set of 40 measurements without covariance."""

    covariance = None
    what = "Poses"
    angular = 3


@pytest.fixture
def reasons(monkeypatch):
    """Reasons of a result, without causes."""
    monkeypatch.setattr(verdict, "most_likely", lambda *given: None)

    def judged(
        found: Any, doubts: Any = (), has_prior: bool = False, to_hold_out: bool = True
    ) -> tuple[str, ...]:
        problem: Any = SimpleNamespace(sets=[Set(range(40))], model=None, q=None)
        return verdict.judge(found, problem, doubts, has_prior, to_hold_out)

    return judged


def residuals(length: Any) -> Residuals:
    length = np.asarray(length, float)
    rows = np.arange(len(length))
    return Residuals(length, np.full(len(length), np.nan), 0 * rows, rows)


def held_out(before: Any, after: Any, **changes: Any) -> Calibration:
    kept = CrossValidation(residuals(before), residuals(after), 5)
    return replace(FOUND, cross_validation=kept, **changes)


def moved(name: str, by: float) -> Calibration:
    """The calibration with one parameter at a value, the others at 0."""
    values = np.zeros(len(FOUND.values))
    k = next(i for i, p in enumerate(FOUND.parameters) if p.name.startswith(name))
    values[k] = by
    return replace(FOUND, values=values)


def test_a_sound_calibration_has_no_reasons(reasons):
    assert FOUND.verdict == ()
    assert reasons(FOUND) == ()


def test_held_out_data_have_to_be_predicted_better_than_before(reasons):
    better = np.full(40, 1e-3)
    assert reasons(held_out(2 * better, better)) == ()
    (words,) = reasons(held_out(better, 1.01 * better))
    assert words == (
        "held-out data are predicted no better than before: off by 1.01 mm, the nominal arm by 1 mm (rms)"
    )
    # a tenth of the rows decide the root mean square, half of them the median
    gross = np.where(np.arange(40) < 4, 0.1, 1e-3)
    worse = np.where(np.arange(40) < 4, 0.11, 0.5e-3)
    assert "(rms)" in reasons(held_out(gross, worse))[0]
    assert not any(
        "no better" in words for words in reasons(held_out(gross, gross - 0.5e-3, loss="huber"))
    )
    assert reasons(held_out(np.full(40, 1e-12), np.full(40, 1e-11))) == ()


@pytest.mark.parametrize(("margin", "few"), [(0.9, True), (1.1, False)])
def test_a_gain_on_held_out_data_has_to_be_more_than_chance(reasons, margin, few):
    """Gains of mean m and standard deviation s over 16 rows: m against 1.645 s / 4."""
    gains = np.tile([1e-4, -1e-4], 8) + margin * 1.645 * 1e-4 / 4
    found = reasons(held_out(1e-3 + gains, np.full(16, 1e-3)))
    assert bool(found) == few
    if few:
        assert found[0].startswith("16 configurations for 30 parameters are too few")


def test_data_that_are_too_few_to_hold_some_out_are_a_reason_unless_none_were_to_be(reasons):
    none = replace(FOUND, cross_validation=None)
    (words,) = reasons(none)
    assert words.startswith("240 equations for 30 parameters are too few to hold some out")
    assert reasons(none, to_hold_out=False) == ()


@pytest.mark.parametrize(("off", "said"), [(4.9e-3, False), (5.1e-3, True)])
def test_a_residual_of_more_than_five_millimetres_is_a_reason(reasons, off, said):
    (*words,) = reasons(replace(FOUND, after=residuals(np.full(40, off))))
    assert words == ["the Poses: the calibrated arm is still off by 5.1 mm"] * said


def test_a_robust_loss_is_named_where_few_measurements_stand_out(reasons):
    odd = FOUND.outliers + tuple(pk.calibration.Outlier(0, i, i) for i in range(3))
    found = replace(FOUND, after=residuals(np.full(40, 9e-3)), outliers=odd[:3])
    assert reasons(found)[0].endswith(
        "9 mm, 3 of 40 stand out (loss='huber' gives them less weight)"
    )
    assert reasons(replace(found, loss="huber"))[0].endswith("9 mm")


@pytest.mark.parametrize(("ratio", "said"), [(9.9, False), (10.1, True)])
def test_residuals_of_ten_times_the_noise_that_was_told_are_a_reason(reasons, ratio, said):
    assert reasons(FOUND, [Contradiction(ratio, "the words")]) == ("the words",) * said


@pytest.mark.parametrize(("name", "most", "words"), [
    ("elbow_joint: tilt", np.radians(3), "the axis of elbow_joint moves by 3.03° and 0 mm"),
    ("elbow_joint: shift", 0.0425, "the axis of elbow_joint moves by 0° and 42.9 mm"),
    ("wrist_3_joint: shift", 0.1 * 0.1193, "the axis of wrist_3_joint moves by 0° and 12 mm"),
    ("home: turn", np.radians(3), "the tip moves by 3.03° and 0 mm"),
    ("home: shift", 0.025, "the tip moves by 0° and 25"),
])  # fmt: skip
def test_no_axis_and_no_tip_is_off_by_as_much(reasons, name, most, words):
    assert reasons(moved(name, 0.99 * most)) == ()
    (said,) = reasons(moved(name, 1.01 * most))
    assert said.startswith(words)


def test_a_zero_of_more_than_three_degrees_is_a_reason(reasons):
    found = calibrate(ARM, MADE.q, MADE.measurements.T, parameters="offsets", folds=0)  # type: ignore[attr-defined]
    for degrees, said in ((2.9, 0), (-3.1, 1)):
        values = np.zeros(6)
        values[1] = np.radians(degrees)
        words = reasons(replace(found, values=values), to_hold_out=False)
        assert [w for w in words if "zero" in w] == [
            "the zero of shoulder_lift_joint moves by -3.1°"
        ] * said


def test_a_bad_condition_is_a_reason_with_the_prior_that_mends_it(reasons):
    values = np.array([10.0, 1e-3])
    for condition, said in ((999.0, 0), (1001.0, 1)):
        can = replace(FOUND.identification, condition=condition, singular_values=values)
        found = replace(FOUND, identification=can)
        assert len(reasons(found)) == said
        assert reasons(found, has_prior=True) == ()
    noise = FOUND.noise_std[0]
    assert noise is not None
    loosest = min(1e3 * noise.length / (10.0 * ARM.reach), 1e-2)
    assert f"give prior={{'rad': {loosest:.1g}, 'm': {loosest:.1g}}}" in reasons(found)[0]


def test_the_first_reason_has_the_likely_cause(monkeypatch):
    monkeypatch.setattr(verdict, "most_likely", lambda *given: "the cause")
    problem: Any = SimpleNamespace(sets=[Set(range(40))], model=None, q=None)
    found = held_out(np.full(40, 1e-3), np.full(40, 2e-3))
    (words,) = verdict.judge(found, problem, [], False, True)
    assert words.endswith("(rms); most likely: the cause")


def test_a_condition_without_a_likely_cause_is_the_first_reason_as_the_others_follow_from_it(
    reasons,
):
    can = replace(FOUND.identification, condition=2e3)
    found = replace(moved("elbow_joint: tilt", 0.1), identification=can)
    first, second = reasons(found)
    assert first.startswith("some parameters are seen 2e+03 times less than others")
    assert second.startswith("the axis of elbow_joint moves by 5.73°")


def test_the_prior_that_is_named_makes_a_calibration_sound():
    """A reflector 0.1 mm off the last axis hardly tells that axis."""
    made = simulated(ARM, 150, kind="points", points=[1e-4, 0.0, 0.03], noise=(1e-4, 5e-5), seed=3)
    points = pk.calibration.Points(made.measurements.p, [1e-4, 0.0, 0.03])  # type: ignore[attr-defined]
    loose = calibrate(ARM, made.q, points, folds=3)
    assert loose.identification.condition > 1e3
    first = loose.verdict[0]
    told = first[first.index("prior=") + len("prior=") :]
    prior = ast.literal_eval(told)
    assert set(prior) == {"rad", "m"}
    held = calibrate(ARM, made.q, points, folds=3, prior=prior)
    assert held.verdict == ()
    # as the prior says what the condition is of: singular values over the noise, with the prior's own
    noise = loose.noise_std[0]
    assert noise is not None
    largest = loose.identification.singular_values[0] * ARM.reach / noise.length
    assert np.hypot(largest, 1 / prior["m"]) * prior["m"] < 1.5e3
