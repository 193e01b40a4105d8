"""Error e = (turn; p* - p) between a pose and its target, in the axes of the base.

    turn = 2 sin(phi / 2) n,   e^{[n] phi} R = R*

phi n is Lemma 3's logarithm of R* R^T. Twice the sine of half the angle in its place has neither a
trigonometric function nor a jump in its length at phi = pi, and n is right there too.
Accuracy: a turn is right to a few u = 2^-53, an angle to u beyond what its turn is wrong by; near
pi that counts 1 / cos(phi / 2) times (tests/formulas/inverse/test_pose_error.py).
Source: the quaternion of `formulas.lie.quaternion`, 2 q_v where w >= 0.
"""

from ...algebra import cross, dot, rotate, scale
from .. import elementary
from ..lie import quaternion


def rotation_error(R, R_target):
    """2 sin(phi / 2) n of the rotation R* R^T by phi about n."""
    row_1 = rotate(R, R_target[0:3])
    row_2 = rotate(R, R_target[3:6])
    row_3 = rotate(R, R_target[6:9])
    w, x, y, z = quaternion.quaternion((*row_1, *row_2, *row_3))
    k = 2.0 / elementary.sqrt(w * w + x * x + y * y + z * z)
    return (k * x, k * y, k * z)


def direction_error(R, R_target, axis):
    """(a, turn): the tool's direction a = R axis, and 2 sin(phi / 2) n of the smallest turn to R*
    axis.

    Opposite directions are half a turn about anything across apart: here about a line across that
    coordinate axis, x or y, which is not nearly parallel to a.
    """
    a = rotate(R, axis)
    b = rotate(R_target, axis)
    n = cross(a, b)
    sine = elementary.sqrt(dot(n, n))
    cosine = dot(a, b)
    size = 2.0 * elementary.sin(0.5 * elementary.atan2(sine, cosine))
    if sine == 0.0 and cosine < 0.0:
        n = _across(a)
        sine = elementary.sqrt(dot(n, n))
    if not sine > 0.0:
        return a, scale(0.0, n)
    return a, scale(size / sine, n)


def _across(a):
    """a x (1, 0, 0) or a x (0, 1, 0): a vector across a of unit length that is not nearly zero."""
    if abs(a[0]) < 0.6:
        return cross(a, (1.0, 0.0, 0.0))
    return cross(a, (0.0, 1.0, 0.0))


def angle(turn):
    """phi (rad) of 2 sin(phi / 2) n: |log R|, 0 <= phi <= pi, of Remark 2."""
    half_sine = 0.5 * elementary.sqrt(dot(turn, turn))
    return 2.0 * elementary.asin(min(half_sine, 1.0))


def distance(e):
    """|p* - p| (m) of an error."""
    p = (e[3], e[4], e[5])
    return elementary.sqrt(dot(p, p))


def remove_turn_about(a, J, count):
    """Takes the angular velocity along the unit vector a out of the columns of J."""
    for i in range(count):
        w = (J[0][i], J[1][i], J[2][i])
        along = dot(a, w)
        J[0][i] = w[0] - along * a[0]
        J[1][i] = w[1] - along * a[1]
        J[2][i] = w[2] - along * a[2]
