"""The measures of how the package reads, on small texts whose measures are known."""

from __future__ import annotations

import pytest

from tools import readable

PLAIN = "x = 1\n"


def measured(tmp_path, **files: str) -> dict[str, float]:
    for name, text in files.items():
        path = tmp_path / f"{name.replace('__', '/')}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return {measure.name.split(",")[0]: measure.value for measure in readable.measures(tmp_path)}


@pytest.mark.parametrize(
    ("text", "name", "value"),
    [
        ("x = 1\n\n# a comment\ny = x + 2  # another\n", "tokens a code line", 4),
        ("x = 1\n\n# a comment\ny = x + 2  # another\n", "code tokens", 8),
        ('"""What a file says\n\nin many lines."""\nx = 1\n', "code tokens", 3),
        ('def f():\n    """Words."""\n    return 1\n', "code tokens", 5 + 2),
        ('x = """A text is code."""\n', "code tokens", 3),
        ('x = f"{a} and {b!r:{width}}" "c" + y\n', "code tokens", 6),
        ("a, b = 1, 2\nc = 3\n", "tuple assignments", 50),
        (
            "a, b = f()\n(c, d) = (a, b)\n[e] = d\nfor g, h in a: pass\n",
            "tuple assignments",
            100 / 3,
        ),
        ("x = 1 if y else 2\nz = 3\n", "ternaries per 100 code lines", 50),
        ("x = [\n    1,  # fmt: skip\n]  #fmt:off\n", "lines with the formatter off", 2),
        ('"""What it is."""\n', "docstrings that begin What", 1),
        (
            '"""Pose of the tip."""\nclass A:\n    """Where it is."""\n',
            "docstrings that begin What",
            1,
        ),
        (
            '"""Whatever."""\ndef f():\n    """How."""\n    x = """Of no docstring."""\n',
            "docstrings that begin What",
            1,
        ),
        ('async def f():\n    """Those."""\nx = "What"\n', "docstrings that begin What", 1),
    ],
)
def test_a_text_is_measured(text, name, value, tmp_path):
    assert measured(tmp_path, plain=text)[name] == pytest.approx(value)


def test_files_and_folders_are_measured(tmp_path):
    found = measured(tmp_path, a=PLAIN, b=PLAIN * 2, c=PLAIN * 6, d__e=PLAIN * 4)
    assert found["median file"] == 3
    assert found["largest file"] == 6
    assert found["most files in one folder"] == 3


def test_a_measure_says_whether_it_exceeds_its_bar():
    assert str(readable.Measure("tokens", 8.4999, 8.5)).endswith("8.5   bar 8.5")
    assert str(readable.Measure("tokens", 8.5, 8.5)).endswith("8.5   bar 8.5")
    assert str(readable.Measure("tokens", 9, 8.5)).endswith("9   bar 8.5  exceeds it")


@pytest.mark.parametrize(("text", "code"), [(PLAIN, 0), ("x = 1 if y else 2\n", 1)])
def test_the_exit_code_says_whether_all_bars_hold(text, code, tmp_path, capsys):
    (tmp_path / "a.py").write_text(text, encoding="utf-8")
    assert readable.main([str(tmp_path)]) == code
    assert len(capsys.readouterr().out.splitlines()) == 9
