"""The quaternion of a rotation matrix, with what rounding took from it.

No square root and no division by sin theta: any column of 4 q q^T = 4 (w; q_v) (w; q_v)^T, whose
entries are sums of entries of R, is a multiple of q. A half turn about an axis of the frame is a
permutation of q's components; after that half turn which leaves the least angle, w is the largest
of them.
Accuracy: with its rest, q is right to u = 2^-53 of its length, and a defect d of R's orthonormality
enters as d^2 (tests/formulas/lie/test_quaternion.py).
Source: Shepperd 1978, with one step of the power method towards the rotation nearest to R.
"""

from .. import elementary
from .compensated import upper

_UNIT = 2.0**-25  # as `size` of `upper`: digits down to the last one of 4


def _of_smallest_angle(R):
    """q = (p; q_v), rest and 1 / |q|^2 of a rotation of which w is the largest component: p = 4
    w^2.

    One power step of K = 4 q q^T = [p q_v^T; q_v M]: K q / (p + |q_v|^2 / p) = (p; q_v + D q_v /
    (p^2 + |q_v|^2)).
    D = p M - q_v q_v^T is nothing but what R misses a rotation by, and p^2 + |q_v|^2 = 4 p where it
    misses nothing.
    """
    a = upper(R[0], _UNIT)
    b = upper(R[4], _UNIT)
    c = upper(R[8], _UNIT)
    exact = 1.0 + a + b + c
    below = (R[0] - a) + (R[4] - b) + (R[8] - c)
    p = exact + below
    rest = below - (p - exact)
    x = R[7] - R[5]
    y = R[2] - R[6]
    z = R[3] - R[1]
    xx = p * (2.0 - p + 2.0 * R[0] - rest) - x * x
    yy = p * (2.0 - p + 2.0 * R[4] - rest) - y * y
    zz = p * (2.0 - p + 2.0 * R[8] - rest) - z * z
    xy = p * (R[1] + R[3]) - x * y
    yz = p * (R[5] + R[7]) - y * z
    zx = p * (R[6] + R[2]) - z * x
    inverse = 0.25 / p
    rests = (
        rest,
        inverse * (xx * x + xy * y + zx * z),
        inverse * (xy * x + yy * y + yz * z),
        inverse * (zx * x + yz * y + zz * z),
    )
    return (p, x, y, z), rests, inverse


def _scale_columns(R, x, y, z):
    """R with its columns times x, y and z."""
    return (
        x * R[0],
        y * R[1],
        z * R[2],
        x * R[3],
        y * R[4],
        z * R[5],
        x * R[6],
        y * R[7],
        z * R[8],
    )


def _half_turn_axis(R):
    """Index of the least angle among R (0) and R after a half turn about its x, y or z axis
    (1, 2, 3).
    """
    trace = R[0] + R[4] + R[8]
    if trace >= R[0] and trace >= R[4] and trace >= R[8]:
        return 0
    if R[0] >= R[4] and R[0] >= R[8]:
        return 1
    if R[4] >= R[8]:
        return 2
    return 3


def _undo_half_turn(axis, w, x, y, z):
    """The quaternion before the half turn about an axis that `_half_turn_axis` names."""
    if axis == 1:
        return -x, w, z, -y
    if axis == 2:
        return -y, -z, w, x
    if axis == 3:
        return -z, y, -x, w
    return w, x, y, z


def parts(R):
    """(q, rest, 1 / |q|^2, sign): sign (q + rest) is a multiple of the quaternion (w, x, y, z), w
    >= 0, of R.

    Where w = 0 (theta = pi) the component of largest magnitude, the first of equals, is positive:
    `_half_turn_axis` chooses it, which settles the sign that Remark 1 leaves open; `sign` is -1
    where w < 0.
    """
    axis = _half_turn_axis(R)
    turned = _scale_columns(
        R,
        -1.0 if axis > 1 else 1.0,
        -1.0 if axis % 2 else 1.0,
        -1.0 if axis in (1, 2) else 1.0,
    )
    q, rest, inverse = _of_smallest_angle(turned)
    q = _undo_half_turn(axis, *q)
    rest = _undo_half_turn(axis, *rest)
    sign = 1.0
    if q[0] + rest[0] < 0:
        sign = -1.0
    return q, rest, inverse, sign


def quaternion(R):
    """A multiple of the quaternion (w, x, y, z), w >= 0, of the rotation nearest to R."""
    q, rest, _, sign = parts(R)
    return (
        sign * (q[0] + rest[0]),
        sign * (q[1] + rest[1]),
        sign * (q[2] + rest[2]),
        sign * (q[3] + rest[3]),
    )


def unit_quaternion(R):
    """The unit quaternion (w, x, y, z), w >= 0, of the rotation nearest to R, to 3 u."""
    w, x, y, z = quaternion(R)
    length = elementary.sqrt(w * w + x * x + y * y + z * z)
    return (w / length, x / length, y / length, z / length)


def rotation(w, x, y, z):
    """The rotation of a multiple of a quaternion, I + 2 (w [v] + [v]^2) / |q|^2, to 6 u.

    On the diagonal w^2 + x^2 - y^2 - z^2 over |q|^2: no term there is twice as large as the sum.
    """
    ww = w * w
    xx = x * x
    yy = y * y
    zz = z * z
    square = ww + xx + yy + zz
    half = 0.5 * square
    return (
        (ww + xx - yy - zz) / square,
        (x * y - w * z) / half,
        (z * x + w * y) / half,
        (x * y + w * z) / half,
        (ww + yy - zz - xx) / square,
        (y * z - w * x) / half,
        (z * x - w * y) / half,
        (y * z + w * x) / half,
        (ww + zz - xx - yy) / square,
    )
