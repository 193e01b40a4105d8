"""The cases that the report on accuracy judges: what they cover, and that of many the worst are
picked.
"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from benchmarks.accuracy import longdouble_oracle, worst_cases, worst_errors
from poekin.groups import se3, so3
from poekin.testing.accuracy.error_bounds import BOTH_SIGNS, UNIT
from poekin.testing.oracles import exact

MANY = 20_000


def spread(x: np.ndarray) -> list[float]:
    """The smallest, the quarters and the largest."""
    return np.quantile(x, [0, 0.25, 0.5, 0.75, 1]).tolist()


def evenly(low: float, high: float) -> Any:
    """The spread of many numbers that lie evenly between two, to many deviations of a quarter."""
    return pytest.approx([low + k * (high - low) / 4 for k in range(5)], abs=0.02 * (high - low))


def size(x: np.ndarray) -> np.ndarray:
    return np.linalg.norm(x, axis=-1)


def test_angles_are_a_grid_and_three_kinds_of_random_ones():
    angles = worst_errors._angles(np.random.default_rng(0), 10.0, 8000)
    grid, wide, usual, even = np.split(angles, [len(angles) - 8000, -6000, -2000])
    marks = {
        0.0,
        1.0,
        1e-1,
        1e-9,
        1e-16,
        1e-20,
        1e-30,
        1e-150,
        math.pi,
        10.0,
        2 * math.pi,
        3 * math.pi,
    }
    marks |= {math.pi - 0.1, math.pi - 1e-8, math.pi - 1e-15}
    for switch in (2e-140, 1.0, 2.0):
        marks |= {math.nextafter(switch, 0), switch, math.nextafter(switch, 9)}
    assert marks <= set(grid)
    assert len(grid) == 17 + 14 + 9 + 15 + 5
    assert spread(np.log10(wide)) == evenly(-150, 1)
    assert spread(np.log10(usual)) == evenly(-10, 1)
    assert spread(even) == evenly(0, 10)
    assert angles.min() == 0
    principal = worst_errors._angles(np.random.default_rng(0), math.pi, 100)
    assert principal.max() == math.pi
    assert principal.min() == 0
    assert len(principal) == 100 + len(grid) - 2  # 2π and 3π are beyond


def test_lengths_do_not_depend_on_angles():
    angles = np.geomspace(1e-9, 10, MANY)
    xi = worst_errors._twists(np.random.default_rng(0), angles)
    assert size(xi[:, :3]) == pytest.approx(angles, rel=1e-14)
    assert spread(np.log10(size(xi[:, 3:]))) == evenly(-9, 3)
    assert abs(np.corrcoef(np.log(angles), np.log(size(xi[:, 3:])))[0, 1]) < 0.03


def test_towards_pi_are_poses_from_the_last_bit_to_1e_12():
    poses = worst_errors._near_pi(np.random.default_rng(0), 200)
    gaps = np.array([float(exact.mp.pi - exact.norm(exact.log(T)[:3])) for T in poses])
    assert poses.shape == (200, 4, 4)
    assert gaps.max() == pytest.approx(1e-12, rel=0.3, abs=0)
    assert np.median(gaps) < 2e-14
    drawn: list[tuple[Any, ...]] = []

    class Least:
        def uniform(self, low: float, high: float, count: int) -> np.ndarray:
            drawn.append((low, high, count))
            return np.full(count, low)

        def integers(self, low: int, high: int, count: int) -> np.ndarray:
            drawn.append((low, high, count))
            return np.arange(count) % 3

    kept: dict[str, np.ndarray] = {}

    def twists(rng: Any, angles: np.ndarray) -> np.ndarray:
        kept["gaps"] = math.pi - angles
        return np.zeros((len(angles), 6))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(worst_errors, "_twists", twists)
        worst_errors._near_pi(Least(), 3)  # type: ignore[arg-type]
    assert drawn == [(-16, -12, 3), (0, 3, 3)]
    assert kept["gaps"] == pytest.approx(
        [0, 8 * UNIT, 16 * UNIT], abs=4 * UNIT
    )  # 1e-16 rounds to no gap


def test_noise_is_of_every_size_up_to_1e_8():
    R = np.zeros((MANY, 3, 3))
    noise = np.abs(worst_errors._noisy(np.random.default_rng(0), R)).max(axis=(1, 2))
    assert np.quantile(np.log10(noise), [0.25, 0.5, 0.75]) == pytest.approx(
        [-14.8, -12.55, -10.3], abs=0.2
    )
    assert 0.9e-8 < noise.max() < 1e-8
    signs = worst_errors._noisy(np.random.default_rng(0), R)
    assert abs(np.mean(signs > 0) - 0.5) < 0.01
    ones = np.broadcast_to(np.eye(3), (MANY, 3, 3))
    assert np.array_equal(worst_errors._noisy(np.random.default_rng(0), ones), ones + signs)


def test_axes_are_anywhere_or_along_an_axis_or_nearly_so():
    n = worst_cases.axes(np.random.default_rng(0), MANY)
    assert size(n) == pytest.approx(np.ones(MANY), rel=1e-15)
    tilt = np.sort(np.abs(n), axis=1)[:, 1]
    exactly = tilt == 0
    assert np.mean(exactly) == pytest.approx(1 / 6, abs=0.01)
    assert np.mean(exactly | (tilt < 1e-3)) == pytest.approx(1 / 6 + 14 / 16 / 6, abs=0.01)
    small = np.log10(tilt[~exactly & (tilt < 1e-3)])
    assert small.min() < -16.5
    assert np.median(small) == pytest.approx(-10, abs=0.4)
    for k in range(3):
        assert np.mean(np.abs(n[exactly, k])) == pytest.approx(1 / 3, abs=0.03)
        assert np.mean(n[~exactly, k] > 0) == pytest.approx(0.5, abs=0.16)


def test_twists_to_pick_from_have_every_angle_length_and_direction():
    xi = worst_cases.twists(np.random.default_rng(0), MANY, 4.0)
    w, v = xi[:, :3], xi[:, 3:]
    assert spread(size(w)) == evenly(0.05, 4)
    assert spread(np.log10(size(v))) == evenly(-2, 2)
    across = size(np.cross(w, v)) / size(w) / size(v)
    assert np.mean(across < 0.9) > 0.5
    assert np.mean(across < 1e-3) == pytest.approx(1 / 8, abs=0.06)
    assert 1e-5 < np.quantile(across, 0.08) < 1e-3


def planted(truth: Any, rng: np.random.Generator) -> Any:
    """A function that is wrong by about 1e-3, differently in each number of each case."""
    return lambda x: (truth(x) + 1e-3 * rng.normal(size=truth(x).shape)).astype(float)


XI = worst_cases.twists(np.random.default_rng(1), 300, 3.0)
POSES = se3.exp(XI)


@pytest.fixture
def judged_by(monkeypatch) -> Any:
    """The errors by which a function picks its cases."""

    def errors_of(function: Any, *arguments: Any) -> list[np.ndarray]:
        seen: list[np.ndarray] = []
        monkeypatch.setattr(
            worst_cases, "_picked", lambda cases, *errors: seen.extend(errors) or cases
        )
        assert function(*arguments) is arguments[-1]
        return seen

    return errors_of


def test_of_exp_rotations_and_translations_are_picked_by_their_own_sizes(judged_by):
    T = planted(longdouble_oracle.exp, np.random.default_rng(2))(XI)
    error = (T - longdouble_oracle.exp(XI)).astype(float)
    R, t = judged_by(worst_cases.of_exp, SimpleNamespace(exp=lambda xi: T), XI)
    rotations = size(error[:, :3, :3].reshape(-1, 9)) / (1 + math.sqrt(2) * size(XI[:, :3]))
    translations = size(error[:, :3, 3]) / (
        size(longdouble_oracle.exp(XI)[:, :3, 3].astype(float)) + size(XI[:, 3:])
    )
    assert pytest.approx(rotations, rel=1e-9) == R.astype(float)
    assert pytest.approx(translations, rel=1e-9) == t.astype(float)


def test_of_log_halves_are_picked_by_their_own_sizes(judged_by):
    xi, truth = (
        planted(longdouble_oracle.log, np.random.default_rng(2))(POSES),
        longdouble_oracle.log(POSES).astype(float),
    )
    theta = size(truth[:, :3])
    kappa = theta / 2 / np.sin(theta / 2)
    w, v = judged_by(worst_cases.of_log, SimpleNamespace(log=lambda T: xi), POSES)
    angular = size((xi - truth)[:, :3]) / (theta * (1 + 1.22 * kappa * np.minimum(1, 1 / theta)))
    linear = size((xi - truth)[:, 3:]) / (size(truth[:, 3:]) + kappa * size(POSES[:, :3, 3]))
    assert w.astype(float) == pytest.approx(angular, rel=1e-9)
    assert v.astype(float) == pytest.approx(linear, rel=1e-9)


def test_of_a_jacobian_blocks_are_picked_by_their_own_sizes(judged_by):
    J = planted(longdouble_oracle.left_jacobian, np.random.default_rng(2))(XI)
    error = (J - longdouble_oracle.left_jacobian(XI)).astype(float)
    blocks, corners = judged_by(
        worst_cases.of_jacobian, SimpleNamespace(left_jacobian=lambda xi: J), "left_jacobian", XI
    )
    assert blocks.astype(float) == pytest.approx(size(error[:, :3, :3].reshape(-1, 9)), rel=1e-9)
    linear = size(error[:, 3:, :3].reshape(-1, 9)) / size(XI[:, 3:])
    assert corners.astype(float) == pytest.approx(linear, rel=1e-9)


def test_nan_is_the_worst_of_all():
    cases, errors = np.arange(100), np.linspace(1, 2, 100)
    errors[5] = np.nan
    assert worst_cases._picked(cases, errors).tolist() == [5, *range(85, 100)]
    assert worst_cases._picked(cases, errors, -errors).tolist() == [*range(16), *range(85, 100)]
    row = worst_errors._worst("an error", 1.0, cases, errors)
    assert (row.error, row.passed, row.cases, row.worst) == (math.inf, False, 100, 5)
    row = worst_errors._worst("an error", 2.0, cases, np.arange(2.0, -98.0, -1))
    assert (row.what, row.error, row.passed, row.worst) == ("an error", 2.0, True, 0)


def test_a_wrong_sign_of_log_is_reported_with_its_gap():
    gaps = np.array([1e-3, 1e-2])
    n = np.array([0.6, 0.0, 0.8])
    xi = np.concatenate([(math.pi - gaps)[:, None] * n, np.ones((2, 3))], axis=1)
    T = se3.exp(xi)

    def flipped(function: Any, which: int) -> Any:
        signs = np.where(np.arange(2) == which, -1.0, 1.0)[:, None]
        return SimpleNamespace(log=lambda X: function(X) * signs)

    nothing = (
        SimpleNamespace(log=lambda X: 0 * se3.log(X)),
        SimpleNamespace(log=lambda X: 0 * so3.log(X)),
    )
    assert worst_errors._log_rows(nothing[1], nothing[0], T)[1].error == 0
    for rotation, pose, gap in (
        (so3, se3, 0.0), (flipped(so3.log, 0), se3, 1e-3), (so3, flipped(se3.log, 1), 1e-2)
    ):  # fmt: skip
        errors, signs = worst_errors._log_rows(rotation, pose, T)
        assert errors.passed == (gap == 0)
        assert signs.error == pytest.approx(gap, rel=1e-9)
        assert signs.bar == worst_errors.SIGN_BAR


def test_a_subject_that_leaves_out_a_result_is_not_judged_by_the_others():
    short = SimpleNamespace(exp=lambda xi: se3.exp(xi)[:2], log=lambda T: se3.log(T)[:2])
    with pytest.raises(ValueError, match="shorter"):
        worst_errors._exp_ratios(so3, short, XI[:3])
    with pytest.raises(ValueError, match="shorter"):
        worst_errors._log_rows(so3, short, POSES[:3])
    rotation = SimpleNamespace(exp=lambda w: so3.exp(w)[:2], log=lambda R: so3.log(R)[:2])
    with pytest.raises(ValueError, match="shorter"):
        worst_errors._exp_ratios(rotation, se3, XI[:3])
    with pytest.raises(ValueError, match="shorter"):
        worst_errors._log_rows(rotation, se3, POSES[:3])
    with pytest.raises(ValueError, match="shorter"):
        worst_errors._noise_errors(rotation, POSES[:3, :3, :3])
    jacobians = SimpleNamespace(
        left_jacobian=se3.left_jacobian, right_jacobian=lambda xi: se3.right_jacobian(xi)[:2]
    )
    with pytest.raises(ValueError, match="shorter"):
        worst_errors._jacobian_rows("jacobian", jacobians, XI[:3], XI[:3])


def test_of_log_and_exp_the_worse_of_rotation_and_pose_counts():
    exact_poses = SimpleNamespace(
        exp=lambda xi: np.stack([exact.rounded(exact.exp(x)) for x in xi])
    )
    wrong = SimpleNamespace(exp=lambda xi: exact_poses.exp(xi) + 1e-3)
    few = XI[:3]
    fine = worst_errors._exp_ratios(exact_poses, exact_poses, few)
    assert max(fine) < 1
    assert min(worst_errors._exp_ratios(wrong, exact_poses, few)) > 1e9
    assert (
        worst_errors._exp_ratios(exact_poses, wrong, few) == [math.inf] * 3
    )  # the last row is wrong too


def test_noise_within_the_last_bits_of_pi_may_have_either_sign():
    n = np.array([0.6, 0.0, 0.8])
    for gap, either in ((BOTH_SIGNS / 4, True), (1e-10, False)):
        R = exact.rounded(exact.exp(exact.exactly(n) * (exact.mp.pi - exact.mp.mpf(gap))))
        for sign in (1, -1):
            rotation = SimpleNamespace(
                log=lambda R, sign=sign: sign * exact.rounded(exact.log(R[0]))[None]
            )
            (error,) = worst_errors._noise_errors(rotation, R[None])
            assert (error < 1e-14) == (either or sign == 1)


@pytest.mark.parametrize(("samples", "near_pi"), [(12, 20), (84, 21)])
def test_the_report_judges_a_grid_random_cases_and_the_worst_of_many(samples, near_pi, monkeypatch):
    seen: dict[str, Any] = {}

    def rows(name: str) -> Any:
        def judged(*arguments: Any) -> list[worst_errors.Row]:
            seen[name if isinstance(arguments[0], SimpleNamespace) else arguments[0]] = arguments
            return [worst_errors.Row(name, 0.0, 1.0, 1, np.zeros(6))]

        return judged

    def some_near_pi(rng: Any, count: int) -> np.ndarray:
        seen["near π"] = count
        return np.full((count, 4, 4), 7.0)

    monkeypatch.setattr(worst_errors.exact, "exp", lambda x: np.eye(4))
    monkeypatch.setattr(worst_errors, "_near_pi", some_near_pi)
    monkeypatch.setattr(worst_errors, "_noisy", lambda rng, R: seen.setdefault("noisy", R))
    monkeypatch.setattr(worst_errors, "_log_rows", rows("log"))
    monkeypatch.setattr(worst_errors, "_jacobian_rows", rows("jacobians"))
    monkeypatch.setattr(
        worst_errors, "_exp_ratios", lambda rotation, pose, xi: seen.setdefault("exp", xi)[:, 0]
    )
    monkeypatch.setattr(worst_errors, "_noise_errors", lambda rotation, R: R[:, 0, 0])
    monkeypatch.setattr(
        worst_cases, "of_exp", lambda pose, many: seen.setdefault("many far", many)[:2]
    )
    monkeypatch.setattr(
        worst_cases, "of_log", lambda pose, many: seen.setdefault("many poses", many)[:3]
    )
    subject = SimpleNamespace()
    found = worst_errors.worst_errors(
        seed=1, samples=samples, sweep=50, rotation=subject, pose=subject
    )
    grid = 60
    assert [row.what for row in found] == [
        "exp: error ÷ attainable", "log", "log of a noisy rotation: error", "jacobians", "jacobians"
    ]  # fmt: skip
    assert seen["near π"] == near_pi
    assert len(seen["exp"]) == grid + samples + 2
    assert np.array_equal(seen["exp"][-2:], seen["many far"][:2])
    assert size(seen["exp"][:, :3]).max() == pytest.approx(10, rel=1e-12)
    T = seen["log"][2]
    assert len(T) == grid - 2 + samples + near_pi + 3
    assert np.array_equal(T[-3:], seen["many poses"][:3])
    assert np.count_nonzero(T[:, 0, 0] == 7) == near_pi
    assert seen["noisy"].shape == (samples, 3, 3)
    assert 0 < np.count_nonzero(seen["noisy"][:, 0, 0] == 7) < samples, "of both"
    for name, largest, count in (("jacobian", 10.0, grid), ("jacobian_inverse", math.pi, grid - 2)):
        _, _, cases, many = seen[name]
        assert len(cases) == count + samples
        assert len(many) == 50
        assert size(cases[:, :3]).max() == pytest.approx(largest, rel=1e-12)
        assert 0.9 * largest < size(many[:, :3]).max() < largest
    assert np.array_equal(seen["many far"], seen["jacobian"][3])
    assert np.allclose(
        seen["many poses"],
        longdouble_oracle.exp(seen["jacobian_inverse"][3]).astype(float),
        atol=1e-15,
    )


def test_warnings_of_what_is_judged_are_errors():
    with pytest.raises(FloatingPointError):
        worst_errors.worst_errors(
            samples=4, sweep=4, pose=SimpleNamespace(exp=lambda xi: 1 / np.zeros((len(xi), 4, 4)))
        )
