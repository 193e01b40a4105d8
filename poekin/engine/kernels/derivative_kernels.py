"""Kernels of a chain's derivatives: rate and Hessian of the Jacobian, accelerations, velocities of
all joint frames, and what a change of the screws does. The table and the frames are those of
`chain_kernels`.
"""

import numpy as np

from ...algebra import adjoint_inverse, angular, column, linear, pose, store_row, translation
from ...formulas.kinematics import columns, derivatives, forward, screw_changes
from ...formulas.lie import exponential
from ..jit.array_io import without_refcount
from ..jit.kernel import kernel
from .chain_kernels import (
    BODY,
    COUPLING,
    OFFSET,
    ROTATES,
    SLIDES,
    SPACE,
    joint_frame,
    scratch,
    set_motions,
    set_rates,
)


def set_columns(table, q, frame, sines, cosines, shifts, J):
    """Write the motions and the Jacobian of the joints, in a frame SPACE, BODY or HYBRID."""
    n = table.shape[0] - 1
    set_motions(table, q, sines, cosines, shifts)
    tip = forward.tip_and_axes(table, sines, cosines, shifts, n, J)
    p = (0.0, 0.0, 0.0) if frame == SPACE else translation(tip)
    columns.about_point(J, table[:, ROTATES], table[:, SLIDES], n, p)
    if frame == BODY:
        columns.rotate_columns(J, n, tip)


def set_jacobian_rate(J, rates, frame, dJ):
    """Write the rate of the Jacobian of the joints, in its frame."""
    count = len(rates)
    if frame == SPACE:
        derivatives.space_rate(J, rates, count, dJ)
    elif frame == BODY:
        derivatives.body_rate(J, rates, count, dJ)
    else:
        derivatives.hybrid_rate(J, rates, count, dJ)


@kernel("w2 r2 r2 int w3")
def jacobian_rates(table, q, dq, frame, dJ):
    """dJ/dt of many configurations and rates, of a chain with a joint."""
    table = without_refcount(table)
    q = without_refcount(q)
    dq = without_refcount(dq)
    dJ = without_refcount(dJ)
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    J = np.empty((6, n))
    rates = np.empty(n)
    dJ_x = np.empty((6, n))
    coupled = table.shape[1] > OFFSET
    for k in range(q.shape[0]):
        set_columns(table, q[k], frame, sines, cosines, shifts, J)
        set_rates(table, dq[k], rates)
        target = dJ_x if coupled else dJ[k]
        set_jacobian_rate(J, rates, frame, target)
        if coupled:
            columns.coupled(dJ_x, table[:, COUPLING:], n, q.shape[1], dJ[k])


@kernel("w2 r2 r2 r2 int w2")
def accelerations(table, q, dq, ddq, frame, A):
    """dV/dt of many configurations, rates and accelerations, of a chain with a joint."""
    table = without_refcount(table)
    q = without_refcount(q)
    dq = without_refcount(dq)
    ddq = without_refcount(ddq)
    A = without_refcount(A)
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    J = np.empty((6, n))
    rates = np.empty(n)
    dJ = np.empty((6, n))
    ddx = np.empty(n)
    for k in range(q.shape[0]):
        set_columns(table, q[k], frame, sines, cosines, shifts, J)
        set_rates(table, dq[k], rates)
        set_rates(table, ddq[k], ddx)
        set_jacobian_rate(J, rates, frame, dJ)
        store_row(A[k], derivatives.acceleration(J, dJ, rates, ddx, n))


@kernel("w2 r2 int w4")
def hessians(table, q, frame, H):
    """dJ/dq of many configurations, of a chain with a joint."""
    table = without_refcount(table)
    q = without_refcount(q)
    H = without_refcount(H)
    n = table.shape[0] - 1
    m = q.shape[1]
    sines, cosines, shifts = scratch(table)
    J = np.empty((6, n))
    H_x = np.empty((6, n, n))
    half = np.empty((6, m, n))
    coupled = table.shape[1] > OFFSET
    coupling = table[:, COUPLING:]
    for k in range(q.shape[0]):
        set_columns(table, q[k], frame, sines, cosines, shifts, J)
        target = H_x if coupled else H[k]
        if frame == SPACE:
            derivatives.space_hessian(J, n, target)
        elif frame == BODY:
            derivatives.body_hessian(J, n, target)
        else:
            derivatives.hybrid_hessian(J, n, target)
        if coupled:
            for j in range(n):
                columns.coupled(
                    H_x[:, :, j],
                    coupling,
                    n,
                    m,
                    half[:, :, j],
                )
            for i in range(m):
                columns.coupled(
                    half[:, i, :],
                    coupling,
                    n,
                    m,
                    H[k][:, i, :],
                )


@kernel("w2 r2 r2 int w3")
def joint_velocities(table, q, dq, frame, V):
    """The twist of every joint's z-aligned frame, into the rows of V."""
    table = without_refcount(table)
    q = without_refcount(q)
    dq = without_refcount(dq)
    V = without_refcount(V)
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    J = np.empty((6, n))
    rates = np.empty(n)
    W = np.empty((6, n))
    for k in range(q.shape[0]):
        set_columns(table, q[k], SPACE, sines, cosines, shifts, J)
        set_rates(table, dq[k], rates)
        derivatives.cumulative_twists(J, rates, n, W)
        T = pose(table[0])
        for i in range(n):
            T = joint_frame(T, table, sines, cosines, shifts, i)
            twist = column(W, i)
            if frame == BODY:
                twist = adjoint_inverse(T, twist)
            elif frame != SPACE:
                twist = derivatives.at_point(twist, translation(T))
            store_row(V[k, i], twist)


def set_exponentials(table, screws, q, x, sines, cosines, exponentials):
    """Write x = C q + c and e^{A_i x_i}, the sines and cosines of the motions given."""
    set_rates(table, q, x)
    for i in range(table.shape[0] - 1):
        if table.shape[1] > OFFSET:
            x[i] += table[i, OFFSET]
        A = screws[i]
        store_row(
            exponentials[i],
            exponential.joint(angular(A), linear(A), x[i], sines[i], cosines[i]),
        )


@kernel("w2 r2 r1 r2 w4")
def pose_changes(table, screws, home, q, D):
    """Changes of the pose under unit conjugations of the screws and the home pose, as space twists."""
    table = without_refcount(table)
    screws = without_refcount(screws)
    q = without_refcount(q)
    D = without_refcount(D)
    n = table.shape[0] - 1
    sines, cosines, shifts = scratch(table)
    x = np.empty(n)
    exponentials = np.empty((n, 12))
    P = np.empty((n + 2, 12))
    for k in range(q.shape[0]):
        set_motions(table, q[k], sines, cosines, shifts)
        set_exponentials(table, screws, q[k], x, sines, cosines, exponentials)
        screw_changes.products(exponentials, home, n, P)
        screw_changes.pose_changes(P, n, D[k])


@kernel("w2 r2 r1 r2 int w5")
def jacobian_changes(table, screws, home, q, frame, C):
    """Changes of the Jacobian in a frame under the same conjugations."""
    table = without_refcount(table)
    screws = without_refcount(screws)
    q = without_refcount(q)
    C = without_refcount(C)
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
        set_columns(table, q[k], SPACE, sines, cosines, shifts, J)
        set_exponentials(table, screws, q[k], x, sines, cosines, exponentials)
        screw_changes.products(exponentials, home, n, P)
        screw_changes.pose_changes(P, n, D)
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
                    columns.coupled(
                        C_x[:, :, i, e],
                        coupling,
                        n,
                        m,
                        C[k][:, :, i, e],
                    )
