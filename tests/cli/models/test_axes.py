"""`poekin axes`: how the axes of an arm lie to each other."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.analysis.axes import axes
from poekin.formats.load import load


def test_pairs_and_shapes_are_said(poekin):
    code, out, err = poekin("axes", "panda", "--tip", "panda_hand")
    assert (code, err) == (0, "")
    assert "perpendicular, 82.5 mm from intersecting" in out
    assert "spherical shoulder" in out


def test_the_table_has_angle_and_distance_of_each_pair(poekin):
    lines = poekin("axes", "panda", "--tip", "panda_hand", "--tol-mm", "0.1", "--tol-deg", "0.01")[
        1
    ].splitlines()
    report = axes(
        load("panda").chain(tip="panda_hand"), tol_position=1e-4, tol_rotation=np.radians(0.01)
    )
    assert any(not pair.fixed for pair in report.pairs)
    for pair in report.pairs:
        (line,) = [x for x in lines if x.split()[:4] == [str(pair.first), pair.name_first, str(pair.second),
                                                         pair.name_second]]  # fmt: skip
        numbers = [np.degrees(pair.angle)]
        if pair.distance is not None:
            numbers.append(1e3 * pair.distance)
        assert [float(x) for x in line.split()[-len(numbers) :]] == pytest.approx(numbers, rel=1e-5)
        assert ("(at q = 0)" in line) == (not pair.fixed)


def test_each_shape_is_said_or_that_there_is_none(poekin, crane):
    report = axes(load("panda").chain(tip="panda_hand"))
    lines = poekin("axes", "panda", "--tip", "panda_hand")[1].splitlines()
    assert lines[0] == "Axes of panda_link0 → panda_hand at q = 0"
    assert lines[-len(report.shapes) :] == [shape.summary() for shape in report.shapes]
    for pair in report.pairs:
        words = pair.relation if pair.fixed else f"{pair.relation} (at q = 0)"
        ends = [
            str(pair.first),
            pair.name_first,
            str(pair.second),
            pair.name_second,
            *words.split(),
        ]
        assert any(line.split()[: len(ends)] == ends for line in lines)
    assert poekin("axes", crane, "--tip", "hook")[1].endswith(
        "\nno spherical joint and no three parallel axes\n"
    )


def test_json_has_every_pair(as_json):
    document = as_json("axes", "panda", "--tip", "panda_hand")
    assert len(document["pairs"]) == 11
    assert (document["base"], document["tip"]) == ("panda_link0", "panda_hand")
    assert document["shapes"][0]["kind"] == "spherical shoulder"
    assert document["shapes"][0]["joints"] == [1, 2, 3]


def test_a_tree_without_a_tip_and_a_bad_tolerance_are_refused(crane, refused):
    assert "hook" in refused("axes", crane)
    assert "--tol-mm: expected a positive number" in refused(
        "axes", crane, "--tip", "hook", "--tol-mm", "-1"
    )
