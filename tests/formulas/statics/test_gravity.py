"""Gravity torques are the derivatives of the height of all masses, by products of exponentials in 40
digits.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from poekin.formulas.statics import gravity

U = 2.0**-53


def motion(screw, x):
    """e^{A x} as a (4, 4) matrix in 40 digits, by its series."""
    w, v = screw[:3], screw[3:]
    X = mpmath.matrix(
        [[0, -w[2], w[1], v[0]], [w[2], 0, -w[0], v[1]], [-w[1], w[0], 0, v[2]], [0] * 4]
    )
    return mpmath.expm(X * x)


def work(screws, bodies, x, g):
    """What gravity has done on all masses at x."""
    T = mpmath.eye(4)
    total = mpmath.mpf(0)
    for screw, (m, *c), value in zip(screws, bodies, x, strict=True):
        T = T * motion(screw, value)
        p = T * mpmath.matrix([*c, 1])
        total += m * sum(g[k] * p[k] for k in range(3))
    return total


def arm(seed):
    """Screws, bodies, values and gravity of an arm of all kinds of joints, over many magnitudes."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 5))
    axes = rng.normal(size=(n, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    feet = rng.normal(size=(n, 3)) * 10.0 ** rng.uniform(-3, 1, (n, 1))
    pitches = rng.choice([0.0, 0.0, 0.2], n)
    screws = np.hstack([axes, np.cross(feet, axes) + pitches[:, None] * axes])
    slides = rng.random(n) < 0.3
    screws[slides] = np.hstack([np.zeros((n, 3)), axes])[slides]
    masses = 10.0 ** rng.uniform(-2, 2, n) * (rng.random(n) < 0.8)
    bodies = np.column_stack([masses, rng.normal(size=(n, 3))])
    x = rng.uniform(-3, 3, n)
    return screws, bodies, x, rng.normal(size=3)


def bound(screws, bodies, x, g):
    """Each e^{A x} is applied to the moments once and to gravity once, with entries that are right to
    6 u: 12 u for each joint of the whole, and as much for the products that make the torque.
    """
    slides = np.abs(np.einsum("ni,ni->n", screws[:, :3], screws[:, 3:]) * x)
    straight = ~screws[:, :3].any(axis=1)
    slides[straight] = np.abs(x[straight])
    far = np.linalg.norm(bodies[:, 1:], axis=1).max()
    far += 2 * np.linalg.norm(screws[:, 3:], axis=1).sum() + slides.sum()
    return 24 * (len(x) + 1) * U * np.linalg.norm(g) * bodies[:, 0].sum() * far


@pytest.mark.parametrize("seed", range(5))
def test_a_torque_is_how_fast_the_weights_sink(seed):
    screws, bodies, x, g = arm(seed)
    n = len(x)
    forces = [[0.0] * 3 for _ in range(n)]
    arguments = screws.tolist(), bodies.tolist(), x.tolist(), np.sin(x).tolist(), np.cos(x).tolist()
    gravity.torques(*arguments, g.tolist(), n, forces)
    with mpmath.workdps(40):
        exact = [
            float(
                mpmath.diff(
                    lambda h, i=i: work(
                        screws.tolist(), bodies.tolist(), x + h * np.eye(n)[i], g.tolist()
                    ),
                    0,
                )
            )
            for i in range(n)
        ]
    off = np.abs(np.array(forces)[:, 0] - exact)
    assert off.max() <= bound(screws, bodies, x, g)
