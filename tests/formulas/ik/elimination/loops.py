"""Six revolute joints drawn by a seed, and the equations of their loop, for the tests beside this file."""

import math

import numpy as np

from poekin.formulas.ik.elimination import line_equations
from poekin.groups import so3


def arm(seed):
    """Axes, the second the z axis, steps, angles and the rotation of each joint."""
    rng = np.random.default_rng(seed)
    h = rng.normal(size=(6, 3))
    h[1] = (0, 0, 1)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    x = rng.uniform(-np.pi, np.pi, 6)
    return h, rng.normal(size=(5, 3)), x, so3.exp(h * x[:, None])


def line(P, E, h):
    """Place and direction of the last axis, seen from the first one's point."""
    p = np.zeros(3)
    for i in range(4, -1, -1):
        p = E[i] @ (P[i] + p)
    d = h[5]
    for i in range(4, -1, -1):
        d = E[i] @ d
    return p, d


def tuples(a):
    return tuple(tuple(map(float, row)) for row in a)


def equations(h, P, p, d):
    """The six equations (6, 3, 3, 3) by their coefficients, and as they are written."""
    near = [math.nan] * line_equations.NEAR_SIDE
    far = [math.nan] * line_equations.FAR_SIDE
    sigma = [math.nan] * (line_equations.KEPT * line_equations.ROOM)
    h = tuples(h)
    P = tuples(P)
    line_equations.far_side(h, P, far, near)
    line_equations.near_side(h[0], P[0], tuple(map(float, p)), tuple(map(float, d)), near)
    line_equations.combine(near, far, line_equations.ROOM, sigma)
    for written in (near, far, sigma):
        assert not any(map(math.isnan, written))
    rows = np.array(sigma).reshape(6, line_equations.ROOM)
    assert (rows[:, line_equations.PLACES :] == 0.0).all()
    return rows[:, : line_equations.PLACES].reshape(6, 3, 3, 3), sigma


def halves(x):
    C, S = np.cos(x / 2), np.sin(x / 2)
    return np.array([C * C, C * S, S * S])


def products(x4, x5):
    """C_4^(3-a) S_4^a C_5^(2-b) S_5^b of the half angles."""
    C4, S4, C5, S5 = (f(x / 2) for x in (x4, x5) for f in (np.cos, np.sin))
    return [C4 ** (3 - a) * S4**a * C5 ** (2 - b) * S5**b for a in range(4) for b in range(3)]
