"""A fit ends where it says that it does, and its covariance is one."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.groups import se3
from poekin.solve import calibration
from poekin.solve.calibration import EyeInHand, Points, Poses, calibrate
from poekin.solve.calibration.diagnostics.identification import identify_directions
from poekin.solve.calibration.fit import fitting
from poekin.solve.calibration.fit import minimise as minimising
from poekin.solve.calibration.fit.fitting import fit_frames
from poekin.solve.calibration.fit.minimise import (
    FitOptions,
    _exact,
    _Linear,
    _solution,
    minimise,
    regular,
)
from poekin.solve.calibration.fit.noise import Noise, NoiseEstimate, estimate_noise
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem

PUMA = pk.load("puma560").chain()
X, Z = se3.exp([0.3, -0.5, 0.2, 1.0, 0.4, -0.3]), se3.exp([-0.1, 0.2, 1.4, 0.05, -0.08, 0.1])
GANTRY = pk.Chain.from_space(
    [pk.screw.prismatic([1, 0, 0]), pk.screw.prismatic([0, 1, 0]), pk.screw.prismatic([0, 0, 1])],
    se3.exp([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]),
)


def off(arm: pk.Chain, seed: int = 1, size: float = 2e-3) -> pk.Chain:
    parameters = ErrorModel(arm, ("screws", "home"), None)
    return parameters.chain(
        size * np.random.default_rng(seed).normal(size=len(parameters.parameters))
    )


def noisy(count: int = 40) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(2)
    q = PUMA.random(rng, count)
    return q, off(PUMA).fk(q) @ se3.exp(2e-4 * rng.normal(size=(count, 6)))


@pytest.mark.parametrize("loss", ["linear", "huber", "tukey"])
@pytest.mark.parametrize("most", [1, 2, 4])
def test_the_most_steps_are_those_of_all_rounds_together(loss, most):
    q, T = noisy()
    found = calibrate(PUMA, q, T, loss=loss, folds=0, iterations=most)
    assert len(found.steps) <= most + (loss == "tukey")
    assert not found.success


def test_the_folds_make_no_more_steps_either():
    q, T = noisy()
    few, many = (calibrate(PUMA, q, T, iterations=most).cross_validation for most in (1, 100))
    assert few is not None
    assert many is not None
    assert few.after.rms_length != many.after.rms_length


@pytest.mark.parametrize("seed", range(3))
def test_rotations_that_fit_from_the_start_do_not_keep_a_gantry_from_its_axes(seed):
    """Nothing turns: the estimated spread of angles is rounding, and every step that tilts an axis
    would break it.
    """
    q = GANTRY.random(0, 30)
    T = se3.inverse(X) @ off(GANTRY, seed, 2e-2).fk(q) @ Z
    found = calibrate(GANTRY, q, EyeInHand(T, board=X, camera=Z), folds=0)
    assert found.success
    assert found.before.rms_length > 1e-3
    assert found.after.rms_length < 1e-12


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("loss", ["linear", "huber"])
def test_noise_of_places_alone_is_estimated_beside_rotations_without_any(loss, seed):
    rng = np.random.default_rng(seed)
    q = GANTRY.random(rng, 200)
    T = se3.inverse(X) @ off(GANTRY, seed, 1e-2).fk(q) @ Z
    T[:, :3, :3] = T[0, :3, :3]
    T[:, :3, 3] += 1e-4 * rng.normal(size=(200, 3))
    found = calibrate(GANTRY, q, EyeInHand(T, board=X, camera=Z), folds=0, loss=loss)
    assert found.success
    (spread,) = found.noise_std
    assert spread is not None
    # 600 numbers: the rms is known to 3 %, the median to 5 %; four deviations
    assert spread.length == pytest.approx(1e-4, rel=0.2)


@pytest.mark.parametrize("seed", range(5))
def test_a_search_that_only_damped_steps_go_on_in_has_not_converged(seed):
    """Down a valley so narrow that steps are damped until they promise hardly anything, far above
    its floor, 0.
    """
    q = GANTRY.random(0, 30)
    sets = [EyeInHand(se3.inverse(X) @ off(GANTRY, seed, 2e-2).fk(q) @ Z, board=X, camera=Z)]
    problem = Problem(ErrorModel(GANTRY, ("screws", "home"), None), q, sets)
    start = fit_frames(problem, "linear")
    narrow = Noise(sets, [NoiseEstimate(1e-15, 1e-2)])
    found = minimise(problem, identify_directions(problem)[1], narrow, start, FitOptions("linear"))
    assert not found.converged or np.abs(problem.errors(found.p)[0]).max() < 1e-9


def test_a_base_a_kilometre_away_converges_to_rounding():
    rng = np.random.default_rng(7)
    there = se3.exp([0, 0, 0, 1000.0, 1000.0, 1000.0])
    screws = [pk.screw.revolute(rng.normal(size=3), rng.uniform(-1, 1, 3)) for _ in range(7)]
    arm = pk.Chain.from_space(
        np.array(screws) @ se3.adjoint(there).T, there @ se3.exp(rng.normal(size=6))
    )
    q = rng.uniform(-1.5, 1.5, (30, 7))
    true = off(arm)
    found = calibrate(arm, q, true.fk(q)[:, :3, 3], folds=0)
    assert found.success
    assert found.after.rms_length < 1e-13 * arm.reach


def test_a_covariance_with_hardly_any_of_what_is_held_is_read_again(tmp_path):
    """Rotations without noise, and a joint that stands still: variances of rounding beside those of
    0.1 mm.
    """
    rng = np.random.default_rng(5)
    q = PUMA.random(rng, 40)
    q[:, 5] = 0.3
    T = off(PUMA).fk(q)
    T[:, :3, 3] += 1e-4 * rng.normal(size=(40, 3))
    camera = se3.inverse(X) @ T @ Z
    found = calibrate(
        PUMA, q, [Poses(T), EyeInHand(camera)], folds=0, on_rank_deficiency="fix", loss="huber"
    )
    np.testing.assert_array_equal(found.covariance, found.covariance.T)
    found.save(tmp_path / "arm.toml")
    again = calibration.load(tmp_path / "arm.toml")
    np.testing.assert_array_equal(again.covariance, found.covariance)


def test_no_configurations_have_no_pose_covariances():
    q, T = noisy()
    assert calibrate(PUMA, q, T, folds=0).pose_covariance(q[:0]).shape == (0, 6, 6)


@pytest.mark.parametrize("reach", [1.0, 1000.0])
@pytest.mark.parametrize(("times", "exact"), [(0.5, True), (2.0, False)])
@pytest.mark.parametrize("part", [0, 5])
def test_an_error_is_rounding_by_the_angle_and_by_the_arm_s_reach(part, times, exact, reach):
    home = se3.exp([0, 0, 0, reach, 0, 0])
    arm = pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [0, 0, 0])], home)
    size = 1e-13 * times * (1.0 if part == 0 else reach)
    T = se3.exp(size * np.eye(6)[part]) @ home  # what the home pose is off by, seen from the base
    T[:3, 3] = home[:3, 3] + size * np.eye(3)[2] * (part == 5)
    problem = Problem(ErrorModel(arm, ("home",), None), np.zeros((1, 1)), [Poses(T[None])])
    assert _exact(problem, np.zeros(6)) == exact


@pytest.mark.parametrize("before, after, change", [
    ([NoiseEstimate(1.0, 2.0)], [NoiseEstimate(1.0, 2.2)], 0.1),
    ([NoiseEstimate(1.0, 2.0)], [NoiseEstimate(0.7, 2.2)], 0.3),
    ([NoiseEstimate(None, 2.0)], [NoiseEstimate(None, 1.0)], 0.5), ([None], [None], 0.0),
    ([NoiseEstimate(0.0, 0.0)], [NoiseEstimate(1.0, 0.0)], 0.0),
    ([NoiseEstimate(1.0, 1.0), None, NoiseEstimate(None, 2.0)],
     [NoiseEstimate(1.0, 1.0), None, NoiseEstimate(None, 3.0)], 0.5),
])  # fmt: skip
def test_spreads_change_by_the_most_that_one_of_them_does(before, after, change):
    one: Any = SimpleNamespace(noise_std=before)
    other: Any = SimpleNamespace(noise_std=after)
    assert fitting._change(one, other) == pytest.approx(change)


@pytest.mark.parametrize("loss, names", [
    ("linear", ["linear"]), ("huber", ["huber"]), ("tukey", ["huber", "tukey"]), ("cauchy", ["huber", "cauchy"]),
])  # fmt: skip
def test_a_loss_that_may_have_several_minima_begins_with_one_that_has_one_and_goes_on_from_there(
    loss, names, monkeypatch
):
    asked, ends, counts = [], [], []

    def recorded(problem, free, noise, p, options):
        asked.append((options.loss, options.max_iterations, any(p is end for end in ends)))
        found = minimise(problem, free, noise, p, options)
        ends.append(found.p)
        counts.append(len(found.steps))
        return found

    monkeypatch.setattr(fitting, "minimise", recorded)
    q, T = noisy()
    problem = Problem(ErrorModel(PUMA, ("screws", "home"), None), q, [Poses(T)])
    found = fitting.fit_parameters(
        problem, identify_directions(problem)[1], np.zeros(problem.size), FitOptions(loss)
    )
    assert [name for name, _, _ in asked] == [*names, *[loss] * (len(asked) - len(names))]
    assert len(asked) > len(names)
    assert [goes_on for _, _, goes_on in asked] == [False, *[True] * (len(asked) - 1)]
    left = [most for _, most, _ in asked]
    assert left == [100 - sum(counts[:k]) for k in range(len(asked))]
    assert len(found.steps) == sum(counts)


@pytest.mark.parametrize("size", [1e-5, 1e-3])
def test_a_prior_draws_every_step_as_much_as_the_data_do(size):
    q, T = noisy(10)
    problem = Problem(ErrorModel(PUMA, ("screws", "home"), None), q, [Poses(T)])
    free, noise = np.eye(problem.size), Noise(problem.sets, [NoiseEstimate(1e-3, 1e-3)])
    prior = np.where(
        np.arange(problem.size) % 3 > 0, size, np.inf
    )  # nothing is said of every third
    found = minimise(problem, free, noise, np.zeros(problem.size), FitOptions("linear", prior))
    assert found.converged
    assert len(found.steps) <= 6
    assert all(step.damping == 0 for step in found.steps)
    errors = noise.whitened(0, problem.errors(found.p)[0][..., None]).ravel()
    jacobian = np.concatenate(
        [noise.whitened(0, D).reshape(-1, problem.size) for _, D in problem.linearised(found.p)]
    )
    pull = np.abs(jacobian.T @ errors)
    np.testing.assert_allclose(jacobian.T @ errors + found.p / prior**2, 0, atol=1e-6 * pull.max())
    assert pull[prior < np.inf].max() > 1
    assert found.steps[0].cost == pytest.approx(
        np.sum(noise.whitened(0, problem.errors(0 * found.p)[0][..., None]) ** 2)
    )


def test_a_triangle_is_regular_whose_diagonal_is_not_much_smaller_somewhere():
    assert regular(np.diag([1.0, -2e-8]))
    assert not regular(np.diag([1.0, 0.9e-8]))
    assert regular(1e-12 * np.diag([1.0, -2e-8]))  # whatever its size
    assert not regular(np.diag([0.0]))
    assert not regular(np.ones((1, 2)))
    assert regular(np.empty((0, 0)))


@pytest.mark.parametrize("damping", [0.0, 1e-3, 10.0])
def test_a_damped_step_is_held_back_in_proportion_to_its_columns(damping):
    rng = np.random.default_rng(0)
    R, c = np.triu(rng.normal(size=(4, 4))) + np.diag([1, 10, 100, 1e3]), rng.normal(size=4)
    z = _solution(_Linear(R, c), damping)
    held = damping * np.diag(np.sum(R**2, axis=0))
    np.testing.assert_allclose((R.T @ R + held) @ z, -R.T @ c, rtol=1e-9)
    # Of a singular one the shortest solution, and none of a column of nothing.
    R[:, 2] = 0.0
    assert _solution(_Linear(R, c), damping)[2] == 0


def test_an_outlier_is_named_by_its_set_its_place_there_and_its_row_of_the_readings():
    q, T = noisy()
    rows = np.arange(39, -1, -1)
    p = T[rows, :3, 3] + 1e-4 * np.random.default_rng(0).normal(size=(40, 3))
    p[5] += 0.3
    T[7, :3, 3] += 0.3
    found = calibrate(PUMA, q, [Poses(T), Points(p, rows=rows)], folds=0, loss="tukey")
    assert [tuple(o) for o in found.outliers] == [(0, 7, 7), (1, 5, 34)]


def test_damping_doubles_and_more_with_each_step_that_fails_and_falls_to_a_tenth_where_one_does_as_predicted(
    monkeypatch,
):
    q, T = noisy(10)
    problem = Problem(ErrorModel(PUMA, ("screws", "home"), None), q, [Poses(T)])
    noise, calls, cost = Noise(problem.sets, [NoiseEstimate(1e-3, 1e-3)]), [], minimising._cost

    def failing(*given):
        calls.append(given)
        return np.inf if len(calls) in (2, 3) else cost(*given)  # the first is of the start

    monkeypatch.setattr(minimising, "_cost", failing)
    found = minimise(
        problem,
        identify_directions(problem)[1],
        noise,
        np.zeros(problem.size),
        FitOptions("linear"),
    )
    assert found.converged
    # two steps fail: 1e-6, and twice that, from where the linear problem predicts every gain
    # (where two steps of success leave nothing but roundings is the processor's to say)
    assert [step.damping for step in found.steps[:2]] == pytest.approx([2e-6, 2e-7])
    assert found.steps[0].cost > found.steps[1].cost
    calls.clear()
    monkeypatch.setattr(
        minimising,
        "_cost",
        lambda *given: calls.append(given) or (1.0 if len(calls) == 1 else np.inf),
    )
    stuck = minimise(
        problem,
        identify_directions(problem)[1],
        noise,
        np.zeros(problem.size),
        FitOptions("linear"),
    )
    assert not stuck.converged
    assert (stuck.steps, stuck.p.tolist()) == ([], [0.0] * problem.size)
    # the start, the full step, and damped by 1e-6 times 2^(k (k + 1) / 2) up to the first above 1e12
    assert len(calls) == 2 + 12


def test_of_a_fit_of_frames_alone_the_arm_stays_and_without_frames_nothing_is_fitted(monkeypatch):
    q, T = noisy(10)
    rough = EyeInHand(se3.inverse(X) @ T @ Z, board=X @ se3.exp([0.01] * 6), camera=Z)
    problem = Problem(ErrorModel(PUMA, ("home",), None), q, [rough])
    p = fit_frames(problem, "linear")
    assert not p[:6].any()
    assert np.sum(problem.errors(p)[0] ** 2) < 0.1 * np.sum(problem.errors(0 * p)[0] ** 2)
    monkeypatch.setattr(fitting, "fit_parameters", None)
    p = fit_frames(Problem(ErrorModel(PUMA, ("home",), None), q, [Poses(T)]), "linear")
    assert p.tolist() == [0.0] * 6


def test_errors_of_exactly_0_take_no_step():
    q, _ = noisy(10)
    exact = Problem(ErrorModel(PUMA, ("screws", "home"), None), q, [Points(PUMA.fk(q)[:, :3, 3])])
    noise = Noise(exact.sets, [NoiseEstimate(None, 1e-3)])
    found = minimise(
        exact, identify_directions(exact)[1], noise, np.zeros(exact.size), FitOptions("linear")
    )
    assert (found.converged, found.steps, found.p.tolist()) == (True, [], [0.0] * exact.size)


def test_spreads_are_estimated_before_anything_is_fitted_and_then_for_what_was(monkeypatch):
    asked = []

    def recorded(sets, errors, free, robust, reach, even):
        asked.append((free, robust, reach, even))
        return estimate_noise(sets, errors, free, robust, reach, even)

    monkeypatch.setattr(fitting, "estimate_noise", recorded)
    q, T = noisy()
    problem = Problem(ErrorModel(PUMA, ("screws", "home"), None), q, [Poses(T)])
    fitting.fit_parameters(
        problem, identify_directions(problem)[1], np.zeros(problem.size), FitOptions("huber")
    )
    assert asked[0] == (0, True, PUMA.reach, 1e-2)
    assert len(asked) > 1
    assert set(asked[1:]) == {(30, True, PUMA.reach, 1e-6)}
