"""A robot: its tree, its coordinates, its chains in either direction, the poses of its links."""

from __future__ import annotations

import functools
import itertools
import math
import pickle
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.linalg
from hypothesis import example, given
from hypothesis import strategies as st

from poekin.errors import InputError, UnknownName
from poekin.model.joint import FREE, Joint, Mimic
from poekin.model.robot import Robot
from poekin.testing.strategies import robot_strategies
from poekin.testing.strategies.group_strategies import frozen, poses

MOVING = ("revolute", "continuous", "prismatic", "helical")
ROOMY = poses(lengths=(1e-9, 2.0))


def robots(kinds=(*MOVING, "fixed"), max_joints=7):
    return robot_strategies.robots(kinds, 0, max_joints, limits=False, still=True)


def value(robot: Robot, joint: Joint, q: dict[str, Any]) -> Any:
    """The joint's value, by the definition of mimic; of many configurations where the coordinates
    are arrays.
    """
    if joint.kind == "fixed":
        return 0.0
    if joint.mimic is None:
        return q[joint.name]
    return (
        joint.mimic.multiplier * value(robot, robot.joint(joint.mimic.joint), q)
        + joint.mimic.offset
    )


def naive_poses(
    robot: Robot, q: dict[str, Any], free: dict[str, np.ndarray] | None = None
) -> dict[str, np.ndarray]:
    """Poses of all links by walking down the tree with SciPy's matrix exponential; leading axes are
    those of q.
    """
    result = {robot.root: np.eye(4)}
    todo = [robot.root]
    while todo:
        link = todo.pop()
        for joint in robot.joints:
            if joint.parent != link:
                continue
            if joint.kind in FREE:
                moved = (free or {}).get(joint.name, np.eye(4))
            else:
                w, v, x = joint.screw[:3], joint.screw[3:], value(robot, joint, q)
                X = np.array(
                    [
                        [0, -w[2], w[1], v[0]],
                        [w[2], 0, -w[0], v[1]],
                        [-w[1], w[0], 0, v[2]],
                        [0, 0, 0, 0],
                    ]
                )
                moved = scipy.linalg.expm(X * np.asarray(x)[..., None, None])
            result[joint.child] = result[link] @ joint.origin @ moved
            todo.append(joint.child)
    return result


def random_q(robot: Robot, seed: int, rows: int | None = None) -> dict[str, Any]:
    """Values of all coordinates, or so many of each."""
    q = np.random.default_rng(seed).uniform(-3, 3, robot.dof if rows is None else (rows, robot.dof))
    return dict(zip(robot.q_names, q.T, strict=True))


def inverse(T: np.ndarray) -> np.ndarray:
    return np.linalg.inv(T)


def size(robot: Robot) -> float:
    """A length that bounds the robot: what errors of positions are measured by."""
    return 1 + sum(np.abs(joint.origin[:3, 3]).sum() + 10 for joint in robot.joints)


def rounding(robot: Robot, q: dict[str, Any]) -> Any:
    """What two ways of computing poses of a robot may differ by, lengths ÷ `size`; u = 2^-53, X the
    sum of all |x|.

    Each joint's e^{S x} by SciPy is off by 8 u (1 + |x|), as its scaling by powers of 2 squares |S
    x| times; a product of two poses by 8 u; a chain's own pose by u (8 (n + 1) + 4 X). A value
    composed of multipliers and offsets is off by u times the sum of their absolute values, counted
    in X, for each of n mimics in a row. To see one link from another takes an inverse, and both of
    their poses: twice.
    """

    def most(joint: Joint) -> Any:
        """The value, had all its parts one sign."""
        if joint.kind in ("fixed", *FREE):
            return 0.0
        if joint.mimic is None:
            return abs(q[joint.name])
        return abs(joint.mimic.multiplier) * most(robot.joint(joint.mimic.joint)) + abs(
            joint.mimic.offset
        )

    n, X = len(robot.joints), sum(map(most, robot.joints))
    slides = sum(most(joint) for joint in robot.joints if joint.kind in ("prismatic", "helical"))
    return 2 * 2.0**-53 * (24 * (n + 1) + (12 + n) * X) * (1 + slides / size(robot))


def link_errors(robot: Robot, subject: Robot, seed: int, rows: int = 1) -> np.ndarray:
    """How far the subject's link poses are from those that the definition gives for the robot, ÷
    `rounding` (rows,).
    """
    q = random_q(robot, seed, rows)
    expected, found = (
        naive_poses(robot, q),
        subject.fk({name: q.get(name, 0.0) for name in subject.q_names}),
    )
    return _worst(robot, q, ((found[link], expected[link]) for link in robot.links))


