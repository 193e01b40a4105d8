"""Transpiled functions of each construct: to the last bit what Python computes."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formulas import elementary

from .compiled_c import READ, WRITTEN, library, run, text_of

LIMIT = 0.5
NAMES = (1.0, -2.0, 4.0)


def arithmetic(a, out):
    out[0] = a[0] + a[1] - a[2] * a[3]
    out[1] = (a[0] - (a[1] - a[2])) * -a[3]
    out[2] = a[0] / (1.0 + a[1] * a[1])
    out[3] = 2 * a[0] - 1
    out[4] = -(0.5 - -a[0])
    out[5] = 0.1 + 0.2
    out[6] += a[1]
    out[6] *= a[2]
    out[7] = -(-a[1])  # noqa: B002
    out[-1] = a[-1]


def a_whole_row(a, out):
    p, q, r, s, t, u = a
    out[0] = p - 2.0 * u
    out[1] = q - 2.0 * t
    out[2] = r - 2.0 * s


def comparisons(a, out):
    if a[0] < a[1]:
        out[0] = 1.0
    elif a[0] == a[1]:
        out[0] = 2.0
    elif not a[0] > a[1]:
        out[0] = 3.0
    else:
        out[0] = 4.0
    if a[0] <= a[1] and (a[2] >= a[3] or a[4] != a[5]):
        out[1] = 1.0
    if a[0] < a[1] < a[2]:
        out[2] = 1.0
    if a[0]:
        out[3] = 1.0
    out[4] = 1.0 if a[0] > LIMIT else -a[1]
    if (a[0], a[1]) == (a[2], a[3]):
        out[5] = 1.0
    if (a[0], a[1]) == (a[2], a[3], a[4]):
        out[6] = 1.0
    out[7 + int(a[0] < a[1])] = 1.0


def numbers_that_are_none(a, out):
    out[0] = max(a[0], a[1])
    out[1] = min(a[0], a[1])
    out[2] = max(a[0], a[1], a[2], -1)
    out[3] = min(1.0, a[1], a[2])
    out[4] = abs(a[0])
    small = a[0] < math.inf
    out[5] = 1.0 if small else math.inf


def swapped(x, y):
    """Two results."""
    return y, x


def nested(a):
    """Tuples of tuples, of truth values, and of several types."""
    return ((a[0], a[1]), (a[2], a[3])), (a[0] > 0.0, a[1] > 0.0), (a[4], True, 3)


def unread(pair):
    x, y = pair
    if LIMIT > 1.0:
        return x * y
    return 1.0


def tuples(a, out):
    x, y = swapped(a[0], a[1])
    x, y = y, x
    out[0] = x
    out[1] = y
    rows, kinds, number = nested(a)
    out[2] = rows[1][0]
    out[3] = 1.0 if kinds[0] and not kinds[1] else 0.0
    out[4] = number[0] * number[2]
    both = rows[0] + rows[1] + (7.0,)
    out[5] = both[3]
    out[6] = len(both)
    part = both[1:3]
    out[7] = part[-1]
    first, _ = (a[5], a[4])
    out[8] = first
    out[9] = unread((a[0], a[1]))


def loops(a, out):
    total = 0
    for i in range(len(a)):
        if a[i] != a[i]:
            continue
        if i > 4:
            break
        total += a[i] * i
    out[0] = total
    for i in range(4, -1, -2):
        out[1] += a[i]
    for factor in (1.0, 2.0, a[0]):
        total = total - factor
    out[2] = total
    for row in ((a[0], a[1]), (a[2], a[3])):
        if row[0] > row[1]:
            continue
        out[3] += row[1]
    for k in (1, 2):
        for i in range(k):
            out[4 + k] += a[i]
    for value in NAMES:
        out[7] += value * a[1]
    steps = 0
    x = abs(a[0])
    while x > 1.0 and steps < 50:
        x = 0.5 * x
        steps += 1
    out[8] = x
    out[9] = steps
    while True:
        steps += 1
        if steps > 60:
            break
    out[10] = steps


def loops_in_loops(a, out):
    at = 0
    for row in ((a[0], a[1]), (a[2], a[3])):
        for x in row:
            out[at] += x * row[0]
        for y in (a[4], a[5]):
            for x in row:
                out[2 + at] += x * y
        out[4 + at] = row[1]
        at += 1  # noqa: SIM113


def functions(a, out):
    out[0] = elementary.sqrt(abs(a[0]))
    out[1] = elementary.sqrt(elementary.below(a[0], 0.0) * 1.0)
    out[2] = elementary.atan2(a[0], a[1])
    x = a[2] if abs(a[2]) < 1.0 else 0.25
    out[3] = elementary.sin(x) + elementary.cos(x)
    out[4] = elementary.asin(x)
    out[5] = math.copysign(1.0, a[3])
    out[6] = int(x * 10.0)
    out[7] = int(x * 10.0) % 3


def rows(a, out):
    part = out[2:6]
    for i in range(4):
        part[i] = a[i + 1]
    store(out, 8, value=a[0])
    out[9] = first_of(a[3:])
    y1, exp = a[0], a[1]
    out[10] = y1 - exp


def store(row, at, value, factor=2.0):
    row[at] = factor * value


def first_of(row):
    return row[0]


def early(a, out):
    for i in range(6):
        if a[i] > LIMIT:
            out[0] = i
            return
    out[0] = -1.0


def a_bound_that_changes(a, out):
    n = 3
    for i in range(n):
        n -= 1
        out[i] = a[i]
    out[4] = n


CONSTRUCTS = (
    a_bound_that_changes,
    arithmetic,
    a_whole_row,
    comparisons,
    numbers_that_are_none,
    tuples,
    loops,
    loops_in_loops,
    functions,
    rows,
    early,
)


@pytest.fixture(scope="module")
def unit(tmp_path_factory):
    return library(tmp_path_factory.mktemp("constructs"), text_of(*CONSTRUCTS))


@pytest.mark.parametrize("function", CONSTRUCTS, ids=lambda f: f.__name__)
@given(a=st.lists(st.floats(width=64), min_size=READ, max_size=READ))
def test_c_computes_what_python_does(function, unit, a):
    out = np.zeros(WRITTEN)
    try:
        with np.errstate(all="ignore"):
            function(np.array(a), out)
    except (OverflowError, ValueError):
        return  # int of what is no number
    # the sign of a NaN is nobody's
    np.testing.assert_array_equal(run(unit, function, a), out)


def test_of_each_construct_there_is_one_function_with_its_docstring_above():
    text = text_of(tuples)
    assert text.count("t_test_statements_swapped(") == 2  # its definition and a call
    assert "/* Tuples of tuples, of truth values, and of several types. */\nstatic " in text


def left_early(a):
    if len(a) > 2:
        return a[0]
    return a[1]


def leaves_early(a, out):
    out[0] = left_early(a)


def test_what_stands_behind_a_return_that_is_met_always_is_left_out():
    text = text_of(leaves_early)
    assert "return a[0];" in text
    assert "a[1]" not in text


def test_nothing_is_multiplied_by_one_or_moved_by_none():
    text = text_of(*CONSTRUCTS)
    assert re.findall(r"[^\n]*(?:\b1 \* |\+ 0\b(?!\.))[^\n]*", text) == []


def test_what_is_written_once_is_const():
    text = text_of(*CONSTRUCTS)
    bodies = [body for body in re.split(r"^}$", text, flags=re.MULTILINE) if "{" in body]
    declared = re.compile(r"^ +(const )?(?:double|int64_t|int) (\w+) = ", re.MULTILINE)
    for body in bodies:
        found = declared.findall(body)
        for const, name in found:
            writes = re.findall(rf"\b{name}(?: [-+*/]?= |\+\+)|&{name}\b", body)
            declarations = [other for _, other in found if other == name]
            assert bool(const) == (len(writes) == len(declarations)), name
    assert len(declared.findall(text)) > 20
