"""Each construct that C has not is refused with its place and its words."""

from __future__ import annotations

import functools
import math
import re
from pathlib import Path

import numpy as np
import pytest

from poekin.engine.transpile.c_types import CRow
from poekin.engine.transpile.translation_unit import TranslationUnit
from poekin.engine.transpile.values import Argument
from poekin.errors import InputError

# pyright: basic, reportIndexIssue=false, reportGeneralTypeIssues=false, reportArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportAssignmentType=false, reportCallIssue=false
# pyright: reportOperatorIssue=false, reportReturnType=false


def while_else(a, out):
    while a[0] > 1.0:
        out[0] = 1.0
    else:
        out[1] = 1.0


def among_a_row(a, out):
    out[0] = 1.0 if a[0] in a else 0.0


def not_among(a, out):
    out[0] = 1.0 if a[0] not in (1.0, 2.0) else 0.0


def a_tuple_as_condition(a, out):
    if (a[0], a[1]):  # noqa: F634
        out[0] = 1.0


@functools.cache
def decorated(a, out):
    out[0] = a[0]


def several_arguments(a, out, *rest):
    out[0] = a[0]


def by_keyword_alone(a, out, *, x=1.0):
    out[0] = x


def over_a_row(a, out):
    for x in a:
        out[0] = x


def of_two_types(a):
    if a[0] > 0.0:
        return (a[0], a[1])
    return 1.0


def two_results(a, out):
    out[0] = of_two_types(a)


def a_row(a):
    return a[1:]


def a_row_as_result(a, out):
    out[0] = a_row(a)[0]


def a_slice_of_a_number(a, out):
    out[0] = a[0][0:1]


def a_slice_of_nothing(a, out):
    x = (a[0], a[1])[2:]
    out[0] = len(x)


def a_slice_not_known(a, out):
    out[0] = a[int(a[0]) :][0]


def a_slice_of_doubles(a, out):
    out[0] = a[1.0:][0]


def a_slice_with_a_step(a, out):
    out[0] = a[0:4:2][0]


def size_of_an_integer(a, out):
    out[0] = abs(int(a[0]))


def plain(x, y):
    return x + y


NAMED = {"y": 1.0}


def two_stars(a, out):
    out[0] = plain(a[0], **NAMED)


def several_targets(a, out):
    x = y = a[0]
    out[0] = x + y


def an_empty_tuple(a, out):
    x = ()
    out[0] = len(x)


def without_effect(a, out):
    a[0]


def index_into_several_types(a, out):
    out[0] = (a[0], True)[int(a[1])]


def break_over_several_types(a, out):
    x = ((a[0], True), (1, 2.0))
    y = (x[0], 2.0)
    for item in y:  # noqa: B007
        if a[0] > 0.0:
            break
        out[0] = 1.0
    out[1] = item


def length_of_a_number(a, out):
    out[0] = len(a[0])


def range_of_a_double(a, out):
    for i in range(a[0]):
        out[i] = 1.0


def step_not_known(a, out):
    for i in range(0, 5, int(a[0])):
        out[i] = 1.0


def step_of_nothing(a, out):
    for i in range(0, 5, 0):
        out[i] = 1.0


def store(out):
    out[0] = 1.0


def value_of_none(a, out):
    out[1] = store(out)


def unpacked_number(a, out):
    x, y = a[0]
    out[0] = x + y


def too_many_values(a, out):
    x, y = (a[0], a[1], a[2])
    out[0] = x + y


def a_class(a, out):
    out[0] = complex(a[0])


def to_an_attribute(a, out):
    a.size = a[0]


def more_to_an_attribute(a, out):
    a.size += a[0]


def index_of_a_double(a, out):
    out[0] = a[a[1]]


def index_of_a_number(a, out):
    out[0] = a[2][1]


def index_below(a, out):
    out[0] = a[-7]


def not_in_a_module(a, out):
    out[0] = math.nothing


def the_same(a, out):
    out[0] = 1.0 if a[0] is a[1] else 0.0


def tuples_in_order(a, out):
    out[0] = 1.0 if (a[0], a[1]) < (a[1], a[0]) else 0.0


def a_literal_text(a, out):
    x = "a text"
    out[0] = x


def underscored(a, out):
    _x = a[0]
    out[0] = _x


def greek(a, out):
    α = a[0]
    out[0] = α


def several_rows(a, out):
    row = a[1:]
    row = a[2:]
    out[0] = row[0]


def inverted(a, out):
    out[0] = ~int(a[0])


def minus_a_tuple(a, out):
    x = -(a[0], a[1])
    out[0] = x[0]


def either_bit(a, out):
    out[0] = int(a[0]) | 3


def grows(n, x):
    n = n + x
    return n


def a_parameter_of_two_types(a, out):
    out[0] = grows(int(a[0]), a[1])


