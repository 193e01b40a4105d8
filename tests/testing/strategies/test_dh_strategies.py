"""The strategies for DH tables: what they draw on purpose, and what they shrink to."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import find

from poekin.formats.dh import Row
from poekin.testing.strategies import dh_strategies
from tests.testing.drawing import QUICK, drawn
from tests.versions import SHRINKS, needs


def test_quarter_turns_are_drawn_and_missed_by_a_little_either_way():
    angles = np.array(drawn(dh_strategies.angles()))
    off = np.abs(angles[:, None] - np.array(dh_strategies.QUARTERS)).min(1)
    assert set(dh_strategies.QUARTERS) <= set(angles)
    # Near π the smallest misses are rounded to multiples of 4e-16.
    assert {round(k) for k in np.log10(off[off > 0])} >= set(range(-11, -3))
    assert off.max() > 0.5
    turns = np.array(dh_strategies.QUARTERS)
    assert np.cos(turns) == pytest.approx([1, 0, 0, -1], abs=1e-15)
    assert np.sin(turns) == pytest.approx([0, 1, -1, 0], abs=1e-15)
    assert [10.0**k for k in dh_strategies.POWERS] == pytest.approx([1e-12, 1e-3])
    missed = angles[(off > 0) & (off < 1e-4)]
    for quarter in dh_strategies.QUARTERS:
        beside = (missed - quarter)[np.abs(missed - quarter) < 1e-3]
        assert beside.min() < 0 < beside.max()
    assert -3 <= angles.min() < -2.5
    assert ((angles > 2.5) & (angles <= 3)).any()
    assert angles.max() < math.pi + 1.001e-3


def test_lengths_are_zero_tiny_and_up_to_two_metres():
    either = np.array(drawn(dh_strategies.lengths()))
    assert -2 <= either.min() < -1.5
    assert 1.5 < either.max() <= 2
    lengths = np.abs(either)
    assert (lengths == 0).any()
    assert ((lengths > 0) & (lengths < 1e-6)).any()


def test_mounts_are_in_their_place_or_from_a_millimetre_to_two_metres_off():
    away = np.array([np.linalg.norm(T[:3, 3]) for T in drawn(dh_strategies.mounts())])
    assert (away == 0).any()
    assert 1e-3 * (1 - 1e-15) <= away[away > 0].min() < 0.01
    assert 1 < away.max() <= 2 * (1 + 1e-15)


def test_tables_are_of_both_conventions_and_kinds_with_flips_base_and_tool():
    tables = drawn(dh_strategies.tables(), 200)
    rows = [row for table in tables for row in table.rows]
    assert {table.convention for table in tables} == set(dh_strategies.CONVENTIONS)
    assert {(row.kind, row.flip) for row in rows} == {
        (k, f) for k in ("revolute", "prismatic") for f in (False, True)
    }
    lengths = [len(table) for table in tables]
    assert (min(lengths), max(lengths)) == (1, 10)
    assert any(
        (table.base != np.eye(4)).any() and (table.tool != np.eye(4)).any() for table in tables
    )
    assert {
        table.convention for table in drawn(dh_strategies.tables(conventions=("modified",)), 20)
    } == {"modified"}


def test_a_table_shrinks_to_one_row_of_zeros():
    needs("hypothesis", SHRINKS)
    table = find(dh_strategies.tables(), lambda _: True, settings=QUICK)
    assert (table.convention, len(table)) == ("standard", 1)
    assert table.rows[0] == Row(name="joint1")
    twisted = find(dh_strategies.tables(), lambda t: math.sin(t.alpha[0]) > 0.5, settings=QUICK)
    assert twisted.alpha[0] == math.pi / 2
