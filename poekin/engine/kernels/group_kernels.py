"""Kernels of SO(3) and SE(3): each maps one formula over the rows of an array."""

from ...algebra import angular, axes, cross, from_axes, inverse, linear, store_row
from ...formulas.lie import defect, euler, exp_jacobian, exponential, logarithm, quaternion
from ..jit.array_io import load_matrix, load_rotation, store_matrix, store_rotation
from ..jit.kernel import kernel


@kernel("r2 w3")
def so3_exp(w, R):
    """exp [w] of rows."""
    for k in range(w.shape[0]):
        R_k = exponential.so3(angular(w[k]))
        store_rotation(R[k], R_k)


@kernel("r3 w2")
def so3_log(R, w):
    """Principal log of matrices."""
    for k in range(w.shape[0]):
        w_k = logarithm.so3(load_rotation(R[k]))
        store_row(w[k], w_k)


@kernel("r3 r2 w2")
def so3_log_near(R, near, w):
    """The log nearest to a given one."""
    for k in range(w.shape[0]):
        R_k = load_rotation(R[k])
        w_k = logarithm.so3_near(R_k, angular(near[k]))
        store_row(w[k], w_k)


@kernel("r3 w2")
def so3_quaternion(R, Q):
    """Unit quaternions (w, x, y, z), w >= 0, of matrices."""
    for k in range(R.shape[0]):
        Q_k = quaternion.unit_quaternion(load_rotation(R[k]))
        store_row(Q[k], Q_k)


@kernel("r2 w3")
def so3_from_quaternion(Q, R):
    """Matrices of multiples of quaternions (w, x, y, z)."""
    for k in range(Q.shape[0]):
        q = Q[k]
        R_k = quaternion.rotation(q[0], q[1], q[2], q[3])
        store_rotation(R[k], R_k)


@kernel("r3 w2")
def so3_zyx_turns(R, turns):
    """Sines and cosines of A, B, C of matrices Rz(A) Ry(B) Rx(C)."""
    for k in range(R.shape[0]):
        turns_k = euler.zyx_turns(load_rotation(R[k]))
        store_row(turns[k], turns_k)


@kernel("r3 w2")
def so3_zyz_turns(R, turns):
    """Sines and cosines of A, B, C of matrices Rz(A) Ry(B) Rz(C)."""
    for k in range(R.shape[0]):
        turns_k = euler.zyz_turns(load_rotation(R[k]))
        store_row(turns[k], turns_k)


@kernel("r2 w3")
def so3_left(w, J):
    """J(w) of rows."""
    for k in range(w.shape[0]):
        J_k = exp_jacobian.left(angular(w[k]))
        store_rotation(J[k], J_k)


@kernel("r2 w3")
def so3_left_inverse(w, J):
    """J(w)^-1 of rows."""
    for k in range(w.shape[0]):
        J_k = exp_jacobian.left_inverse(angular(w[k]))
        store_rotation(J[k], J_k)


@kernel("r2 w3")
def se3_exp(xi, T):
    """exp of twists."""
    for k in range(xi.shape[0]):
        w = angular(xi[k])
        v = linear(xi[k])
        store_matrix(T[k], exponential.se3(w, v))


@kernel("r3 w2")
def se3_log(T, xi):
    """Principal log of poses."""
    for k in range(xi.shape[0]):
        xi_k = logarithm.se3(load_matrix(T[k]))
        store_row(xi[k], xi_k)


@kernel("r3 r2 w2")
def se3_log_near(T, near, xi):
    """The log whose angular part is nearest to that of a given twist."""
    for k in range(xi.shape[0]):
        T_k = load_matrix(T[k])
        w_near = angular(near[k])
        v_near = linear(near[k])
        xi_k = logarithm.se3_near(T_k, w_near, v_near)
        store_row(xi[k], xi_k)


@kernel("r3 w3")
def se3_inverse(T_ab, T_ba):
    """Inverses of poses."""
    for k in range(T_ab.shape[0]):
        store_matrix(T_ba[k], inverse(load_matrix(T_ab[k])))


def _store_blocks(J, diagonal, corner):
    """The 6x6 matrix [diagonal 0; corner diagonal], each block by its first nine numbers."""
    for r in range(3):
        for c in range(3):
            J[r][c] = diagonal[3 * r + c]
            J[r + 3][c + 3] = diagonal[3 * r + c]
            J[r + 3][c] = corner[3 * r + c]
            J[r][c + 3] = 0.0


@kernel("r3 w3")
def se3_adjoint(T_ab, Ad):
    """Ad of poses: [p] R is p x each column of R."""
    for k in range(T_ab.shape[0]):
        T = load_matrix(T_ab[k])
        X, Y, Z, p = axes(T)
        crossed = from_axes(cross(p, X), cross(p, Y), cross(p, Z), p)
        _store_blocks(Ad[k], T, crossed)


@kernel("r2 w3")
def se3_left(xi, J):
    """Left Jacobian of exp at twists."""
    for k in range(xi.shape[0]):
        w = angular(xi[k])
        v = linear(xi[k])
        diagonal = exp_jacobian.left(w)
        _store_blocks(J[k], diagonal, exp_jacobian.left_dual(w, v))


@kernel("r2 w3")
def se3_left_inverse(xi, J):
    """Inverse of the left Jacobian of exp at twists."""
    for k in range(xi.shape[0]):
        w = angular(xi[k])
        v = linear(xi[k])
        diagonal = exp_jacobian.left_inverse(w)
        corner = exp_jacobian.left_inverse_dual(w, v)
        _store_blocks(J[k], diagonal, corner)


@kernel("r3 w1", returns="int")
def first_defect(M, found):
    """Index of the first matrix whose 3x3 corner misses a rotation by more than found[0], or of
    which the fourth row is off; on return `found` holds the largest entry of abs(R R^T - I), det R
    and the fourth row's error. Else -1, or -2 where there is a fourth row with NaN in it.
    """
    limit = found[0]
    none = -1
    for k in range(M.shape[0]):
        R = load_rotation(M[k])
        off = defect.orthonormality(R)
        sign = defect.determinant(R)
        last = 0.0
        if M.shape[1] == 4:
            row = M[k][3]
            last = abs(row[0]) + abs(row[1]) + abs(row[2]) + abs(row[3] - 1.0)
        if off > limit or sign < 0.0 or last > limit:
            store_row(found, (off, sign, last))
            return k
        if last != last:
            none = -2
    return none
