"""Program that compares an emitted C source with numbers of the chain's general kernels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .messages import EmittedFunction
from .statements import WriteNumber, double
from .vectors import Vectors

TEXT = """/*
 * Tests {word}.c: compile both, link with the mathematical library, run. It prints the worst error and the error
 * allowed, which is {tolerance} (1, m or m per rad), and exits with 0 if that is kept, else with 1.
 */
#include "{word}.h"

#include <math.h>
#include <stdio.h>

#define VECTORS {count}
#define ALLOWED {tolerance}

static const {real} Q[VECTORS][{width}] = {{
{q}
}};
static const double T_EXPECTED[VECTORS][16] = {{
{T}
}};
static const double J_EXPECTED[VECTORS][{columns}] = {{
{J}
}};

static double worst = 0.0;
static int failed = 0;

static void compare(const {real} *got, const double *expected, int count)
{{
    int k;
    for (k = 0; k < count; k++) {{
        const double error = fabs((double)got[k] - expected[k]);
        if (!(error <= ALLOWED)) {{
            failed = 1;
        }}
        if (error > worst) {{
            worst = error;
        }}
    }}
}}

int main(void)
{{
    {real} T[16], J[{columns}];
    int i;
    for (i = 0; i < VECTORS; i++) {{
{calls}
    }}
    printf("{word}: worst error %.3g, allowed %.3g: %s\\n", worst, ALLOWED, failed ? "FAILED" : "passed");
    return failed;
}}
"""


def selftest(
    word: str,
    real: str,
    literal: WriteNumber,
    tasks: Sequence[EmittedFunction],
    wanted: Vectors,
) -> str:
    """The text of the program."""
    dof = wanted.q.shape[1]
    return TEXT.format(
        word=word,
        real=real,
        count=len(wanted.q),
        width=max(dof, 1),
        columns=max(6 * dof, 1),
        tolerance=f"{wanted.tolerance:.3g}",
        q=table_rows(wanted.q, literal),
        T=table_rows(wanted.T),
        J=table_rows(wanted.J),
        calls="\n".join(line for task in tasks for line in _calls(word, task)),
    )


def _calls(word: str, task: EmittedFunction) -> list[str]:
    return [
        f"        {word}_{task.name}(Q[i]{task.arguments});",
        *(f"        compare({r}, {r}_EXPECTED[i], {task.sizes[r]});" for r in task.results),
    ]


def table_rows(values: np.ndarray, literal: WriteNumber = double) -> str:
    """Rows of an array in C."""
    rows = [row.ravel().tolist() or [0.0] for row in values]  # C has no empty arrays
    return ",\n".join("    {" + ", ".join(map(literal, row)) + "}" for row in rows)
