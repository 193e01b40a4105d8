"""The algebra of tuples is that of matrices: each function against NumPy's product of the matrices
it stands for.

Each is a polynomial in its arguments with whole coefficients, so one point of generic numbers tells
two of them apart.
"""

from __future__ import annotations

import numpy as np
import pytest

from poekin import algebra
from poekin.formulas import dh
from poekin.formulas.kinematics import recursive
from poekin.formulas.lie import defect, exponential

rng = np.random.default_rng(11)
a, b, k = rng.normal(size=3), rng.normal(size=3), 0.37
V = rng.normal(size=6)
R, S = (np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in range(2))
p, r = rng.normal(size=3), rng.normal(size=3)
FEW = 1e-14  # sums of at most six products of numbers below 3, and as many in NumPy's


def hat(w):
    return np.cross(np.eye(3), w)


def matrix(R, p):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


def flat(T):
    return (*T[:3, :3].ravel().tolist(), *T[:3, 3].tolist())


def Ad(T):
    """[R 0; [p] R R], twists with the angular part first."""
    R, p = T[:3, :3], T[:3, 3]
    return np.block([[R, np.zeros((3, 3))], [hat(p) @ R, R]])


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
    "pose_of": (algebra.pose_of(R.ravel(), p), Q),
    "compose": (algebra.compose(Q, P), flat(T @ W)),
    "inverse": (algebra.inverse(Q), flat(np.linalg.inv(T))),
    "adjoint": (algebra.adjoint(Q, V), Ad(T) @ V),
    "adjoint_inverse": (algebra.adjoint_inverse(Q, V), np.linalg.inv(Ad(T)) @ V),
    "turned_about_z": (
        algebra.turned_about_z(Q, 0.6, 0.8, k),
        flat(T @ matrix(TURN, (0.0, 0.0, k))),
    ),
    "identity": (algebra.IDENTITY, flat(np.eye(4))),
    "rotation": (
        exponential.rotation(a, k, 0.2),
        (np.eye(3) + k * hat(a) + 0.2 * hat(a) @ hat(a)).ravel(),
    ),
    "displacement": (exponential.displacement(0.3, a, k, b, 0.2, p), 0.3 * a + k * b + 0.2 * p),
    "z_column": (recursive.z_column(Q, 0.7, 0.4), np.linalg.inv(Ad(T)) @ [0, 0, 0.7, 0, 0, 0.4]),
    "dh link": (
        dh.link(0.6, 0.8, k, -0.2, 0.28, 0.96),
        flat(
            matrix(TURN, (0, 0, k))
            @ matrix([[1, 0, 0], [0, 0.96, -0.28], [0, 0.28, 0.96]], (-0.2, 0, 0))
        ),
    ),
    "determinant": (defect.determinant(Q), np.linalg.det(R)),
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


@pytest.mark.parametrize("row", range(3))
@pytest.mark.parametrize("column", range(3))
def test_a_defect_of_any_two_rows_is_seen_at_its_size(row, column):
    # (I + d E) (I + d E)^T misses I by d + d^T, and d^2 more
    d = 1e-3
    M = np.eye(3)
    M[row, column] -= d
    expected = 2 * d - d * d if row == column else d
    assert abs(defect.orthonormality(M.ravel()) - expected) < 1e-15
    assert defect.orthonormality(np.eye(3).ravel()) == 0.0
