"""compare where one model has joints that the other has not, and where joints are helical."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.planted_changes import arm, random_arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare import unmatched_joints
from poekin.analysis.compare.alignment.search import agreeing, search
from poekin.analysis.compare.compare import compare
from poekin.analysis.compare.locked_joints import held_positions
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain

TOL = Tolerances(1e-5, np.radians(1e-3))


def longer_by(chain, places, rng):
    """The chain with revolute joints that it did not have before the joints at some places, and
    their names.
    """
    rows, names, added = list(chain.screws), list(chain.joint_names), []
    for k in sorted(places, reverse=True):
        rows.insert(k, screw.revolute(rng.normal(size=3), 0.3 * rng.normal(size=3)))
        names.insert(k, f"extra{k}")
        added.insert(0, f"extra{k}")
    return Chain.from_space(rows, chain.home, joint_names=names), tuple(added)


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([(2,), (5,), (0, 3), (1, 2), (4, 6)]), st.booleans())
def test_one_or_two_extra_joints_are_named_wherever_they_are(seed, places, swapped):
    rng = np.random.default_rng(seed)
    chain = random_arm(seed)
    other, added = longer_by(chain, places, rng)
    moved = other.rebased(se3.exp(rng.normal(size=6))).retooled(se3.exp(rng.normal(size=6)))
    result = compare(moved, chain, samples=5) if swapped else compare(chain, moved, samples=5)
    assert result.unmatched_joints == ("a" if swapped else "b", *added)
    assert (result.same_arm, result.differing) == (False, ())
    assert all(f"'{name}'" in result.verdict for name in added)
    assert f"{'two joints' if len(added) == 2 else 'one joint'} more" in result.verdict
    assert result.after is not None
    assert result.after.worst_position < 1e-5
    json.loads(result.to_json())


@pytest.mark.parametrize("places", [(3,), (3, 5)])
def test_extra_joints_of_the_panda_are_named_under_other_zeros_too(places):
    chain, rng = arm("panda"), np.random.default_rng(2)
    other, added = longer_by(chain, places, rng)
    result = compare(chain, other.rezeroed(0.3 * rng.normal(size=other.dof)), samples=5)
    assert result.unmatched_joints == ("b", *added)
    assert not any(j.axis_differs for j in result.joints)
    assert result.after is not None
    assert result.after.worst_position < 1e-5


@pytest.mark.parametrize(
    "extra_joint",
    [
        lambda S: screw.prismatic([1, 2, 3]),  # that moves the axes behind it without turning them
        lambda S: screw.revolute(
            S[2, :3], [0.1, 0.2, 0]
        ),  # parallel to the axis before it: no angle tells where
        lambda S: screw.helical([1, 2, 0], [0.1, 0.3, 0.2], 0.02),
    ],
    ids=["prismatic", "parallel to a neighbour", "helical"],
)
def test_an_extra_joint_of_any_kind_is_named_at_another_zero(extra_joint):
    chain = random_arm(3, ("revolute",) * 5)
    rows = np.insert(chain.screws, 3, extra_joint(chain.screws), 0)
    names = [*chain.joint_names[:3], "extra", *chain.joint_names[3:]]
    other = Chain.from_space(rows, chain.home, joint_names=names).rezeroed(
        [0.2, -0.1, 0.3, 0.4, -0.2, 0.1]
    )
    # The joint behind it counts the other way.
    other = Chain.from_space(
        other.screws * np.array([1, 1, 1, 1, -1, 1])[:, None], other.home, joint_names=names
    )
    for pair, side in (((chain, other), "b"), ((other, chain), "a")):
        result = compare(*pair, samples=5)
        assert result.unmatched_joints == (side, "extra")
        assert result.after is not None
        assert result.after.worst_position < 1e-5
    # An axis that is elsewhere as well is no matter of where the joint is held.
    S = np.array(other.screws)
    S[1] = se3.adjoint(se3.exp(np.array([0.01, 0, 0, 0, 0.01, 0]))) @ S[1]
    assert (
        compare(
            chain, Chain.from_space(S, other.home, joint_names=names), samples=1
        ).unmatched_joints
        is None
    )


def scara():
    """Three parallel axes and a quill along them."""
    turning = [screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 0.4, 0.7)]
    return Chain.from_space(
        [*turning[:2], screw.prismatic([0, 0, -1]), turning[2]], se3.exp([0, 0, 0, 0.7, 0, 0.3])
    )


ALONG = screw.revolute([0, 0, 1], [0.2, 0.3, 0])
ACROSS = screw.revolute([0.3, -1, 0.4], [0.1, 0.2, -0.3])
OTHER = screw.revolute([1, 0.5, -0.2], [-0.2, 0.3, 0.1])
SLIDE = screw.prismatic([1, 2, 3])


OPPOSITE = [screw.revolute([0, 0, 1], [0, 0, 0]), screw.revolute([0, 0, -1], [0.3, 0, 0])]


@pytest.mark.parametrize(
    "chain, k, extra_joints",
    [
        (random_arm(4), 3, [ACROSS, OTHER]),
        (random_arm(4), 3, [SLIDE, OTHER]),
        (random_arm(1, ("revolute", "prismatic", "revolute", "revolute")), 1, [ACROSS, OTHER]),
        (random_arm(1, ("revolute", "prismatic", "revolute", "revolute")), 2, [OTHER]),
        (scara(), 1, [ALONG]),  # parallel to both neighbours: a distance alone tells where
        # one of them the other way round
        (Chain.from_space([*OPPOSITE, ACROSS, OTHER], np.eye(4)), 1, [ALONG]),
        (scara(), 2, [ALONG]),  # the same across a slide
        (scara(), 3, [SLIDE]),
        # held anywhere that leaves the distance
        (scara(), 1, [ALONG, screw.revolute([0, 0, 1], [0.4, 0.1, 0])]),
        # a turn away
        (random_arm(2, ("revolute",) * 5), 2, [screw.helical([1, 2, 0], [0.1, 0.3, 0.2], 0.02)]),
    ],
    ids=["two", "two, one slides", "two behind a turning axis and before a slide", "behind a slide", "parallel",
         "opposite", "parallel, before a slide", "a slide between parallel axes", "two parallel", "helical"],
)  # fmt: skip
def test_extra_joints_beside_each_other_and_beside_parallel_axes_are_named_at_other_zeros(
    chain, k, extra_joints
):
    added = [f"extra{i}" for i in range(len(extra_joints))]
    names = [*chain.joint_names[:k], *added, *chain.joint_names[k:]]
    rows = np.concatenate([chain.screws[:k], extra_joints, chain.screws[k:]])
    other = Chain.from_space(rows, chain.home, joint_names=names)
    q = np.where(np.array(other.kinds) == "prismatic", 0.1, 0.7) * np.resize(
        [1, -1, 0.8], len(names)
    )
    q[k] -= 2 * np.pi if other.kinds[k] == "helical" else 0.0
    result = compare(
        chain, other.rezeroed(q).rebased(se3.exp([0.2, 0.5, -0.3, 0.1, 0.2, 0.3])), samples=5
    )
    assert result.unmatched_joints == ("b", *added)
    assert not any(j.axis_differs for j in result.joints)
    assert result.after is not None
    assert result.after.worst_position < 1e-5


def test_of_parallel_joints_that_fit_alike_rounding_does_not_choose():
    chain = (
        scara()
    )  # of its parallel axes and two more, extra0 and joint2 can be dropped as exactly as the two
    rows = [chain.screws[0], ALONG, screw.revolute([0, 0, 1], [0.4, 0.1, 0]), *chain.screws[1:]]
    names = ["joint1", "extra0", "extra1", *chain.joint_names[1:]]
    other = Chain.from_space(rows, chain.home, joint_names=names).rezeroed(
        [0.7, -0.7, 0.6, 0.7, -0.1, 0.6]
    )
    rng = np.random.default_rng(3)
    for _ in range(4):
        moved = other.rebased(se3.exp(rng.normal(size=6)))
        assert compare(chain, moved, samples=1).unmatched_joints == ("b", "extra0", "extra1")


@pytest.mark.parametrize(
    "joints, words", [(6, "no one joint"), (5, "no two joints"), (4, "no 3 joints at the ends")]
)
def test_where_no_joints_can_be_dropped_that_is_said(joints, words):
    result = compare(random_arm(1, ("revolute",) * joints), random_arm(2, ("revolute",) * 7))
    assert (result.same_arm, result.unmatched_joints, result.joints, result.base) == (
        False,
        None,
        (),
        None,
    )
    assert f"{joints} joints against 7, and {words}" in result.verdict


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6), st.lists(st.floats(-1, 1), min_size=6, max_size=6))
def test_the_quick_look_lets_every_pair_of_models_that_agree_pass(seed, wobble):
    # Every axis off by half a tolerance in direction and in place, base and zeros moved: the search
    # would agree.
    rng = np.random.default_rng(seed)
    chain = random_arm(seed)
    rows = []
    for S, part in zip(chain.screws, wobble, strict=True):
        z, p = S[:3], np.cross(S[:3], S[3:])
        across = np.cross(z, rng.normal(size=3))
        across *= 0.5 * part / np.linalg.norm(across)
        rows.append(screw.revolute(z + np.radians(1e-3) * across, p + 1e-5 * across))
    other = (
        Chain.from_space(rows, chain.home)
        .rezeroed(rng.normal(size=6))
        .rebased(se3.exp(rng.normal(size=6)))
    )
    assert unmatched_joints._may_agree(chain, other, TOL)
    assert not unmatched_joints._may_agree(chain, random_arm(seed + 1), TOL)


@pytest.mark.parametrize("front, back", [(3, 0), (0, 3), (2, 1), (1, 4)])
@pytest.mark.parametrize("swapped", [False, True])
def test_any_number_of_joints_more_at_the_ends_is_named(front, back, swapped):
    rng = np.random.default_rng(front)
    chain = random_arm(1, ("revolute",) * 5)
    rows = [screw.revolute(*rng.normal(size=(2, 3))) for _ in range(front + back)]
    first = [f"f{k}" for k in range(front)]
    last = [f"l{k}" for k in range(back)]
    longer = Chain.from_space(
        [*rows[:front], *chain.screws, *rows[front:]],
        chain.home,
        joint_names=[*first, *chain.joint_names, *last],
    )
    pair = (longer, chain) if swapped else (chain, longer)
    result = compare(*pair, samples=3)
    assert result.unmatched_joints == ("a" if swapped else "b", *first, *last)
    assert (result.outcome, result.differing) == ("differ", ())
    assert f"has {front + back} joints more" in result.findings[0]
    assert result.after is not None
    assert result.after.worst_position < 1e-9


def bolt(pitch=0.02, sign=1.0):
    """An arm of five joints of which the third is helical."""
    rng = np.random.default_rng(0)
    rows = [screw.revolute(z, 0.3 * p) for z, p in rng.normal(size=(5, 2, 3))]
    rows[2] = sign * screw.helical(rows[2][:3], np.cross(rows[2][:3], rows[2][3:]), pitch)
    return Chain.from_space(rows, se3.exp(rng.normal(size=6)))


def test_helical_joints_agree_under_any_convention():
    rng, chain = np.random.default_rng(5), bolt()
    moved = chain.rezeroed(rng.uniform(-1, 1, 5)).rebased(se3.exp(rng.normal(size=6)))
    result = compare(chain, moved.retooled(se3.exp(rng.normal(size=6))))
    assert result.same_arm, result.verdict
    assert result.after is not None
    assert result.after.worst_position < 2e-4
    flipped = compare(chain, bolt(sign=-1.0))
    assert (flipped.same_arm, [j.number for j in flipped.differing if j.reversed]) == (True, [3])


def test_a_zero_offset_of_a_helical_joint_is_named_and_sized():
    chain = bolt()
    result = compare(chain, chain.rezeroed([0, 0, 0.1, 0, 0]))
    (joint,) = result.differing
    assert (joint.number, joint.axis_differs, joint.unit) == (3, False, "rad")
    assert joint.zero_offset == pytest.approx(-0.1, rel=1e-3)


@pytest.mark.parametrize(
    "pitch, words",
    [
        (0.021, "has another pitch"),
        (-0.02, "has another pitch"),
        (0.0, "is helical in one model and revolute in the other"),
    ],
)
def test_another_pitch_is_named_and_nothing_else_is_blamed(pitch, words):
    result = compare(bolt(), bolt(pitch))
    assert (result.same_arm, [j.number for j in result.differing]) == (False, [3])
    assert "joint 3 ('joint3') " in result.verdict
    assert words in result.verdict


def test_a_pitch_that_shows_less_than_the_tolerance_after_a_turn_is_the_same():
    assert compare(bolt(), bolt(0.02 + 1e-6), tol_position=1e-5).same_arm
    assert not compare(bolt(), bolt(0.02 + 2e-6), tol_position=1e-5).same_arm


@pytest.mark.parametrize("seed", range(4))
def test_what_agrees_is_found_without_looking_for_what_differs(seed):
    rng = np.random.default_rng(seed)
    chain = random_arm(
        seed, ("revolute", "revolute", "prismatic", "revolute", "revolute")[: 3 + seed % 3]
    )
    other = chain.rezeroed(rng.normal(size=chain.dof)).rebased(se3.exp(rng.normal(size=6)))
    for two in (chain, chain.rebased(se3.exp(rng.normal(size=6))), other):
        found, _ = search(chain, two, TOL)
        reading = agreeing(chain, two, TOL)
        assert reading is not None
        assert not reading.moved.any()
        assert reading.cost[0] == found.cost[0]
    if chain.dof > 3:
        assert agreeing(chain, random_arm(seed + 9, chain.kinds), TOL) is None


def test_an_axis_three_tolerances_off_does_not_agree_though_the_poses_nearly_do():
    chain = random_arm(3)
    S = chain.screws.copy()
    across = np.cross(S[2, :3], S[0, :3])
    S[2, 3:] += np.cross(3e-5 * across / np.linalg.norm(across), S[2, :3])
    assert agreeing(chain, Chain.from_space(S, chain.home), TOL) is None


KINDS = [(a, k, b) for a in "rph" for k in "rph" for b in "rph"]


def arm_of(letters, seed=0):
    """An arm of these joints, r, p or h, that stand anyhow."""
    rng = np.random.default_rng(seed)
    make = {
        "r": screw.revolute,
        "h": lambda z, p: screw.helical(z, p, 0.05),
        "p": lambda z, p: screw.prismatic(z),
    }
    lines = rng.normal(size=(len(letters), 2, 3))
    rows = [make[letter](z, 0.4 * p) for letter, (z, p) in zip(letters, lines, strict=True)]
    return Chain.from_space(rows, np.eye(4))


def off(x, y):
    """How far two angles are apart."""
    return abs(np.angle(np.exp(1j * (x - y))))


def held_at(chain, short):
    """Where joint 2 of an arm can be held that another arm lacks (rad, m)."""
    return [x for (x,) in held_positions(chain, short, (2,), (2,), TOL)]


@pytest.mark.parametrize("kinds", KINDS, ids="".join)
@pytest.mark.parametrize("held", [0.4, -1.1, 2.5])
def test_the_position_at_which_a_joint_is_held_is_among_those_that_its_neighbours_tell(kinds, held):
    chain = arm_of(("r", *kinds, "p"))
    short = unmatched_joints.without(chain, (2,), [held])
    found = held_at(chain, short)
    if kinds[1] == "p" and "p" in (kinds[0], kinds[2]):
        assert 0.0 in found  # a slide beside a slide has no place that axes could tell
    else:
        assert min(off(x, held) if kinds[1] == "r" else abs(x - held) for x in found) < 1e-9


def test_a_joint_parallel_to_a_neighbour_is_held_where_the_moment_of_the_axes_beside_it_says():
    chain = arm_of("rrrr")
    rows = chain.screws.copy()
    way = rows[1, :3]
    rows[2] = screw.revolute(way, [0.3, -0.2, 0.1])
    chain = Chain.from_space(rows, np.eye(4))
    short = unmatched_joints.without(chain, (2,), [0.8])
    found = held_at(chain, short)
    assert min(off(x, 0.8) for x in found) < 1e-9
    # No position tells where neither angle nor moment changes: a joint on the line of its
    # neighbour.
    rows[2] = rows[1]
    assert held_at(Chain.from_space(rows, np.eye(4)), short) == []


def test_joints_at_the_ends_alone_are_held_at_zero_alone():
    chain = arm_of("rrrrrrr")

    def positions(ks, held):
        short = unmatched_joints.without(chain, ks, held)
        return list(unmatched_joints._positions(chain, short, ks, Tolerances(0.01, 0.001)))

    assert positions((0,), [0.5]) == positions((6,), [0.5]) == [(0.0,)]
    for held in (0.5, -0.5):
        one = positions((3,), [held])
        assert one[0] == (0.0,)
        assert min(off(x, held) for (x,) in one) < 1e-9
    for pair in ((2, 4), (2, 3), (1, 2)):
        both = positions(pair, [0.5, -0.3])
        assert both[0] == (0.0, 0.0)
        assert min(max(map(off, x, (0.5, -0.3))) for x in both) < 1e-9
        assert len(set(both)) == len(both)
    end = positions((0, 3), [0.7, 0.5])
    assert all(first == 0.0 for first, _ in end)
    assert min(off(x, 0.5) for _, x in end) < 1e-9
    # Where other neighbours do not agree, no position helps, and none but 0 is tried.
    other = arm_of("rrrrrr", seed=1)
    assert list(unmatched_joints._positions(chain, other, (3,), Tolerances(0.01, 0.001))) == [
        (0.0,)
    ]


def test_what_is_left_of_a_chain_without_joints_keeps_its_names_limits_and_poses():
    chain = Chain.from_space(arm_of("rphr").screws, se3.exp([0.1, 0.2, 0.3, 1, 2, 3]), joint_names=list("abcd"),
                  limits=[[-1, 1], [-2, 2], [-3, 3], [-4, 4]], base="floor", tip="hand")  # fmt: skip
    rest = unmatched_joints.without(chain, (1, 3), [0.3, -0.2])
    assert (rest.joint_names, rest.base, rest.tip) == (("a", "c"), "floor", "hand")
    assert rest.limits.tolist() == [[-1, 1], [-3, 3]]
    assert rest.pitches == pytest.approx([0, 0.05])
    assert rest.fk([0.4, 0.7]) == pytest.approx(chain.fk([0.4, 0.3, 0.7, -0.2]), abs=1e-14)


@pytest.mark.parametrize("change, agree", [
    ({"angle": 3.9e-3}, True), ({"angle": 4.1e-3}, False), ({"gap": 0.03}, True), ({"gap": 0.3}, False),
])  # fmt: skip
def test_the_quick_look_lets_four_tolerances_pass(change, agree):
    def crossing(angle, gap):
        slant = screw.revolute([0, np.sin(angle), np.cos(angle)], [1 + 1e-3 * gap, 0, 0])
        return Chain.from_space([screw.revolute([0, 0, 1], [0, 0, 0]), slant], np.eye(4))

    angle = 0.9 + np.radians(change.get("angle", 0))
    a, b = crossing(0.9, 0.0), crossing(angle, change.get("gap", 0))
    assert unmatched_joints._may_agree(a, b, TOL) == unmatched_joints._may_agree(b, a, TOL) == agree
    assert unmatched_joints._may_agree(a, b, TOL, but=(0,))
    assert not unmatched_joints._may_agree(
        a,
        Chain.from_space([a.screws[0], screw.prismatic([0, 0, 1])], np.eye(4)),
        TOL,
    )


def two(angle, gap, tip=1.0):
    """An axis along z and one at a gap (mm) along x, at an angle to it."""
    slant = screw.revolute([0, np.sin(angle), np.cos(angle)], [1e-3 * gap, 0, 0])
    return Chain.from_space(
        [screw.revolute([0, 0, 1], [0, 0, 0]), slant], se3.exp([0, 0, 0, tip, 0, 0])
    )


@pytest.mark.parametrize(
    "angle, certain", [(0.9, np.sin(0.9)), (0.101, np.sin(0.101)), (0.099, 0.0), (0.0, 1.0)]
)
@pytest.mark.parametrize("tip", [0.5, 3.0])
def test_the_quick_look_lets_lengths_pass_by_four_tolerances_and_what_angles_make_of_the_reach(
    angle, certain, tip
):
    tol = Tolerances(2e-5, np.radians(0.003))
    a = two(angle, 500.0)
    reach = max(a.reach, two(angle, 500.0, tip).reach)
    most = 4 * (tol.position + reach * tol.rotation)
    for share in (0.9996, 1.0004, -0.9996, -1.0004):
        b = two(angle, 500.0 + 1e3 * share * most / (certain or 1e-3), tip)
        assert unmatched_joints._may_agree(a, b, tol) == (certain == 0 or abs(share) < 1)


def test_the_quick_look_looks_at_neighbours_and_across_slides_alone():
    turning = [screw.revolute(z, p) for z, p in np.random.default_rng(2).normal(size=(4, 2, 3))]
    slide = screw.prismatic([1, 2, 3])

    def agree(rows, k, other, but=()):
        """Whether arms agree of which the second has another axis k."""
        changed = [*rows[:k], other, *rows[k + 1 :]]
        return unmatched_joints._may_agree(
            Chain.from_space(rows, np.eye(4)),
            Chain.from_space(changed, np.eye(4)),
            TOL,
            but,
        )

    assert not agree(turning, 3, screw.revolute([1, 2, 3], [1, 0, 0]))
    assert agree(turning, 3, screw.revolute([1, 2, 3], [1, 0, 0]), but=(2,))
    assert not agree(turning, 3, screw.revolute([1, 2, 3], [1, 0, 0]), but=(0, 1))
    # A turn about joint 2 changes how joint 3 lies to joint 1, and to nothing else.
    about = se3.adjoint(se3.exp(0.4 * turning[1]))
    assert agree(turning[:3], 2, about @ turning[2])
    # Across a slide directions stay, and places do not.
    rows = [turning[0], slide, turning[1]]
    assert agree(rows, 2, screw.revolute(turning[1][:3], [3, -2, 1]))
    about = se3.adjoint(se3.exp(np.concatenate([0.4 * slide[3:], np.zeros(3)])))
    assert not agree(rows, 2, about @ turning[1])
    # A helical joint turns what is behind it, as any that turns.
    bolt = [turning[0], screw.helical(turning[1][:3], [1, 2, 0], 0.1), turning[2]]
    assert agree(bolt, 2, se3.adjoint(se3.exp(0.4 * bolt[1])) @ turning[2])
    for but, agreed in (((0,), True), ((1,), True), ((2,), False)):
        assert agree(rows, 2, about @ turning[1], but) == agreed
    assert not unmatched_joints._may_agree(
        Chain.from_space(rows, np.eye(4)),
        Chain.from_space(turning[:3], np.eye(4)),
        TOL,
    )


@pytest.mark.parametrize("seed", range(3))
def test_seven_and_nine_parallel_joints_are_told_apart_without_a_search(monkeypatch, seed):
    """Of 36 pairs of joints each would cost a search of some tenths of a second."""
    searched = []
    monkeypatch.setattr(unmatched_joints, "agreeing", lambda *models: searched.append(models))
    rng = np.random.default_rng(seed)
    short, long = (
        Chain.from_space([screw.revolute([0, 0, 1], p) for p in rng.normal(size=(n, 3))], np.eye(4))
        for n in (7, 9)
    )
    assert unmatched_joints.droppable(short, long, TOL) is None
    assert searched == []
