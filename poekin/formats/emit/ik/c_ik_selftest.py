"""Program that compares emitted inverse kinematics with solutions that Python finds."""

from __future__ import annotations

import numpy as np

from ....groups.arrays import Array
from ..c_selftest import table_rows
from ..statements import double
from .ik_vectors import TOLERANCE, Targets

TEXT = """/*
 * Tests {word}.c: compile both, link with the mathematical library, run. It prints the worst error of a
 * solution and the error allowed, {tolerance} (rad or m), and exits with 0 if that is kept and each target
 * has the solutions that it should have, else with 1.
 */
#include "{word}.h"

#include <math.h>
#include <stdio.h>

#define TARGETS {count}
#define ALLOWED {tolerance}

static const double T_GIVEN[TARGETS][16] = {{
{T}
}};
static const int COUNTS[TARGETS] = {{{counts}}};
/* Solutions, those of one target after those of another. */
static const double EXPECTED[{total}][{dof}] = {{
{q}
}};
/* A whole turn of each coordinate that is an angle, 0 of a length. */
static const double PERIODS[{dof}] = {{{periods}}};

/* Largest difference of two solutions, but for whole turns. */
static double apart(const double *a, const double *b)
{{
    double worst = 0.0;
    int i;
    for (i = 0; i < {dof}; i++) {{
        double error = fabs(a[i] - b[i]);
        if (fabs(error - PERIODS[i]) < error) {{
            error = fabs(error - PERIODS[i]);
        }}
        if (!(error <= worst)) {{
            worst = error;
        }}
    }}
    return worst;
}}

int main(void)
{{
    double q[{most}][{dof}], worst = 0.0;
    int failed = 0, first = 0, k, i, j;
    for (k = 0; k < TARGETS; k++) {{
        const int count = {word}(T_GIVEN[k], q);
        if (count != COUNTS[k]) {{
            failed = 1;
        }}
        for (i = first; i < first + COUNTS[k]; i++) {{
            double least = HUGE_VAL;
            for (j = 0; j < count; j++) {{
                const double error = apart(q[j], EXPECTED[i]);
                if (error < least) {{
                    least = error;
                }}
            }}
            if (!(least <= ALLOWED)) {{
                failed = 1;
            }}
            if (least > worst) {{
                worst = least;
            }}
        }}
        first += COUNTS[k];
    }}
    printf("{word}: worst error %.3g, allowed %.3g: %s\\n", worst, ALLOWED, failed ? "FAILED" : "passed");
    return failed;
}}
"""


def selftest(word: str, periods: Array, wanted: Targets) -> str:
    """The text of the program."""
    q = np.concatenate(wanted.solutions)
    return TEXT.format(
        word=word,
        most=f"{word.upper()}_MOST",
        tolerance=f"{TOLERANCE:.3g}",
        count=len(wanted.T),
        counts=", ".join(str(len(found)) for found in wanted.solutions),
        total=max(len(q), 1),
        dof=len(periods),
        T=table_rows(wanted.T),
        q=table_rows(q if len(q) else np.zeros((1, len(periods)))),
        periods=", ".join(map(double, periods.tolist())),
    )
