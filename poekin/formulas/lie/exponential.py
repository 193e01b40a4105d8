"""exp on SO(3) and SE(3), and Lemma 2's e^{Aq} of a joint: one body, other coefficients.

Accuracy: with u = 2^-53 and theta = |w| <= 10 the rotation is within 1.5 u (1 + sqrt(2) theta) in
the Frobenius norm, the translation p within 1.5 u (|p| + |v| + theta |dp/dw|), in the cases of
tests/groups/test_accuracy.py,
and within twice that in every case that the property tests draw. |w| beyond 1e154 overflows.
Source: Park 1994, Lemmas 1 and 2.
"""

from ...algebra import add, cross, dot, make_pose, scale, subtract
from .. import elementary
from .coefficients import NEAR, b_near, c_near
from .compensated import length


def rotation(w, a, b):
    """I + a [w] + b [w]^2 of a vector w, row by row: the form of exp and of its Jacobians."""
    xx = w[0] * w[0]
    yy = w[1] * w[1]
    zz = w[2] * w[2]
    return _with_diagonal(
        w,
        a,
        b,
        1.0 - b * (yy + zz),
        1.0 - b * (xx + zz),
        1.0 - b * (xx + yy),
    )


def _with_diagonal(w, a, b, first, second, third):
    """a [w] + b w w^T with another diagonal, row by row."""
    xy = b * (w[0] * w[1])
    yz = b * (w[1] * w[2])
    zx = b * (w[2] * w[0])
    x = a * w[0]
    y = a * w[1]
    z = a * w[2]
    return (
        *(first, xy - z, zx + y),
        *(xy + z, second, yz - x),
        *(zx - y, yz + x, third),
    )


def linear_combination(a, u, b, v, c, w):
    """a u + b v + c w of three vectors: the translation of exp in any of its forms."""
    return (
        a * u[0] + b * v[0] + c * w[0],
        a * u[1] + b * v[1] + c * w[1],
        a * u[2] + b * v[2] + c * w[2],
    )


def _diagonal(b, along, across, cosine):
    """cos theta + b along = 1 - b across, along + across = theta^2: of the smaller square, so 1
    about a frame axis.
    """
    if across < along:
        return 1.0 - b * across
    return cosine + b * along


def rotation_by_cosine(w, a, b, cosine):
    """cos theta I + a [w] + b w w^T, row by row: the same as I + a [w] + b [w]^2 where theta is
    large.
    """
    xx = w[0] * w[0]
    yy = w[1] * w[1]
    zz = w[2] * w[2]
    return _with_diagonal(
        w,
        a,
        b,
        _diagonal(b, xx, yy + zz, cosine),
        _diagonal(b, yy, zz + xx, cosine),
        _diagonal(b, zz, xx + yy, cosine),
    )


def closed_form(w, tt):
    """(A, B, cos theta) of a rotation vector, theta >= 1, from tt = |w|^2 to rounding.

    What rounding took from tt and from its root is put back to first order: else it would count
    sqrt(2) theta times in the rotation.
    """
    t, dt, rest = length(w, tt)
    inverse = 1.0 / t
    sine = elementary.sin(t)
    cosine = elementary.cos(t)
    versine = 1.0 - cosine
    a = (sine + dt * (cosine - sine * inverse)) / t
    b = (
        versine + ((1.0 - versine - cosine) + dt * sine - versine * (inverse * inverse) * rest)
    ) / tt
    return a, b, cosine - dt * sine


def so3(w):
    """exp [w] = I + A [w] + B [w]^2 of a rotation vector w (rad): Lemma 1."""
    tt = dot(w, w)
    if elementary.below(tt, NEAR):
        return rotation(w, 1.0 - tt * c_near(tt), b_near(tt))
    return rotation_by_cosine(w, *closed_form(w, tt))


def se3(w, v):
    """exp of the twist (w; v): the pose (R, p), Lemma 2 for any length of w.

    p = v + B w x v + C w x (w x v) where theta < 1, and v_along + A v_across + B w x v elsewhere:
    v_along is the part of v along w, v_across the rest. The first has no cancellation near theta =
    0, the second none near 2 pi k.
    """
    tt = dot(w, w)
    across = cross(w, v)
    if elementary.below(tt, NEAR):
        b = b_near(tt)
        c = c_near(tt)
        return make_pose(
            rotation(w, 1.0 - tt * c, b),
            linear_combination(1.0, v, c, cross(w, across), b, across),
        )
    a, b, cosine = closed_form(w, tt)
    k = dot(w, v) / tt
    v_across = subtract(v, scale(k, w))
    more = dot(w, v_across) / tt  # of v_across, what rounding left along w
    p = add(scale(k, w), linear_combination(a, v_across, (1.0 - a) * more, w, b, across))
    return make_pose(rotation_by_cosine(w, a, b, cosine), p)


def joint(w, v, q, sine, cosine):
    """e^{A q} of a joint's screw A = (w; v) with |w| = 1 or w = 0, the sine and cosine of q given
    (Lemma 2).

    p = sin q v_across + (1 - cos q) w x v + q v_along: v_along is the part of v along the axis (a
    helical joint's pitch, all of a prismatic joint's v), v_across the rest. So one form serves
    every kind of joint.
    """
    across = cross(w, v)
    v_across = cross(across, w)
    versine = 1.0 - cosine
    return make_pose(
        rotation(w, sine, versine),
        linear_combination(sine, v_across, versine, across, q, subtract(v, v_across)),
    )
