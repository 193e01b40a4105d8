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
COEFFICIENTS = 24
"""Of a polynomial, then those that tell its noise, then zeros: a number that four divide."""
ARCS = 8
LENGTH = 2 * DEGREE + 1
ROOM = 32
"""Most roots that are written."""

_DEPTH = 40  # halvings of an arc: 1e-12 rad
SCRATCH = (_DEPTH + 2) * (LENGTH + 2)
_SHORT = 0.5 ** (_DEPTH - 1)
_START = 0.0923  # rad: no angle that an arm has of itself
_OPPOSITE = (3, 4)  # arcs
_NEAR = 1e-6  # rad: double roots that are one
STEPS = 60
"""Most steps of Newton's rule."""
FIELDS = 6
_DONE = 1e-17
_HALF_ARC = pi / ARCS


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


_PLACES = LENGTH * (DEGREE + 1)
_TANGENT = elementary.sin(0.5 * _HALF_ARC) / elementary.cos(0.5 * _HALF_ARC)


def _polar_forms():
    forms = [_polar_form(j, k) for j in range(LENGTH) for k in range(DEGREE + 1)]
    return [x for x, _ in forms] + [y for _, y in forms]


def _centre(arc):
    return _START + (2 * arc + 1) * _HALF_ARC


def _points(angles):
    """Cosines of angles, then their sines."""
    return [f(x) for f in (elementary.cos, elementary.sin) for x in angles]


def _waves():
    """Weights of the value at each sample in each coefficient."""
    share = 2.0 / SAMPLES
    table = []
    for j in range(SAMPLES):
        row = [0.5 * share]
        for k in range(1, DEGREE + 3):
            angle = 2.0 * pi * (j * k % SAMPLES) / SAMPLES
            row += [share * elementary.cos(angle), share * elementary.sin(angle)]
        table += row + [0.0] * (COEFFICIENTS - len(row))
    return table


POLAR_FORMS = tuple(_polar_forms())
"""The polar forms of e^{i k x}, real parts, then imaginary ones."""
CENTRES = tuple(_points([_centre(arc) for arc in range(ARCS)]))
HALVES = tuple(_points([pi * k / SAMPLES for k in range(SAMPLES)]))
"""Cosines, then sines, of half of each equally spaced angle."""
WAVES = tuple(_waves())


def fourier(waves, values, f, width):
    """Writes a_0, a_1, b_1, ..., a_8, b_8 of a polynomial with given values at the samples, then the
    next coefficients, which it cannot hold: its noise. `waves` is `WAVES` in rows of `width`.
    """
    for k in range(width):
        total = values[0] * waves[k]
        for j in range(1, SAMPLES):
            total += values[j] * waves[width * j + k]
        f[k] = total


def size_and_noise(f):
    """The largest coefficient, and the largest of those that tell the noise."""
    size = 0.0
    for k in range(LENGTH):
        size = max(size, abs(f[k]))
    noise = 0.0
    for k in range(LENGTH, COEFFICIENTS):
        noise = max(noise, abs(f[k]))
    return size, noise


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


def steepest(f):
    """The largest slope that the coefficients allow."""
    total = 0.0
    for k in range(1, DEGREE + 1):
        a = f[2 * k - 1]
        b = f[2 * k]
        total += k * elementary.sqrt(a * a + b * b)
    return total


def on_arcs(forms, centres, f, b, width):
    """Writes the coefficients on each arc, the arcs in rows of `width`: `forms` is `POLAR_FORMS`,
    and `centres` is `CENTRES`.
    """
    for arc in range(width):
        c = centres[arc]
        s = centres[width + arc]
        x = c
        y = s
        for j in range(LENGTH):
            b[width * j + arc] = f[0] * forms[(DEGREE + 1) * j]
        for k in range(1, DEGREE + 1):
            even = f[2 * k - 1]
            odd = f[2 * k]
            p = even * x + odd * y
            q = odd * x - even * y
            turned = x * c - y * s
            y = x * s + y * c
            x = turned
            for j in range(DEGREE + 1):
                at = (DEGREE + 1) * j + k
                along = p * forms[at]
                across = q * forms[_PLACES + at]
                # the second end for the first one: the conjugate
                first = width * j + arc
                last = width * (2 * DEGREE - j) + arc
                b[first] = b[first] + along + across
                if j < DEGREE:
                    b[last] = b[last] + along - across


