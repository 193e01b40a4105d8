"""Lines of C: where branches, loops and declarations stand, and what their names are."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.engine.transpile.c_types import CRow, CTable
from poekin.engine.transpile.translation_unit import TranslationUnit
from poekin.engine.transpile.values import Argument
from poekin.errors import InputError


def branches(a, out):
    if a[0] > 1.0:
        out[0] = 1.0
    elif a[0] > 0.5:
        out[0] = 2.0
    elif a[0] > 0.25:
        if a[1] > 0.0:
            out[0] = 3.0
        else:
            out[0] = 4.0
    else:
        if a[1] > 0.0:
            out[0] = 5.0
        out[1] = 6.0
    if a[2] > 0.0:
        out[2] = 7.0
    else:
        out[2] = 8.0
        if a[3] > 0.0:
            out[3] = 9.0


BRANCHES = """
    if (a[0] > 1.0) {
        out[0] = 1.0;
    } else if (a[0] > 0.5) {
        out[0] = 2.0;
    } else if (a[0] > 0.25) {
        if (a[1] > 0.0) {
            out[0] = 3.0;
        } else {
            out[0] = 4.0;
        }
    } else {
        if (a[1] > 0.0) {
            out[0] = 5.0;
        }
        out[1] = 6.0;
    }
    if (a[2] > 0.0) {
        out[2] = 7.0;
    } else {
        out[2] = 8.0;
        if (a[3] > 0.0) {
            out[3] = 9.0;
        }
    }
"""


def branches_in_loops(a, out):
    for i in range(2):
        if a[i] > 1.0:
            out[i] = 1.0
        elif a[i] > 0.0:
            out[i] = 2.0
        else:
            for j in range(1, 6, 2):
                out[j] = a[j]
    for i in range(5, 0, -1):
        out[i] = 0.0
    for _ in range(3):
        out[0] = out[0] + 1.0
    for N in range(4, 0, -3):
        out[N] = 1.0


BRANCHES_IN_LOOPS = """
    for (int i = 0; i < 2; i++) {
        if (a[i] > 1.0) {
            out[i] = 1.0;
        } else if (a[i] > 0.0) {
            out[i] = 2.0;
        } else {
            for (int j = 1; j < 6; j += 2) {
                out[j] = a[j];
            }
        }
    }
    for (int i = 5; i > 0; i--) {
        out[i] = 0.0;
    }
    for (int k1 = 0; k1 < 3; k1++) {
        out[0] = out[0] + 1.0;
    }
    for (int N = 4; N > 0; N += -3) {
        out[N] = 1.0;
    }
"""


def names(a, out):
    sin = a[0]
    part = a[2:5]
    near = part[1:]
    if a[0] > 0.0:
        x = 1.0
    else:
        x = a[1]
    total = 0.0
    for k1 in range(2):
        total = total + near[k1]
    for _ in range(2):
        total += x
    unused = a[5]  # noqa: F841
    first, _ = a[0], a[1]
    out[int(a[0])] = sin * total + part[0] + near[1] + first


NAMES = """
    double x;
    const double sin_ = a[0];
    const double *const part = a + 2;
    const double *const near = part + 1;
    if (a[0] > 0.0) {
        x = 1.0;
    } else {
        x = a[1];
    }
    double total = 0.0;
    for (int k1 = 0; k1 < 2; k1++) {
        total = total + near[k1];
    }
    for (int k2 = 0; k2 < 2; k2++) {
        total = total + x;
    }
    const double t3 = a[0];
    const double first = t3;
    out[(int)a[0]] = sin_ * total + part[0] + near[1] + first;
"""


def whiles(a, out):
    x = a[0]
    n = 0
    while x > 1.0 and n < 9:
        x = 0.5 * x
        n += 1
    while True:
        n += 1
        if n > 20:
            break
    while 0.0 < square(x) < 0.5:
        x = 2.0 * x
    out[0] = x
    out[1] = n


def square(x):
    return x * x


WHILES = """
    double x = a[0];
    int n = 0;
    while (x > 1.0 && n < 9) {
        x = 0.5 * x;
        n = n + 1;
    }
    for (;;) {
        n = n + 1;
        if (n > 20) {
            break;
        }
    }
    for (;;) {
        const double t1 = t_test_layout_square(x);
        if (!(0.0 < t1 && t1 < 0.5)) {
            break;
        }
        x = 2.0 * x;
    }
    out[0] = x;
    out[1] = (double)n;
