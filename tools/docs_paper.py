"""The paper's lemmas and equations as a table for the pages: where each stands in poekin, read out of
`poekin.formulas`.
"""

from __future__ import annotations

from poekin.formulas import PAPER


def _code(name: str) -> str:
    return f"`{name}`" if name else "–"


def page() -> str:
    """Markdown: one row a lemma or equation."""
    lines = [
        "| in the paper | equation | formula | yours | method of `Chain` | test |",
        "|---|---|---|---|---|---|",
    ]
    for row in PAPER:
        equation = row.equation.replace("|", "\\|")
        user = _code(row.user and f"pk.{row.user}")
        method = _code(row.method)
        test = _code(f"tests/{row.test}")
        lines.append(
            f"| {row.paper} | `{equation}` | `{row.formula}` | {user} | {method} | {test} |"
        )
    return "\n".join(lines) + "\n"
