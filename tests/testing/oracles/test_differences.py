"""Finite differences on the group: against motions whose velocity is known, and as exact as they
say.
"""

from __future__ import annotations

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.testing.oracles import differences, exact

SCREWS = np.array([[0, 0, 1, 0, 0, 0], [0.6, 0.8, 0, 0.16, -0.12, 0.3], [0, 0, 0, 0, 0.6, -0.8]])
HOME = exact.rounded(exact.exp([0.3, -0.2, 2.0, 0.5, -0.6, 0.7]))
Q = np.array([0.4, -1.3, 0.2])


def pose(q: np.ndarray) -> np.ndarray:
    return exact.rounded(exact.forward(SCREWS, HOME, q))


def jacobians() -> dict[str, np.ndarray]:
    """The exact Jacobians at Q, column by column out of the product of exponentials."""
    T, columns = exact.exactly(np.eye(4)), []
    for screw, x in zip(exact.exactly(SCREWS), exact.exactly(Q), strict=True):
        columns.append(exact.adjoint(T) @ screw)
        T = T @ exact.exp(screw * x)
    T, space = T @ exact.exactly(HOME), np.stack(columns, axis=1)
    turned = exact.exactly(np.eye(4))
    turned[:3, :3] = T[:3, :3]
    body = exact.adjoint(exact.inverse(T)) @ space
    return {
        "space": exact.rounded(space),
        "body": exact.rounded(body),
        "hybrid": exact.rounded(exact.adjoint(turned) @ body),
    }


@pytest.mark.parametrize("frame", ["space", "body", "hybrid"])
def test_the_jacobian_of_three_joints_is_right_to_1e_13(frame):
    J = jacobians()[frame]
    assert np.abs(differences.jacobian(pose, Q, frame) - J).max() < 1e-13
    dq = np.array([1.0, -2.0, 0.5])
    assert np.abs(differences.velocity(pose, Q, dq, frame, rate=3.0) - J @ dq).max() < 2e-13


def test_the_frames_differ_here():
    J = jacobians()
    assert (
        min(
            np.abs(J[a] - J[b]).max()
            for a, b in (("space", "body"), ("body", "hybrid"), ("hybrid", "space"))
        )
        > 0.1
    )


@pytest.mark.parametrize("rate", [1.0, 10.0, 100.0])
def test_a_faster_motion_keeps_its_digits_when_its_rate_is_given(rate):
    error = differences.derivative(lambda q: np.sin(rate * q), [0.3], [1.0], rate) - rate * np.cos(
        0.3 * rate
    )
    assert np.abs(error) < 1e-14 * rate


@pytest.mark.parametrize(("rates", "step"), [((), 0.1), ((0.5,), 0.1), ((4.0,), 0.025)])
def test_values_are_asked_for_at_12_points_a_tenth_of_a_radian_apart(rates, step):
    derivative = [differences.derivative, differences.velocity, differences.jacobian]
    for function, arguments in zip(derivative, (([2.0],), ([2.0], "body"), ("body",)), strict=True):
        asked: list[float] = []

        def f(q: np.ndarray, asked: list[float] = asked) -> np.ndarray:
            asked.append(float(q[0]))
            return HOME

        function(f, [1.0], *arguments, *rates)
        width = step * (1 if function is differences.jacobian else 2)
        points = [
            1 + k * width for k in range(-6, 7) if k or function is not differences.derivative
        ]
        assert sorted(asked) == pytest.approx(points, rel=1e-14)


def test_without_its_rate_a_fast_motion_is_wrong():
    assert (
        np.abs(differences.derivative(lambda q: np.sin(30 * q), [0.3], [1.0]) - 30 * np.cos(9))
        > 1e-4
    )


def test_polynomials_up_to_order_12_are_differentiated_exactly():
    q = np.array([0.7])
    for k in range(13):
        assert differences.derivative(lambda q, k=k: q**k, q, [1.0]) == pytest.approx(
            k * q ** max(k - 1, 0), abs=3e-14
        )


def test_no_coordinate_gives_no_column():
    assert differences.jacobian(lambda q: HOME, np.empty(0), "body").shape == (6, 0)


def test_a_function_may_return_lists():
    lists = differences.jacobian(lambda q: pose(q).tolist(), Q.tolist(), "space")
    np.testing.assert_array_equal(lists, differences.jacobian(pose, Q, "space"))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: differences.jacobian(pose, [Q, Q], "space"),
            r"q: expected shape \(m,\), one configuration, got \(2, 3\)",
        ),
        (
            lambda: differences.jacobian(pose, 0.3, "space"),
            r"q: expected shape \(m,\), one configuration, got \(\)",
        ),
        (
            lambda: differences.velocity(pose, Q, Q[:2], "space"),
            r"^expected q and dq of one shape \(m,\), got \(3,\) and \(2,\)$",
        ),
        (
            lambda: differences.velocity(pose, Q[:2], Q, "space"),
            r"one shape \(m,\), got \(2,\) and \(3,\)",
        ),
        (
            lambda: differences.velocity(pose, Q, ["a"], "space"),
            r"dq: expected numbers \(m,\), got \['a'\]",
        ),
        (
            lambda: differences.velocity(HOME, Q, Q, "space"),  # pyright: ignore
            r"f: expected a function of q, got array",
        ),
        (
            lambda: differences.jacobian(lambda q: q, Q, "space"),
            r"f: expected a pose \(4, 4\) at q, got shape \(3,\)",
        ),
        (
            lambda: differences.velocity(lambda q: np.eye(5), Q, Q, "body"),
            r"a pose \(4, 4\) at q, got shape \(5, 5\)",
        ),
        (
            lambda: differences.derivative(pose, Q, Q, np.nan),
            r"rate: expected a number from 0 .* got nan",
        ),
    ],
    ids=["batch", "number", "few rates", "many rates", "text", "array", "vector", "matrix", "rate"],
)
def test_what_is_no_argument_is_refused(call, message):
    with pytest.raises(InputError, match=message):
        call()


@pytest.mark.parametrize("frame", ["", "base", "globe", "local", "world"])
def test_an_unknown_frame_is_refused(frame):
    with pytest.raises(
        InputError, match=f'^frame must be "space", "body" or "hybrid", not {frame!r}$'
    ):
        differences.velocity(pose, Q, Q, frame)
