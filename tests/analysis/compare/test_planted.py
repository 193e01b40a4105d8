"""Differences of nine kinds, one at a time and two at once, in twenty arms: the outcome is right, and
the cause is named.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from benchmarks.planted_changes import ARMS, arm
from poekin.analysis.compare.compare import compare
from poekin.formats.load import load
from poekin.groups import se3
from tests.analysis.compare.planted import KINDS, Case, fault, plant, with_limits
from tests.analysis.compare.test_compare_slides import COBRA, RAILS

ON_RAILS = {f"{name} on a rail": chain for name, chain in RAILS.items()}
FRAMES = ("tool", "base", "mm file")


def joints(kind, n):
    """Numbers from 0 of the joints in which a difference can be told from one of base or tool."""
    if kind in FRAMES:
        return [0]
    if kind == "link length":
        return list(range(1, n - 2))
    return list(range(1, n - 1))


@pytest.mark.parametrize("name", ARMS)
def test_one_difference_is_named_and_no_other_joint_is_blamed(name):
    chain = with_limits(arm(name))
    rng = np.random.default_rng(list(ARMS).index(name))
    faults = {}
    # Three kinds in each arm, each kind in six or seven arms.
    kinds = KINDS[list(ARMS).index(name) % 3 :: 3]
    for kind in kinds:
        k = int(rng.choice(joints(kind, chain.dof)))
        case = plant(Case(chain, ()), kind, k, rng)
        faults[kind] = fault(compare(chain, case.chain, samples=20), case)
    assert faults == dict.fromkeys(kinds, "")


def two(chain, kinds, rng):
    """Two differences, two joints apart, as neighbours may say the same together."""
    first, second = (joints(kind, chain.dof) for kind in kinds)
    pairs = [(k, j) for k in first for j in second if abs(k - j) >= 2 or kinds[1] in FRAMES]
    k, j = pairs[rng.integers(len(pairs))]
    return plant(plant(Case(chain, ()), kinds[0], k, rng), kinds[1], j, rng)


def test_of_two_differences_at_once_the_outcome_is_right_and_nine_in_ten_are_named():
    pairs = [(one, other) for one, other in combinations(KINDS, 2) if one not in FRAMES]
    outcomes = []
    named = []
    for i, name in enumerate(list(ARMS)[::2]):
        chain = with_limits(arm(name))
        rng = np.random.default_rng(i)
        # Each pair in one arm; the full measure is every pair in every arm.
        for kinds in pairs[i::10]:
            case = two(chain, kinds, rng)
            result = compare(chain, case.chain, samples=20)
            outcomes.append(result.outcome == case.outcome)
            named.append(not fault(result, case))
    assert len(outcomes) == len(pairs)
    assert all(outcomes)
    assert np.mean(named) >= 0.9


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize(
    "name, frame",
    [
        *((name, "") for name in ("cobra600", "stanford", *ON_RAILS)),
        ("cobra600", "base"),
        ("stanford", "base"),
        ("panda on a rail", "tool"),
        ("six axes anywhere on a rail", "tool"),
    ],
)
def test_a_longer_link_is_named_where_a_slide_that_shows_no_motion_lies_beside_it(
    name, frame, swapped
):
    chain = with_limits(ON_RAILS.get(name) or load(name).chain())
    rng = np.random.default_rng(0)
    for k in joints("link length", chain.dof):
        if chain.kinds[k] == "prismatic":
            continue
        case = plant(Case(chain, ()), "link length", k, rng)
        if frame:
            case = plant(case, frame, 0, rng)
        pair = (case.chain, chain) if swapped else (chain, case.chain)
        result = compare(*pair, samples=5)
        assert fault(result, case) == ""
        slides = chain.kinds[k + 1] == "prismatic"
        assert any("which slides" in said for said in result.alternatives) == slides


def test_a_link_that_turned_the_slide_behind_it_is_not_one_behind_the_slide():
    S = COBRA.screws.copy()
    T = se3.exp([0.01, 0, 0, 0, 0.005, 0])
    S[2:] = S[2:] @ se3.adjoint(T).T
    result = compare(COBRA, COBRA.replace(screws=S, home=T @ COBRA.home), samples=5)
    (said,) = result.findings
    assert said.startswith("the link between joint 2 ('joint2') and joint 3 ('joint3') differs")
    assert not any("which slides" in said for said in result.alternatives)


@pytest.mark.parametrize("swapped", [False, True])
def test_an_axis_and_a_tool_that_did_not_move_with_it_across_a_slide_are_no_link(swapped):
    chain = with_limits(COBRA)
    rng = np.random.default_rng(0)
    case = plant(plant(Case(chain, ()), "shift", 3, rng), "tool", 0, rng)
    pair = (case.chain, chain) if swapped else (chain, case.chain)
    assert fault(compare(*pair, samples=5), case) == ""


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("kind", ["tilt", "shift"])
@pytest.mark.parametrize("link", [1, 2])
@pytest.mark.parametrize("name", ["ur5e", "ur10e"])
def test_an_axis_behind_another_link_is_told_beside_it_where_the_others_are_parallel(
    name, link, kind, swapped
):
    chain = with_limits(load(name).chain(tip={"ur5e": "tool0"}.get(name)))
    rng = np.random.default_rng(link)
    case = plant(plant(Case(chain, ()), kind, 4, rng), "link length", link, rng)
    pair = (case.chain, chain) if swapped else (chain, case.chain)
    assert fault(compare(*pair, samples=5), case) == ""


@pytest.mark.parametrize("seed", range(4))
def test_an_axis_is_told_in_full_and_not_in_part_as_a_base_or_tool_that_moved(seed):
    chain = with_limits(load("stanford").chain())
    rng = np.random.default_rng(seed)
    case = plant(plant(Case(chain, ()), "tilt", 4, rng), "shift", 1, rng)
    result = compare(chain, case.chain, samples=5)
    assert fault(result, case) == ""
    assert result.base == pytest.approx(np.eye(4), abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_the_battery_sees_a_difference_that_is_not_named(kind):
    chain = with_limits(arm("panda"))
    rng = np.random.default_rng(1)
    case = plant(Case(chain, ()), kind, 2, rng)
    nothing = compare(chain, chain, samples=1)
    assert fault(nothing, case).startswith("outcome same")
    other = plant(Case(chain, ()), "tilt", 4, rng)
    wrong = compare(chain, other.chain, samples=1)
    assert fault(wrong, case._replace(planted=(*case.planted, ("tilt", 5)))) != ""
    assert fault(wrong, other) == ""
    assert fault(wrong, Case(chain, (("tilt", 5), ("shift", 4)))).endswith(wrong.verdict)


@pytest.mark.parametrize("name", ["panda", "ur5e", "random 6a"])
@pytest.mark.parametrize("kinds", [("zero", "tilt"), ("direction", "base"), ("shift", "tool")])
def test_either_way_round_the_same_joints_are_blamed(name, kinds):
    chain = with_limits(arm(name))
    case = two(chain, kinds, np.random.default_rng(5))
    there = compare(chain, case.chain, samples=5)
    back = compare(case.chain, chain, samples=5)
    assert there.outcome == back.outcome
    for one, other in zip(there.joints, back.joints, strict=True):
        assert (one.axis_differs, one.zero_differs, one.reversed) == (
            other.axis_differs,
            other.zero_differs,
            other.reversed,
        )
        # f_b(s x + z) = f_a(x) is f_a(s (y - z)) = f_b(y)
        way = -1.0 if one.reversed else 1.0
        assert other.zero_offset == pytest.approx(-way * one.zero_offset, abs=1e-9)
        assert other.angle == pytest.approx(one.angle, abs=1e-9)
        assert other.normal == pytest.approx(one.normal, abs=1e-9)
    assert there.base is not None
    assert back.base is not None
    assert there.base @ back.base == pytest.approx(np.eye(4), abs=1e-12)
    assert there.tool is not None
    assert back.tool is not None
    assert there.tool @ back.tool == pytest.approx(np.eye(4), abs=1e-12)
