"""log on SO(3) and SE(3), on its principal branch or on the branch nearest to a given one.

No acos and no division by sin theta: theta comes from the quaternion of R's polar projection, so it is as exact at pi
as anywhere, and a defect d of R's orthonormality enters as d^2.
Accuracy: with u = 2^-53 and k = (theta/2)/sin(theta/2), w is within 1.5 u (1 + 1.22 k min(1, 1/theta)) of its length
and v within 1.5 u (|v| + k |p| + theta |dv/dw|) of the logarithm of R's polar projection, in the cases of
tests/groups/test_accuracy.py, and within 2 times u and so on where a processor has no fused multiplication.
Source: Park 1994, Lemmas 3 and 4 and Remark 1; the quaternion replaces the printed acos (NaN near 0, useless near pi).
"""

from ..algebra import add, cross, dot, scale, subtract, translation, twist
from . import elementary
from .coefficients import SWITCH, d_of
from .compensated import quotient_rest, square_rest, sum_rest, upper
from .exponential import displacement

_UNDERFLOW = 1e-280  # below it the square of |q_v| has lost digits; there theta = 2 |q_v| / q_w to the last one
_UNIT = 2.0**-25  # as `size` of `upper`: digits down to the last one of 4
_TAU = 6.283185307179586
_NAN = float("nan")


def _least(R):
    """(w, x, y, z), a multiple of the quaternion of the rotation nearest to R, where w is the largest of them.

    The column (p; q) of 4 q q^T = [p q^T; q M] and one power step, which leaves of its error d only d^2: q moves by
    D x p/4 - (1 - p/4) (q - x p), x = q/p, where D = M - x q^T is nothing but what R misses a rotation by. So q keeps
    its digits, and what rounding took from p and q is put back with it.
    """
    a, b, c = upper(R[0], _UNIT), upper(R[4], _UNIT), upper(R[8], _UNIT)
    al, bl, cl = R[0] - a, R[4] - b, R[8] - c
    p, qx, qy, qz = 1.0 + a + b + c, R[7] - R[5], R[2] - R[6], R[3] - R[1]
    inverse = 1.0 / p
    x, y, z = qx * inverse, qy * inverse, qz * inverse
    part, pl = 0.25 * p, al + bl + cl
    xx = (1.0 + a - b - c - x * qx) + (al - bl - cl - pl)
    yy = (1.0 - a + b - c - y * qy) + (bl - al - cl - pl)
    zz = (1.0 - a - b + c - z * qz) + (cl - al - bl - pl)
    xy, yz, zx = R[1] + R[3] - x * qy, R[5] + R[7] - y * qz, R[6] + R[2] - z * qx
    dx = (xx * x + xy * y + zx * z) * part - (1.0 - part) * (qx - x * p)
    dy = (xy * x + yy * y + yz * z) * part - (1.0 - part) * (qy - y * p)
    dz = (zx * x + yz * y + zz * z) * part - (1.0 - part) * (qz - z * p)
    return (
        p,
        qx + (dx + sum_rest(R[7], -R[5], qx)),
        qy + (dy + sum_rest(R[2], -R[6], qy)),
        qz + (dz + sum_rest(R[3], -R[1], qz)),
    )


def _flipped(R, x, y, z):
    """R with its columns times x, y and z."""
    return (x * R[0], y * R[1], z * R[2], x * R[3], y * R[4], z * R[5], x * R[6], y * R[7], z * R[8])


def _about(R):
    """Of R (0) and R after a half turn about its x, y or z axis (1, 2, 3) that one whose angle is least."""
    trace = R[0] + R[4] + R[8]
    if trace >= R[0] and trace >= R[4] and trace >= R[8]:
        return 0
    if R[0] >= R[4] and R[0] >= R[8]:
        return 1
    return 2 if R[4] >= R[8] else 3


def quaternion(R):
    """A multiple of the quaternion (w, x, y, z), w >= 0, of the rotation nearest to R.

    After a half turn about an axis that leaves the least angle, w is the largest of the four. Where w = 0 (theta = pi)
    the component of largest magnitude is positive; this settles the sign that Remark 1 leaves open.
    """
    axis = _about(R)
    turned = _flipped(R, -1.0 if axis > 1 else 1.0, -1.0 if axis % 2 else 1.0, -1.0 if axis in (1, 2) else 1.0)
    w, x, y, z = _least(turned)
    if axis == 1:
        w, x, y, z = -x, w, z, -y
    elif axis == 2:
        w, x, y, z = -y, -z, w, x
    elif axis == 3:
        w, x, y, z = -z, y, -x, w
    return (-w, -x, -y, -z) if w < 0 else (w, x, y, z)