def chain_errors(robot: Robot, subject: Robot, seed: int, rows: int = 1) -> np.ndarray:
    """The same for the chains between every two links, seen from one and from the other."""
    q = random_q(robot, seed, rows)
    expected = naive_poses(robot, q)

    def pairs():
        for base, tip in itertools.product(robot.links, repeat=2):
            chain = subject.chain(base, tip)
            T = chain.fk({name: q.get(name, 0.0) for name in chain.q_names})
            yield T, inverse(expected[base]) @ expected[tip]

    return _worst(robot, q, pairs())


def _worst(
    robot: Robot, q: dict[str, Any], pairs: Iterable[tuple[np.ndarray, np.ndarray]]
) -> np.ndarray:
    """The largest difference of poses in each configuration, ÷ `rounding`."""
    worst = functools.reduce(np.maximum, (np.abs(a - b).max(axis=(-2, -1)) for a, b in pairs))
    return np.atleast_1d(worst / size(robot) / rounding(robot, q))


seeds = st.integers(0, 2**32 - 1)


@given(robot=robots(), seed=seeds)
def test_link_poses_are_those_of_the_definition(robot, seed):
    assert link_errors(robot, robot, seed).max() <= 1


@given(robot=robots(max_joints=5), seed=seeds)
def test_a_chain_runs_between_any_two_links_in_either_direction(robot, seed):
    assert chain_errors(robot, robot, seed).max() <= 1


def two_arms() -> Robot:
    """A robot with every kind of moving joint, a fork and mimics: what the planted errors are
    planted in.
    """
    turn = Joint(
        "t", "fixed", "a", "b", scipy.linalg.expm(_generator([0.3, 0.2, 0.5, 0.1, 0.2, 0.3]))
    ).origin
    return Robot(
        "two arms",
        ["a", "b", "c", "d", "e"],
        [
            Joint("p", "prismatic", "b", "c", turn, (0, 1, 0), mimic=Mimic("r", 0.5, 0.25)),
            Joint("r", "revolute", "a", "b", turn, (1, 2, 3)),
            Joint("h", "helical", "b", "d", turn @ turn, (0, 0, 1), pitch=0.2),
            Joint("m", "revolute", "d", "e", turn, (1, 0, 0), mimic=Mimic("p", -2.0, 0.125)),
        ],
    )


def _generator(xi):
    w, v = xi[:3], xi[3:]
    return np.array(
        [[0, -w[2], w[1], v[0]], [w[2], 0, -w[0], v[1]], [-w[1], w[0], 0, v[2]], [0, 0, 0, 0]]
    )


def planted(name: str, change: Callable[[Joint], Joint]) -> Robot:
    robot = two_arms()
    return Robot(
        robot.name, robot.links, [change(j) if j.name == name else j for j in robot.joints]
    )


PLANTED = {
    "axis reversed": planted("r", lambda j: replace(j, axis=tuple(-a for a in j.axis))),
    "origin inverted": planted("h", lambda j: replace(j, origin=inverse(j.origin))),
    "pitch dropped": planted("h", lambda j: replace(j, kind="revolute", pitch=0.0)),
    "slide taken for a turn": planted("p", lambda j: replace(j, kind="revolute")),
    "mimic ignored": planted("p", lambda j: replace(j, mimic=None)),
    "multiplier dropped": planted("p", lambda j: replace(j, mimic=Mimic("r", 1.0, 0.25))),
    "offset dropped": planted("p", lambda j: replace(j, mimic=Mimic("r", 0.5))),
    "mimic of mimic not composed": planted(
        "m", lambda j: replace(j, mimic=Mimic("r", -2.0, 0.125))
    ),
    "a millionth of a turn": planted("r", lambda j: replace(j, axis=(1, 2, 3.00001))),
}


@pytest.mark.parametrize("wrong", PLANTED.values(), ids=PLANTED)
@pytest.mark.parametrize("law", [link_errors, chain_errors])
def test_planted_errors_are_found(law, wrong):
    assert law(two_arms(), two_arms(), 1).max() <= 1
    assert law(two_arms(), wrong, 1).max() > 1e4


@given(robot=robots(max_joints=5), data=st.data())
def test_the_order_of_joints_and_links_changes_only_the_order_of_coordinates(robot, data):
    other = Robot(
        "r", data.draw(st.permutations(robot.links)), data.draw(st.permutations(robot.joints))
    )
    assert set(other.q_names) == set(robot.q_names)
    q = random_q(robot, 0)
    mine, theirs = robot.fk(q), other.fk(q)
    for link in robot.links:
        assert (mine[link] == theirs[link]).all()


