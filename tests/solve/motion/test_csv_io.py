"""What is no array of poses or joints is refused in full words; names, units and rates of columns."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.solve.motion.csv_io import (
    joint_units,
    joints_over_time,
    read_joints,
    read_poses,
    velocity_columns,
    write_joints,
    write_poses,
)

PAIR: Any = ["a", 1]


@pytest.mark.parametrize(("call", "kind", "words"), [
    (lambda path: write_poses(path, np.eye(4), "12"), ShapeError, "T: expected poses (N, 4, 4), got (4, 4)"),
    (lambda path: write_poses(path, np.tile(np.eye(4), (2, 3, 1, 1)), "12"), ShapeError,
     "T: expected poses (N, 4, 4), got (2, 3, 4, 4)"),
    (lambda path: write_joints(path, np.zeros(2), ["a", "b"]), ShapeError, "q: expected shape (N, 2), got (2,)"),
    (lambda path: write_joints(path, np.zeros((4, 1)), ["a", "b"]), ShapeError, "q: expected shape (N, 2), got (4, 1)"),
    (lambda path: write_joints(path, np.zeros((4, 3)), ["a", "b"]), ShapeError, "q: expected shape (N, 2), got (4, 3)"),
    (lambda path: write_joints(path, np.zeros((1, 4, 2)), ["a", "b"]), ShapeError,
     "q: expected shape (N, 2), got (1, 4, 2)"),
    (lambda path: write_joints(path, np.zeros((4, 2)), ["a", "b"], times=[1, 2, 3]), ShapeError,
     "times: expected shape (4,), got (3,)"),
    (lambda path: write_joints(path, np.zeros((4, 2)), ["a", "b"], times=[1, 2, 3, 4, 5]), ShapeError,
     "times: expected shape (4,), got (5,)"),
    (lambda path: write_joints(path, np.zeros((4, 2)), ["a", "b"], times=np.zeros((4, 1))), ShapeError,
     "times: expected shape (4,), got (4, 1)"),
    (lambda path: write_joints(path, np.zeros((4, 2)), ["a", "b"], times=3), ShapeError,
     "times: expected shape (4,), got ()"),
    (lambda path: write_joints(path, np.zeros((1, 2)), "ab"), InputError,
     "names: expected a chain or names of coordinates, got 'ab'"),
    (lambda path: write_joints(path, np.zeros((1, 2)), PAIR), InputError,
     "names: expected a chain or names of coordinates, got ['a', 1]"),
])  # fmt: skip
def test_what_is_no_array_of_poses_or_joints_is_not_written(call, kind, words, tmp_path):
    path = tmp_path / "x.csv"
    with pytest.raises(kind, match=f"^{re.escape(words)}$"):
        call(path)
    assert not path.exists()


def test_joints_over_time_are_arrays_of_numbers():
    q, t = joints_over_time([[1, 2], [3, 4]], (0, 1), 2)
    assert (q.dtype, q.tolist()) == (np.float64, [[1, 2], [3, 4]])
    assert t is not None
    assert (t.dtype, t.tolist()) == (np.float64, [0, 1])
    assert joints_over_time([[1, 2]], None, 2)[1] is None


@pytest.mark.parametrize(("names", "columns"), [
    (["a", "b"], ("a_velocity", "b_velocity")),
    (["a", "a_velocity"], ("a_velocity_", "a_velocity_velocity")),
    (["a", "a_velocity", "a_velocity_"], ("a_velocity__", "a_velocity_velocity", "a_velocity__velocity")),
])  # fmt: skip
def test_a_rate_is_called_after_its_coordinate_and_like_no_other(names, columns):
    assert velocity_columns(names) == columns


def lift() -> pk.Chain:
    """A joint that turns and a slide."""
    screws = [pk.screw.revolute([0, 0, 1.0], [0, 0, 0]), pk.screw.prismatic([0, 0, 1.0])]
    return pk.Chain.from_space(screws, np.eye(4), joint_names=["turn", "rise"])


def test_units_are_those_of_a_chain_s_coordinates():
    assert joint_units(lift()) == ("rad", "m")
    assert joint_units(["turn", "rise"]) == ()


def test_rates_and_times_may_stand_in_any_column(tmp_path: Path):
    path = tmp_path / "q.csv"
    path.write_text("rise_velocity,rise,time,turn_velocity,turn\n9,1,2,8,3\n7,4,5,6,6\n")
    q, t = read_joints(path, lift())
    assert q.tolist() == [[3, 1], [6, 4]]
    assert t is not None
    assert t.tolist() == [2, 5]


def test_files_are_numbers_in_their_shortest_form_below_their_names(tmp_path: Path):
    path = tmp_path / "x.csv"
    write_joints(path, [[0.5, -2], [1e-9, 0.1]], lift(), times=[0, 0.25])
    assert path.read_text().split() == ["time,turn,rise", "0.0,0.5,-2.0", "0.25,1e-09,0.1"]
    write_joints(path, [[0.5, 3]], lift())
    assert path.read_text().split() == ["turn,rise", "0.5,3.0"]
    T = np.eye(4)[None]
    write_poses(path, T, "7", quaternion="xyzw")
    assert path.read_text().split() == ["x,y,z,qx,qy,qz,qw", "0.0,0.0,0.0,0.0,0.0,0.0,1.0"]
    np.testing.assert_array_equal(read_poses(path, "7", quaternion="xyzw"), T)


def test_a_column_that_is_not_known_is_refused_with_its_file(tmp_path: Path):
    path = tmp_path / "q.csv"
    path.write_text("turn,lift\n1,2\n")
    with pytest.raises(UnknownName, match=r"q\.csv:1: .*'lift'"):
        read_joints(path, lift())
    path.write_text("turn,rise\n1,2\n\n3\n")
    with pytest.raises(InputError, match=r"q\.csv:4: 2 values expected \(turn, rise\), got 1"):
        read_joints(path, lift())