def brackets(coefficients, noise, segments, found, is_whole):
    """Writes where each root is, and returns the number of roots: the segment of an arc, as tangents
    of half the angle from the arc's centre, a first guess and the sign at the segment's beginning.

    Only those on the whole circle are between 2.45 and 4.01 rad.
    `coefficients` are those on the arcs, in rows of `ARCS`, and `found` is rows of `ROOM`, one for
    each of `FIELDS`; `segments` has room for SCRATCH numbers.
    """
    count = 0
    for arc in range(ARCS):
        for j in range(LENGTH):
            segments[j] = coefficients[ARCS * j + arc]
        segments[LENGTH] = 0.0
        segments[LENGTH + 1] = 1.0
        if is_whole or arc not in _OPPOSITE:
            count = _on_arc(arc, noise, segments, found, count)
    if count > 1 and _apart(found, 0, count - 1) <= _NEAR:
        count -= 1  # the same root at the circle's beginning and end
    return count


def _on_arc(arc, noise, stack, found, count):
    """Adds the roots of an arc whose coefficients are the first on the stack."""
    left = 1
    while left > 0 and count < ROOM:
        left -= 1
        at = left * (LENGTH + 2)
        changes, small = _signs(stack, at, noise)
        low = stack[at + LENGTH]
        high = stack[at + LENGTH + 1]
        if small == LENGTH or (high - low <= _SHORT and changes + small > 0):
            middle = _tangent(0.5 * (low + high))
            _put(found, count, arc, (middle, middle, middle, 0.0))
            near = max(_NEAR, 8.0 * _TANGENT * (high - low))
            if count == 0 or _apart(found, count - 1, count) > near:
                count += 1
        elif small == 0 and changes == 1:
            guess = low + (high - low) * _crossing(stack, at)
            sign = 1.0
            if stack[at] < 0.0:
                sign = -1.0
            _put(found, count, arc, (_tangent(low), _tangent(high), _tangent(guess), sign))
            count += 1
        elif changes + small > 0:
            _halve(stack, at)
            left += 2
    return count


def _tangent(t):
    return (2.0 * t - 1.0) * _TANGENT


def _put(found, k, arc, bracket):
    half = 0.5 * _centre(arc)
    found[k] = elementary.cos(half)
    found[ROOM + k] = elementary.sin(half)
    for i in range(4):
        found[ROOM * (2 + i) + k] = bracket[i]


def _apart(found, i, k):
    """Angle between two roots, twice the sine of half of it."""
    a, b = half_of_root(found, i, ROOM)
    c, d = half_of_root(found, k, ROOM)
    return 2.0 * abs(a * d - b * c)


def half_of_root(found, k, width):
    """(cos, sin) of half the k-th root in rows of `width`, as long as they are near the centre."""
    c = found[k]
    s = found[width + k]
    t = found[4 * width + k]
    return c - s * t, s + c * t


def newton(f, found, k, width):
    """One step of Newton's rule on the k-th root in rows of `width`, halving where it leads out of
    the segment. Returns the step and the slope before it, by angles.
    """
    C, S = half_of_root(found, k, width)
    size = 1.0 / (C * C + S * S)
    c = (C * C - S * S) * size
    s = 2.0 * C * S * size
    value, slope = value_and_slope(f, c, s)
    t = found[4 * width + k]
    side = value * found[5 * width + k]
    low = elementary.where_less(0.0, side, t, found[2 * width + k])
    high = elementary.where_less(0.0, side, found[3 * width + k], t)
    found[2 * width + k] = low
    found[3 * width + k] = high
    rate = 2.0 * size * slope
    end = t - value / elementary.where_less(0.0, abs(rate), rate, 1.0)
    middle = 0.5 * (low + high)
    end = elementary.where_less(end, low, middle, end)
    end = elementary.where_less(high, end, middle, end)
    found[4 * width + k] = end
    return 2.0 * size * (end - t), slope


def is_found(step, slope, steepest):
    """Whether a step is the last: of half its square, f'' over the slope is left."""
    return abs(step) <= 1e-15 or DEGREE * steepest * step * step <= _DONE * abs(slope)


def _crossing(b, at):
    """Place at which coefficients with one change of sign pass 0, as a share of their segment."""
    j = 1
    while b[at + j] * b[at] > 0.0:
        j += 1
    last = b[at + j - 1]
    return (j - 1 + last / (last - b[at + j])) / (LENGTH - 1)


def _signs(b, at, noise):
    """Changes of sign among coefficients, and how many are within the noise."""
    changes = 0
    small = 0
    last = 0.0
    for j in range(LENGTH):
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
    above = at + LENGTH + 2
    for j in range(LENGTH):
        b[above + j] = b[at]
        for i in range(LENGTH - 1 - j):
            b[at + i] = 0.5 * (b[at + i] + b[at + i + 1])
    low = b[at + LENGTH]
    high = b[at + LENGTH + 1]
    middle = 0.5 * (low + high)
    b[above + LENGTH] = low
    b[above + LENGTH + 1] = middle
    b[at + LENGTH] = middle
    b[at + LENGTH + 1] = high
