"""The algebra of tuples is that of matrices: each function against NumPy's product of the matrices
it stands for.

Each is a polynomial in its arguments with whole coefficients, so one point of generic numbers tells
two of them apart.
"""

from __future__ import annotations

import numpy as np
import pytest

from poekin import algebra
from tests.formulas.matrices import Ad, flat, matrix

rng = np.random.default_rng(11)
a, b, k = rng.normal(size=3), rng.normal(size=3), 0.37
V = rng.normal(size=6)
R, S = (np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in range(2))
p, r = rng.normal(size=3), rng.normal(size=3)
FEW = 1e-14  # sums of at most six products of numbers below 3, and as many in NumPy's


T, W = matrix(R, p), matrix(S, r)
TURN = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
Q, P = flat(T), flat(W)

CASES = {
    "add": (algebra.add(a, b), a + b),
    "subtract": (algebra.subtract(a, b), a - b),
    "scale": (algebra.scale(k, a), k * a),
    "dot": (algebra.dot(a, b), a @ b),
    "cross": (algebra.cross(a, b), np.cross(a, b)),
    "rotate": (algebra.rotate(Q, a), R @ a),
    "unrotate": (algebra.unrotate(Q, a), R.T @ a),
    "angular": (algebra.angular(V), V[:3]),
    "linear": (algebra.linear(V), V[3:]),
    "translation": (algebra.translation(Q), p),
    "twist": (algebra.twist(a, b), np.r_[a, b]),
    "pose": (algebra.pose([*Q, 7.0, 8.0]), Q),
    "make_pose": (algebra.make_pose(R.ravel(), p), Q),
    "transform": (algebra.transform(Q, a), R @ a + p),
    "axes": (np.ravel(algebra.axes(Q)), T[:3].T.ravel()),
    "from_axes": (algebra.from_axes(*T[:3].T), Q),
    "turn_axes": (
        np.ravel(algebra.turn_axes(a, b, 0.6, 0.8)),
        (np.c_[a, b] @ TURN[:2, :2]).T.ravel(),
    ),
    "compose": (algebra.compose(Q, P), flat(T @ W)),
    "inverse": (algebra.inverse(Q), flat(np.linalg.inv(T))),
    "adjoint": (algebra.adjoint(Q, V), Ad(T) @ V),
    "adjoint_inverse": (algebra.adjoint_inverse(Q, V), np.linalg.inv(Ad(T)) @ V),
    "turned_about_z": (
        algebra.turned_about_z(Q, 0.6, 0.8, k),
        flat(T @ matrix(TURN, (0.0, 0.0, k))),
    ),
    "identity": (algebra.IDENTITY, flat(np.eye(4))),
}


@pytest.mark.parametrize("case", CASES)
def test_a_function_of_tuples_is_the_one_of_matrices(case):
    got, expected = CASES[case]
    np.testing.assert_allclose(got, expected, rtol=0, atol=FEW)


def test_a_column_is_read_and_written_in_its_place_alone():
    J = rng.normal(size=(6, 4))
    assert algebra.column(J, 2) == tuple(J[:, 2])
    written = J.copy()
    algebra.set_column(written, 1, V)
    assert np.array_equal(written, np.c_[J[:, :1], V, J[:, 2:]])
