"""Points of the unit circle on a line: the angles of a c + b s = d, c = cos(theta), s = sin(theta).

Subproblem 3 of Paden and Kahan (a point turned to a given distance of another) and the fourth of
Elias and Wen (turned into a plane) are this equation, as both distances are linear in (c, s).

    (c, s) = (d (a, b) +- w (-b, a)) / r^2,   r^2 = a^2 + b^2,   w^2 = (r - d) (r + d)

Accuracy: the angles are right to 4 u (1 + |d| / w), u = 2^-53, which is what rounding a, b and d
costs (tests/formulas/ik/test_circle_line.py). Source: Murray, Li and Sastry 1994, Section 3.2;
Elias and Wen 2025.
"""

from .. import elementary
from .rounding import is_rounding

_DOUBLE = 0.03125  # 1 / 32: from a margin of -16 u on the line touches


def roots(a, b, d):
    """(c, s) of both angles, one after the other, and their margin 1 - |d| / r, not below -1.

    Of a margin of 0 both are the point where the line touches, or any angle serves (a = b = d = 0);
    below 0 they are the circle's nearest point, which leaves the least of a c + b s - d. Where only
    a = b = 0, the margin is -1.
    """
    rr = a * a + b * b
    if rr == 0.0:
        one = 1.0 + rr
        none = rr
        if d == 0.0:
            return one, none, one, none, none
        return one, none, one, none, -one
    r = elementary.sqrt(rr)
    margin = (r - abs(d)) / r
    w = 0.0 * r
    if margin > 0.0:
        w = elementary.sqrt((r - d) * (r + d))
    else:
        if is_rounding(_DOUBLE * margin, 1.0):
            margin = w
        elif margin < -1.0:
            margin = -1.0 + w
        d = r if d > 0.0 else -r
    return (
        (a * d - b * w) / rr,
        (b * d + a * w) / rr,
        (a * d + b * w) / rr,
        (b * d - a * w) / rr,
        margin,
    )
