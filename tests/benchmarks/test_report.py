"""`python -m benchmarks` from end to end, on the one topic that takes no time."""

from __future__ import annotations

import contextlib
import json
import sys
from pathlib import Path

import pytest

from benchmarks import __main__ as command
from benchmarks import run as measuring
from benchmarks.cases import OPENING, TOPICS, robustness
from benchmarks.fresh import Outcome
from benchmarks.page import QUESTIONS, html, markdown
from benchmarks.report import Figure, Picture, Topic


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
    assert not any(word in page for word in ("<link", "@import", "src=", "setTimeout"))
    document = json.loads((tmp_path / "report" / "results.json").read_text(encoding="utf-8"))
    counts, *_ = (t for topic in document["topics"] for t in topic["tables"])
    assert (document["topics"][0]["name"], document["topics"][0]["section"]) == (
        "operation_counts",
        "Paper",
    )
    assert counts["rows"][0][:7] == [2, 24, 18, 6, 3, 84, 60]
    assert document["machine"]["versions"]["numpy"]


def test_a_topic_that_breaks_off_loses_no_other_figure(monkeypatch, tmp_path, capsys):
    monkeypatch.setitem(TOPICS, "start", _Broken)
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


ABOUT = {"when": "now", "commit": "c", "processor": "p", "cores": 2, "load": 0.0, "system": "s", "python": "3",
         "versions": {}}  # fmt: skip


def test_the_pictures_that_answer_open_the_page_and_stand_there_alone():
    picture = Picture("so exact", "<svg>exact</svg>").answering("exact")
    other = Picture("besides", "<svg>other</svg>")
    topic = Topic("angles", pictures=[other, picture], section="Truth", quick=True)
    page = html([topic], ABOUT, 60.0)
    assert page.count("<svg>exact</svg>") == 1
    assert page.index(QUESTIONS["exact"]) < page.index("<svg>exact</svg>")
    assert page.index("<svg>exact</svg>") < page.index(">Truth</h2>") < page.index("<svg>other")
    assert "so exact (a quick look)" in page
    assert not any(question in page for key, question in QUESTIONS.items() if key != "exact")


def test_every_question_is_answered_by_a_topic_that_is_looked_at_first():
    sources = [Path(TOPICS[name].__file__).read_text(encoding="utf-8") for name in OPENING]
    asked = {key for key in QUESTIONS if any(f'"{key}"' in source for source in sources)}
    assert asked == set(QUESTIONS)


def test_a_page_that_is_being_measured_says_so_and_is_read_again():
    page = html([Topic("t")], ABOUT, 60.0, left=3)
    assert "3 topics are still being measured" in page
    assert "location.reload" in page
    assert "3 topics are still being measured" in markdown([Topic("t")], ABOUT, 60.0, left=3)
    assert "being measured" not in html([Topic("t")], ABOUT, 60.0)


def test_a_look_is_measured_again_and_the_page_is_there_after_the_first(monkeypatch, tmp_path):
    seen = []

    class Looked:
        @staticmethod
        def topic(quick, say):
            path = tmp_path / "report" / "index.html"
            seen.append((quick, path.exists() and "a quick look" in path.read_text("utf-8")))
            return Topic("looked at", figures=[Figure("f", 1.0, 2.0)])

    for place in (command, measuring):
        monkeypatch.setattr(place, "TOPICS", {"one": Looked, "two": Looked})
    monkeypatch.setattr(command, "OPENING", ("two",))
    ready = []
    monkeypatch.setattr(measuring, "workers", lambda: contextlib.nullcontext(map))
    monkeypatch.setattr(measuring, "_ready", ready.append)
    assert _run(monkeypatch, tmp_path) == 0
    assert "group_kernels.so3_exp" in ready
    assert seen == [(True, False), (False, True), (False, True)]
    document = json.loads((tmp_path / "report" / "results.json").read_text(encoding="utf-8"))
    assert [(t["name"], t["quick"]) for t in document["topics"]] == [("one", False), ("two", False)]
    assert document["left"] == 0


def test_the_time_left_is_that_of_the_report_before(tmp_path):
    before = {"topics": [{"name": "start", "seconds": 100, "quick": False},
                         {"name": "robustness", "seconds": 200.0, "quick": False}]}  # fmt: skip
    (tmp_path / "results.json").write_text(json.dumps(before))
    said = []
    run = measuring.Run(tmp_path, ["start", "robustness"], said.append)
    assert run._time_left(look=False) == " (2 of 2 to go, about 5 min)"
    assert run._time_left(look=True) == ""
    (tmp_path / "results.json").write_text("{")
    assert measuring.Run(tmp_path, ["start"], said.append)._time_left(look=False) == ""
