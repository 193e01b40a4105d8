"""Measures of how the package reads: tokens, assignments, ternaries. `python -m tools.readable
[DIR]`.
"""

from __future__ import annotations

import ast
import functools
import io
import re
import statistics
import sys
import tokenize
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

LAYOUT = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
}
FORMATTER_OFF = re.compile(r"#\s*fmt:\s*(skip|off)")
ODD_OPENING = re.compile(r"\s*(What|Where|How|Of|Those|The same|Who|When)\b")
Documented = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Measure:
    """A measured value, and the bar that it should not exceed."""

    name: str
    value: float
    bar: float

    def __str__(self) -> str:
        verdict = "" if self.value <= self.bar else "  exceeds it"
        return f"{self.name:<36} {self.value:>10.4g}   bar {self.bar:g}{verdict}"


@dataclass(frozen=True)
class Source:
    """A file of the package: its path, text and syntax tree."""

    path: Path
    text: str
    tree: ast.Module

    @functools.cached_property
    def syntax(self) -> list[ast.AST]:
        """All nodes of the tree."""
        return list(ast.walk(self.tree))

    def docstrings(self) -> Iterator[ast.Expr]:
        """Docstrings of the module, its classes and its functions."""
        for node in self.syntax:
            if isinstance(node, Documented) and ast.get_docstring(node, clean=False) is not None:
                statement = node.body[0]
                if isinstance(statement, ast.Expr):
                    yield statement

    def tokens_by_line(self) -> Counter[int]:
        """Tokens on each line of code; comments and docstrings are none."""
        documentation: set[int] = set()
        for statement in self.docstrings():
            documentation.update(
                range(statement.lineno, (statement.end_lineno or statement.lineno) + 1)
            )
        tokens = _whole_strings(tokenize.generate_tokens(io.StringIO(self.text).readline))
        lines = (token.start[0] for token in tokens if token.type not in LAYOUT)
        return Counter(line for line in lines if line not in documentation)

    def nodes(self, kind: type[ast.AST]) -> int:
        """Number of syntax nodes of a kind."""
        return sum(isinstance(node, kind) for node in self.syntax)

    def tuple_assignments(self) -> int:
        """Number of assignments of a tuple display to a tuple of names."""
        assignments = (node for node in self.syntax if isinstance(node, ast.Assign))
        return sum(
            isinstance(a.targets[0], ast.Tuple) and isinstance(a.value, ast.Tuple)
            for a in assignments
        )


def _whole_strings(tokens: Iterator[tokenize.TokenInfo]) -> Iterator[tokenize.TokenInfo]:
    """Tokens, an f-string as its first one: from Python 3.12 on its parts are tokens too."""
    depth = 0
    for token in tokens:
        if not depth:
            yield token
        name = tokenize.tok_name[token.type]
        depth += name.endswith("STRING_START") - name.endswith("STRING_END")


def sources(root: Path) -> list[Source]:
    """Files of Python below a directory."""
    found = []
    for path in sorted(root.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        found.append(Source(path, text, ast.parse(text)))
    return found


def measures(root: Path) -> list[Measure]:
    """All measures of the package below `root`."""
    files = sources(root)
    lines: Counter[tuple[Path, int]] = Counter()
    for file in files:
        lines.update({(file.path, line): count for line, count in file.tokens_by_line().items()})
    tokens = lines.total()
    lengths = [file.text.count("\n") for file in files]
    folders = Counter(file.path.parent for file in files)
    openings = [str(ast.literal_eval(s.value)) for file in files for s in file.docstrings()]
    assignments = sum(file.nodes(ast.Assign) for file in files)
    tuples = sum(file.tuple_assignments() for file in files)
    ternaries = sum(file.nodes(ast.IfExp) for file in files)
    unformatted = sum(len(FORMATTER_OFF.findall(file.text)) for file in files)
    odd = sum(bool(ODD_OPENING.match(opening)) for opening in openings)
    return [
        Measure("tokens a code line", _ratio(tokens, len(lines)), 8.5),
        Measure("code tokens", tokens, 234_000),
        Measure("tuple assignments, % of assignments", 100 * _ratio(tuples, assignments), 2),
        Measure("ternaries per 100 code lines", 100 * _ratio(ternaries, len(lines)), 1.2),
        Measure("lines with the formatter off", unformatted, 30),
        Measure("docstrings that begin What, Where, How", odd, 0),
        Measure("median file, lines", statistics.median(lengths), 150),
        Measure("largest file, lines", max(lengths), 400),
        Measure("most files in one folder", max(folders.values()), 10),
    ]


def _ratio(part: int, whole: int) -> float:
    return part / whole if whole else 0.0


def main(arguments: list[str]) -> int:
    """Print the measures of a directory; 1 where one exceeds its bar."""
    found = measures(Path(arguments[0] if arguments else "poekin"))
    print(*found, sep="\n")
    return int(any(measure.value > measure.bar for measure in found))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
