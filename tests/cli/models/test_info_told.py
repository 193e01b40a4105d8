"""What `poekin info` tells beside the tree: sums, drives, notes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from poekin.cli.models.info import _screw_rows, _show_drives, _tell_of_sums
from poekin.model.chain import Chain
from poekin.model.joint import Joint

SENTENCE = "Limits are those of each coordinate alone; solvers keep the joints' own, too\n"
SCREWS = np.tile([0, 0, 1.0, 0, 0, 0], (2, 1))
ONE_EACH = [[1, 0], [0, 2]]
NONE_AND_ONE = [[0, 0], [0, 1]]
TWO = [[1, 0], [1, -1]]
TWO_OF_ONE = [[1, 0], [2, 0]]
TWO_AND_NONE = [[1, 1], [0, 0]]


@pytest.mark.parametrize(
    ("couplings", "said"),
    [
        ([], ""),
        ([ONE_EACH], ""),
        ([NONE_AND_ONE, ONE_EACH], ""),
        ([TWO_OF_ONE], ""),
        ([TWO], SENTENCE),
        ([TWO_AND_NONE], SENTENCE),
        ([ONE_EACH, TWO, TWO], SENTENCE),
    ],
)
def test_a_joint_of_several_coordinates_is_told_of_once(couplings, said, capsys):
    _tell_of_sums(Chain.from_space(SCREWS, np.eye(4), coupling=C) for C in couplings)
    assert capsys.readouterr().out == said


def test_a_joint_s_own_coordinate_gives_the_limits_where_it_follows_several():
    chain = Chain.from_space(
        np.tile([0, 0, 1.0, 0, 0, 0], (3, 1)),
        np.eye(4),
        q_names=["z", "m", "a"],
        joint_names=["m", "z", "x"],
        coupling=[[1, 1, 1], [1, 1, 0], [0, 1, 1]],
        limits=[[-1, 2], [-3, 4], [-5, 6]],
    )
    rows = [(row[0], row[-2:]) for row in _screw_rows(chain)]
    assert rows == [("m", ("-3", "4")), ("z", ("-1", "2")), ("x", ("-3", "4"))]


def test_drives_are_words_then_numbers_of_every_moving_joint_that_says_one(capsys):
    inf = float("inf")
    joints = [
        Joint("a", "revolute", "l0", "l1", velocity=2.345678, effort=inf),
        Joint("rail_of_b", "prismatic", "l1", "l2", velocity=inf, effort=100),
        Joint("c", "fixed", "l2", "l3", velocity=3, effort=4),
        Joint("d", "revolute", "l3", "l4", velocity=inf, effort=inf),
    ]
    _show_drives(joints)
    head, *lines = capsys.readouterr().out.strip().splitlines()
    assert head == "Limits of velocity (rad/s or m/s) and effort (N m or N), inf where not known"
    assert [line.rstrip() for line in lines if set(line) - set(" ─")] == [
        "joint       velocity   effort",
        "a            2.34568      inf",
        "rail_of_b        inf      100",
    ]
    _show_drives(joints[2:])
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(("kind", "more"), [("continuous", []), ("floating", ["note"])])
def test_there_is_a_column_of_notes_where_a_chain_has_one(kind, more, crane, poekin, tmp_path):
    path = tmp_path / "made.urdf"
    path.write_text(Path(crane).read_text().replace("continuous", kind))
    lines = poekin("info", path)[1].splitlines()
    heads = lines[lines.index("Chains from root to leaf") + 1]
    assert heads.split() == ["base", "tip", "joints", "coordinates", "reach", "(m)", *more]
