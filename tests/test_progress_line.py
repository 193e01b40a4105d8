"""Line of progress: in a terminal, in a notebook, in a file."""

from __future__ import annotations

import io
import sys
from typing import Any

import pytest

import poekin as pk
from poekin import progress_line
from poekin.errors import InputError
from tests.terminal import Terminal

CLEAR = "\r\x1b[K"


class Cell(io.StringIO):
    """What a notebook's cell writes to."""


Cell.__module__ = "ipykernel.iostream"


@pytest.fixture
def clock(monkeypatch):
    """A clock that stands until it is set."""
    now = [1.0]
    monkeypatch.setattr(progress_line.time, "monotonic", lambda: now[0])
    return now


@pytest.fixture
def run(clock, monkeypatch):
    """Function that gives what calls at these times write to a stream."""

    def of(stream, calls, what="reading"):
        monkeypatch.setattr(sys, "stderr", stream)
        with pk.ProgressLine(what) as progress:
            for time, *words in calls:
                clock[0] = 1.0 + time
                progress(*words)
        return stream.getvalue()

    return of


def test_in_a_file_it_is_a_line_when_its_pause_is_over(run):
    calls = [(9.9, 1, 0), (10.0, 2, 0, "x\n"), (19.9, 3, 0), (20.1, 4, 0)]
    assert run(io.StringIO(), calls, "read\nings") == ("read\\nings: 2, x\\n\nread\\nings: 4\n")


@pytest.mark.parametrize("stream", [Terminal, Cell])
def test_in_a_terminal_and_a_notebook_it_is_one_line_that_goes_away(run, stream):
    calls = [(0.4, 1, 0), (0.5, 2, 0), (0.59, 3, 0), (0.61, 4, 0)]
    assert run(stream(), calls) == f"{CLEAR}reading: 2{CLEAR}reading: 4{CLEAR}"


def test_a_line_without_an_end_is_seen_at_once(clock, monkeypatch):
    stream = Terminal()
    monkeypatch.setattr(sys, "stderr", stream)
    with pk.ProgressLine("reading") as progress:
        clock[0] += 0.5
        progress(1, 0)
        assert stream.seen == f"{CLEAR}reading: 1"
    assert stream.seen == f"{CLEAR}reading: 1{CLEAR}"


def test_rate_and_time_left_are_by_what_was_done_since_the_first_call(run):
    # 100 were there already, kept by a run before
    calls = [(10.0, 100, 1000), (20.0, 400, 1000, "x"), (40.0, 700, 1000), (60.0, 1000, 1000)]
    assert run(io.StringIO(), calls) == (
        "reading: 100 of 1000\n"
        "reading: 400 of 1000, 30 a second, 20 s left, x\n"
        "reading: 700 of 1000, 20 a second, 15 s left\n"
        "reading: 1000 of 1000, 18 a second, 0 s left\n"
    )


def test_a_name_that_is_no_text_is_refused():
    wrong: Any = 3
    with pytest.raises(InputError, match=r"^what: expected the name of the work, got 3$"):
        pk.ProgressLine(wrong)


def test_nothing_done_has_no_rate(run):
    assert run(io.StringIO(), [(10.0, 5, 7), (20.0, 5, 7)]) == "reading: 5 of 7\n" * 2


@pytest.mark.parametrize("stream", [Terminal, Cell, io.StringIO])
def test_short_work_shows_nothing(run, stream):
    assert run(stream(), [(0.49, 1, 2)]) == ""


def test_a_line_is_cut_where_it_is_written_again_alone(run):
    assert run(Terminal(), [(20.0, 1, 10)], "x" * 200) == f"{CLEAR}{'x' * 100}{CLEAR}"
    assert run(io.StringIO(), [(40.0, 1, 10)], "x" * 200) == f"{'x' * 200}: 1 of 10\n"
