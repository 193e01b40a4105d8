"""Conventions that may not differ decide the outcome, and others do not."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from benchmarks.planted_changes import arm, planted
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.compare import compare
from poekin.analysis.compare.comparison import JointComparison
from poekin.analysis.compare.differences.conventions import (
    BUT_NAMES,
    CONVENTIONS,
    Convention,
    checked,
    judged,
    limits_differ,
)
from poekin.errors import InputError
from poekin.groups import se3
from poekin.model.chain import Chain

UR = arm("ur5e")
TOL = Tolerances(1e-5, 1e-5)


def one_other(word):
    """The arm with one convention changed."""
    rng = np.random.default_rng(0)
    limits = UR.limits.copy()
    limits[1, 0] += 0.1
    names = [f"j{k}" for k in range(6)]
    return {
        "base": lambda: UR.rebased(se3.exp([0.1, 0.2, 0, 0, 0, 0.1])),
        "tool": lambda: UR.retooled(se3.exp([0, 0, 0, 0, 0.003, 0])),
        "zeros": lambda: planted(UR, "zero", 2, rng),
        "directions": lambda: planted(UR, "flip", 2, rng),
        "limits": lambda: UR.replace(limits=limits),
        "names": lambda: Chain.from_space(UR.screws, UR.home, joint_names=names, limits=UR.limits),
    }[word]()


@pytest.mark.parametrize("word", CONVENTIONS)
def test_a_convention_counts_where_it_may_not_differ_and_only_there(word):
    other = one_other(word)
    others: list[Convention] = [name for name in CONVENTIONS if name != word]
    outcome = "differ" if word == "limits" else "conventions"
    assert compare(UR, other, samples=1, same=(word,)).outcome == outcome
    assert compare(UR, other, samples=1, same=CONVENTIONS).outcome == outcome
    assert compare(UR, other, samples=1, same=others).outcome == "same"
    left_out = compare(UR, other, samples=1, same=())
    assert (left_out.outcome, left_out.equal, left_out.same_arm) == ("same", True, True)
    usual = compare(UR, other, samples=1)
    assert usual.same == BUT_NAMES
    assert usual.equal == (word == "names")


def test_an_arm_that_differs_does_so_whatever_may():
    other = planted(UR, "shift", 2, np.random.default_rng(0))
    for words in ((), BUT_NAMES, CONVENTIONS):
        result = compare(UR, other, samples=1, same=words)
        assert (result.outcome, result.same_arm) == ("differ", False)


@pytest.mark.parametrize("words", list(combinations(CONVENTIONS, 2)))
def test_of_two_conventions_that_differ_limits_decide_and_another_arm_before_them(words):
    joints = [joint for word in words for joint in compare(UR, one_other(word), samples=1).joints]
    frames = {
        word: compare(UR, one_other(word), samples=1) for word in ("base", "tool") if word in words
    }
    reading: Any = SimpleNamespace(base=np.eye(4), tool=np.eye(4))
    for word, result in frames.items():
        setattr(reading, word, getattr(result, word))

    def found(same, alike=True):
        return judged(joints, reading, alike, same, TOL)

    assert found(()) == (True, "same")
    assert found(CONVENTIONS) == (True, "differ" if "limits" in words else "conventions")
    for word in words:
        assert found((word,)) == (True, "differ" if word == "limits" else "conventions")
    assert found((), alike=False) == (False, "differ")


KNOWN = "'base', 'tool', 'zeros', 'directions', 'limits' or 'names'"


@pytest.mark.parametrize("same, message", [
    ("base", f"same: expected a tuple of {KNOWN}, got 'base'"),
    (None, f"same: expected a tuple of {KNOWN}, got None"),
    (("base", "speed"), f"same: expected names out of {KNOWN}, got 'speed'"),
    (([],), f"same: expected names out of {KNOWN}, got []"),
])  # fmt: skip
def test_a_word_that_is_no_convention_is_refused(same, message):
    with pytest.raises(InputError) as caught:
        compare(UR, UR, same=same)
    assert str(caught.value) == message


def test_conventions_come_once_and_in_their_order():
    assert checked(["tool", "base", "tool"]) == ("base", "tool")
    assert checked({"names"}) == ("names",)
    assert checked(frozenset()) == ()


JOINT = JointComparison(
    1, "a", "b", "revolute", "revolute", 0.0, 0.0, 0.0, 0.0, False, (0.0, 0.0), False, False,
    "", "", False, 0.0, (0.0, 0.0),
)  # fmt: skip


@pytest.mark.parametrize("changes, same, differ", [
    ({}, BUT_NAMES, False),
    ({"limits": (0.0, 2e-5)}, BUT_NAMES, True),
    ({"limits": (-2e-5, 0.0)}, BUT_NAMES, True),
    ({"limits": (1e-6, -1e-6)}, BUT_NAMES, False),
    # The same numbers about another zero, and the other way round
    ({"limits": (0.1, 0.1), "zero_differs": True}, BUT_NAMES, False),
    ({"limits": (0.1, 0.1), "zero_differs": True}, ("limits",), True),
    ({"limits": (0.1, 0.1), "reversed": True}, BUT_NAMES, False),
    ({"limits": (0.1, 0.1), "reversed": True}, ("zeros", "limits"), True),
    ({"limits": (0.1, 0.1), "limit_numbers": (0.1, 0.0), "reversed": True}, BUT_NAMES, True),
    # A slide is judged in metres
    ({"limits": (0.0, 2e-4), "kind_b": "prismatic"}, BUT_NAMES, True),
    ({"limits": (math.inf, 0.0)}, BUT_NAMES, True),
])  # fmt: skip
def test_limits_differ_by_more_than_zero_and_direction_explain(changes, same, differ):
    tol = TOL
    if "kind_b" in changes:
        tol = Tolerances(1e-4, 1.0)
    assert limits_differ(replace(JOINT, **changes), same, tol) == differ


def test_a_model_that_bounds_no_joint_states_no_limits():
    bare = Chain.from_space(UR.screws, UR.home, joint_names=UR.joint_names)
    for pair, model in (((UR, bare), "b"), ((bare, UR), "a")):
        result = compare(*pair, samples=1)
        assert (result.outcome, result.findings) == (
            "differ",
            (f"model {model} states no limits",),
        )
    limits = np.tile([-np.inf, np.inf], (6, 1))
    limits[0, 0] = -1.0
    result = compare(UR, UR.replace(limits=limits), samples=1)
    assert result.outcome == "differ"
    assert not any("states no limits" in text for text in result.findings)
    none = Chain.from_space(np.zeros((0, 6)), np.eye(4))
    assert compare(none, none, samples=1).findings == ()


def test_that_a_model_states_no_limits_is_said_only_where_limits_count_and_differ():
    bare = Chain.from_space(UR.screws, UR.home, joint_names=UR.joint_names)
    assert compare(bare, bare, samples=1).findings == ()
    assert compare(UR, bare, samples=1, same=("base",)).findings == ()
