"""Parts of a page: well formed, and every text in them escaped."""

from __future__ import annotations

import pytest

from poekin import html_page


def test_texts_are_escaped_and_keep_their_line_breaks():
    assert html_page.text('<a b="c">\n\x1b') == "&lt;a b=&quot;c&quot;&gt;\n\\x1b"
    assert html_page.text("long", 3) == "lo…"


def test_an_element_has_a_class_where_there_is_one():
    assert html_page.element("p", "<b>") == "<p><b></p>"
    assert html_page.paragraph("a & b", "lead") == '<p class="lead">a &amp; b</p>'


def test_a_table_has_heads_and_rows_of_their_classes():
    rows = [html_page.row(["a", "1"], ["word", "number"], kind="missed")]
    assert html_page.table(["of", "value"], ["word", "number"], rows) == (
        '<div class="wide"><table><thead><tr><th class="word">of</th><th class="number">value</th></tr>'
        '</thead><tbody>\n<tr class="missed"><td class="word">a</td><td class="number">1</td></tr>\n'
        "</tbody></table></div>"
    )


def test_a_row_has_a_class_for_each_cell():
    for kinds in (["word"], ["word", "number", "word"]):
        with pytest.raises(ValueError, match="zip"):
            html_page.row(["a", "1"], kinds)


def test_figures_and_folded_parts_have_their_words():
    caption = "<figcaption>x &lt; 1</figcaption>"
    assert html_page.figure("<svg/>", "x < 1") == f"<figure><svg/>{caption}</figure>"
    assert html_page.details("all", "x") == "<details><summary>all</summary>x</details>"


def test_a_page_holds_its_parts_and_its_own_style_last():
    page = html_page.page("<title>", ["<p>1</p>", "<p>2</p>"], "p { color: red; }\n")
    assert page.count("&lt;title&gt;") == 2
    assert "<p>1</p>\n<p>2</p>\n</body>" in page
    assert "p { color: red; }\n</style>" in page


def test_a_title_is_cut_at_200_characters():
    longest, longer = html_page.page("t" * 200, []), html_page.page("t" * 201, [])
    assert longest.count(f">{'t' * 200}<") == 2
    assert longer.count(f">{'t' * 199}…<") == 2
