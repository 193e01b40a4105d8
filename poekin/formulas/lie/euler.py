"""Rotations as three turns about axes of the frame, by the sines and cosines of the turns.

    zyx: R = Rz(A) Ry(B) Rx(C)        zyz: R = Rz(A) Ry(B) Rz(C)

Of a rotation, the first turn is read off a column of R, is taken out of R, and the others are read
off what is left: what rounding does to the first, the last makes good, also near the lock, where B
is ±90° (zyx), 0 or 180° (zyz) and A and C turn about one axis. In the lock itself C = 0.
Accuracy: the rotation of the turns found is R within 6 u in every entry (plus what R itself misses
a rotation by), in the lock too, u = 2^-53 (tests/formulas/lie/test_euler.py).
Source: the first two angles of an Euler triple fix the third; C = 0 is how controllers write the
lock (KUKA C, Fanuc W).
"""

from .. import elementary

LOCK = 6.6e-16
"""Sine or cosine of B up to which A and C are one turn, 6 u: what rounding leaves of 0 in R."""


def zyx(sa, ca, sb, cb, sc, cc):
    """Rz(A) Ry(B) Rx(C) of the sines and cosines of A, B and C."""
    return (
        ca * cb,
        ca * sb * sc - sa * cc,
        ca * sb * cc + sa * sc,
        sa * cb,
        sa * sb * sc + ca * cc,
        sa * sb * cc - ca * sc,
        -sb,
        cb * sc,
        cb * cc,
    )


def zyz(sa, ca, sb, cb, sc, cc):
    """Rz(A) Ry(B) Rz(C) of the sines and cosines of A, B and C."""
    return (
        ca * cb * cc - sa * sc,
        -ca * cb * sc - sa * cc,
        ca * sb,
        sa * cb * cc + ca * sc,
        ca * cc - sa * cb * sc,
        sa * sb,
        -sb * cc,
        sb * sc,
        cb,
    )


def _first_turn(y, x):
    """(y, x) over its length, and the length; of length 0 where A and C are one turn."""
    square = x * x + y * y
    if elementary.below(square, LOCK * LOCK):
        return y, x, 0.0
    length = elementary.sqrt(square)
    return y / length, x / length, length


def zyx_turns(R):
    """Points (sine, cosine) of A, B and C, in one row; those of B and C may be of any length.

    R = Rz(A) Ry(B) Rx(C), -90° <= B <= 90°.
    """
    s, c, cosine = _first_turn(R[3], R[0])
    if cosine == 0.0:
        return (-R[1], R[4], -R[6], cosine, cosine, 1.0)
    return (s, c, -R[6], cosine, s * R[2] - c * R[5], c * R[4] - s * R[1])


def zyz_turns(R):
    """Points (sine, cosine) of A, B and C, in one row; those of B and C may be of any length.

    R = Rz(A) Ry(B) Rz(C), 0 <= B <= 180°.
    """
    s, c, sine = _first_turn(R[5], R[2])
    if sine == 0.0:
        return (-R[1], R[4], sine, R[8], sine, 1.0)
    return (s, c, sine, R[8], c * R[3] - s * R[0], c * R[4] - s * R[1])
