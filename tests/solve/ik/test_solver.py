"""A solver's settings, and how its targets are shared out."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels import ik_codes as codes
from poekin.errors import InputError
from poekin.solve.ik import solver
from poekin.solve.ik.solver import Settings, hashable, items, solver_of

ARM = pk.load("ur5").chain().compile()
GIVEN = Settings("pose", None, True, 1e-9, 2e-9, None, None, 7, 30, 3, False)


@pytest.mark.parametrize("changed, words", [
    ({"tol_position": 0}, "tol_position: expected a positive number, got 0"),
    ({"tol_rotation": np.inf}, "tol_rotation: expected a positive number, got inf"),
    ({"tol_rotation": True}, "tol_rotation: expected a positive number, got True"),
    ({"restarts": -1}, "restarts: expected a whole number from 0 on, got -1"),
    ({"restarts": 1.5}, "restarts: expected a whole number from 0 on, got 1.5"),
    ({"iterations": 0}, "iterations: expected a whole number from 1 on, got 0"),
    ({"seed": -1}, "seed: expected a whole number from 0 on, got -1"),
    ({"seed": 2**62}, f"seed: expected a whole number from 0 on, got {2**62}"),
    ({"seed": False}, "seed: expected a whole number from 0 on, got False"),
    ({"limits": 1}, "limits: expected True or False, got 1"),
    ({"parallel": None}, "parallel: expected True or False, got None"),
])  # fmt: skip
def test_a_setting_that_is_none_is_told_whole(changed, words):
    with pytest.raises(InputError, match=f"^{re.escape(words)}$"):
        solver._check_numbers(GIVEN._replace(**changed))
    solver._check_numbers(GIVEN._replace(restarts=0, iterations=1, seed=2**62 - 1, limits=np.True_))


def test_the_kernel_is_told_the_settings_with_a_tenth_of_the_tolerances_to_spare():
    made = solver_of(
        ARM, GIVEN._replace(task="direction", axis=(0.0, 3.0, 4.0), weights=(1.0, 1, 1, 2, 2, 2))
    )
    options = made.options
    assert options[codes.TOL_POSITION] == pytest.approx(0.9e-9)
    assert options[codes.TOL_ROTATION] == pytest.approx(1.8e-9)
    assert (options[codes.ITERATIONS], options[codes.RESTARTS], options[codes.TASK]) == (
        30,
        7,
        codes.DIRECTION,
    )
    np.testing.assert_allclose(options[codes.AXIS : codes.AXIS + 3], [0, 0.6, 0.8])
    np.testing.assert_allclose(options[codes.WEIGHTS :], [0.5, 0.5, 0.5, 1, 1, 1])
    assert solver_of(ARM, GIVEN) is solver_of(ARM, GIVEN._replace())


def test_a_call_of_a_kernel_takes_so_many_targets_that_an_interrupt_is_soon_seen():
    assert solver._rows(0, 30) == 800_000 // 30
    assert solver._rows(99, 100) == 80
    assert solver._rows(10**6, 100) == 1


@pytest.mark.parametrize("parallel", [False, True])
def test_targets_that_are_shared_out_are_solved_as_all_together(parallel, monkeypatch):
    T = ARM.fk(ARM.chain.random(0, 40))
    made = solver_of(ARM, GIVEN._replace(parallel=parallel))
    anywhere, numbers = np.full((40, 6), np.nan), np.arange(40.0)
    q, info = made.solve(T, numbers, anywhere)
    monkeypatch.setattr(made, "_rows", 7)
    parts = made.solve(T, numbers, anywhere)
    np.testing.assert_array_equal(parts[0], q)
    np.testing.assert_array_equal(parts[1], info)
    few = made.solve(T, numbers, anywhere, restarts=0)[1]
    assert (few[:, codes.AT_RESTARTS] == 0).all()
    assert made.options[codes.RESTARTS] == 7


def test_settings_become_keys_where_they_are_vectors_or_mappings():
    assert hashable([1, 2.5], "axis") == (1.0, 2.5)
    assert hashable(np.array([1, 2]), "axis") == (1.0, 2.0)
    assert hashable(3, "axis") == 3
    assert np.ndim(hashable([[1, 2]], "axis")) == 2
    assert items(None) is None
    assert items({"a": 1, "b": 2}) == (("a", 1), ("b", 2))
    with pytest.raises(
        InputError, match=r"^lock: expected a dict of names and values, got \[\('a', 1\)\]$"
    ):
        items([("a", 1)])


def test_a_distance_is_that_of_solutions_alone():
    q, near, info = np.array([[3.0, 4], [1, 0]]), np.zeros(2), np.zeros((2, codes.INFO))
    info[:, codes.AT_STATE] = codes.SOLVED, codes.STALLED
    assert solver._distance(q, near, info).tolist() == [5, np.inf]


@pytest.mark.parametrize("lock", [None, (("elbow_joint", 0.5),)])
def test_the_nearest_is_looked_for_with_limits_and_without_from_near_and_from_anywhere(
    lock, monkeypatch
):
    made = solver_of(ARM, GIVEN._replace(task="position", seed=5, lock=lock))
    near = np.tile([0.1, -1.0, 1.2, 0.4, 0.9, -0.3], (2, 1))
    asked = []

    def solve(targets, indices, q0, *, restarts=None, limits=None):
        asked.append((q0, restarts, limits))
        q, info = np.full_like(q0, 9.0), np.zeros((2, codes.INFO))
        info[:, codes.AT_STATE] = codes.STALLED
        info[:, codes.AT_ITERATIONS] = 1
        return q, info

    monkeypatch.setattr(made, "solve", solve)
    _, info = made.nearest(
        np.tile(np.eye(4), (2, 1, 1)), np.arange(2.0), np.full((2, 6), np.nan), near
    )
    assert info[:, codes.AT_ITERATIONS].tolist() == [49, 49]
    first, *others = asked
    begin = np.where(made.room.fixed, made.room.held, near)
    np.testing.assert_array_equal(first[0], begin)
    assert first[1:] == (None, None)
    assert len(others) == 48
    rng = np.random.default_rng(5)
    low, high = made.room.ranges.T
    for k, (q0, restarts, limits) in enumerate(others):
        start = np.where(made.room.fixed, begin, low + (high - low) * rng.random((2, 6)))
        close = k % 2 == 0
        np.testing.assert_allclose(
            q0, begin + 0.25 * (start - begin) if close else start, atol=1e-15
        )
        assert restarts == 0
        assert (limits is None) == (k % 4 < 2)
        assert limits is None or np.array_equal(limits, np.tile([-np.inf, np.inf], (6, 1)))


@pytest.mark.parametrize("aim", [None, "middle"])
@pytest.mark.parametrize("near", [None, [0.1, -1.0, 1.2, 0.4, 0.9, -0.3]])
def test_targets_in_parts_are_solved_as_all_together(near, aim, monkeypatch):
    T = ARM.fk(ARM.chain.random(0, 20))
    made, told = solver_of(ARM, GIVEN._replace(task="position")), []
    whole = made.run(T, None, near, aim, None)
    monkeypatch.setattr(solver, "AT_ONCE", 7)
    parts = made.run(T, None, near, aim, lambda done, count: told.append((done, count)))
    assert told == [(7, 20), (14, 20), (20, 20)]
    np.testing.assert_array_equal(parts.success, whole.success)
    if near is None:  # random starts of the others depend on how many there are in a part
        np.testing.assert_allclose(parts.q, whole.q, rtol=0, atol=1e-12)
        np.testing.assert_array_equal(parts.iterations, whole.iterations)
