"""Recursions over z-aligned link frames: the body Jacobian and the paper's V recursion.

`links` are the poses f_{i-1,i} = M_i e^{S_i x_i}; r (`rotates`) and s (`slides`) make the screw S =
(0, 0, r; 0, 0, s). `Chain.jacobian` runs `forward.tip_and_axes` and `columns`, which cost less;
`pk.count` counts both. The integers 0 and 1 in them are structure, not numbers, and cost nothing when
counted.
Accuracy: rounding of the products, u (8 (n + 1) + 4 sum |x|), u = 2^-53, lengths times the reach
(tests/model/test_chain_laws.py).
Source: Park 1994, Section IV. As printed V_i has its index off by one; V_n = f^-1 f' is the body
velocity.
"""

from ...algebra import adjoint_inverse, compose, pose, set_column


def z_column(T, r, s):
    """Ad(T)^-1 (0, 0, r; 0, 0, s): 6 multiplications and 3 additions of a revolute joint, none of a
    prismatic one.
    """
    x = r * T[9]
    y = r * T[10]
    return (
        r * T[6],
        r * T[7],
        r * T[8],
        x * T[3] - y * T[0] + s * T[6],
        x * T[4] - y * T[1] + s * T[7],
        x * T[5] - y * T[2] + s * T[8],
    )


def body(links, rotates, slides, count, J):
    """Body Jacobian, tool in the last link frame: column i is Ad(f_{i,i+1} ... f_{n-1,n})^-1 S_i.

    (n - 2) products and (n - 1) columns: 42 n - 78 multiplications and 30 n - 57 additions if
    revolute.
    Returns f_{1,n}, the tool in the frame of joint 1: links[0] times it is the pose f.
    """
    set_column(J, count - 1, (0.0, 0.0, rotates[count - 1], 0.0, 0.0, slides[count - 1]))
    T = pose(links[count - 1])
    for i in range(count - 2, -1, -1):
        if i < count - 2:
            T = compose(links[i + 1], T)
        set_column(J, i, z_column(T, rotates[i], slides[i]))
    return T


def body_with_tool(links, tool, rotates, slides, count, J):
    """Body Jacobian with the trailing constant tool pose M_{n+1} that z-aligned frames need.

    (n - 1) products and (n - 1) columns that depend on x: 42 n - 42 multiplications and 30 n - 30
    additions if revolute. Returns the tool in the frame of joint 1.
    """
    T = pose(tool)
    set_column(J, count - 1, z_column(T, rotates[count - 1], slides[count - 1]))
    for i in range(count - 2, -1, -1):
        T = compose(links[i + 1], T)
        set_column(J, i, z_column(T, rotates[i], slides[i]))
    return T


def body_velocity(links, tool, rotates, slides, count, rates):
    """Body velocity (omega; v) of the tool: V_i = Ad(f_{i-1,i})^-1 V_{i-1} + S_i dx_i, V_0 = 0 (the
    V recursion).
    """
    V = (
        0.0,
        0.0,
        rotates[0] * rates[0],
        0.0,
        0.0,
        slides[0] * rates[0],
    )
    for i in range(1, count):
        V = adjoint_inverse(links[i], V)
        V = (
            V[0],
            V[1],
            V[2] + rotates[i] * rates[i],
            V[3],
            V[4],
            V[5] + slides[i] * rates[i],
        )
    return adjoint_inverse(tool, V)
