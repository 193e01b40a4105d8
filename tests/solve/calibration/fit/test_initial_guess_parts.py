"""The parts of the initial guesses: what is taken for rounding, and what each least-squares problem
is.
"""

from __future__ import annotations

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.groups import se3, so3
from poekin.solve.calibration.fit import initial_guess
from poekin.solve.calibration.fit.initial_guess import _multilateral, _nearer, _of_fours, _rigid
from poekin.solve.calibration.fit.reweighted import reweighted


@pytest.fixture
def floors(monkeypatch):
    """What each robust solution of an initial guess takes for rounding, and how many rows it needs."""
    found = []

    def noted(solve, count, need, floor, *first):
        found.append((count, need, floor))
        return reweighted(solve, count, need, floor, *first)

    monkeypatch.setattr(initial_guess, "reweighted", noted)
    return found


def test_rounding_is_that_of_the_lengths_that_are_measured(floors):
    rng = np.random.default_rng(0)
    A, X, Z = (se3.exp(rng.normal(size=size)) for size in ((12, 6), 6, 6))
    B = se3.inverse(X) @ A @ Z
    p, c = rng.normal(size=(9, 3)), np.array([5.0, 6, 7])
    d, scale = np.linalg.norm(p - c, axis=1), 1e3
    longer = A.copy()
    longer[:, :3, 3] *= scale
    initial_guess.hand_eye(A, B)
    here = max(float(np.median(np.abs(x))) for x in (A[:, :3, 3], B[:, :3, 3] @ X[:3, :3].T))
    assert floors == [(12, 3, 1e-13), (12, 3, pytest.approx(1e-13 * here))]
    floors.clear()
    still = A * np.where(np.eye(4)[3] * (1 - np.eye(4)[3])[:, None] > 0, 0.0, 1.0)  # places of 0
    initial_guess.hand_eye(still, se3.inverse(still[0]) @ still)
    assert floors[1][2] == pytest.approx(1e-16, abs=1e-20)
    floors.clear()
    initial_guess.registration(p, p @ X[:3, :3] - 30.0)
    assert floors == [(9, 3, pytest.approx(1e-13 * np.abs(p @ X[:3, :3] - 30.0).max()))]
    floors.clear()
    initial_guess.registration(scale * p, p)
    assert floors == [(9, 3, pytest.approx(1e-13 * scale * np.abs(p).max()))]
    floors.clear()
    initial_guess.centre(p, d)
    assert floors == [(9, 4, pytest.approx(1e-13 * np.median(d)))] * 3
    floors.clear()
    far = 30 * p
    initial_guess.centre(far + 1000.0, np.linalg.norm(far - c, axis=1) / 10)
    assert floors == [(9, 4, pytest.approx(1e-13 * np.abs(far - far.mean(axis=0)).max()))] * 3
    floors.clear()
    initial_guess.centre(1e-9 * p, 1e-9 * d)
    initial_guess.registration(1e-9 * p, 1e-9 * p)
    assert [floor for _, _, floor in floors] == pytest.approx([1e-16] * 4, abs=1e-20)
    floors.clear()
    initial_guess.mean_pose(longer)
    assert floors == [
        (12, 1, 1e-13),
        (12, 1, pytest.approx(1e-13 * np.abs(longer[:, :3, 3]).max())),
    ]
    floors.clear()
    initial_guess.mean_pose(np.eye(4)[None])
    assert floors == [(1, 1, 1e-13), (1, 1, pytest.approx(1e-16))]


def least(cost, x, step=1e-4):
    """Whether a quadratic or nearly quadratic cost is least at x."""
    here = cost(x)
    assert all(cost(x + sign * step * e) > here for e in np.eye(len(x)) for sign in (1, -1))


@pytest.mark.parametrize("gross", [1.0, 30.0])
def test_a_row_of_the_linear_centre_misses_by_its_distance_and_counts_by_its_weight(gross):
    rng = np.random.default_rng(1)
    p, w, c = rng.normal(size=(12, 3)), rng.uniform(0.1, 1, 12), np.array([0.5, -2, 1])
    p[3] = c
    d = np.abs(np.linalg.norm(p - c, axis=1) + 0.05 * rng.normal(size=12))
    d[3] = 0.0
    d[5] *= gross  # no single distance says what is usual
    found, off = _multilateral(p, d, w)
    usual = np.maximum(d, 0.1 * np.median(d))

    def cost(c):
        # |p|^2 - 2 p.c + s = d^2, with s = |c|^2 taken as a number of its own; each row divided by
        # 2 d
        left, row = (p * p).sum(1) - 2 * p @ c - d * d, np.sqrt(w) / (2 * usual)
        s = -(row**2 @ left) / (row @ row)
        return float(np.sum((row * (left + s)) ** 2))

    least(cost, found)
    assert off == pytest.approx(np.abs(np.linalg.norm(p - found, axis=1) - d))


