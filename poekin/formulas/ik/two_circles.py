"""Two angles of two equations that are linear in their sines and cosines:

    a_i c + a'_i s + b_i x + b'_i y = d_i,   i = 1, 2,   (c, s) and (x, y) on the unit circle

Subproblems 5 and 6 of Elias and Wen are this: what a third joint between two others leaves as it is,
the height along its axis and the distance from a point of it, is linear in both circles' points.
Combined to orthonormal rows, turned to the singular vectors of both halves (the cosine-sine
decomposition of two by two and two), the equations are

    alpha_1 c + beta_1 x = d_1,   alpha_2 s + beta_2 y = d_2,   alpha_i^2 + beta_i^2 = 1

of turned points. What they leave open, (c, x) = d_1 (alpha_1, beta_1) + t (-beta_1, alpha_1) and (s,
y) likewise with r, is on a circle, t^2 + r^2 = 2 - d_1^2 - d_2^2, and c^2 + s^2 = x^2 + y^2 is a
conic of (t, r) (`circle_conic`). Nothing is divided by, so nothing is lost where an angle, or each,
stands in one equation alone. Newton's rule on the equations themselves sharpens both angles.
Accuracy: both angles are right to 4 times what a change of the equations, divided by the length of
their coefficients, by u (2 + |d_1| + |d_2|), u = 2^-53, makes of them: that over the smallest singular
value of the slopes, or its square root at a double root (1.6 times measured;
tests/formulas/ik/test_two_circles.py). Source: Elias and Wen 2025 for the equations; Golub and Van
Loan 2013, Section 2.5.4, for the decomposition.
"""

from .. import elementary
from . import circle_conic, circle_line
from .rounding import is_rounding, least

_SHARPENED = 3  # steps at most
_NEAR = -1e-3  # margin of a root that may be double
_DEPENDENT = 0.125  # 1 / 8: rows apart by 4 u are one
_DOUBLE = 0.04  # residuals of 12 u of unit rows are rounding
_NOTHING = 0.015625  # 1 / 64: a conic of 32 u over the rows' distance is all rounding


def roots(first, second):
    """Four rows (c, s, x, y, margin) of two equations (a, a', b, b', d).

    Of a margin of 0 the row is a double root to rounding, or one of a continuum of roots (of
    dependent equations, or of one circle's point that no equation holds); below 0 there is no root,
    and the row is near to the least residual.
    """
    first = _unit(first)
    second = _unit(second)
    a, b, _, _, _ = first
    c, d, _, _, _ = second
    if a * a + b * b + c * c + d * d <= 1.0:
        p, q, r, t = _roots(first, second)
    else:
        p, q, r, t = _roots(_exchanged(first), _exchanged(second))
        p = _exchanged(p)
        q = _exchanged(q)
        r = _exchanged(r)
        t = _exchanged(t)
    return (
        _sharpened(first, second, p),
        _sharpened(first, second, q),
        _sharpened(first, second, r),
        _sharpened(first, second, t),
    )


def _length(row):
    a, b, c, d, _ = row
    return elementary.sqrt(a * a + b * b + c * c + d * d)


def _unit(row):
    """An equation divided by the length of its coefficients."""
    size = _length(row)
    if size > 0.0:
        return _times(1.0 / size, row)
    return row


def _times(k, row):
    return (
        k * row[0],
        k * row[1],
        k * row[2],
        k * row[3],
        k * row[4],
    )


def _combined(k, first, m, second):
    return (
        k * first[0] + m * second[0],
        k * first[1] + m * second[1],
        k * first[2] + m * second[2],
        k * first[3] + m * second[3],
        k * first[4] + m * second[4],
    )


def _exchanged(row):
    a, b, c, d, e = row
    return c, d, a, b, e


def _roots(first, second):
    """Roots of unit rows of which the first circle's halves are the smaller."""
    total = _combined(1.0, first, 1.0, second)
    change = _combined(1.0, first, -1.0, second)
    size = _length(total)
    rest = _length(change)
    if is_rounding(_DEPENDENT * rest, size):
        return _of_one(_times(0.5, total), change[4])
    if is_rounding(_DEPENDENT * size, rest):
        return _of_one(_times(0.5, change), total[4])
    if _length(first) == 0.0:
        return _of_one(second, first[4])
    if _length(second) == 0.0:
        return _of_one(first, second[4])
    total = _times(1.0 / size, total)
    along = _product(total, change)
    change = _combined(1.0, change, -along, total)
    apart = min(size, rest)
    return _canonical(total, _unit(change), apart)


