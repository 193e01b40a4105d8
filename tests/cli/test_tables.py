"""Tables on the command line: words begin below their heads, numbers end below theirs."""

from __future__ import annotations

import itertools
import re

import pytest

from poekin.cli.kinematics import singularity
from poekin.cli.models import axes, compare, count, dh, info, validate

S = ["wx", "wy", "wz", "vx", "vy", "vz", "lower", "upper"]
TABLES = {
    "info chain": (info, ["stanford", "--tip", "tool"], ["joint", "kind", "coordinate"], S),
    "info robot": (info, ["panda"], ["base", "tip"], ["joints", "coordinates", "reach (m)"]),
    "info screws": (info, ["panda"], ["joint", "kind", "coordinate"], S),
    "axes": (axes, ["stanford"], ["axis", "and axis", "are"], ["angle (deg)", "distance (mm)"]),
    "count": (count, ["stanford"], ["frame"], ["×", "+", "sin/cos", "with pose: ×"]),
    "compare": (
        compare,
        ["ur5e", "ur3e"],
        ["joint", "kind", "axis"],
        ["angle (deg)", "normal (mm)", "limits"],
    ),
    "dh": (
        dh,
        ["stanford"],
        ["joint", "kind"],
        ["theta (rad)", "a (m)", "alpha (rad)", "lower", "upper"],
    ),
    "singularity": (
        singularity,
        ["stanford", "--at", "0 0 0.5 0 1 0"],
        ["Jacobian (rad, m)"],
        ["Yoshikawa", "condition", "smallest singular value"],
    ),
    "validate": (
        validate,
        ["stanford", "--samples", "2"],
        ["robot", "worst chain"],
        ["chains", "pose", "J space", "J body", "J hybrid"],
    ),
}


@pytest.mark.parametrize("case", TABLES)
def test_words_begin_below_their_heads_and_numbers_end_below_theirs(case, poekin):
    if case == "validate":
        pytest.importorskip("pinocchio")
    module, more, words, numbers = TABLES[case]
    lines = poekin(module.__name__.rpartition(".")[2], *more)[1].splitlines()
    found = [
        {m[0]: m.span() for m in reversed(list(re.finditer(r"\S+(?: \S+)*", line)))}
        for line in lines
    ]
    at = next(i for i, heads in enumerate(found) if {*words, *numbers} <= set(heads))
    assert set(lines[at + 1]) == {"─"}
    width = len(lines[at + 1])
    rows = list(itertools.takewhile(lambda line: len(line) == width, lines[at + 2 :]))
    assert rows
    for head in (*words, *numbers):
        begin, end = found[at][head]
        cells = [row for row in rows if row[begin:end].strip()]
        assert cells
        inner, outer = (
            (begin, row_before(begin)) if head in words else (end - 1, slice(end, end + 2))
        )
        assert [row for row in cells if row[inner] == " " or row[outer].strip()] == [], head


def row_before(begin: int) -> slice:
    return slice(max(begin - 2, 0), begin)
