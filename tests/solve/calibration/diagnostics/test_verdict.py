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
    ("shoulder_lift_joint: shift", 0.0425, "the axis of shoulder_lift_joint moves by 0° and 42.9 mm"),
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


def test_the_zero_of_a_slide_is_no_angle(reasons):
    arm = pk.load("stanford").chain()  # joint 3 slides
    made = simulated(arm, 20, seed=2)
    found = calibrate(arm, made.q, made.measurements.T, parameters="offsets", folds=0)  # type: ignore[attr-defined]
    values = np.array([0, 0, 0.1, 0.1, 0, 0])
    words = reasons(replace(found, values=values), to_hold_out=False)
    assert [w for w in words if "zero" in w] == ["the zero of joint4 moves by 5.73°"]


def test_a_bad_condition_is_a_reason_with_the_prior_that_mends_it(reasons):
    values = np.array([10.0, 1e-3])
    for condition, said in ((999.5, 0), (1000.5, 1)):
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


@pytest.mark.parametrize(("before", "after", "changes", "figures"), [
    # more than half of the mean gain is that of one row, and of the squares, too
    ([1.0] * 10, [0.5] * 9 + [5.0], {}, "1.65 mm, the nominal arm by 1 mm (rms)"),
    ([0.5] * 9 + [5.0], [1.0] * 10, {}, "1 mm, the nominal arm by 1.65 mm (rms)"),
    ([2.0, 0.0], [1.0, 1.0], {}, "1 mm, the nominal arm by 1.41 mm (rms)"),
    ([1.0, 1.0, 1.0], [0.5, 1.0, 1.0], {"loss": "huber"}, "1 mm, the nominal arm by 1 mm (median)"),
    ([1.2344], [1.2345], {}, "1.23 mm, the nominal arm by 1.23 mm (rms)"),
    ([1.2355], [1.2356], {}, "1.24 mm, the nominal arm by 1.24 mm (rms)"),
])  # fmt: skip
def test_held_out_data_gain_in_their_mean_and_in_their_size(
    reasons, before, after, changes, figures
):
    found = held_out(1e-3 * np.array(before), 1e-3 * np.array(after), **changes)
    (words,) = reasons(found)
    assert words == f"held-out data are predicted no better than before: off by {figures}"


def test_a_gain_that_may_be_chance_is_said_with_its_figures(reasons):
    before = 1e-3 + np.tile([1e-4, -1e-4], 8) + 1e-5
    (words,) = reasons(held_out(before, np.full(16, 1e-3)))
    assert words == (
        "16 configurations for 30 parameters are too few, the gain on held-out data may be chance: "
        "off by 1 mm, the nominal arm by 1.01 mm (rms); measure more, or calibrate fewer parameters"
    )


def test_rows_that_were_measured_several_times_count_once():
    found = Residuals(np.array([3.0, 5.0, 4.0]), np.zeros(3), np.zeros(3, int), np.array([7, 2, 7]))
    np.testing.assert_allclose(verdict._by_configuration(found), [5.0, np.sqrt(12.5)])


@pytest.mark.parametrize(("odd", "said"), [(0, False), (1, True), (9, True), (10, False), (13, False)])  # fmt: skip
def test_measurements_stand_out_where_they_are_some_and_less_than_a_quarter(reasons, odd, said):
    outliers = tuple(pk.calibration.Outlier(0, i, i) for i in range(odd))
    others = tuple(pk.calibration.Outlier(1, i, i) for i in range(3))
    off = replace(FOUND, after=residuals(np.full(40, 9e-3)), outliers=outliers + others)
    (words,) = reasons(off)
    assert words.endswith("9 mm") != said
    assert (f", {odd} of 40 stand out" in words) == said
    (words,) = reasons(replace(off, loss="tukey"))
    assert words.endswith("9 mm")


def test_of_two_sets_each_is_told_with_its_own_outliers(monkeypatch):
    monkeypatch.setattr(verdict, "most_likely", lambda *given: None)
    lengths = np.repeat([8e-3, 9e-3], 40)
    which = np.repeat([0, 1], 40)
    after = Residuals(lengths, np.full(80, np.nan), which, np.tile(np.arange(40), 2))
    outliers = [
        pk.calibration.Outlier(k, i, i) for k, count in ((0, 2), (1, 5)) for i in range(count)
    ]
    found = replace(FOUND, after=after, outliers=tuple(outliers))
    problem: Any = SimpleNamespace(sets=[Set(range(40)), Set(range(40))], model=None, q=None)
    first, second = verdict.judge(found, problem, [], False, True)
    assert "off by 8 mm, 2 of 40 stand out" in first
    assert "off by 9 mm, 5 of 40 stand out" in second


@pytest.mark.parametrize("k", range(6))
def test_a_tip_is_off_by_its_turn_in_degrees_and_its_shift_in_mm(reasons, k):
    names = [p.name for p in FOUND.parameters if p.owner == "home"]
    turns = "turn" in names[k]
    for size, degrees, mm in ((0.123449, "7.07", "123"), (0.123551, "7.08", "124")):
        (words,) = reasons(moved(names[k], size))
        told = f"{degrees}° and 0 mm" if turns else f"0° and {mm} mm"
        assert words == f"the tip moves by {told}, to another one"


def test_numbers_of_frames_are_no_moves_of_the_arm(reasons):
    values = np.concatenate([FOUND.values, [9.0, 9.0, 9.0]])
    assert reasons(replace(FOUND, values=values)) == ()


def test_of_noise_that_was_told_the_prior_has_the_mean_of_the_variances_of_lengths():
    C = np.tile(np.diag([1.0, 1, 1, 1e-8, 4e-8, 22e-8]), (40, 1, 1))
    told: Any = SimpleNamespace(covariance=C, angular=3)
    can = replace(
        FOUND.identification, condition=2e3, singular_values=np.array([1e3, 0.5]) / ARM.reach
    )
    found = replace(FOUND, identification=can, noise_std=(None,))
    problem: Any = SimpleNamespace(sets=[told])
    # a thousand times 3e-4 over 1e3
    (words,) = verdict._condition(found, problem)
    assert words.endswith("give prior={'rad': 0.0003, 'm': 0.0003}")