def _angle(R):
    """(w, n, E) of a rotation: theta n, n, and E = (theta/2) cot(theta/2).

    theta = 2 atan2(|q_v|, q_w). What rounding took from |q_v| and from n = q_v / |q_v| is put back to first order.
    """
    w, x, y, z = quaternion(R)
    vv = x * x + y * y + z * z
    if vv < _UNDERFLOW * w * w:
        return scale(2.0 / w, (x, y, z)), (x, y, z), w / w
    norm = elementary.sqrt(vv)
    inverse = 1.0 / norm
    more = 0.5 * inverse * (square_rest((x, y, z), norm, vv) + quotient_rest(vv, norm, norm))
    n = (x * inverse, y * inverse, z * inverse)
    half = elementary.atan2(norm, w)
    theta, rest = 2.0 * half, 2.0 * more * w / (w * w + vv)
    rests = (
        (quotient_rest(x, n[0], norm) - n[0] * more) * inverse,
        (quotient_rest(y, n[1], norm) - n[1] * more) * inverse,
        (quotient_rest(z, n[2], norm) - n[2] * more) * inverse,
    )
    return add(scale(theta, n), add(scale(theta, rests), scale(rest, n))), n, half * w * inverse


def so3(R):
    """The rotation vector w (rad) with exp [w] = R, 0 <= |w| <= pi."""
    return _angle(R)[0]


def _linear(w, n, p, e):
    """J(w)^-1 p, the linear part of log, in the form that does not cancel.

    p + D w x (w x p) - w x p / 2 where theta < 2, and p_along + E p_across - w x p / 2 elsewhere: p_along is the part
    of p along n = w / theta, p_across the rest.
    """
    tt = dot(w, w)
    across = cross(w, p)
    if elementary.below(tt, SWITCH):
        return displacement(1.0, p, d_of(tt, e), cross(w, across), -0.5, across)
    k = dot(n, p)
    p_across = subtract(p, scale(k, n))
    more = dot(n, p_across)  # of p_across, what rounding left along n
    return add(scale(k, n), displacement(e, p_across, (1.0 - e) * more, n, -0.5, across))


def se3(T):
    """The twist (w; v) with exp = T, 0 <= |w| <= pi."""
    w, n, e = _angle(T)
    return twist(w, _linear(w, n, translation(T), e))


def _near(w, w_near):
    """(w, phi, turned, free): the logarithm w = phi n that is closest to w_near, phi = theta + turned, turned = 2 pi k.

    A rotation that is the identity to rounding has logarithms of 2 pi k about any axis: then n is that of w_near and
    `free` is true.
    """
    t = elementary.sqrt(dot(w, w))
    reach = elementary.sqrt(dot(w_near, w_near))
    turns = reach / _TAU + 0.5
    turns = turns - turns % 1.0
    if turns > 0 and t < 1e-15 * reach:
        return scale(turns * _TAU / reach, w_near), turns * _TAU, turns * _TAU, True
    if reach + t < 3.0 or (turns == 0 and t < 1e-300):  # less than half a turn apart on any line, or no line
        return w, t, 0.0, False
    n = (w[0] / t, w[1] / t, w[2] / t)
    k = (dot(n, w_near) - t) / _TAU + 0.5
    turned = (k - k % 1.0) * _TAU
    return scale(t + turned, n), t + turned, turned, False


def so3_near(R, w_near):
    """Of all w with exp [w] = R the one closest to w_near (rad)."""
    return _near(_angle(R)[0], w_near)[0]


def se3_near(T, w_near, v_near):
    """Of all twists (w; v) with exp = T the one whose w is closest to w_near.

    Where |w| = 2 pi k, k != 0, a logarithm exists only if p is along w, to the rounding of exp at (w_near; v_near);
    then the part of v across w is free, and v_near's is taken. v is NaN where there is none.
    """
    principal, axis, e = _angle(T)
    w, phi, turned, free = _near(principal, w_near)
    p = translation(T)
    if turned == 0:
        return twist(w, _linear(w, axis, p, e))
    n = (w[0] / phi, w[1] / phi, w[2] / phi)
    along, p_across = scale(dot(n, p), n), cross(cross(n, p), n)
    if free:
        off, size, push = dot(p_across, p_across), dot(p, p), phi * phi * dot(v_near, v_near)
        v_across = cross(cross(n, v_near), n)
        return twist(w, add(along, v_across if off <= 1e-30 * (1.0 + size + push) else scale(_NAN, p)))
    # (phi/2) cot(phi/2): the cotangent is that of theta/2, which has lost no digit; e p_across stays apart, for near
    # a whole turn it is large
    return twist(w, displacement(1.0, along, e / (phi - turned) * phi, p_across, -0.5, cross(w, p)))
