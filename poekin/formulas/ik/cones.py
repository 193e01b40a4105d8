"""Two rotations that take two vectors to the same one: subproblem 2 of Paden and Kahan.

    e^{[k] theta} a = e^{[m] phi} b,   |a| = |b|

The common vector z lies on both cones, k . z = k . a and m . z = m . b, and has the length of a. In
the plane of the axes, where k + m and k - m are across each other, and out of it along k x m:

    z = (k . a + m . b) (k + m) / |k + m|^2 + (k . a - m . b) (k - m) / |k - m|^2 +- gamma k x m

Accuracy: that of gamma, u (1 + |a|^2 / (2 gamma^2 |k x m|^2)), u = 2^-53, over the sine of the axes'
angle (tests/formulas/ik/test_cones.py). Source: Murray, Li and Sastry 1994, Section 3.2.
"""

from ...algebra import add, cross, dot, scale, subtract
from .. import elementary
from .rotation_onto import rotation_onto
from .rounding import is_rounding

_DOUBLE = 0.0078125  # 1 / 128: from a margin of -16 u over the squared sine on the circles touch


def roots(k, a, m, b):
    """Both answers (c, s of theta, c, s of phi), one after the other, and their margin: the share of
    |z|^2 that lies out of the axes' plane.

    Of a margin of 0 both are the same to rounding, or, of parallel axes and of vectors of length 0,
    one of a continuum. Below 0 the cones' circles pass each other, and each vector is turned nearest
    to the common line of the planes of both circles; of parallel axes then, a is turned nearest to
    b.
    """
    plus = add(k, m)
    minus = subtract(k, m)
    pp = dot(plus, plus)
    mm = dot(minus, minus)
    size = dot(a, a)
    ka = dot(k, a)
    mb = dot(m, b)
    if pp * mm == 0.0 or size == 0.0:
        return _parallel(k, a, m, b)
    inside = add(scale((ka + mb) / pp, plus), scale((ka - mb) / mm, minus))
    rest = size - dot(inside, inside)
    margin = rest / size
    out = cross(minus, plus)
    gamma = 0.0 * size
    if margin > 0.0:
        gamma = elementary.sqrt(rest / dot(out, out))
    elif is_rounding(_DOUBLE * margin * pp * mm, 1.0):
        margin = gamma
    out = scale(gamma, out)
    first = rotation_pair(k, a, m, b, add(inside, out))
    second = rotation_pair(k, a, m, b, subtract(inside, out))
    return first + second + (margin,)


def _parallel(k, a, m, b):
    """The answer that leaves b where it is."""
    pair = rotation_pair(k, a, m, b, b)
    apart = dot(k, a) - dot(k, b)
    margin = 0.0 * apart
    if not is_rounding(_DOUBLE * apart, elementary.sqrt(dot(a, a))):
        margin = margin - 1.0
    return pair + pair + (margin,)


def rotation_pair(k, a, m, b, z):
    """(c, s) of the rotations that take a to z about k, and b to z about m."""
    c, s, _ = rotation_onto(k, a, z)
    cosine, sine, _ = rotation_onto(m, b, z)
    return c, s, cosine, sine
