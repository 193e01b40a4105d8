"""The report as one HTML page that needs nothing else, as Markdown, and as JSON. Every text is
escaped.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from typing import Any

from poekin import html_page
from poekin.errors import escape_unprintable
from poekin.html_page import element, paragraph, text

from .report import Figure, Table, Topic, short


def plain(words: str) -> str:
    """Text without characters that a terminal or a browser would obey instead of showing; line
    breaks stay.
    """
    return escape_unprintable(words, keep="\n")


VERDICT = {True: "holds", False: "MISSED", None: ""}


STYLE = """body { max-width: 84rem; display: grid; grid-template-columns: 15rem minmax(0, 64rem); gap: 0 2.5rem; }
h1 { grid-column: 2; }
main { grid-column: 2; min-width: 0; }
nav { grid-column: 1; grid-row: 1 / span 3; position: sticky; top: 1rem; align-self: start; max-height: 96vh;
  overflow-y: auto; font-size: .8rem; line-height: 1.3; }
nav ol { list-style: none; margin: .2rem 0 .8rem; padding: 0; }
nav li { margin: .25rem 0; overflow-wrap: anywhere; }
h2 { margin-top: 2.75rem; }
h2.section { font-size: 1.6rem; }
h3 { margin: 2rem 0 .25rem; }
dl { display: grid; grid-template-columns: repeat(auto-fill, minmax(13rem, 1fr)); gap: .35rem 1.25rem;
  margin: 1rem 0; padding: .75rem 1rem; border: 1px solid #bbb; font-size: .85rem; }
dl div { min-width: 0; }
dt { color: #555; }
dd { margin: 0; font-weight: 600; overflow-wrap: anywhere; }
a { color: inherit; }
input { font: inherit; padding: .2rem .4rem; width: min(24rem, 100%); }
.wide td:first-child { min-width: 15rem; }
td.error { min-width: 11rem; }
td.verdict { font-weight: 600; white-space: nowrap; }
td.note { color: #444; font-size: .82rem; }
tr.missed td { background: #eee; font-weight: 700; }
figcaption { margin-top: 1rem; }
pre { overflow-x: auto; background: #f3f3f3; padding: .75rem; font-size: .8rem; }
.broken { font-weight: 700; }
@media (max-width: 60rem) {
  body { display: block; max-width: 64rem; }
  nav { position: static; max-height: none; columns: 2; }
}
@media (max-width: 40rem) { nav { columns: 1; } }
"""


QUESTIONS = {
    "exact": "How exact, and beside whom?",
    "fast": "How fast, and beside whom?",
    "cost": "What does it cost?",
    "solve": "How does it solve and calibrate?",
}
"""What the pictures at the top of the page answer (`Picture.answers`)."""

SEARCH = """<p><label>Search the bars <input type="search" id="find" placeholder="exp, Pinocchio, MISSED …"></label></p>
<script>
document.getElementById("find").addEventListener("input", (event) => {
  const words = event.target.value.toLowerCase().split(/\\s+/);
  for (const row of document.querySelectorAll("#bars tbody tr")) {
    const text = row.textContent.toLowerCase();
    row.hidden = !words.every((word) => text.includes(word));
  }
});
</script>"""
AGAIN = "<script>setTimeout(() => location.reload(), 20000);</script>"
"""While topics are being measured the page is read again every twenty seconds."""


def html(topics: Sequence[Topic], machine: dict[str, Any], seconds: float, left: int = 0) -> str:
    """The page, in the looks of poekin's own; left: topics that are still being measured."""
    parts = [
        _navigation(topics),
        "<main>",
        paragraph(_place(machine, seconds), "caption"),
        paragraph(summary(topics), "lead"),
        *([paragraph(_unfinished(left), "broken"), AGAIN] if left else []),
        *_answers(topics),
        *_sections(topics),
        '<section id="bars">' + element("h2", "All bars"),
        html_page.details(
            "The figures that have a bar", SEARCH + _figures(_barred(topics), notes=False)
        ),
        html_page.details("Machine and versions", element("dl", _definitions(machine, seconds))),
        "</section></main>",
    ]
    return html_page.page("poekin: report", parts, STYLE)


def _place(machine: dict[str, Any], seconds: float) -> str:
    """Where and when it was measured, in a line."""
    return (
        f"{machine['processor']}, {machine['cores']} cores, Python {machine['python']}, "
        f"{machine['when']}, commit {machine['commit']}; took {seconds / 60:.0f} min"
    )


def _unfinished(left: int) -> str:
    return (
        f"{left} topics are still being measured: this page renews itself, and what is marked as a "
        "quick look is measured again with all samples."
    )


def _answers(topics: Sequence[Topic]) -> list[str]:
    """The questions with the pictures that answer them."""
    parts = []
    for key, question in QUESTIONS.items():
        drawn = [
            html_page.figure(picture.svg, picture.caption + _look(topic))
            for topic in topics
            for picture in topic.pictures
            if picture.answers == key
        ]
        if drawn:
            parts += [element("h2", text(question)), *drawn]
    return parts


def _look(topic: Topic) -> str:
    return " (a quick look)" if topic.quick else ""


def _by_section(topics: Sequence[Topic]) -> dict[str, list[Topic]]:
    """Topics under their section, in the order of the first of each."""
    found: dict[str, list[Topic]] = {}
    for topic in topics:
        found.setdefault(topic.section or "Report", []).append(topic)
    return found


def _navigation(topics: Sequence[Topic]) -> str:
    """Links to the topics by section, beside the page where it is wide enough."""
    parts = []
    for section, of_section in _by_section(topics).items():
        links = (f'<li><a href="#{_anchor(t)}">{text(t.title)}</a></li>' for t in of_section)
        parts.append(element("strong", text(section)) + element("ol", "".join(links)))
    parts.append('<strong><a href="#bars">All bars</a></strong>')
    return element("nav", "".join(parts))


def _anchor(topic: Topic) -> str:
    return text(topic.name or topic.title).replace(" ", "-")


def _sections(topics: Sequence[Topic]) -> list[str]:
    parts = []
    for section, of_section in _by_section(topics).items():
        parts.append(element("h2", text(section), "section"))
        parts += [_topic(topic) for topic in of_section]
    return parts


def _barred(topics: Sequence[Topic]) -> list[Figure]:
    return [f for t in topics for f in t.figures if f.verdict is not None]


def markdown(
    topics: Sequence[Topic], machine: dict[str, Any], seconds: float, left: int = 0
) -> str:
    """The same without pictures."""
    parts = ["# poekin: report", _place(machine, seconds), summary(topics)]
    if left:
        parts.append(_unfinished(left))
    for section, of_section in _by_section(topics).items():
        parts.append(f"## {section}")
        for topic in of_section:
            parts += [
                f"### {topic.title}{_look(topic)}",
                topic.text,
                topic.failure and f"```\n{topic.failure}\n```",
            ]
            parts.append(_grid(HEADS, [_cells(f) for f in topic.figures]) if topic.figures else "")
            for table in topic.tables:
                parts += [
                    f"**{table.caption}**",
                    _grid(table.columns, [[_text(c) for c in r] for r in table.rows]),
                ]
    parts += ["## All bars", _grid(HEADS, [_cells(f) for f in _barred(topics)])]
    parts.append(_machine_line(machine, seconds))
    return plain("\n\n".join(part for part in parts if part)) + "\n"


def results(topics: Sequence[Topic], machine: dict[str, Any], seconds: float, left: int = 0) -> str:
    """Everything measured as JSON text."""
    document = {"machine": machine, "seconds": round(seconds, 1), "left": left, "topics": []}
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
KINDS = ("word", "number", "number", "number", "error", "verdict", "note")


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
    kinds = [KINDS[i] for i in keep]
    rows = []
    for figure, cells in zip(figures, filled, strict=True):
        kind = "missed" if figure.verdict is False else ""
        rows.append(html_page.row([cells[i] for i in keep], kinds, kind=kind))
    return html_page.table([HEADS[i] for i in keep], kinds, rows)


def _topic(topic: Topic) -> str:
    parts = [f'<section id="{_anchor(topic)}"><h3>{text(topic.title)}{_look(topic)}</h3>']
    parts += [paragraph(words) for words in topic.text.split("\n\n") if words]
    if topic.failure:
        parts.append(paragraph("This topic broke off:", "broken"))
        parts[-1] += element("pre", text(topic.failure))
    parts.append(_figures(topic.figures))
    pictures = [picture for picture in topic.pictures if not picture.answers]
    parts += [html_page.figure(picture.svg, picture.caption) for picture in pictures]
    parts += [_table(t) for t in topic.tables]
    return "\n".join(part for part in parts if part) + "</section>"


def _table(table: Table) -> str:
    # Numbers that were not measured are empty, and leave a column one of numbers.
    columns = range(len(table.columns))
    numeric = [not any(isinstance(r[i], str) and r[i] for r in table.rows) for i in columns]
    kinds = ["number" if right else "word" for right in numeric]
    rows = []
    for cells in table.rows:
        own = [
            kind if isinstance(c, str) else "number" for c, kind in zip(cells, kinds, strict=True)
        ]
        rows.append(html_page.row(map(_text, cells), own))
    inner = html_page.table(table.columns, kinds, rows)
    if table.folded:
        return html_page.details(f"{table.caption} ({len(table.rows)} rows)", inner)
    return html_page.caption(table.caption) + inner


def _definitions(machine: dict[str, Any], seconds: float) -> str:
    items = [(k, v) for k, v in machine.items() if k != "versions"] + [("took", f"{seconds:.0f} s")]
    items += list(machine["versions"].items())
    return "".join(f"<div><dt>{text(str(k))}</dt><dd>{text(str(v))}</dd></div>" for k, v in items)


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
