"""Jacobians of exp and their inverses against integrals of matrix exponentials."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

from poekin.formulas.lie import exp_jacobian
from tests.formulas.matrices import ad
from tests.formulas.on_both_sides import VECTORS, V, same


def integral(M):
    """The integral of exp(M s) over s in 0..1, which is a corner of an exponential."""
    n = len(M)
    return expm(np.block([[M, np.eye(n)], [np.zeros((n, 2 * n))]]))[:n, n:]


@pytest.mark.parametrize(
    "w", VECTORS, ids=lambda w: f"{np.linalg.norm(w):.3g} about {np.round(w, 2)}"
)
def test_the_jacobians_are_the_integral_of_the_exponential_of_ad(w):
    J = integral(ad((*w, *V)))
    same(exp_jacobian.left(w), J[:3, :3].ravel())
    same(exp_jacobian.left_dual(w, V), J[3:, :3].ravel())
    inverse = np.linalg.inv(J)
    same(exp_jacobian.left_inverse(w), inverse[:3, :3].ravel())
    same(exp_jacobian.left_inverse_dual(w, V), inverse[3:, :3].ravel())
