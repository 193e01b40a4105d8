"""README.md is run as it stands: Python blocks in order in one namespace, commands in a shell,
outputs compared.

A ```text block right after a ```python or ```sh block is what that block prints, exactly. In a
```console block lines with "$ " are commands and the others what they print. Commands that set a
machine up are not run, but what they name (make targets, extras, files) must exist.
"""

from __future__ import annotations

import contextlib
import io
import linecache
import os
import re
import shlex
import subprocess
import sys
import tomllib
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

import poekin as pk
from poekin.cli import run as run_poekin

ROOT = Path(__file__).resolve().parent.parent

SOURCE = "<README.md>"
RUN = ("poekin", "python")
PLAIN = re.compile(r"poekin ([^|&;<>$`()*?~\\]+)(\|.*)?")
NOT_CODE = ("text", "math", "bibtex")
SET_UP = (
    r"git clone \S+",
    r"cd \S+",
    r"python3? -m venv \S+",
    r"(source|\.) \S+/bin/activate",
    r"(python3? -m )?pip install .+",
    r"make( .+)?",
    r"\.venv/bin/python -m tools\.processors .+",
)


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, first line, text, and whether only blank lines part it from the
    one before.
    """

    language: str
    line: int
    text: str
    adjoins: bool


def blocks(text: str) -> Iterator[Block]:
    inside, language, start, adjoins = False, "", 0, False
    lines: list[str] = []
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            if inside:
                yield Block(language, start, "\n".join(lines), adjoins)
                adjoins = True
            language, start, lines, inside = line[3:].strip(), number + 1, [], not inside
        elif inside:
            lines.append(line)
        elif line.strip():
            adjoins = False


def printed_by(block: Block, namespace: dict) -> str:
    """What a Python block prints, with warnings as errors; a failure names the line of README.md."""
    out, code = io.StringIO(), "\n" * (block.line - 1) + block.text
    # Who asks for the source of a function, as Hypothesis does, gets this block and not a file of
    # that name.
    linecache.cache[SOURCE] = (len(code), None, code.splitlines(keepends=True), SOURCE)
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(out):
            warnings.simplefilter("error")
            exec(compile(code, SOURCE, "exec", dont_inherit=True), namespace)
    except Exception as error:
        frames = traceback.extract_tb(error.__traceback__)
        within = [frame.lineno for frame in frames if frame.filename == SOURCE]
        line = error.lineno if isinstance(error, SyntaxError) else within[-1]
        raise AssertionError(f"README.md:{line}: {type(error).__name__}: {error}") from error
    return out.getvalue()


@dataclass
class Command:
    """A command of a block: the line it starts at, its text, and what a console block says that it
    prints.
    """

    line: int
    text: str
    output: list[str] | None


def commands(block: Block) -> list[Command]:
    found: list[Command] = []
    console = block.language == "console"
    for number, line in enumerate(block.text.splitlines(), block.line):
        if found and found[-1].text.endswith("\\") and not found[-1].output:
            found[-1].text = found[-1].text[:-1] + line.strip()
        elif console and not line.startswith("$ "):
            if not found:
                raise AssertionError(
                    f"README.md:{number}: output before the first command (a line with '$ ')"
                )
            found[-1].output = [*(found[-1].output or []), line]
        elif line.strip() and not line.startswith("#"):
            found.append(Command(number, line[2:] if console else line, [] if console else None))
    return found


def fault_of_set_up(command: str, root: Path) -> str | None:
    """Why a command is none that sets a machine up, or which name in it does not exist."""
    words = shlex.split(command, comments=True)
    if not any(re.fullmatch(pattern, " ".join(words)) for pattern in SET_UP):
        return f"neither run by this test nor known as a set-up command: {command}"
    if words[0] == "make":
        targets = re.findall(
            r"^([\w-]+):(?!=)", (root / "Makefile").read_text(encoding="utf-8"), re.MULTILINE
        )
        missing = [w for w in words[1:] if "=" not in w and w not in targets]
        return f"no such make target: {', '.join(missing)}" if missing else None
    if "pip" in words:
        project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
        named = [
            re.split(r"[\[<>=!~; ]", word)[0]
            for word in words[words.index("install") + 1 :]
            if word[0] != "-"
        ]
        if foreign := [name for name in named if name not in (project["name"], ".")]:
            return f"neither {project['name']} nor this checkout: {', '.join(foreign)}"
        wanted = re.findall(r"(?:poekin|\.)\[([\w,-]+)\]", command)
        missing = [
            e
            for extras in wanted
            for e in extras.split(",")
            if e not in project["optional-dependencies"]
        ]
        return f"no such extra: {', '.join(missing)}" if missing else None
    return None


def compare(printed: str, expected: str, where: str) -> None:
    if printed.rstrip("\n") != expected.rstrip("\n"):
        raise AssertionError(f"{where}: printed\n{printed}\nand not\n{expected}")


def output_of(command: str, place: Path, where: str) -> str:
    """What a command prints, poekin's in this process where it needs nothing of a shell but a pipe
    behind it.
    """
    given = ""
    plain = PLAIN.fullmatch(command)
    if plain:
        out = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
        err = io.StringIO()
        with contextlib.chdir(place), contextlib.redirect_stdout(out):
            with contextlib.redirect_stderr(err):
                code = run_poekin(shlex.split(plain[1], comments=True))
            out.flush()
        given = out.buffer.getvalue().decode()
        if code and not plain[2]:
            raise AssertionError(f"{where}: exit code {code}: {command}\n{err.getvalue()}")
        if not plain[2]:
            return given
        command = f"cat {plain[2]}"
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    environment = {**os.environ, "PATH": path, "NO_COLOR": "1", "PYTHONWARNINGS": "error"}
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=place,
        env=environment,
        input=given,
        capture_output=True,
        text=True,
        timeout=300,
    )
    if done.returncode:
        raise AssertionError(f"{where}: exit code {done.returncode}: {command}\n{done.stderr}")
    return done.stdout


def run_commands(block: Block, place: Path, root: Path) -> str:
    """What the commands of a block print; those that set a machine up are only looked at."""
    outputs = []
    for command in commands(block):
        where, parts = f"README.md:{command.line}", command.text.split(" && ")
        if any(part.split()[0] in RUN for part in parts) and not re.fullmatch(
            "|".join(SET_UP), command.text
        ):
            outputs.append(output_of(command.text, place, where))
            if command.output is not None:
                compare(outputs[-1], "\n".join(command.output), where)
        elif faults := [fault for part in parts if (fault := fault_of_set_up(part, root))]:
            raise AssertionError(f"{where}: {faults[0]}")
    return "".join(outputs)


def run(text: str, place: Path, root: Path = ROOT) -> dict[str, int]:
    """Run a README in a directory; how many blocks of each language it has. AssertionError says
    where it is wrong.
    """
    namespace, printed, counts = {"__name__": "__main__"}, None, {}
    for block in blocks(text):
        counts[block.language] = counts.get(block.language, 0) + 1
        where = f"README.md:{block.line}"
        if block.language == "python":
            printed = printed_by(block, namespace)
        elif block.language in ("sh", "console"):
            printed = run_commands(block, place, root)
        elif block.language not in NOT_CODE:
            raise AssertionError(
                f"{where}: a block of '{block.language}': use python, sh, console or text"
            )
        else:
            if block.language == "text" and block.adjoins and printed is not None:
                compare(printed, block.text, where)
            printed = None
    return counts


def missing_links(text: str, root: Path) -> list[str]:
    """Relative links to files that do not exist, and pictures."""
    links = re.findall(r"\]\(([^)\s#]+)(?:#[^)]*)?\)", text)
    links += re.findall(r'<img src="([^"]+)"', text)
    return [link for link in links if "://" not in link and not (root / link).exists()]


def test_the_readme_runs_and_prints_what_it_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    counts = run((ROOT / "README.md").read_text(encoding="utf-8"), tmp_path)
    assert counts.get("python", 0) >= 1
    assert counts.get("sh", 0) + counts.get("console", 0) >= 1
    picture = (ROOT / "docs" / "_static" / "panda.svg").read_text(encoding="utf-8")
    assert len(picture) <= 100_000
    assert same_picture((tmp_path / "panda.svg").read_text(encoding="utf-8"), picture)
    assert "connect-src" in (tmp_path / "panda.html").read_text(encoding="utf-8")


def same_picture(one: str, other: str) -> bool:
    """Whether two figures of Matplotlib show the same: as many lines, the same words, and lines
    that begin and bend within 3 pt of each other, whatever the version.
    """
    (parts, words, points), (others, other_words, other_points) = drawn(one), drawn(other)
    if parts != others or words != other_words or not len(points) == len(other_points) > 4:
        return False
    return all(abs(a - b) <= 3 for a, b in zip(points, other_points, strict=True))


def drawn(picture: str) -> tuple[Counter[str], list[str], list[float]]:
    """Numbers of groups by kind, the words, and the coordinates of the arm's line."""
    parts = Counter(re.findall(r'<g id="(line2d|text|patch)_\d+"', picture))
    line = re.search(r'<path d="([^"]+)"[^>]*stroke: ?#9a9a9a', picture)
    return parts, re.findall(r"<!-- (.*?) -->", picture), numbers(line[1] if line else "")


