"""A problem's settings, and how its targets are shared out."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels import ik_codes as codes
from poekin.errors import InputError
from poekin.solve.ik import ik_problem
from poekin.solve.ik.ik_problem import Settings, hashable, make_problem
from poekin.solve.lock import items

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
        ik_problem._check_numbers(GIVEN._replace(**changed))
    ik_problem._check_numbers(
        GIVEN._replace(restarts=0, iterations=1, seed=2**62 - 1, limits=np.True_)
    )


def test_the_kernel_is_told_the_settings_with_a_tenth_of_the_tolerances_to_spare():
    made = make_problem(
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
    assert make_problem(ARM, GIVEN) is make_problem(ARM, GIVEN._replace())


def test_a_call_of_a_kernel_takes_so_many_targets_that_an_interrupt_is_soon_seen():
    assert ik_problem._rows(0, 30) == 800_000 // 30
    assert ik_problem._rows(99, 100) == 80
    assert ik_problem._rows(10**6, 100) == 1


@pytest.mark.parametrize("parallel", [False, True])
def test_targets_that_are_shared_out_are_solved_as_all_together(parallel, monkeypatch):
    T = ARM.fk(ARM.chain.random(0, 40))
    made = make_problem(ARM, GIVEN._replace(parallel=parallel))
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


@pytest.mark.parametrize("unlimited", [False, True])
def test_targets_whose_joints_are_beyond_their_own_limits_are_solved_again_from_other_starts(
    unlimited, monkeypatch
):
    made = ik_problem.IKProblem(ARM, GIVEN)
    monkeypatch.setattr(made, "has_joint_limits", True)
    asked: list[list[float]] = []

    def solved(targets, indices, q0, **options):
        asked.append(indices.tolist())
        assert (len(asked) == 1) != np.isnan(q0).all()
        assert targets[:, 0, 0].tolist() == [index % 1e9 for index in indices]
        info = np.zeros((len(targets), codes.INFO))
        info[:, codes.AT_STATE] = np.where(indices == 0, codes.STALLED, codes.SOLVED)
        # target 2 keeps its joints' limits the third time, target 3 never does
        kept = (indices % 1e9 == 1) | ((indices % 1e9 == 2) & (indices > 1.5e9))
        return np.where(kept[:, None], 1.0, 9.0) * np.ones((1, 6)), info

    monkeypatch.setattr(made, "_solved", solved)
    monkeypatch.setattr(made, "keeps_joints", lambda q: q[:, 0] < 5.0)
    T = np.arange(4.0)[:, None, None] * np.ones((4, 4))
    options = {"limits": np.zeros((6, 2))} if unlimited else {}
    q, _ = made.solve(T, np.arange(4.0), np.zeros((4, 6)), **options)
    again = [[2 + 1e9, 3 + 1e9], [2 + 2e9, 3 + 2e9], *([3 + turn * 1e9] for turn in range(3, 30))]
    assert asked == [[0, 1, 2, 3], *([] if unlimited else again)]
    assert q[:, 0].tolist() == [9, 1, 9 if unlimited else 1, 9]


def test_a_descent_has_no_restarts_unless_it_is_told():
    options = ik_problem.kernel_options(make_problem(ARM, GIVEN).task, 1e-3, 1e-4, 20)
    assert options[codes.RESTARTS] == 0
    assert options[[codes.TOL_POSITION, codes.TOL_ROTATION]].tolist() == [1e-3, 1e-4]
    assert options[codes.ITERATIONS] == 20


@pytest.mark.parametrize("shape", [(6,), (3, 6), (2, 3, 6)])
def test_locked_coordinates_have_their_value_but_where_nothing_is_known(shape):
    geared = ARM.chain.replace(
        coupling=2.0 * np.eye(6), q_names=[*"abcdef"], limits=None, velocity_limits=None
    )
    made = make_problem(geared.compile(), GIVEN._replace(lock=(("c", 0.5),)))
    u = np.arange(np.prod(shape)).reshape(shape) / 8.0
    expected = u / 2.0
    expected[..., 2] = 0.5
    np.testing.assert_array_equal(made.coordinates(u), expected)
    u[..., 4] = np.nan
    assert np.isnan(made.coordinates(u)[..., 2]).all()
