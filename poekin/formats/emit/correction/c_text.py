"""The correction of readings as C99: a header, a source, and a program that tests them."""

from __future__ import annotations

from ..assignments import comment
from ..c import HEADER, CSource
from ..c_selftest import table_rows
from .correction import Correction, assignments

ALLOWED = 1e-12
"""Error (rad or m) that the self-test allows."""

SELFTEST = """/*
 * Tests {word}.c: compile both, link with the mathematical library, run. It prints the worst error and the error
 * allowed, {allowed:g} (rad or m), and exits with 0 if that is kept, else with 1.
 */
#include "{word}.h"

#include <math.h>
#include <stdio.h>

#define VECTORS {count}

static const double Q[VECTORS][{dof}] = {{
{q}
}};
{tables}static const double EXPECTED[VECTORS][{dof}] = {{
{expected}
}};

int main(void)
{{
    double worst = 0.0;
    int i, k, failed = 0;
    for (i = 0; i < VECTORS; i++) {{
        double x[{dof}];
        {word}(Q[i], {argument}x);
        for (k = 0; k < {dof}; k++) {{
            const double error = fabs(x[k] - EXPECTED[i][k]);
            if (!(error <= {allowed:g})) {{
                failed = 1;
            }}
            if (error > worst) {{
                worst = error;
            }}
        }}
    }}
    printf("{word}: worst error %.3g, allowed {allowed:g}: %s\\n", worst, failed ? "FAILED" : "passed");
    return failed;
}}
"""


def c_text(correction: Correction, word: str, origin: str) -> CSource:
    """C99 of a correction in double, of names that begin with `word`."""
    word = f"{word}_true_joints"
    conditions = "const double *conditions, " if correction.conditions else ""
    head = f"void {word}(const double *q, {conditions}double *q_true)"
    said = comment([
        f"{word}: true joint values of readings, as C99. Generated: change the calibration instead.",
        *correction.lines(origin),
    ])  # fmt: skip
    pairs = assignments(correction, "sin", "cos", "{}[{}]")
    outputs = enumerate(correction.statements.outputs)
    body = [f"    const double {variable} = {text};" for variable, text in pairs]
    body += [f"    q_true[{k}] = {text};" for k, text in outputs]
    declaration = f"/* q_true may be q. */\n{head};\n"
    guard = f"{word.upper()}_H_INCLUDED"
    lines = [said, f'#include "{word}.h"\n\n#include <math.h>\n', head, "{", *body, "}", ""]
    header = HEADER.format(comment=said, guard=guard, declarations=declaration)
    return CSource(word, header, "\n".join(lines), _selftest(word, correction))


def _selftest(word: str, correction: Correction) -> str:
    tables = ""
    argument = ""
    if correction.conditions:
        width = len(correction.conditions)
        rows = table_rows(correction.given)
        tables = f"static const double CONDITIONS[VECTORS][{width}] = {{\n{rows}\n}};\n"
        argument = "CONDITIONS[i], "
    return SELFTEST.format(
        word=word,
        allowed=ALLOWED,
        count=len(correction.q),
        dof=correction.chain.dof,
        q=table_rows(correction.q),
        tables=tables,
        argument=argument,
        expected=table_rows(correction.expected),
    )
