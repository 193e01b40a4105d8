"""The second oracle agrees with the truth, and does not where the truth is off in the 40th digit."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.testing.conform import confirm
from poekin.testing.oracles import exact

XI = np.array([0.4, -0.2, 0.7, 1.5, -2.0, 0.1])
SMALL = np.concatenate([1e-12 * XI[:3], XI[3:]])
T = exact.rounded(exact.exp(XI))
SCREWS, HOME, X = (
    np.array([[0, 0, 1.0, 0, 0, 0], [0, 1.0, 0, -0.3, 0, 0]]),
    T,
    np.array([0.3, -1.0]),
)

CASES = {
    "exp": ("exp", lambda: confirm.of_exp(XI)),
    "exp of a small angle": ("exp", lambda: confirm.of_exp(SMALL)),
    "exp of SO(3)": ("exp", lambda: confirm.of_exp(XI[:3])),
    "log": ("log", lambda: confirm.of_log(T)),
    "log of SO(3)": ("log", lambda: confirm.of_log(T[:3, :3])),
    "left": ("left_jacobian", lambda: confirm.of_jacobian("left_jacobian", XI)),
    "right": ("right_jacobian", lambda: confirm.of_jacobian("right_jacobian", XI)),
    "left inverse": (
        "left_jacobian_inverse",
        lambda: confirm.of_jacobian("left_jacobian_inverse", XI),
    ),
    "right inverse": (
        "right_jacobian_inverse",
        lambda: confirm.of_jacobian("right_jacobian_inverse", XI[:3]),
    ),
    "pose": ("forward", lambda: confirm.of_pose(SCREWS, HOME, X)),
}


@pytest.mark.parametrize("name", CASES)
def test_the_oracles_agree_and_a_planted_error_of_1e_40_is_seen(name, monkeypatch):
    function, agrees = CASES[name]
    assert agrees()
    true = getattr(exact, function)

    def wrong(*arguments):
        result = np.array(true(*arguments), dtype=object)
        result.flat[1] += exact.mp.mpf(10) ** -40
        return result

    monkeypatch.setattr(exact, function, wrong)
    assert not agrees()


def test_another_branch_is_no_logarithm(monkeypatch):
    true = exact.log

    def longer(R):
        w = true(R)
        return w * (1 - 2 * exact.mp.pi / exact.norm(w))

    monkeypatch.setattr(exact, "log", longer)
    assert not confirm.of_log(T[:3, :3])


def test_the_adjoint_and_velocities_are_confirmed_and_a_wrong_one_is_not(monkeypatch):
    columns = np.stack(
        [exact.exactly(SCREWS[0]), exact.adjoint(exact.exp(SCREWS[0] * X[0])) @ SCREWS[1]], axis=1
    )
    assert confirm.of_velocities(SCREWS, HOME, X, columns)
    columns[2, 0] += exact.mp.mpf(10) ** -30
    assert not confirm.of_velocities(SCREWS, HOME, X, columns)
    assert confirm.of_adjoint(T)
    true = exact.adjoint
    monkeypatch.setattr(exact, "adjoint", lambda T: true(T) + exact.mp.mpf(10) ** -10)
    assert not confirm.of_adjoint(T)


FAR = np.concatenate([XI[:3], 1000 * XI[3:]])  # |v| of 2000


def _off(x: np.ndarray, place: int, by: float) -> np.ndarray:
    other = np.array(x, dtype=object)
    other.flat[place] += exact.mp.mpf(by)
    return other


def edge(agrees, limit: float) -> None:
    """Errors up to the limit are let pass, and larger ones are not."""
    assert agrees(0.9 * limit)
    assert not agrees(1.1 * limit)


@pytest.mark.parametrize("place", range(16))
def test_60_digits_of_the_largest_number_are_asked_for_of_each(place):
    truth = exact.exp(FAR)
    limit = 1e-60 * (1 + float(max(abs(x) for x in truth.flat)))
    for by, near in (
        (0.9 * limit, True),
        (-0.9 * limit, True),
        (1.1 * limit, False),
        (-1.1 * limit, False),
    ):
        assert confirm.is_exp(FAR, _off(truth, place, by)) == near
    assert not confirm.is_exp(XI[:3], _off(exact.exp(XI[:3]), place % 9, 3e-60))
    edge(lambda by: confirm.is_exp(np.zeros(6), _off(np.eye(4), place, by)), 2e-60)


def test_a_logarithm_is_held_to_60_digits_of_the_rotation_and_of_the_lengths():
    X = exact.rounded(exact.exp(FAR))
    truth = exact.log(X)
    assert confirm.is_log(X, truth)
    for k in range(6):
        assert not confirm.is_log(X, _off(truth, k, 1e-55))
    for k in range(3):
        assert confirm.is_log(X, _off(truth, 3 + k, 1e-58))  # of 2000
        assert not confirm.is_log(X[:3, :3], _off(truth[:3], k, 1e-58))
    assert confirm.is_log(X[:3, :3], truth[:3])


def test_a_half_turn_is_a_logarithm_and_more_is_none():
    R = np.diag([1.0, -1.0, -1.0])
    pi = exact.mp.pi
    assert confirm.is_log(R, exact.exactly([1, 0, 0]) * pi)
    assert confirm.is_log(R, exact.exactly([-1, 0, 0]) * pi)
    assert not confirm.is_log(R, exact.exactly([3, 0, 0]) * pi)
    # a rotation that leaves a symmetric factor, but is not near
    assert not confirm.is_log(R, exact.exactly([0, 0, 0]))


def test_velocities_are_asked_of_every_joint_and_number():
    columns = exact.exactly(np.zeros((6, 2)))
    columns[:, 0], columns[:, 1] = SCREWS[0], exact.adjoint(exact.exp(SCREWS[0] * X[0])) @ SCREWS[1]
    assert confirm.of_velocities(SCREWS, HOME, X, columns)
    for place in range(12):
        assert not confirm.of_velocities(SCREWS, HOME, X, _off(columns, place, 1e-45))
    assert confirm.of_velocities(SCREWS[:0], HOME, X[:0], columns[:, :0])
    assert confirm.near(
        confirm.chain_of([SCREWS[0] * X[0], SCREWS[1] * X[1]]), exact.forward(SCREWS, np.eye(4), X)
    )


def test_each_number_of_an_adjoint_is_asked_for(monkeypatch):
    true = exact.adjoint(T)
    for place in range(36):
        monkeypatch.setattr(exact, "adjoint", lambda T, place=place: _off(true, place, 1e-10))
        assert not confirm.of_adjoint(T)
        assert confirm.of_adjoint(T, 1e-9)


W_SMALL, W_LARGE = [0.0, 0.0, 0.0], [0.0, 0.0, 3.0]
# v is turned by up to 1.5 rad: of its entries and those of the translation each is the largest
# once.
LOGARITHMS = [
    (W_SMALL, [0.1, 0, 0]), (W_SMALL, [0, 0, 0]), (W_LARGE, [0.1, 0.05, 0.02]), (W_SMALL, [5.0, 1, 2]),
    (W_SMALL, [1, 5.0, 2]), (W_SMALL, [1, 2, 5.0]), ([0, 0, 1.57], [700.0, 700, 0]), ([1.57, 0, 0], [0, 700.0, 700]),
    ([0, 1.57, 0], [700.0, 0, 700]), ([0, 0, 3.1], [900.0, 1, 1]),
]  # fmt: skip


@pytest.mark.parametrize(("w", "v"), LOGARITHMS)
def test_a_translation_is_held_in_proportion_to_the_lengths(w, v):
    truth = exact.exactly([*w, *v])
    X = exact.exp(truth)
    limit = 1e-60 * (1 + max(abs(float(x)) for x in (*v, *X[:3, 3])))
    for place in (3, 7, 11):
        edge(lambda by, place=place: confirm.is_log(_off(X, place, by), truth), limit)


def test_a_rotation_is_held_to_60_digits_and_its_angle_to_pi():
    for k in range(3):
        # E - E^T is twice the angle.
        edge(lambda by, k=k: confirm.is_log(np.eye(3), exact.exactly(by * np.eye(3)[k])), 0.5e-60)
        n = exact.exactly(np.eye(3)[k])
        for rest in ([], [2.0, 3.0, 4.0]):

            def of_angle(by: float, n=n, rest=rest) -> bool:
                truth = np.concatenate([n * (exact.mp.pi + exact.mp.mpf(by)), exact.exactly(rest)])
                return confirm.is_log(exact.exp(truth), truth)

            edge(of_angle, 1e-60)
    n = exact.exactly([1, 1, 1]) / exact.mp.sqrt(3)
    assert not confirm.is_log(np.eye(3), n * exact.mp.pi), "symmetric, and a half turn away"


@pytest.mark.parametrize(("length", "scale"), [(0.0, 2), (0.25, 2), (1e3, 1001)])
def test_an_adjoint_is_held_to_14_digits_of_the_square_of_what_is_in_it(length, scale, monkeypatch):
    pose = np.eye(4)
    pose[1, 3] = length
    true = exact.adjoint(pose)
    for place in range(18, 36):  # the lower half, in which a twist's v comes out

        def agrees(by: float, *within: float, place=place) -> bool:
            monkeypatch.setattr(exact, "adjoint", lambda T: _off(true, place, by))
            return confirm.of_adjoint(pose, *within)

        edge(agrees, 1e-14 * scale**2)
        edge(lambda by, agrees=agrees: agrees(by, 1e-7), 1e-7 * scale**2)


@pytest.mark.parametrize(
    "name", ["left_jacobian", "right_jacobian", "left_jacobian_inverse", "right_jacobian_inverse"]
)
@pytest.mark.parametrize("length", [0.0, 0.25, 1e3])
def test_a_jacobian_of_exp_is_held_to_60_digits_of_what_is_in_it(name, length, monkeypatch):
    xi = np.array([0, 0, 0, 0, -length, 0])
    limit = 1e-60 * (1 + length) ** (2 if name.endswith("inverse") else 1)
    true = getattr(exact, name)(xi)
    for place in (
        18,
        25,
        35,
    ):  # in the lower half J is [.. I]: an error of its inverse comes out as it is

        def agrees(by: float, place=place) -> bool:
            monkeypatch.setattr(exact, name, lambda xi: _off(true, place, by))
            return confirm.of_jacobian(name, xi)

        edge(agrees, limit)


@pytest.mark.parametrize(("column", "scale"), [([0, 0, 1, 0, 0, 0], 2), ([0, 0.25, 0, 0.5, 0, 0], 1.5),
                                               ([0, 0, 1, 0, -1e3, 0], 1001)])  # fmt: skip
def test_a_velocity_is_held_to_50_digits_of_the_square_of_its_column(column, scale):
    for place in range(6):

        def agrees(by: float, place=place) -> bool:
            return confirm.of_velocities(
                [column], np.eye(4), [0.5], _off(exact.exactly(column), place, by)[:, None]
            )

        edge(agrees, 1e-50 * scale**2)
