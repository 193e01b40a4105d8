"""log on SO(3) and SE(3), on its principal branch or on the branch nearest to a given one.

No acos and no division by sin theta: theta comes from the quaternion of R's polar projection, so it is as exact at pi
as anywhere, and a defect d of R's orthonormality enters as d^2.
Source: Park 1994, Lemmas 3 and 4 and Remark 1; the quaternion replaces the printed acos (NaN near 0, useless near pi).
"""

from ..algebra import cross, dot, scale, translation, twist
from . import elementary
from .coefficients import d_of
from .exponential import displacement

_UNDERFLOW = 1e-280  # below it the square of |q_v| has lost digits; there theta = 2 |q_v| / q_w to the last one
_TAU = 6.283185307179586
_NAN = float("nan")


def _power_step(R, k):
    """The k-th column of the symmetric 4x4 matrix that equals 4 q q^T for a rotation, multiplied once by the matrix."""
    ww, xx, yy, zz = (
        1.0 + R[0] + R[4] + R[8],
        1.0 + R[0] - R[4] - R[8],
        1.0 - R[0] + R[4] - R[8],
        1.0 - R[0] - R[4] + R[8],
    )
    wx, wy, wz = R[7] - R[5], R[2] - R[6], R[3] - R[1]
    xy, yz, zx = R[1] + R[3], R[5] + R[7], R[6] + R[2]
    if k == 0:
        w, x, y, z = ww, wx, wy, wz
    elif k == 1:
        w, x, y, z = wx, xx, xy, zx
    elif k == 2:
        w, x, y, z = wy, xy, yy, yz
    else:
        w, x, y, z = wz, zx, yz, zz
    return (
        ww * w + wx * x + wy * y + wz * z,
        wx * w + xx * x + xy * y + zx * z,
        wy * w + xy * x + yy * y + yz * z,
        wz * w + zx * x + yz * y + zz * z,
    )


def quaternion(R):
    """A multiple of the quaternion (w, x, y, z), w >= 0, of the rotation nearest to R.

    The largest column of 4 q q^T and one power step: an error d orthogonal to q is left as d^2. Where w = 0
    (theta = pi) the component of largest magnitude is positive; this settles the sign that Remark 1 leaves open.
    """
    trace = R[0] + R[4] + R[8]
    k, largest = 0, trace
    if R[0] > largest:
        k, largest = 1, R[0]
    if R[4] > largest:
        k, largest = 2, R[4]
    if R[8] > largest:
        k, largest = 3, R[8]
    w, x, y, z = _power_step(R, k)
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
    """(w, phi, free): the logarithm w = phi n of the rotation that is closest to w_near, phi = theta + 2 pi k.

    A rotation that is the identity to rounding has logarithms of 2 pi k about any axis: then n is that of w_near and
    `free` is true.
    """
    w = scale(stretch, q_v)
    t = elementary.sqrt(dot(w, w))
    reach = elementary.sqrt(dot(w_near, w_near))
    turns = reach / _TAU + 0.5
    turns = turns - turns % 1.0
    if turns > 0 and t < 1e-15 * reach:
        return scale(turns * _TAU / reach, w_near), turns * _TAU, True
    if reach + t < 3.0 or t < 1e-300:  # less than half a turn apart on any line, or no line to speak of
        return w, t, False
    n = scale(1.0 / t, w)
    k = (dot(n, w_near) - t) / _TAU + 0.5
    phi = t + (k - k % 1.0) * _TAU
    return scale(phi, n), phi, False


def so3_near(R, w_near):
    """Of all w with exp [w] = R the one closest to w_near (rad)."""
    q_v, stretch, _ = _angle(R)
    return _near(q_v, stretch, w_near)[0]


def se3_near(T, w_near):
    """Of all twists (w; v) with exp = T the one whose w is closest to w_near.

    v is NaN where there is none: |w| = 2 pi k, k != 0, and p not along w.
    """
    q_v, stretch, e = _angle(T)
    w, phi, free = _near(q_v, stretch, w_near)
    p = translation(T)
    if free:
        off = cross(w, p)
        along = dot(off, off) <= 1e-28 * (phi * phi) * dot(p, p)
        return twist(w, p if along else scale(_NAN, p))
    t = stretch * elementary.sqrt(dot(q_v, q_v))
    if t != phi:
        # (phi/2) cot(phi/2): the cotangent is that of theta/2, which has lost no digit
        e = e / t * phi
    return twist(w, _linear(w, p, phi * phi, e))
