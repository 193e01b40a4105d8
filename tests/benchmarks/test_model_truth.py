"""The report's judges of DH, URDF and compare: they agree with what is known, and they catch what
is wrong.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import poekin as pk
from benchmarks import calibrated_arm, dh_judge
from benchmarks.cases import model_truth_compare, model_truth_robots, model_truth_tables
from poekin.formats.dh import Row, Table


def silent(_: str) -> None:
    """No line of progress."""


ROWS = [
    Row(0.3, 0.1, 0.2, 1.0, flip=True),
    Row(0.5, 0.2, 0.1, -0.7, "prismatic"),
    Row(0.7, 0.3, 0.4, 0.2),
]
X = np.array([0.4, -0.3, 0.9])


@pytest.mark.parametrize(
    ("table", "position"),
    [
        (Table("standard", [Row(a=2.0), Row(a=1.0)]), (-1.0, 2.0, 0.0)),
        (Table("modified", [Row(a=2.0), Row(a=1.0)]), (2.0, 1.0, 0.0)),
        (
            Table("standard", [Row(alpha=math.pi / 2), Row(kind="prismatic")]),
            (math.pi / 2, 0.0, 0.0),
        ),
        (Table("standard", [Row(a=2.0, flip=True), Row(a=1.0, flip=True)]), (-1.0, -2.0, 0.0)),
    ],
    ids=["standard", "modified", "slides along x", "flipped"],
)
def test_the_product_of_links_is_what_one_sees_on_paper(table, position):
    T = dh_judge.product(table, np.array([math.pi / 2, math.pi / 2]))
    np.testing.assert_allclose(T[:3, 3], position, rtol=0, atol=2e-16)


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("lost", ["flip", "kind", "theta", "base", "tool", "convention"])
def test_the_product_of_links_sees_what_is_lost(convention, lost):
    base, tool = pk.se3.exp([[0.1, 0.2, 0.3, 0.4, 0.5, 0.6], [0.3, 0.1, 0.2, 0.1, 0.2, 0.3]])
    table = Table(convention, ROWS, base=base, tool=tool)
    changed = (
        {"standard": "modified", "modified": "standard"}[convention]
        if lost == "convention"
        else convention
    )
    rows = (
        [dataclasses.replace(r, **{lost: getattr(Row(), lost)}) for r in ROWS]
        if hasattr(Row(), lost)
        else ROWS
    )
    wrong = Table(
        changed,  # type: ignore[arg-type]
        rows,
        base=None if lost == "base" else base,
        tool=None if lost == "tool" else tool,
    )
    expected = dh_judge.product(table, X)
    assert dh_judge.error(pk.dh.to_chain(table).fk(X), expected, 1.0) < 1e-15
    assert dh_judge.error(pk.dh.to_chain(wrong).fk(X), expected, 1.0) > 1e-3


def test_random_tables_have_everything_that_tables_go_wrong_on():
    rng = np.random.default_rng(0)
    for convention in pk.dh.table.CONVENTIONS:
        tables = [model_truth_tables.random_table(rng, convention) for _ in range(150)]
        assert {len(table) for table in tables} == set(range(1, 11))
        assert all(number > 0 for _, number in model_truth_tables._contents(tables))
        shares = [dh_judge.largest(table, pk.dh.to_chain(table).reach) for table in tables]
        assert sum(share <= dh_judge.FAR for share in shares) > 100
        assert sum(share > dh_judge.FAR for share in shares) > 10
        alphas = [row.alpha for table in tables for row in table.rows]
        assert all(alphas.count(quarter) > 10 for quarter in model_truth_tables.QUARTERS)


def test_a_far_table_is_judged_by_its_bounds_and_a_near_one_by_the_bar():
    q = np.random.default_rng(0).uniform(-3, 3, (5, 6))
    near = dh_judge.there_and_back(pk.load("puma560").chain(), "modified", q)
    assert near.well
    assert near.error < 1e-14
    far = dh_judge.there_and_back(pk.dh.to_chain(calibrated_arm.UR10E), "standard", q)
    assert (far.well, far.dropped) == (False, ())
    assert far.error <= far.bound <= far.ceiling < 1e-9


def nearly_parallel() -> pk.Chain:
    angle = 1e-9
    axes = [
        pk.screw.revolute([0, 0, 1], [0, 0, 0]),
        pk.screw.revolute([math.sin(angle), 0, 1], [0.4, 0, 0]),
    ]
    return pk.Chain.from_space(axes, np.eye(4))


def test_a_dropped_angle_counts_only_where_it_is_said(monkeypatch):
    q = np.ones((1, 2))
    said = dh_judge.there_and_back(nearly_parallel(), "standard", q)
    assert said.dropped == (1e-9,)
    assert said.error <= said.bound <= said.ceiling
    honest = dh_judge.dh.from_chain
    monkeypatch.setattr(
        dh_judge.dh,
        "from_chain",
        lambda *a, **k: dataclasses.replace(honest(*a, **k), warnings=("something else",)),
    )
    unsaid = dh_judge.there_and_back(nearly_parallel(), "standard", q)
    assert unsaid.error > dh_judge.WELL
    assert unsaid.well


def test_the_topic_of_tables_holds_and_a_lost_tool_is_missed(monkeypatch):
    topic = model_truth_tables.topic(True, silent)
    assert len(topic.figures) == 8
    assert {figure.verdict for figure in topic.figures} == {True}
    honest = model_truth_tables.dh.to_chain
    monkeypatch.setattr(
        model_truth_tables.dh, "to_chain",
        lambda t: honest(Table(t.convention, t.rows, base=t.base, name=t.name)),
    )  # fmt: skip
    assert [figure.verdict for figure in model_truth_tables.topic(True, silent).figures[:2]] == [
        False,
        False,
    ]


FLOATING = """<robot name="ship"> <link name="sea"/> <link name="deck"/> <link name="boom"/> <link name="hook"/>
  <joint name="swell" type="floating"> <parent link="sea"/> <child link="deck"/> </joint>
  <joint name="slew" type="continuous"> <parent link="deck"/> <child link="boom"/>
    <origin xyz="0 0 1"/> <axis xyz="0 0.6 0.8"/> </joint>
  <joint name="luff" type="continuous"> <parent link="boom"/> <child link="hook"/>
    <origin xyz="0.3 0.2 0.1" rpy="0.1 0.2 0.3"/> <axis xyz="1 0 0"/> </joint> </robot>"""


def robots_topic(monkeypatch, tmp_path, text: str):
    (tmp_path / "one.urdf").write_text(text, encoding="utf-8")
    monkeypatch.setattr(
        model_truth_robots, "example_robots", lambda: ({"one": str(tmp_path / "one.urdf")}, {})
    )
    return model_truth_robots.topic(False, silent)


def test_chains_below_a_floating_joint_are_judged_and_the_page_says_where_they_start(
    monkeypatch, tmp_path
):
    topic = robots_topic(monkeypatch, tmp_path, FLOATING)
    chains, near, *_, urdf = topic.figures
    assert (chains.shown, chains.verdict, near.verdict, urdf.verdict) == (
        "1 of 1",
        True,
        True,
        True,
    )
    (parts,) = (table for table in topic.tables if table.caption == "Chains taken in parts")
    assert parts.rows[0][1:] == ("hook", "starts below the floating joint 'swell'")


def test_a_urdf_with_a_lost_rotation_is_missed(monkeypatch, tmp_path):
    monkeypatch.setattr(
        model_truth_robots,
        "to_urdf",
        lambda chain: pk.to_urdf(chain).replace('<axis xyz="0 0', '<axis xyz="0 1'),
    )
    assert robots_topic(monkeypatch, tmp_path, FLOATING).figures[-1].verdict is False


def test_a_refused_chain_stands_in_the_report_with_its_reason():
    bolt = pk.Chain.from_space(
        [pk.screw.helical([0, 0, 1], [0, 0, 0], 0.1)], np.eye(4), joint_names=["bolt"]
    )
    way = model_truth_robots.way("press", bolt, "")
    assert (way.trips, way.urdf) == ((), None)
    assert "'bolt' is helical" in way.refusal


def compare_topic(monkeypatch):
    monkeypatch.setattr(model_truth_compare, "ARMS", {"random 6a": ""})
    return model_truth_compare.topic(False, silent)


def test_planted_changes_are_counted(monkeypatch):
    topic = compare_topic(monkeypatch)
    assert [(figure.shown, figure.verdict) for figure in topic.figures] == [
        ("16 of 16", True),
        ("3 of 3", True),
    ]
    tilt, *_ = topic.tables[0].rows
    assert (tilt[1], float(tilt[2])) == (4, pytest.approx(0.1, rel=0.01))


def test_a_comparison_that_sees_nothing_is_missed(monkeypatch):
    blind = model_truth_compare.compare
    monkeypatch.setattr(
        model_truth_compare, "compare", lambda a, b, samples: blind(a, a, samples=samples)
    )
    topic = compare_topic(monkeypatch)
    assert [(figure.shown, figure.verdict) for figure in topic.figures] == [
        ("0 of 16", False),
        ("0 of 3", False),
    ]
    assert any(table.caption == "What went wrong" for table in topic.tables)
