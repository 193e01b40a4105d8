"""Kernels of a chain: one configuration or many, over one table of the chain's numbers.

Table: row i < n holds the twelve numbers of M_{i+1}, then r, s of joint i (see
`formulas.kinematics.forward`), then, where joints and coordinates are not the same, c_i and row i
of C. Row n holds the twelve numbers of the constant tool. `frame` is the index of a joint, or
SPACE, BODY or HYBRID.
"""

import numpy as np

from ...algebra import pose, store_row, translation, turned_about_z
from ...formulas.kinematics import columns, forward, recursive
from ..jit.array_io import store_matrix, without_refcount
from ..jit.kernel import kernel
from ..straight_line.sincos import sincos

SPACE = -1
BODY = -2
HYBRID = -3
POSE = 0
ROTATES = 12
SLIDES = 13
OFFSET = 14
COUPLING = 15


def scratch(table):
    """Memory for the sines, cosines and shifts of the joints' motions."""
    n = table.shape[0] - 1
    return np.empty(n), np.empty(n), np.empty(n)


def set_motions(table, q, sines, cosines, shifts):
    """Write sin(r x), cos(r x) and s x of every joint, x = C q + c."""
    coupled = table.shape[1] > OFFSET
    for i in range(table.shape[0] - 1):
        if coupled:
            x = table[i, OFFSET]
            for k in range(len(q)):
                x += table[i, COUPLING + k] * q[k]
        else:
            x = q[i]
        sines[i], cosines[i] = sincos(table[i, ROTATES] * x)
        shifts[i] = table[i, SLIDES] * x


def set_rates(table, dq, dx):
    """Write dx = C dq: of the rates or accelerations of the coordinates, those of the joints."""
    coupled = table.shape[1] > OFFSET
    for i in range(table.shape[0] - 1):
        if coupled:
            dx[i] = 0.0
            for k in range(len(dq)):
                dx[i] += table[i, COUPLING + k] * dq[k]
        else:
            dx[i] = dq[i]


def joint_frame(T, table, sines, cosines, shifts, i):
    """Pose of joint i's frame after its motion, T that of the joint before it."""
    if i == 0:
        first = pose(table[0])
        return turned_about_z(first, sines[0], cosines[0], shifts[0])
    link = table[i]
    return forward.next_frame(T, link, sines[i], cosines[i], shifts[i])


@kernel("w2 r1 w2", bare=True)
def pose_one(table, q, T):
    """f(q) of one configuration of a chain that is not coupled."""
    n = table.shape[0] - 1
    table = without_refcount(table)
    q = without_refcount(q)
    T = without_refcount(T)
    sines, cosines, shifts = scratch(table)
    set_motions(table, q, sines, cosines, shifts)
    store_matrix(T, forward.tip(table, sines, cosines, shifts, n))


@kernel("w2 r2 w3")
def pose_many(table, q, T):
    """f(q) of many configurations."""
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    table = without_refcount(table)
    q = without_refcount(q)
    T = without_refcount(T)
    for k in range(q.shape[0]):
        set_motions(table, q[k], sines, cosines, shifts)
        store_matrix(T[k], forward.tip(table, sines, cosines, shifts, n))


@kernel("w2 r1 int w2 w2", bare=True)
def pose_jacobian_one(table, q, frame, T, J):
    """f(q) and the Jacobian of one configuration, in a named frame, of a chain that is not coupled."""
    n = table.shape[0] - 1
    table = without_refcount(table)
    q = without_refcount(q)
    T = without_refcount(T)
    J = without_refcount(J)
    # the rows of J serve as scratch: taking memory costs as much as three joints
    sines = J[0]
    cosines = J[1]
    shifts = J[2]
    set_motions(table, q, sines, cosines, shifts)
    tip = forward.tip_and_axes(table, sines, cosines, shifts, n, J)
    store_matrix(T, tip)
    p = (0.0, 0.0, 0.0) if frame == SPACE else translation(tip)
    columns.about_point(J, table[:, ROTATES], table[:, SLIDES], n, p)
    if frame == BODY:
        columns.rotate_columns(J, n, tip)


def _pose_jacobian(table, q, frame, T, J_x):
    """The poses into T, the Jacobians of the joints in `frame` into J_x. A T of length 1 is
    scratch.
    """
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    table = without_refcount(table)
    q = without_refcount(q)
    T = without_refcount(T)
    J_x = without_refcount(J_x)
    rotates = table[:, ROTATES]
    slides = table[:, SLIDES]
    for k in range(q.shape[0]):
        set_motions(table, q[k], sines, cosines, shifts)
        J = J_x[k]
        tip = forward.tip_and_axes(table, sines, cosines, shifts, n, J)
        last = T.shape[0] - 1
        store_matrix(T[min(k, last)], tip)
        at = tip
        p = translation(tip)
        if frame >= 0:
            at = forward.frame(table, sines, cosines, shifts, frame + 1)
            p = translation(at)
        elif frame == SPACE:
            p = (0.0, 0.0, 0.0)
        columns.about_point(J, rotates, slides, n, p)
        if frame != SPACE and frame != HYBRID:
            columns.rotate_columns(J, n, at)


@kernel("w2 r2 int w3 w3")
def pose_jacobian_many(table, q, frame, T, J):
    """f(q) and the Jacobian of many configurations; a T of length 1 is scratch, used again and
    again.
    """
    n = table.shape[0] - 1
    if table.shape[1] > OFFSET:
        J_x = np.empty((1, 6, n))
        coupling = table[:, COUPLING:]
        for k in range(q.shape[0]):
            j = min(k, T.shape[0] - 1)
            _pose_jacobian(table, q[k : k + 1], frame, T[j : j + 1], J_x)
            columns.coupled(J_x[0], coupling, n, q.shape[1], J[k])
    else:
        _pose_jacobian(table, q, frame, T, J)


@kernel("w2 r2 w4")
def joint_poses(table, q, T):
    """The z-aligned frame of every joint in the base frame, after its motion."""
    sines, cosines, shifts = scratch(table)
    for k in range(q.shape[0]):
        set_motions(table, q[k], sines, cosines, shifts)
        frame = pose(table[0])
        for i in range(table.shape[0] - 1):
            frame = joint_frame(frame, table, sines, cosines, shifts, i)
            store_matrix(T[k, i], frame)


@kernel("w2 r2 r2 w2")
def body_velocity(table, q, dq, V):
    """f^-1 f' by the V recursion, of a chain with a joint."""
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    links = np.empty((n, 12))
    rates = np.empty(n)
    for k in range(q.shape[0]):
        set_motions(table, q[k], sines, cosines, shifts)
        set_rates(table, dq[k], rates)
        for i in range(n):
            link = pose(table[i])
            moved = turned_about_z(link, sines[i], cosines[i], shifts[i])
            store_row(links[i], moved)
        tool = pose(table[n])
        rotates = table[:, ROTATES]
        slides = table[:, SLIDES]
        velocity = recursive.body_velocity(links, tool, rotates, slides, n, rates)
        store_row(V[k], velocity)
