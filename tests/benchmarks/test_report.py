"""`python -m benchmarks` from end to end, on the one topic that takes no time."""

from __future__ import annotations

import json
import sys

import pytest

from benchmarks import __main__ as command
from benchmarks.cases import robustness
from benchmarks.fresh import Outcome


class _Broken:
    @staticmethod
    def topic(quick, say):
        raise RuntimeError("<b>gone</b>")


def _run(monkeypatch, tmp_path, *words):
    monkeypatch.setattr(sys, "argv", ["benchmarks", "--output", str(tmp_path / "report"), *words])
    return command.main()


def test_the_report_is_written_and_says_where_it_is(monkeypatch, tmp_path, capsys):
    assert _run(monkeypatch, tmp_path, "--quick", "--only", "operation_counts") == 0
    out = capsys.readouterr().out
    assert out.splitlines()[-1] == f"The report: {tmp_path / 'report' / 'index.html'}"
    assert "12 of 12 bars hold." in out
    page = (tmp_path / "report" / "index.html").read_text(encoding="utf-8")
    assert "<svg" in page
    assert not any(word in page for word in ("<script", "<link", "@import", "src="))
    document = json.loads((tmp_path / "report" / "results.json").read_text(encoding="utf-8"))
    counts, *_ = (t for topic in document["topics"] for t in topic["tables"])
    assert counts["rows"][0][:7] == [2, 24, 18, 6, 3, 84, 60]
    assert document["machine"]["versions"]["numpy"]


def test_a_topic_that_breaks_off_loses_no_other_figure(monkeypatch, tmp_path, capsys):
    monkeypatch.setitem(command.TOPICS, "start", _Broken)
    assert _run(monkeypatch, tmp_path, "--quick", "--only", "start", "operation_counts") == 1
    out = capsys.readouterr().out
    assert "the paper's table by counting" in out
    assert "These topics broke off: start." in out
    assert "&lt;b&gt;gone" in (tmp_path / "report" / "index.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("outcome", "value"),
    [(Outcome(0, "1.5\n", ""), 1.5), (Outcome(1, "1.5\n", "x"), None), (Outcome(0, "", ""), None)],
)
def test_a_process_that_failed_has_no_result(outcome, value):
    assert robustness._value(outcome) == value


def test_an_old_kernel_after_an_edit_is_wrong(monkeypatch, tmp_path):
    monkeypatch.setattr(robustness, "run", lambda *_, **__: Outcome(0, "1.0", ""))
    assert [good for _, good, _ in robustness._edit(tmp_path, 1.0)] == [False, True]


def test_an_edit_that_breaks_everything_proves_nothing(monkeypatch, tmp_path):
    monkeypatch.setattr(robustness, "run", lambda *_, **__: Outcome(1, "", "broken"))
    assert [good for _, good, _ in robustness._edit(tmp_path, 1.0)] == [False, False]
