"""Rows shared out among threads: each row once, and what one of the threads raises is raised here."""

from __future__ import annotations

import os
import threading

import numpy as np
import pytest

from poekin.engine.jit import threads


@pytest.mark.parametrize("size", [0, 1, 3, 4, 5, 8, 9])
def test_every_row_is_handed_out_once_with_its_partner(size):
    a, b, seen = np.arange(size), np.arange(size) * 10.0, []

    def run(x, y):
        assert len(x) <= 4
        seen.append((x.tolist(), y.tolist(), threading.current_thread() is threading.main_thread()))

    threads.share_out(run, a, b, rows=4)
    assert sorted(x for part, _, _ in seen for x in part) == list(range(size))
    assert all([10.0 * x for x in part] == others for part, others, _ in seen)
    assert {here for _, _, here in seen} == {size <= 4}  # a single part needs no thread


def test_parts_are_of_so_many_rows_where_nothing_is_said():
    sizes = []
    threads.share_out(lambda a: sizes.append(len(a)), np.zeros(8193))
    assert sorted(sizes) == [1, 8192]


def test_what_a_part_raises_is_raised():
    def run(part):
        if part[0] == 4:
            raise ValueError("in the second part")

    with pytest.raises(ValueError, match="in the second part"):
        threads.share_out(run, np.arange(12), rows=4)


def test_an_error_in_one_part_takes_those_that_wait_off_the_list():
    release, begun = threading.Event(), []

    def run(part):
        if part[0] == 0:
            raise KeyboardInterrupt
        begun.append(int(part[0]))
        release.wait(10)

    with pytest.raises(KeyboardInterrupt):
        threads.share_out(run, np.arange(500), rows=1)
    release.set()
    threads.share_out(lambda part: None, np.arange(2), rows=1)  # behind all that waits
    assert len(begun) < 250


def test_there_are_as_many_processors_as_this_process_may_use(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", {0: {3, 5, 9}}.get, raising=False)
    assert threads.processors() == 3
    monkeypatch.delattr(os, "sched_getaffinity")
    for known, number in ((6, 6), (1, 1), (None, 1)):
        monkeypatch.setattr(os, "cpu_count", lambda known=known: known)
        assert threads.processors() == number
