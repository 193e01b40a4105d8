"""A calibration that shares no code with the package: products of exponentials in NumPy, each screw
moved by all six numbers, SciPy's least squares, and Gauss-Newton steps until they are rounding.

Derivatives are exact, by complex steps: nothing here compares or takes an absolute value.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import least_squares

STEP = 1e-100
SEEN = 1e-9
"""Singular values below this part of the largest are those of the gauge: six numbers an axis are two
too many, and a base or tool that moves with all axes changes nothing."""
MOST = 60


def hat(w):
    x, y, z = w
    o = 0 * x
    return np.array([[o, -z, y], [z, o, -x], [-y, x, o]])


def small_motion(eta):
    """exp of a twist (ω; v), by its series: (4, 4)."""
    X = np.zeros((4, 4), eta.dtype)
    X[:3, :3] = hat(eta[:3])
    X[:3, 3] = eta[3:]
    power = np.eye(4)
    total = np.eye(4)
    for k in range(1, 15):
        power = power @ X / k
        total = total + power
    return total


def moved(axis, eta):
    """The screw (ω; v) of an axis that a motion e^eta has moved."""
    T = small_motion(eta)
    ω = T[:3, :3] @ axis[:3]
    return ω, T[:3, :3] @ axis[3:] + np.cross(T[:3, 3], ω)


def points(screws, home, point, eta, x):
    """Places (N, 3) of a point of the tool at joint values x (N, n)."""
    p = np.tile((home @ small_motion(eta[-1]))[:3] @ [*point, 1.0], (len(x), 1))
    for i in reversed(range(len(screws))):
        ω, v = moved(screws[i], eta[i])
        foot = np.cross(ω, v)  # a point on the axis, as |ω| = 1
        arm = (p - foot).T
        W = hat(ω)
        # Rodrigues
        p = (arm + np.sin(x[:, i]) * (W @ arm) + (1 - np.cos(x[:, i])) * (W @ W @ arm)).T + foot
    return p


def fit(screws, home, point, q, measured, basis):
    """Function of readings q, whose basis is `basis(q)` (N, n, k), to the places of the point, fitted to
    `measured` (N, 3).
    """
    n = len(screws)
    B = basis(q)

    def predicted(p, q, B):
        x = q + B @ p[6 * (n + 1) :]
        return points(screws, home, point, p[: 6 * (n + 1)].reshape(n + 1, 6), x)

    def residuals(p):
        return 1e3 * (predicted(p, q, B) - measured).ravel()

    def jacobian(p):
        steps = 1j * STEP * np.eye(len(p))
        return np.array([residuals(p + step).imag / STEP for step in steps]).T

    jac: Any = jacobian  # SciPy has no types: its own default, a text, is taken for that of jac
    start = np.zeros(6 * (n + 1) + B.shape[2])
    p = least_squares(residuals, start, jac=jac, xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=30).x
    for _ in range(MOST):
        J = jacobian(p)
        step = np.linalg.lstsq(J, residuals(p), rcond=SEEN)[0]
        p = p - step
        # mm, of all predictions: in directions that hardly show a step is longer and changes nothing
        change = np.abs(J @ step).max()
        if change < 1e-10:
            return lambda q: predicted(p, q, basis(q))
    raise AssertionError(f"the independent fit did not converge: its last step changed {change} mm")
