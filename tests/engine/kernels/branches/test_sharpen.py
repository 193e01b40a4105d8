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

for module in engine_compile.modules_used(kernel):
    engine_compile._register_functions(module)

AIM = 1e-13  # m and rad: as of solutions of ik_all
CHAIN = pk.load("ur5e").chain(tip="tool0")


@numba.njit(**engine_compile.OPTIONS)
def sharpened(arm, options, fixed, targets, owners, q, errors):
    problem = kernel.BranchProblem(arm, targets[0], fixed, options)
    branches = kernel.Branches(q, errors, owners)
    kernel.sharpen(problem, targets, branches, 0, kernel.sharpening(fixed))


def run(chain, q, T, owners, fixed=None, steps=8):
    fast = chain.compile()
    end = np.array(q)
    errors = np.empty((4, 2))
    fixed = np.zeros(chain.dof) if fixed is None else fixed
    options = kernel_options(POSE, AIM, AIM, steps)
    sharpened(fast.hybrid_address, options, fixed, T, np.array(owners), end, errors)
    return end, errors


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


@pytest.mark.parametrize("seed", range(5))
def test_each_of_four_ends_at_the_target_of_its_owner(seed):
    q = CHAIN.random(seed, 2)
    T = CHAIN.fk(q)
    owners = [0, 1, 1, 0]
    start = q[owners] + np.array([[1e-4], [0.0], [-1e-6], [1e-9]])
    end, errors = run(CHAIN, start, T, owners)
    assert (errors <= AIM).all()
    # what is at its target already stays to the last digit
    np.testing.assert_array_equal(end[1], q[1])
    # 1e-12: rounding of a pose, 1e-15, by the Jacobian's smallest singular value of these draws
    np.testing.assert_allclose(end, q[owners], rtol=0, atol=1e-12)


def test_what_is_fixed_stays_and_seven_coordinates_are_no_other_case():
    chain = pk.load("panda").chain(tip="panda_hand")
    q = np.tile([0.1, -0.5, 0.2, -2.0, 0.3, 1.6, 0.8], (4, 1))
    fixed = np.eye(7)[2]
    start = q + 1e-5 * (1.0 - fixed) * np.arange(1, 5)[:, None]
    end, errors = run(chain, start, chain.fk(q), range(4), fixed)
    assert (errors <= AIM).all()
    assert (end[:, 2] == q[:, 2]).all()
    np.testing.assert_allclose(end, q, rtol=0, atol=1e-12)


def test_one_that_goes_nowhere_leaves_the_others_alone():
    q = CHAIN.random(7, 4)
    T = CHAIN.fk(q)
    T[2, :3, 3] += 10.0
    start = q + 1e-6
    start[3, 1] = np.nan
    end, errors = run(CHAIN, start, T, range(4))
    assert (errors[:2] <= AIM).all()
    assert not (errors[2] <= AIM).all()
    assert not (errors[3] <= AIM).all()
    np.testing.assert_allclose(end[:2], q[:2], rtol=0, atol=1e-11)
    # a planted fault: without any step the errors are those of the start
    _, errors = run(CHAIN, start, T, range(4), steps=1)
    assert (errors[:2].max(axis=1) > 1e-7).all()
