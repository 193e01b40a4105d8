"""Solutions that branches of a closed form lead to: sharpened by Newton's rule, and held against the
pose that the arm has there.

    J dq = e,   e = (sin(phi) n; p* - p),   e^{[n] phi} R = R*

The branches may be those of an arm nearby, of which the arm itself is a calibrated one. Accuracy: a
solution's pose is the target within 1e-9, of which Newton's rule leaves rounding unless the arm is
singular there (tests/formulas/inverse/test_confirmed.py). Source: Luh, Walker and Paul 1980, Resolved
acceleration control of mechanical manipulators, whose error of the rotation this is.
"""

from ...algebra import add, cross, dot, scale, subtract
from ..lie import defect
from . import least_squares

OUTSIDE = -1e-4
"""Margin below which a branch is no solution of the arm itself, whatever a target's rotation misses of
being one.
"""
OUTSIDE_NEARBY = -0.02
"""Margin below which a branch is no solution of an arm nearby."""

_DEFECT = 1e-5
_EXACT = 1e-14
_CONFIRMED = 1e-9
_ALIKE = 1e-7
_STEPS = 16
_LONGEST = 0.2  # rad or m
_LARGE = 1e300
_ONES = (1.0, 1.0, 1.0, 1.0, 1.0, 1.0)


def select(forward, placed, target, branches, sizes, T, work, q):
    """Write the solutions that branches lead to into rows of q, and return their number.

    `forward(x, T, J)` writes the pose T, 4 x 4, and the hybrid Jacobian J; `placed(branch, T)` the
    pose of a branch: m <= 6 coordinates, what else it has, and a margin. `sizes` holds the period of
    each coordinate, 0 of a length, the arm's reach, and the margin of which a branch has to have
    more. `work` is scratch, m + 8 rows of m.
    """
    m = len(sizes) - 2
    found = 0
    if not _is_pose(target):
        return found
    for k in range(len(branches)):
        branch = branches[k]
        if not branch[len(branch) - 1] > sizes[m + 1]:
            continue
        for i in range(m):
            q[found][i] = branch[i]
        placed(branch, T)
        near = size(pose_error(T, target), sizes[m]) <= _EXACT * _EXACT
        if not near:
            near = _converged(forward, target, sizes[m], T, work, q[found])
        if near and not _is_listed(q, found, sizes):
            found += 1
    return found


def _is_pose(T):
    """Whether a 4 x 4 matrix has a rotation, within what poses are accepted with."""
    x = _column(T, 0)
    y = _column(T, 1)
    z = _column(T, 2)
    R = x + y + z
    return defect.orthonormality(R) <= _DEFECT and defect.determinant(R) > 0.0


def _converged(forward, target, reach, T, work, x):
    """Sharpen x in place, and return whether it is a solution."""
    m = len(x)
    J = work[0:6]
    g = work[6]
    last = work[7]
    least = _LARGE
    for _ in range(_STEPS):
        forward(x, T, J)
        e = pose_error(T, target)
        error = size(e, reach)
        if error <= _EXACT * _EXACT:
            return True
        if least <= _CONFIRMED * _CONFIRMED and not 4.0 * error < least:
            if not error < least:
                for i in range(m):
                    x[i] = last[i]
            return True
        least = error
        least_squares.normal_equations(J, e, _ONES, 0.0, _ONES, m, work[8:], g)
        least_squares.solve(work[8:], g, m)
        share = _shortened(g)
        for i in range(m):
            last[i] = x[i]
            x[i] += share * g[i]
    return least <= _CONFIRMED * _CONFIRMED


def _shortened(step):
    """Factor of a step that none of its coordinates goes too far: Newton's rule would end at another
    branch, where the arm is nearly singular.
    """
    most = 0.0
    for i in range(len(step)):
        most = max(most, abs(step[i]))
    if most > _LONGEST:
        return _LONGEST / most
    return 1.0


def pose_error(T, target):
    """(sin(phi) n; p* - p) of two 4 x 4 matrices; of phi of a quarter turn and more the tip is taken
    to be very far.
    """
    x = _column(T, 0)
    y = _column(T, 1)
    z = _column(T, 2)
    to_x = _column(target, 0)
    to_y = _column(target, 1)
    to_z = _column(target, 2)
    w = scale(0.5, add(cross(x, to_x), add(cross(y, to_y), cross(z, to_z))))
    p = subtract(_column(target, 3), _column(T, 3))
    if not dot(x, to_x) + dot(y, to_y) + dot(z, to_z) > 1.0:
        p = (_LARGE, _LARGE, _LARGE)
    return w + p


def size(e, reach):
    """|e|^2, lengths by the reach."""
    w = (e[0], e[1], e[2])
    p = (e[3], e[4], e[5])
    return dot(w, w) + dot(p, p) / (reach * reach)


def _is_listed(q, count, sizes):
    """Whether row `count` of q is one of the rows before it, whole turns apart or none."""
    for k in range(count):
        if _is_alike(q[k], q[count], sizes):
            return True
    return False


def _is_alike(a, b, sizes):
    for i in range(len(a)):
        apart = abs(a[i] - b[i])
        if not min(apart, abs(apart - sizes[i])) <= _ALIKE:
            return False
    return True


def _column(T, j):
    return T[0][j], T[1][j], T[2][j]
