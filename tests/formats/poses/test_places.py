"""Lines of a text that pieces of it stand on, as messages call them."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from poekin.formats.poses.places import places


@given(st.text("ab \t\n\r\x0b", max_size=30))
def test_a_place_is_the_line_that_it_begins_on_counted_from_1(text):
    starts = range(len(text))
    found = places(text, list(starts), "f.txt")
    assert found == [f"f.txt:{len(text[:start].split(chr(10)))}" for start in starts]