"""


def tuples(a, out):
    at = 0
    for x in (a[0], a[1]):
        out[at] = x
        at += 1
    pairs = ((a[0], a[1]), (a[2], a[3]))
    for pair in pairs:
        if pair[0] > 0.0:
            continue
        out[at] = pair[1]
    i = int(a[4])
    out[5] = pairs[i][1]
    out[-1] = pairs[-1][0]


TUPLES = """
    int at = 0;
    {
        const double x = a[0];
        out[at] = x;
        at = at + 1;
    }
    {
        const double x = a[1];
        out[at] = x;
        at = at + 1;
    }
    const t_d2x2 pairs = {{{{a[0], a[1]}}, {{a[2], a[3]}}}};
    for (int k1 = 0; k1 < 2; k1++) {
        const t_d2 pair = pairs.v[k1];
        if (pair.v[0] > 0.0) {
            continue;
        }
        out[at] = pair.v[1];
    }
    const int i = (int)a[4];
    out[5] = pairs.v[i].v[1];
    out[5] = pairs.v[1].v[0];
"""


def slices(a, out):
    p, q = a[:2]
    r, s = a[2:4]
    out[0] = p * q - r * s
    out[1] = first_of(a[0:]) + first_of(a[1:][2:]) - first_of(a[-2:])
    i = int(a[0])
    out[2] = a[2:][1] + a[2:][0] + a[2:][i] + a[2:][-1] + a[i] + a[-6]


def first_of(row):
    return row[0]


SLICES = """
    const double p = a[0];
    const double q = a[1];
    const double r = (a + 2)[0];
    const double s = (a + 2)[1];
    out[0] = p * q - r * s;
    out[1] = t_test_layout_first_of(a) + t_test_layout_first_of_2(a + 3) - t_test_layout_first_of_3(a + 4);
    const int i = (int)a[0];
    out[2] = a[3] + a[2] + a[2 + i] + a[5] + a[i] + a[0];
"""


def constants(a, out):
    half = 0.5
    n = 2
    pair = (a[0], a[1])
    p, q = pair  # noqa: RUF059
    out[n] = half * a[n] + len(pair)
    out[n + 1] = 2 * half - (1 if n > 1 else a[3])
    if n == 3:
        out[0] = a[0]
    elif n == 2:
        out[1] = a[1]


CONSTANTS = """
    const double half = 0.5;
    const t_d2 pair = {{a[0], a[1]}};
    out[2] = half * a[2] + 2.0;
    out[3] = 2.0 * half - 1.0;
    out[1] = a[1];
"""


def ends(a, out):
    i = int(a[0])
    j = int(a[1])
    out[0] = max(i, j)
    out[1] = min(i, j + 1)
    out[2] = max(i, 2, a[2])
    out[3] = twice(3, a[0]) + twice(i, a[1])


def twice(n, x):
    return n * x


ENDS = """
    const int i = (int)a[0];
    const int j = (int)a[1];
    out[0] = (double)(j > i ? j : i);
    const int t1 = j + 1;
    out[1] = (double)(t1 < i ? t1 : i);
    out[2] = t_max((double)(2 > i ? 2 : i), a[2]);
    out[3] = t_test_layout_twice(a[0]) + t_test_layout_twice_2(i, a[1]);
