"""Error e = (turn; p* - p) between a pose and its target, in the axes of the base.

    turn = 2 sin(phi / 2) n,   e^{[n] phi} R = R*

phi n is Lemma 3's logarithm of R* R^T. Twice the sine of half the angle in its place has neither a
trigonometric function nor a jump in its length at phi = pi, and n is right there too.
Accuracy: a turn is right to a few u = 2^-53, an angle to u beyond what its turn is wrong by; near
pi that counts 1 / cos(phi / 2) times (tests/formulas/inverse/test_pose_error.py).
Source: the quaternion of `formulas.lie.quaternion`, 2 q_v where w >= 0.
"""

from ...algebra import (
    add,
    angular,
    column,
    cross,
    dot,
    linear,
    rotate,
    scale,
    set_column,
    subtract,
    twist,
)
from .. import elementary
from ..lie import quaternion


def rotation_error(R, R_target):
    """2 sin(phi / 2) n of the rotation R* R^T by phi about n."""
    w, x, y, z = quaternion.quaternion(_turn_to(R, R_target))
    k = 2.0 / elementary.sqrt(w * w + x * x + y * y + z * z)
    return (k * x, k * y, k * z)


def planar_error(R, R_target, normal):
    """2 sin(phi / 2) n of the turn by phi about the unit normal n of a plane that is in R* R^T.

    R* R^T is that turn and then one about a line in the plane (swing and twist). Where the latter
    is half a turn, the tool is upside down: no phi is right, and half a turn is returned.
    """
    w, x, y, z = quaternion.quaternion(_turn_to(R, R_target))
    along = dot(normal, (x, y, z))
    size = elementary.sqrt(w * w + along * along)
    if size == 0.0:
        return scale(2.0, normal)
    return scale(2.0 * along / size, normal)


def _turn_to(R, R_target):
    """R* R^T, row by row."""
    row_1 = rotate(R, R_target[0:3])
    row_2 = rotate(R, R_target[3:6])
    row_3 = rotate(R, R_target[6:9])
    return (*row_1, *row_2, *row_3)


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


def differentiate(e, J, count):
    """Makes the columns (omega; v) of a hybrid Jacobian -de/dq.

    That of 2 sin(phi / 2) n is cos(phi / 2) omega + sin(phi / 2) n x omega: near the target it is
    omega itself.
    """
    half, cosine = _half_turn(e)
    for i in range(count):
        V = column(J, i)
        w = angular(V)
        turn = add(scale(cosine, w), cross(half, w))
        set_column(J, i, twist(turn, linear(V)))


def differentiate_direction(a, e, J, count):
    """Makes the columns of a hybrid Jacobian without the turn about a = R axis -de/dq, for the
    smallest turn from a to R* axis.

    So that it stays the smallest, a turn about a goes with omega, tan(phi / 2) (a x n) . omega; of
    opposite directions there is none.
    """
    half, cosine = _half_turn(e)
    across_both = cross(a, half)
    for i in range(count):
        V = column(J, i)
        w = angular(V)
        if cosine > 0.0:
            about = dot(across_both, w) / cosine
            set_column(J, i, twist(add(w, scale(about, a)), linear(V)))
    differentiate(e, J, count)


def _half_turn(e):
    """(sin(phi / 2) n, cos(phi / 2)) of an error."""
    half = scale(0.5, angular(e))
    cosine = elementary.sqrt(max(1.0 - dot(half, half), 0.0))
    return half, cosine


def distance(e):
    """|p* - p| (m) of an error."""
    p = linear(e)
    return elementary.sqrt(dot(p, p))


def remove_turn_about(a, J, count):
    """Takes the angular velocity along the unit vector a out of the columns of J."""
    for i in range(count):
        V = column(J, i)
        w = angular(V)
        set_column(J, i, twist(subtract(w, scale(dot(a, w), a)), linear(V)))


def across(normal, v):
    """v without its part along a unit normal."""
    return subtract(v, scale(dot(normal, v), normal))


def keep_in_plane(normal, J, count):
    """Leaves of the columns of J the turn about a unit normal and the velocity across it."""
    for i in range(count):
        V = column(J, i)
        turn = scale(dot(normal, angular(V)), normal)
        set_column(J, i, twist(turn, across(normal, linear(V))))
