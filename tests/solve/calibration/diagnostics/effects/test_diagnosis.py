"""The diagnosis names what was planted, says how large it is, and nothing where nothing is."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.diagnostics.effects.effect_test import EffectTest, chance
from poekin.solve.calibration.diagnostics.effects.f_test import f_survival
from poekin.solve.calibration.terms.gravity import levers, wrist_in_tip
from tests.solve.calibration.diagnostics.effects.planted import (
    ARM,
    NOISE,
    POINTS,
    ROWS,
    calibrated,
    diagnosis_of,
    made,
)

OPTIONS = {"folds": 0, "on_rank_deficiency": "fix"}
LIFT = "joint 2 (shoulder_lift_joint)"
VERDICTS = [
    ("sag", 1, f"{LIFT} sags", f"gravity lever of {LIFT}"),
    ("rise", 1, f"{LIFT} turns against its load", f"gravity lever of {LIFT}"),
    ("lag", 1, "readings lag the motion", "the move before"),
    (
        "backlash",
        3,
        "joints stop by the side that they come from (backlash)",
        "direction of the move before",
    ),
    (
        "ripple",
        1,
        "the error of joint 4 (wrist_1_joint) repeats with its angle",
        "angle of joint 4 (wrist_1_joint)",
    ),
    ("drift", 1, "the base drifts", "time"),
    ("drift", 3, "the base drifts", "time"),
    (
        "scale",
        1,
        "the device errs by the place in space (its scale, or its field)",
        "place in space",
    ),
    ("loose", 3, "reflector 2 is loose", "scatter of reflector 2 against the others"),
    (
        "moved",
        3,
        "reflector 2 is not where it is said to be",
        "place of reflector 2 on the tool",
    ),
]


@pytest.mark.parametrize(("planted", "count", "verdict", "what"), VERDICTS)
def test_what_was_planted_is_named_first(planted, count, verdict, what):
    found = diagnosis_of(calibrated(planted, 1, count))
    first = found.findings[0]
    assert first.verdict == verdict
    assert first.what == what
    assert first.p < 1e-3
    assert found.tests[0].what == what
    # beside it nothing is left, but what noise shows once in 20 times
    assert all(test.p > 1e-3 for test in found.findings[1:])


def test_a_diagnosis_of_noise_says_so_and_what_came_nearest():
    found = calibrated("nothing", 1)
    diagnosis = diagnosis_of(found)
    assert diagnosis.findings == ()
    nearest = diagnosis.tests[0]
    assert nearest.p == min(test.p for test in diagnosis.tests) > 0.05
    words = (
        f"diagnosis: nothing but noise, by {len(diagnosis.tests)} tests; the nearest to more is "
        f"{nearest.what} (p = {nearest.p:.2g}, {1e3 * nearest.size:.2g} mm)"
    )
    assert str(diagnosis) == words
    assert words in str(found).split("\n")
    # 6 angles, 5 levers, move, its sign, time, place, and 3 reflectors twice
    assert len(diagnosis.tests) == 21


def test_the_size_is_what_the_effect_moves_the_points_by():
    found = calibrated("sag", 1, 1)
    (finding,) = diagnosis_of(found).findings
    left = found.after.rms_length
    # noise is 3 numbers a point, less what 25 of 180 parameters took up
    noise = NOISE * np.sqrt(3.0 * (1.0 - 25 / 180))
    # the noise's square is known to sqrt(2 / 155) = 11 %, the size to 7 %: two of these
    assert finding.size == pytest.approx(np.sqrt(left**2 - noise**2), rel=0.14)
    assert str(finding) == f"{finding.verdict} ({chance(finding.p)}, {1e3 * finding.size:.2g} mm)"


def test_a_loose_reflector_has_the_size_of_its_own_residuals():
    found = calibrated("loose", 1)
    assert found.residuals is not None
    e = found.residuals.after[1::3]
    first = diagnosis_of(found).findings[0]
    assert first.size == pytest.approx(np.sqrt(np.mean(np.sum(e**2, axis=1))), rel=1e-9)


def test_chances_are_those_of_nested_fits_times_the_number_of_tests():
    """By two whole calibrations, the second with the elbow's lever as a term."""
    q, p = made("sag", 1, POINTS[:1])
    found = calibrated("sag", 1, 1)
    down = np.tile([0.0, 0.0, -1.0], (ROWS, 1))

    def basis(q, conditions):
        B = np.zeros((*q.shape, 1))
        B[:, 2, 0] = levers(ARM, q, down[: len(q)], wrist_in_tip(ARM))[:, 2]
        return B

    term = pk.calibration.Term("elbow", (pk.calibration.Parameter("e", "sag", "rad/m"),), basis)
    measured = pk.calibration.Points(p, POINTS[0])
    other = pk.calibrate(ARM, q, measured, parameters=("screws", "home", term), **OPTIONS)
    before, after = (np.sum(f.after.length**2) for f in (found, other))
    freedom = 3 * ROWS - 25 - 1
    F = (before - after) / (after / freedom)
    chance_alone = f_survival(F, 1, freedom)
    (elbow,) = (
        t for t in diagnosis_of(found).tests if t.what.startswith("gravity lever of joint 3")
    )
    assert elbow.p < 1.0
    # the fits are linear to a hundredth of F, which a chance falls with as e^(-F / 2) does
    assert np.log(elbow.p / (15 * chance_alone)) == pytest.approx(0.0, abs=0.01 * F)
    assert len(diagnosis_of(found).tests) == 15


