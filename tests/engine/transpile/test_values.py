"""Numbers, brackets and names of C, and lines that are not too long."""

from __future__ import annotations

import math

import numpy as np
import pytest

from poekin.engine.transpile.c_types import (
    BOOL,
    DOUBLE,
    INT,
    WORD,
    CTuple,
    Structures,
    type_of_constant,
    unify,
)
from poekin.engine.transpile.translation_unit import TranslationUnit, _plain, _used_in, wrapped
from poekin.engine.transpile.values import (
    EQUAL,
    LESS,
    OR,
    PRODUCT,
    SUM,
    UNARY,
    CValue,
    as_double,
    binary,
    initial,
    member,
    number,
    scalar,
    word,
)

X, Y = CValue(DOUBLE, "x"), CValue(DOUBLE, "y")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1, "1.0"),
        (-0.1, "-0.1"),
        (math.inf, "HUGE_VAL"),
        (-math.inf, "-HUGE_VAL"),
        (math.nan, "(double)NAN"),
    ],
)
def test_a_number_is_a_double_of_c(value, text):
    assert number(value) == text


@pytest.mark.parametrize(
    ("value", "kind", "text", "in_a_product"),
    [
        (3, INT, "3", "3"),
        (-3, INT, "-3", "-3"),
        (True, BOOL, "1", "1"),
        (2**63, WORD, "9223372036854775808ULL", "9223372036854775808ULL"),
        (0.5, DOUBLE, "0.5", "0.5"),
    ],
)
def test_a_known_number_is_written_out(value, kind, text, in_a_product):
    found = scalar(value, kind)
    assert (found.text, found.within(PRODUCT), found.known) == (text, in_a_product, True)
    assert not found.fixed
    assert found.simple == (value >= 0)
    assert as_double(scalar(3, INT)).text == "3.0"
    assert as_double(CValue(INT, "i + j", SUM)).text == "(double)(i + j)"
    assert as_double(X) is X


def test_operands_have_brackets_where_the_order_of_operations_asks_for_them():
    total = binary("-", X, Y, DOUBLE, SUM)
    assert total.text == "x - y"
    assert binary("*", total, total, DOUBLE, PRODUCT).text == "(x - y) * (x - y)"
    assert binary("-", total, total, DOUBLE, SUM).text == "x - y - (x - y)"
    product = binary("/", X, Y, DOUBLE, PRODUCT)
    assert binary("/", product, product, DOUBLE, PRODUCT).text == "x / y / (x / y)"
    assert binary("+", product, product, DOUBLE, SUM).text == "x / y + x / y"
    less = binary("<", total, product, BOOL, LESS)
    assert less.text == "x - y < x / y"
    assert binary("==", less, less, BOOL, EQUAL).text == "(x - y < x / y) == (x - y < x / y)"
    both = binary("&&", less, less, BOOL, 2)
    assert both.text == "x - y < x / y && x - y < x / y"
    either = binary("||", both, less, BOOL, OR)
    assert either.text == "(x - y < x / y && x - y < x / y) || x - y < x / y"
    assert total.within(UNARY) == "(x - y)"
    assert word("^", CValue(WORD, "a * b", 0), CValue(WORD, "c")).text == "(a * b) ^ c"


def test_an_arm_tells_items_that_are_known_and_fixed():
    fixed, known = scalar(2, INT, True), scalar(3, INT)
    unknown = CValue(INT, "i", fixed=True)
    pair = CValue(CTuple((INT,) * 3), "p", parts=(fixed, known, unknown))
    assert pair.told == (fixed, None, None)


def test_types_that_hold_values_of_both():
    pair, other = CTuple((DOUBLE, INT)), CTuple((INT, INT))
    assert unify(BOOL, INT) == INT
    assert unify(INT, DOUBLE) == unify(DOUBLE, BOOL) == DOUBLE
    assert unify(WORD, INT) is unify(DOUBLE, WORD) is None
    assert unify(WORD, WORD) == WORD
    assert unify(pair, other) == pair
    assert unify(pair, CTuple((DOUBLE,))) is unify(pair, DOUBLE) is None
    assert unify(pair, CTuple((DOUBLE, pair))) is None
    assert type_of_constant((1.0, (True, 2))) == CTuple((DOUBLE, CTuple((BOOL, INT))))
    assert type_of_constant(np.uint64(3)) == WORD
    for value in ((), (1.0, "a"), None, "a", [1.0]):
        assert type_of_constant(value) is None


