"""Where --draw of ik, follow and singularity tells of its page: beside a table, on stderr."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import poekin as pk
from poekin.cli.kinematics import follow, ik, singularity
from poekin.solve import motion

Q0 = np.array([0, -0.5, 0, -2.0, 0, 1.6, 0.8])


class Page:
    """A page that is as good as empty."""

    def save(self, place: Path) -> None:
        place.write_text("a page", encoding="utf-8")


@pytest.fixture
def arms(tmp_path, monkeypatch):
    """Poses as words and as a file."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(ik, "view", lambda found, robot: Page())
    monkeypatch.setattr(follow, "view", lambda path, robot: Page())
    T = pk.load("panda").chain(tip="panda_hand").fk(Q0)
    motion.write_poses("T.csv", np.tile(T, (2, 1, 1)), "12")
    return {"one": [f"{x:.17g}" for x in T[:3].ravel()], "many": ["--input", "T.csv"]}


@pytest.mark.parametrize(
    ("command", "poses", "more", "on_stdout", "on_stderr"),
    [
        ("ik", "one", [], True, False),
        ("ik", "one", ["-o", "q.csv"], True, False),
        ("ik", "one", ["--json"], False, False),
        ("ik", "many", [], False, True),
        ("ik", "many", ["-o", "q.csv"], True, False),
        ("ik", "many", ["--json"], False, False),
        ("ik", "many", ["-o", "q.csv", "--json"], False, False),
        ("follow", "many", [], False, True),
        ("follow", "many", ["-o", "q.csv"], True, False),
        ("follow", "many", ["--json"], False, False),
    ],
)
def test_a_page_is_told_of_where_no_table_or_document_is(
    command, poses, more, on_stdout, on_stderr, arms, poekin
):
    start = ["--q0", ",".join(map(str, Q0))]
    options = ["--format", "12", *start, "--draw", "page.html", *more]
    code, out, err = poekin(command, "panda", "--tip", "panda_hand", *options, *arms[poses])
    assert code == 0
    assert Path("page.html").read_text(encoding="utf-8") == "a page"
    assert (out.endswith("drawn in 'page.html'\n"), "drawn in" in out) == (on_stdout, on_stdout)
    assert (err.endswith("poekin: drawn in 'page.html'\n"), "drawn in" in err) == (on_stderr,) * 2


@pytest.mark.parametrize(("more", "told"), [([], True), (["--json"], False)])
def test_a_page_of_a_singularity_is_told_of_last(more, told, tmp_path, monkeypatch, poekin):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(singularity, "view", lambda result, robot: Page())
    words = ["--tip", "panda_hand", "--draw", "page.html", *more, "--at", ",".join(map(str, Q0))]
    code, out, err = poekin("singularity", "panda", *words)
    assert (code, err) == (0, "")
    assert (out.endswith("drawn in 'page.html'\n"), "drawn in" in out) == (told, told)
    assert Path("page.html").read_text(encoding="utf-8") == "a page"
