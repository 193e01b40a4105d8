"""Parts of an HTML page that needs nothing else: no scripts, nothing fetched, every text escaped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from string import Template

from .errors import escape_unprintable

_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
$style</style>
</head>
<body>
<h1>$title</h1>
$body
</body>
</html>
"""

_STYLE = """:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 64rem; padding: 2rem 1.25rem 4rem; color: #1a1a1a; background: #fff;
  font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .25rem; overflow-wrap: anywhere; }
h2 { font-size: 1.3rem; margin: 2.5rem 0 .5rem; padding-top: .75rem; border-top: 2px solid #1a1a1a; }
p { max-width: 46rem; margin: .5rem 0; overflow-wrap: anywhere; }
.lead { font-size: 1.15rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; margin: .5rem 0 1.25rem; font-size: .88rem; min-width: 55%; }
th { text-align: left; font-weight: 600; border-bottom: 1.5px solid #1a1a1a; padding: .3rem .6rem;
  vertical-align: bottom; }
td { padding: .3rem .6rem; border-bottom: 1px solid #ddd; vertical-align: top; }
th.number { text-align: right; }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
figure { margin: 1rem 0; }
figure svg { max-width: 100%; height: auto; }
figcaption, .caption { font-size: .88rem; color: #333; font-weight: 600; margin: 1rem 0 .25rem; }
figcaption { margin-top: .25rem; }
summary { cursor: pointer; font-weight: 600; font-size: .88rem; }
@media print { body { max-width: none; padding: 0; font-size: 11px; }
  details:not([open]) > *:not(summary) { display: revert; } }
"""


def page(title: str, body: Iterable[str], style: str = "") -> str:
    """Page of parts that are HTML already; style: CSS behind that of all pages."""
    return Template(_PAGE).substitute(
        title=text(title, 200),
        style=_STYLE + style,
        body="\n".join(body),
    )


def text(words: object, width: int | None = None) -> str:
    """Text escaped, its unprintable characters but line breaks too, cut at `width`."""
    return escape(escape_unprintable(words, width, keep="\n"))


def element(tag: str, inner: str, kind: str = "") -> str:
    """Element of a class around what is HTML already."""
    attribute = f' class="{kind}"' if kind else ""
    return f"<{tag}{attribute}>{inner}</{tag}>"


def paragraph(words: str, kind: str = "") -> str:
    """Paragraph of a class."""
    return element("p", text(words), kind)


def caption(words: str) -> str:
    """Caption above a table."""
    return paragraph(words, "caption")


def figure(picture: str, words: str) -> str:
    """Inline SVG with its caption."""
    below = element("figcaption", text(words))
    return element("figure", picture + below)


def details(words: str, inner: str) -> str:
    """Part that is folded away under a summary."""
    summary = element("summary", text(words))
    return element("details", summary + inner)


def row(
    cells: Iterable[str],
    kinds: Sequence[str],
    kind: str = "",
    tag: str = "td",
) -> str:
    """Row of a table, of a class: texts, and the class of each."""
    inner = ""
    for words, cell_kind in zip(cells, kinds, strict=True):
        inner += element(tag, text(words), cell_kind)
    return element("tr", inner, kind)


def table(
    heads: Sequence[str],
    kinds: Sequence[str],
    rows: Iterable[str],
) -> str:
    """Table of rows that are HTML already, under heads of these classes."""
    head = element("thead", row(heads, kinds, tag="th"))
    lines = "".join(f"{line}\n" for line in rows)
    body = element("tbody", "\n" + lines)
    return element("div", element("table", head + body), "wide")
