"""`calibrate` refuses data that cannot give what is asked for, each time in words that say what is
wrong.
"""

from __future__ import annotations

import re
from types import SimpleNamespace

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.groups import se3
from poekin.solve.calibration import Distances, EyeInHand, Points, Poses, calibrate, identify
from poekin.solve.calibration.causes.most_likely import build_problem
from poekin.solve.calibration.diagnostics import units
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem

PUMA = pk.load("puma560").chain()
TRUE = ErrorModel(PUMA, ("screws", "home"), None).chain(
    2e-3 * np.random.default_rng(0).normal(size=30)
)
Q = PUMA.random(0, 40)
T = TRUE.fk(Q)
X, Z = se3.exp([0.3, -0.5, 0.2, 1.0, 0.4, -0.3]), se3.exp([-0.1, 0.2, 1.4, 0.05, -0.08, 0.1])
GANTRY = pk.Chain.from_space(
    [pk.screw.prismatic([1, 0, 0]), pk.screw.prismatic([0, 1, 0]), pk.screw.prismatic([0, 0, 1])],
    se3.exp([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]),
)


def off(arm: pk.Chain, seed: int = 1) -> pk.Chain:
    parameters = ErrorModel(arm, ("screws", "home"), None)
    return parameters.chain(
        2e-3 * np.random.default_rng(seed).normal(size=len(parameters.parameters))
    )


@pytest.mark.parametrize("ask", [calibrate, identify])
def test_no_readings_and_no_measurements_are_refused(ask):
    with pytest.raises(InputError, match=r"^q: expected readings, got none$"):
        ask(PUMA, Q[:0], T[:0])
    with pytest.raises(InputError, match=r"^measurements\[1\]: expected Points, got none$"):
        ask(PUMA, Q, [Poses(T), Points(np.empty((0, 3)), rows=np.empty(0, int))])


def test_a_list_of_unlike_things_is_no_measurement():
    for unlike in ([[1, 2], [3]], [T, Poses(T)]):
        with pytest.raises(
            ShapeError,
            match=(
                r"^measurements: expected Poses, Points, Distances, EyeInHand, EyeToHand, a list of them, "
                r"or an array \(N, 4, 4\) of poses or \(N, 3\) of points, got list of shape \(\)$"
            ),
        ):
            calibrate(PUMA, Q, unlike)


NO_NAMES = {
    "parameters": ({"parameters": 3}, r"parameters: expected names, got 3"),
    "joints": ({"joints": 3}, r"joints: expected names, got 3"),
    "a seed below 0": ({"seed": -1}, r"seed: expected a whole number from 0 on, got -1"),
    "a seed in words": ({"seed": "x"}, r"seed: expected a whole number from 0 on, got 'x'"),
    "folds": ({"folds": 41}, r"folds: 41 parts of 40 readings; folds=0 holds none out"),
}


@pytest.mark.parametrize("what", NO_NAMES)
def test_what_is_no_name_and_no_number_is_refused(what):
    given, words = NO_NAMES[what]
    with pytest.raises(InputError, match=words):
        calibrate(PUMA, Q, T, **given)


def test_as_many_numbers_as_parameters_do_not_make_the_arm_known_without_error():
    words = r"30 equations for 30 parameters leave no residuals to estimate the noise from: .*covariance="
    with pytest.raises(InputError, match=words):
        calibrate(PUMA, Q[:5], T[:5], folds=0)
    with pytest.raises(
        InputError,
        match=(
            r"^6 equations for 6 parameters leave no residuals to estimate the noise from: measure "
            r"more, or give covariance=$"
        ),
    ):
        calibrate(PUMA, Q[:1], T[:1], folds=0, on_rank_deficiency="fix")
    found = calibrate(PUMA, Q[:5], Poses(T[:5], 1e-8 * np.eye(6)), folds=0)
    assert (found.deviations > 1e-5).all()


@pytest.mark.parametrize(
    ("prior", "seen"), [({"m/rad": 1e-3}, 26), ({"rad": 1e-3}, 28)], ids=["of none", "of tilts"]
)
def test_a_prior_does_not_hide_what_it_tells_nothing_of(prior, seen):
    q = Q.copy()
    q[:, 4] = 0.0
    with pytest.raises(InputError, match=rf"identify {seen} of 30 parameters\. Unobserved: "):
        calibrate(PUMA, q, Poses(TRUE.fk(q), 1e-8 * np.eye(6)), prior=prior, folds=0)
    held = calibrate(
        PUMA, q, Poses(TRUE.fk(q), 1e-8 * np.eye(6)), prior=prior, folds=0, on_rank_deficiency="fix"
    )
    shifts = [k for k, p in enumerate(held.parameters) if p.owner == "joint5" and p.unit == "m"]
    np.testing.assert_allclose(held.values[shifts], 0.0, rtol=0, atol=1e-12)