def numbers(path: str) -> list[float]:
    return [float(x) for x in re.findall(r"-?[\d.]+", path)]


def test_another_picture_is_caught():
    arm = pk.load("panda").chain(tip="panda_hand")
    pictures = []
    for q in ([0, -0.5, 0, -2, 0, 1.6, 0.8], [0, -0.6, 0, -2, 0, 1.6, 0.8]):
        arm.plot(q).savefig(out := io.StringIO(), format="svg")
        pictures.append(out.getvalue())
    assert same_picture(pictures[0], pictures[0].replace("-->", "-->\n"))
    assert not same_picture(*pictures)
    assert not same_picture(pictures[0], pictures[0].replace("panda_hand", "hand"))


def test_the_readme_links_to_files_that_exist():
    assert missing_links((ROOT / "README.md").read_text(encoding="utf-8"), ROOT) == []


PLANTED = [
    ("```python\nprint(1 + 1)\n```\n\n```text\n3\n```", "README.md:6: printed"),
    ("text\n```python\nx = 1\ny = x +\n```", "README.md:4: SyntaxError"),
    ("```python\nx = 1\n\nraise ValueError('so')\n```", "README.md:4: ValueError: so"),
    ("```python\nimport warnings\nwarnings.warn('old')\n```", "README.md:3: UserWarning: old"),
    ("```py\nx = 1\n```", "README.md:2: a block of 'py'"),
    ("```\nx = 1\n```", "README.md:2: a block of ''"),
    ("```sh\nmake test\nmake tset\n```", "README.md:3: no such make target: tset"),
    ("```sh\npip install 'poekin[everything]'\n```", "no such extra: everything"),
    ("```sh\npip install poekn\n```", "neither poekin nor this checkout: poekn"),
    ("```sh\nrm -r poekin\n```", "README.md:2: neither run"),
    ("```sh\ngit clone there && rm -r poekin\n```", "README.md:2: neither run"),
    ("```sh\npython -c 'raise SystemExit(3)'\n```", "exit code 3"),
    ("```sh\npython -c 'import warnings; warnings.warn(\"old\")'\n```", "UserWarning: old"),
    ("```sh\npython -c 'print(1)'\n```\n```text\n2\n```", "README.md:5: printed\n1"),
    (
        "```console\n$ python -c 'print(1)'\n1\n$ python -c \\\n  'print(2)'\n3\n```",
        "README.md:4: printed\n2",
    ),
]


