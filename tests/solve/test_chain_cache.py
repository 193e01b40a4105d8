"""A cache of results by compiled chain: found again, the latest ones kept, by any number of threads."""

from __future__ import annotations

import gc
import pickle
import threading
import time

import numpy as np
import pytest

import poekin as pk
from poekin.model.kinematics.compiled import CompiledChain
from poekin.solve import chain_cache, joint_units
from poekin.solve.chain_cache import ChainCache
from poekin.solve.ik import ik_problem
from poekin.solve.ik.ik import ik

UR5 = pk.load("ur5").chain()


def test_a_result_is_found_for_its_own_chain_and_key_alone():
    cache: ChainCache[str] = ChainCache()
    one, other = CompiledChain(UR5), CompiledChain(UR5)
    assert cache.keep(one, "result", 3) == "result"
    assert cache.get(one, 3) == "result"
    assert cache.get(one, 4) is None
    assert cache.get(other, 3) is None, "equal chains are two"
    with pytest.raises(TypeError, match="unhashable"):
        cache.get(one, [3])  # type: ignore[arg-type]


def test_the_latest_results_are_kept(monkeypatch):
    monkeypatch.setattr(chain_cache, "KEPT", 3)
    cache: ChainCache[int] = ChainCache()
    fast = CompiledChain(UR5)
    for k in range(5):
        cache.keep(fast, k, k)
    assert len(cache) == 3
    assert [cache.get(fast, k) for k in range(5)] == [None, None, 2, 3, 4]


def test_a_chain_that_came_in_the_place_of_another_finds_nothing_of_it():
    cache: ChainCache[int] = ChainCache()
    for k in range(3):
        fast = CompiledChain(UR5)
        assert cache.get(fast) is None
        cache.keep(fast, k)
        del fast
        gc.collect()


def test_a_compiled_chain_carries_nothing_of_what_was_solved_with_it():
    fast = CompiledChain(UR5)
    before = pickle.dumps(fast)
    assert ik(fast, UR5.fk(UR5.random(0))).success
    assert pickle.dumps(fast) == before
    assert not any(isinstance(part, ik_problem.IKProblem) for part in vars(fast).values())
    assert fast == CompiledChain(UR5)


class Interrupted(dict):
    """A dict that other threads get their turn of while one begins to look through it."""

    def __iter__(self):
        looking = super().__iter__()
        time.sleep(1e-3)
        return looking


def test_threads_may_ask_one_arm_in_more_ways_than_are_kept(monkeypatch):
    monkeypatch.setattr(chain_cache, "KEPT", 64)
    cache: ChainCache[ik_problem.IKProblem] = ChainCache()
    cache._entries = Interrupted()
    monkeypatch.setattr(ik_problem, "_PROBLEMS", cache)
    fast = CompiledChain(UR5)
    T, wrong = UR5.fk(UR5.random(0)), []

    def ask(first):
        try:
            for seed in range(first, first + 64):
                assert ik(fast, T, seed=seed).success
        except RuntimeError as error:
            wrong.append(error)

    threads = [threading.Thread(target=ask, args=(first,)) for first in range(0, 256, 64)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []
    assert len(cache) == 64


def test_the_joint_units_of_a_geared_arm_are_made_once():
    geared = pk.Chain.from_space(
        UR5.screws, UR5.home, coupling=2 * np.eye(6), q_names=list("abcdef")
    )
    fast = geared.compile()
    units = joint_units.joint_units(fast)
    assert units.scale is not None
    assert joint_units.joint_units(fast) is units
