"""Kernels of a chain's derivatives: rate and Hessian of the Jacobian, accelerations, velocities of
all joint frames, and what a change of the screws does. The table and the frames are those of
`chain_kernels`.
"""

import numpy as np

from ...algebra import adjoint_inverse, angular, column, linear, pose, translation, turned_about_z
from ...formulas.kinematics import columns, derivatives, forward, screw_changes
from ...formulas.lie import exponential
from ..jit.array_io import borrowed, store_row
from ..jit.kernel import kernel
from .chain_kernels import BODY, COUPLING, OFFSET, ROTATES, SLIDES, SPACE, motions, scratch


def _followed(table, q, x):
    """x = C q: of the rates and accelerations of the coordinates, those of the joints."""
    for i in range(table.shape[0] - 1):
        if table.shape[1] > OFFSET:
            x[i] = 0.0
            for k in range(len(q)):
                x[i] += table[i, COUPLING + k] * q[k]
        else:
            x[i] = q[i]


def _columns(table, q, frame, sines, cosines, shifts, J):
    """The Jacobian of the joints into J, in one of the frames SPACE, BODY and HYBRID; the pose."""
    n = table.shape[0] - 1
    motions(table, q, sines, cosines, shifts)
    tip = forward.tip_and_axes(table, sines, cosines, shifts, n, J)
    p = (0.0, 0.0, 0.0) if frame == SPACE else translation(tip)
    columns.about_point(J, table[:, ROTATES], table[:, SLIDES], n, p)
    if frame == BODY:
        columns.turned_into(J, n, tip)
    return tip


def _rate(J, rates, count, frame, dJ):
    """The rate of the Jacobian, in its frame."""
    if frame == SPACE:
        derivatives.space_rate(J, rates, count, dJ)
    elif frame == BODY:
        derivatives.body_rate(J, rates, count, dJ)
    else:
        derivatives.hybrid_rate(J, rates, count, dJ)


@kernel("w2 r2 r2 int w3")
def jacobian_rates(table, q, dq, frame, dJ):
    """dJ/dt of many configurations and rates, of a chain with a joint."""
    table = borrowed(table)
    q = borrowed(q)
    dq = borrowed(dq)
    dJ = borrowed(dJ)
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    J = np.empty((6, n))
    dJ_x = np.empty((6, n))
    rates = np.empty(n)
    for k in range(q.shape[0]):
        _columns(table, q[k], frame, sines, cosines, shifts, J)
        _followed(table, dq[k], rates)
        if table.shape[1] > OFFSET:
            _rate(J, rates, n, frame, dJ_x)
            columns.coupled(dJ_x, table[:, COUPLING:], n, q.shape[1], dJ[k])
        else:
            _rate(J, rates, n, frame, dJ[k])


@kernel("w2 r2 r2 r2 int w2")
def accelerations(table, q, dq, ddq, frame, A):
    """dV/dt of many configurations, rates and accelerations, of a chain with a joint."""
    table = borrowed(table)
    q = borrowed(q)
    dq = borrowed(dq)
    ddq = borrowed(ddq)
    A = borrowed(A)
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    J = np.empty((6, n))
    dJ = np.empty((6, n))
    rates = np.empty(n)
    more = np.empty(n)
    for k in range(q.shape[0]):
        _columns(table, q[k], frame, sines, cosines, shifts, J)
        _followed(table, dq[k], rates)
        _followed(table, ddq[k], more)
        _rate(J, rates, n, frame, dJ)
        store_row(A[k], derivatives.acceleration(J, dJ, rates, more, n))


@kernel("w2 r2 int w4")
def hessians(table, q, frame, H):
    """dJ/dq of many configurations, of a chain with a joint."""
    table = borrowed(table)
    q = borrowed(q)
    H = borrowed(H)
    n = table.shape[0] - 1
    m = q.shape[1]
    sines, cosines, shifts = scratch(table)
    J = np.empty((6, n))
    H_x = np.empty((6, n, n))
    half = np.empty((6, m, n))
    coupling = table[:, COUPLING:]
    for k in range(q.shape[0]):
        _columns(table, q[k], frame, sines, cosines, shifts, J)
        target = H_x if table.shape[1] > OFFSET else H[k]
        if frame == SPACE:
            derivatives.space_hessian(J, n, target)
        elif frame == BODY:
            derivatives.body_hessian(J, n, target)
        else:
            derivatives.hybrid_hessian(J, n, target)
        if table.shape[1] > OFFSET:
            for j in range(n):
                columns.coupled(H_x[:, :, j], coupling, n, m, half[:, :, j])
            for i in range(m):
                columns.coupled(half[:, i, :], coupling, n, m, H[k][:, i, :])


