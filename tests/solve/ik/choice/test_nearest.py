"""The solution nearest to a configuration: from where it is looked for, and by what distance."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels import ik_codes as codes
from poekin.solve.ik.choice import nearest
from poekin.solve.ik.choice.every_solution import EverySolution
from poekin.solve.ik.ik_problem import Settings, make_problem

ARM = pk.load("ur5").chain().compile()
GIVEN = Settings("pose", None, True, 1e-9, 2e-9, None, None, 7, 30, 3, False)


def test_a_distance_is_that_of_solutions_alone():
    q, near, info = np.array([[3.0, 4], [1, 0]]), np.zeros(2), np.zeros((2, codes.INFO))
    info[:, codes.AT_STATE] = codes.SOLVED, codes.STALLED
    assert nearest._distance(q, near, info).tolist() == [5, np.inf]


@pytest.mark.parametrize("lock", [None, (("elbow_joint", 0.5),)])
def test_the_nearest_is_looked_for_with_limits_and_without_from_near_and_from_anywhere(
    lock, monkeypatch
):
    made = make_problem(ARM, GIVEN._replace(task="position", seed=5, lock=lock))
    near = np.tile([0.1, -1.0, 1.2, 0.4, 0.9, -0.3], (2, 1))
    asked = []

    def solve(targets, indices, q0, *, restarts=None, limits=None):
        asked.append((q0, restarts, limits))
        q, info = np.full_like(q0, 9.0), np.zeros((2, codes.INFO))
        info[:, codes.AT_STATE] = codes.STALLED
        info[:, codes.AT_ITERATIONS] = 1
        return q, info

    monkeypatch.setattr(made, "solve", solve)
    targets, anywhere = np.tile(np.eye(4), (2, 1, 1)), np.full((2, 6), np.nan)
    _, info = nearest.nearest(made, targets, np.arange(2.0), anywhere, near)
    assert info[:, codes.AT_ITERATIONS].tolist() == [49, 49]
    first, *others = asked
    begin = made.domain.held(near)
    np.testing.assert_array_equal(first[0], begin)
    assert first[1:] == (None, None)
    assert len(others) == 48
    rng = np.random.default_rng(5)
    low, high = made.domain.ranges.T
    for k, (q0, restarts, limits) in enumerate(others):
        start = np.where(made.domain.locked, begin, low + (high - low) * rng.random((2, 6)))
        close = k % 2 == 0
        np.testing.assert_allclose(
            q0, begin + 0.25 * (start - begin) if close else start, atol=1e-15
        )
        assert restarts == 0
        assert (limits is None) == (k % 4 < 2)
        assert limits is None or np.array_equal(limits, np.tile([-np.inf, np.inf], (6, 1)))


def test_where_all_solutions_are_known_the_nearest_is_taken_and_else_the_better_of_both(
    monkeypatch,
):
    made = make_problem(ARM, GIVEN)
    q = ARM.chain.random(3, 4)
    T = ARM.fk(q)
    near = q + 0.01
    T[3, :3, 3] = 9.0  # out of reach
    other = ARM.chain.random(4, 4)
    # the first target's are complete, the second's not, the third's are none
    u = np.vstack([q[:1], ARM.chain.random(5, 1), q[1:2]])
    every = EverySolution(u, np.array([0, 0, 1]), np.array([True, False, True, True]))
    asked = []

    def tries(problem, targets, indices, q0, near):
        asked.append(indices.tolist())
        info = np.zeros((len(targets), codes.INFO))
        info[:, codes.AT_STATE] = [codes.SOLVED, codes.SOLVED, codes.STALLED]
        info[:, codes.AT_ITERATIONS] = 49
        return other[indices.astype(int)], info

    monkeypatch.setattr(nearest, "every_solution", lambda *_: every)
    monkeypatch.setattr(nearest, "nearest_of_tries", tries)
    numbers = np.arange(4.0)
    anywhere = np.full((4, 6), np.nan)
    best, info = nearest.nearest(made, T, numbers, anywhere, near)
    assert asked == [[1, 2, 3]], "what is complete is not searched"
    np.testing.assert_array_equal(best, [q[0], q[1], other[2], other[3]])
    assert info[:, codes.AT_ITERATIONS].tolist() == [0, 0, 49, 49]
    assert info[3, codes.AT_STATE] == codes.STALLED
    other[1] = near[1]  # now the search's is nearer
    best, _ = nearest.nearest(made, T, numbers, anywhere, near)
    np.testing.assert_array_equal(best[1], other[1])


def test_of_tries_the_nearest_is_taken_that_is_a_solution_within_the_limits(monkeypatch):
    arm = ARM.chain.replace(limits=np.tile([-1.0, 1.0], (6, 1))).compile()
    made = make_problem(arm, GIVEN._replace(task="position"))
    ends = iter([
        (np.full(6, 0.9), codes.SOLVED),
        (np.full(6, 0.5), codes.SOLVED),  # within the limits, and nearer
        (np.eye(6)[0] * 1.05, codes.SOLVED),  # nearer still, and beyond a limit
        (np.zeros(6), codes.STALLED),  # no solution
        (np.full(6, 0.6), codes.SOLVED),  # farther
    ])  # fmt: skip

    def solve(targets, indices, q0, *, restarts=None, limits=None):
        end, state = next(ends, (np.ones(6), codes.STALLED))
        info = np.zeros((1, codes.INFO))
        info[:, codes.AT_STATE] = state
        return end[None].copy(), info

    monkeypatch.setattr(made, "solve", solve)
    asked = np.eye(4)[None], np.zeros(1), np.full((1, 6), np.nan), np.zeros((1, 6))
    best, info = nearest.nearest_of_tries(made, *asked)
    assert best.tolist() == [[0.5] * 6]
    assert info[0, codes.AT_STATE] == codes.SOLVED
