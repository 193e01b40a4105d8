"""compare names the joint that differs and its size, blames nothing else, and knows what is a free
choice.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from benchmarks.planted_changes import (
    ARMS,
    CHANGES,
    alignment_fault,
    arm,
    fault,
    moves,
    planted,
    random_arm,
)
from poekin.analysis.compare.alignment.lines import lines
from poekin.analysis.compare.compare import compare
from poekin.analysis.compare.mistakes.mirror import mirrored
from poekin.errors import InputError
from poekin.formats import dh
from poekin.formats.load import load
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain


@pytest.mark.parametrize("name", ARMS)
def test_one_change_in_an_interior_joint_is_named_and_sized_and_nothing_else_is_blamed(name):
    chain, rng = arm(name), np.random.default_rng(3)
    assert chain.kinds in (("revolute",) * 6, ("revolute",) * 7)
    faults = {
        (change, k): fault(compare(chain, planted(chain, change, k, rng), samples=1), change, k)
        for n, change in enumerate(CHANGES)
        for k in range(1, chain.dof - 1)
        if (n + k + list(ARMS).index(name)) % 4 == 0  # each kind and each joint: the report has all
    }
    assert {case: words for case, words in faults.items() if words} == {}


def test_the_battery_catches_a_wrong_joint_a_wrong_size_and_a_smeared_change():
    chain, rng = arm("random 6a"), np.random.default_rng(0)
    result = compare(chain, planted(chain, "shift", 2, rng), samples=1)
    assert fault(result, "shift", 2) == ""
    assert "blames" in fault(result, "shift", 3)
    assert fault(result, "tilt", 2).startswith("size")
    assert fault(result, "flip", 2).startswith("says")
    S = chain.screws.copy()
    S[2] = screw.revolute(
        S[2, :3], np.cross(S[2, :3], S[2, 3:]) + 1.02e-3 * np.cross(S[2, :3], S[0, :3])
    )
    assert fault(compare(chain, Chain.from_space(S, chain.home), samples=1), "shift", 2).startswith(
        "size"
    )
    assert "blames" in fault(
        compare(chain, chain.rezeroed([0, 0.01, 0.01, 0, 0, 0]), samples=1), "zero", 1
    )


@pytest.mark.parametrize("name", ARMS)
def test_a_moved_base_and_tool_are_alignment_only(name):
    chain, rng = arm(name), np.random.default_rng(4)
    faults = {
        what: alignment_fault(compare(chain, moved, samples=5), base, tool)
        for what, moved, base, tool in moves(chain, rng)
    }
    assert faults == {"base": "", "tool": "", "base and tool": ""}


@settings(deadline=None, max_examples=15)
@example(62020, "rrr")
@given(
    st.integers(0, 10**6), st.sampled_from(["rrrrrr", "rrprr", "prrr", "rrrp", "rrr", "rrp", "rr"])
)
def test_two_conventions_of_one_arm_are_equal_and_the_alignment_maps_one_onto_the_other(
    seed, kinds
):
    rng = np.random.default_rng(seed)
    chain = random_arm(seed, ["prismatic" if kind == "p" else "revolute" for kind in kinds])
    other = chain.rezeroed(rng.uniform(-1.2, 1.2, chain.dof)).rebased(se3.exp(rng.normal(size=6)))
    signs = rng.choice([-1.0, 1.0], chain.dof)
    result = compare(
        chain,
        Chain.from_space(other.screws * signs[:, None], other.home @ se3.exp(rng.normal(size=6))),
    )
    assert result.same_arm, result.verdict
    assert result.after is not None
    assert result.after.worst_position < 2e-4
    assert result.after.worst_rotation < np.radians(0.02)


@pytest.mark.parametrize("seed", range(4))
def test_a_shifted_axis_is_named_even_where_zeros_and_directions_differ_too(seed):
    rng = np.random.default_rng(seed)
    chain = arm("panda")
    other = chain.rezeroed(rng.normal(size=7)).rebased(se3.exp(rng.normal(size=6)))
    flipped = Chain.from_space(other.screws * rng.choice([-1.0, 1.0], 7)[:, None], other.home)
    result = compare(chain, planted(flipped, "shift", 3, rng))
    (moved,) = [j for j in result.joints if j.axis_differs]
    assert (moved.number, moved.normal) == (4, pytest.approx(1e-3, rel=0.01))


def test_two_shifted_axes_are_both_named():
    chain, rng = arm("random 7a"), np.random.default_rng(1)
    result = compare(
        chain,
        planted(planted(chain, "shift", 2, rng), "tilt", 4, rng).rebased(
            se3.exp(rng.normal(size=6))
        ),
    )
    assert [j.number for j in result.joints if j.axis_differs] == [3, 5]
    assert (result.joints[2].normal, result.joints[4].angle) == (
        pytest.approx(1e-3, rel=1e-2),
        pytest.approx(np.radians(0.1), rel=1e-2),
    )


@pytest.mark.parametrize("swapped", [False, True], ids=["a b", "b a"])
@pytest.mark.parametrize(
    "kinds, changes",
    [
        ("rrrrrrr", {3: "shift", 4: "tilt", 5: "zero"}),
        # Zero offsets of the slides, with base or tool elsewhere, would make up for one of the
        # shifts.
        ("rprprrr", {1: "shift", 3: "shift"}),
        ("rrrpprr", {1: "flip", 6: "shift", 7: "shift"}),
    ],
)
def test_of_several_changes_no_other_joint_is_blamed(kinds, changes, swapped):
    chain = random_arm(0, [{"r": "revolute", "p": "prismatic"}[kind] for kind in kinds])
    other, rng = chain, np.random.default_rng(0)
    for number, change in changes.items():
        other = planted(other, change, number - 1, rng)
    result = compare(*((other, chain) if swapped else (chain, other)), samples=1)
    assert [j.number for j in result.differing] == list(changes)
    assert [j.number for j in result.joints if j.axis_differs] == [
        number for number, change in changes.items() if change in ("shift", "tilt")
    ]
    assert [j.number for j in result.joints if j.zero_differs] == [
        number for number, change in changes.items() if change == "zero"
    ]


def test_a_zero_offset_of_an_end_joint_is_a_turned_base_or_tool_and_both_readings_are_given():
    chain = arm("ur5e")
    first, last = (
        compare(chain, chain.rezeroed(q).replace(limits=chain.limits))
        for q in ([0.1, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0.2])
    )
    assert (first.same_arm, first.differing, last.same_arm, last.differing) == (True, (), True, ())
    assert "zero offset of -5.73°" in first.alternatives[0]
    assert "joint 1" in first.alternatives[0]
    assert "zero offset of -11.46°" in last.alternatives[0]
    assert "joint 6" in last.alternatives[0]


def test_a_tilt_that_is_also_a_zero_offset_is_read_as_what_leaves_the_base_and_the_other_reading_is_given():
    # At its zero position the panda's axes 1 and 3 are one line: axis 2 turned about it is a zero
    # offset of joint 3.
    chain = arm("panda")
    S = chain.screws.copy()
    S[1] = se3.adjoint(se3.exp(S[0] * np.radians(0.1))) @ S[1]
    tilted = compare(chain, Chain.from_space(S, chain.home, joint_names=chain.joint_names))
    assert [j.number for j in tilted.differing] == [2]
    assert any(
        "zero offset of 0.1° of joint 3" in words or "of -0.1° of joint 3" in words
        for words in tilted.alternatives
    )


def test_the_extra_joint_is_named_where_one_can_be_dropped():
    chain = arm("panda")
    names = [*chain.joint_names[:4], "extra", *chain.joint_names[4:]]
    longer = Chain.from_space(
        np.insert(chain.screws, 4, screw.revolute([1, 2, 0], [0.1, 0.3, 0.2]), 0),
        chain.home,
        joint_names=names,
    )
    for pair, side in (((chain, longer), "b"), ((longer, chain), "a")):
        result = compare(*pair)
        assert (result.same_arm, result.unmatched_joints, result.differing) == (
            False,
            (side, "extra"),
            (),
        )
        assert "'extra'" in result.verdict
    lost = compare(arm("ur5e"), chain)
    assert (lost.same_arm, lost.unmatched_joints, lost.joints, lost.base) == (False, None, (), None)
    assert "6 joints against 7" in lost.verdict
    json.loads(lost.to_json())


def test_strict_shows_the_joints_as_they_stand_and_comes_to_the_same_verdict():
    chain = arm("ur5e")
    rng = np.random.default_rng(0)
    assert compare(chain, chain, strict=True).equal
    others = {
        "base": chain.rebased(se3.exp([0, 0, 0, 1e-3, 0, 0])),
        "tool": chain.retooled(se3.exp([0, 0, 0, 1e-3, 0, 0])),
        "sign of q": planted(chain, "flip", 2, rng),
        "zero": planted(chain, "zero", 2, rng),
    }
    for word, other in others.items():
        strict = compare(chain, other, strict=True)
        aligned = compare(chain, other)
        assert (strict.outcome, aligned.outcome) == ("conventions", "conventions")
        assert word in strict.verdict
        assert strict.verdict == aligned.verdict.replace("aligned: ", "")
        assert (strict.tool, strict.after) == (None, None)
    (zero, *behind) = compare(chain, others["zero"], strict=True).differing
    assert (zero.number, zero.axis_differs, zero.zero_differs) == (4, True, False)
    assert [joint.number for joint in behind] == [5, 6]


def test_a_strict_comparison_leaves_the_base_where_it_stands():
    chain = arm("ur5e")
    moved = compare(chain, chain.rebased(se3.exp([0, 0, 0, 1e-3, 0, 0])), strict=True, samples=1)
    assert "the base frame is moved by 1 mm" in moved.verdict
    assert moved.base == pytest.approx(np.eye(4), abs=1e-15)


def test_limits_are_compared_in_the_other_models_zero_and_direction():
    chain = arm("ur5e")
    limits = chain.limits.copy()
    limits[2, 1] -= np.radians(10)
    other = chain.replace(limits=limits)
    result = compare(chain, other)
    assert (result.outcome, result.same_arm) == ("differ", True)
    assert result.findings == ("joint 3 ('elbow_joint') has its upper limit 10° lower in model b",)
    assert compare(chain, other, same=("base", "tool", "zeros", "directions")).equal
    assert result.joints[2].limits == pytest.approx((0, -np.radians(10)))
    flipped = compare(chain, planted(chain, "flip", 2, np.random.default_rng(0)))
    assert flipped.joints[2].limits == pytest.approx((0, 0))


def test_another_kind_of_joint_is_said():
    chain = random_arm(1)
    S = chain.screws.copy()
    S[2] = screw.prismatic(S[2, :3])
    result = compare(chain, Chain.from_space(S, chain.home))
    assert (result.same_arm, [j.number for j in result.differing]) == (False, [3])
    assert "is revolute in one model and prismatic in the other" in result.verdict
    assert "direction" not in result.verdict


def test_axes_that_agree_exactly_share_the_blame_of_no_other_axis():
    # Their tables differ in a_2 by 0.7 mm, a_2 + a_3 by 0.05, d_4 by 10.209, d_5 by 4.15, d_1
    # (base) and d_6 (tool).
    result = compare(load("ur10").chain(), load("ur10e").chain(), samples=1)
    assert [j.number for j in result.differing] == [3, 4, 5, 6]
    assert [j.shift for j in result.differing] == pytest.approx(
        [0.7e-3, 0.05e-3, np.hypot(10.209e-3, 0.05e-3), np.hypot(4.15e-3, 0.05e-3)], rel=1e-6
    )
    assert "°" not in result.verdict


@pytest.mark.parametrize("k, column", [(1, "a"), (2, "a"), (1, "alpha")])
def test_one_link_of_another_length_or_twist_is_named_and_no_zero_offset_is_made_of_it(k, column):
    table = dh.published("ur5")
    rows = list(table.rows)
    rows[k] = replace(rows[k], **{column: getattr(rows[k], column) + 0.005})
    result = compare(dh.to_chain(table), dh.to_chain(dh.Table(table.convention, rows)), samples=5)
    assert not result.same_arm
    assert f"the link between joint {k + 1} (" in result.verdict
    assert "zero position" not in result.verdict
    size = "5 mm" if column == "a" else "0.2865°"
    assert size in result.verdict
    assert result.base == pytest.approx(np.eye(4))
    assert result.tool == pytest.approx(np.eye(4), abs=1e-9)


def test_what_is_the_same_within_tolerance_as_it_stands_is_not_aligned():
    chain, rng = arm("random 6b"), np.random.default_rng(0)
    result = compare(chain, planted(chain, "shift", 2, rng), tol_position=1.01e-3)
    assert (result.base, result.tool) == (
        pytest.approx(np.eye(4)),
        pytest.approx(np.eye(4), abs=1e-12),
    )
    assert result.after is not None
    assert result.before is not None
    assert result.after.worst_position == pytest.approx(result.before.worst_position, rel=1e-9)


def _coupled(C, c=None):
    chain = arm("ur5e")
    return Chain.from_space(
        chain.screws, chain.home, joint_names=chain.joint_names, coupling=C, offset=c,
        q_names=[f"q{k}" for k in range(np.shape(C)[1])],
    )  # fmt: skip


def test_joints_that_follow_others_differently_differ_though_all_axes_agree():
    C = np.delete(np.eye(6), 2, 1)
    ratio = {r: C.copy() for r in (1.0, -1.0, 2.0)}
    for r, matrix in ratio.items():
        matrix[2, 1] = r
    for one, other in ((1.0, -1.0), (1.0, 2.0)):
        result = compare(_coupled(ratio[one]), _coupled(ratio[other]), samples=1)
        assert (result.same_arm, [j.number for j in result.differing]) == (False, [3])
        assert (
            f"follows {one:g} × 'shoulder_lift_joint' in one model and follows {other:g} × "
            in result.verdict
        )
        assert compare(_coupled(ratio[one]), _coupled(ratio[one]), samples=1).same_arm
        assert not compare(
            _coupled(ratio[one]), _coupled(ratio[other]), samples=1, strict=True
        ).same_arm
    alone = compare(_coupled(ratio[1.0]), _coupled(np.eye(6)), samples=1)
    assert not alone.same_arm
    assert "and moves by itself in the other" in alone.verdict
    # A flipped joint that follows by the opposite ratio moves as before.
    chain = _coupled(ratio[2.0])
    S = chain.screws * np.array([1, 1, -1, 1, 1, 1])[:, None]
    C = np.diag([1.0, 1.0, -1.0, 1.0, 1.0, 1.0]) @ ratio[2.0]
    turned = Chain.from_space(
        S, chain.home, joint_names=chain.joint_names, coupling=C, q_names=chain.q_names
    )
    result = compare(chain, turned, samples=1)
    assert result.same_arm
    assert not any(j.coupling_differs for j in result.joints)


GROUND = np.array([[1.0, 0, 0], [0, 1, 0], [0, 1, 1]])
"""Joint 3 is read against the ground: x3 = q2 + q3."""


def _fanuc(ratio=1.0, half_range=1.0):
    chain = arm("ur5e")
    C = np.eye(6)
    C[:3, :3] = GROUND
    C[2, 1] = ratio
    limits = np.tile([-2.0, 2.0], (6, 1))
    limits[2] = [-half_range, half_range]
    return chain.replace(coupling=C, limits=limits)


def test_the_limits_of_a_reading_with_a_name_of_its_own_count_in_the_joint_that_follows_it():
    readings = [f"reading{k}" for k in range(6)]
    pair = [_fanuc(half_range=half).replace(q_names=readings) for half in (1.0, 0.5)]
    result = compare(*pair, samples=1)
    assert (result.outcome, result.same_arm) == ("differ", True)
    # x3 = r2 + r3, so that half a radian of r3 less is one of x3's.
    assert result.joints[2].limits == pytest.approx((0.5, -0.5))
    assert not any(joint.limits != (0.0, 0.0) for k, joint in enumerate(result.joints) if k != 2)


def test_directions_that_are_all_reversed_are_told_as_that_with_the_base_where_it_is():
    for name in ("ur5e", "panda"):
        chain = arm(name)
        turned = chain.replace(screws=-chain.screws)
        for a, b in ((chain, turned), (turned, chain)):
            result = compare(a, b, samples=5)
            assert [joint.reversed for joint in result.joints] == [True] * chain.dof
            assert not any(joint.zero_differs for joint in result.joints)
            assert result.base == pytest.approx(np.eye(4), abs=1e-9)
            assert result.tool == pytest.approx(np.eye(4), abs=1e-9)


def test_the_limits_of_a_coupled_reading_count():
    here = _fanuc()
    result = compare(here, _fanuc(half_range=0.5), samples=1)
    assert (result.outcome, result.same_arm) == ("differ", True)
    assert [text.startswith("joint 3 (") for text in result.findings] == [True]
    # Another zero of joint 2 moves that of joint 3, and both limits with it.
    moved = here.rezeroed([0, 0.1, 0, 0, 0, 0])
    result = compare(here, moved, samples=1)
    assert (result.outcome, [j.limits for j in result.joints]) == (
        "conventions",
        [pytest.approx((0, 0), abs=1e-12)] * 6,
    )


def test_the_poses_as_they_stand_are_those_of_the_same_readings():
    one, other = _fanuc(), _fanuc(-1.0)
    result = compare(one, other, samples=10)
    q = one.random(0, 10)
    apart = np.linalg.norm(one.fk(q)[:, :3, 3] - other.fk(q)[:, :3, 3], axis=1)
    assert result.before is not None
    assert result.before.worst_position == pytest.approx(apart.max(), rel=1e-12)
    assert result.after is not None
    assert result.after.worst_position < 1e-12


def test_a_joint_that_turns_in_one_model_and_slides_in_the_other_has_no_limits_to_compare():
    screws = arm("ur5e").screws.copy()
    screws[2] = [0, 0, 0, 0, 0, 1]
    limits = np.tile([-2.0, 2.0], (6, 1))
    one = arm("ur5e").replace(limits=limits)
    limits[2] = [0.0, 0.5]
    other = one.replace(screws=screws, limits=limits)
    result = compare(one, other, samples=1)
    third = result.joints[2]
    assert np.isnan([*third.limits, *third.limit_numbers]).all()
    assert third.axis_differs
    assert not any("limit" in text for text in result.findings)


def test_a_ratio_to_a_coordinate_whose_joint_is_not_on_the_chain_is_compared():
    scaled = np.eye(6)
    scaled[4, 4] = 2.0
    result = compare(_coupled(np.eye(6)), _coupled(scaled), samples=1)
    assert (result.same_arm, [j.number for j in result.differing]) == (False, [5])


def test_tolerances_are_metres_and_radians():
    chain, rng = arm("random 6b"), np.random.default_rng(0)
    assert compare(chain, planted(chain, "shift", 2, rng), tol_position=1.01e-3).same_arm
    assert not compare(chain, planted(chain, "shift", 2, rng), tol_position=1e-4).same_arm


def test_chains_without_joints_and_with_one_compare():
    none = Chain.from_space(np.zeros((0, 6)), np.eye(4))
    assert compare(none, none.retooled(se3.exp([1, 0, 0, 1, 0, 0]))).same_arm
    one = Chain.from_space([screw.revolute([0, 0, 1], [1, 0, 0])], np.eye(4))
    assert compare(one, one.rebased(se3.exp([1, 2, 0, 1, 0, 0]))).same_arm


def test_json_is_plain_and_complete():
    document = json.loads(compare(arm("ur5e"), arm("erd:ur5_robot")).to_json())
    assert document["equal"] is False
    assert len(document["joints"]) == 6
    assert {"angle", "normal", "zero_offset", "unit", "differs", "limits"} <= set(
        document["joints"][0]
    )


@pytest.mark.parametrize(
    "options",
    [
        {"tol_position": 0},
        {"tol_rotation": -1},
        {"tol_position": float("nan")},
        {"samples": 0},
        {"seed": -1},
        {"tol_rotation": "x"},
    ],
)
def test_options_out_of_range_are_refused(options):
    with pytest.raises(InputError, match=next(iter(options))):
        compare(random_arm(0), random_arm(0), **options)


def test_a_robot_is_no_chain():
    with pytest.raises(InputError, match="chain"):
        compare(load("panda"), arm("panda"))  # type: ignore[arg-type]


CHAIN = "expected a Chain, as Robot.chain(tip=...) makes it, got 5"
WHOLE = {
    "a": ({"a": 5}, f"a: {CHAIN}"),
    "b": ({"b": 5}, f"b: {CHAIN}"),
    "tol_position": ({"tol_position": 0}, "tol_position: expected a positive number, got 0"),
    "tol_rotation": ({"tol_rotation": "x"}, "tol_rotation: expected a positive number, got 'x'"),
    "no samples": (
        {"samples": 0},
        "samples: expected a whole number from 1 on, got 0",
    ),
    "half a sample": (
        {"samples": 1.5},
        "samples: expected a whole number from 1 on, got 1.5",
    ),
    "a truth value": (
        {"samples": True},
        "samples: expected a whole number from 1 on, got True",
    ),
}


@pytest.mark.parametrize("options, message", WHOLE.values(), ids=WHOLE)
def test_what_cannot_be_compared_is_said_whole(options: dict[str, Any], message):
    two = {"a": random_arm(0), "b": random_arm(0)} | {k: options[k] for k in "ab" if k in options}
    with pytest.raises(InputError) as caught:
        compare(two["a"], two["b"], **{k: v for k, v in options.items() if k not in two})
    assert str(caught.value) == message


REVERSED = "joint 3 ('elbow_joint') has the sign of q flipped: 308 mm at the tool"
IN_MM = "the models differ; lengths of model b are 1000 times those of model a (millimetres against metres?)"
OTHER = "the models are the same arm in other conventions"


@pytest.mark.parametrize("change, aligned, strict", [
    ("nothing", "the models are the same", "the models are the same"),
    ("direction", f"{OTHER}; {REVERSED}", f"{OTHER}; {REVERSED}"),
    ("unit", IN_MM, IN_MM),
    ("tool", f"{OTHER}; aligned: the tool frame is moved by 100 mm", f"{OTHER}; the tool frame is moved by 100 mm"),
])  # fmt: skip
def test_a_verdict_says_what_differs_and_nothing_else(change, aligned, strict):
    chain = arm("ur5e")
    S, home = chain.screws.copy(), chain.home.copy()
    if change == "direction":
        S[2] *= -1
    if change == "unit":
        S[:, 3:] *= 1e3
        home[:3, 3] *= 1e3
    if change == "tool":
        home = home @ se3.exp([0, 0, 0, 0, 0, 0.1])
    other = chain.replace(screws=S, home=home)
    assert compare(chain, other, samples=1).verdict == aligned
    assert compare(chain, other, samples=1, strict=True).verdict == strict


@pytest.mark.parametrize("numbers, verdict", [
    ((3, 5), "the models differ: 3 joints against 5, and no two joints can be dropped so that the rest agree"),
    ((5, 4), "the models differ: 5 joints against 4, and no one joint can be dropped so that the rest agree"),
    ((6, 3), "the models differ: 6 joints against 3, and no 3 joints at the ends can be dropped so that the rest"
             " agree"),
])  # fmt: skip
def test_numbers_of_joints_that_do_not_fit_are_said_whole(numbers, verdict):
    a, b = (random_arm(k, ("revolute",) * n) for k, n in enumerate(numbers))
    found = compare(a, b, samples=7, seed=3, tol_position=2e-5, tol_rotation=5e-5)
    assert (
        found.verdict,
        found.same_arm,
        found.joints,
        found.unmatched_joints,
        found.alternatives,
    ) == (
        verdict,
        False,
        (),
        None,
        (),
    )
    assert (found.base, found.tool, found.before, found.after) == (None, None, None, None)
    assert (found.strict, found.tol_position, found.tol_rotation, found.samples, found.seed) == (
        False,
        2e-5,
        5e-5,
        7,
        3,
    )


def test_a_model_that_no_dropped_joints_match_is_at_rest_as_any_other():
    turned = random_arm(2, ("revolute",) * 5).replace(offset=np.full(5, 0.3))
    found = compare(random_arm(1, ("revolute",) * 4), turned, samples=1)
    assert (found.joints, found.b.offset.any()) == ((), False)
    assert found.b.fk(np.zeros(5)) == pytest.approx(turned.fk(np.zeros(5)))


def test_pose_errors_of_a_mirrored_model_are_first_those_of_the_file_as_it_stands():
    chain = arm("ur5e")
    other = mirrored(chain, "y")
    found = compare(chain, other, samples=5)
    q = chain.random(0, 5)
    gaps = chain.fk(q)[:, :3, 3] - other.fk(q)[:, :3, 3]
    assert found.mistake == "mirrored"
    assert found.before is not None
    assert found.before.worst_position == pytest.approx(np.linalg.norm(gaps, axis=1).max())


def test_a_mirrored_model_is_named_too_where_its_joints_are_not_at_0_as_its_coordinates_are():
    chain = arm("ur5e")
    offset = np.array([0.1, 0.2, -0.3, 0.4, 0.5, -0.6])
    other = mirrored(chain, "y").rezeroed(-offset).replace(offset=offset)
    found = compare(chain, other, samples=1)
    assert (found.mistake, found.differing) == ("mirrored", ())


@pytest.mark.parametrize("share", [0.9996, 1.0004])
@pytest.mark.parametrize("name", ["tol_position", "tol_rotation"])
def test_a_tolerance_is_kept_to_less_than_a_thousandth(name, share):
    chain = random_arm(3)
    S, k = chain.screws.copy(), 2
    across = np.cross(S[k, :3], S[0, :3]) / np.linalg.norm(np.cross(S[k, :3], S[0, :3]))
    tol = {"tol_position": 5e-4, "tol_rotation": np.radians(0.5)}[name]
    size = share * tol
    if name == "tol_position":
        motion = np.concatenate([np.zeros(3), size * across])
    else:
        place = lines(chain).places[k] + lines(chain).centre
        motion = size * screw.revolute(across, place)
    S[k] = se3.adjoint(se3.exp(motion)) @ S[k]
    tolerances: dict[str, Any] = {"tol_position": 0.05, "tol_rotation": 0.1, name: tol}
    found = compare(chain, Chain.from_space(S, chain.home), strict=True, samples=1, **tolerances)
    assert [joint.number for joint in found.joints if joint.axis_differs] == (
        [k + 1] if share > 1 else []
    )
    assert found.equal == (share < 1)