def root_of_a_tuple(a, out):
    out[0] = math.sqrt((a[0], a[1]))


def a_number_or_a_tuple(a, out):
    x = (a[0], a[1]) if a[0] > 0.0 else a[1]
    out[0] = x


def managed(a, out):
    with np.errstate():
        out[0] = a[0]


REFUSED = {
    while_else: ("while a", "`else` of a loop"),
    among_a_row: ("in a else", "`in` but of a tuple that is written there"),
    not_among: ("not in", "`in` but of a tuple that is written there"),
    a_tuple_as_condition: ("if (", "a condition that is no number"),
    decorated.__wrapped__: ("def decorated", "a decorator"),
    several_arguments: ("def several", "a parameter of another sort than by position"),
    by_keyword_alone: ("def by_keyword", "a parameter of another sort than by position"),
    over_a_row: ("for x in a", "a loop over anything but range and a tuple"),
    two_results: ("return 1.0", "a result of two types, or a row as a result,", of_two_types),
    a_row_as_result: ("return a[1:]", "a result of two types, or a row as a result,", a_row),
    a_slice_of_a_number: ("[0:1]", "a slice here"),
    a_slice_of_nothing: ("[2:]", "a slice here"),
    a_slice_not_known: ("int(", "a slice whose bounds are not known"),
    a_slice_of_doubles: ("1.0:", "a slice whose bounds are not known"),
    a_slice_with_a_step: ("0:4:2", "a slice with a step"),
    size_of_an_integer: ("abs(", "abs of an integer"),
    two_stars: ("**", "an argument with two stars"),
    several_targets: ("x = y", "an assignment to several targets"),
    an_empty_tuple: ("x = ()", "an empty tuple"),
    without_effect: ("a[0]", "an expression without effect"),
    index_into_several_types: (
        "(a[0], True)",
        "an index that is not known of a tuple of several types",
    ),
    break_over_several_types: (
        "for item",
        "break or continue in a loop over a tuple of several types",
    ),
    length_of_a_number: ("len(", "len of a number"),
    range_of_a_double: ("range(", "range of anything but one to three integers"),
    step_not_known: ("range(", "range with a step that is not known"),
    step_of_nothing: ("range(", "range with a step that is not known"),
    value_of_none: ("store(out)", "the value of a call that returns none"),
    unpacked_number: ("x, y =", "unpacking a number"),
    too_many_values: ("x, y =", "unpacking 3 values into 2 names"),
    a_class: ("complex", "a call of complex"),
    to_an_attribute: ("a.size =", "an assignment to a.size"),
    more_to_an_attribute: ("a.size +=", "the name a"),
    index_of_a_double: ("a[a[1]]", "an index of a here"),
    index_of_a_number: ("a[2][1]", "an index of a[2] here"),
    index_below: ("a[-7]", "the index -7 of 6"),
    not_in_a_module: ("math.nothing", "the attribute nothing"),
    the_same: (" is ", "the comparison Is here"),
    tuples_in_order: (" < ", "the comparison Lt here"),
    a_literal_text: ('"a text"', "the constant 'a text'"),
    underscored: ("_x = a[0]", "the name '_x'"),
    greek: ("α = a[0]", "the name 'α'"),
    several_rows: ("row = a[1:]", "the name row for several rows"),
    inverted: ("~int", "the operator Invert here"),
    minus_a_tuple: ("x = -(", "the operator USub here"),
    either_bit: ("| 3", "the operator BitOr here"),
    a_parameter_of_two_types: ("n = n + x", "the parameter n for values of two types", grows),
    root_of_a_tuple: ("math.sqrt(", "math.sqrt of anything but numbers"),
    a_number_or_a_tuple: ("x = (", "a value of two types"),
    managed: ("with ", "a statement With"),
}


@pytest.mark.parametrize("function", REFUSED, ids=lambda f: f.__name__)
def test_what_has_no_counterpart_is_refused_with_file_line_and_construct(function):
    at, construct, *elsewhere = REFUSED[function]
    named = (elsewhere or [function])[0].__name__
    module = Path(__file__).read_text(encoding="utf-8").splitlines()
    start = next(k for k, line in enumerate(module) if f"def {named}(" in line)
    line = 1 + next(k for k, text in enumerate(module) if k >= start and at in text)
    if "name" in construct and ("_x" in construct or "α" in construct):
        line = start + 1  # of the function: the name may come from anywhere in it
    message = f"{__file__}:{line}: transpile: {construct} has no counterpart in C here"
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        TranslationUnit("t").instance(function, [Argument(CRow(6)), Argument(CRow(6))])


def test_what_is_no_function_defined_by_def_is_refused():
    nameless = lambda a, out: a  # noqa: E731
    with pytest.raises(InputError, match="transpile: anything but a function defined by def has"):
        TranslationUnit("t").instance(nameless, [Argument(CRow(6)), Argument(CRow(6))])
