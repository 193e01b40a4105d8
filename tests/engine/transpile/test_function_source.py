"""What is refused: file, line and construct are named."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from poekin.engine.transpile.c_types import CRow
from poekin.engine.transpile.translation_unit import TranslationUnit
from poekin.engine.transpile.values import Argument
from poekin.errors import InputError

WORD = "text"
EMPTY = {"a": 1}


def a_list(a, out):
    out[0] = [a[0]][0]


def a_power(a, out):
    out[0] = a[0] ** 2


def a_text(a, out):
    return WORD


def a_dictionary(a, out):
    out[0] = EMPTY["a"]


def an_attempt(a, out):
    try:
        out[0] = a[0]
    finally:
        out[1] = 1.0


def a_generator(a, out):
    out[0] = sum(x for x in a)


def before_its_value(a, out):
    out[0] = late  # type: ignore # noqa: F821
    late = a[0]
    out[1] = late


def two_types(a, out):
    x = (a[0], a[1])
    x = a[0]
    out[0] = x


def beyond_the_end(a, out):
    out[0] = a[7]


def beside_its_loop(a, out):
    for i in range(3):
        out[i] = a[i]
    out[3] = i


def else_of_a_loop(a, out):
    for i in range(3):
        out[i] = a[i]
    else:
        out[3] = 1.0


def not_always(a, out):
    out[0] = sometimes(a)


def sometimes(a):
    if a[0] > 0.0:
        return 1.0


def itself(a, out):
    out[0] = falling(a[0])


def falling(x):
    if x > 0.0:
        return falling(x - 1.0)
    return x


def a_tuple_written(a, out):
    x = (a[0], a[1])
    x[0] = 1.0  # type: ignore


def an_attribute(a, out):
    out[0], a.size = (a[0], a[1])


def keyword(a, out):
    out[0] = abs(x=a[0])  # type: ignore[call-arg]


def one_too_few(a, out):
    out[0] = larger(a[0])  # type: ignore


def larger(x, y):
    return max(x, y)


def a_lambda(a, out):
    out[0] = (lambda x: x)(a[0])


def a_word_and_a_number(a, out):
    out[0] = np.uint64(3) + a[0]


def a_word_of_a_double(a, out):
    out[0] = np.int64(np.uint64(a[0]))


def a_word_or_a_number(a, out):
    x = np.uint64(3)
    x = 2
    out[0] = x


def a_rest_of_doubles(a, out):
    out[0] = a[0] % 2.0


def the_largest_of_one(a, out):
    out[0] = max(a[0])


def the_largest_of_rows(a, out):
    out[0] = max(a, a)


REFUSED = {
    the_largest_of_one: ("max(", "max of anything but two numbers or more"),
    the_largest_of_rows: ("max(", "max of anything but two numbers or more"),
    a_word_and_a_number: ("+ a[0]", "the operator Add here"),
    a_word_of_a_double: ("np.int64(", "np.uint64 of anything but an integer"),
    a_word_or_a_number: ("x = 2", "the name x for values of two types"),
    a_rest_of_doubles: ("% 2.0", "% or // but of integers"),
    a_list: ("[a[0]][0]", "an expression List"),
    a_power: ("**", "the operator Pow here"),
    a_text: ("WORD", "the value WORD of type str"),
    a_dictionary: ("EMPTY", "the value EMPTY of type dict"),
    an_attempt: ("try:", "a statement Try"),
    a_generator: ("sum", "an expression GeneratorExp"),
    before_its_value: ("= late  #", "the use of late before it has a value"),
    two_types: ("x = a[0]", "the name x for values of two types"),
    beyond_the_end: ("a[7]", "the index 7 of 6"),
    beside_its_loop: ("for i", "the use of i beside its loop"),
    else_of_a_loop: ("for i", "`else` of a loop, or a loop over several names,"),
    not_always: ("def sometimes", "a function that may end without its value"),
    itself: ("return falling", "a call of falling by itself"),
    a_tuple_written: ("x[0] = 1.0", "writing to x[0]"),
    an_attribute: ("a.size", "unpacking into a.size"),
    keyword: ("abs(", "a call with a keyword here"),
    a_lambda: ("(lambda", "the name lambda x: x"),
    one_too_few: ("larger(", "a call of larger with missing a required argument: 'y'; it"),
}


@pytest.mark.parametrize("function", REFUSED, ids=lambda f: f.__name__)
def test_what_has_no_counterpart_is_refused_with_file_line_and_construct(function):
    at, construct = REFUSED[function]
    module = Path(__file__).read_text(encoding="utf-8").splitlines()
    start = next(k for k, line in enumerate(module) if f"def {function.__name__}(" in line)
    line = 1 + next(k for k, text in enumerate(module) if k >= start and at in text)
    message = f"{__file__}:{line}: transpile: {construct} has no counterpart in C here"
    unit = TranslationUnit("t")
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        unit.instance(function, [Argument(CRow(6)), Argument(CRow(6))])
