"""Docstrings of the house as reStructuredText: they are plain text in numpydoc's sections, so all
markup characters are escaped.

Sections of entries (Parameters, Returns, Raises ...) become fields of definitions, the others
rubrics. Kept letter by letter: indented blocks and columns, which are equations and tables, and
examples. `names in backquotes` become links where there is such a name, else code.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby, pairwise

OF_ENTRIES = {
    *("Parameters", "Other Parameters", "Attributes"),
    *("Returns", "Yields", "Raises", "Warns", "See Also"),
}
COLUMNS = re.compile(r"\S {2,}\S")
MARKUP = re.compile(r"(?<!\\)([\\*|_]|\\(?!`))")
NAME = re.compile(r"[A-Za-z_][\w.]*")
NAMES = re.compile(r"\*{0,2}[\w.]+(, \*{0,2}[\w.]+)*")
Links = Mapping[str, str]  # from what stands in backquotes to what it is called in full


def rest(lines: Iterable[str], links: Links) -> list[str]:
    """A docstring as lines of reStructuredText."""
    out: list[str] = []
    for title, body in sections([line.rstrip() for line in lines]):
        if title in OF_ENTRIES:
            out += [f":{title}:", *indented(definitions(body, links)), ""]
        else:
            heading = [f".. rubric:: {title}", ""] if title else []
            out += [*heading, *blocks(body, links)]
    return out


def sections(lines: Sequence[str]) -> Iterator[tuple[str, list[str]]]:
    """Titles and lines of the sections; that of the summary has no title."""
    starts = [
        number
        for number, (line, under) in enumerate(pairwise(lines))
        if line and re.fullmatch(r"-{3,}", under)
    ]
    ends = [*starts, None]
    yield "", list(lines[: ends[0]])
    for start, end in zip(starts, ends[1:], strict=True):
        yield lines[start], list(lines[start + 2 : end])


def definitions(lines: Sequence[str], links: Links) -> list[str]:
    """Entries "name : type" with what is indented below each."""
    out: list[str] = []
    below: list[str] = []

    def close() -> None:
        out.extend([*indented(blocks(textwrap.dedent("\n".join(below)).splitlines(), links)), ""])
        below.clear()

    for line in lines:
        if line.startswith(" ") or not line:
            below.append(line)
        else:
            close()
            out.append(term(line, links))
    close()
    return out


def term(line: str, links: Links) -> str:
    """The names of an entry in bold, and its type, in which classes are links."""
    names, colon, kind = line.partition(" : ")
    if not NAMES.fullmatch(names):
        return prose(line, links)
    if (error := f"errors.{names}") in links:
        return f":py:obj:`{names} <{links[error]}>`"
    bold = ", ".join(f"**{MARKUP.sub(_escaped, name)}**" for name in names.split(", "))
    return f"{bold} : {kind_of(kind, links)}" if colon else bold


def kind_of(kind: str, links: Links) -> str:
    """A type in italics; names of classes in it lead to them."""
    out = ""
    end = 0
    for found in NAME.finditer(kind):
        if found[0] in links and found[0][0].isupper():
            out += italic(kind[end : found.start()]) + link(found[0], links)
            end = found.end()
    return out + italic(kind[end:])


def italic(text: str) -> str:
    """Text in italics, the spaces around it outside."""
    inner = text.strip()
    return text.replace(inner, f"\\ *{MARKUP.sub(_escaped, inner)}*\\ ") if inner else text


def link(name: str, links: Links) -> str:
    """A name as a link where it leads somewhere, else as code."""
    return f":py:obj:`{name} <{links[name]}>`" if name in links else f"``{name}``"


def prose(text: str, links: Links) -> str:
    """One line of inline markup: everything escaped, `code` as a link or a literal."""
    parts = " ".join(text.split()).split("`")
    if len(parts) % 2 == 0:  # a backquote without its partner is a character like any other
        parts = ["\\`".join(parts)] if len(parts) == 2 else [*parts[:-2], "\\`".join(parts[-2:])]
    out = []
    for number, part in enumerate(parts):
        if number % 2 and part.strip() == part and part:
            of_extra = parts[number - 1].endswith("extra ")  # the names of extras are no functions
            # A letter or a figure right beside it would keep it from being markup.
            out.append(f"\\ {link(part, {} if of_extra else links)}\\ ")
        else:
            out.append(MARKUP.sub(_escaped, part))
    # The empty escape keeps a first word such as "1." or "-" from beginning a list.
    return "\\ " + "".join(out)


def blocks(lines: Sequence[str], links: Links) -> list[str]:
    """Paragraphs, lists of "- ", examples, and what is indented or in columns."""
    out: list[str] = []
    for full, group in groupby(lines, key=bool):
        paragraph = list(group)
        if not full:
            continue
        if paragraph[0].startswith(">>>"):
            out += paragraph
        elif paragraph[0].startswith("  ") or (
            len(paragraph) > 1 and all(map(COLUMNS.search, paragraph))
        ):
            out += ["::", "", *indented(paragraph)]
        else:
            out += text_and_lists(paragraph, links)
        out.append("")
    return out


def text_and_lists(paragraph: Sequence[str], links: Links) -> list[str]:
    """A paragraph in which lists of "- " may stand: their entries' further lines are indented."""
    pieces: list[tuple[bool, str]] = []  # whether it is an entry of a list, and its text
    for line in paragraph:
        if line.startswith("- "):
            pieces.append((True, line[2:]))
        elif pieces and (line.startswith("  ") or not pieces[-1][0]):
            pieces[-1] = (pieces[-1][0], f"{pieces[-1][1]} {line}")
        else:
            pieces.append((False, line))
    out: list[str] = []
    for listed, group in groupby(pieces, key=lambda piece: piece[0]):
        sign = "* " if listed else ""
        out += [*(sign + prose(text, links) for _, text in group), ""]
    return out


def indented(lines: Iterable[str]) -> list[str]:
    """Lines one level further in."""
    return [f"    {line}" if line else line for line in lines]


def _escaped(found: re.Match[str]) -> str:
    return "\\" + found[1]
