"""Which targets are settled and tried by other tasks, and the end of an arm's reach."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels import ik_codes as codes
from poekin.errors import InputError
from poekin.solve.ik import diagnosis
from poekin.solve.ik.diagnosis import Causes
from poekin.solve.ik.task import make_task

REASONS = np.array(["solved", "unreachable", "bad target", "limits", "iterations", "unreachable"])


@pytest.mark.parametrize("underactuated", [False, True])
def test_of_an_arm_with_few_coordinates_unsolved_targets_are_settled_and_unreached_ones_tried(
    underactuated, monkeypatch
):
    rows: list[Any] = []
    after = np.array([True, False, False, False, True, False])

    def causes(problem: Any, targets: Any, q: Any, info: Any, success: np.ndarray) -> Causes:
        rows.append(success.tolist())
        return Causes(REASONS, np.zeros(6))

    def tasks(problem: Any, targets: Any, first: Any, which: np.ndarray) -> Any:
        rows.append(which.tolist())
        return (("position",),) * 6

    monkeypatch.setattr(diagnosis, "find_causes", causes)
    monkeypatch.setattr(diagnosis, "settle", lambda *given: rows.append(given[-1].tolist()))
    monkeypatch.setattr(diagnosis, "reachable_tasks", tasks)
    problem: Any = SimpleNamespace(
        underactuated=underactuated,
        coordinates=lambda q: q,
        pose_errors=lambda T, q: (None, after),
    )
    info = np.zeros((6, codes.INFO))
    info[:, codes.AT_STATE] = codes.STALLED
    info[2, codes.AT_STATE] = codes.BAD_TARGET
    success = np.arange(6) == 0
    q = np.zeros((6, 2))
    found = diagnosis.diagnose(problem, np.zeros((6, 4, 4)), q, q, info, success)
    if underactuated:
        assert rows == [[1, 3, 4, 5], after.tolist(), [1, 5]]
        assert found.reachable_tasks == (("position",),) * 6
    else:
        assert rows == [success.tolist()]
        assert found.reachable_tasks == ()


def test_other_tasks_are_tried_but_those_that_the_arm_has_no_plane_for():
    tried: list[Any] = []

    def with_task(name: str) -> Any:
        if name == "planar":
            raise InputError("no plane")

        def solve(T: np.ndarray, numbers: np.ndarray, first: np.ndarray, restarts: int) -> Any:
            tried.append((name, T[:, 0, 0].tolist(), numbers.tolist(), first.tolist(), restarts))
            return first, None

        reached = {"position": [True, False], "rotation": [True, True], "direction": [False] * 2}
        return SimpleNamespace(
            solve=solve,
            coordinates=lambda q: q,
            pose_errors=lambda T, q: (None, np.array(reached[name])),
        )

    problem: Any = SimpleNamespace(
        task=SimpleNamespace(name="pose"),
        with_task=with_task,
        settings=SimpleNamespace(restarts=50),
    )
    targets = np.arange(4.0)[:, None, None] * np.ones((4, 4))
    first = np.arange(4.0)[:, None]
    rows = np.array([1, 3])
    found = diagnosis.reachable_tasks(problem, targets, first, rows)
    assert found == ((), ("position", "rotation"), (), ("rotation",))
    asked = ([1, 3], [1, 3], [[1], [3]], 20)
    assert tried == [(name, *asked) for name in ("direction", "position", "rotation")]
    problem.settings.restarts = 7
    diagnosis.reachable_tasks(problem, targets, first, rows)
    assert tried[-1][-1] == 7


@pytest.mark.parametrize("beyond", [0.0, 1e-9])
def test_a_target_at_the_end_of_the_reach_is_not_beyond_it(beyond):
    axes = [pk.screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in (0, 1, 2)]
    arm = pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, 2.7, 0, 0]))
    target = pk.se3.exp([[0, 0, 0, 2.7 + beyond, 0, 0]])
    found = diagnosis.distance_beyond_reach(arm, make_task("pose", None, None), target, arm.limits)
    # of the reach a millionth of a millionth is spared for rounding
    np.testing.assert_allclose(found, beyond, rtol=0, atol=3e-12 if beyond else 0)
