"""exp on SO(3) and SE(3), and Lemma 2's e^{Aq} of a joint: one body, other coefficients.

Accuracy: with u = 2^-53 and theta = |w| <= 10 the rotation is within 3 u (1 + sqrt(2) theta) in the Frobenius norm,
the translation p within 3 u (|p| + |v| + theta |dp/dw|) (tests/groups/test_accuracy.py). |w| beyond 1e154 overflows.
Source: Park 1994, Lemmas 1 and 2.
"""

from ..algebra import cross, dot, pose_of, scale, subtract
from . import elementary
from .coefficients import a_of, b_of, c_of


def rotation(w, a, b):
    """I + a [w] + b [w]^2 of a vector w, row by row: the form of exp and of its Jacobians."""
    xx, yy, zz = w[0] * w[0], w[1] * w[1], w[2] * w[2]
    xy, yz, zx = b * (w[0] * w[1]), b * (w[1] * w[2]), b * (w[2] * w[0])
    x, y, z = a * w[0], a * w[1], a * w[2]
    return (
        *(1.0 - b * (yy + zz), xy - z, zx + y),
        *(xy + z, 1.0 - b * (xx + zz), yz - x),
        *(zx - y, yz + x, 1.0 - b * (xx + yy)),
    )


def displacement(a, along, b, across, c, beyond):
    """a along + b across + c beyond: the translation of exp in any of its forms."""
    return (
        a * along[0] + b * across[0] + c * beyond[0],
        a * along[1] + b * across[1] + c * beyond[1],
        a * along[2] + b * across[2] + c * beyond[2],
    )


def so3(w):
    """exp [w] = I + A [w] + B [w]^2 of a rotation vector w (rad)."""
    tt = dot(w, w)
    t = elementary.sqrt(tt)
    return rotation(w, a_of(t), b_of(tt, t))


def se3(w, v):
    """exp of the twist (w; v): the pose (R, p).

    p = v + B w x v + C w x (w x v) where theta < 1, and A v + B w x v + C (w . v) w elsewhere: the first has no
    cancellation near theta = 0, the second none near 2 pi k.
    """
    tt = dot(w, w)
    t = elementary.sqrt(tt)
    a, b = a_of(t), b_of(tt, t)
    c = c_of(tt, a)
    across = cross(w, v)
    if tt < 1.0:
        p = displacement(1.0, v, b, across, c, cross(w, across))
    else:
        p = displacement(a, v, b, across, c, scale(dot(w, v), w))
    return pose_of(rotation(w, a, b), p)


def joint(w, v, q, sine, cosine):
    """e^{A q} of a joint's screw A = (w; v) with |w| = 1 or w = 0, the sine and cosine of q given (Lemma 2).

    p = sin q v_across + (1 - cos q) w x v + q v_along: v_along is the part of v along the axis (a helical joint's
    pitch, all of a prismatic joint's v), v_across the rest. So one form serves every kind of joint.
    """
    across = cross(w, v)
    v_across = cross(across, w)
    versine = 1.0 - cosine
    return pose_of(rotation(w, sine, versine), displacement(sine, v_across, versine, across, q, subtract(v, v_across)))
