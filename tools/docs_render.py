"""The house's docstrings as reStructuredText: they are plain text, so all markup characters are
escaped.

What is told apart: paragraphs; indented blocks and columns (equations and tables, kept letter by
letter); lists of
"- "; and what begins with one of the labels "Parameters:", "Returns:", "Raises:", "Accuracy:",
"Source:" and the like, which becomes a field. `names in backquotes` become links where there is
such a name, else code.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping

LABEL = re.compile(
    r"(?:^|(?<=\n)|(?<=[.;)] ))"
    r"((?:Parameters|Returns|Raises|Warns|Accuracy|Source|Further fields|Fields|Attributes)"
    r"(?:,? (?:and )?(?:parameters|returns|errors|raises|accuracy|source))*):\s"
)
HEADED = ("Parameters", "Returns", "Raises", "Fields", "Further fields", "Attributes")
ITEM = re.compile(r"([A-Za-z_]\w*)(?:[ ,(][^:]*)?:\s")
ONE = r"[A-Za-z_]\w*(?: ?\([^)]*\))?"  # a name, and what stands in brackets behind it
NAMES = re.compile(rf"{ONE}(?:, {ONE})*(?=:| \([^)]*\)[:,]| = [^:]*:)")
COLUMNS = re.compile(r"\S {2,}\S")


def prose(text: str, links: Mapping[str, str]) -> str:
    """One line of inline markup: everything escaped, `code` as a link or a literal."""
    parts = " ".join(text.split()).split("`")
    if len(parts) % 2 == 0:  # a backquote without its partner is a character like any other
        parts = ["\\`".join(parts)] if len(parts) == 2 else [*parts[:-2], "\\`".join(parts[-2:])]
    out = []
    for number, part in enumerate(parts):
        if number % 2 and part.strip() == part and part:
            # The names of extras are no functions.
            link = part in links and not parts[number - 1].endswith("extra ")
            code = f":py:obj:`{part} <{links[part]}>`" if link else f"``{part}``"
            # A letter or a figure right beside it would keep it from being markup.
            out.append(f"\\ {code}\\ ")
        else:
            out.append(re.sub(r"(?<!\\)([\\*|_]|\\(?!`))", r"\\\1", part))
    # The empty escape keeps a first word such as "1." or "-" from beginning a list.
    return "\\ " + "".join(out)


def headings(lines: list[str]) -> list[str]:
    """Underlined headings, and "Fields" on a line of its own, in the form "Label:" with their lines
    indented.
    """
    out: list[str] = []
    for line in lines:
        if re.fullmatch(r"-{3,}", line) and out and out[-1] in HEADED:
            out[-1] += ":"
        elif line.startswith("- ") and out and out[-1] in HEADED:
            out[-1:] = [out[-1] + ":", line]
        else:
            out.append(line)
    return out


def paragraphs(lines: Iterable[str]) -> list[list[str]]:
    found: list[list[str]] = [[]]
    for line in lines:
        if line.strip():
            found[-1].append(line)
        elif found[-1]:
            found.append([])
    return [p for p in found if p]


def listed(lines: list[str], starts, links: Mapping[str, str]) -> list[str]:
    """A list with one entry for each line that starts one; the lines after it belong to it."""
    entries: list[str] = []
    for line in lines:
        text, begins = starts(line)
        if begins or not entries:
            entries.append(text)
        else:
            entries[-1] += " " + text
    return [f"* {named(entry, links)}" for entry in entries]


def named(entry: str, links: Mapping[str, str]) -> str:
    """An entry, the names that it begins with in bold: "q (..., m), out: ..." or "- kind: ..."."""
    match = NAMES.match(entry)
    if not match:
        return prose(entry, links)
    out, end = "", 0
    for name in re.finditer(r"(?:^|(?<=, ))[A-Za-z_]\w*(?![^(]*\))", match[0]):
        out += spaced(entry[end : name.start()], links) + "**" + name[0].replace("_", "\\_") + "**"
        end = name.end()
    return out + spaced(entry[end:], links)


def spaced(text: str, links: Mapping[str, str]) -> str:
    """What stands behind a name, or between two."""
    before, after = (" " if edge else "" for edge in (text.startswith(" "), text.endswith(" ")))
    return f"{before}{prose(text, links)}{after}" if text.strip() else text


def apart(lines: list[str], names: Collection[str]) -> list[str]:
    """Lines of parameters, cut also where in one line a sentence ends and another parameter's name
    begins.
    """
    known = "|".join(map(re.escape, sorted(names, key=len, reverse=True)))
    begin = re.compile(
        rf"(?<=[.;]) +(?=(?:{known})(?: ?\([^)]*\))?(?:, [a-z_]\w*(?: ?\([^)]*\))?)*: )"
    )
    return [part for line in lines for part in begin.split(line)] if names else lines


def text_and_fields(text: str, links: Mapping[str, str]) -> list[str]:
    """Prose, and behind it what its labels say as a field list."""
    first, *rest = LABEL.split(text)
    out = [prose(first, links), ""] if first.strip() else []
    out += [
        f":{name}: {prose(body, links)}" for name, body in zip(rest[::2], rest[1::2], strict=True)
    ]
    return [*out, ""]


def rest(lines: Iterable[str], links: Mapping[str, str], names: Collection[str] = ()) -> list[str]:
    """A docstring as lines of reStructuredText.

    links: from what stands in backquotes to what it is called in full. names: of the parameters,
    for "Parameters" over an item a line; where it is empty, any name will do.
    """
    out: list[str] = []
    for paragraph in paragraphs(headings([line.rstrip() for line in lines])):
        if paragraph[0].startswith("  ") or (
            len(paragraph) > 1 and all(map(COLUMNS.search, paragraph))
        ):
            out += ["::", "", *(f"    {line}" for line in paragraph), ""]
        elif paragraph[0].rstrip(":") in HEADED and paragraph[0].endswith(":"):
            bullets = paragraph[1].startswith("- ")

            def item(line: str, bullets: bool = bullets) -> tuple[str, bool]:
                if bullets:
                    return line.removeprefix("- ").strip(), line.startswith("- ")
                match = ITEM.match(line)
                return line.strip(), bool(match) and (not names or match[1] in names)

            body = paragraph[1:] if bullets else apart(paragraph[1:], names)
            out += [
                f":{paragraph[0][:-1]}:",
                *(f"    {line}" for line in listed(body, item, links)),
                "",
            ]
        else:
            out += mixed(paragraph, links)
    return out


def mixed(paragraph: list[str], links: Mapping[str, str]) -> list[str]:
    """A paragraph in which lists of "- " may stand: their entries' further lines are indented."""
    out: list[str] = []
    group: list[str] = []
    inside = False

    def close() -> None:
        if group and inside:
            out.extend(
                [
                    *listed(
                        group, lambda x: (x.removeprefix("- ").strip(), x.startswith("- ")), links
                    ),
                    "",
                ]
            )
        elif group:
            out.extend(text_and_fields("\n".join(group), links))
        group.clear()

    for line in paragraph:
        belongs = line.startswith("- ") or (inside and line.startswith("  "))
        if belongs != inside:
            close()
            inside = belongs
        group.append(line)
    close()
    return out
