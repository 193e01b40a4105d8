"""URScript as text: its lines, its numbers, and the arms that it is for."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

import poekin as pk
from poekin.errors import ModelError, PoekinWarning
from poekin.solve.motion.trajectory.urscript import check_urscript, urscript

Q = np.random.default_rng(0).normal(size=(4, 6))


def program(q=Q, names=("a", "b", "c", "d", "e", "f")) -> str:
    return urscript(names, q, 0.008, 0.1, 300)


def configurations(text: str) -> np.ndarray:
    return np.array([row.split(",") for row in re.findall(r"\[(.*?)\]", text)], float)


def test_a_program_moves_to_the_first_point_and_serves_the_others():
    q = np.arange(18.0).reshape(3, 6) / 8
    assert program(q) == (
        "def poekin_path():\n"
        "  # rad, rad/s and rad/s^2; joints in the order a, b, c, d, e, f\n"
        "  movej([0.0, 0.125, 0.25, 0.375, 0.5, 0.625], a=1.4, v=1.05)\n"
        "  servoj([0.75, 0.875, 1.0, 1.125, 1.25, 1.375], 0, 0, 0.008, 0.1, 300.0)\n"
        "  servoj([1.5, 1.625, 1.75, 1.875, 2.0, 2.125], 0, 0, 0.008, 0.1, 300.0)\n"
        "  stopj(2.0)\n"
        "end\n"
    )
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
    q = np.zeros((5001, 6))
    words = "URScript: 5001 lines; a controller of the CB series may refuse more than 5000"
    with pytest.warns(PoekinWarning, match=f"^{words}$"):
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
    names = ", ".join(map(repr, arm.q_names)) or "none"
    with pytest.raises(ModelError) as refused:
        check_urscript(arm)
    assert str(refused.value) == (
        "URScript: expected an arm with 6 revolute joints, each with its own coordinate, got "
        f"{names}; another tip may help"
    )


def test_six_revolute_joints_are_taken():
    check_urscript(pk.load("ur5").chain())
