"""exp, log and the Jacobians of exp against 60 digits, through the package's own accuracy battery."""

from __future__ import annotations

from poekin.testing.oracles import exact

from ..accuracy.worst_errors import worst_errors
from ..report import Figure, Table, Topic


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    rows = worst_errors(samples=100 if quick else 600)
    say(f"{len(rows)} rows, {sum(row.cases for row in rows)} cases")
    return Topic(
        "Accuracy of exp, log and the Jacobians of exp",
        "Angles from 0 and 1e-150 through π, for exp and its Jacobians to 10, on a grid across every switch of the "
        f"formulas and at random; lengths independent of them. The truth has {exact.DIGITS} digits. exp and log: error "
        "÷ what float64 can attain, that is the rounding of input and output carried through the exact derivative. A "
        "NaN counts as an infinite error, and an exception or a floating-point warning would have ended this run.",
        figures=[
            Figure(
                row.what,
                row.error,
                row.bar,
                holds=row.passed,
                note=f"{row.cases} cases",
                unit=_unit(row.what),
            )
            for row in rows
        ],
        tables=[
            Table(
                "Worst cases",
                ("what", "argument"),
                [(row.what, _flat(row.worst)) for row in rows],
                folded=True,
            )
        ],
    )


def _unit(what: str) -> str:
    return "rad" if "sign" in what or "noisy" in what else ""


def _flat(argument) -> str:  # type: ignore[no-untyped-def]
    return " ".join(f"{x!r}" for x in argument.ravel().tolist())