def _product(first, second):
    """Sum of the products of two equations' coefficients."""
    a, b, c, d, _ = first
    e, f, g, h, _ = second
    return a * e + b * f + c * g + d * h


def _of_one(row, left):
    """Two points of the continuum of roots of one equation, twice; `left` is the second's d, which has
    no coefficients.
    """
    a, b, c, d, _ = row
    if a * a + b * b <= c * c + d * d:
        first, second = _of_longer(row, left)
        return first, second, first, second
    first, second = _of_longer(_exchanged(row), left)
    first = _exchanged(first)
    second = _exchanged(second)
    return first, second, first, second


def _of_longer(row, left):
    """Both (x, y) of one (c, s), of which the coefficients are the shorter: across them, or along them
    where d asks for it.
    """
    a, a2, b, b2, d = row
    size = elementary.sqrt(a * a + a2 * a2)
    rest = elementary.sqrt(b * b + b2 * b2)
    none = 0.0 * size
    c = 1.0
    s = none
    if size > 0.0:
        v = a / size
        w = a2 / size
        c = -w
        s = v
        if d > rest:
            c = v
            s = w
            d = d - size
        elif d < -rest:
            c = -v
            s = -w
            d = d + size
    x, y, u, v, margin = circle_line.roots(b, b2, d)
    if margin > 0.0:
        margin = 0.0 * margin
    if not is_rounding(_DEPENDENT * left, 1.0):
        margin = -1.0 + 0.0 * left
    return (
        (c, s, x, y, margin),
        (c, s, u, v, margin),
    )


def _canonical(first, second, apart):
    """Roots of orthonormal rows, made of unit rows that are so far apart or opposite."""
    c, s = _singular_turn(first, second)
    large = _combined(c, first, s, second)
    small = _combined(-s, first, c, second)
    a, a2, b, b2, d = large
    f, f2, g, g2, e = small
    alpha = elementary.sqrt(a * a + a2 * a2)
    none = 0.0 * alpha
    v = (1.0, none)
    if alpha > 0.0:
        v = (a / alpha, a2 / alpha)
    delta = elementary.sqrt(g * g + g2 * g2)
    w = (g2 / delta, -g / delta)
    beta = b * w[0] + b2 * w[1]
    gamma = f2 * v[0] - f * v[1]
    pair = (alpha, beta, d)
    other = (gamma, delta, e)
    square = 2.0 - d * d - e * e
    radius = elementary.sqrt(max(square, 0.0 * square))
    conic = _conic(pair, other, square, radius, apart)
    found = circle_conic.points(conic, 0.015625)
    there = square
    here = square
    if square > 0.0:
        there = square * found[4]
        here = square * found[9]
    frame = (pair, other, v, w, radius)
    return (
        _back(frame, found[0], found[1], there),
        _back(frame, found[2], found[3], there),
        _back(frame, found[5], found[6], here),
        _back(frame, found[7], found[8], here),
    )


def _singular_turn(first, second):
    """(c, s) of the turn of the rows after which their parts (a, a') are across each other, the first
    the longer.
    """
    a, b, _, _, _ = first
    c, d, _, _, _ = second
    e = 0.5 * (a + d)
    f = 0.5 * (a - d)
    g = 0.5 * (c + b)
    h = 0.5 * (c - b)
    q = elementary.sqrt(e * e + h * h)
    r = elementary.sqrt(f * f + g * g)
    qr = q * r
    if not qr > 0.0:
        return 1.0 + qr, qr
    x = (e * f - h * g) / qr
    y = (e * g + h * f) / qr
    if x >= 0.0:
        c = elementary.sqrt(0.5 + 0.5 * x)
        return c, 0.5 * y / c
    s = elementary.sqrt(0.5 - 0.5 * x)
    return 0.5 * y / s, s


