"""Points of the unit circle on a conic: the angles of

    A c^2 + B c s + C s^2 + D c + E s + F = 0,   c = cos(theta), s = sin(theta)

Some conic of the pencil Q + lambda diag(1, 1, -1), all of which meet the circle in the same four
points, is a pair of real lines; lambda is a root of det = 0, a cubic. Each line gives two points
(`circle_line`), which Laguerre's rule on the equation itself then sharpens.
Accuracy: an angle is right to 4 times what a change of the equation by u (|A| + ... + |F|),
u = 2^-53, makes of it: that over the slope, its square root at a double root, up to its fourth root
where all four points meet (2.0 times measured; tests/formulas/ik/test_circle_conic.py). Source:
Richter-Gebert 2011, Perspectives on Projective Geometry, Section 11.3.
"""

from ...algebra import dot, scale
from .. import elementary
from . import circle_line
from .rounding import is_rounding

_DOUBLE = 0.25  # 1 / 4: a value of 2 u is rounding, of coefficients with the sum 1 / 2
_NEAR = 1e-3  # margin of a line that may touch
_CLUSTER = 0.03  # between the cubic's roots, of coefficients up to 1 / 4
_SHARPENED = 12  # steps at most; a cluster of four roots takes some
_CUBE_ROOT = 60  # steps at most


def roots(A, B, C, D, E, F):
    """(c, s, c, s, margin) of the points on one line, then of those on the other.

    Of a margin of 0 both are a double root to rounding, or any angle serves; below 0 both are the
    nearest to one, where the equation's left side is least in size or nearly so.
    """
    half = (
        A,
        0.5 * B,
        C,
        0.5 * D,
        0.5 * E,
        F,
    )
    return points(half, 16.0)


def points(Q, share):
    """`roots` of a conic A, B/2, C, D/2, E/2, F, sharpened while the left side is above u / share of
    the largest coefficient, about.
    """
    a, b, c, d, e, f = Q
    once = abs(a) + abs(c) + abs(f)
    twice = abs(b) + abs(d) + abs(e)
    size = once + 2.0 * twice
    if size > 0.0:
        k = 0.5 / size
        Q = (
            k * a,
            k * b,
            k * c,
            k * d,
            k * e,
            k * f,
        )
    g, h = _lines(_with_lines(Q))
    first = circle_line.roots(g[0], g[1], -g[2])
    second = circle_line.roots(h[0], h[1], -h[2])
    return _sharpened(Q, first, share) + _sharpened(Q, second, share)


def derivatives(Q, c, s):
    """The equation's left side at an angle, and its first and second derivative; Q holds A, B/2, C,
    D/2, E/2, F.
    """
    a, b, d, e, f, g = Q
    x = a * c + b * s
    y = b * c + d * s
    across = a * s * s - 2.0 * b * c * s + d * c * c
    value = c * (x + 2.0 * e) + s * (y + 2.0 * f) + g
    x = x + e
    y = y + f
    slope = 2.0 * (c * y - s * x)
    bend = 2.0 * (across - c * x - s * y)
    return value, slope, bend


def _adjugate(Q):
    """Diagonal, then 01, 02, 12 of the adjugate of the symmetric matrix of a conic."""
    a, b, c, d, e, f = Q
    return (
        c * f - e * e,
        a * f - d * d,
        a * c - b * b,
        d * e - b * f,
        b * e - c * d,
        b * d - a * e,
    )


def _in_pencil(Q, k):
    a, b, c, d, e, f = Q
    return a + k, b, c + k, d, e, f - k


def _with_lines(Q):
    """The conic of the pencil that is a pair of real lines.

    The roots of lambda^3 - p lambda^2 - q lambda - r = 0 at both ends are looked at: where all four
    points are real both give real lines, where none is one of them does. The root farthest from the
    others is the better known; of a pair of real lines the sum of the principal minors is not above
    0.
    """
    adj = _adjugate(Q)
    determinant = Q[3] * adj[4] + Q[4] * adj[5] + Q[5] * adj[2]
    far, end = _ends(Q, adj, determinant)
    if abs(far - end) < _CLUSTER:
        # of three roots that nearly meet the first pass knows the cube root of rounding alone; its
        # conic's own determinant, by elimination, leaves the square root
        Q = _in_pencil(Q, far)
        far, end = _ends(Q, _adjugate(Q), _determinant(Q))
    found = _in_pencil(Q, far)
    if _sum_of_minors(found) > 0.0:
        found = _in_pencil(Q, end)
    return found


