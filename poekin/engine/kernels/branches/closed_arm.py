"""Array of one arm of six joints that is solved in closed form, and the six axes for a target.

Joints are in the order in which the arm is solved. A loop of six joints may be cut at any of them:

    X_1 ... X_6 = D   is   X_{k+1} ... X_6 (D^-1 X_1 D) ... (D^-1 X_k D) = D,   D = T M^-1

so the last k joints are fixed to the tool, and `D^-1` brings their axes to the target. Rows 0 to 5:
direction, a point of the axis, whether it is prismatic, its coordinate's column or -1 of a joint
that the arm does not have and that has to stay at 0. Rows 6 to 8: M^-1. Row 9: family, k, a vector
across the axis that the family names, and how many joints the arm does not have. All in the base
frame at zero.
"""

from ....algebra import rotate, subtract, unrotate
from ...straight_line.arctangent import atan2

SHAPE = (10, 8)
DIRECTION = 0
POINT = 3
SLIDES = 6
COLUMN = 7
HOME = 6
RULE = 9
FAMILY = 0
TURNED = 1
ACROSS = 2
ADDED = 5

WRIST = 0
PARALLEL = 1

BRANCHES = 8
"""Rows of a target: as many as any family has branches."""

# rad or m: how near to 0 a joint that the arm does not have is in a solution, and in what may be one
# within the square root of rounding
HELD = 1e-9
NEAR = 1e-3
LOST = 1e-7
"""Share of the largest determinant of the six joints below which an added one may be anywhere."""

DOUBLE = 1e-9
"""Margin within which of 0 a double root may be, or two."""

UNSURE = -2.0
"""Margin of a row with an added joint anywhere: the arm may have solutions that are not listed."""


def doubted(margin, first):
    """Margin of a branch whose first step has the margin `first`: 0 at least where that is a double
    root, or one of infinitely many, of which another one may reach.
    """
    if abs(first) < DOUBLE:
        return max(margin, 0.0)
    return margin


def vector(row, start):
    """Three numbers of a row."""
    return row[start], row[start + 1], row[start + 2]


def displacement(arm, T):
    """Rotation and translation of D = T M^-1."""
    a = (arm[HOME, 0], arm[HOME + 1, 0], arm[HOME + 2, 0])
    b = (arm[HOME, 1], arm[HOME + 1, 1], arm[HOME + 2, 1])
    c = (arm[HOME, 2], arm[HOME + 1, 2], arm[HOME + 2, 2])
    o = (arm[HOME, 3], arm[HOME + 1, 3], arm[HOME + 2, 3])
    x = rotate(T, a)
    y = rotate(T, b)
    z = rotate(T, c)
    p = rotate(T, o)
    R = (x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2])
    return R, (p[0] + T[9], p[1] + T[10], p[2] + T[11])


def direction(arm, i, R):
    """Direction of axis i for a target's D."""
    h = vector(arm[i], DIRECTION)
    if i >= 6 - arm[RULE, TURNED]:
        return unrotate(R, h)
    return h


def point(arm, i, R, p):
    """Point of axis i for a target's D = (R, p)."""
    c = vector(arm[i], POINT)
    if i >= 6 - arm[RULE, TURNED]:
        return unrotate(R, subtract(c, p))
    return c


def across(arm, i, R):
    """The family's vector across axis i for a target's D."""
    a = vector(arm[RULE], ACROSS)
    if i >= 6 - arm[RULE, TURNED]:
        return unrotate(R, a)
    return a


def slides(arm, i):
    """Whether joint i is prismatic."""
    return arm[i, SLIDES] != 0.0


def coordinates(arm):
    """Number of the coordinates that the arm has."""
    return 6 - int(arm[RULE, ADDED])


def store(arm, x, margin, row):
    """Write the coordinates and margin of x = (x_1, y_1, ..., x_6, y_6), and return whether joints
    that the arm does not have are near 0. A row of 3 m + 1 numbers gets the x of all coordinates
    and their y instead of these, which `finish` makes of them.
    """
    m = coordinates(arm)
    away = 0.0
    if arm[RULE, ADDED]:
        away = _away(arm, x)
    for i in range(6):
        column = int(arm[i, COLUMN])
        if column >= 0 and row.shape[0] == m + 1:
            row[column] = _coordinate(arm, i, x)
        elif column >= 0:
            row[m + column] = x[2 * i]
            row[2 * m + column] = x[2 * i + 1]
    if not away <= HELD or not margin > 0.0:
        margin = min(margin, -away)
    row[row.shape[0] - 1] = margin
    return away <= NEAR


def _away(arm, x):
    """Largest coordinate of the joints that the arm does not have."""
    away = 0.0
    for i in range(6):
        if arm[i, COLUMN] < 0:
            value = abs(_coordinate(arm, i, x))
            if not value <= away:
                away = value
    return away


def _coordinate(arm, i, x):
    if slides(arm, i):
        return x[2 * i]
    return atan2(x[2 * i + 1], x[2 * i])


def finish(arm, row):
    """Write the coordinates of a row of 3 m + 1 numbers: a compiler takes several angles at once."""
    m = coordinates(arm)
    for k in range(m):
        row[k] = atan2(row[2 * m + k], row[m + k])
    if _any_slides(arm):
        for i in range(6):
            if slides(arm, i) and arm[i, COLUMN] >= 0:
                row[int(arm[i, COLUMN])] = row[m + int(arm[i, COLUMN])]


def _any_slides(arm):
    found = False
    for i in range(6):
        found = found or slides(arm, i)
    return found


def brought(R, p, a):
    """D a of D = (R, p)."""
    b = rotate(R, a)
    return b[0] + p[0], b[1] + p[1], b[2] + p[2]
