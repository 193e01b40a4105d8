"""DH, Hayati's form and screws side by side: each is the arm that it says, and what is reported was
measured.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks import parametrisations_fit as fit
from benchmarks.cases import calibration_claim as claim
from benchmarks.page import html, markdown
from benchmarks.parametrisations import ELBOW, SHOULDER, link_parameters, table_with, tilted
from benchmarks.parametrisations_fit import Found, Sample
from poekin import dh, so3

NOMINAL = dh.to_chain(table_with(0.0))
Q = NOMINAL.random(3, 30)
DECADES = (1e-2, 1e-3, 1e-4, 1e-5)
ABOUT = {"when": "now", "commit": "c", "processor": "p", "cores": 2, "load": 0.0, "system": "s", "python": "3",
         "versions": {}}  # fmt: skip


def sample(delta: float, seed: int, count: int) -> Sample:
    q = NOMINAL.random(seed, count)
    return Sample(q, tilted(delta).fk(q))


@pytest.fixture(scope="module")
def at_a_thousandth():
    return claim.at_tilt(1e-3, 1)


@pytest.mark.parametrize(
    "make",
    [
        lambda: table_with(0.3),
        lambda: dh.from_chain(tilted(0.1), convention="standard").table,
        lambda: dh.from_chain(NOMINAL.rebased(tilted(0.2).home), convention="standard").table,
    ],
    ids=["twisted", "tilted", "on a base"],
)
def test_link_parameters_are_the_table_s_arm(make):
    table = make()
    # 34 products of numbers of up to 5 m
    np.testing.assert_allclose(
        link_parameters(table).poses(Q), dh.to_chain(table).fk(Q), rtol=0, atol=34 * 5 * 2.0**-52
    )


@given(st.floats(-1.2, 1.2))
def test_hayati_s_link_without_beta_is_the_table_s_link_without_d(twist):
    form = link_parameters(table_with(twist), (SHOULDER,))
    assert form.values[claim.BETA] == 0
    np.testing.assert_allclose(
        form.poses(Q), dh.to_chain(table_with(twist)).fk(Q), rtol=0, atol=34 * 2.0**-52
    )


def test_the_numbers_of_d_and_beta_are_those_of_the_shoulder_s_link():
    plain, hayati = link_parameters(table_with(0.0)), link_parameters(table_with(0.0), (SHOULDER,))
    assert plain.motions[claim.D_OF_SHOULDER] == "Tz"
    assert plain.turned_by[SHOULDER] == claim.D_OF_SHOULDER - 1
    assert hayati.motions[claim.BETA] == "Ry"
    assert [form.lengths.sum() for form in (plain, hayati)] == [15, 14]


def test_a_link_with_d_is_refused_by_hayati_s_form():
    with pytest.raises(
        ValueError, match=r"row 3: Hayati's link has no d, and this one is 0\.15005 m"
    ):
        link_parameters(table_with(0.0), (ELBOW,))


THIRTY = st.lists(st.floats(-1, 1), min_size=30, max_size=30).map(np.array)


@given(THIRTY, THIRTY, st.booleans())
def test_columns_are_the_derivative_of_the_poses(values, direction, hayati):
    form = link_parameters(table_with(0.0), (SHOULDER,) if hayati else ()).moved(values)
    h = 1e-5
    ahead, behind = (form.moved(sign * h * direction).poses(Q) for sign in (1, -1))
    turn = so3.log(ahead[:, :3, :3] @ np.swapaxes(behind[:, :3, :3], -1, -2)) / (2 * h)
    shift = (ahead[:, :3, 3] - behind[:, :3, 3]) / (2 * h)
    # h^2 / 6 times the third derivative: fifteen turns of at most 1 rad each, cubed, of an arm of
    # at most 30 m
    np.testing.assert_allclose(
        form.columns(Q) @ direction, np.hstack([turn, shift]), rtol=0, atol=2e-6
    )


@given(st.floats(-8, -0.5).map(lambda power: 10.0**power))
def test_the_tilted_axis_meets_the_shoulder_s_at_a_over_tan_delta(delta):
    A, nominal = tilted(delta).screws, NOMINAL.screws
    np.testing.assert_array_equal(np.delete(A, ELBOW, 0), np.delete(nominal, ELBOW, 0))
    np.testing.assert_array_equal(tilted(delta).home, NOMINAL.home)
    angle = np.arctan2(
        np.linalg.norm(np.cross(A[ELBOW, :3], A[SHOULDER, :3])), A[ELBOW, :3] @ A[SHOULDER, :3]
    )
    assert angle == pytest.approx(delta, abs=1e-15)
    # reciprocal product zero: the axes have a point in common
    assert abs(A[ELBOW, :3] @ A[SHOULDER, 3:] + A[ELBOW, 3:] @ A[SHOULDER, :3]) <= 1e-15
    d = dh.from_chain(tilted(delta), convention="standard").table.d[SHOULDER]
    # an angle known to 1e-16 rad
    assert d == pytest.approx(
        -table_with(0.0).a[SHOULDER] / math.tan(delta), rel=1e-15 / delta + 1e-14
    )


def test_dh_s_condition_grows_as_the_inverse_square_of_the_twist_and_the_others_do_not():
    rows = np.array([claim.conditions(claim.forms_with(twist)) for twist in DECADES])
    # the leading term, to terms of the order of the twist
    np.testing.assert_allclose(rows[1:, 0] / rows[:-1, 0], 100, rtol=0.02)
    assert rows[:, 1:].max() < claim.CONDITION_BAR
    assert rows[0, 0] > 1e3


def test_at_right_angles_it_is_hayati_s_link_whose_condition_grows():
    rows = np.array([claim.conditions(claim.forms_with(math.pi / 2 - miss)) for miss in DECADES])
    np.testing.assert_allclose(rows[1:, 1] / rows[:-1, 1], 10, rtol=0.02)
    assert rows[:, [0, 2]].max() < claim.CONDITION_BAR


def test_condition_counts_lengths_in_units_of_the_reach():
    form = link_parameters(table_with(0.5))
    J = form.columns(Q) * np.where(form.lengths, 2.0, 1.0)
    J[:, 3:] /= 2.0
    assert fit.condition(form, Q, 2.0) == pytest.approx(
        np.linalg.cond(J.reshape(-1, 30)), rel=1e-12
    )


@pytest.mark.parametrize("delta", claim.TILTS_OF_THE_BAR)
def test_screws_and_hayati_s_form_find_the_tilted_arm_in_a_few_steps_and_plain_dh_does_not(delta):
    measured, fresh = sample(delta, 1, 40), sample(delta, 2, 200)
    plain, hayati, screws = claim.forms_with(0.0)
    R = NOMINAL.reach
    by_screws = fit.calibrated(screws, measured, fresh, 6)
    by_hayati = fit.gauss_newton(hayati, measured, fresh, R, 6)
    by_dh = fit.gauss_newton(plain, measured, fresh, R, 20)
    for found in (by_screws, by_hayati):
        count = found.steps_to(claim.EXACT)
        assert count is not None
        assert count <= claim.STEPS_BAR
    assert by_dh.steps_to(0.1 * delta) is None
    np.testing.assert_allclose(by_screws.arm.screws, tilted(delta).screws, rtol=0, atol=1e-14)
    assert by_hayati.arm.values[claim.BETA] == pytest.approx(delta, abs=1e-14)


def test_levenberg_marquardt_finds_the_far_solution_of_plain_dh():
    found = fit.levenberg_marquardt(
        link_parameters(table_with(0.0)),
        sample(1e-2, 10, 40),
        sample(1e-2, 2, 200),
        NOMINAL.reach,
        300,
    )
    assert found.error < claim.REACHED
    assert found.arm.values[claim.D_OF_SHOULDER] == pytest.approx(
        -0.4318 / math.tan(1e-2), rel=1e-9
    )


def test_a_damped_step_is_not_counted_as_gauss_newton(monkeypatch):
    damped = SimpleNamespace(steps=[SimpleNamespace(damping=1e-4)], chain=NOMINAL)
    monkeypatch.setattr(fit.calibration, "calibrate", lambda *_, **__: damped)
    with pytest.raises(RuntimeError, match=r"a step was damped"):
        fit.calibrated(NOMINAL, sample(1e-2, 1, 40), sample(1e-2, 2, 5), 3)


def test_steps_are_counted_to_the_first_error_that_is_small_enough():
    assert Found(NOMINAL, [1.0, 1e-3, 1e-13, 1e-16]).steps_to(1e-12) == 2
    assert Found(NOMINAL, [1e-13]).steps_to(1e-12) == 0
    assert Found(NOMINAL, [1.0, math.nan]).steps_to(1e-12) is None


AS_PREDICTED = [(10 / twist**2, 10.0, 12.0) for twist in claim.TWISTS]
AT_RIGHT_ANGLES = [(3.0, 10 / twist, 12.0) for twist in claim.TWISTS]


def verdicts(tilt, conditions=AS_PREDICTED, right=AT_RIGHT_ANGLES) -> list[bool | None]:
    return [figure.verdict for figure in claim.figures(conditions, right, [tilt])]


def test_the_report_can_be_read_and_its_bars_hold(at_a_thousandth):
    topic = claim.report(AS_PREDICTED, AT_RIGHT_ANGLES, [at_a_thousandth])
    assert [figure.verdict for figure in topic.figures] == [True, None, None, True, True, True]
    for page in (html([topic], ABOUT, 1.0), markdown([topic], ABOUT, 1.0)):
        assert "Hayati" in page
    assert (
        len(
            {
                len(row)
                for table in topic.tables
                for row in itertools.chain(table.rows, [table.columns])
            }
        )
        == 3
    )


@pytest.mark.parametrize(
    "errors", [[1.0] * 6 + [1e-13], [1.0] * 7, [math.nan] * 7], ids=["six", "never", "NaN"]
)
def test_too_many_steps_miss_the_bar(at_a_thousandth, errors):
    late = at_a_thousandth._replace(screws=at_a_thousandth.screws._replace(errors=errors))
    assert verdicts(late)[0] is False


@pytest.mark.parametrize(
    ("planted", "number"),
    [((10.0, 10.0, 21.0), 3), ((10.0, 10.0, math.nan), 3), ((1e9, 10.0, 12.0), 4)],
    ids=["POE above the bar", "POE not a number", "DH not as predicted"],
)
def test_a_condition_off_its_bar_is_seen(at_a_thousandth, planted, number):
    rows = [*AS_PREDICTED[:5], planted, *AS_PREDICTED[6:]]
    assert verdicts(at_a_thousandth, rows)[number] is False


@pytest.mark.parametrize("value", [21.0, math.nan])
def test_a_condition_of_poe_off_its_bar_at_right_angles_or_when_tilted_is_seen(
    at_a_thousandth, value
):
    right = [*AT_RIGHT_ANGLES[:5], (3.0, 10.0, value), *AT_RIGHT_ANGLES[6:]]
    assert verdicts(at_a_thousandth, right=right)[5] is False
    assert verdicts(at_a_thousandth._replace(conditions=(1e5, 10.0, value)))[5] is False


def test_a_table_with_twist_is_the_published_one_but_for_that_twist():
    table, published = table_with(0.25), dh.published("puma560")
    rows = list(published.rows)
    rows[SHOULDER] = dataclasses.replace(rows[SHOULDER], alpha=0.25)
    assert list(table.rows) == rows
