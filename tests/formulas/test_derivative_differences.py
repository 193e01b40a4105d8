"""Derivatives of Jacobians, formula by formula, against central differences of Jacobians made of
matrix exponentials.

A step of 1e-5 leaves 1e-10 of a third derivative (up to 1e3 here); a wrong sign or index is an
error of about 1.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

from poekin.formulas.kinematics import derivatives, screw_changes

rng = np.random.default_rng(8)
MOST, STEP, CLOSE = 4, 1e-5, 2e-7
SCREWS, HOME_XI = rng.normal(size=(MOST, 6)), rng.normal(size=6)
X, RATES, SECOND = rng.normal(size=(3, MOST))
COUNTS = pytest.mark.parametrize("count", [1, 2, 3, 4])
FRAMES = pytest.mark.parametrize("frame", ["space", "body", "hybrid"])


def hat(w):
    return np.cross(np.eye(3), w)


def exp(xi):
    X = np.zeros((4, 4))
    X[:3, :3], X[:3, 3] = hat(xi[:3]), xi[3:]
    return expm(X)


def Ad(T):
    R, p = T[:3, :3], T[:3, 3]
    return np.block([[R, np.zeros((3, 3))], [hat(p) @ R, R]])


def twist_of(D, T):
    """The twist of dT T^-1."""
    V = D @ np.linalg.inv(T)
    return np.r_[V[2, 1], V[0, 2], V[1, 0], V[:3, 3]]


HOME = exp(HOME_XI)


def flat(T):
    return (*T[:3, :3].ravel().tolist(), *T[:3, 3].tolist())


def products(screws, x):
    """P_0 = I, P_i = P_{i-1} e^{A_i x_i}, and f = P_n M."""
    found = [np.eye(4)]
    for S, xi in zip(screws, x, strict=True):
        found.append(found[-1] @ exp(S * xi))
    return found


def jacobian(screws, home, x, frame):
    before = products(screws, x)
    f = before[-1] @ home
    J = np.transpose([Ad(T) @ S for T, S in zip(before, screws, strict=False)])
    if frame == "body":
        return Ad(np.linalg.inv(f)) @ J
    if frame == "hybrid":
        at = np.eye(4)
        at[:3, 3] = -f[:3, 3]
        return Ad(at) @ J
    return J


def slope(function: Any) -> Any:
    return (function(STEP) - function(-STEP)) / (2 * STEP)


def close(got, expected):
    np.testing.assert_allclose(got, expected, rtol=0, atol=CLOSE)


@COUNTS
@FRAMES
def test_a_rate_is_the_difference_of_jacobians_along_a_motion(frame, count):
    A, x, dx = SCREWS[:count], X[:count], RATES[:count]
    J, dJ = jacobian(A, HOME, x, frame), np.full((6, count), np.nan)
    getattr(derivatives, f"{frame}_rate")(J, dx, count, dJ)
    close(dJ, slope(lambda h: jacobian(A, HOME, x + h * dx, frame)))
    ddx = SECOND[:count]
    expected = slope(
        lambda h: jacobian(A, HOME, x + h * dx + h * h / 2 * ddx, frame) @ (dx + h * ddx)
    )
    close(derivatives.acceleration(J, dJ, dx, ddx, count), expected)


@COUNTS
@FRAMES
def test_a_hessian_is_the_difference_of_jacobians_along_each_joint(frame, count):
    A, x = SCREWS[:count], X[:count]
    H = np.full((6, count, count), np.nan)
    if frame == "hybrid":
        H[:3] = 0.0  # it writes the entries that may differ from zero, into rows of zeros
    getattr(derivatives, f"{frame}_hessian")(jacobian(A, HOME, x, frame), count, H)
    for j, e in enumerate(np.eye(count)):
        close(H[:, :, j], slope(lambda h, e=e: jacobian(A, HOME, x + h * e, frame)))


@COUNTS
def test_velocities_run_along_the_chain(count):
    J = jacobian(SCREWS[:count], HOME, X[:count], "space")
    V = np.full((6, count), np.nan)
    derivatives.running(J, RATES[:count], count, V)
    np.testing.assert_allclose(V, np.cumsum(J * RATES[:count], axis=1), rtol=0, atol=1e-13)


def moved(index, eta, count):
    """The screws and the home pose after A_i <- Ad(e^eta) A_i, or M <- M e^eta for i = n."""
    A, home = SCREWS[:count].copy(), HOME
    if index == count:
        return A, home @ exp(eta)
    A[index] = Ad(exp(eta)) @ A[index]
    return A, home


@pytest.mark.parametrize("count", [1, 3])
@FRAMES
def test_what_a_screw_s_change_does_is_the_difference_it_makes(frame, count):
    x = X[:count]
    before = products(SCREWS[:count], x)
    f = before[-1] @ HOME
    P, D = np.full((count + 2, 12), np.nan), np.full((6, count + 1, 6), np.nan)
    screw_changes.products(
        [flat(exp(S * q)) for S, q in zip(SCREWS[:count], x, strict=True)], flat(HOME), count, P
    )
    np.testing.assert_allclose(P, [flat(T) for T in (*before, f)], rtol=0, atol=1e-12)
    screw_changes.pose_changes(P, count, D)
    J_s = jacobian(SCREWS[:count], HOME, x, "space")
    C = np.full((6, count, count + 1, 6), np.nan)
    changes: Any = {"space": screw_changes.space_changes, "body": screw_changes.body_changes}
    changes.get(frame, screw_changes.hybrid_changes)(J_s, P, D, count, C)
    for i in range(count + 1):
        for e, unit in enumerate(np.eye(6)):

            def after(h, i=i, unit=unit):
                return moved(i, h * unit, count)

            pose = slope(lambda h, after=after: products(after(h)[0], x)[-1] @ after(h)[1])
            close(D[:, i, e], twist_of(pose, f))
            close(
                C[:, :, i, e],
                slope(lambda h, after=after: jacobian(after(h)[0], after(h)[1], x, frame)),
            )
