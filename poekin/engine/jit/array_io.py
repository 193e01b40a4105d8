"""Between the rows and matrices of arrays and the tuples of the formulas."""

from ...algebra import make_pose


def without_refcount(held):
    """An array, or a tuple of arrays, itself; in compiled code without a count of its references,
    which would go up and down with every view and cost more than the arithmetic. For arguments
    only: the caller holds them.
    """
    return held


def load_rotation(R):
    """The nine numbers of a 3x3 (or the corner of a 4x4) matrix."""
    return (R[0, 0], R[0, 1], R[0, 2], R[1, 0], R[1, 1], R[1, 2], R[2, 0], R[2, 1], R[2, 2])


def load_matrix(T):
    """The pose in a 4x4 matrix."""
    return make_pose(load_rotation(T), (T[0, 3], T[1, 3], T[2, 3]))


def store_rotation(M, R):
    """Write nine numbers into a 3x3 matrix, or into the corner of a larger one."""
    M[0, 0] = R[0]
    M[0, 1] = R[1]
    M[0, 2] = R[2]
    M[1, 0] = R[3]
    M[1, 1] = R[4]
    M[1, 2] = R[5]
    M[2, 0] = R[6]
    M[2, 1] = R[7]
    M[2, 2] = R[8]


def store_matrix(M, T):
    """Write a pose into a 4x4 matrix."""
    store_rotation(M, T)
    M[0, 3] = T[9]
    M[1, 3] = T[10]
    M[2, 3] = T[11]
    M[3, 0] = 0.0
    M[3, 1] = 0.0
    M[3, 2] = 0.0
    M[3, 3] = 1.0
