"""Angle of a point of the plane without a table or a branch: a third of the library's time, and a loop
over many points may take some at once.

The angle of the smaller coordinate over the larger is that of 0, 1/2 or 1, whichever is near, and
what is left, |t| <= sqrt(5) - 2, goes through the series of `formulas.lie.arctangent`.
Absolute error at most 6e-16 (tests/engine/straight_line/test_arctangent.py).
"""

import math

from ...formulas.lie.arctangent import NARROW, NARROW_SERIES

_FIRST = NARROW  # tan(atan(1 / 2) / 2)
_SECOND = 0.7207592200561265  # tan((atan(1 / 2) + atan(1)) / 2)
_HALF = math.atan(0.5)
_REST = math.atan(1.0) - math.atan(0.5)
_TINY = 1e-300
_C = NARROW_SERIES


def atan2(y, x):
    """Angle (rad) of (x, y), within [-pi, pi]; 0 of (0, 0)."""
    a = abs(x)
    b = abs(y)
    steep = _is_less(a - b)
    flat = 1.0 - steep
    large = steep * b + flat * a + _TINY
    small = steep * a + flat * b
    first = _is_less(_FIRST * large - small)
    second = _is_less(_SECOND * large - small)
    near = 0.5 * (first + second)
    t = (small - near * large) / (large + near * small)
    angle = (first * _HALF + second * _REST) + t * (1.0 + _series(t * t))
    back = _is_less(x)
    start = (0.5 * math.pi) * steep + math.pi * (flat * back)
    angle = start + (flat - steep) * (1.0 - 2.0 * back) * angle
    return math.copysign(angle, y)


def _is_less(x):
    """1 of a number below 0, and 0 of another: of a comparison a compiler may make a branch."""
    return 0.5 - math.copysign(0.5, x)


def _series(z):
    """atan(t) / t - 1, z = t^2."""
    w = z * z
    first = _C[0] + _C[1] * z + w * (_C[2] + _C[3] * z)
    second = _C[4] + _C[5] * z + w * (_C[6] + _C[7] * z)
    return z * (first + w * w * second)
