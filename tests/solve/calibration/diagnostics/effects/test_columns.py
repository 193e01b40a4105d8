"""Columns of effects are the derivatives of the measured numbers along what each effect moves."""

from __future__ import annotations

from itertools import pairwise, starmap
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import escape_unprintable
from poekin.solve.calibration import Points
from poekin.solve.calibration.diagnostics.effects.columns import (
    effects,
    joint_name,
    parts,
    point_shifts,
    twists,
)
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem
from poekin.solve.calibration.terms.conditions import parse_conditions
from tests.solve.calibration.diagnostics.effects.mixed import (
    ARM,
    DEVICE,
    ENDS,
    POINTS,
    SIGMA,
    N,
    Q,
    fit_of,
    problem_of,
)

KINDS = {
    "compliance": "gravity",
    "harmonics": "angle",
    "second harmonics": "angle",
    "lag": "lag",
    "backlash": "backlash",
}
CONDITIONS, REFERENCE = parse_conditions({"time": np.arange(float(N)) ** 2}, Q)
STEP = 1e-6
# of second derivatives of some m, and rounding of 1e-15 m over the step
TOL = 1e-8


@pytest.fixture(scope="module")
def problem():
    return problem_of(np.random.default_rng(0).normal(size=ENDS[-1]))


def named(k: int) -> str:
    return f"joint {k + 1} ({ARM.q_names[k]})"


def test_what_moves_the_readings_moves_the_tip_as_the_parameters_of_its_terms(problem):
    rng = np.random.default_rng(1)
    p = 1e-2 * rng.normal(size=problem.size)
    found = twists(problem, p, CONDITIONS)
    expected: dict[Any, list[np.ndarray]] = {}
    for word, kind in KINDS.items():
        model = ErrorModel(ARM, ("screws", "home", word), None, problem.model.reference)
        own = np.zeros(len(model.parameters))
        own[: problem.model_size] = p[: problem.model_size]
        D = model.poses_and_twists(own, Q, model.basis(Q, CONDITIONS)).D
        for j, parameter in enumerate(model.parameters):
            if j >= problem.model_size:
                k = ARM.q_names.index(parameter.owner)
                whose = named(k) if kind in ("gravity", "angle") else ""
                expected.setdefault((kind, whose), []).append(D[..., j])
    others = [("drift", ""), ("place", ""), ("set", "")]
    assert list(found) == [*expected, *others]
    for name, columns in expected.items():
        np.testing.assert_allclose(found[name], np.stack(columns, axis=2), rtol=0, atol=1e-12)
    base = np.tile(np.eye(6), (N, 1, 1))
    np.testing.assert_array_equal(found["set", ""], base)
    drift = np.arange(N) ** 2 - np.mean(np.arange(N) ** 2)
    np.testing.assert_allclose(found["drift", ""], base * drift[:, None, None], rtol=1e-12)


def test_space_is_strained_about_the_middle_of_the_places_in_all_six_ways(problem):
    p = 1e-2 * np.random.default_rng(2).normal(size=problem.size)
    found = twists(problem, p, CONDITIONS)["place", ""]
    places = problem.poses(p)[:, :3, 3]
    from_middle = places - places.mean(axis=0)
    assert not found[:, :3].any()
    strains = []
    for k in range(6):
        E, left, *_ = np.linalg.lstsq(from_middle, found[:, 3:, k], rcond=None)
        np.testing.assert_allclose(left, 0.0, rtol=0, atol=1e-24)
        np.testing.assert_allclose(E, E.T, rtol=0, atol=1e-12)
        strains.append(E.ravel())
    assert np.linalg.matrix_rank(strains) == 6


def whitened_errors(problem: Problem, T: np.ndarray, frames: list) -> np.ndarray:
    """Errors (M,) in standard deviations, where the tip is at T (N, 4, 4)."""
    found = []
    for k, s in enumerate(problem.sets):
        found.append((s.errors(T[problem.rows[k]], frames[k]) / SIGMA[k]).ravel())
    return np.concatenate(found)


def moved_by(problem: Problem, D: np.ndarray) -> np.ndarray:
    """Difference quotient (M,) of all errors along space twists (N, 6) of the tip."""
    T = ARM.fk(Q)
    ends = []
    for sign in (1, -1):
        moved = pk.se3.exp(sign * STEP * D) @ T
        ends.append(whitened_errors(problem, moved, [[], [DEVICE], []]))
    return (ends[0] - ends[1]) / (2 * STEP)