@given(robot=robots(kinds=(*MOVING, "fixed", *FREE), max_joints=5), T=ROOMY, seed=seeds)
def test_floating_and_planar_joints_are_where_poses_says_and_at_identity_otherwise(robot, T, seed):
    q = random_q(robot, seed)
    free = [joint.name for joint in robot.joints if joint.kind in FREE]
    for given_poses in ({}, dict.fromkeys(free, T), dict.fromkeys(free[:1], T)):
        expected, found = naive_poses(robot, q, given_poses), robot.fk(q, given_poses)
        for link in robot.links:
            # one more product a free joint, of poses of up to 2 m
            within = (size(robot) + 2 * len(free)) * (
                rounding(robot, q) + 16 * 2.0**-53 * len(free)
            )
            assert np.abs(found[link] - expected[link]).max() <= within


def test_a_batch_of_configurations_meets_a_batch_of_poses():
    robot = Robot(
        "r",
        ["a", "b", "c"],
        [Joint("f", "floating", "a", "b"), Joint("j", "revolute", "b", "c", axis=(0, 0, 1))],
    )
    T = np.tile(np.eye(4), (5, 1, 1, 1))
    T[:, 0, 0, 3] = np.arange(5)
    found = robot.fk({"j": np.arange(3.0)}, {"f": T})
    assert found["c"].shape == (5, 3, 4, 4)
    assert (found["c"][..., 0, 3] == np.arange(5)[:, None]).all()
    assert np.allclose(found["c"][..., 1, 0], np.sin(np.arange(3)), rtol=0, atol=1e-15)
    assert found["a"].shape == (5, 3, 4, 4)


@pytest.mark.parametrize("batch", [(), (0,), (1,), (3, 1, 2)])
def test_every_batch_shape_works_and_equals_its_elements(batch):
    robot = two_arms()
    q = frozen(np.random.default_rng(0).uniform(-1, 1, (*batch, robot.dof)))
    found = robot.fk(q)
    assert list(found) == list(robot.links)
    for link, T in found.items():
        assert T.shape == (*batch, 4, 4)
        for index in np.ndindex(*batch):
            assert (T[index] == robot.fk(q[index])[link]).all()


def test_nan_in_one_configuration_stays_in_that_configuration():
    robot = two_arms()
    q = np.zeros((3, robot.dof))
    q[1] = math.nan
    found = robot.fk(q)
    assert np.isnan(found["e"][1]).any()
    assert np.isfinite(found["e"][[0, 2]]).all()


@given(robot=robots(max_joints=4))
@example(Robot("stone", ["only"], []))
def test_copies_are_equal_and_read_only(robot):
    copy = pickle.loads(pickle.dumps(robot))
    assert copy == robot
    assert hash(copy) == hash(robot)
    assert copy.q_names == robot.q_names
    assert not copy.limits.flags.writeable
    assert robot == Robot(robot.name, list(robot.links), list(robot.joints), "elsewhere")
    assert robot != Robot("other", robot.links, robot.joints)
    with pytest.raises(AttributeError):
        robot.name = "x"
    for base, tip in itertools.product(robot.links[:2], repeat=2):
        assert copy.chain(base, tip) == robot.chain(base, tip)


def test_a_copy_says_where_the_robot_was_read_from():
    copy = pickle.loads(pickle.dumps(Robot("stone", ["only"], [], "arm.urdf")))
    with pytest.raises(UnknownName, match=r"^arm\.urdf: no joint 'j'"):
        copy.joint("j")


def test_a_robot_of_one_link_has_one_chain_without_joints():
    robot = Robot("stone", ["only"], [])
    assert (robot.root, robot.leaves, robot.dof, robot.limits.shape) == (
        "only",
        ("only",),
        0,
        (0, 2),
    )
    chain = robot.chain()
    assert (chain.base, chain.tip, chain.dof) == ("only", "only", 0)
    assert (chain.fk([]) == np.eye(4)).all()
    assert (robot.fk([])["only"] == np.eye(4)).all()
    assert robot.fk(np.empty((2, 0)))["only"].shape == (2, 4, 4)


def test_a_repr_is_one_harmless_line():
    assert (
        repr(two_arms())
        == "Robot('two arms': 5 links, 4 joints, dof 2, root 'a', 2 leaves: 'c', 'e')"
    )
    assert repr(Robot("\x1b[31m", ["a\nb"], [])).isprintable()


def test_a_tip_must_be_named_where_there_are_several_leaves():
    with pytest.raises(InputError, match="tip must be given, there are several leaves: 'c', 'e'"):
        two_arms().chain()


def test_a_far_revolute_joint_does_not_look_helical():
    origin = np.eye(4)
    origin[:3, 3] = [1e8, -3e7, 2e7]
    joints = [
        Joint("far", "fixed", "a", "b", origin),
        Joint("j", "revolute", "b", "c", axis=(0.3, -0.4, 0.5)),
    ]
    assert Robot("r", ["a", "b", "c"], joints).chain().kinds == ("revolute",)
