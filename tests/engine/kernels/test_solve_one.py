"""One target from one start: what the first try reaches, judged by the chain, and what is left to others."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from poekin.engine.kernels import ik_codes as codes
from poekin.engine.kernels import ik_kernels
from poekin.model.chain import Chain

from .test_ik_kernels import ARM, FREE, TARGET, WIDE, Q, options

SOLUTION = np.array([0.8, -0.2, 0.6, 0.9])
LOOSE = np.array([1e-6, 1e-6])


def asked(
    monkeypatch: Any,
    found: np.ndarray = SOLUTION,
    ended: int = codes.SOLVED,
    target: np.ndarray = TARGET,
    start: np.ndarray = Q,
    limits: np.ndarray = WIDE,
    tolerances: np.ndarray = LOOSE,
    periods: np.ndarray = FREE,
) -> tuple[int, list[float], list[float], list[np.ndarray]]:
    """Answer, q, info and starts of solve_one, whose try ends at `found`."""
    begun = []

    def descend(problem: Any, target: Any, q: np.ndarray, work: Any) -> Any:
        begun.append(q.copy())
        q[:] = found
        return ended, 9.0, 9.0, 5  # whatever the try says of its own errors

    monkeypatch.setattr(ik_kernels, "descend", descend)
    q = np.zeros(4)
    info = np.full(codes.INFO, -1.0)
    table = ARM.kernel_table
    answer = ik_kernels.solve_one.function(
        ARM, table, target, start, limits, FREE, options(), tolerances, periods, q, info
    )
    return answer, q.tolist(), info.tolist(), begun


def test_it_begins_at_the_start_and_says_what_the_chain_is_off_by(monkeypatch):
    answer, q, info, begun = asked(monkeypatch)
    assert answer == 1
    assert q == SOLUTION.tolist()
    assert info[:2] == pytest.approx([0.0, 0.0], abs=1e-14)
    assert info[2:] == [5, 0, codes.SOLVED]
    assert [start.tolist() for start in begun] == [Q.tolist()]


@pytest.mark.parametrize("axis", range(4))
def test_each_part_of_the_error_is_held_against_its_own_tolerance(monkeypatch, axis):
    off = SOLUTION + 1e-3 * np.eye(4)[axis]
    T = ARM.fk(off)
    position = float(np.linalg.norm(TARGET[:3, 3] - T[:3, 3]))
    for share in (0.9, 1.1):
        for k, expected in enumerate((position, 1e-3)):
            tolerances = np.ones(2)
            tolerances[k] = share * expected
            answer, _, info, _ = asked(monkeypatch, off, tolerances=tolerances)
            assert answer == int(share > 1), (share, k)
            assert info[:2] == pytest.approx([position, 1e-3], rel=1e-9)


def test_errors_as_large_as_the_tolerances_are_small_enough(monkeypatch):
    off = SOLUTION + 1e-3
    _, _, errors, _ = asked(monkeypatch, off)
    assert min(errors[:2]) > 1e-4
    assert asked(monkeypatch, off, tolerances=np.array(errors[:2]))[0] == 1


def test_a_start_at_its_limits_is_within_them(monkeypatch):
    for limits in (np.stack([Q, Q + 9.0], axis=1), np.stack([Q - 9.0, Q], axis=1)):
        answer, _, _, begun = asked(monkeypatch, limits=limits)
        assert (answer, len(begun)) == (1, 1)


def test_an_arm_of_three_joints_is_judged_by_all_of_them(monkeypatch):
    chain = Chain.from_space(ARM.screws[:3], ARM.home)
    q = np.zeros(3)
    monkeypatch.setattr(
        ik_kernels, "descend", lambda problem, target, q, work: (codes.SOLVED, 9.0, 9.0, 5)
    )
    answer = ik_kernels.solve_one.function(
        chain, chain.kernel_table, chain.fk(Q[:3]), Q[:3], WIDE[:3], FREE[:3],
        options(), LOOSE, FREE[:3], q, np.zeros(codes.INFO)
    )  # fmt: skip
    assert answer == 1
    assert q.tolist() == Q[:3].tolist()


def test_what_the_try_does_not_reach_is_left_to_others(monkeypatch):
    assert asked(monkeypatch, ended=codes.STALLED)[0] == 0
    nowhere = TARGET.copy()
    nowhere[2, 3] = math.nan
    unreached: tuple[dict[str, Any], ...] = (
        {"target": nowhere},
        {"start": np.array([0.0, math.nan, 0, 0])},
        {"start": np.array([0.0, 0, math.inf, 0])},
        {"start": np.array([0.0, 9.1, 0, 0])},
        {"start": np.array([0.0, 0, 0, -9.1])},
    )
    for given in unreached:
        answer, _, _, begun = asked(monkeypatch, **given)
        assert (answer, begun) == (0, [])


def test_coordinates_with_a_period_end_within_half_of_it(monkeypatch):
    turns = 2 * np.pi * np.array([1, -2, 3, 0])
    periods = np.array([2 * np.pi, 2 * np.pi, 0.0, 0.8])
    answer, q, _, _ = asked(monkeypatch, SOLUTION + turns, periods=periods, tolerances=np.ones(2))
    assert answer == 1
    expected = SOLUTION + np.array([0, 0, turns[2], -0.8])
    np.testing.assert_allclose(q, expected, rtol=0, atol=1e-14)
