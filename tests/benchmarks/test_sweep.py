"""The report's topic of workspaces: its judge sees what is wrong, and its page says what was timed."""

from __future__ import annotations

from dataclasses import replace

import poekin as pk
from benchmarks.cases import sweep as topic
from poekin.sweep import Random, Sweep, run

ARM = pk.load("ur5e").chain(tip="tool0")
SWEEP = Sweep(ARM, Random.of(ARM, 5000), topic._cells(0), "manipulability")


def test_the_judge_sees_a_lost_cell_and_a_wrong_measure():
    found = run(SWEEP)
    assert topic.error(SWEEP, found) < 1e-6
    assert topic.error(SWEEP, replace(found, counts=0 * found.counts + 1)) > 1e-6
    assert found.best is not None
    wrong = replace(found, best=1.01 * found.best)
    assert topic.error(SWEEP, wrong) > 1e-4
    counts = found.counts.copy()
    place = topic._cells(0).find(ARM.fk(topic._judged(SWEEP)[:1]))
    counts.reshape(-1)[place] = 0
    assert topic.error(SWEEP, replace(found, counts=counts)) >= 1 / topic.JUDGED


def test_the_page_has_a_figure_for_each_way_and_bars_where_they_are_asked():
    said = []
    page = topic.topic(True, said.append)
    figures = {figure.what: figure for figure in page.figures}
    assert figures[f"{topic.MANIPULABILITY}, a sample"].bar == topic.SAMPLE_BAR
    assert figures[f"{topic.MANIPULABILITY} ÷ {topic.BATCH}"].bar == topic.BATCH_BAR
    assert figures[f"{topic.REACH}, a sample"].bar is None
    assert [row[0] for row in page.tables[0].rows] == [
        topic.BATCH,
        topic.MANIPULABILITY,
        topic.REACH,
        topic.DIRECTIONS,
    ]
    # errors, not times: the batch's, the measure's, and no sample without a cell
    assert float(page.tables[0].rows[0][2]) < 1e-13
    assert float(page.tables[0].rows[1][2]) < 1e-6
    assert [float(row[2]) for row in page.tables[0].rows[2:]] == [0.0, 0.0]
    (by_poses,) = [
        figure for what, figure in figures.items() if what.startswith("UR5e: 20000 poses")
    ]
    assert by_poses.bar is None  # of a million
    assert by_poses.error is not None
    assert float(by_poses.error) < 1e-13
    assert by_poses.note.endswith("with up to 8 solutions")
