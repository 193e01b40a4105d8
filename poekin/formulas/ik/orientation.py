"""Three revolute joints that make a rotation (a spherical wrist).

    R = e^{[h_1] x_1} e^{[h_2] x_2} e^{[h_3] x_3},   h_1 . e^{[h_2] x_2} h_3 = h_1 . R h_3

The latter gives two x_2 (`circle_line`), each with one x_1 and x_3. Accuracy: that of `circle_line`
(tests/formulas/ik/test_orientation.py). Source: Murray, Li and Sastry 1994, Section 3.3.
"""

from ...algebra import dot, rotate
from . import circle_line
from .rotation_onto import rotated, rotation_onto
from .turned_component import turned_component


def roots(h, across, R):
    """Two rows (c, s of x_1, of x_2, of x_3, margin) of axes h = (h_1, h_2, h_3) and a vector across
    h_3.

    Where e^{[h_2] x_2} h_3 lies along h_1, only the sum or difference of x_1 and x_3 is told: the
    margin is 0 then, and x_1 any angle that fits x_3. Below 0 no x_2 serves: the one returned leaves
    the least difference of the cosines, and x_1 and x_3 fit it.
    """
    A, B, C = turned_component(h[0], h[1], h[2])
    Rh = rotate(R, h[2])
    c, s, cosine, sine, margin = circle_line.roots(A, B, dot(h[0], Rh) - C)
    first = _with_outer(h, across, R, Rh, (c, s, margin))
    second = _with_outer(h, across, R, Rh, (cosine, sine, margin))
    return first, second


def _with_outer(h, across, R, Rh, root):
    """The row of a root, x_1 turning e^{[h_2] x_2} h_3 to R h_3, and x_3 what is left."""
    c2, s2, margin = root
    c1, s1, _ = rotation_onto(h[0], rotated(h[1], c2, s2, h[2]), Rh)
    rest = rotated(h[1], c2, -s2, rotated(h[0], c1, -s1, rotate(R, across)))
    c3, s3, _ = rotation_onto(h[2], across, rest)
    return c1, s1, c2, s2, c3, s3, margin
