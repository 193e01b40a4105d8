"""Names out of files are data: markup, escape sequences and line breaks in them do nothing."""

from __future__ import annotations

import pytest

NAMES = [
    "[bold]x[/bold]",
    "[/b]",
    "[link=http://x]y[/link]",
    ":smile:",
    "=1+1",
    "<b>&amp;",
    "\u202eevil",
    "%s{0}",
    "ü",
]

URDF = """<robot name="{n}r"><link name="{n}root"/><link name="{n}tip"/><joint name="{n}j" type="revolute">
<parent link="{n}root"/><child link="{n}tip"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
</joint></robot>"""


def _escaped(name: str) -> str:
    return name.replace("&", "&amp;").replace("<", "&lt;")


@pytest.fixture(params=NAMES)
def hostile(request, tmp_path):
    path = tmp_path / "hostile.urdf"
    path.write_text(URDF.format(n=_escaped(request.param)), encoding="utf-8")
    return request.param, str(path)


@pytest.mark.parametrize(
    "words",
    [
        ["info"],
        ["info", "--json"],
        ["fk", "0.5"],
        ["jacobian", "--frame", "body", "0.5"],
        ["validate", "--samples", "2"],
    ],
    ids=lambda w: "-".join(w),
)
def test_a_hostile_name_is_shown_as_it_is_or_escaped(hostile, poekin, words):
    name, path = hostile
    code, out, err = poekin(words[0], path, *words[1:])
    assert (code, err) == (0, "")
    shown = name.encode("unicode_escape").decode() if "\u202e" in name else name
    if "--json" in words:
        shown = __import__("json").dumps(name)[1:-1]
    assert shown in out
    assert "\u202e" not in out
    assert "\x1b" not in out


def test_a_hostile_argument_is_harmless_in_the_message(refused, crane):
    for words in (
        ["fk", "\x1b[31mred"],
        ["fk", crane, "--tip", "a\x1b]0;x\x07\n"],
        ["\x1b[31m"],
        ["info", crane, "--\x1b[2J"],
    ):
        assert not set("\x1b\x07") & set(refused(*words))


def test_a_hostile_name_in_a_warning_is_harmless(tmp_path, poekin):
    path = tmp_path / "w.urdf"
    path.write_text(URDF.format(n="[/b]&#x9;").replace("0 0 1", "0 0 2"), encoding="utf-8")
    code, _, err = poekin("info", path)
    assert code == 0
    assert err.startswith("poekin: warning: ")
    assert "\t" not in err
