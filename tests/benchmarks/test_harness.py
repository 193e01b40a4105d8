"""The harness's own rules; nothing here depends on how long anything takes."""

from __future__ import annotations

import json
import time

import pytest

from benchmarks.harness import Case, Timed, compare, in_turn, ratio, spread
from benchmarks.page import html, markdown, plain_table, results, summary
from benchmarks.report import Figure, Table, Topic, short

HOSTILE = '<script>alert("x")</script> | `b` \x1b[31m'
ABOUT = {"when": "now", "commit": HOSTILE, "processor": "p", "cores": 2, "load": 0.0, "system": "s", "python": "3",
         "versions": {"numpy": "1"}}  # fmt: skip


def _topic(**fields: object) -> Topic:
    return Topic(
        HOSTILE,
        HOSTILE,
        [Figure(HOSTILE, 1.0, 2.0, note=HOSTILE)],
        [Table(HOSTILE, [HOSTILE], [[HOSTILE]])],
    )


def test_cases_run_in_turn_and_the_order_alternates():
    order: list[str] = []
    cases = [Case(n, lambda: None, lambda _, n=n: order.append(n), lambda s, r: 0.0) for n in "AB"]
    compare(*cases, pairs=4, slice_s=0.0)
    assert "".join(order[-8:]) == "ABBAABBA"


def test_any_number_of_cases_goes_there_and_back():
    order: list[str] = []
    cases = [Case(n, lambda: None, lambda _, n=n: order.append(n), lambda s, r: 0.0) for n in "ABC"]
    timed = in_turn(cases, rounds=3, slice_s=0.0)
    assert "".join(order[-9:]) == "ABCCBAABC"
    assert [(t.name, len(t.each)) for t in timed] == [("A", 3), ("B", 3), ("C", 3)]


def test_a_rest_is_taken_before_each_slice(monkeypatch):
    order: list[str] = []
    monkeypatch.setattr(time, "sleep", lambda seconds: order.append(f"rest {seconds}"))
    case = Case("case", lambda: None, lambda _: order.append("run"), lambda s, r: 0.0)
    in_turn([case], rounds=2, slice_s=0.0, rest_s=0.5)
    assert order[-4:] == ["rest 0.5", "run"] * 2


def test_a_ratio_is_taken_within_each_round():
    def timed(*each: float) -> Timed:
        return Timed("t", spread(list(each)), each, 0.0)

    assert ratio(timed(1.0, 2.0, 30.0), timed(2.0, 4.0, 60.0)).__dict__ == {
        "median": 0.5,
        "lower": 0.5,
        "upper": 0.5,
    }


def test_a_clock_of_the_wall_counts_waiting():
    waits = Case("waits", lambda: None, lambda _: time.sleep(0.05), lambda s, r: 0.0)
    assert in_turn([waits], rounds=2, slice_s=0.01, clock=time.perf_counter)[0].time.median >= 0.05


def test_numbers_that_were_not_measured_leave_a_column_one_of_numbers():
    topic = Topic("t", tables=[Table("c", ["what", "time"], [["a", 1.5], ["b", ""]])])
    assert html([topic], ABOUT, 1.0).count('class="number"') == 3


def test_each_row_of_speed_has_the_error_of_its_own_result():
    first = Case("first", lambda: 3.0, lambda x: x + 1, lambda state, result: abs(result - 4.5))
    second = Case("second", lambda: 3.0, lambda x: x, lambda state, result: abs(result - 3.0))
    c = compare(first, second, pairs=2, slice_s=0.0)
    assert (c.first_error, c.second_error) == (0.5, 0.0)


def test_setup_runs_once_and_outside_the_repetitions():
    made = []
    case = Case("c", lambda: made.append(1), lambda _: None, lambda s, r: 0.0)
    compare(case, Case("d", lambda: None, lambda _: None, lambda s, r: 0.0), pairs=3, slice_s=0.0)
    assert made == [1]


def test_time_without_the_processor_does_not_count():
    waits = Case("waits", lambda: None, lambda _: time.sleep(0.05), lambda s, r: 0.0)
    assert compare(waits, waits, pairs=2, slice_s=0.01).first.median < 0.04


def test_spread_is_median_and_quartiles():
    assert spread([4.0, 1.0, 3.0, 2.0, 5.0]).__dict__ == {"median": 3.0, "lower": 2.0, "upper": 4.0}
    assert spread([7.0]).upper == 7.0


@pytest.mark.parametrize(
    ("figure", "verdict"),
    [
        (Figure("w", 1.0, 2.0), True),
        (Figure("w", 2.0, 2.0), True),
        (Figure("w", 2.1, 2.0), False),
        (Figure("w", float("nan"), 2.0), False),
        (Figure("w", None, 2.0), False),
        (Figure("w", 1.0), None),
        (Figure("w", 1.0, 2.0, holds=False), False),
    ],
)
def test_a_bar_holds_only_where_a_number_was_measured_at_or_below_it(figure, verdict):
    assert figure.verdict is verdict


def test_a_missed_bar_and_a_topic_that_broke_off_are_counted():
    topics = [
        Topic("a", figures=[Figure("x", 1.0, 2.0), Figure("y", 3.0, 2.0)]),
        Topic("b", failure="trace"),
    ]
    assert summary(topics) == "1 of 2 bars hold. These topics broke off: b."
    assert "MISSED" in plain_table(topics)
    assert "MISSED" in html(topics, ABOUT, 1.0)
    assert "trace" in html(topics, ABOUT, 1.0)


def test_hostile_names_are_escaped_on_the_page():
    page = html([_topic()], ABOUT, 1.0)
    assert "<script>alert" not in page
    assert page.count("&lt;script&gt;") >= 6


def test_hostile_names_do_not_break_a_markdown_table():
    text = markdown([_topic()], ABOUT, 1.0)
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert "<script>" not in "".join(rows)
    assert {line.replace("\\|", "").count("|") for line in rows[:3]} == {8}


def test_results_are_json_even_with_numbers_that_are_none():
    topic = Topic(
        "t", figures=[Figure("w", float("inf"), 1.0)], tables=[Table("c", ["x"], [[float("nan")]])]
    )
    assert json.loads(results([topic], ABOUT, 1.0))["topics"][0]["figures"][0]["value"] is None


@pytest.mark.parametrize(
    ("value", "text"),
    [(5, "5"), (0.0, "0"), (0.123456, "0.123"), (6.5e-15, "6.5e-15"), (2e6, "2e+06")],
)
def test_figures_are_shown_to_three_digits(value, text):
    assert short(value) == text
