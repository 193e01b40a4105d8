"""What `poekin compare` says beside its table: where a page is, and which option helps which model."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from poekin.cli.models import compare


class Page:
    """A page that is as good as empty."""

    def save(self, place: Path) -> None:
        place.write_text("a page", encoding="utf-8")


@pytest.mark.parametrize(("more", "told"), [([], True), (["--json"], False)])
def test_a_page_has_the_names_of_both_and_is_told_of_last(
    more, told, crane, tmp_path, monkeypatch, poekin
):
    monkeypatch.chdir(tmp_path)
    other = Path(crane).read_text(encoding="utf-8").replace('"crane"', '"other"')
    Path("other.urdf").write_text(other, encoding="utf-8")
    models = [crane, "other.urdf", "--tip", "hook", "--samples", "3"]
    titles = []
    monkeypatch.setattr(compare, "comparison_scene", lambda result, title: titles.append(title))
    monkeypatch.setattr(compare, "page", lambda scene: Page())
    code, out, err = poekin("compare", *models, "--draw", "page.html", *more)
    assert (code, err, titles) == (0, "", ["crane and other"])
    assert (out.endswith("drawn in 'page.html'\n"), "drawn in" in out) == (told, told)
    assert Path("page.html").read_text(encoding="utf-8") == "a page"
    assert poekin("compare", *models, *more)[1] == out.removesuffix("drawn in 'page.html'\n")


@pytest.mark.parametrize(
    ("model", "end", "said"),
    [
        ("a", "tip", "model a: it is longer: --tip hand"),
        ("a", "base", "model a: it is longer: --base hand"),
        ("b", "tip", "model b: it is longer: --tip-b hand"),
        ("b", "base", "model b: it is longer: --base-b hand"),
    ],
)
def test_a_remedy_is_an_option_of_the_model_that_it_helps(model, end, said):
    remedy: Any = SimpleNamespace(model=model, end=end, link="hand", reason="it is longer")
    assert compare._remedy_words(remedy) == said


@pytest.mark.parametrize(
    ("text", "words"),
    [("", ()), (" ", ()), ("limits", ("limits",)), (" names , limits", ("names", "limits"))],
)
def test_what_may_not_differ_is_words_with_commas_between(text, words):
    assert set(compare._conventions(text)) == set(words)
