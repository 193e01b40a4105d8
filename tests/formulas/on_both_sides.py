"""Rotation vectors on both sides of every switch of exp, log and their Jacobians."""

from __future__ import annotations

import math

import numpy as np

AXES = [np.array(a) / np.linalg.norm(a) for a in ((3, 2, 1), (1, -3, 2), (-2, 1, 3), (1, 1, -0.2))]
V, NEAR_V = np.array([0.7, -1.1, 0.4]), np.array([0.2, 0.5, -0.3])
ANGLES = (1e-9, 0.3, 0.97, 1.03, 1.97, 2.03, 3.1)
FEW = 1e-13  # of matrix functions at arguments of norm up to 7: SciPy's own accuracy, not poekin's
TURN = 2 * math.pi
VECTORS = [tuple((t * a).tolist()) for t in ANGLES for a in AXES]


def same(got, expected, far=1.0):
    np.testing.assert_allclose(got, expected, rtol=0, atol=FEW * far)
