"""Derivatives of the Jacobian, and what is built on them: its rate, its Hessian, the tool's
acceleration.

`J` is six rows of one column a joint, in the frame that a function's name says (`columns`); `rates`
are the joints' velocities. Every derivative of a column is a bracket of two columns: a space column
s_i is carried by the joints before it, ds_i/dx_j = [s_j, s_i] for j < i; a body column b_i by those
behind it, db_i/dx_j = [b_i, b_j] for j > i. All else is zero. In hybrid columns (w_i; v_i), with
base axes at the tool's origin, dw_i/dx_j = w_j x w_i for j < i, and the linear parts are second
derivatives of a point: dv_i/dx_j = w_k x v_l with k = min(i, j), l = max(i, j).
Accuracy: each bracket rounds by a few u = 2^-53 of its columns' product beyond what is wrong in the
columns (tests/model/kinematics/test_derivatives.py).
Source: Park 1994, Section III, J_s differentiated; the bracket is ad of its Section II.
"""

from ...algebra import add, angular, column, cross, linear, scale, set_column, subtract, twist

ZERO_TWIST = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def bracket(X, Y):
    """[X, Y] = ad(X) Y = (w_X x w_Y; w_X x v_Y + v_X x w_Y): 18 multiplications and 12 additions."""
    w = angular(X)
    a = angular(Y)
    v = add(cross(w, linear(Y)), cross(linear(X), a))
    return twist(cross(w, a), v)


def scale_twist(k, V):
    """k V of a scalar and a twist."""
    w = scale(k, angular(V))
    v = scale(k, linear(V))
    return twist(w, v)


def add_twists(V, W):
    """V + W of two twists."""
    return twist(
        add(angular(V), angular(W)),
        add(linear(V), linear(W)),
    )


def subtract_twists(V, W):
    """V - W of two twists."""
    return twist(
        subtract(angular(V), angular(W)),
        subtract(linear(V), linear(W)),
    )


def at_point(V, p):
    """(w; v + w x p): the same twist with the velocity of the point p in place of the origin's."""
    w = angular(V)
    turned = cross(w, p)
    return twist(w, add(linear(V), turned))


def cumulative_twists(J, rates, count, V):
    """V_i = the sum over j <= i of J_j dx_j: the velocity of what follows joint i, written as
    column i of V.

    6 n multiplications and 6 n - 6 additions.
    """
    W = scale_twist(rates[0], column(J, 0))
    set_column(V, 0, W)
    for i in range(1, count):
        own = scale_twist(rates[i], column(J, i))
        W = add_twists(W, own)
        set_column(V, i, W)


def space_rate(J, rates, count, dJ):
    """dJ_s/dt: column i is [V_{i-1}, s_i], V_{i-1} the velocity of what carries joint i.

    24 n - 18 multiplications and 18 n - 18 additions.
    """
    set_column(dJ, 0, ZERO_TWIST)
    V = scale_twist(rates[0], column(J, 0))
    for i in range(1, count):
        S = column(J, i)
        set_column(dJ, i, bracket(V, S))
        V = add_twists(V, scale_twist(rates[i], S))


def body_rate(J, rates, count, dJ):
    """dJ_b/dt: column i is [b_i, U_i], U_i the tool's velocity relative to the link behind joint i.

    24 n - 18 multiplications and 18 n - 18 additions.
    """
    set_column(dJ, count - 1, ZERO_TWIST)
    last = column(J, count - 1)
    U = scale_twist(rates[count - 1], last)
    for i in range(count - 2, -1, -1):
        B = column(J, i)
        set_column(dJ, i, bracket(B, U))
        U = add_twists(U, scale_twist(rates[i], B))


def hybrid_rate(J, rates, count, dJ):
    """dJ_h/dt: column i is (W_{i-1} x w_i; W_i x v_i + w_i x u_i).

    W_i is the sum of w_j dx_j over j <= i, and u_i that of v_j dx_j over j > i.
    24 n - 12 multiplications and 18 n - 12 additions.
    """
    last = column(J, count - 1)
    set_column(dJ, count - 1, ZERO_TWIST)
    u = scale(rates[count - 1], linear(last))
    for i in range(count - 2, -1, -1):
        H = column(J, i)
        v = cross(angular(H), u)
        set_column(dJ, i, twist((0.0, 0.0, 0.0), v))
        u = add(u, scale(rates[i], linear(H)))
    first = column(J, 0)
    W = scale(rates[0], angular(first))
    v = linear(column(dJ, 0))
    v = add(v, cross(W, linear(first)))
    set_column(dJ, 0, twist((0.0, 0.0, 0.0), v))
    for i in range(1, count):
        H = column(J, i)
        w = angular(H)
        before = W
        W = add(W, scale(rates[i], w))
        v = linear(column(dJ, i))
        v = add(v, cross(W, linear(H)))
        set_column(dJ, i, twist(cross(before, w), v))


def acceleration(J, dJ, rates, accelerations, count):
    """dV/dt = J ddx + (dJ/dt) dx, in the frame of J: 12 n multiplications and 12 n - 6 additions."""
    own = scale_twist(accelerations[0], column(J, 0))
    A = add_twists(own, scale_twist(rates[0], column(dJ, 0)))
    for i in range(1, count):
        own = scale_twist(accelerations[i], column(J, i))
        carried = scale_twist(rates[i], column(dJ, i))
        A = add_twists(A, add_twists(own, carried))
    return A


def set_derivative(H, i, j, V):
    """Writes V, the derivative of twist i by number j, into H: H[r][i][j] is its component r."""
    for r in range(6):
        H[r][i][j] = V[r]


def space_hessian(J, count, H):
    """ds_i/dx_j = [s_j, s_i] for j < i, else 0: 9 n (n - 1) multiplications and 6 n (n - 1)
    additions.
    """
    for i in range(count):
        S = column(J, i)
        for j in range(i):
            carried = bracket(column(J, j), S)
            set_derivative(H, i, j, carried)
        for j in range(i, count):
            set_derivative(H, i, j, ZERO_TWIST)


def body_hessian(J, count, H):
    """db_i/dx_j = [b_i, b_j] for j > i, else 0: 9 n (n - 1) multiplications and 6 n (n - 1)
    additions.
    """
    for i in range(count):
        B = column(J, i)
        for j in range(i + 1):
            set_derivative(H, i, j, ZERO_TWIST)
        for j in range(i + 1, count):
            carried = bracket(B, column(J, j))
            set_derivative(H, i, j, carried)


def hybrid_hessian(J, count, H):
    """dw_i/dx_j = w_j x w_i for j < i, else 0; dv_i/dx_j = w_k x v_l with k = min(i, j), l = max(i,
    j).

    6 n² multiplications and 3 n² additions.
    """
    for i in range(count):
        later = column(J, i)
        for j in range(i + 1):
            earlier = column(J, j)
            w = angular(earlier)
            v = cross(w, linear(later))
            set_derivative(H, j, i, twist((0.0, 0.0, 0.0), v))
            if j < i:
                turned = cross(w, angular(later))
                set_derivative(H, i, j, twist(turned, v))