"""


def of_a_table(M, out):
    row = M[1]
    last = M[-1]
    i = int(M[0][0])
    out[0] = row[2] + M[0][1] + M[2, 1] + M[1:][1][2] + last[-1]
    out[1] = M[i][2] + M[i, 0] + M[2][i]
    n, m = M.shape
    out[2] = n + m * len(M) + len(row) + out.shape[0]
    for j in range(len(M)):
        out[j] = M[j][j] + M[:2][j][0]


OF_A_TABLE = """
    const double *const row = M + 3;
    const double *const last = M + 6;
    const int i = (int)M[0];
    out[0] = row[2] + M[1] + M[7] + M[8] + last[2];
    out[1] = M[3 * i + 2] + M[3 * i] + M[6 + i];
    out[2] = 21.0;
    for (int j = 0; j < 3; j++) {
        out[j] = M[3 * j + j] + M[3 * j];
    }
"""

LAYOUTS = {
    slices: SLICES,
    ends: ENDS,
    constants: CONSTANTS,
    branches: BRANCHES,
    branches_in_loops: BRANCHES_IN_LOOPS,
    names: NAMES,
    whiles: WHILES,
    tuples: TUPLES,
}


def test_rows_of_a_table_are_pointers_into_it():
    entry = TranslationUnit("t").instance(of_a_table, [Argument(CTable(3, 3)), Argument(CRow(6))])
    assert entry is not None
    head = "static inline void t_test_layout_of_a_table(const double *M, double *out)"
    assert entry.text == f"{head}\n{{{OF_A_TABLE}}}"


def of_an_arm(arm, a, out):
    minus, two, none = arm[0], arm[1], arm[2]
    i = int(a[0])
    out[0] = minus * (a[0] + a[1])
    out[1] = (a[0] - a[1]) * minus
    out[2] = (a[0] + a[1]) / minus
    out[3] = two + a[0]
    out[4] = two - a[0]
    out[5] = a[0] - two * a[1]
    out[0] = none - (a[0] + a[1])
    out[1] = a[0] - none
    out[2] = none * a[0] + a[1]
    out[3] = 3.0 + 0.0
    out[4] = 1.0 if i in (2, 5) else 0.0
    out[5] = 1.0 if not not a[0] > 1.0 else 0.0  # noqa: SIM208


OF_AN_ARM = """
    const int i = (int)a[0];
    out[0] = -(a[0] + a[1]);
    out[1] = -(a[0] - a[1]);
    out[2] = -(a[0] + a[1]);
    out[3] = -2.0 + a[0];
    out[4] = -2.0 - a[0];
    out[5] = a[0] - -2.0 * a[1];
    out[0] = -(a[0] + a[1]);
    out[1] = a[0];
    out[2] = a[1];
    out[3] = 3.0;
    out[4] = i == 2 || i == 5 ? 1.0 : 0.0;
    out[5] = !(!(a[0] > 1.0)) ? 1.0 : 0.0;
"""


def test_numbers_of_an_arm_that_are_1_or_0_but_for_their_sign_are_not_multiplied_by():
    unit = TranslationUnit("t")
    arm = unit.table("arm", np.array([-1.0, -2.0, 0.0]))
    entry = unit.instance(of_an_arm, [arm, Argument(CRow(6)), Argument(CRow(6))])
    assert entry is not None
    head = "static inline void t_test_layout_of_an_arm(const double *a, double *out)"
    assert entry.text == f"{head}\n{{{OF_AN_ARM}}}"


def writes(row, x):
    row[0] = x


def writes_to_an_arm(arm, a, out):
    writes(arm, a[0])


def test_what_an_arm_tells_is_not_written_to():
    unit = TranslationUnit("t")
    given = [unit.table("arm", np.ones(3)), Argument(CRow(6)), Argument(CRow(6))]
    with pytest.raises(InputError, match="transpile: writing to "):
        unit.instance(writes_to_an_arm, given)


@pytest.mark.parametrize("function", LAYOUTS, ids=lambda f: f.__name__)
def test_c_is_laid_out_as_by_hand(function):
    entry = TranslationUnit("t").instance(function, [Argument(CRow(6)), Argument(CRow(6))])
    assert entry is not None
    head = f"static inline void t_test_layout_{function.__name__}(const double *a, double *out)"
    assert entry.text == f"{head}\n{{{LAYOUTS[function]}}}"
