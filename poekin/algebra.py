"""Vectors, rotations, poses and twists as tuples of scalars of any kind.

- vector: (x, y, z)
- rotation R: nine numbers, row by row
- pose T = (R, p): twelve numbers, the nine of R, then p
- twist or screw (omega; v): six numbers, the angular part first

Plain Python without branches, so that one function serves floats, compiled code, counting scalars
and exact numbers.
An argument may be any indexable row; what is returned is a tuple.
"""

IDENTITY = (1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0)


def add(a, b):
    """a + b of two vectors."""
    return (
        a[0] + b[0],
        a[1] + b[1],
        a[2] + b[2],
    )


def subtract(a, b):
    """a - b of two vectors."""
    return (
        a[0] - b[0],
        a[1] - b[1],
        a[2] - b[2],
    )


def scale(k, a):
    """k a of a scalar and a vector."""
    return (k * a[0], k * a[1], k * a[2])


def dot(a, b):
    """a . b of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    """a x b of two vectors."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def rotate(R, a):
    """R a."""
    return (
        R[0] * a[0] + R[1] * a[1] + R[2] * a[2],
        R[3] * a[0] + R[4] * a[1] + R[5] * a[2],
        R[6] * a[0] + R[7] * a[1] + R[8] * a[2],
    )


def unrotate(R, a):
    """R^T a."""
    return (
        R[0] * a[0] + R[3] * a[1] + R[6] * a[2],
        R[1] * a[0] + R[4] * a[1] + R[7] * a[2],
        R[2] * a[0] + R[5] * a[1] + R[8] * a[2],
    )


def transform(T, a):
    """R a + p of a pose and a point."""
    return (
        T[0] * a[0] + T[1] * a[1] + T[2] * a[2] + T[9],
        T[3] * a[0] + T[4] * a[1] + T[5] * a[2] + T[10],
        T[6] * a[0] + T[7] * a[1] + T[8] * a[2] + T[11],
    )


def angular(V):
    """omega of a twist (omega; v)."""
    return (V[0], V[1], V[2])


def linear(V):
    """v of a twist (omega; v)."""
    return (V[3], V[4], V[5])


def translation(T):
    """p of a pose (R, p)."""
    return (T[9], T[10], T[11])


def twist(w, v):
    """The twist (w; v) of two vectors."""
    return (w[0], w[1], w[2], v[0], v[1], v[2])


def make_pose(R, p):
    """The pose (R, p) of a rotation and a vector."""
    return (R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8], p[0], p[1], p[2])


def pose(row):
    """Pose held by the first twelve numbers of a row."""
    return make_pose(row, translation(row))


def axes(T):
    """The axes X, Y, Z and the origin of a pose."""
    return (T[0], T[3], T[6]), (T[1], T[4], T[7]), (T[2], T[5], T[8]), translation(T)


def from_axes(X, Y, Z, o):
    """The pose of the axes X, Y, Z and the origin: inverse of `axes`."""
    return make_pose((X[0], Y[0], Z[0], X[1], Y[1], Z[1], X[2], Y[2], Z[2]), o)


def compose(T_ab, T_bc):
    """T_ac = T_ab T_bc, as of f' = P f Q in the paper's Section II: 36 multiplications and 27
    additions.
    """
    x = unrotate(T_bc, T_ab[0:3])
    y = unrotate(T_bc, T_ab[3:6])
    z = unrotate(T_bc, T_ab[6:9])
    return make_pose((*x, *y, *z), transform(T_ab, translation(T_bc)))


def inverse(T_ab):
    """T_ba = (R^T, -R^T p)."""
    R = T_ab
    p = unrotate(R, translation(T_ab))
    return (R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8], -p[0], -p[1], -p[2])


def adjoint(T_ab, V_b):
    """V_a = Ad(T_ab) V_b = (R w; R v + p x R w), the paper's eq. (3): 24 multiplications and 18
    additions.
    """
    w = rotate(T_ab, angular(V_b))
    return twist(w, add(rotate(T_ab, linear(V_b)), cross(translation(T_ab), w)))


def adjoint_inverse(T_ab, V_a):
    """V_b = Ad(T_ab)^-1 V_a = (R^T w; R^T (v - p x w)): 24 multiplications and 18 additions."""
    w = angular(V_a)
    v = subtract(linear(V_a), cross(translation(T_ab), w))
    return twist(unrotate(T_ab, w), unrotate(T_ab, v))


def turned_about_z(T, sine, cosine, slide):
    """T (Rz, slide z), M_i e^{S_i q_i} of the paper's Section IV: a joint about and along its own z
    axis. Its sine and cosine are given: a table of them may serve, the paper's alternative.
    """
    X, Y, Z, o = axes(T)
    X, Y = turn_axes(X, Y, sine, cosine)
    return from_axes(X, Y, Z, add(o, scale(slide, Z)))


def turn_axes(a, b, sine, cosine):
    """(cosine a + sine b, cosine b - sine a): two axes of a frame after a turn about the third."""
    return add(scale(cosine, a), scale(sine, b)), subtract(scale(cosine, b), scale(sine, a))


def column(J, i):
    """Column i of six rows, a twist."""
    return (
        J[0][i],
        J[1][i],
        J[2][i],
        J[3][i],
        J[4][i],
        J[5][i],
    )


def set_column(J, i, V):
    """Write the twist V into column i of six rows."""
    J[0][i] = V[0]
    J[1][i] = V[1]
    J[2][i] = V[2]
    J[3][i] = V[3]
    J[4][i] = V[4]
    J[5][i] = V[5]


def store_row(row, values):
    """Write the numbers of a tuple into a row."""
    for k in range(len(values)):
        row[k] = values[k]