def _ends(Q, adj, r):
    """The root of the cubic that is farthest from the others, and the end on their side."""
    p = Q[5] - Q[0] - Q[2]
    q = adj[0] + adj[1] - adj[2]
    shift = p / 3.0
    m = q / 3.0 + shift * shift
    half = 0.5 * r + shift * (0.5 * q + shift * shift)
    square = m * m * m - half * half
    size = abs(half)
    if square <= 0.0:
        k = _cube_root(size + elementary.sqrt(-square))
        if k > 0.0:
            k = k + m / k
    else:
        k = _largest_of_three(m, size)
    between = 12.0 * m - 3.0 * k * k
    apart = elementary.sqrt(max(between, 0.0 * m))
    end = -0.5 * (k + apart)
    if half < 0.0:
        return shift - k, shift - end
    return shift + k, shift + end


def _determinant(Q):
    """By elimination with the largest pivot: exact but for rounding of the matrix."""
    a, b, c, d, e, f = Q
    x, y, z = _largest_first((a, b, d), (b, c, e), (d, e, f))
    if x[0] == 0.0:
        return x[0]
    p, q = _eliminated(x, y)
    r, s = _eliminated(x, z)
    return x[0] * (p * s - q * r)


def _eliminated(pivot, row):
    """Second and third entry of a row less that multiple of the pivot's which leaves the first 0."""
    k = row[0] / pivot[0]
    return row[1] - k * pivot[1], row[2] - k * pivot[2]


def _largest_first(x, y, z):
    """Rows and columns of a matrix turned round until its largest entry is the first, but for that of
    the rows the longest is taken.
    """
    row = _longest(x, y, z)
    if row == y:
        x, y, z = y, z, x
    elif row == z:
        x, y, z = z, x, y
    first = abs(x[0])
    second = abs(x[1])
    third = abs(x[2])
    largest = max(first, second, third)
    if largest == second:
        return _from_second(x), _from_second(y), _from_second(z)
    if largest == third:
        return _from_third(x), _from_third(y), _from_third(z)
    return x, y, z


def _from_second(x):
    return x[1], x[2], x[0]


def _from_third(x):
    return x[2], x[0], x[1]


def _cube_root(x):
    """Cube root of 0 <= x <= 1, by Halley's rule downwards from the fourth root."""
    y = elementary.sqrt(elementary.sqrt(x))
    if y > 0.0:
        for _ in range(_CUBE_ROOT):
            cube = y * y * y
            above = cube + 2.0 * x
            below = 2.0 * cube + x
            z = y * above / below
            if not z < y:
                break
            y = z
    return y


def _largest_of_three(m, half):
    """The largest root of k^3 - 3 m k - 2 half, 0 <= half <= m^(3/2), by Newton's rule from a chord
    below it and then downwards.
    """
    root = elementary.sqrt(m)
    x = root * 1.7320508 + 0.2679492 * half / m
    k = _newton(m, half, x)
    for _ in range(_CUBE_ROOT):
        x = _newton(m, half, k)
        if not x < k:
            break
        k = x
    return k


def _newton(m, half, k):
    kk = k * k
    value = kk * k + half
    slope = kk - m
    return 2.0 * value / (3.0 * slope)


def _sum_of_minors(Q):
    adj = _adjugate(Q)
    return adj[0] + adj[1] + adj[2]


def _lines(Q):
    """The lines g and h of a conic Q = g h^T + h g^T: Q + [p]x has the rank 1, and p p^T is the
    adjugate with its sign changed.
    """
    adj = _adjugate(Q)
    x = -adj[0]
    y = -adj[1]
    z = -adj[2]
    if x >= y and x >= z:
        p = (x, -adj[3], -adj[4])
        pp = x
    elif y >= z:
        p = (-adj[3], y, -adj[5])
        pp = y
    else:
        p = (-adj[4], -adj[5], z)
        pp = z
    if pp > 0.0:
        p = scale(1.0 / elementary.sqrt(pp), p)
    else:
        p = scale(0.0 * pp, p)
    # the rows and the columns of Q + [p]x
    g = _longest_row(Q, p)
    h = _longest_row(Q, scale(-1.0, p))
    return g, h


