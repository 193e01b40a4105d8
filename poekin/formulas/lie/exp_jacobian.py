"""Left Jacobians of exp and their inverses; the right ones are the transposes of the same blocks.

    J(w) = I + B [w] + C [w]^2            J(w)^-1 = I - [w]/2 + D [w]^2

On SE(3) both diagonal 3x3 blocks are J(w) and the lower left one is its dual part: J(w + eps v) = J
+ eps Q.
Accuracy: J(w) within 5e-16 and its dual part within 5e-16 |v|, Frobenius, for |w| <= 10; the
inverses for |w| <= pi;
in the cases of tests/groups/test_accuracy.py, and within twice that in every case that the property
tests draw.
Source: Park 1994, Lemma 5 (J is the integral of exp [w] s over s in 0..1); the dual parts are
derived from it.
"""

from ...algebra import dot
from .. import elementary
from .coefficients import (
    NEAR,
    SWITCH,
    b_derivative,
    b_near,
    c_derivative,
    c_near,
    c_of,
    d_and_e,
    d_derivative,
    d_of,
)
from .compensated import length, square_rest
from .exponential import closed_form, rotation, rotation_by_cosine

_SIZE = 8.0  # a power of two above 2 pi


def _abc(w, tt):
    """A, B and C; what rounding took from |w| is put back where it counts theta times."""
    if elementary.below(tt, NEAR):
        c = c_near(tt)
        return 1.0 - tt * c, b_near(tt), c
    a, b, _ = closed_form(w, tt)
    c = c_of(tt, a)
    if elementary.below(tt, SWITCH):
        return a, b, c
    _, _, rest = length(w, tt)
    return a, b, c - c * rest / tt


def left(w):
    """J(w), row by row: d exp[w] = [J(w) dw] exp[w], Lemma 5."""
    tt = dot(w, w)
    a, b, c = _abc(w, tt)
    if elementary.below(tt, NEAR):
        return rotation(w, b, c)
    return rotation_by_cosine(w, b, c, a)


def left_inverse(w):
    """J(w)^-1, row by row, for |w| < 2 pi."""
    tt = dot(w, w)
    d, e = d_and_e(tt, square_rest(w, _SIZE, tt))
    return rotation_by_cosine(w, -0.5, d, e)


def _dual(w, v, p, q, r, s):
    """p [v] + q ([w][v] + [v][w]) + (w . v) (r [w] + s [w]^2), row by row."""
    wv = dot(w, v)
    rr = r * wv
    ss = s * wv
    q2 = 2.0 * q
    # symmetric part: q (v w^T + w v^T - 2 (w.v) I) + s (w.v) (w w^T - theta^2 I)
    xx = w[0] * (q2 * v[0] + ss * w[0])
    yy = w[1] * (q2 * v[1] + ss * w[1])
    zz = w[2] * (q2 * v[2] + ss * w[2])
    xy = q * (w[0] * v[1] + w[1] * v[0]) + ss * (w[0] * w[1])
    yz = q * (w[1] * v[2] + w[2] * v[1]) + ss * (w[1] * w[2])
    zx = q * (w[2] * v[0] + w[0] * v[2]) + ss * (w[2] * w[0])
    x = p * v[0] + rr * w[0]
    y = p * v[1] + rr * w[1]
    z = p * v[2] + rr * w[2]
    return (-(yy + zz), xy - z, zx + y, xy + z, -(xx + zz), yz - x, zx - y, yz + x, -(xx + yy))


def left_dual(w, v):
    """Q(w, v), the lower left block of the left Jacobian on SE(3), row by row."""
    tt = dot(w, w)
    a, b, c = _abc(w, tt)
    return _dual(
        w,
        v,
        b,
        c,
        b_derivative(tt, a, b),
        c_derivative(tt, b, c),
    )


def left_inverse_dual(w, v):
    """The lower left block of the inverse of the left Jacobian on SE(3), row by row, for |w| < 2
    pi.
    """
    tt = dot(w, w)
    return _dual(w, v, -0.5, d_of(tt), 0.0, d_derivative(tt))