def test_readings_of_sliding_joints_in_millimetres_are_told():
    q = GANTRY.random(0, 30)
    measured = off(GANTRY).fk(q)
    with pytest.raises(InputError, match=r"readings of sliding joints look like millimetres"):
        calibrate(GANTRY, 1e3 * q, measured)
    measured[:, :3, 3] *= 1e3
    with pytest.raises(
        InputError, match=r"all lengths look like millimetres, those of sliding joints, too"
    ):
        calibrate(GANTRY, 1e3 * q, measured)
    with pytest.raises(InputError, match=r"where the lengths look like millimetres"):
        calibrate(GANTRY, q, measured)


@pytest.mark.parametrize("seed", range(3))
def test_an_arm_that_is_far_off_is_not_called_one_in_other_units(seed):
    """Lengths made a thousandth are off by a thousandth, as the frames of camera and board are
    found for them.
    """
    rng = np.random.default_rng(seed)
    far = ErrorModel(PUMA, ("screws", "home"), None).chain(0.1 * rng.normal(size=30))
    camera = EyeInHand(se3.inverse(X) @ far.fk(Q) @ Z, board=X, camera=Z)
    with pytest.warns(pk.PoekinWarning, match=r"no other base and tool explain it"):
        found = calibrate(PUMA, Q, camera, folds=0)
    assert found.success
    assert found.before.median_length > 0.1 * PUMA.reach
    assert found.after.rms_length < 1e-12


OTHER = {
    "rows of other readings": (
        np.roll(T, 1, axis=0),
        r"no arm near the nominal one explains these Poses",
    ),
    "poses the other way round": (
        se3.inverse(T),
        r"most likely: the poses inverted; with that .* by 6\.\d* mm",
    ),
    "positions of other readings": (
        np.roll(T, 1, axis=0)[:, :3, 3],
        r"explains these Points: the best that was found is off",
    ),
    "one set of two": (
        [Poses(T), Distances(np.full(40, 9.0), [1, 0, 0])],
        r"measurement set 1 \(Distances\)",
    ),
}


@pytest.mark.parametrize("what", OTHER)
def test_measurements_that_do_not_belong_to_the_readings_are_told(what):
    measured, words = OTHER[what]
    with pytest.raises(InputError, match=words):
        calibrate(PUMA, Q, measured, folds=0)


def test_what_was_said_to_be_noise_is_no_misfit():
    """Rotations of a tracker that tells only positions: any, with a covariance that says so."""
    rng = np.random.default_rng(0)
    measured = T.copy()
    measured[:, :3, :3] = pk.so3.exp(rng.normal(size=(40, 3))) @ measured[:, :3, :3]
    C = np.diag([4.0] * 3 + [1e-10] * 3)
    found = calibrate(PUMA, Q, Poses(measured, C), folds=0)
    assert found.after.median_angle > 0.5
    assert found.after.median_length < 1e-3


def test_few_measurements_with_given_frames_are_solved_where_that_is_asked_for():
    camera = EyeInHand((se3.inverse(X) @ T @ Z)[:1], 1e-8 * np.eye(6), board=X, camera=Z)
    found = calibrate(PUMA, Q[:1], camera, folds=0, on_rank_deficiency="fix")
    assert found.identification.rank == 6
    assert found.after.rms_length < 1e-9


def test_other_units_are_told_with_how_far_the_arm_is_off_in_metres_either_way():
    measured = T.copy()
    measured[:, :3, 3] *= 1e3
    p, true = PUMA.fk(Q)[:, :3, 3], T[:, :3, 3]
    away, best = (float(np.median(np.linalg.norm(p - x, axis=1))) for x in (1e3 * true, true))
    assert best < 0.02
    words = f"the nominal arm is off by {away:.3g} m (median) as the data stand, and by {best:.3g} m where the lengths "
    with pytest.raises(InputError, match=f"^{re.escape(words)}"):
        calibrate(PUMA, Q, measured, folds=0)
    degrees = np.degrees(Q)
    stands = float(np.median(np.linalg.norm(PUMA.fk(degrees)[:, :3, 3] - true, axis=1)))
    words = (f"the nominal arm is off by {stands:.3g} m (median) as the data stand, and by {best:.3g} m where the "
             "joint angles look like degrees: give radians")  # fmt: skip
    with pytest.raises(InputError, match=f"^{re.escape(words)}"):
        calibrate(PUMA, degrees, T, folds=0)


