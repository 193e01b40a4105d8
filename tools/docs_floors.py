"""The floors of the house as a page: read out of the test that holds them and out of the files' own
first lines.
"""

from __future__ import annotations

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def floors(root: Path = ROOT) -> dict[str, float]:
    """The table FLOORS of tests/test_architecture.py, which is what the imports are held to."""
    tree = ast.parse((root / "tests" / "test_architecture.py").read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "FLOORS":
            return ast.literal_eval(node.value)
    raise ValueError("tests/test_architecture.py has no table FLOORS")


def place(name: str, root: Path = ROOT) -> Path:
    """The folder or file of a floor; FileNotFoundError where the package has none."""
    for path in (root / "poekin" / name, root / "poekin" / f"{name}.py"):
        if path.exists():
            return path
    raise FileNotFoundError(f"the floor {name} is no part of poekin/")


def first_line(file: Path) -> str:
    """What a file says of itself: its docstring up to the first blank line, as one line for a
    table.
    """
    text = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""
    return (
        " ".join(text.split("\n\n")[0].split())
        .replace("|", "\\|")
        .replace("<", "&lt;")
        .replace("`", "")
    )


def escaped(text: str) -> str:
    """As MyST shows it letter by letter."""
    return "".join(f"\\{c}" if c in "*_[]{}$#" else c for c in text)


def page(root: Path = ROOT) -> str:
    """Markdown: a table of the floors from the top, then each floor's files, each with its own
    first line.
    """
    table = floors(root)
    down = sorted(table, key=lambda n: (-table[n], n))
    lines = ["| floor | in `poekin/` | what it is |", "|---|---|---|"]
    for name in down:
        path = place(name, root)
        file = path / "__init__.py" if path.is_dir() else path
        shown = f"{name}/" if path.is_dir() else f"{name}.py"
        lines.append(f"| {table[name]:g} | `{shown}` | {escaped(first_line(file))} |")
    for name in down:
        path = place(name, root)
        if path.is_dir():
            lines += ["", f"## `{name}/`", "", "| file | what it is |", "|---|---|"]
            for file in sorted(path.rglob("*.py")):
                if file.name != "__init__.py" or file.parent != path:
                    says = escaped(first_line(file))
                    lines.append(f"| `{file.relative_to(root / 'poekin').as_posix()}` | {says} |")
    return "\n".join(lines) + "\n"