def test_the_best_of_many_fours_is_the_same_whenever_it_is_looked_for():
    rng = np.random.default_rng(4)
    p = rng.normal(size=(12, 3))
    d = np.linalg.norm(p - [0.5, -2, 1], axis=1) + 0.05 * rng.normal(size=12)
    first, second = (_of_fours(p, d) for _ in range(2))
    assert np.array_equal(first.value, second.value)


def test_the_steps_from_there_on_go_to_the_least_squares_of_the_distances():
    rng = np.random.default_rng(2)
    p, w, c = rng.normal(size=(12, 3)), rng.uniform(0.1, 1, 12), np.array([0.5, -2, 1])
    d = np.linalg.norm(p - c, axis=1) + 0.01 * rng.normal(size=12)
    found, off = _nearer(p, d, c + 0.1, w)
    least(lambda c: float(w @ (np.linalg.norm(p - c, axis=1) - d) ** 2), found)
    assert off == pytest.approx(np.abs(np.linalg.norm(p - found, axis=1) - d))
    assert _nearer(p, np.linalg.norm(p - p[2], axis=1), p[2].copy(), w)[0] == pytest.approx(p[2])


def test_a_rigid_fit_counts_each_point_by_its_weight():
    rng = np.random.default_rng(3)
    b, w = rng.normal(size=(8, 3)), rng.uniform(0.1, 1, 8)
    a = b @ so3.exp([0.3, 0.2, -0.5]).T + [1, 2, 3] + 0.1 * rng.normal(size=(8, 3))
    T, off = _rigid(a, b, w)
    least(lambda xi: float(w @ ((se3.exp(xi) @ T)[:3, :3] @ b.T - a.T + (se3.exp(xi) @ T)[:3, 3:]).T.__pow__(2).sum(1)),
          np.zeros(6))  # fmt: skip
    assert off == pytest.approx(np.linalg.norm(b @ T[:3, :3].T + T[:3, 3] - a, axis=1))


def test_measurements_that_are_all_zero_are_said_to_be_flat():
    with pytest.raises(
        InputError,
        match=(
            r"^an initial guess of the centre of distances needs points that are not in one plane, these "
            r"are \(0 m along it and 0 m out of it, rms\): the centre and its mirror image fit alike; "
            r"give the centre, or a rough one \(guess=\), or measure out of the plane$"
        ),
    ):
        initial_guess.centre(np.ones((4, 3)), np.zeros(4))
    with pytest.raises(
        InputError,
        match=(
            r"^an initial guess of the frame of points needs points that are not on one line, these are "
            r"\(0 m along it and 0 m out of it, rms\): measure more of them, in other poses of the arm$"
        ),
    ):
        initial_guess.registration(np.zeros((4, 3)), np.zeros((4, 3)))


@pytest.mark.parametrize("scatter, turns, words", [
    (0.0, [1e-6, 0, 0], r"it was not turned \(by 1e-06 rad about its first, 0 about a second, rms, where the rotations "
     r"scatter by 0\): turn it more, or give both frames$"),
    (0.0, [2e-6, 1e-6, 0], "it was turned about one axis only"),
    (0.0, [2e-6, 2e-6, 0], None),
    (0.1, [0.1, 0.0, 0], "it was not turned"),
    (0.1, [0.3, 0.1, 0], r"it was turned about one axis only \(by 0\.3 rad about its first, 0\.1 about a second"),
    (0.1, [0.3, 0.11, 0], None),
    (0.2, [0.3, 0.21, 0], None),
    (0.25, [0.3, 0.3, 0], r"no two frames fit: they leave 0\.25 rad between the measured rotations and the arm's"),
    (0.25, [0.3, 0.19, 0], "it was turned about one axis only"),
    (0.25, [0.3, 0.2, 0], "it was turned about one axis only"),
])  # fmt: skip
def test_a_hand_has_to_turn_about_two_axes_by_more_than_the_rotations_scatter(
    scatter, turns, words, monkeypatch
):
    monkeypatch.setattr(initial_guess, "extents", lambda x: np.array(turns))
    R = np.tile(np.eye(3), (3, 1, 1))
    if words is None:
        initial_guess._check_turns(R, scatter)
    else:
        with pytest.raises(InputError, match=words):
            initial_guess._check_turns(R, scatter)


def test_a_chord_is_twice_the_sine_of_half_the_angle():
    angles = np.array([0.0, 0.3, 2.0, np.pi])
    R = so3.exp(angles[:, None] * np.array([0.6, 0, 0.8]))
    assert initial_guess._chord(R - np.eye(3)) == pytest.approx(2 * np.sin(angles / 2))


def test_a_linear_solution_counts_each_row_by_its_weight_and_misses_by_its_length():
    rng = np.random.default_rng(4)
    design, rhs, w = rng.normal(size=(9, 3, 4)), rng.normal(size=(9, 3)), rng.uniform(0.1, 1, 9)
    x, off = initial_guess._linear(design, rhs, w)
    least(lambda x: float(w @ np.sum((design @ x - rhs) ** 2, axis=1)), x)
    assert off == pytest.approx(np.linalg.norm(design @ x - rhs, axis=1))
