"""Rotation about an axis that takes one vector to another, as (c, s): subproblem 1 of Paden and Kahan.

    (c, s) ~ ((k x a) . (k x b), k . (a x b))

of the parts of a and b across the unit axis k; of vectors that no rotation takes to each other it is
the rotation of least |e^{[k] theta} a - b|. Accuracy: the angle is right to 4 u |a| |b| over the product
of these parts (tests/formulas/ik/test_rotation_onto.py). Source: Murray, Li and Sastry 1994,
Section 3.2.
"""

from ...algebra import cross, dot
from .. import elementary


def rotation_onto(k, a, b):
    """(c, s) of the rotation about k that takes a to b, and the length |k x a| |k x b| which tells
    it: of a length of 0 any rotation serves, and (1, 0) is returned.
    """
    ka = cross(k, a)
    c = dot(ka, cross(k, b))
    s = dot(ka, b)
    length = elementary.sqrt(c * c + s * s)
    if length > 0.0:
        return c / length, s / length, length
    return 1.0 + length, length, length


def rotated(k, c, s, a):
    """e^{[k] theta} a, of a unit axis k and (c, s) of theta (Rodrigues)."""
    ka = cross(k, a)
    along = (1.0 - c) * dot(k, a)
    return (
        c * a[0] + s * ka[0] + along * k[0],
        c * a[1] + s * ka[1] + along * k[1],
        c * a[2] + s * ka[2] + along * k[2],
    )
