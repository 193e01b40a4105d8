"""From the joint axes of one forward pass to the Jacobian in any frame.

`J` is six rows of one number a joint; on entry it holds each joint's z axis and origin in the base
frame (`forward.tip_and_axes`), on return the columns (omega; v). `rotates` r and `slides` s are
those of `forward`.
Source: Park 1994, Section III, each A_i moved to where its axis is.
Accuracy: that of `forward` (tests/model/test_chain_laws.py).
"""

from ...algebra import (
    add,
    angular,
    column,
    cross,
    linear,
    scale,
    set_column,
    subtract,
    twist,
    unrotate,
)


def about_point(J, rotates, slides, count, p):
    """Columns (r z; r z x (p - o) + s z): base axes, velocity of the point p. The space Jacobian
    has p = 0.
    """
    for i in range(count):
        axis = column(J, i)
        r = rotates[i]
        s = slides[i]
        z = angular(axis)
        v = cross(z, subtract(p, linear(axis)))
        set_column(J, i, twist(scale(r, z), add(scale(r, v), scale(s, z))))


def rotate_columns(J, count, R):
    """Both halves of every column times R^T: from base axes to the axes whose rotation in the base
    is R.
    """
    for i in range(count):
        V = column(J, i)
        set_column(J, i, twist(unrotate(R, angular(V)), unrotate(R, linear(V))))


def coupled(J_x, coupling, joints, coordinates, J_q):
    """J_q = J_x C: from velocities of the joints to velocities of the coordinates."""
    for r in range(6):
        for k in range(coordinates):
            J_q[r][k] = 0.0
        for i in range(joints):
            for k in range(coordinates):
                J_q[r][k] += J_x[r][i] * coupling[i][k]
