"""Changes of the pose and the Jacobian when the screws move: A_i <- Ad(e^eta_i) A_i, M <- M e^eta.

The conjugation keeps every axis unit and every pitch as it is. With P_i = e^{A_1 x_1} ... e^{A_i
x_i} it turns e^{A_i x_i} into e^eta_i e^{A_i x_i} e^-eta_i, so the pose f = P_n M moves by the
space twist

    df f^-1 = sum over i of (Ad(P_{i-1}) - Ad(P_i)) eta_i + Ad(f) eta

and a space column s_k = Ad(P_{k-1}) A_k by [d_i, s_k] for i < k, d_i the pose's twist, by
[Ad(P_{k-1}) eta_k, s_k] for i = k, and not at all for i > k. `P` holds P_0 ... P_n and the pose f,
twelve numbers a row (`products`).
Accuracy: rounding of the products, u (8 (n + 1) + 4 sum |x|), u = 2^-53, lengths times the reach
(tests/model/kinematics/test_derivatives.py).
Source: Park 1994, Section II, with e^{Ad(g) A x} = g e^{A x} g^-1.
"""

from ...algebra import (
    IDENTITY,
    add,
    adjoint,
    adjoint_inverse,
    angular,
    column,
    compose,
    cross,
    dot,
    linear,
    pose,
    store_row,
    translation,
    twist,
)
from .derivatives import ZERO_TWIST, at_point, bracket, set_derivative, subtract_twists

UNITS = tuple(tuple(int(k == e) for k in range(6)) for e in range(6))


def products(exponentials, home, count, P):
    """P_0 = I, P_i = P_{i-1} e^{A_i x_i}, and f = P_n M, eq. (1), as rows 0 ... n + 1 of P."""
    T = pose_row(P, 0, IDENTITY)
    for i in range(count):
        T = pose_row(P, i + 1, compose(T, exponentials[i]))
    pose_row(P, count + 1, compose(T, home))


def pose_row(P, i, T):
    """Write the pose T into row i of P, and hand out what stands there."""
    store_row(P[i], T)
    return pose(P[i])


def pose_changes(P, count, D):
    """D[r][i][e]: component r of df f^-1 per unit of component e of eta_i; of the home pose's eta
    for i = n.
    """
    for e in range(6):
        before = adjoint(P[0], UNITS[e])
        for i in range(count):
            after = adjoint(P[i + 1], UNITS[e])
            set_derivative(D, i, e, subtract_twists(before, after))
            before = after
        set_derivative(D, count, e, adjoint(P[count + 1], UNITS[e]))


def _derivative(D, i, e):
    return (
        D[0][i][e],
        D[1][i][e],
        D[2][i][e],
        D[3][i][e],
        D[4][i][e],
        D[5][i][e],
    )


def column_change(J, P, D, k, i, e):
    """Change of the space column s_k per unit of component e of eta_i; J holds the space columns."""
    if i < k:
        return bracket(_derivative(D, i, e), column(J, k))
    if i == k:
        return bracket(adjoint(P[k], UNITS[e]), column(J, k))
    return ZERO_TWIST


def space_changes(J, P, D, count, C):
    """C[r][k][i][e]: component r of the change of s_k per unit of component e of eta_i (i = n: of
    the home pose).
    """
    for k in range(count):
        for i in range(count + 1):
            for e in range(6):
                _store_change(C, k, i, e, column_change(J, P, D, k, i, e))


def body_changes(J, P, D, count, C):
    """Change of the body columns b_k = Ad(f)^-1 s_k: Ad(f)^-1 (ds_k - [d, s_k]), d the space twist
    of the pose.
    """
    f = P[count + 1]
    for k in range(count):
        S = column(J, k)
        for i in range(count + 1):
            for e in range(6):
                change = column_change(J, P, D, k, i, e)
                relative = bracket(_derivative(D, i, e), S)
                _store_change(C, k, i, e, adjoint_inverse(f, subtract_twists(change, relative)))


def hybrid_changes(J, P, D, count, C):
    """Change of the hybrid columns: that of s_k with its velocity at p, and w_k x dp more, p the
    tool's origin.
    """
    p = translation(P[count + 1])
    for k in range(count):
        w = angular(column(J, k))
        for i in range(count + 1):
            for e in range(6):
                change = at_point(column_change(J, P, D, k, i, e), p)
                dp = linear(at_point(_derivative(D, i, e), p))
                _store_change(C, k, i, e, twist(angular(change), add(linear(change), cross(w, dp))))


def _store_change(C, k, i, e, V):
    for r in range(6):
        C[r][k][i][e] = V[r]


def source_twist(D, p, source, count):
    """Rotation and displacement (dω; dp) of the tool by a source (count + 1, 6): its origin p in the
    base, D the derivatives of `pose_changes`.

    Accuracy: that of D, times the sum of the source's entries.
    """
    total = [0.0] * 6
    for r in range(6):
        for i in range(count + 1):
            for e in range(6):
                total[r] = total[r] + D[r][i][e] * source[i][e]
    V = (total[0], total[1], total[2], total[3], total[4], total[5])
    return at_point(V, p)


def squared_rotation(V):
    """|dω|², rad²."""
    w = angular(V)
    return dot(w, w)


def squared_displacement(V):
    """|dp|², m²."""
    v = linear(V)
    return dot(v, v)
