"""Masses of links: a chain has what each of its joints moves, whatever its base and tip are."""

from __future__ import annotations

import pickle
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ModelError, ShapeError
from poekin.model.tree.link_masses import FARTHEST, HEAVIEST
from poekin.testing.strategies.robot_strategies import robots

TURN = pk.Joint("turn", "revolute", "base", "arm", axis=(0, 1, 0))
LIFT = pk.Joint("lift", "revolute", "arm", "hand", np.diag([1.0, 1, 1, 1]), axis=(0, 1, 0))
LINKS = ["base", "arm", "hand"]
MASSES = [
    pk.LinkMass("base", 50.0),
    pk.LinkMass("arm", 2.0, (0.5, 0, 0)),
    pk.LinkMass("hand", 1.0, (0, 0, 0.25)),
]
ROBOT = pk.Robot("r", LINKS, [TURN, LIFT], masses=MASSES)


def masses_of(chain: pk.Chain) -> np.ndarray:
    assert chain.masses is not None
    return chain.masses


def with_masses(robot, rng):
    masses = [
        pk.LinkMass(link, float(10 ** rng.uniform(-2, 1)), tuple(rng.normal(size=3).tolist()))
        for link in robot.links
        if rng.random() < 0.7
    ]
    return pk.Robot(robot.name, robot.links, robot.joints, masses=masses)


@given(robots(mimics=False), st.integers(0, 10**6))
def test_the_bodies_of_a_chain_are_where_the_links_are(robot, seed):
    rng = np.random.default_rng(seed)
    robot = with_masses(robot, rng)
    base, tip = rng.choice(robot.links, 2)
    chain = robot.chain(base, tip)
    if not robot.masses:
        assert chain.masses is None
        return
    q = rng.uniform(-1, 1, chain.dof)
    poses = robot.fk(dict.fromkeys(robot.q_names, 0.0) | dict(zip(chain.q_names, q, strict=True)))
    to_base = np.linalg.inv(poses[base])
    expected = np.zeros(3)
    fixed = np.zeros(3)
    at_zero = robot.fk(np.zeros(robot.dof))
    near = np.linalg.inv(at_zero[base])
    for own in robot.masses:
        p = to_base @ poses[own.link] @ [*own.centre, 1.0]
        expected += own.mass * p[:3]
        fixed += own.mass * (near @ at_zero[own.link] @ [*own.centre, 1.0])[:3]
    # what the base carries along stands still, and is in no row
    masses = masses_of(chain)
    moved = masses[:, :1] * masses[:, 1:]
    still = fixed - moved.sum(axis=0)
    found = still.copy()
    frames = zip(chain.screws, q, masses, strict=True)
    P = np.eye(4)
    for screw, x, (mass, *c) in frames:
        P = P @ pk.se3.exp(screw * x)
        found += mass * (P @ [*c, 1.0])[:3]
    size = sum(own.mass for own in robot.masses) * (chain.reach + 10.0)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13 * size)


def test_a_body_is_all_that_moves_with_a_joint():
    np.testing.assert_array_equal(ROBOT.chain().masses, [[2, 0.5, 0, 0], [1, 0, 0, 0.25]])
    np.testing.assert_array_equal(ROBOT.chain(tip="arm").masses, [[3, 1 / 3, 0, 0.25 / 3]])
    # from the hand: first the arm moves, then the base
    np.testing.assert_array_equal(masses_of(ROBOT.chain("hand", "base"))[:, 0], [2, 50])


def test_masses_go_with_the_base_and_the_zero_and_stay_with_another_tool():
    arm = ROBOT.chain()
    P = pk.se3.exp([0.3, -0.2, 0.5, 0.1, 0.4, -0.3])
    for row, moved in zip(masses_of(arm), masses_of(arm.rebased(P)), strict=True):
        np.testing.assert_allclose(moved, [row[0], *(P @ [*row[1:], 1])[:3]], atol=1e-15)
    turned = masses_of(arm.rezeroed([np.pi / 2, np.pi / 2]))
    np.testing.assert_allclose(turned, [[2, 0, 0, -0.5], [1, 0, 0, -0.25]], atol=1e-15)
    for same in (arm.retooled(P), arm.coupled("lift = lift + turn"), arm.replace(tip="t")):
        np.testing.assert_array_equal(same.masses, arm.masses)
    assert arm.replace(screws=arm.screws).masses is None
    assert arm.rebased(P).replace(masses=None).rebased(P).rezeroed([1.0, 0.0]).masses is None


def test_masses_are_kept_and_make_no_other_robot_or_chain():
    bare = pk.Robot("r", LINKS, [TURN, LIFT])
    assert bare == ROBOT
    assert hash(bare.chain()) == hash(ROBOT.chain())
    assert bare.chain() == ROBOT.chain()
    assert bare.chain().masses is None
    assert pickle.loads(pickle.dumps(ROBOT)).masses == tuple(MASSES)
    arm = pickle.loads(pickle.dumps(ROBOT.chain()))
    np.testing.assert_array_equal(arm.masses, ROBOT.chain().masses)
    assert not arm.masses.flags.writeable
    assert ROBOT.coupled("lift = lift + turn").masses == ROBOT.masses
    assert pk.relinked(ROBOT, ROBOT.chain()).masses == ROBOT.masses
    exact = ROBOT.chain().rebased(pk.se3.exp([1e-9, 0, 0, 0, 0, 0])).idealised(1e-6).chain
    np.testing.assert_allclose(masses_of(exact), masses_of(ROBOT.chain()), atol=1e-8)


REFUSED = [
    (
        pk.LinkMass("hand", 0.0),
        "robot 'r': link 'hand': expected a mass above 0 and below 10000 kg",
    ),
    (pk.LinkMass("hand", HEAVIEST), "got (10000.0, (0.0, 0.0, 0.0))"),
    (pk.LinkMass("hand", float("nan")), "got (nan, "),
    (pk.LinkMass("hand", 1.0, (2 * FARTHEST, 0, 0)), "and its centre within 100 m"),
    (pk.LinkMass("hand", 1.0, (0, 0)), "got (1.0, (0, 0))"),  # type: ignore[arg-type]
    (
        pk.LinkMass("foot", 1.0),
        "robot 'r': masses: expected a LinkMass of each link at most once, got LinkMass(link='foot'",
    ),
    (MASSES[1], "masses: expected a LinkMass of each link at most once"),
    (("hand", 1.0), "masses: expected a LinkMass of each link at most once, got ('hand', 1.0)"),
]


@pytest.mark.parametrize(("mass", "words"), REFUSED)
def test_what_is_no_mass_of_a_link_is_refused(mass, words):
    with pytest.raises(ModelError) as fault:
        pk.Robot("r", LINKS, [TURN, LIFT], masses=[MASSES[1], mass])
    assert words in str(fault.value)


def test_masses_of_a_chain_are_a_row_a_joint_and_not_negative():
    arm = ROBOT.chain()
    with pytest.raises(ShapeError, match=re.escape("masses: expected shape (2, 4)")):
        arm.replace(masses=np.ones((3, 4)))
    with pytest.raises(InputError, match=re.escape("masses: expected none below 0 kg, got -1")):
        arm.replace(masses=-np.ones((2, 4)))
