"""Which solutions of a search are examined, and the ranges of its random starts."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels import ik_all_kernel as kernel
from poekin.solve.ik_all import ik_all_search as module
from poekin.solve.ik_all.solution_sets.found import Found
from poekin.solve.ik_all.solution_sets.places import Box
from poekin.solve.joint_units import bounds, periods
from poekin.solve.ragged import Ragged

Z = [0, 0, 1.0]


def searched(chain: pk.Chain) -> module.SearchedArm:
    box = Box(bounds(chain, True), periods(chain))
    return module.SearchedArm(chain.compile(), box, np.ones(chain.dof, bool))


@pytest.mark.parametrize("size", [0.03, 1.0, 30.0])
@pytest.mark.parametrize(("straight", "share", "singular"), [
    (True, 0.9, True),
    (True, 1.1, False),
    (False, 0.9, False),
])  # fmt: skip
def test_what_may_be_singular_in_any_unit_of_length_is_examined(size, straight, share, singular):
    axes = [pk.screw.revolute(Z, [size * k / 3, 0, 0]) for k in range(3)]
    chain = pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, size, 0, 0]))
    # an arm in one line is at the end of its reach: two solutions are one
    q = np.array([[0.3, 0.0, 0.0]]) if straight else np.array([[0.3, 0.4, -0.9]])
    none = np.zeros(1, int)
    found = Found(Ragged(q, none + 1), np.ones(1), none, none, none > 0, none > 0)
    # the bound of the search is of lengths in m, and a share of 1e-5 of them is examined
    bound = np.array([share * 1e-5 * max(size, 1 / size)])
    judged = module._examined(searched(chain), chain.fk(q), np.full((1, 3), np.nan), found, bound)
    assert judged.singular.tolist() == [singular]
    assert judged.self_motion == {}
    np.testing.assert_array_equal(judged.q.rows, q)


def test_of_a_continuum_one_solution_is_kept_that_is_within_the_limits():
    # axes 1 and 3 are the same: what one turns the other may turn back
    axes = [pk.screw.revolute(w, [0, 0, 0]) for w in ([0, 0, 1.0], [1.0, 0, 0], [0, 0, 1.0])]
    chain = pk.Chain.from_space(
        axes, pk.se3.exp([0, 0, 0, 0.2, 0.1, 0.3]), limits=[[1.0, 2.0], [-1, 1], [-3, 3]]
    )
    q = np.array([[0.5, 0.0, 0.7], [0.7, 0.0, 0.5], [1.2, 0.0, 0.0]])
    none = np.zeros(1, int)
    found = Found(Ragged(q, none + 3), np.arange(3.0), none, none, none > 0, none > 0)
    bound = np.full(3, 1e-9)
    T = chain.fk(q[:1])
    judged = module._examined(searched(chain), T, np.full((1, 3), np.nan), found, bound)
    assert judged.singular.tolist() == [True]
    np.testing.assert_array_equal(judged.q.rows, q[2:])
    assert judged.hits.tolist() == [2]
    motion = judged.self_motion[0]
    assert motion.names == ("joint1", "joint3")
    step = motion.step / motion.step[0]
    np.testing.assert_allclose(step, [1, 0, -1], atol=1e-6)
    # a walk of 0.05 rad, of which Newton's steps take little back
    assert np.linalg.norm(motion.step) == pytest.approx(0.05, rel=0.1)


@pytest.mark.parametrize("at_once", [4096, 35])
def test_each_target_is_searched_with_its_own_pose_starts_and_locked_values(at_once, monkeypatch):
    monkeypatch.setattr(module, "_AT_ONCE", at_once)
    asked: list[tuple[float, ...]] = []

    def call(address: object, T: np.ndarray, starts: np.ndarray, *words: np.ndarray) -> None:
        given, *_, values, _, _, indices, _, q, hits, condition, info = words
        columns = (T[:, 0, 3], starts[:, 0, 0], given, values[:, 1], indices)
        asked.extend(zip(*(column.tolist() for column in columns), strict=True))
        q[:], hits[:], condition[:], info[:] = 0.0, 1.0, 1.0, 0.0

    monkeypatch.setattr(kernel, "search", SimpleNamespace(call=call))
    axes = [pk.screw.revolute(Z, [0, 0, 0]), pk.screw.prismatic(Z)]
    chain = pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, 0.5, 0, 0]))
    k = np.arange(80.0)
    T = np.tile(np.eye(4), (80, 1, 1))
    T[:, 0, 3] = k
    values = np.stack([np.full(80, np.nan), 3 * k], axis=1)
    starts = Ragged(np.repeat(2 * k[:, None], 2, axis=1), np.ones(80, int))
    module.search(searched(chain), T, values, starts, module.Rule(3, 4, 5))
    assert asked == [(n, 2 * n, 1, 3 * n, n) for n in k.tolist()]


def test_random_starts_are_of_a_whole_turn_or_of_the_range():
    axes = [pk.screw.revolute(Z, [0, 0, 0]), pk.screw.prismatic(Z)]
    chain = pk.Chain.from_space(axes, np.eye(4), limits=[[0.5, 1.0], [-0.25, 0.75]])
    arm = searched(chain)
    np.testing.assert_allclose(arm.ranges, [[-np.pi, np.pi], [-0.25, 0.75]])
    halves = module.SearchedArm(arm.fast, Box(arm.box.limits, np.array([np.pi, 0.0])), arm.free)
    np.testing.assert_allclose(halves.ranges, [[-np.pi / 2, np.pi / 2], [-0.25, 0.75]])
