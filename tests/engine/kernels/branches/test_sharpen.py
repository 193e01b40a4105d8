"""Newton's rule on four branches at once: each goes its own way."""

from __future__ import annotations

import numba
import numpy as np
import pytest

import poekin as pk
from poekin.engine.jit import compile as engine_compile
from poekin.engine.kernels.branches import sharpen as kernel
from poekin.solve.ik.ik_problem import kernel_options
from poekin.solve.ik_all.ik_all_search import POSE
from tests.engine.kernels.branches.four_at_once import plain

for module in engine_compile.modules_used(kernel):
    engine_compile._register_functions(module)

AIM = 1e-13  # m and rad: as of solutions of ik_all
CHAIN = pk.load("ur5e").chain(tip="tool0")


@numba.njit(**engine_compile.OPTIONS)
def sharpened(arm, options, fixed, targets, owners, q, errors):
    problem = kernel.BranchProblem(arm, targets[0], fixed, options)
    branches = kernel.Branches(q, errors, owners)
    kernel.sharpen(problem, targets, branches, 0, kernel.sharpening(fixed))


def run(chain, q, T, owners, fixed=None, steps=8, compiled=True):
    end = np.array(q)
    errors = np.empty((4, 2))
    fixed = np.zeros(chain.dof) if fixed is None else fixed
    options = kernel_options(POSE, AIM, AIM, steps)
    if compiled:
        code = chain.compile().hybrid_address
        sharpened(code, options, fixed, T, np.array(owners), end, errors)
        return end, errors
    # after four of others, which stay
    others = np.full((4, chain.dof), 7.0)
    branches = kernel.Branches(
        np.concatenate([others, end]), np.full((8, 2), 7.0), np.array([99] * 4 + list(owners))
    )
    problem = kernel.BranchProblem(chain, np.empty(0), np.empty(0), options)
    with plain():
        kernel.sharpen(problem, T, branches, 4, kernel.sharpening(fixed))
    assert (branches.q[:4] == 7.0).all()
    assert (branches.errors[:4] == 7.0).all()
    return branches.q[4:], branches.errors[4:]


@pytest.fixture(scope="module", autouse=True)
def compiled_first():
    """What is compiled is compiled before its functions are replaced by plain ones."""
    run(CHAIN, np.zeros((4, 6)), CHAIN.fk(np.zeros((1, 6))), [0] * 4)


EITHER = pytest.mark.parametrize("compiled", [False, True], ids=["plain", "compiled"])


@pytest.mark.parametrize("m", [1, 6, 9])
def test_memory_has_each_number_of_all_four_side_by_side_and_room_for_the_arm_s_code(m):
    fixed = np.arange(m) % 2.0
    one = kernel.sharpening(fixed)
    assert one.weights.tolist() == [1.0] * 6
    np.testing.assert_array_equal(one.free, fixed == 0)
    assert (one.T.shape, one.J.shape) == ((4, 4, 4), (4, 6, m))
    assert (one.rows.shape, one.H.shape) == ((6, 4 * m), (m, 4 * m))
    assert (one.e.shape, one.step.shape) == ((24,), (4 * m,))
    assert one.code.shape == (8 * (m + kernel.SPARE),)  # sines and cosines of as many angles


@EITHER
@pytest.mark.parametrize("seed", range(5))
def test_each_of_four_ends_at_the_target_of_its_owner(seed, compiled):
    q = CHAIN.random(seed, 2)
    T = CHAIN.fk(q)
    owners = [0, 1, 1, 0]
    start = q[owners] + np.array([[1e-4], [0.0], [-1e-6], [1e-9]])
    end, errors = run(CHAIN, start, T, owners, compiled=compiled)
    assert (errors <= AIM).all()
    # what is at its target already stays to the last digit, and what is not moves
    assert (end[[0, 2]] != start[[0, 2]]).any(axis=1).all()
    np.testing.assert_array_equal(end[1], q[1])
    # 1e-12: rounding of a pose, 1e-15, by the Jacobian's smallest singular value of these draws
    np.testing.assert_allclose(end, q[owners], rtol=0, atol=1e-12)


