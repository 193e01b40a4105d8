"""Points of the circle by roots of polynomials in z = e^{i theta}, in 120 digits, and what rounding
costs an angle: oracles of the subproblems, which know no line, no conic and no elimination of them.
"""

from __future__ import annotations

import mpmath

UNIT = 2.0**-53
DIGITS = 120


def on_circle(coefficients):
    """Angles of the zeros of sum of coefficients[k] z^k, |z| = 1, where coefficients[n - k] is the
    conjugate of coefficients[k].
    """
    kept = list(map(mpmath.mpc, coefficients))
    while kept and kept[-1] == 0:
        kept = kept[1:-1]  # so is the first
    n = len(kept) - 1
    if n < 1:
        return []
    companion = mpmath.matrix(n)
    for k in range(n):
        companion[k, n - 1] = -kept[k] / kept[n]
    for k in range(n - 1):
        companion[k + 1, k] = 1
    zeros = mpmath.eig(companion, left=False, right=False)
    near = mpmath.mpf(10) ** (-mpmath.mp.dps // 5)  # of a fourfold zero: a quarter of the digits
    return [mpmath.arg(z) for z in zeros if abs(abs(z) - 1) < near]


def laurent(cosine, sine, constant):
    """cosine c + sine s + constant as coefficients of 1 / z, 1 and z."""
    return [mpmath.mpc(cosine, sine) / 2, mpmath.mpc(constant), mpmath.mpc(cosine, -sine) / 2]


def product(a, b):
    """Coefficients of the product of two polynomials."""
    result = [mpmath.mpc(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            result[i + j] += x * y
    return result


def attainable(derivatives, size):
    """Change of a zero when the function changes by u size: its derivatives f', f'', ... there."""
    costs = [mpmath.inf]
    for k, derivative in enumerate(derivatives, start=1):
        if derivative != 0:
            costs.append(
                (mpmath.factorial(k) * UNIT * size / abs(derivative)) ** (mpmath.mpf(1) / k)
            )
    return min(costs) + UNIT


def apart(a, b):
    """Size of the difference of two angles."""
    return abs((a - b + mpmath.pi) % (2 * mpmath.pi) - mpmath.pi)


def angle(c, s):
    return mpmath.atan2(s, c)
