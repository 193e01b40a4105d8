"""log on SO(3) and SE(3), on its principal branch or on the branch nearest to a given one.

No acos and no division by sin theta: theta comes from the quaternion of R's polar projection, so it is as exact at pi
as anywhere, and a defect d of R's orthonormality enters as d^2.
Accuracy: with u = 2^-53 and k = (theta/2)/sin(theta/2), w is within 3 u (1 + 1.22 k min(1, 1/theta)) of its length and
v within 3 u (|v| + k |p| + theta |dv/dw|) of the logarithm of R's polar projection (tests/groups/test_accuracy.py).
Source: Park 1994, Lemmas 3 and 4 and Remark 1; the quaternion replaces the printed acos (NaN near 0, useless near pi).
"""

from ..algebra import add, cross, dot, scale, translation, twist
from . import elementary
from .coefficients import d_of
from .exponential import displacement

_UNDERFLOW = 1e-280  # below it the square of |q_v| has lost digits; there theta = 2 |q_v| / q_w to the last one
_TAU = 6.283185307179586
_NAN = float("nan")


def _power_step(pp, px, py, pz, xx, yy, zz, xy, yz, zx):
    """The first column of a symmetric 4x4 matrix, multiplied once by the matrix and divided by its pivot pp.

    The pivot's own share is the column itself, so the digits that it has are kept.
    """
    x, y, z = px / pp, py / pp, pz / pp
    return (
        pp + (px * x + py * y + pz * z),
        px + (xx * x + xy * y + zx * z),
        py + (xy * x + yy * y + yz * z),
        pz + (zx * x + yz * y + zz * z),
    )


def quaternion(R):
    """A multiple of the quaternion (w, x, y, z), w >= 0, of the rotation nearest to R.

    The largest column of 4 q q^T and one power step: an error d orthogonal to q is left as d^2. Where w = 0
    (theta = pi) the component of largest magnitude is positive; this settles the sign that Remark 1 leaves open.
    """
    trace = R[0] + R[4] + R[8]
    ww, xx, yy, zz = 1.0 + trace, 1.0 + R[0] - R[4] - R[8], 1.0 - R[0] + R[4] - R[8], 1.0 - R[0] - R[4] + R[8]
    wx, wy, wz = R[7] - R[5], R[2] - R[6], R[3] - R[1]
    xy, yz, zx = R[1] + R[3], R[5] + R[7], R[6] + R[2]
    if trace >= R[0] and trace >= R[4] and trace >= R[8]:
        w, x, y, z = _power_step(ww, wx, wy, wz, xx, yy, zz, xy, yz, zx)
    elif R[0] >= R[4] and R[0] >= R[8]:
        x, w, y, z = _power_step(xx, wx, xy, zx, ww, yy, zz, wy, yz, wz)
    elif R[4] >= R[8]:
        y, x, w, z = _power_step(yy, xy, wy, yz, xx, ww, zz, wx, wz, zx)
    else:
        z, x, y, w = _power_step(zz, zx, yz, wz, xx, yy, ww, xy, wy, wx)
    return (-w, -x, -y, -z) if w < 0 else (w, x, y, z)


def _angle(R):
    """(q_v as a vector, theta / |q_v|, E = (theta/2) cot(theta/2)) of a rotation."""
    w, x, y, z = quaternion(R)
    vv = x * x + y * y + z * z
    if vv < _UNDERFLOW * w * w:
        return (x, y, z), 2.0 / w, w / w
    norm = elementary.sqrt(vv)
    half = elementary.atan2(norm, w)
    return (x, y, z), 2.0 * half / norm, half * w / norm


def so3(R):
    """The rotation vector w (rad) with exp [w] = R, 0 <= |w| <= pi."""
    q_v, stretch, _ = _angle(R)
    return scale(stretch, q_v)


def _linear(w, p, tt, e):
    """J(w)^-1 p, the linear part of log: p - w x p / 2 + D w x (w x p), in the form that does not cancel."""
    d = d_of(tt, e)
    across = cross(w, p)
    if tt < 1.0:
        return displacement(1.0, p, -0.5, across, d, cross(w, across))
    return displacement(e, p, -0.5, across, d, scale(dot(w, p), w))


def se3(T):
    """The twist (w; v) with exp = T, 0 <= |w| <= pi."""
    q_v, stretch, e = _angle(T)
    w = scale(stretch, q_v)
    return twist(w, _linear(w, translation(T), dot(w, w), e))


def _near(q_v, stretch, w_near):
    """(w, phi, turned, free): the logarithm w = phi n that is closest to w_near, phi = theta + turned, turned = 2 pi k.

    A rotation that is the identity to rounding has logarithms of 2 pi k about any axis: then n is that of w_near and
    `free` is true.
    """
    w = scale(stretch, q_v)
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
    q_v, stretch, _ = _angle(R)
    return _near(q_v, stretch, w_near)[0]


def se3_near(T, w_near, v_near):
    """Of all twists (w; v) with exp = T the one whose w is closest to w_near.

    Where |w| = 2 pi k, k != 0, a logarithm exists only if p is along w, to the rounding of exp at (w_near; v_near);
    then the part of v across w is free, and v_near's is taken. v is NaN where there is none.
    """
    q_v, stretch, e = _angle(T)
    w, phi, turned, free = _near(q_v, stretch, w_near)
    p = translation(T)
    if turned == 0:
        return twist(w, _linear(w, p, dot(w, w), e))
    n = (w[0] / phi, w[1] / phi, w[2] / phi)
    along, p_across = scale(dot(n, p), n), cross(cross(n, p), n)
    if free:
        off, size, push = dot(p_across, p_across), dot(p, p), phi * phi * dot(v_near, v_near)
        v_across = cross(cross(n, v_near), n)
        return twist(w, add(along, v_across if off <= 1e-30 * (1.0 + size + push) else scale(_NAN, p)))
    # (phi/2) cot(phi/2): the cotangent is that of theta/2, which has lost no digit; e p_across stays apart, for near
    # a whole turn it is large
    return twist(w, displacement(1.0, along, e / (phi - turned) * phi, p_across, -0.5, cross(w, p)))
