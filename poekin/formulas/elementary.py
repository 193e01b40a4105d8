"""The only functions beyond + - x / and comparison that the formulas use.

Each looks up the functions of its argument's kind: those of floats, unless `provide` has registered
its kind. The engine maps each function to compiled code. This is why one formula runs in all kinds.
"""

import math
from types import SimpleNamespace


def _or_nan(function):
    """A function of floats with NaN where it raises: compiled code gives that too."""

    def defined(x):
        try:
            return function(x)
        except ValueError:
            return math.nan

    return defined


_FLOATS = (
    SimpleNamespace(
        sqrt=_or_nan(math.sqrt),
        sin=_or_nan(math.sin),
        cos=_or_nan(math.cos),
        asin=_or_nan(math.asin),
        atan2=math.atan2,
    ),
    True,
)
_FUNCTIONS = {}


def provide(kind, functions, series=True):
    """Let scalars of type `kind` take sqrt, sin, cos, asin and atan2 from the namespace `functions`.

    `series` says whether small arguments need the Taylor polynomials; numbers of many digits do
    without.
    """
    _FUNCTIONS[kind] = (functions, series)


def _functions(x):
    return _FUNCTIONS.get(type(x), _FLOATS)[0]


def sqrt(x):
    """Square root."""
    return _functions(x).sqrt(x)


def sin(x):
    """Sine of an angle in rad."""
    return _functions(x).sin(x)


def cos(x):
    """Cosine of an angle in rad."""
    return _functions(x).cos(x)


def asin(x):
    """Angle (rad) between -pi/2 and pi/2 of which x is the sine."""
    return _functions(x).asin(x)


def atan2(y, x):
    """Angle of the point (x, y), in rad."""
    return _functions(y).atan2(y, x)


def takes_series(x):
    """Whether a polynomial serves for x; numbers of many digits do without."""
    return _FUNCTIONS.get(type(x), _FLOATS)[1]


def below(x, limit):
    """Whether x is so small, x < limit, that a closed form would cancel; for exact numbers only x =
    0 is.
    """
    if takes_series(x):
        return x < limit
    return x == 0


def where_less(a, b, x, y):
    """x where a < b, else y; of several numbers at once, each by itself."""
    if a < b:
        return x
    return y