def test_a_fitted_term_is_not_found_again():
    q, p = made("sag", 1, POINTS[:1])
    kinds = ("screws", "home", "compliance")
    measured = pk.calibration.Points(p, POINTS[0])
    found = pk.calibrate(ARM, q, measured, parameters=kinds, **OPTIONS)
    assert diagnosis_of(found).findings == ()
    assert not [test for test in diagnosis_of(found).tests if test.kind == "gravity"]


def test_exact_data_leave_nothing_to_be_tested():
    q = ARM.random(0, 40)
    found = pk.calibrate(ARM, q, ARM.fk(q), folds=0)
    assert diagnosis_of(found).tests == ()
    assert str(diagnosis_of(found)) == "diagnosis: nothing is left to be tested"


def test_a_set_that_stands_elsewhere_is_named():
    q = ARM.random(0, 80)
    rng = np.random.default_rng(0)
    p = ARM.fk(q)[:, :3, 3] + rng.normal(scale=NOISE, size=(80, 3))
    p[40:] += [3e-4, 0.0, 0.0]
    first, last = np.arange(40), np.arange(40, 80)
    sets = [pk.calibration.Points(p[rows], rows=rows) for rows in (first, last)]
    order = np.tile([0, 40], 40) + np.repeat(np.arange(40), 2)
    time = np.argsort(order).astype(float)  # measured in turn: no drift
    found = pk.calibrate(ARM, q, sets, conditions={"time": time}, **OPTIONS)
    assert {test.whose for test in diagnosis_of(found).tests if test.kind == "set"} == {
        "measurement set 0 (Points)",
        "measurement set 1 (Points)",
    }
    first = diagnosis_of(found).findings[0]
    assert first.verdict.partition(" (")[0] in ("measurement set 0", "measurement set 1")
    assert first.verdict.endswith(" stands elsewhere than the others")


def test_a_loose_reflector_does_not_hide_what_the_others_show():
    q, p = made("sag", 1)
    p[:, 1] += np.random.default_rng(0).normal(scale=2e-3, size=(ROWS, 3))
    found = pk.calibrate(ARM, q, pk.calibration.Points(p, POINTS), **OPTIONS)
    verdicts = [finding.verdict for finding in diagnosis_of(found).findings]
    assert verdicts[:2] == ["reflector 2 is loose", f"{LIFT} sags"]


def test_a_chance_below_all_floats_is_told_as_a_bound():
    test = EffectTest("lag", "", 0.0, 1e-3)
    assert str(test) == "readings lag the motion (p < 1e-300, 1 mm)"


def test_a_calibration_without_measurements_has_no_diagnosis():
    found = dataclasses.replace(calibrated("sag", 1, 1), evidence=None)
    assert found.diagnosis is None
    assert found.tool_and_base == ()
    assert "diagnosis" not in str(found)
