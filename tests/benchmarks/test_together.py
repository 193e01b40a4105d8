"""Topics that run side by side: they measure no time, and the page holds what each of them says."""

from __future__ import annotations

import contextlib
import inspect
import json
import pickle
import re
import sys

import pytest

from benchmarks import __main__ as command
from benchmarks import peers
from benchmarks import run as measuring
from benchmarks.cases import TOPICS, UNTIMED
from benchmarks.report import Figure, Topic

CLOCKS = re.compile(r"perf_counter|monotonic|harness|in_turn|workers|ProcessPool|fresh import")


class _Sound:
    @staticmethod
    def topic(quick, say):
        say("half of it")
        names = ", ".join(found.peer.name for found in peers.chosen())
        return Topic("sound", figures=[Figure(f"beside {names}", 1.0, 2.0)])


class _Broken:
    @staticmethod
    def topic(quick, say):
        raise ValueError("planted")


@pytest.fixture
def run(monkeypatch, tmp_path):
    topics = {"first": _Sound, "second": _Broken, "timed": _Sound}
    shared = []

    def share(function, *arguments):
        shared.append(function.__name__)
        return [
            pickle.loads(pickle.dumps(function(*each))) for each in zip(*arguments, strict=True)
        ]

    for place in (command, measuring):
        monkeypatch.setattr(place, "TOPICS", topics)
    monkeypatch.setattr(measuring, "UNTIMED", ("second", "first"))
    monkeypatch.setattr(measuring, "kernels", dict)
    monkeypatch.setattr(command, "OPENING", ("first", "second"))
    # In this process, but each result as it comes from another one.
    monkeypatch.setattr(measuring, "workers", lambda: contextlib.nullcontext(share))

    def run(*words):
        monkeypatch.setattr(sys, "argv", ["benchmarks", "--output", str(tmp_path), *words])
        return command.main()

    run.shared = shared  # type: ignore[attr-defined]

    yield run
    peers.use(["standard"])


@pytest.mark.parametrize("name", UNTIMED)
def test_a_topic_that_runs_beside_others_asks_no_clock_that_they_slow_down(name):
    assert not CLOCKS.findall(inspect.getsource(TOPICS[name]))


@pytest.mark.parametrize("name", ["peers", "conformance", "compile_time", "follow"])
def test_a_topic_with_a_clock_or_processes_is_told_from_the_others(name):
    source = inspect.getsource(TOPICS[name])
    assert CLOCKS.findall(source) or "fresh" in source
    assert name not in UNTIMED


def test_topics_side_by_side_are_all_on_the_page_and_one_that_breaks_off_ends_no_other(
    run, tmp_path, capsys
):
    assert run("--only", "first", "second", "timed", "--quick", "--peers", "scipy") == 1
    said = capsys.readouterr().out
    assert said.index("second, first …") < said.index("timed …")
    assert "first: half of it" in said
    document = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    first, second, timed = document["topics"]
    assert "ValueError: planted" in second["failure"]
    assert [topic["name"] for topic in (first, second, timed)] == ["first", "second", "timed"]
    assert first["figures"][0]["what"] == "beside SciPy"
    assert first["quick"]
    assert document["left"] == 0


def test_a_look_is_side_by_side_too_and_is_followed_by_the_measurement(run, tmp_path, capsys):
    assert run() == 1
    said = capsys.readouterr().out
    # what is looked at and what is measured, each with its lines of progress
    assert said.count("second, first …") == 2
    assert said.count("first: half of it") == 2
    topics = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["topics"]
    assert [topic["quick"] for topic in topics] == [False, False, False]
    # kernels first: nobody waits for one in a topic
    assert run.shared == ["_ready", "_apart", "_apart"]


def test_the_names_of_the_chosen_peers_choose_them_again():
    peers.use(["jaxlie", "scipy"])
    names = peers.chosen_names()
    peers.use(["standard"])
    assert names == ["scipy", "jaxlie"]
    peers.use(names)
    assert [found.peer.name for found in peers.chosen()] == ["SciPy", "jaxlie"]
    peers.use(["standard"])
