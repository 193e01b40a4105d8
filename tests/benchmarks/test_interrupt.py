"""Ctrl-C while `python -m benchmarks` measures: what is measured is kept, on a page that is whole."""

from __future__ import annotations

import json
import sys

import pytest

from benchmarks import __main__ as command
from benchmarks import peers
from benchmarks import run as measuring
from benchmarks.report import Figure, Topic


class _Done:
    @staticmethod
    def topic(quick, say):
        return Topic("done before", figures=[Figure("a figure", 1.0, 2.0)])


class _Interrupted:
    @staticmethod
    def topic(quick, say):
        raise KeyboardInterrupt


@pytest.fixture
def run(monkeypatch, tmp_path):
    topics = {"first": _Done, "second": _Interrupted, "third": _Done}
    for place in (command, measuring):
        monkeypatch.setattr(place, "TOPICS", topics)
    monkeypatch.setattr(measuring, "kernels", dict)
    monkeypatch.setattr(command, "OPENING", ("first",))

    def run(*words: str) -> int:
        monkeypatch.setattr(sys, "argv", ["benchmarks", "--output", str(tmp_path), *words])
        return command.main()

    yield run
    peers.use(["standard"])


def test_ctrl_c_keeps_what_is_measured_and_says_what_is_not(run, tmp_path, capsys):
    assert run() == command.INTERRUPTED == 130
    out = capsys.readouterr().out
    assert "1 of 1 bars hold. These topics broke off: second." in out
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "a figure" in page
    assert "Ctrl-C: not measured: second, third" in page
    document = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert [topic["title"] for topic in document["topics"]] == ["done before", "second"]


def test_ctrl_c_in_the_last_topic_is_an_interruption_too(run):
    assert run("--only", "first", "second") == 130
    assert run("--only", "first", "third") == 0


def test_ctrl_c_while_a_page_is_written_leaves_the_page_that_was_there(run, tmp_path, monkeypatch):
    (tmp_path / "index.html").write_text("as it was")

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(measuring.Path, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run("--only", "first")
    assert [path.name for path in tmp_path.iterdir()] == ["index.html"]
    assert (tmp_path / "index.html").read_text() == "as it was"


def test_the_peers_of_a_run_are_chosen_on_the_command_line(run, capsys):
    assert run("--only", "first", "--peers", "standard", "pytorch_kinematics") == 0
    assert [found.peer.name for found in peers.chosen()][-1] == "pytorch_kinematics"
    with pytest.raises(SystemExit):
        run("--peers", "rbdl")
    assert "invalid choice: 'rbdl'" in capsys.readouterr().err


def test_results_name_the_version_of_every_peer_or_its_absence(run, tmp_path):
    run("--only", "first")
    versions = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["machine"][
        "versions"
    ]
    assert {
        peer.distribution for peer in (peers.STANDARD | peers.OPTIONAL).values()
    } <= versions.keys()
