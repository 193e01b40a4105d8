"""Comments above the header of a CSV file, and a header in a comment."""

from __future__ import annotations

import pytest

from poekin.formats.text.csv_dialect import with_header


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a,b\n1,2\n", "a,b\n1,2\n"),
        ("# x\n\na,b\n1,2\n", "\n\na,b\n1,2\n"),
        ("# a,b\n1,2\n", "a,b\n1,2\n"),
        ("# x\n# a,b\n\n1,2\n", "\na,b\n\n1,2\n"),
        ("  // a b\n1 2\n", "a b\n1 2\n"),
        ("%a;b\n 1;-2e3; \n", "a;b\n 1;-2e3; \n"),
        ("## a,b\n1,2\n# end\n", "a,b\n1,2\n# end\n"),
        ("# x\nq,1\n", "\nq,1\n"),
        ("#,a\n1,2\n", "#,a\n1,2\n"),
        ("# joint#1,joint#2\n1,2\n", "joint#1,joint#2\n1,2\n"),
        ("# ;a\n1;2\n", "# ;a\n1;2\n"),
        ("\n1,2\n", "\n1,2\n"),
        ("# a\n\n", "# a\n\n"),
        ("", ""),
    ],
)
def test_lines_stay_where_they_are_and_comments_are_empty_but_for_the_header(text, expected):
    lines = text.splitlines(keepends=True)
    assert "".join(with_header(iter(lines))) == expected
