"""The report as one HTML page that needs nothing else, as Markdown, and as JSON. Every text is
escaped.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from html import escape as html_escape
from pathlib import Path
from string import Template
from typing import Any

from .report import Figure, Table, Topic, short


def plain(text: str) -> str:
    """Text without characters that a terminal or a browser would obey instead of showing; line
    breaks stay.
    """
    return "".join(
        c if c.isprintable() or c == "\n" else c.encode("unicode_escape").decode() for c in text
    )


def escape(text: str) -> str:
    """Text as HTML."""
    return html_escape(plain(text))


VERDICT = {True: "holds", False: "MISSED", None: ""}


def html(topics: Sequence[Topic], machine: dict[str, Any], seconds: float) -> str:
    """The page, out of `page.html` beside this file."""
    template = Template(Path(__file__).with_name("page.html").read_text(encoding="utf-8"))
    return template.substitute(
        summary=escape(summary(topics)),
        machine=_definitions(machine, seconds),
        all_figures=_figures(
            [f for t in topics for f in t.figures if f.verdict is not None], notes=False
        ),
        contents="".join(
            f'<li><a href="#{i}">{escape(t.title)}</a></li>' for i, t in enumerate(topics, 1)
        ),
        topics="\n".join(_topic(i, t) for i, t in enumerate(topics, 1)),
    )


def markdown(topics: Sequence[Topic], machine: dict[str, Any], seconds: float) -> str:
    """The same without pictures."""
    parts = ["# poekin: report", summary(topics), _machine_line(machine, seconds)]
    barred = [f for t in topics for f in t.figures if f.verdict is not None]
    parts.append(_grid(HEADS, [_cells(f) for f in barred]))
    for topic in topics:
        parts += [f"## {topic.title}", topic.text, topic.failure and f"```\n{topic.failure}\n```"]
        loose = [f for f in topic.figures if f.verdict is None]
        parts.append(_grid(HEADS, [_cells(f) for f in loose]) if loose else "")
        for table in topic.tables:
            parts += [
                f"**{table.caption}**",
                _grid(table.columns, [[_text(c) for c in r] for r in table.rows]),
            ]
    return plain("\n\n".join(part for part in parts if part)) + "\n"


def results(topics: Sequence[Topic], machine: dict[str, Any], seconds: float) -> str:
    """Everything measured as JSON text."""
    document = {"machine": machine, "seconds": round(seconds, 1), "topics": []}
    for topic in topics:
        plain = asdict(topic)
        plain.pop("pictures")
        plain["figures"] = [asdict(f) | {"verdict": f.verdict} for f in topic.figures]
        document["topics"].append(plain)
    return json.dumps(_finite(document), indent=1, allow_nan=False, ensure_ascii=False)


def summary(topics: Sequence[Topic]) -> str:
    """One sentence: how many bars hold."""
    verdicts = [f.verdict for t in topics for f in t.figures if f.verdict is not None]
    broken = [t.title for t in topics if t.failure]
    text = f"{sum(verdicts)} of {len(verdicts)} bars hold."
    return text + (f" These topics broke off: {', '.join(broken)}." if broken else "")


def plain_table(topics: Sequence[Topic]) -> str:
    """The figures that have a bar, as text for a terminal."""
    rows = [
        [*_cells(f)[:3], VERDICT[f.verdict]]
        for t in topics
        for f in t.figures
        if f.verdict is not None
    ]
    rows = [["what", "figure", "bar", ""], *rows]
    widths = [max(len(r[i]) for r in rows) for i in range(4)]
    return plain(
        "\n".join(
            "  ".join(c.ljust(w) for c, w in zip(r, widths, strict=True)).rstrip() for r in rows
        )
    )


HEADS = ("what", "figure", "bar", "quartiles", "error in the same run", "", "note")


def _cells(f: Figure) -> list[str]:
    quartiles = "" if f.spread is None else f"{short(f.spread[0])} – {short(f.spread[1])}"
    return [f.what, f.text, f.bar_text, quartiles, f.error, VERDICT[f.verdict], f.note]


def _figures(figures: Sequence[Figure], *, notes: bool = True) -> str:
    """Figures as a table without the columns that would be empty."""
    if not figures:
        return ""
    filled = [_cells(f) for f in figures]
    keep = [
        i
        for i, head in enumerate(HEADS)
        if any(row[i] for row in filled) and (notes or head != "note")
    ]
    head = "".join(f'<th class="{_kind(i)}">{escape(HEADS[i])}</th>' for i in keep)
    body = ""
    for figure, row in zip(figures, filled, strict=True):
        kind = ' class="missed"' if figure.verdict is False else ""
        cells = "".join(f'<td class="{_kind(i)}">{escape(row[i])}</td>' for i in keep)
        body += f"<tr{kind}>{cells}</tr>\n"
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>'


def _kind(column: int) -> str:
    return ("word", "number", "number", "number", "error", "verdict", "note")[column]


def _topic(number: int, topic: Topic) -> str:
    parts = [f'<section id="{number}"><h2>{escape(topic.title)}</h2>']
    parts += [f"<p>{escape(paragraph)}</p>" for paragraph in topic.text.split("\n\n") if paragraph]
    if topic.failure:
        parts.append(
            f'<p class="broken">This topic broke off:</p><pre>{escape(topic.failure)}</pre>'
        )
    parts.append(_figures(topic.figures))
    for picture in topic.pictures:
        parts.append(
            f"<figure>{picture.svg}<figcaption>{escape(picture.caption)}</figcaption></figure>"
        )
    parts += [_table(t) for t in topic.tables]
    return "\n".join(part for part in parts if part) + "</section>"


def _table(table: Table) -> str:
    # Numbers that were not measured are empty, and leave a column one of numbers.
    numeric = [
        not any(isinstance(row[i], str) and row[i] for row in table.rows)
        for i in range(len(table.columns))
    ]
    heads = zip(table.columns, numeric, strict=True)
    head = "".join(
        f'<th class="{"number" if right else "word"}">{escape(c)}</th>' for c, right in heads
    )
    body = ""
    for row in table.rows:
        kinds = (
            "number" if right or not isinstance(c, str) else "word"
            for c, right in zip(row, numeric, strict=True)
        )
        cells = (
            f'<td class="{kind}">{escape(_text(c))}</td>'
            for c, kind in zip(row, kinds, strict=True)
        )
        body += f"<tr>{''.join(cells)}</tr>\n"
    inner = f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>'
    caption = escape(table.caption)
    if table.folded:
        return f"<details><summary>{caption} ({len(table.rows)} rows)</summary>{inner}</details>"
    return f'<p class="caption">{caption}</p>{inner}'


def _definitions(machine: dict[str, Any], seconds: float) -> str:
    items = [(k, v) for k, v in machine.items() if k != "versions"] + [("took", f"{seconds:.0f} s")]
    items += list(machine["versions"].items())
    return "".join(
        f"<div><dt>{escape(str(k))}</dt><dd>{escape(str(v))}</dd></div>" for k, v in items
    )


def _machine_line(machine: dict[str, Any], seconds: float) -> str:
    versions = ", ".join(f"{k} {v}" for k, v in machine["versions"].items())
    return (
        f"{machine['when']}, commit {machine['commit']}, {machine['processor']} ({machine['cores']} cores, load "
        f"{machine['load']}), {machine['system']}, Python {machine['python']}, {versions}; took {seconds:.0f} s."
    )


def _grid(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    def line(cells: Iterable[str]) -> str:
        # Backslashes and bars would end a cell, angle brackets would be HTML.
        safe = (
            c.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;").replace("\n", " ")
            for c in cells
        )
        return "| " + " | ".join(safe) + " |"

    return "\n".join([line(heads), "|" + "---|" * len(heads), *map(line, rows)])


def _text(cell: str | float) -> str:
    return cell if isinstance(cell, str) else short(cell)


def _finite(item: Any) -> Any:
    if isinstance(item, dict):
        return {k: _finite(v) for k, v in item.items()}
    if isinstance(item, (list, tuple)):
        return [_finite(v) for v in item]
    return None if isinstance(item, float) and not math.isfinite(item) else item
