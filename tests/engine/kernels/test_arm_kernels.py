"""The kernels of one arm's machine code: what they take, what they refuse, and blocks of any size."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels import arm_kernels
from poekin.engine.kernels.arm_kernels import BLOCK
from poekin.engine.straight_line.machine_code import LANES
from poekin.engine.straight_line.sincos import MODERATE

CHAIN = pk.load("panda").chain(tip="panda_link8")
FAST = CHAIN.compile()
M = CHAIN.dof
BOTH = FAST.hybrid_address
# Both ways round differently, each within 1e-14 of the truth
# (tests/model/kinematics/test_compiled.py).
NEAR = 2e-14


def address(pose: bool, jacobian: bool) -> int:
    FAST.fk(np.zeros(M))
    FAST.jacobian(np.zeros(M), "hybrid")
    calls = FAST._poses if pose else FAST._jacobians
    return calls[None if pose else "hybrid"][1] if not (pose and jacobian) else BOTH


POSE, JACOBIAN = address(True, False), address(False, True)
ONE = {
    "pose_one": (POSE, (4, 4), None),
    "jacobian_one": (JACOBIAN, None, (6, M)),
    "pose_jacobian_one": (BOTH, (4, 4), (6, M)),
}


@pytest.mark.parametrize("name", ONE)
def test_a_plain_configuration_is_taken(name):
    arm, *shapes = ONE[name]
    q = CHAIN.random(0)
    results = [np.full(shape, np.nan) for shape in shapes if shape]
    assert getattr(arm_kernels, name).ready()(arm, q, *results) == 1
    wanted = [w for w, shape in zip(CHAIN.fk_jacobian(q, "hybrid"), shapes, strict=True) if shape]
    for result, right in zip(results, wanted, strict=True):
        np.testing.assert_allclose(result, right, rtol=0, atol=NEAR)


SHAPES = {
    "few coordinates": ((M - 1,), (4, 4), (6, M)),
    "many coordinates": ((M + 1,), (4, 4), (6, M)),
    "few rows of the pose": ((M,), (3, 4), (6, M)),
    "many rows of the pose": ((M,), (5, 4), (6, M)),
    "few columns of the pose": ((M,), (4, 3), (6, M)),
    "many columns of the pose": ((M,), (4, 5), (6, M)),
    "few rows of J": ((M,), (4, 4), (5, M)),
    "many rows of J": ((M,), (4, 4), (7, M)),
    "few columns of J": ((M,), (4, 4), (6, M - 1)),
    "many columns of J": ((M,), (4, 4), (6, M + 1)),
}


@pytest.mark.parametrize("case", SHAPES)
def test_other_shapes_are_refused_and_nothing_is_done(case):
    size, *shapes = SHAPES[case]
    right = (M,), (4, 4), (6, M)
    wrong = {k for k, (a, b) in enumerate(zip((size, *shapes), right, strict=True)) if a != b}
    for name, (arm, *has) in ONE.items():
        taken = {0, *(k for k, shape in enumerate(has, 1) if shape)}
        results = [np.full(shape, 7.0) for shape, there in zip(shapes, has, strict=True) if there]
        said = getattr(arm_kernels, name).ready()(arm, np.zeros(size), *results)
        assert said == int(not wrong & taken)
        assert all((result == 7).all() for result in results) or not wrong & taken


def parts(q: int, T: int, J: int) -> list[np.ndarray]:
    """q, T and J at these places of one memory."""
    memory = np.full(200, 0.25)
    return [
        memory[q : q + M],
        memory[T : T + 16].reshape(4, 4),
        memory[J : J + 6 * M].reshape(6, M),
    ]


@pytest.mark.parametrize(
    "places, taken",
    [
        ((0, M, M + 16), True),  # side by side
        ((58, 42, 0), True),
        ((16 + 42, 0, 16), True),
        ((0, M - 1, 60), False),
        ((15, 0, 60), False),
        ((0, 60, M - 1), False),
        ((41, 60, 0), False),
        ((100, 0, 15), False),
        ((100, 41, 0), False),
    ],
    ids=str,
)
def test_memory_that_is_shared_is_refused_and_what_lies_side_by_side_is_not(places, taken):
    q, T, J = parts(*places)
    assert arm_kernels.pose_jacobian_one.ready()(BOTH, q, T, J) == int(taken)
    assert taken or ((q == 0.25).all() and (T == 0.25).all() and (J == 0.25).all())
    q_T = max(places[0], places[1]) - min(places[0], places[1]) >= (
        M if places[0] < places[1] else 16
    )
    q, T, _ = parts(*places)
    assert arm_kernels.pose_one.ready()(POSE, q, T) == int(q_T)
    q_J = max(places[0], places[2]) - min(places[0], places[2]) >= (
        M if places[0] < places[2] else 6 * M
    )
    q, _, J = parts(*places)
    assert arm_kernels.jacobian_one.ready()(JACOBIAN, q, J) == int(q_J)


@pytest.mark.parametrize(
    "rows", [0, 1, LANES - 1, LANES, LANES + 1, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK + LANES + 3]
)
def test_a_batch_of_any_size_has_each_of_its_rows(rows):
    q = CHAIN.random(1, rows)
    if rows > 2:
        q[rows // 2, 0] = 3 * MODERATE  # one angle of a block goes another way
    T, J = np.full((rows, 4, 4), np.nan), np.full((rows, 6, M), np.nan)
    arm_kernels.pose_jacobian_many.ready()(BOTH, q, T, J)
    wanted = CHAIN.fk_jacobian(q, "hybrid")
    np.testing.assert_allclose(T, wanted[0], rtol=0, atol=NEAR)
    np.testing.assert_allclose(J, wanted[1], rtol=0, atol=NEAR)
    T[:], J[:] = np.nan, np.nan
    arm_kernels.pose_many.ready()(POSE, q, T)
    arm_kernels.jacobian_many.ready()(JACOBIAN, q, J)
    np.testing.assert_allclose(T, wanted[0], rtol=0, atol=NEAR)
    np.testing.assert_allclose(J, wanted[1], rtol=0, atol=NEAR)
