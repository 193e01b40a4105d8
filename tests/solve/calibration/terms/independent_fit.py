"""A calibration that shares no code with the package: products of exponentials in NumPy, each screw
moved by all six numbers, and SciPy's least squares with differences.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation


def hat(w):
    x, y, z = w
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], float)


def small_motion(eta):
    """exp of a twist (ω; v), by its series: (4, 4)."""
    X = np.zeros((4, 4))
    X[:3, :3] = hat(eta[:3])
    X[:3, 3] = eta[3:]
    power = np.eye(4)
    total = np.eye(4)
    for k in range(1, 25):
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
        R = Rotation.from_rotvec(x[:, i, None] * ω)
        p = R.apply(p - foot) + foot
    return p


def fit(screws, home, point, q, measured, basis):
    """Function of readings q, whose basis is `basis(q)` (N, n, k), to the places of the point, fitted to
    `measured` (N, 3).
    """
    n = len(screws)
    k = basis(q[:1]).shape[2]

    def predicted(p, q):
        x = q + basis(q) @ p[6 * (n + 1) :]
        return points(screws, home, point, p[: 6 * (n + 1)].reshape(n + 1, 6), x)

    def residuals(p):
        return 1e3 * (predicted(p, q) - measured).ravel()

    found = least_squares(
        residuals, np.zeros(6 * (n + 1) + k), jac="2-point", xtol=1e-15, ftol=1e-15, gtol=1e-15,
        max_nfev=30,
    )  # fmt: skip
    return lambda q: predicted(found.x, q)