def test_columns_are_the_difference_quotients_of_the_whitened_errors(problem):
    fit = fit_of(problem)
    found = effects(problem, fit, CONDITIONS)
    every = twists(problem, fit.p, CONDITIONS)
    base = every.pop(("set", ""))
    assert [(one.kind, one.whose) for one in found] == [
        *every,
        *(("set", f"measurement set {k} ({s.what})") for k, s in enumerate(problem.sets)),
        *(("reflector", f"reflector {j} of measurement set 1") for j in (1, 2, 3)),
    ]
    tolerance = TOL / min(map(min, SIGMA))
    for one, D in zip(found, every.values(), strict=False):
        assert one.columns.shape == (ENDS[-1], D.shape[2])
        scale = max(1.0, float(np.abs(D).max()))
        for k in range(D.shape[2]):
            slope = moved_by(problem, D[..., k] / scale)
            np.testing.assert_allclose(one.columns[:, k] / scale, slope, rtol=0, atol=tolerance)
    whole = np.stack([moved_by(problem, base[..., k]) for k in range(6)], axis=1)
    for k, one in enumerate(found[len(every) : len(every) + 3]):
        rows = slice(ENDS[k], ENDS[k + 1])
        np.testing.assert_allclose(one.columns[rows], whole[rows], rtol=0, atol=tolerance)
        assert not np.delete(one.columns, np.r_[rows], axis=0).any()
    rows = slice(ENDS[1], ENDS[2])
    for j, one in enumerate(found[-3:]):
        moved = shifted(problem, j)
        np.testing.assert_allclose(one.columns[rows], moved / SIGMA[1][0], rtol=0, atol=tolerance)
        assert not np.delete(one.columns, np.r_[rows], axis=0).any()


def shifted(problem: Problem, j: int) -> np.ndarray:
    """Difference quotients (9 N, 3) of the errors of the reflectors when one of them is moved in the
    axes of the tool.
    """
    measured = problem.sets[1].measured
    columns = []
    for axis in range(3):
        ends = []
        for sign in (1, -1):
            points = POINTS.copy()
            points[j, axis] += sign * STEP
            s = Points(measured, points, frame="unknown")
            ends.append(s.errors(ARM.fk(Q), [DEVICE]).ravel())
        columns.append((ends[0] - ends[1]) / (2 * STEP))
    return np.stack(columns, axis=1)


def test_points_that_are_not_known_are_shifted_as_those_that_are(problem):
    measured = problem.sets[1].measured
    model = problem.model
    unknown = Problem(model, Q, [Points(measured, None, frame="unknown")], [DEVICE, *POINTS])
    found = point_shifts(unknown, np.zeros(unknown.size), 0)
    for j in range(3):
        own = found[..., 3 * j : 3 * j + 3].reshape(-1, 3)
        np.testing.assert_allclose(own, shifted(problem, j), rtol=0, atol=TOL)


def test_points_are_shifted_in_the_axes_of_the_tool_at_the_rows_of_q_that_their_set_names():
    q, rows = ARM.random(0, 6), [5, 3, 4]
    plate = Points(np.zeros((3, 2, 3)), [[0, 0, 0], [0.1, 0, 0]], rows=rows)
    problem = Problem(ErrorModel(ARM, ("home",), None), q, [plate])
    found = point_shifts(problem, np.zeros(6), 0)
    np.testing.assert_allclose(found[:, 3:, 3:], ARM.fk(q[rows])[:, :3, :3], rtol=0, atol=1e-12)


def test_one_set_stands_nowhere_else_and_its_reflectors_need_no_number(problem):
    measured = problem.sets[1].measured
    alone = Problem(
        problem.model, Q, [Points(measured, POINTS, np.eye(9), frame="unknown")], [DEVICE]
    )
    whole = problem_of(np.zeros(ENDS[-1]))
    fit = fit_of(whole)
    fit.noise = type(fit.noise)(alone.sets, [None])
    found = effects(alone, fit, CONDITIONS)
    last = [(one.kind, one.whose) for one in found if one.kind in ("set", "reflector")]
    assert last == [("reflector", f"reflector {j}") for j in (1, 2, 3)]


def test_the_errors_of_the_sets_follow_each_other(problem):
    assert parts(problem) == list(starmap(slice, pairwise(ENDS)))


def test_a_joint_is_counted_from_one_and_a_long_name_is_cut():
    assert joint_name(0, "lift") == "joint 1 (lift)"
    name = 61 * "x"
    assert len(escape_unprintable(name, 60)) == 60
    assert joint_name(3, name) == f"joint 4 ({escape_unprintable(name, 60)})"
    assert joint_name(3, name[:60]) == f"joint 4 ({name[:60]})"
