"""Functions of scalars written for arrays: of each element what the function says of it alone."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from poekin.engine.transpile.arrays.array_functions import ArrayFunctions
from poekin.errors import InputError

HALF = 0.5
STEP = np.uint64(2**63 + 5)


def ways(x, y):
    """Names that ways give values, one inside the other."""
    a = x
    b = math.sqrt(abs(y))
    if x > y:
        a += 1.0
        if y > 0.0 or not x < HALF:
            b = a * 2.0
        else:
            a = 0.0
    elif -1.0 < x <= y and y != 0.0:
        b = min(x, y) - max(a, math.pi)
    return a, b


def returns(x, y):
    if x < 0.0:
        below = abs(x)
        return below, y
    if y < 0.0:
        return x, swapped(x, y)[0]
    both = x + y
    return both, x - y


def swapped(x, y):
    if x > y:
        x, y = y, x
    return y, x


def whole(x, y):
    i = int(x)
    j = math.floor(y)
    bits = (np.uint64(abs(i)) * STEP + np.uint64(3)) ^ (np.uint64(abs(j)) >> np.uint64(1))
    return i // 3 + j % 5, np.int64(bits >> np.uint64(20))


def fixed_way(sizes, x, y):
    n = sizes[0]
    if x > 0.0:
        return 1.0, y
    if n == 0:
        return 2.0, y
    return n * x, y


def elsewhere(x, y):
    return math.hypot(x, y), 0.0


def called(x, y):
    return elsewhere(x, y)


def of_arrays(function, *given, fixed=(), replaced=None):
    """What the text of a function gives."""
    functions = ArrayFunctions(replaced or {})
    name = functions.add(function, fixed)
    namespace: dict[str, Any] = {"xp": np}
    exec(functions.text, namespace)
    with np.errstate(all="ignore"):
        return namespace[name](*given)


PAIRS = st.lists(
    st.tuples(st.floats(-4, 4), st.sampled_from([-2.0, -0.0, 0.0, 0.5, 3.5])), min_size=1
)


@pytest.mark.parametrize("function", [ways, returns, swapped, whole], ids=lambda f: f.__name__)
@given(pairs=PAIRS)
@example(pairs=[(x, y) for x in (-2.0, -0.5, 0.2, 0.5, 1.0) for y in (-1.0, 0.0, 0.3, 0.5, 2.0)])
def test_each_element_is_what_the_function_says_of_it(function, pairs):
    x, y = np.array(pairs).T
    found = of_arrays(function, x, y)
    with np.errstate(over="ignore"):
        expected = [function(*pair) for pair in pairs]
    for k, numbers in enumerate(zip(*expected, strict=True)):
        np.testing.assert_array_equal(np.broadcast_to(found[k], x.shape), numbers)


@pytest.mark.parametrize("n", [0, 3])
def test_an_if_that_asks_of_no_array_stays_one(n):
    x = np.array([-1.0, 2.0])
    a, b = of_arrays(fixed_way, (n,), x, x, fixed=["sizes"])
    assert a.tolist() == [fixed_way((n,), v, v)[0] for v in x]
    assert b.tolist() == x.tolist()


def in_ways(sizes, x, y):
    """Ways in ways,
    each by itself.
    """
    a = x
    if x > y:
        a = 2.0 * y
    if y < a < 1.0:
        if sizes[0] == 0:
            return a
        if a < 0.0:
            return x
    return -y


IN_WAYS = """
def test_array_functions_in_ways(sizes, x, y):
    \"""Ways in ways, each by itself.\"""
    a = x
    test_1 = x > y
    a_1 = 2.0 * y
    a = select(test_1, a_1, a)
    def way_1():
        if sizes[0] == 0:
            return a
        def way_2():
            return x
        def way_3():
            return -y
        return select(a < 0.0, way_2(), way_3())
    def way_4():
        return -y
    return select((y < a) & (a < 1.0), way_1(), way_4())
"""


def test_text_is_laid_out_as_by_hand():
    functions = ArrayFunctions({})
    functions.add(in_ways, ["sizes"])
    choice, found = functions.text.split("\n\n\n")
    assert choice.startswith("def select(test, a, b):\n")
    assert found == IN_WAYS.lstrip()


def test_what_is_written_elsewhere_is_called_by_its_name():
    functions = ArrayFunctions({elsewhere: "xp.elsewhere"})
    functions.add(called)
    assert "    return xp.elsewhere(x, y)\n" in functions.text


def a_loop(x, y):
    for _ in range(3):
        x += y
    return x


def a_row(x, y):
    x[0] = y
    return x


def one_way(x, y):
    if x > y:
        late = y
    return late  # pyright: ignore[reportPossiblyUnboundVariable]


def again(x, y):
    if x > y:
        x = 2.0 * y
        return x
    return y


def other_way(sizes, y):
    if sizes[0] > 0:
        x = y
    else:
        x = 2.0 * y
    return x


def a_fixed_way(sizes, x, y):
    a = x
    if x > y:
        a = y
        if sizes[0] > 0:
            a = 2.0 * y
    return a


def another_function(x, y):
    return math.hypot(x, y)


def a_text(x, y):
    return __name__


REFUSED = {
    a_loop: "a statement For",
    a_row: "writing to x[0]",
    one_way: "late, which one way alone gives a value,",
    again: "a way that returns and gives a name another value",
    other_way: "`else` where an `if` asks of no array",
    a_fixed_way: "an `if` of no array inside one of arrays",
    another_function: "a call of math.hypot",
    a_text: "the value __name__ of type str",
}


@pytest.mark.parametrize("function", REFUSED, ids=lambda f: f.__name__)
def test_what_has_no_counterpart_is_refused(function):
    with pytest.raises(InputError, match=re.escape(f"transpile: {REFUSED[function]} has no")):
        ArrayFunctions({}).add(function, ["sizes"])
