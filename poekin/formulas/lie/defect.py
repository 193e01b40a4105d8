"""Distance of nine numbers from a rotation. Accuracy: within 4 u of sums of products of about 1, u
= 2^-53.
"""

from ...algebra import cross, dot


def orthonormality(R):
    """The largest entry of abs(R R^T - I)."""
    x, y, z = _rows(R)
    worst = abs(dot(x, x) - 1.0)
    for entry in (
        dot(y, y) - 1.0,
        dot(z, z) - 1.0,
        dot(x, y),
        dot(y, z),
        dot(z, x),
    ):
        if abs(entry) > worst:
            worst = abs(entry)
    return worst


def determinant(R):
    """det R: +1 of a rotation, -1 of a reflection."""
    x, y, z = _rows(R)
    return dot(x, cross(y, z))


def _rows(R):
    return (R[0], R[1], R[2]), (R[3], R[4], R[5]), (R[6], R[7], R[8])