@kernel("w2 r2 r2 int w3")
def joint_velocities(table, q, dq, frame, V):
    """The twist of every joint's z-aligned frame, into the rows of V."""
    table = borrowed(table)
    q = borrowed(q)
    dq = borrowed(dq)
    V = borrowed(V)
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    J = np.empty((6, n))
    W = np.empty((6, n))
    rates = np.empty(n)
    for k in range(q.shape[0]):
        _columns(table, q[k], SPACE, sines, cosines, shifts, J)
        _followed(table, dq[k], rates)
        derivatives.running(J, rates, n, W)
        T = pose(table[0])
        for i in range(n):
            if i == 0:
                T = turned_about_z(T, sines[0], cosines[0], shifts[0])
            else:
                T = forward.next_frame(T, table[i], sines[i], cosines[i], shifts[i])
            twist = column(W, i)
            if frame == BODY:
                twist = adjoint_inverse(T, twist)
            elif frame != SPACE:
                twist = derivatives.at_point(twist, translation(T))
            store_row(V[k, i], twist)


def _products(table, screws, home, q, x, sines, cosines, shifts, exponentials, P):
    """P_0 ... P_n and the pose into P; the sines, cosines and shifts of the motions as well."""
    n = table.shape[0] - 1
    motions(table, q, sines, cosines, shifts)
    _followed(table, q, x)
    for i in range(n):
        if table.shape[1] > OFFSET:
            x[i] += table[i, OFFSET]
        A = screws[i]
        store_row(
            exponentials[i], exponential.joint(angular(A), linear(A), x[i], sines[i], cosines[i])
        )
    screw_changes.products(exponentials, home, n, P)


@kernel("w2 r2 r1 r2 w4")
def pose_changes(table, screws, home, q, D):
    """Changes of the pose under unit conjugations of the screws and the home pose, as space twists."""
    table = borrowed(table)
    screws = borrowed(screws)
    q = borrowed(q)
    D = borrowed(D)
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    x = np.empty(n)
    exponentials = np.empty((n, 12))
    P = np.empty((n + 2, 12))
    for k in range(q.shape[0]):
        _products(table, screws, home, q[k], x, sines, cosines, shifts, exponentials, P)
        screw_changes.pose_changes(P, n, D[k])


@kernel("w2 r2 r1 r2 int w5")
def jacobian_changes(table, screws, home, q, frame, C):
    """Changes of the Jacobian in a frame under the same conjugations."""
    table = borrowed(table)
    screws = borrowed(screws)
    q = borrowed(q)
    C = borrowed(C)
    n = table.shape[0] - 1
    m = q.shape[1]
    sines, cosines, shifts = scratch(table)
    x = np.empty(n)
    exponentials = np.empty((n, 12))
    P = np.empty((n + 2, 12))
    J = np.empty((6, n))
    D = np.empty((6, n + 1, 6))
    C_x = np.empty((6, n, n + 1, 6))
    coupled = table.shape[1] > OFFSET
    coupling = table[:, COUPLING:]
    for k in range(q.shape[0]):
        _products(table, screws, home, q[k], x, sines, cosines, shifts, exponentials, P)
        screw_changes.pose_changes(P, n, D)
        forward.tip_and_axes(table, sines, cosines, shifts, n, J)
        columns.about_point(J, table[:, ROTATES], table[:, SLIDES], n, (0.0, 0.0, 0.0))
        target = C_x if coupled else C[k]
        if frame == SPACE:
            screw_changes.space_changes(J, P, D, n, target)
        elif frame == BODY:
            screw_changes.body_changes(J, P, D, n, target)
        else:
            screw_changes.hybrid_changes(J, P, D, n, target)
        if coupled:
            for i in range(n + 1):
                for e in range(6):
                    columns.coupled(C_x[:, :, i, e], coupling, n, m, C[k][:, :, i, e])