def test_structures_are_defined_before_what_is_made_of_them_and_only_where_they_are_used():
    structures = Structures("t")
    three = CTuple((DOUBLE,) * 3)
    mixed = CTuple((three, INT, BOOL))
    rows = CTuple((three, three))
    assert [structures.spell(kind) for kind in (three, mixed, rows, INT)] == [
        "t_d3",
        "t_t3_d3_i_b",
        "t_d3x2",
        "int",
    ]
    assert structures.definitions == {
        "t_d3": "typedef struct { double v[3]; } t_d3;",
        "t_t3_d3_i_b": "typedef struct { t_d3 m0; int m1; int m2; } t_t3_d3_i_b;",
        "t_d3x2": "typedef struct { t_d3 v[2]; } t_d3x2;",
    }
    d3, t3, d3x2 = structures.definitions.values()
    assert structures.used_in("const t_d3x2 a;") == [d3, d3x2]
    assert structures.used_in("(t_t3_d3_i_b){a}") == [d3, t3]
    assert structures.used_in("t_d30 x") == []
    value = CValue(mixed, "x")
    assert [member(value, k).text for k in (0, 2, -1)] == ["x.m0", "x.m2", "x.m2"]
    assert member(CValue(three, "f(x)"), -3).text == "f(x).v[0]"
    assert initial("(t_d3){{1.0}}", "t_d3") == "{{1.0}}"
    assert initial("(t_d3)x", "t_d3") == "(t_d3)x"


def test_lines_are_cut_at_110_characters_and_go_on_further_in():
    words = " ".join(["abcdefghi"] * 30)
    lines = wrapped(f"    x = {words};\n\n/* {words} */\nshort").split("\n")
    assert max(map(len, lines)) <= 110
    # words of nine and a blank: ten would be 4 + 4 + 10 * 10 - 1 = 107, eleven 117
    assert [line.count("abcdefghi") for line in lines] == [10, 9, 9, 2, 0, 10, 10, 10, 0]
    assert lines[0].startswith("    x = abc")
    assert lines[1].startswith(" " * 12 + "abc")
    assert lines[5].startswith("/* abc")
    assert lines[6].startswith(" * abc")
    assert lines[-1] == "short"


def test_a_comment_is_ascii_and_ends_where_it_should():
    assert _plain("a */ b /* c \\ d ?? é") == "a * / b / * c / d ? ? &#233;"


def test_definitions_are_found_by_their_whole_names():
    definitions = {"t_max": "A", "t_m": "B", "t_x": "C"}
    assert _used_in("y = t_max(a, b) + t_x[3];", definitions) == ["A", "C"]
    assert _used_in("t_maximum = t_mx", definitions) == []


def first():
    def same(a, out):
        out[0] = a[0]

    return same


def second():
    def same(a, out):
        out[1] = a[0]

    return same


def test_functions_of_one_name_are_told_apart_by_a_number():
    unit = TranslationUnit("t")
    names = [unit._name(function) for function in (first(), second(), first())]
    assert names == ["t_test_values_same", "t_test_values_same_2", "t_test_values_same_3"]


def test_quotients_and_rests_and_ends_have_functions_of_their_own():
    unit = TranslationUnit("t")
    assert [unit.helper(name) for name in ("max", "Mod", "FloorDiv")] == [
        "t_max",
        "t_mod",
        "t_floordiv",
    ]
    assert unit._helpers["t_max"] == (
        "/* max(a, b) as Python has it: a where one is not a number. */\n"
        "static inline double t_max(double a, double b)\n{\n    return b > a ? b : a;\n}"
    )
    assert unit._helpers["t_floordiv"] == (
        "/* floordiv(a, b) as Python has it: a / b, rounded down. */\n"
        "static inline int t_floordiv(int a, int b)\n{\n"
        "    return a / b - (a % b != 0 && (a % b < 0) != (b < 0));\n}"
    )


def test_a_table_is_written_row_by_row():
    unit = TranslationUnit("t")
    told = unit.table("arm", np.array([[1.0, -0.5], [0.0, math.inf]])).told
    assert told is not None
    assert (told.text, told.fixed) == ("t_arm", True)
    assert unit._constants["t_arm"] == (
        "static const double t_arm[4] = {\n    1.0, -0.5,\n    0.0, HUGE_VAL\n};"
    )
    assert unit.integer(-4).told == scalar(-4, INT, True)
