"""Sequences of parts of one array: views, padded, chosen; nothing is made before it is asked for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.solve.ragged import LazySequence, Ragged

COUNTS = st.lists(st.integers(0, 5), max_size=12)


def made(counts: list[int]) -> tuple[Ragged, list[list[list[float]]]]:
    total = sum(counts)
    rows = np.arange(2.0 * total).reshape(total, 2)
    parts = np.split(rows, np.cumsum(counts)[:-1]) if counts else []
    return Ragged(rows, np.array(counts, int)), [part.tolist() for part in parts]


@given(COUNTS)
def test_items_are_the_parts_of_the_array_in_order(counts):
    ragged, parts = made(counts)
    assert [item.tolist() for item in ragged] == parts
    assert len(ragged) == len(counts)
    assert ragged.counts.tolist() == counts
    assert ragged.owner.tolist() == [k for k, n in enumerate(counts) for _ in range(n)]
    for k in range(len(counts)):
        assert ragged[k].tolist() == ragged[k - len(counts)].tolist() == parts[k]
    assert [item.tolist() for item in ragged[1::2]] == parts[1::2]


@given(COUNTS)
def test_padded_items_have_their_own_rows_first_and_then_the_filling(counts):
    ragged, parts = made(counts)
    whole = ragged.padded(-1.0)
    assert whole.shape == (len(counts), max(counts, default=0), 2)
    for row, part in zip(whole.tolist(), parts, strict=True):
        assert row[: len(part)] == part
        assert all(x == [-1.0, -1.0] for x in row[len(part) :])


@given(COUNTS, st.data())
def test_a_part_and_some_chosen_are_as_those_of_a_list(counts, data):
    ragged, parts = made(counts)
    numbers = sorted(
        data.draw(st.sets(st.sampled_from(range(len(counts))) if counts else st.nothing()))
    )
    chosen = ragged.chosen(np.array(numbers, int))
    assert [item.tolist() for item in chosen] == [parts[k] for k in numbers]
    first = data.draw(st.integers(0, len(counts)))
    end = data.draw(st.integers(first, len(counts) + 3))
    assert [item.tolist() for item in ragged.part(first, end)] == parts[first:end]


def test_nothing_is_made_before_it_is_asked_for():
    asked: list[int] = []
    lazy = LazySequence(5, lambda k: asked.append(k) or f"item {k}")
    assert (len(lazy), repr(lazy), asked) == (5, "<LazySequence of 5>", [])
    assert (lazy[np.int64(-2)], asked) == ("item 3", [3])
    assert lazy[3:] == ["item 3", "item 4"]
    for outside in (5, 6, 1000, -6):
        with pytest.raises(IndexError, match=f"index {outside} is out of bounds for 5 targets"):
            lazy[outside]
    wrong: Any = 1.0
    with pytest.raises(TypeError):
        lazy[wrong]