@EITHER
@pytest.mark.parametrize("tip", ["wrist_1_link", "wrist_2_link"])
def test_fewer_than_six_coordinates_are_no_other_case(tip, compiled):
    chain = pk.load("ur5e").chain(tip=tip)
    q = chain.random(3, 4)
    start = q + 1e-5 * np.arange(1, 5)[:, None]
    end, errors = run(chain, start, chain.fk(q), range(4), compiled=compiled)
    assert (errors <= AIM).all()
    np.testing.assert_allclose(end, q, rtol=0, atol=1e-12)


@EITHER
def test_what_is_fixed_stays_and_seven_coordinates_are_no_other_case(compiled):
    chain = pk.load("panda").chain(tip="panda_hand")
    q = np.tile([0.1, -0.5, 0.2, -2.0, 0.3, 1.6, 0.8], (4, 1))
    fixed = np.eye(7)[2]
    start = q + 1e-5 * (1.0 - fixed) * np.arange(1, 5)[:, None]
    end, errors = run(chain, start, chain.fk(q), range(4), fixed, compiled=compiled)
    assert (errors <= AIM).all()
    assert (end[:, 2] == q[:, 2]).all()
    np.testing.assert_allclose(end, q, rtol=0, atol=1e-12)


@EITHER
def test_one_that_goes_nowhere_leaves_the_others_alone(compiled):
    q = CHAIN.random(7, 4)
    T = CHAIN.fk(q)
    T[2, :3, 3] += 10.0
    start = q + 1e-6
    start[3, 1] = np.nan
    end, errors = run(CHAIN, start, T, range(4), compiled=compiled)
    assert (errors[:2] <= AIM).all()
    assert not (errors[2] <= AIM).all()
    assert not (errors[3] <= AIM).all()
    np.testing.assert_allclose(end[:2], q[:2], rtol=0, atol=1e-11)
    # a planted fault: without any step the errors are those of the start
    _, errors = run(CHAIN, start, T, range(4), steps=1, compiled=compiled)
    assert (errors[:2].max(axis=1) > 1e-7).all()


def test_an_error_is_written_into_its_lane_and_its_lengths_into_its_row():
    lanes, lengths = np.full(24, 9.0), np.full((3, 2), 9.0)
    kernel.set_error(lanes, lengths, 2, 1, (1.0, 2.0, -2.0, 2.0, -3.0, 6.0))
    expected = np.full((6, 4), 9.0)
    expected[:, 2] = 1.0, 2.0, -2.0, 2.0, -3.0, 6.0
    assert lanes.tolist() == expected.ravel().tolist()
    assert lengths.tolist() == [[9.0, 9.0], [7.0, 3.0], [9.0, 9.0]]


def test_of_a_pose_three_rows_are_taken():
    T = np.arange(32.0).reshape(2, 4, 4)
    for k in range(2):
        assert kernel.nested(T, k) == tuple(tuple(row) for row in T[k, :3])


def test_a_target_is_reached_where_both_errors_are_within_their_tolerances():
    options = kernel_options(POSE, 0.5, 0.25, 8)
    errors = np.full((3, 2), 9.0)
    for position, rotation, reached in (
        (0.5, 0.25, True), (0.0, 0.125, True), (0.6, 0.0, False), (0.0, 0.3, False), (0.3, 0.3, False),
        (np.nan, 0.0, False), (0.0, np.nan, False),
    ):  # fmt: skip
        errors[1] = position, rotation
        assert bool(kernel.is_reached(errors, 1, options)) is reached


def test_as_many_steps_are_taken_as_are_allowed(monkeypatch):
    asked = []

    def run_four(arm, q, T, J, scratch):
        asked.append(q.copy())
        T[:], J[:] = np.eye(4), np.eye(6)

    far = np.eye(4)
    far[0, 3] = 0.5
    branches = kernel.Branches(np.zeros((4, 6)), np.zeros((4, 2)), np.zeros(4, int))
    options = kernel_options(POSE, AIM, AIM, 3)
    problem = kernel.BranchProblem(0, np.empty(0), np.empty(0), options)
    with plain():
        monkeypatch.setattr(kernel, "run_four", run_four)
        kernel.sharpen(problem, far[None], branches, 0, kernel.sharpening(np.zeros(6)))
        assert len(asked) == 3
        assert branches.q[:, 3].tolist() == [1.5] * 4  # each goes the whole way
        asked.clear()
        kernel.sharpen(problem, np.eye(4)[None], branches, 0, kernel.sharpening(np.zeros(6)))
        assert len(asked) == 1
