"""Errors on held-out readings out of one linearisation are those of fits without these readings."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from poekin.solve.calibration import Points, Poses, calibrate
from poekin.solve.calibration.diagnostics.identification import identify_directions
from poekin.solve.calibration.fit.fitting import fit_parameters
from poekin.solve.calibration.fit.minimise import FitOptions
from poekin.solve.calibration.model.configurations import Folds
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem
from poekin.solve.calibration.selection.choose_terms import candidates, choose, gains
from poekin.solve.calibration.selection.held_out import LinearFit
from poekin.solve.calibration.terms.conditions import parse_conditions
from tests.solve.calibration.terms.sagging import arm, case

CHAIN = arm("puma560")
MADE = case(CHAIN, 0, sag=1e-3)
CONDITIONS, _ = parse_conditions(None, MADE.q)


def fitted(sets, kinds=("screws", "home"), q=MADE.q):
    problem = Problem(ErrorModel(CHAIN, kinds, None), q, sets)
    free = identify_directions(problem)[1]
    return problem, fit_parameters(problem, free, np.zeros(problem.size), FitOptions("linear"))


def test_held_out_errors_are_those_of_refits():
    problem, fit = fitted([MADE.points])
    found: Any = candidates(problem, fit, ("compliance",), CONDITIONS, "linear", Folds(5, 3))
    for chosen in ([], ["compliance"]):
        linear = found.held_out(chosen)
        kinds: Any = ("screws", "home", *chosen)
        again: Any = calibrate(CHAIN, MADE.q, MADE.points, parameters=kinds, folds=5, seed=3)
        # the linearisation leaves out second orders of errors of 1e-4, of lengths of 1 m
        assert linear.rms_length == pytest.approx(again.cross_validation.after.rms_length, rel=1e-2)


def linear(problem, fit, **groups) -> Any:
    groups = groups or {"all": fit.free}
    return LinearFit(problem, fit, "linear", Folds(5, 0), groups)


def test_repeated_readings_are_held_out_together():
    q = np.repeat(MADE.q[:30], 2, axis=0)
    p = np.repeat(MADE.points.p[:30], 2, axis=0)
    found = linear(*fitted([Points(p, MADE.points.points)], q=q))
    for rows in found._folds:
        assert set(np.bincount(rows // 6, minlength=30).tolist()) == {0, 6}
    columns = found.with_group(found.nothing, "all")
    assert found.held_out(columns).lengths.shape == (30,)


def test_an_error_counts_for_the_configuration_at_the_row_that_its_measurement_names():
    q = np.concatenate([MADE.q[[0, 0]], MADE.q[:30]])
    p = np.concatenate([MADE.points.p[[0, 0]], MADE.points.p[:30]])
    rows = np.arange(32)[::-1]
    both = Points(p, MADE.points.points), Points(p[rows], MADE.points.points, rows=rows)
    found = [linear(*fitted([points], q=q)) for points in both]
    in_order, named = (one.held_out(one.nothing).lengths for one in found)
    np.testing.assert_allclose(named, in_order, rtol=1e-6)


def test_what_one_fold_alone_knows_cannot_be_held_out():
    problem, fit = fitted([MADE.points])
    q = np.array(MADE.q)
    q[1:, 0] = q[0, 0]  # only one row says how the first joint's reading counts
    problem = Problem(ErrorModel(CHAIN, ("gains",), None), q - q[0], problem.sets)
    found = linear(problem, fit._replace(p=np.zeros(problem.size)), all=np.eye(problem.size))
    assert found.held_out(found.nothing) is not None
    q[0, 0] += 1.0
    problem = Problem(problem.model, q - q[1], problem.sets)
    found = linear(problem, fit._replace(p=np.zeros(problem.size)), all=np.eye(problem.size))
    assert found.held_out(found.with_group(found.nothing, "all")) is None


def test_columns_are_orthonormal_and_twice_the_same_is_once():
    problem, fit = fitted([MADE.points])
    found = linear(problem, fit, some=fit.free[:, :8], all=fit.free)
    some = found.with_group(found.nothing, "some")
    both = found.with_group(some, "all")
    assert both.shape[1] == fit.free.shape[1]
    np.testing.assert_allclose(both.T @ both, np.eye(both.shape[1]), atol=1e-12)
    np.testing.assert_array_equal(found.with_group(both, "some"), both)


def test_a_length_is_the_error_in_metres_whatever_the_noise():
    poses = CHAIN.fk(MADE.q)
    poses[:, :3, 3] += 1e-3 * np.sin(np.arange(180)).reshape(60, 3)
    C = np.diag([1e-8] * 3 + [1e-6, 4e-6, 2e-6])
    C[3, 4] = C[4, 3] = 1e-6
    problem, fit = fitted([Poses(poses, C)], ("home",))
    made = linear(problem, fit)
    found = made.held_out(made.nothing)
    errors = problem.errors(fit.p)[0]
    np.testing.assert_allclose(found.lengths, (errors[:, 3:] ** 2).sum(axis=1))
    whitened = np.einsum("ni,ij,nj->n", errors, np.linalg.inv(C), errors) / 6
    np.testing.assert_allclose(found.whitened, whitened)


def test_the_rule_takes_the_smallest_set_within_one_standard_error():
    problem, fit = fitted([MADE.points])
    found: Any = candidates(
        problem, fit, ("drift", "compliance"), CONDITIONS, "linear", Folds(5, 0)
    )
    assert choose(found) == ["compliance"]
    compliance = found.held_out(["compliance"])
    both = found.held_out(["compliance", "drift"])
    assert compliance.score <= min(compliance.score, both.score) + both.deviation
    by_name = {gain.name: gain for gain in gains(found, ["compliance"])}
    without = found.held_out([])
    assert by_name["compliance"].gain == without.rms_length - compliance.rms_length
    assert by_name["drift"].gain == compliance.rms_length - both.rms_length
    assert by_name["compliance"].coefficients == 2
    assert by_name["drift"].coefficients == 6


def test_too_few_readings_are_said_to_be():
    made = case(CHAIN, 2, sag=1e-3, count=12)
    problem, fit = fitted([made.points], q=made.q)
    conditions, _ = parse_conditions(None, made.q)
    found: Any = candidates(problem, fit, ("harmonics",), conditions, "linear", Folds(3, 0))
    (gain,) = gains(found, [])
    assert np.isnan(gain.gain)
    assert str(gain) == "harmonics: not in the fit, too few readings to judge it"
    assert choose(found) == []
