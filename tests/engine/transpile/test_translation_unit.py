"""Texts of functions: written for an arm's flags and tables, the same on every run."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest

from poekin import algebra
from poekin.engine.transpile.c_types import DOUBLE, CRow, CTable, CTuple
from poekin.engine.transpile.translation_unit import External, TranslationUnit
from poekin.engine.transpile.values import Argument
from poekin.formulas.ik import circle_conic, cones, orientation, two_circles
from poekin.formulas.lie import quaternion

from .compiled_c import library, run, text_of

TABLE = np.array([[1.0, 2.0, 0.0], [3.0, 4.0, 1.0]])


def by_kind(arm, a, out):
    """One of two, by a flag of the arm."""
    kinds = (arm[0, 2] != 0.0, arm[1][2] != 0.0)
    if kinds[0]:
        out[0] = never(a)
    elif chosen(kinds, 1):
        out[0] = twice(kinds, a[0]) * arm[1, 0]
    for i in range(2):
        out[1] += arm[i, 1]


def chosen(kinds, k):
    return kinds[k]


def never(a):
    return a[5]


def twice(kinds, x):
    if kinds[1]:
        return 2.0 * x
    return x


def calls_another(forward, a, out):
    forward(a, out)
    out[1] = out[0] + 1.0


def stand_in(a, out):
    """Written elsewhere."""


def test_a_function_is_written_for_the_arms_flags_and_what_it_does_not_need_is_left_out():
    unit = TranslationUnit("t")
    entry = unit.instance(by_kind, [unit.table("arm", TABLE), Argument(CRow(6)), Argument(CRow(2))])
    assert entry is not None
    text = unit.text([entry])
    assert "never" not in text
    assert "if" not in text.replace("/* One of two, by a flag of the arm. */", "")
    assert (
        "static inline void t_test_translation_unit_by_kind(const double *a, double *out)\n{\n"
        "    out[0] = t_test_translation_unit_twice(a[0]) * 3.0;\n"
        "    for (int i = 0; i < 2; i++) {\n"
        "        out[1] = out[1] + t_arm[3 * i + 1];\n    }\n}"
    ) in text


def test_a_function_of_c_that_is_written_elsewhere_is_called_by_its_name():
    unit = TranslationUnit("t", {stand_in: External("arm_fk", (1,))})
    arguments = [unit.function(stand_in), Argument(CRow(6)), Argument(CRow(2))]
    entry = unit.instance(calls_another, arguments)
    assert entry is not None
    assert "    arm_fk(a, out);\n" in unit.text([entry])
    assert entry.head.endswith("(const double *a, double *out)")


def test_the_text_of_formulas_is_the_same_on_every_run_in_ascii_and_without_long_lines():
    v = CTuple((DOUBLE,) * 3)
    three = CTuple((v,) * 3)
    R = CTuple((DOUBLE,) * 9)
    wanted = {
        circle_conic.roots: [DOUBLE] * 6,
        two_circles.roots: [CTuple((DOUBLE,) * 5)] * 2,
        cones.roots: [v] * 4,
        orientation.roots: [three, v, R],
    }
    texts = []
    for _ in range(2):
        unit = TranslationUnit("t")
        entries = [unit.instance(f, [Argument(t) for t in ts]) for f, ts in wanted.items()]
        texts.append(unit.text([entry for entry in entries if entry]))
    assert texts[0] == texts[1]
    assert texts[0].isascii()
    assert max(map(len, texts[0].splitlines())) <= 110


def conic(a, out):
    found = circle_conic.roots(a[0], a[1], a[2], a[3], a[4], a[5])
    for k in range(10):
        out[k] = found[k]


def two(a, out):
    first = (a[0], a[1], a[2], a[3], a[4])
    second = (a[5], a[4], a[3], a[1], a[0])
    at = 0
    for root in two_circles.roots(first, second):
        out[at] = root[0]
        out[at + 1] = root[3]
        out[at + 2] = root[4]
        at += 3


def turned(a, out):
    R = quaternion.rotation(a[0], a[1], a[2], a[3])
    for k in range(9):
        out[k] = R[k]


FORMULAS = (conic, two, turned)


def test_formulas_in_c_are_the_formulas_to_the_last_bit(tmp_path):
    unit = library(tmp_path, text_of(*FORMULAS))
    rng = np.random.default_rng(3)
    for function in FORMULAS:
        for a in rng.normal(size=(300, 6)):
            out = np.zeros(16)
            function(a.tolist(), out)
            np.testing.assert_array_equal(run(unit, function, a.tolist()), out)


def ends(a, out):
    out[0] = max(a[0], a[1])
    out[1] = min(a[0], a[1])
    out[2] = max(a[0], a[1], a[2])


def test_max_and_min_of_nan_are_those_of_compiled_python(tmp_path):
    unit = library(tmp_path, text_of(ends))
    compiled = numba.njit(ends)
    values = (math.nan, -1.0, 0.0, 2.0, math.inf)
    for a in ((x, y, z, 0.0, 0.0, 0.0) for x in values for y in values for z in values):
        out = np.zeros(16)
        compiled(np.array(a), out)
        np.testing.assert_array_equal(run(unit, ends, list(a)), out)


def by_zero(a, out):
    out[0] = 1.0 / 0.0
    out[1] = -1.0 / 0
    out[2] = 0.0 / 0.0
    out[3] = 2.5 - 0
    out[4] = 2.5 + 0.0


def test_a_quotient_by_a_zero_that_is_known_is_c_s(tmp_path):
    found = run(library(tmp_path, text_of(by_zero)), by_zero, [0.0] * 6)
    np.testing.assert_array_equal(found[:5], [math.inf, -math.inf, math.nan, 2.5, 2.5])


AXIS = np.array([[6.2e-17, 0.0, 1.0 - 2.0**-53], [3.0e-16, 0.5, 1.0 + 2.0**-51]])


def about_axis(arm, a, out):
    """Products and sums with numbers of the arm."""
    k = (arm[0, 0], arm[0, 1], arm[0, 2])
    across = algebra.cross(k, (a[0], a[1], a[2]))
    out[0] = across[0] - k[0]
    out[1] = k[1] - across[1]
    out[2] = across[2] * unread(a[4])
    out[3] = a[3] / k[2]
    out[4] = known(k, 2) + a[5]
    out[5] = arm[1, 0] * a[0] + arm[1, 2] * a[1]
    out[6] = k[1] - -a[4]


def unread(x):
    return 2.0 * x


def known(k, i):
    return k[i] + 1.0


def test_what_the_arm_tells_to_be_0_or_1_but_for_rounding_is_multiplied_by_and_added_nowhere(
    tmp_path,
):
    unit = TranslationUnit("t")
    entry = unit.instance(
        about_axis, [unit.table("arm", AXIS), Argument(CRow(6)), Argument(CRow(16))]
    )
    assert entry is not None
    text = unit.text([entry])
    for line in (
        "return (t_d3){{-b.v[1], b.v[0], 0.0}};",
        "out[0] = across.v[0];",
        "out[1] = -across.v[1];",
        "out[2] = 0.0;",
        "out[3] = a[3];",
        "out[4] = 2.0 + a[5];",
        "out[6] = -(-a[4]);",
        # beyond that rounding they stay
        "out[5] = 3e-16 * a[0] + 1.0000000000000004 * a[1];",
    ):
        assert f"    {line}\n" in text
    # nor is a function called of which nothing is needed, or all is told
    assert "unread" not in text
    assert "_known" not in text
    head = "void run_about_axis(double *a, double *out)"
    whole = f"#include <math.h>\n{text}\n{head};\n{head}\n{{\n    {entry.name}(a, out);\n}}\n"
    compiled = library(tmp_path, whole)
    for a in np.random.default_rng(3).normal(size=(20, 6)):
        out = np.zeros(16)
        about_axis(AXIS, a, out)
        # a number of 2^-52 is left out, of three that are 6 at most
        np.testing.assert_allclose(run(compiled, about_axis, a.tolist()), out, rtol=0, atol=4e-15)


@pytest.mark.parametrize(("shape", "kind"), [((2, 3), CTable(2, 3)), ((4,), CRow(4))])
def test_a_table_knows_its_size(shape, kind):
    assert TranslationUnit("t").table("x", np.zeros(shape)).type == kind
