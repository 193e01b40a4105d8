"""Pictures have the size and the letters that were asked for, and are the same each time."""

from __future__ import annotations

import re
import sys

import pytest

from poekin import svg
from poekin.errors import MissingExtra

pytest.importorskip("matplotlib")


@pytest.fixture(scope="module")
def picture():
    """An SVG file of 2 by 1 inches with a curve that is clipped, and a word."""

    def draw(figure):
        axes = figure.add_subplot()
        axes.plot([0, 1], [0, 1])
        axes.set_title("a word")

    return [svg.svg(2, 1, "a test", draw) for _ in range(2)]


def test_the_same_numbers_give_the_same_text_without_a_date(picture):
    first, second = picture
    assert first == second
    assert "clip-path" in first
    assert "<dc:date>" not in first
    assert "<dc:creator>" not in first


def test_a_size_in_inches_is_72_points_each(picture):
    assert re.search(r'<svg [^>]*width="144pt"', picture[0])
    assert re.search(r'<svg [^>]*height="72pt"', picture[0])


@pytest.mark.parametrize("size, said", [((), "9px"), ((7,), "7px")])
def test_words_stay_words_of_nine_points_or_of_the_size_asked_for(size, said):
    word = svg.svg(2, 1, "a test", lambda figure: figure.text(0, 0, "a word"), *size)
    assert ">a word</text>" in word
    assert re.findall(r"\b\d+px", word) == [said]


def test_what_goes_into_a_page_begins_with_the_picture(picture):
    inner = svg.inline(picture[0])
    assert inner.startswith("<svg ")
    assert picture[0].endswith(inner)
    assert "<?xml" not in inner


def test_a_label_is_forty_characters_long_and_no_formula():
    assert svg.label("$q$") == r"\$q\$"
    assert svg.label("x" * 40) == "x" * 40
    assert svg.label("x" * 41) == "x" * 39 + "…"
    assert svg.label("joint\x1b", 8) == r"joint\x…"


def test_a_plain_frame_is_open_at_the_top_and_on_the_right():
    axes = svg.new_figure(2, 1, "a test").add_subplot()
    svg.plain(axes)
    seen = {side for side, spine in axes.spines.items() if spine.get_visible()}
    assert seen == {"left", "bottom"}


def test_without_matplotlib_the_extra_and_the_purpose_are_said(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    message = "a test needs the package matplotlib: pip install 'poekin[report]'"
    for call in (svg.new_figure, lambda *size: svg.svg(*size, draw=pytest.fail)):
        with pytest.raises(MissingExtra) as caught:
            call(2, 1, "a test")
        assert str(caught.value) == message