@pytest.mark.parametrize(("text", "message"), PLANTED)
def test_a_planted_fault_is_caught(text, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(AssertionError, match=re.escape(message)):
        run(text, tmp_path)


def test_the_source_of_a_function_on_a_page_is_that_of_its_block(tmp_path):
    run(
        "text\n```python\nimport inspect\n\n\ndef f():\n    return (1,\n            2)\n\n\n"
        "print(inspect.getsource(f).count('\\n'))\n```\n```text\n3\n```",
        tmp_path,
    )


def test_a_sound_readme_is_accepted(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = """
        ```sh
        git clone there && cd poekin   # the source
        make test   # all tests
        pip install 'poekin[cli,report]'
        ```
        ```python
        open("made", "w").close()
        x = 20
        ```
        ```python
        print(x + 1)
        ```

        ```text
        21
        ```
        A picture, which no block prints:
        ```text
        o---o
        ```
        ```console
        $ python -c "import os; print(os.path.exists('made'))"
        True
        $ python -c \\
            "print()"

        ```
        """.replace("\n        ", "\n")
    assert run(text, tmp_path) == {"sh": 1, "python": 2, "text": 2, "console": 1}


def test_a_dead_link_is_caught(tmp_path):
    (tmp_path / "there.md").touch()
    text = "[a](there.md) [b](there.md#part) [c](https://example.com/x) [d](gone.md) ![e](gone.png)"
    text += '<img src="gone.svg">'
    assert missing_links(text, tmp_path) == ["gone.md", "gone.png", "gone.svg"]