def _longest_row(Q, p):
    """The longest row of Q + [p]x."""
    a, b, c, d, e, f = Q
    x, y, z = p
    return _longest(
        (a, b - z, d + y),
        (b + z, c, e - x),
        (d - y, e + x, f),
    )


def _longest(a, b, c):
    """The vector with the largest sum of squares."""
    aa = dot(a, a)
    bb = dot(b, b)
    cc = dot(c, c)
    if aa >= bb and aa >= cc:
        return a
    if bb >= cc:
        return b
    return c


def _sharpened(Q, found, share):
    """Both points of a line and the margin, by Laguerre's rule."""
    c, s, cosine, sine, margin = found
    if margin > 0.0:
        c, s, here = _laguerre(Q, c, s, share)
        cosine, sine, there = _laguerre(Q, cosine, sine, share)
        if margin < _NEAR:
            first = (c, s, here)
            second = (cosine, sine, there)
            return _accepted(first, second, margin, min(_DOUBLE, 0.5 * share))
    elif margin > -_NEAR:
        return _touching(Q, c, s, margin)
    return c, s, cosine, sine, margin


def _touching(Q, c, s, margin):
    """The point where a line nearly touches, parted where the equation says so."""
    value, slope, bend = derivatives(Q, c, s)
    bend = value + bend
    square = slope * slope - 2.0 * value * bend
    t = 0.0 * value
    middle = t
    if bend != 0.0:
        middle = -0.5 * slope / bend
        if square > 0.0:
            t = 0.5 * elementary.sqrt(square) / bend
    x, y = _turned(c, s, middle - t)
    u, v = _turned(c, s, middle + t)
    first = _laguerre(Q, x, y, 16.0)
    second = _laguerre(Q, u, v, 16.0)
    return _accepted(first, second, margin, _DOUBLE)


def _accepted(first, second, margin, share):
    """Points (c, s, value), out of two, that solve the equation to rounding, and the margin."""
    c, s, here = first
    x, y, there = second
    zero = 0.0 * margin
    also = is_rounding(share * there, 1.0)
    if is_rounding(share * here, 1.0):
        if also:
            return c, s, x, y, max(margin, zero)
        return c, s, c, s, zero
    if also:
        return x, y, x, y, zero
    return c, s, x, y, -abs(margin)


def _turned(c, s, t):
    """(c, s) turned by 2 atan(t)."""
    one = 1.0 + t * t
    cosine = (1.0 - t * t) / one
    sine = 2.0 * t / one
    return (
        c * cosine - s * sine,
        s * cosine + c * sine,
    )


def _laguerre(Q, c, s, share):
    """A root by Laguerre's rule in tan(theta / 2) from the point, as long as the left side becomes
    smaller and is above rounding, and the left side there.
    """
    value, slope, bend = derivatives(Q, c, s)
    for _ in range(_SHARPENED):
        if is_rounding(share * value, 1.0):
            break
        t = _laguerre_step(value, slope, bend)
        x, y = _turned(c, s, t)
        other, other_slope, other_bend = derivatives(Q, x, y)
        if not abs(other) < abs(value):
            break
        c = x
        s = y
        value = other
        slope = other_slope
        bend = other_bend
    return c, s, value


def _laguerre_step(value, slope, bend):
    """To the root of the quartic in t = tan(turn / 2) by its first three coefficients."""
    first = 2.0 * slope
    second = value + bend
    square = 9.0 * first * first - 48.0 * value * second
    if square >= 0.0:
        root = elementary.sqrt(square)
        below = first + root
        if first < 0.0:
            below = first - root
        if below == 0.0:
            return 0.0 * value
        return -4.0 * value / below
    # of two complex roots the point between
    return -4.0 * value * first / (first * first - square)
