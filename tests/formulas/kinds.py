"""The kinds of scalar that a formula runs in: floats, compiled, counting and exact, each as a way
to call it.
"""

from __future__ import annotations

from collections.abc import Callable

import mpmath
import numba
import numpy as np

from poekin.engine.count import Count, counted
from poekin.engine.jit import compile as engine_compile
from poekin.engine.jit.cache import KernelCache
from poekin.engine.straight_line.interpret import evaluate
from poekin.engine.straight_line.program import Angles, program
from poekin.engine.straight_line.trace import Graph
from poekin.formulas import elementary

DIGITS = 60
elementary.provide(mpmath.mpf, mpmath.mp, series=False)
_compiled: dict[Callable, Callable] = {}


def _mapped(value, leaf):
    """Nested tuples and lists with every float replaced; integers are counts and structure, and
    stay.
    """
    if isinstance(value, (tuple, list)):
        return type(value)(_mapped(v, leaf) for v in value)
    return leaf(value) if isinstance(value, float) else value


def _flat(value) -> list:
    if value is None:
        return []
    if isinstance(value, np.ndarray):
        return [float(x) for x in value.ravel()]
    if isinstance(value, (tuple, list)):
        return [x for v in value for x in _flat(v)]
    return [value]


def floats(formula, *arguments):
    return _run(formula, _mapped(list(arguments), float))


def machine_code(formula):
    """Compiled as the kernels are, and kept with them: an edit of any formula compiles it anew."""
    dispatcher = numba.njit(**engine_compile.OPTIONS)(formula)
    if dispatcher is not formula:  # where Numba is switched off
        dispatcher._cache = KernelCache(f"{formula.__module__}.{formula.__name__}")  # type: ignore[attr-defined]
    return dispatcher


def both(formula):
    """As floats, and compiled as the kernels are: there a product and a sum may be one operation."""
    return formula, machine_code(formula)


def compiled(formula, *arguments):
    """Tuples stay tuples; lists, which are rows, become arrays."""
    if formula not in _compiled:
        _compiled[formula] = machine_code(formula)
    return _run(
        _compiled[formula],
        [np.array(a, dtype=float) if isinstance(a, list) else a for a in arguments],
    )


def counting(formula, *arguments):
    count = Count()
    return _run(formula, counted_floats(list(arguments), count))


def counted_floats(value, count):
    return _mapped(value, lambda x: counted(x, count))


def traced(formula, *arguments):
    """Recorded on numbers that are all unknown, then computed from what was recorded."""
    graph, values = Graph(), []

    def recorded(x):
        values.append(x)
        return graph.input(-len(values))

    arguments = _mapped(list(arguments), recorded)
    result = formula(*arguments)
    outputs = [
        x + 0.0 if isinstance(x, int) else x for x in _flat(result) + _flat(_written(arguments))
    ]
    return evaluate(program(graph, Angles(graph), outputs), np.array([values]))[0].tolist()


def exact(formula, *arguments):
    with mpmath.workdps(DIGITS):
        return _run(formula, _mapped(list(arguments), mpmath.mpf))


def _run(function, arguments) -> list[float]:
    """The result and whatever was written into rows, flattened."""
    result = function(*arguments)
    return [float(x) for x in _flat(result) + _flat(_written(arguments))]


def _written(arguments) -> list:
    return [a for a in arguments if isinstance(a, (list, np.ndarray))]


KINDS = {"compiled": compiled, "counting": counting, "exact": exact}
