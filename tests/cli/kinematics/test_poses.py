"""Poses and numbers on a command line: what is refused, in whole sentences."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.cli.kinematics import arm, poses
from poekin.errors import InputError
from poekin.formats.poses.layout import NAMED, layout

CHAIN = pk.load("stanford").chain()
NAMES = ", ".join(CHAIN.q_names)
TWELVE = "T00, T01, T02, T03, T10, T11, T12, T13, T20, T21, T22, T23"
ROW = ["1", "0", "0", "0.1", "0", "1", "0", "0.2", "0", "0", "1", "0.3"]

REFUSED = {
    "format": (lambda: poses.read(ROW, None, None, None),
               f"--format: expected one of {NAMED}; the format of a pose is never guessed"),
    "both": (lambda: poses.read(ROW, "T.csv", "12", None),
             "either a pose or --input expected, got both ('1' and 'T.csv')"),
    "count": (lambda: poses.read(ROW[1:], None, "12", None),
              f"the pose:1: 12 values expected ({TWELVE}), got 11"),
    "none": (lambda: poses.read(None, None, "12", None),
             "one pose expected, got 0; or --input with a file"),
    "word": (lambda: poses.read([*ROW[:4], "x", *ROW[5:]], None, "12", None),
             "the pose:1, column 5: a number expected, got 'x'"),
    "coordinates": (lambda: poses.coordinates("1, 2", CHAIN, "--q0"), f"--q0: 6 coordinates expected ({NAMES}), got 2"),
    "coordinate": (lambda: poses.coordinates("1,b", CHAIN, "--q0"), "--q0: number 2: a number expected, got 'b'"),
    "for each": (lambda: poses.for_each("1 2", CHAIN, "--speed"), f"--speed: 6 coordinates expected ({NAMES}), got 2"),
    "for all": (lambda: poses.for_each(" b ", CHAIN, "--speed"), "--speed: number 1: a number expected, got 'b'"),
    "few": (lambda: arm.take("stanford", None, None, ["1", "2"], None),
            f"6 coordinates expected ({NAMES}), got 2; or --input with a file"),
    "few, one only": (lambda: arm.take("stanford", None, None, ["1"], None, many=False),
                      f"6 coordinates expected ({NAMES}), got 1"),
    "no number": (lambda: arm.take("stanford", None, None, ["1", "x"], None),
                  "coordinate 2: a number expected, got 'x'"),
    "both ways": (lambda: arm.take("stanford", None, None, ["1", "2"], "q.csv"),
                  "either coordinates or --input expected, got both ('1' and 'q.csv')"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused_is_said_with_what_was_expected_and_what_arrived(case):
    call, message = REFUSED[case]
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value) == message


def test_numbers_are_taken_in_their_order():
    T = poses.read(ROW, None, "12", None)
    assert T[0, :3].ravel().tolist() == [float(word) for word in ROW]
    for words in ([" ".join(ROW)], [", ".join(ROW)], ["; ".join(ROW).replace(".", ",")]):
        assert np.array_equal(poses.read(words, None, "matrix", None), T)
    assert np.array_equal(poses.coordinates("1,2 3, 4,5  6", CHAIN, "--q0"), [1, 2, 3, 4, 5, 6])  # type: ignore[arg-type]
    assert poses.coordinates(None, CHAIN, "--q0") is None
    assert poses.for_each(None, CHAIN, "--speed") is None
    assert poses.for_each(" 0.5 ", CHAIN, "--speed") == 0.5
    assert np.array_equal(poses.for_each("1,2,3,4,5,6", CHAIN, "--speed"), [1, 2, 3, 4, 5, 6])  # type: ignore[arg-type]
    given = arm.take("stanford", None, None, ["1", "2", "3", "4", "5", "6"], None)
    assert (given.robot, given.single, given.q.tolist()) == ("stanford", True, [[1, 2, 3, 4, 5, 6]])


@pytest.mark.parametrize("rows", [0, 1, 4, 5])
def test_results_are_computed_some_at_a_time_and_all_of_them(rows, monkeypatch):
    monkeypatch.setattr(arm, "ROWS_AT_ONCE", 2)
    q = np.random.default_rng(0).normal(size=(rows, 6))
    sizes: list[int] = []

    def function(part):
        sizes.append(len(part))
        return CHAIN.fk(part)

    T = arm.compute(arm.ChainArguments("r", CHAIN, q, False), function, (4, 4))
    np.testing.assert_array_equal(T, CHAIN.fk(q))
    assert sizes == [2] * (rows // 2) + [1] * (rows % 2)


@pytest.mark.parametrize(
    ("words", "close"),
    [
        (["singularity", "stanford", "--tipp", "1"], "'--tip'"),
        (["ik", "stanford", "--inptu", "1"], "'--input'"),
        (["fk", "stanford", "--mn", "1"], "'--mm'"),
        (["fk", "stanford", "1", "--couplin"], "'--coupling'"),
    ],
)
def test_a_misspelt_option_is_told_from_a_number_with_those_of_the_command(words, close, refused):
    said = refused(*words)
    assert said.startswith("poekin: error: there is no option '--")
    assert f"did you mean {close}" in said


@pytest.mark.parametrize("more", [-1, 1])
def test_other_than_one_number_for_each_coordinate_is_refused(more):
    poses.check_count(np.zeros(CHAIN.dof), CHAIN)
    with pytest.raises(InputError) as refused:
        poses.check_count(np.zeros(CHAIN.dof + more), CHAIN, "--q0: ", "; or another")
    assert str(refused.value) == (
        f"--q0: 6 coordinates expected ({NAMES}), got {6 + more}; or another"
    )


def test_the_help_counts_the_numbers_of_a_matrix():
    counts = " or ".join(str(len(layout(name).columns)) for name in ("12", "16"))
    assert f"matrix ({counts}, row by row" in poses.FORMAT_HELP