def _conic(pair, other, square, radius, apart):
    """c^2 + s^2 = x^2 + y^2 on the circle (t, r) / radius, its squares' sum taken out."""
    alpha, beta, d = pair
    gamma, delta, e = other
    turned = (gamma - alpha) * (gamma + alpha)
    dd = d * d
    ee = e * e
    one = (beta - alpha) * (beta + alpha)
    two = (delta - gamma) * (delta + gamma)
    rest = 0.5 * (one + two) * square - one * dd - two * ee
    x = -2.0 * alpha * beta * d * radius
    y = -2.0 * gamma * delta * e * radius
    zero = 0.0 * rest
    size = abs(turned) + abs(x) + abs(y) + abs(rest)
    if is_rounding(_NOTHING * apart * size, 1.0):
        return zero, zero, zero, zero, zero, zero
    return turned * square, zero, -turned * square, x, y, rest


def _back(frame, c, s, margin):
    """The root of a direction of the third circle."""
    pair, other, v, w, radius = frame
    t = radius * c
    r = radius * s
    alpha, beta, d = pair
    gamma, delta, e = other
    c, s = _on_circle(alpha * d - beta * t, gamma * e - delta * r, v)
    x, y = _on_circle(beta * d + alpha * t, delta * e + gamma * r, w)
    return c, s, x, y, margin


def _on_circle(x, y, v):
    """The unit vector along x v + y v', v' the unit vector v turned a quarter."""
    length = elementary.sqrt(x * x + y * y)
    if length > 0.0:
        return (x * v[0] - y * v[1]) / length, (x * v[1] + y * v[0]) / length
    return v[0] + length, v[1] + length


def _residuals(first, second, c, s, x, y):
    return (
        _residual(first, c, s, x, y),
        _residual(second, c, s, x, y),
    )


def _residual(row, c, s, x, y):
    a, a2, b, b2, d = row
    return a * c + a2 * s + b * x + b2 * y - d


def _sharpened(first, second, root):
    """A root by Newton's rule in both angles, as long as the residual becomes smaller; its margin is
    0 where it is just below and the residual is rounding, and below 0 where it is not.
    """
    c, s, x, y, margin = root
    if not margin > _NEAR:
        return root
    e, f = _residuals(first, second, c, s, x, y)
    size = abs(e) + abs(f)
    for _ in range(_SHARPENED):
        if is_rounding(0.25 * size, 1.0):
            break
        e_c, e_x = _slopes(first, c, s, x, y)
        f_c, f_x = _slopes(second, c, s, x, y)
        if margin > 0.0:
            t, z = _newton(e, f, e_c, f_c, e_x, f_x)
        else:
            t, z = _steepest(e, f, e_c, f_c, e_x, f_x)
        p, q = _turn(c, s, t)
        u, v = _turn(x, y, z)
        e, f = _residuals(first, second, p, q, u, v)
        smaller = abs(e) + abs(f)
        if not smaller < size:
            break
        size = smaller
        c = p
        s = q
        x = u
        y = v
    if margin <= 0.0:
        rounding = is_rounding(_DOUBLE * size, 1.0)
        margin = 0.0 * size if rounding else least(margin, -size)
    return c, s, x, y, margin


def _slopes(row, c, s, x, y):
    """Derivatives of an equation's left side by both angles."""
    a, a2, b, b2, _ = row
    return a2 * c - a * s, b2 * x - b * y


def _newton(e, f, e_c, f_c, e_x, f_x):
    """Both turns of Newton's rule, none where the slopes are dependent."""
    det = e_c * f_x - e_x * f_c
    if det == 0.0:
        return det, det
    return (
        (e_x * f - e * f_x) / det,
        (e * f_c - e_c * f) / det,
    )


def _steepest(e, f, e_c, f_c, e_x, f_x):
    """Turns of steepest descent to the least residual: Newton's where only one turn counts, as at a
    double root.
    """
    t = e * e_c + f * f_c
    z = e * e_x + f * f_x
    p = e_c * t + e_x * z
    q = f_c * t + f_x * z
    below = p * p + q * q
    if below == 0.0:
        return below, below
    k = -(t * t + z * z) / below
    return k * t, k * z


def _turn(c, s, step):
    """(c, s) turned by 2 atan(step / 2)."""
    t = 0.5 * step
    one = 1.0 + t * t
    cosine = (1.0 - t * t) / one
    sine = step / one
    return (
        c * cosine - s * sine,
        s * cosine + c * sine,
    )
