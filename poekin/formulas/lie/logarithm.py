"""log on SO(3) and SE(3), on its principal branch or on the branch nearest to a given one.

No acos and no division by sin theta: theta comes from the quaternion of R's polar projection, so it
is as exact at pi as anywhere, and a defect d of R's orthonormality enters as d^2.
Accuracy: with u = 2^-53 and k = (theta/2)/sin(theta/2), w is within 1.5 u (1 + 1.22 k min(1,
1/theta)) of its length and v within 1.5 u (|v| + k |p| + theta |dv/dw|) of the logarithm of R's
polar projection, in the cases of tests/groups/test_accuracy.py, with or without a fused
multiplication.
Source: Park 1994, Lemmas 3 and 4 and Remark 1; the quaternion replaces the printed acos (NaN near
0, useless near pi).
"""

from ...algebra import add, cross, dot, scale, subtract, translation, twist
from .. import elementary
from .arctangent import angle
from .coefficients import SWITCH, d_of
from .compensated import quotient_rest, square_rest, sum_rest, upper
from .exponential import linear_combination
from .quaternion import parts

# below it the square of |q_v| has lost digits; there theta = 2 |q_v| / q_w to the last one
_UNDERFLOW = 1e-280
_TAU = 6.283185307179586  # 2 pi as a float, and what is missing
_TAU_REST = 2.4492935982947064e-16
_NAN = float("nan")


def _polar(R):
    """(theta, rest, axis, cot(theta/2)) of a rotation by theta + rest, from theta = 2 atan2(|q_v|,
    q_w).

    axis = (q_v, rest, r, rest, 1/r), where r is |q_v| with the sign of q_w, so that n = q_v / r. A
    rest is what rounding took, to first order.
    """
    q, q_rest, inverse_square, sign = parts(R)
    w = q[0]
    w_rest = q_rest[0]
    v = (q[1], q[2], q[3])
    v_rest = (q_rest[1], q_rest[2], q_rest[3])
    vv = dot(v, v)
    if vv < _UNDERFLOW * w * w:
        axis = (v, v_rest, w, 0.0, 1.0 / w)
        return 2.0, 0.0, axis, w / w
    r = sign * elementary.sqrt(vv)
    inverse = 1.0 / r
    r_rest = square_rest(v, r, vv) + quotient_rest(vv, r, r) + 2.0 * dot(v, v_rest)
    r_rest = 0.5 * inverse * r_rest
    half, rest = angle(sign * r, sign * w)
    rest = rest + inverse_square * (r_rest * w - r * w_rest)
    axis = (v, v_rest, r, r_rest, inverse)
    return 2.0 * half, 2.0 * rest, axis, w * inverse


def _product(k, k_rest, x, x_rest, size):
    """(k + k_rest) (x + x_rest), rounded once, where k has at most 26 digits and abs(x) <=
    abs(size).
    """
    x_upper = upper(x, size)
    lower = x - x_upper + x_rest
    return k * x_upper + (k * lower + k_rest * x)


def _rotation_vector(theta, rest, axis):
    """(theta + rest) n, rounded once."""
    v, v_rest, r, r_rest, inverse = axis
    k = theta * inverse
    k_upper = upper(k, k)
    quotient = quotient_rest(theta, k, r)
    k_rest = (k - k_upper) + inverse * (quotient + (rest - k * r_rest))
    return (
        _product(k_upper, k_rest, v[0], v_rest[0], r),
        _product(k_upper, k_rest, v[1], v_rest[1], r),
        _product(k_upper, k_rest, v[2], v_rest[2], r),
    )


def so3(R):
    """The rotation vector w (rad) with exp [w] = R, 0 <= |w| <= pi: Lemma 3.

    Remark 1, the sign at pi, is settled in `quaternion.parts`.
    """
    theta, rest, axis, _ = _polar(R)
    return _rotation_vector(theta, rest, axis)


def _linear_part(w, n, p, e):
    """J(w)^-1 p, the linear part of log, in the form that does not cancel.

    p + D w x (w x p) - w x p / 2 where theta < 2, and p_along + E p_across - w x p / 2 elsewhere:
    p_along is the part of p along n = w / theta, p_across the rest.
    """
    tt = dot(w, w)
    across = cross(w, p)
    if elementary.below(tt, SWITCH):
        twice = cross(w, across)
        return linear_combination(1.0, p, d_of(tt), twice, -0.5, across)
    k = dot(n, p)
    p_across = subtract(p, scale(k, n))
    more = dot(n, p_across)  # of p_across, what rounding left along n
    along = (1.0 - e) * more
    return add(scale(k, n), linear_combination(e, p_across, along, n, -0.5, across))


def se3(T):
    """The twist (w; v) with exp = T, 0 <= |w| <= pi: Lemma 4; `quaternion.parts` has the sign at pi."""
    theta, rest, axis, cotangent = _polar(T)
    w = _rotation_vector(theta, rest, axis)
    e = 0.5 * theta * cotangent
    n = scale(axis[4], axis[0])
    return twist(w, _linear_part(w, n, translation(T), e))


def _nearest_branch(theta, rest, axis, w_near):
    """(w, phi, free): the logarithm w = phi n that is closest to w_near, phi = theta + 2 pi k.

    A rotation that is the identity to rounding has logarithms of 2 pi k about any axis: then n is
    that of w_near and `free` is true.
    """
    w = _rotation_vector(theta, rest, axis)
    t = elementary.sqrt(dot(w, w))
    reach = elementary.sqrt(dot(w_near, w_near))
    turns = reach / _TAU + 0.5
    turns = turns - turns % 1.0
    if turns > 0 and t < 1e-15 * reach:
        return scale(turns * _TAU / reach, w_near), turns * _TAU, True
    # less than half a turn apart on any line, or no line
    if reach + t < 3.0 or (turns == 0 and t < 1e-300):
        return w, theta, False
    k = (dot(w, w_near) / t - t) / _TAU + 0.5
    k = k - k % 1.0
    turned = k * _TAU
    phi = theta + turned
    turned_rest = k * _TAU_REST - quotient_rest(turned, k, _TAU)
    rest = rest + (sum_rest(theta, turned, phi) + turned_rest)
    return _rotation_vector(phi, rest, axis), phi, False


def so3_near(R, w_near):
    """Logarithm w of R closest to w_near (rad), of all those of Remark 1."""
    theta, rest, axis, _ = _polar(R)
    return _nearest_branch(theta, rest, axis, w_near)[0]


def se3_near(T, w_near, v_near):
    """Logarithm (w; v) of T whose w is closest to w_near.

    Where |w| = 2 pi k, k != 0, a logarithm exists only if p is along w, to the rounding of exp at
    (w_near; v_near); then the part of v across w is free, and v_near's is taken. v is NaN where
    there is none.
    """
    theta, rest, axis, cotangent = _polar(T)
    w, phi, free = _nearest_branch(theta, rest, axis, w_near)
    p = translation(T)
    if not free:
        # (phi/2) cot(phi/2): the cotangent is that of theta/2, which has lost no digit
        n = scale(axis[4], axis[0])
        e = 0.5 * phi * cotangent
        return twist(w, _linear_part(w, n, p, e))
    n = scale(1.0 / phi, w)
    along = scale(dot(n, p), n)
    p_across = cross(cross(n, p), n)
    off = dot(p_across, p_across)
    size = dot(p, p)
    push = phi * phi * dot(v_near, v_near)
    v_across = cross(cross(n, v_near), n)
    if off <= 1e-30 * (1.0 + size + push):
        return twist(w, add(along, v_across))
    return twist(w, add(along, scale(_NAN, p)))
