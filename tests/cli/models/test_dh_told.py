"""What `poekin dh` prints of a table: what is less than the error's bound is 0, all else has its digits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import poekin as pk
from poekin.cli.models import dh as command

REACH = 3.0  # m, that of two links of 1 m and 2 m
BOUND = 1e-3
LEAST = 3e-3  # the bound of the error of a length, BOUND REACH


@pytest.fixture(scope="module")
def chain():
    rows = [pk.dh.Row(a=1.0), pk.dh.Row(a=2.0)]
    made = pk.dh.to_chain(pk.dh.Table("standard", rows, name="two"))
    assert made.reach == REACH
    return made


@pytest.mark.parametrize(
    ("value", "shown"),
    [(2.9e-3, "0"), (-2.9e-3, "0"), (3.1e-3, "0.0031"), (-3.1e-3, "-0.0031"), (0.1234567894, "0.123456789")],
)  # fmt: skip
def test_what_is_below_the_bound_in_m_is_a_zero(value, shown, chain, capsys):
    T = np.eye(4)
    T[0, 3] = value
    row = pk.dh.Row(theta=value, d=value, a=value, alpha=value, limits=(value, 0.25))
    slides = pk.dh.Row(theta=value, d=value, a=value, alpha=value, kind="prismatic")
    made = pk.dh.from_chain(chain, convention="standard")
    table = pk.dh.Table("standard", [row, slides], base=T, tool=T)
    command._show(chain, replace(made, table=table, bound=BOUND))
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    first = next(line for line in lines if line[:1] == ["1"])
    assert first[2:] == ["revolute", shown, "+", "x", shown, shown, shown, f"{value:.6g}", "0.25"]
    second = next(line for line in lines if line[:1] == ["2"])
    assert second[2:7] == ["prismatic", shown, shown, "+", "x"]
    for what in ("Base:", "Tool:"):
        at = lines.index([what])
        assert lines[at + 1] == ["1", "0", "0", shown]
        assert lines[at + 2] == ["0", "1", "0", "0"]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({}, 0),
        ({"coupling": [[1, 0], [0, -2]]}, 1),
        ({"coupling": [[1], [1]], "limits": [[-1, 1]]}, 1),
        ({"offset": [0, 0.5]}, 1),
        ({"coupling": [[1, 0], [1, 1]], "offset": [0.25, 0]}, 1),
    ],
)
def test_whose_values_x_are_is_told_where_they_are_not_the_coordinates(change, told, chain, capsys):
    q_names = [f"q{k}" for k in range(len(change.get("limits", "12")))]
    coupled = chain.replace(
        **{"limits": None, "velocity_limits": None, "q_names": q_names} | change
    )
    command._show(coupled, pk.dh.from_chain(chain, convention="standard"))
    sentence = (
        "x are the joints' own values: what follows another joint does so by its ratio and offset"
    )
    assert capsys.readouterr().out.splitlines().count(sentence) == told
