"""Machine code of a program with every kind of step, called as it stands: where it reads and writes,
and in how many blocks it comes.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
import pytest
from llvmlite import ir

from poekin.engine.straight_line import interpret, machine_code
from poekin.engine.straight_line.machine_code import (
    LANES,
    Layout,
    LoadedCode,
    _Function,
    object_code,
)
from poekin.engine.straight_line.program import Angle, Program
from poekin.engine.straight_line.trace import Node

ANGLES = (
    Angle(None, ((0, 1.0), (1, -1.0)), 0.25),
    Angle(None, ((2, 0.5),), 0.0),
    Angle(0, ((1, 3.0), (2, -1.0)), -0.5),
)
NODES = [
    *(Node("input", number) for number in (0, 1, 2, 3, 4, 5, -1, -3)),
    Node("constant", 2.5),
    Node("scaled", 0.3, 0),
    Node("product", 1, 6),
    Node("sum", 10, 2, 1),
    Node("sum", 11, 9, -1),
    Node("reciprocal", 1.0, 8),
    Node("product", 13, 7),
    Node("sum", 3, 8, 1),
    Node("reciprocal", 1.0, 15),
    Node("product", 4, 5),
]
STEPS = tuple(enumerate(NODES))
ENDS: list[Any] = [(k, (1.0, -1.0)[k % 3 == 0]) for k in range(18)]
ENDS += [(None, 0.75), (None, -1.0), (None, 0.0), (11, -1.0), (14, 1.0), (16, 1.0)]
COORDINATES = 3
FOUR = ctypes.CFUNCTYPE(
    None,
    *(ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64, ctypes.c_void_p, ctypes.c_int64),
    *(ctypes.c_void_p, ctypes.c_void_p),
)
OF_ANGLES = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64)


def made(outputs: int) -> Program:
    ends = tuple((ENDS + ENDS)[:outputs])
    return Program(ANGLES, STEPS, ends, None)  # type: ignore[arg-type]


def at(array: np.ndarray) -> int:
    return array.ctypes.data


RNG = np.random.default_rng(5)
SINES, COSINES = RNG.uniform(0.1, 1, (2, len(ANGLES), LANES))
Q = RNG.uniform(0.5, 2, (LANES, COORDINATES))


def expected(outputs: int) -> np.ndarray:
    return interpret.outputs(made(outputs), SINES.T, COSINES.T, Q)


def matrices(numbers: np.ndarray) -> np.ndarray:
    """Poses (N, 4, 4) of twelve numbers each."""
    T = np.tile(np.eye(4), (len(numbers), 1, 1))
    T[:, :3, :3] = numbers[:, :9].reshape(-1, 3, 3)
    T[:, :3, 3] = numbers[:, 9:]
    return T


def test_columns_are_the_program_bit_for_bit_each_number_with_its_like():
    code = LoadedCode(object_code(made(30), True, "columns"), "columns")
    stride = 9  # of which four are this function's
    sines, cosines = np.zeros((2, len(ANGLES), stride))
    sines[:, :LANES], cosines[:, :LANES] = SINES, COSINES
    q = np.zeros((COORDINATES, stride))
    q[:, :LANES] = Q.T
    R_p = np.full((13, stride), 77.0)
    J = np.full((20, LANES), 77.0)
    FOUR(code.addresses[1])(at(sines), at(cosines), stride, at(q), 99, at(R_p), at(J))
    np.testing.assert_array_equal(R_p[:12, :LANES].T, expected(30)[:, :12])
    np.testing.assert_array_equal(J[:18].T, expected(30)[:, 12:])
    assert (R_p[12] == 77).all()
    assert (R_p[:, LANES:] == 77).all()
    assert (J[18:] == 77).all()


@pytest.mark.parametrize("pose", [True, False])
def test_rows_are_matrices_of_poses_and_of_jacobians_of_one_configuration_or_four(pose):
    entries = 18
    wanted = expected(entries + 12 * pose)
    code = LoadedCode(object_code(made(entries + 12 * pose), pose), "rows")
    width, stride = 5, 6
    sines, cosines = np.zeros((2, len(ANGLES), stride))
    sines[:, :LANES], cosines[:, :LANES] = SINES, COSINES
    q = np.zeros((LANES, width))
    q[:, :COORDINATES] = Q
    for function, lanes in zip(code.addresses[1:], (1, LANES), strict=True):
        T = np.full((LANES + 1, 4, 4), 77.0)
        J = np.full((LANES + 1, entries), 77.0)
        FOUR(function)(at(sines), at(cosines), stride, at(q), width, at(T), at(J))
        # a product and a sum may be fused: numbers up to 20 are rounded once or twice
        np.testing.assert_allclose(J[:lanes], wanted[:lanes, 12 * pose :], rtol=0, atol=1e-14)
        poses = matrices(wanted[:lanes, :12]) if pose else np.full((lanes, 4, 4), 77.0)
        np.testing.assert_allclose(T[:lanes], poses, rtol=0, atol=1e-14)
        assert (J[lanes:] == 77).all()
        assert (T[lanes:] == 77).all()


def test_without_entries_of_a_jacobian_none_is_written():
    code = LoadedCode(object_code(made(12), True), "rows")
    T, J = np.zeros((LANES, 4, 4)), np.full(4, 77.0)
    FOUR(code.addresses[2])(at(SINES), at(COSINES), LANES, at(Q), COORDINATES, at(T), at(J))
    np.testing.assert_allclose(T, matrices(expected(12)), rtol=0, atol=1e-14)
    assert (J == 77).all()


def test_angles_are_sums_of_coordinates_and_of_angles_before_them():
    first = Q[:, 0] - Q[:, 1] + 0.25
    wanted = [first, 0.5 * Q[:, 2], first + 3 * Q[:, 1] - Q[:, 2] - 0.5]
    stride = 6
    ways: list[tuple[Layout, int]] = [("rows", 1), ("columns", LANES)]
    for layout, lanes in ways:
        code = LoadedCode(object_code(made(12), True, layout), layout)
        q = np.zeros((COORDINATES, stride))
        q[:, :LANES] = Q.T
        given = Q[0].copy() if layout == "rows" else q
        sines = np.full((4, stride), 77.0)
        OF_ANGLES(code.addresses[0])(at(given), at(sines), stride)
        # sums of five numbers below 6
        np.testing.assert_allclose(
            sines[:3, :lanes], np.array(wanted)[:, :lanes], rtol=0, atol=5e-15
        )
        assert (sines[3] == 77).all()
        assert (sines[:, lanes:] == 77).all()


@pytest.mark.parametrize("longest", [1, 4, 5])
@pytest.mark.parametrize("steps", [1, 3, 4, 5, 8, 9])
def test_a_block_has_as_many_steps_and_stores_as_are_said(monkeypatch, longest, steps):
    monkeypatch.setattr(machine_code, "LONGEST", longest)
    inputs = tuple((k, Node("input", k)) for k in range(steps))
    program = Program((), inputs, ((0, 1.0), (None, 2.0)), None)  # type: ignore[arg-type]
    module = ir.Module("arm")
    _Function(module, "columns", LANES, "columns").write(program, False)
    # between two blocks there is a branch that is always taken
    assert str(module).count("icmp") == -(-(steps + 2) // longest) - 1
    module = ir.Module("arm")
    _Function(module, "one", 1, "rows").write(program, False)
    # both stores are one group
    left = steps % longest or longest
    further = -(-steps // longest) - 1 + (left + 2 > longest)
    assert str(module).count("icmp") == further
