"""URScript as text: its lines, its numbers, and the arms that it is for."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

import poekin as pk
from poekin.errors import ModelError, PoekinWarning
from poekin.solve.motion.trajectory.urscript import MANY, check_urscript, urscript

Q = np.random.default_rng(0).normal(size=(4, 6))


def program(q=Q, names=("a", "b", "c", "d", "e", "f")) -> str:
    return urscript(names, q, 0.008, 0.1, 300)


def configurations(text: str) -> np.ndarray:
    return np.array([row.split(",") for row in re.findall(r"\[(.*?)\]", text)], float)


def test_a_program_moves_to_the_first_point_and_serves_the_others():
    lines = program().splitlines()
    assert lines[0] == "def poekin_path():"
    assert lines[2].startswith("  movej([")
    assert all(
        re.fullmatch(r"  servoj\(\[.*\], 0, 0, 0\.008, 0\.1, 300\.0\)", line) for line in lines[3:6]
    )
    assert lines[6:] == ["  stopj(2.0)", "end"]
    np.testing.assert_array_equal(configurations(program()), Q)


def test_a_line_within_the_program_is_indented_and_all_is_ascii():
    text = program(names=("ü", "x\nend\nset_digital_out(0, True)", "\u2028", "[1]", "f", "g"))
    assert text.isascii()
    inner = text.splitlines()[1:-1]
    assert all(line.startswith("  ") for line in inner)
    assert "\n" + "end\n" in text
    assert text.count("set_digital_out") == 1
    assert "\r" not in text


def test_small_numbers_have_a_dot():
    assert "[1.0e-05, 0.0, 0.0, 0.0, 0.0, 0.0]" in program(np.array([[1e-5, -0.0, 0, 0, 0, 0]]))


def test_many_lines_are_warned_of():
    q = np.zeros((MANY + 1, 6))
    with pytest.warns(PoekinWarning, match=rf"{MANY + 1} lines; a controller of the CB series"):
        program(q)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        program(q[1:])


def arms():
    turn = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in range(7)]
    slide = pk.screw.prismatic([0, 0, 1])
    double = np.eye(6)
    double[0, 0] = 2
    return {
        "seven": pk.Chain.from_space(turn, np.eye(4)),
        "five": pk.Chain.from_space(turn[:5], np.eye(4)),
        "a slide": pk.Chain.from_space([*turn[:5], slide], np.eye(4)),
        "a gear": pk.Chain.from_space(turn[:6], np.eye(4), coupling=double),
        "no joint": pk.Chain.from_space(np.zeros((0, 6)), np.eye(4)),
    }


@pytest.mark.parametrize("arm", arms().values(), ids=arms())
def test_an_arm_that_is_no_ur_is_refused(arm):
    with pytest.raises(ModelError, match="URScript: expected an arm with 6 revolute joints"):
        check_urscript(arm)


def test_six_revolute_joints_are_taken():
    check_urscript(pk.load("ur5").chain())
