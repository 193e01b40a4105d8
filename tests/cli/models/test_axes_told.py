"""Tolerances of `poekin axes` and `poekin compare` in m and rad, and a whole table of axes."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

import poekin as pk
from poekin.cli.models import axes, compare


@pytest.mark.parametrize(
    ("words", "metres", "radians"),
    [
        ([], 1e-5, math.pi / 180e3),
        (["--tol-mm", "0.75", "--tol-deg", "0.25"], 0.00075, math.pi / 720),
        (["--tol-mm", "1500", "--tol-deg", "90"], 1.5, math.pi / 2),
    ],
)
@pytest.mark.parametrize(
    ("module", "name", "models"), [(axes, "axes", ["ur5e"]), (compare, "compare", ["ur5e", "ur5"])]
)
def test_tolerances_in_mm_and_degrees_are_taken(
    module, name, models, words, metres, radians, monkeypatch, poekin
):
    asked = {}

    def function(*chains, tol_position, tol_rotation, **more):
        asked.update(position=tol_position, rotation=tol_rotation)
        raise pk.errors.InputError("asked")

    monkeypatch.setattr(module, name, function)
    assert poekin(name, *models, *words)[0] == 2
    # a division or a product, each rounded once
    assert asked == {
        "position": pytest.approx(metres, rel=4e-16),
        "rotation": pytest.approx(radians, rel=4e-16),
    }


PAIRS = [
    (1, "one", 2, "two", "skew", True, 0.123456789, 0.0123456789),
    (2, "two", 3, "three", "parallel", False, 0.0, 1.5),
    (3, "three", 5, "[b]", "the same", True, math.pi, None),
]
ROWS = [
    "1 one 2 two skew 7.07355 12.3457",
    "2 two 3 three parallel (at q = 0) 0 1500",
    "3 three 5 [b] the same 180",
]


def test_each_pair_is_a_row_in_degrees_and_mm(monkeypatch, poekin):
    keys = (
        "first",
        "name_first",
        "second",
        "name_second",
        "relation",
        "fixed",
        "angle",
        "distance",
    )
    pairs = [SimpleNamespace(**dict(zip(keys, pair, strict=True))) for pair in PAIRS]
    report = SimpleNamespace(pairs=pairs, shapes=[])
    monkeypatch.setattr(axes, "axes", lambda chain, **_: report)
    code, out, err = poekin("axes", "ur5e", "--tip", "tool0")
    assert (code, err) == (0, "")
    lines = [" ".join(line.split()) for line in out.splitlines() if set(line) - set(" ─")]
    base = pk.load("ur5e").chain(tip="tool0").base
    assert lines == [
        f"Axes of {base} → tool0 at q = 0",
        "axis and axis are angle (deg) distance (mm)",
        *ROWS,
        "no spherical joint and no three parallel axes",
    ]
