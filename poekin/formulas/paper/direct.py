"""The Jacobian by the direct method: each screw carried by the product of the exponentials before
it.

Accuracy: rounding of the products, u (8 (n + 1) + 4 sum |x|), u = 2^-53, lengths times the reach
(tests/model/test_chain_laws.py).
Source: Park 1994, Section III, "The Jacobian": (n - 2) products (36, 27) and (n - 1) adjoints (24,
18), that is
60 n - 96 multiplications and 45 n - 72 additions.
"""

from ...algebra import adjoint, adjoint_inverse, compose, pose, set_column


def space(screws, exponentials, count, J):
    """Space Jacobian: column i is Ad(e^{A_1 q_1} ... e^{A_{i-1} q_{i-1}}) A_i. Example 1's arm is in
    its test.

    `screws` are A_i in the base frame, `exponentials` the poses e^{A_i q_i}. Returns the product of
    all exponentials but the last: times e^{A_n q_n} M it is the pose f.
    """
    set_column(J, 0, screws[0])
    T = pose(exponentials[0])
    for i in range(1, count):
        if i > 1:
            T = compose(T, exponentials[i - 1])
        set_column(J, i, adjoint(T, screws[i]))
    return T


def body(screws, exponentials, count, J):
    """Body Jacobian, eq. (2): column i is Ad(e^{B_{i+1} q_{i+1}} ... e^{B_n q_n})^-1 B_i.

    `screws` are B_i in the tool frame, `exponentials` the poses e^{B_i q_i}. Returns the product of
    all exponentials but the first: M e^{B_1 q_1} times it is the pose f.
    """
    set_column(J, count - 1, screws[count - 1])
    T = pose(exponentials[count - 1])
    for i in range(count - 2, -1, -1):
        if i < count - 2:
            T = compose(exponentials[i + 1], T)
        set_column(J, i, adjoint_inverse(T, screws[i]))
    return T
