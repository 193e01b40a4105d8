"""All real roots of a trigonometric polynomial of degree 8, counted.

    f(x) = a_0 + sum_k (a_k cos(k x) + b_k sin(k x)),   k = 1 ... 8

On an arc, f is a polynomial of degree 16 along the chord, and its Bernstein coefficients are within
the range of f's values nearby: without a change of sign there is no root, with a single one exactly
one (Descartes). An arc with more is halved (de Casteljau), down to where all coefficients are within
`noise`: there f is 0 to rounding, a double root.
Accuracy: rounding of f over its slope (tests/formulas/ik/elimination/test_circle_roots.py). Source:
Farouki and Rajan 1987; Ramshaw 1989 (the coefficients are the polar form at the ends of the arc).
"""

from math import comb, pi

from ... import elementary

DEGREE = 8
SAMPLES = 20
ROOM = 32
"""Most roots that are written."""

_ARCS = 8
_LENGTH = 2 * DEGREE + 1
_DEPTH = 40  # halvings of an arc: 1e-12 rad
SCRATCH = (_DEPTH + 2) * (_LENGTH + 2)
_SHORT = 0.5 ** (_DEPTH - 1)
_START = 0.1234  # rad: no angle that an arm has of itself
_NEAR = 1e-6  # rad: double roots that are one
_STEPS = 60
_HALF_ARC = pi / _ARCS


def _polar_form(j, k):
    """The polar form of e^{i k x} at the ends of an arc around 0, the second taken j times.

    e^{i k x} = z^m conj(z)^(16 - m), z = e^{i x / 2}, m = 8 + k.
    """
    n = 2 * DEGREE
    m = DEGREE + k
    x = 0.0
    y = 0.0
    for i in range(max(0, m - (n - j)), min(j, m) + 1):
        # i of the m factors z are at the second end, and j - i of the conjugates
        turns = i - (m - i) - (j - i) + (n - j - (m - i))
        share = comb(j, i) * comb(n - j, m - i) / comb(n, m)
        angle = 0.5 * turns * _HALF_ARC
        x += share * elementary.cos(angle)
        y += share * elementary.sin(angle)
    return x, y


_PLACES = _LENGTH * (DEGREE + 1)
_HALVES = 2 * _PLACES
_TANGENT = elementary.sin(0.5 * _HALF_ARC) / elementary.cos(0.5 * _HALF_ARC)


def _constants():
    forms = [_polar_form(j, k) for j in range(_LENGTH) for k in range(DEGREE + 1)]
    table = [x for x, _ in forms] + [y for _, y in forms]
    for k in range(SAMPLES):
        half = pi * k / SAMPLES
        table.append(elementary.cos(half))
        table.append(elementary.sin(half))
    return table


TABLE = tuple(_constants())
"""Numbers that the functions here take as `table`: the polar forms, real and imaginary parts, then
(cos, sin) of half of each equally spaced angle.
"""


def half_of_sample(table, k):
    """(cos, sin) of half the k-th of the equally spaced angles."""
    at = _HALVES + 2 * k
    return table[at], table[at + 1]


def fourier(table, values, f):
    """Writes a_0, a_1, b_1, ..., a_8, b_8 of a polynomial with given values at the samples, and
    returns its noise: the size of what it cannot hold, the next coefficients.
    """
    noise = 0.0
    for k in range(DEGREE + 3):
        a = 0.0
        b = 0.0
        for j in range(SAMPLES):
            at = 2 * j * k % (2 * SAMPLES)
            c, s = half_of_sample(table, at % SAMPLES)
            if at >= SAMPLES:
                c = -c
                s = -s
            a += c * values[j]
            b += s * values[j]
        a *= 2.0 / SAMPLES
        b *= 2.0 / SAMPLES
        if k == 0:
            f[0] = 0.5 * a
        elif k <= DEGREE:
            f[2 * k - 1] = a
            f[2 * k] = b
        else:
            noise = max(noise, abs(a), abs(b))
    return noise


def value_and_slope(f, c, s):
    """f and its derivative at an angle (c, s)."""
    value = f[0]
    slope = 0.0 * f[0]
    x = c
    y = s
    for k in range(1, DEGREE + 1):
        a = f[2 * k - 1]
        b = f[2 * k]
        value += a * x + b * y
        slope += k * (b * x - a * y)
        turned = x * c - y * s
        y = x * s + y * c
        x = turned
    return value, slope


