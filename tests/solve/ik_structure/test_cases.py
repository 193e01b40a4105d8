"""Cases of inverse kinematics, of arms whose axes meet or are parallel where each case says."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.model.chain import Chain
from poekin.solve.ik_structure.ik_structure import QUARTIC
from poekin.solve.ik_structure.neighbours import locked


def made(n: int, *relations: tuple[str, str], slides: tuple[int, ...] = ()) -> Chain:
    """Chain of n joints, of which those that are named, from 1, meet in a point or are parallel."""
    rng = np.random.default_rng(5)
    h = rng.normal(size=(n, 3))
    o = 0.4 * rng.normal(size=(n, 3))
    for what, joints in relations:
        first, *others = (int(joint) - 1 for joint in joints)
        {"meet": o, "parallel": h}[what][others] = {"meet": o, "parallel": h}[what][first]
    screws = [
        pk.screw.prismatic(w) if i + 1 in slides else pk.screw.revolute(w, p)
        for i, (w, p) in enumerate(zip(h, o, strict=True))
    ]
    return Chain.from_space(screws, np.eye(4))


WRIST = ("meet", "456")
SHOULDER = ("meet", "123")
FEW = "fewer than six joints"
SPHERICAL = ("spherical wrist", (4, 5, 6), False)
REVERSED = ("spherical shoulder", (1, 2, 3), True)
CASES = {
    "six axes": (made(6), ("general", (), False, "", 0)),
    "5 and 6 meet": (made(6, ("meet", "56")), ("two axes intersect", (5, 6), False, "", 0)),
    "1 and 2 meet": (made(6, ("meet", "12")), ("two axes intersect", (1, 2), True, "", 0)),
    "both": (
        made(6, ("meet", "12"), ("meet", "56")), ("two axes intersect", (5, 6), False, "", 0),
    ),
    "2 and 3 parallel": (made(6, ("parallel", "23")), ("two parallel axes", (2, 3), False, "", 0)),
    "4 and 5 parallel": (made(6, ("parallel", "45")), ("two parallel axes", (4, 5), False, "", 0)),
    "1 and 2 parallel": (made(6, ("parallel", "12")), ("general", (), False, "", 0)),
    "5 and 6 parallel": (made(6, ("parallel", "56")), ("general", (), False, "", 0)),
    "five axes": (made(5), ("general", (), False, "", 1)),
    "3 and 4 of five parallel": (
        made(5, ("parallel", "34")), ("two parallel axes", (3, 4), False, "", 1),
    ),
    "4 and 5 of five meet": (made(5, ("meet", "45")), (FEW, (4, 5), False, "", 1)),
    "1 and 2 of five meet": (made(5, ("meet", "12")), (FEW, (1, 2), True, "", 1)),
    "four axes": (made(4), (FEW, (4,), False, "", 2)),
    "four, the last slides": (made(4, slides=(4,)), (FEW, (1,), True, "", 2)),
    "three axes": (made(3), (FEW, (), False, "", 3)),
    "two axes": (made(2), (FEW, (), False, "", 4)),
    "wrist": (made(6, WRIST), (*SPHERICAL, QUARTIC, 0)),
    "wrist, 1 and 2 meet": (
        made(6, WRIST, ("meet", "12")), (*SPHERICAL, "axes 1 and 2 intersect", 0),
    ),
    "wrist, 2 and 3 meet": (
        made(6, WRIST, ("meet", "23")), (*SPHERICAL, "axes 2 and 3 intersect", 0),
    ),
    "wrist, 1 and 2 parallel, 2 and 3 meet": (
        made(6, WRIST, ("parallel", "12"), ("meet", "23")),
        (*SPHERICAL, "axes 1 and 2 are parallel", 0),
    ),
    "wrist, 2 and 3 parallel": (
        made(6, WRIST, ("parallel", "23")), (*SPHERICAL, "axes 2 and 3 are parallel", 0),
    ),
    "wrist, 3 slides": (made(6, WRIST, slides=(3,)), (*SPHERICAL, "prismatic", 0)),
    "shoulder": (made(6, SHOULDER), (*REVERSED, QUARTIC, 0)),
    "shoulder, 5 and 6 meet": (
        made(6, SHOULDER, ("meet", "56")), (*REVERSED, "axes 5 and 6 intersect", 0),
    ),
    "shoulder, 4 and 5 meet": (
        made(6, SHOULDER, ("meet", "45")), (*REVERSED, "axes 4 and 5 intersect", 0),
    ),
    "shoulder, 5 and 6 parallel, 4 and 5 meet": (
        made(6, SHOULDER, ("parallel", "56"), ("meet", "45")),
        (*REVERSED, "axes 5 and 6 are parallel", 0),
    ),
    "shoulder, 4 slides": (made(6, SHOULDER, slides=(4,)), (*REVERSED, "prismatic", 0)),
    "2, 3 and 4 meet": (made(6, ("meet", "234")), ("spherical joint", (2, 3, 4), True, "", 0)),
    "3, 4 and 5 meet": (made(6, ("meet", "345")), ("spherical joint", (3, 4, 5), False, "", 0)),
    "1, 2 and 3 parallel": (
        made(6, ("parallel", "123")), ("three parallel axes", (1, 2, 3), False, "", 0),
    ),
    "4, 5 and 6 parallel": (
        made(6, ("parallel", "456")), ("three parallel axes", (4, 5, 6), True, "", 0),
    ),
    "3, 4 and 5 of five meet": (
        made(5, ("meet", "345")), ("spherical wrist", (3, 4, 5), False, "", 1),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_each_arm_has_its_case(case):
    chain, expected = CASES[case]
    found = pk.ik_structure(chain)
    assert (
        found.kind, found.joints, found.reversed, found.first_joints, found.fictitious,
    ) == expected  # fmt: skip
    assert found.exact
    assert found.assumptions == ()
    slides = [kind == "prismatic" for kind in chain.kinds]
    assert found.prismatic == tuple(np.array(chain.joint_names)[slides])


@pytest.mark.parametrize("relations", [
    (("meet", "567"),),
    (("meet", "567"), ("meet", "23")),
    (("meet", "123"), ("parallel", "67")),
    (("meet", "345"),),
])  # fmt: skip
def test_a_locked_joint_leaves_the_case_of_the_six_others_with_their_numbers_in_the_whole_arm(
    relations,
):
    chain = made(7, *relations)
    found = pk.ik_structure(chain)
    assert (found.kind, found.method, len(found.locked)) == ("redundant", "lock", 7)
    for k, one in enumerate(found.locked):
        number = {str(i): str(i + (i > k)) for i in range(1, 7)}
        alone = pk.ik_structure(locked(chain, k, 0.3))
        assert one.joint == chain.joint_names[k]
        assert (one.kind, one.reversed, one.exact) == (alone.kind, alone.reversed, alone.exact)
        assert one.joints == tuple(int(number[str(i)]) for i in alone.joints)
        words = [number.get(word, word) for word in alone.first_joints.split(" ")]
        assert one.first_joints == " ".join(words)


def test_a_joint_that_leaves_no_quartic_is_locked_before_one_that_does_though_nearer_to_the_tip():
    # without joint 3 or 4 no neighbours of the others meet
    chain = made(7, ("meet", "567"), ("meet", "34"))
    found = pk.ik_structure(chain)
    assert [one.first_joints == QUARTIC for one in found.locked[:4]] == [False, False, True, True]
    assert found.hint == f"closed form with {chain.joint_names[1]!r} locked"
    assert found.exact


def test_seven_axes_without_relations_have_no_joint_to_lock_for_a_closed_form():
    found = pk.ik_structure(made(7))
    assert (found.kind, found.exact, found.hint) == ("redundant", False, "")
    assert {one.kind for one in found.locked} == {"general"}


def displaced(chain: Chain, k: int, twist: list[float]) -> Chain:
    """The chain with axis k, from 1, moved by a motion about and along base axes."""
    screws = chain.screws.copy()
    screws[k - 1] = pk.se3.adjoint(pk.se3.exp(twist)) @ screws[k - 1]
    return Chain.from_space(screws, chain.home)


def test_the_hint_is_at_the_three_axes_that_miss_by_least_of_all():
    near = displaced(made(6, WRIST), 6, [0, 0, 0, 0.08, -0.08, 0.08])
    large = near.screws * [1, 1, 1, 100, 100, 100]
    for screws in (near.screws, large):
        found = pk.ik_structure(Chain.from_space(screws, np.eye(4)))
        assert found.exact
        assert found.hint.startswith("closed form if axes 4, 5 and 6 met: they miss by")


@pytest.mark.parametrize(("degrees", "is_near"), [(1.9, True), (2.1, False)])
def test_axes_nearly_are_parallel_up_to_two_degrees(degrees, is_near):
    parallel = made(6, ("parallel", "234"))
    across = np.cross(parallel.screws[3, :3], parallel.screws[5, :3])
    tilt = np.radians(degrees) * across / np.linalg.norm(across)
    # the wrist's axes are far apart
    chain = displaced(displaced(parallel, 4, [*tilt, 0, 0, 0]), 6, [0, 0, 0, 0.7, -0.7, 0.7])
    found = pk.ik_structure(chain)
    assert found.exact != is_near
    assert found.hint == (
        f"closed form if axes 2, 3 and 4 were parallel: they are {degrees:g}° apart"
    )
    assert [(a.joints, a.distance) for a in found.assumptions] == [((2, 3, 4), 0.0)] * is_near


def test_axes_nearly_meet_up_to_a_hundredth_of_the_reach():
    chain = displaced(made(6, WRIST), 6, [0, 0, 0, 0.01, -0.01, 0.01])
    found = pk.ik_structure(chain)
    assert (found.kind, found.joints, found.exact) == ("spherical wrist", (4, 5, 6), False)
    (assumption,) = found.assumptions
    assert (assumption.joints, assumption.angle) == ((4, 5, 6), 0.0)
    assert 0 < assumption.distance < 0.01 * chain.reach


def test_exact_relations_come_before_near_ones():
    tilted = displaced(made(6, WRIST, ("parallel", "123")), 2, [0.01, 0.01, 0, 0, 0, 0])
    found = pk.ik_structure(tilted)
    assert (found.kind, found.joints, found.exact) == ("spherical wrist", (4, 5, 6), True)
    last = pk.screw.revolute([0.3, 0.5, 0.8], [2, 1, -1])
    seven = pk.ik_structure(Chain.from_space([*tilted.screws, last], np.eye(4)))
    assert (seven.locked[6].joints, seven.locked[6].exact) == ((4, 5, 6), True)
