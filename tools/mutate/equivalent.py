"""The mutants that no test can catch, because they do what the module does: a list kept by hand,
each with its reason.

An entry names the file, the function (may be left out at module level), the line as it is, and the
lines that it may become; no line numbers, so that an edit elsewhere leaves the list as it is. The
list of each room lies in equivalent/<room>.toml.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

from .mutants import Mutant

FILES = sorted((Path(__file__).parent / "equivalent").glob("*.toml"))


@dataclass(frozen=True)
class Entry:
    """One mutant of the list."""

    path: str
    definition: str
    old: str
    new: str
    reason: str


def entries(text: str | None = None) -> list[Entry]:
    """The list, read; KeyError or ValueError for what is left out or empty."""
    data = tomllib.loads(
        "\n".join(file.read_text(encoding="utf-8") for file in FILES) if text is None else text
    )
    found = []
    for block in data.get("equivalent", []):
        if not block["reason"].strip() or not block["becomes"]:
            raise ValueError(
                f"{block['file']}: an entry without a reason, or without a mutant: {block['line']}"
            )
        for new in block["becomes"]:
            found.append(
                Entry(
                    block["file"],
                    block.get("function", ""),
                    block["line"],
                    new,
                    block["reason"].strip(),
                )
            )
    if len({(e.path, e.definition, e.old, e.new) for e in found}) < len(found):
        raise ValueError("a mutant is listed twice")
    return found


def listed(mutants: list[Mutant], known: list[Entry]) -> tuple[dict[str, str], list[Entry]]:
    """Key to reason of the mutants on the list, and the entries that are no mutant: stale, or
    misspelt.
    """
    reasons = {(e.path, e.definition, e.old, e.new): e for e in known}
    found, used = {}, set()
    for m in mutants:
        entry = reasons.get((m.path, m.definition, m.old, m.new))
        if entry is not None:
            found[m.key] = entry.reason
            used.add(entry)
    return found, [e for e in known if e not in used]