@pytest.mark.parametrize("away, told", [(0.098, False), (0.102, True)])
def test_units_are_looked_at_from_a_tenth_of_the_reach_or_four_turns_on(away, told, monkeypatch):
    tried = []
    monkeypatch.setattr(units, "_tried", lambda *given: tried.append(given) or np.inf)
    moved = T.copy()
    moved[:, :3, 3] = PUMA.fk(Q)[:, :3, 3] + [0, 0, away * PUMA.reach]
    problem = Problem(ErrorModel(PUMA, ("screws", "home"), None), Q, [Poses(moved)])
    units.check(problem, np.zeros(problem.size))
    assert bool(tried) == told
    for turns, looked in ((3.9, told), (4.1, True)):
        q = Q.copy()
        q[0, 5] = 2 * np.pi * turns
        tried.clear()
        problem = Problem(ErrorModel(PUMA, ("screws", "home"), None), q, [Poses(moved)])
        units.check(problem, np.zeros(problem.size))
        assert bool(tried) == looked


MIXED = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([0, 0, 1])], np.eye(4)
)
LIKE = {
    "the lengths look like millimetres: give metres (divide by 1000)": ([1, 1], 1e-3),
    "the joint angles look like degrees: give radians (numpy.deg2rad)": ([np.pi / 180, 1], 1.0),
    "the readings of sliding joints look like millimetres: give metres (divide by 1000)": ([1, 1e-3], 1.0),
    "all lengths look like millimetres, those of sliding joints, too: give metres (divide by 1000)": ([1, 1e-3], 1e-3),
    "the lengths look like millimetres and the joint angles like degrees: give metres and radians": (
        [np.pi / 180, 1], 1e-3,
    ),
}  # fmt: skip


@pytest.mark.parametrize("words", LIKE)
def test_other_units_are_told_that_explain_the_data_more_than_four_times_better(words, monkeypatch):
    """A model whose distance is `left`, in the units as they stand, in these units alone, and 10 m
    in all others.
    """
    q, (factors, unit), left = np.ones((3, 2)), LIKE[words], 0.0

    def tried(problem, tried_units):
        readings, scale = units.converted(MIXED, q, tried_units), tried_units.length
        return scale * (left if np.allclose(readings, q * factors) and scale == unit else 10.0)

    monkeypatch.setattr(units, "_tried", tried)
    monkeypatch.setattr(Problem, "residuals", lambda *given: SimpleNamespace(median_length=8.0))
    problem = Problem(
        ErrorModel(MIXED, ("screws",), None), q, [Poses(np.tile(np.eye(4), (3, 1, 1)))]
    )
    left = 8.0 / 4.1
    said = f"the nominal arm is off by 8 m (median) as the data stand, and by {unit * left:.3g} m where {words}"
    with pytest.raises(InputError, match=f"^{re.escape(said)}$"):
        units.check(problem, np.zeros(problem.size))
    left = 8.0 / 3.9
    units.check(problem, np.zeros(problem.size))


def test_readings_are_converted_by_what_their_joints_are():
    np.testing.assert_allclose(
        units.converted(MIXED, np.ones((2, 2)), units.Units("", 3.0, 5.0)), [[3, 5], [3, 5]]
    )
    assert pytest.approx(np.pi / 180) == units._DEGREES.angle


def test_where_degrees_give_no_initial_guess_either_the_readings_are_refused_as_they_stand():
    q = np.zeros((6, 6))
    q[:, 5] = np.linspace(0.0, 1.0, 6)
    camera, arm = EyeInHand(se3.inverse(X) @ PUMA.fk(q) @ Z), ErrorModel(PUMA, ("home",), None)
    with pytest.raises(InputError) as alone:
        Problem(arm, q, [camera])
    assert "was turned about one axis only" in str(alone.value)
    with pytest.raises(InputError) as caught:
        build_problem(arm, q, [camera])
    assert str(caught.value) == str(alone.value)