def collect(table, f, noise, scratch, found):
    """Writes the roots, angle and slope each, the slope as a share of the largest that the
    coefficients allow, and returns their number.

    `scratch` has room for SCRATCH numbers, `found` for 2 ROOM.
    """
    steepest = 0.0
    for k in range(1, DEGREE + 1):
        a = f[2 * k - 1]
        b = f[2 * k]
        steepest += k * elementary.sqrt(a * a + b * b)
    count = 0
    for arc in range(_ARCS):
        centre = _START + (2 * arc + 1) * _HALF_ARC
        _bernstein(table, f, centre, scratch)
        count = _on_arc(f, centre, noise, scratch, found, count)
    if count > 1 and found[2 * count - 2] - found[0] > 2.0 * pi - _NEAR:
        count -= 1  # the same root at the circle's beginning and end
    for i in range(count):
        x = found[2 * i]
        _, slope = value_and_slope(f, elementary.cos(x), elementary.sin(x))
        found[2 * i + 1] = abs(slope) / steepest
    return count


def _bernstein(table, f, centre, b):
    """The coefficients on the arc around an angle, and its ends 0 and 1 along the chord."""
    c = elementary.cos(centre)
    s = elementary.sin(centre)
    for j in range(_LENGTH):
        b[j] = f[0] * table[(DEGREE + 1) * j]
    x = c
    y = s
    for k in range(1, DEGREE + 1):
        even = f[2 * k - 1]
        odd = f[2 * k]
        p = even * x + odd * y
        q = odd * x - even * y
        for j in range(_LENGTH):
            at = (DEGREE + 1) * j + k
            b[j] += p * table[at] + q * table[_PLACES + at]
        turned = x * c - y * s
        y = x * s + y * c
        x = turned
    b[_LENGTH] = 0.0
    b[_LENGTH + 1] = 1.0


def _angle(centre, t):
    return centre + 2.0 * elementary.atan2((2.0 * t - 1.0) * _TANGENT, 1.0)


def _on_arc(f, centre, noise, stack, found, count):
    """Adds the roots of an arc whose coefficients are the first on the stack."""
    left = 1
    while left > 0 and count < ROOM:
        left -= 1
        at = left * (_LENGTH + 2)
        changes, small = _signs(stack, at, noise)
        low = stack[at + _LENGTH]
        high = stack[at + _LENGTH + 1]
        if small == _LENGTH or (high - low <= _SHORT and changes + small > 0):
            x = _angle(centre, 0.5 * (low + high))
            first = _angle(centre, low)
            last = _angle(centre, high)
            width = 2.0 * (last - first)
            if count == 0 or x - found[2 * count - 2] > max(_NEAR, width):
                found[2 * count] = x
                count += 1
        elif small == 0 and changes == 1:
            first = _angle(centre, low)
            last = _angle(centre, high)
            found[2 * count] = _bracketed(f, first, last)
            count += 1
        elif changes + small > 0:
            _halve(stack, at)
            left += 2
    return count


def _signs(b, at, noise):
    """Changes of sign among coefficients, and how many are within the noise."""
    changes = 0
    small = 0
    last = 0.0
    for j in range(_LENGTH):
        value = b[at + j]
        if abs(value) <= noise:
            small += 1
        else:
            if value * last < 0.0:
                changes += 1
            last = value
    return changes, small


def _halve(b, at):
    """The second half in the place of a segment, and the first half above it (de Casteljau)."""
    above = at + _LENGTH + 2
    for j in range(_LENGTH):
        b[above + j] = b[at]
        for i in range(_LENGTH - 1 - j):
            b[at + i] = 0.5 * (b[at + i] + b[at + i + 1])
    low = b[at + _LENGTH]
    high = b[at + _LENGTH + 1]
    middle = 0.5 * (low + high)
    b[above + _LENGTH] = low
    b[above + _LENGTH + 1] = middle
    b[at + _LENGTH] = middle
    b[at + _LENGTH + 1] = high


def _bracketed(f, low, high):
    """The root between two angles where f has opposite signs: Newton's rule, halving where it leads
    out.
    """
    first, _ = value_and_slope(f, elementary.cos(low), elementary.sin(low))
    x = 0.5 * (low + high)
    for _ in range(_STEPS):
        value, slope = value_and_slope(f, elementary.cos(x), elementary.sin(x))
        if value == 0.0:
            return x
        if (value < 0.0) == (first < 0.0):
            low = x
        else:
            high = x
        last = x
        x = 0.5 * (low + high)
        if slope != 0.0:
            newton = last - value / slope
            if low < newton < high:
                x = newton
        if abs(x - last) <= 1e-15:
            break
    return x
