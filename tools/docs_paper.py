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
        "| in the paper | formula | used by | test |",
        "|---|---|---|---|",
    ]
    for row in PAPER:
        equation = row.equation.replace("|", "\\|")
        calls = [f"pk.{row.user}"] * bool(row.user) + [f"Chain.{row.method}"] * bool(row.method)
        called = "<br>".join(map(_code, calls)) or "–"
        place, _, test = row.test.rpartition("/")
        held = f"`tests/{place}`<br>`{test}`" if place else f"`tests/{test}`"
        lines.append(f"| {row.paper}<br>`{equation}` | `{row.formula}` | {called} | {held} |")
    return "\n".join(lines) + "\n"
