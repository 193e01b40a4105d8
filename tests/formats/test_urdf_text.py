"""URDF out: the same robot comes back, and Pinocchio sees the same kinematics in it."""

from __future__ import annotations

import functools
import math
import re
import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from benchmarks.urdf_errors import SAMPLES, pinocchio_errors, values_of
from poekin.analysis.validate import routes
from poekin.errors import PoekinWarning
from poekin.formats import urdf
from poekin.formats.erd import example_robots
from poekin.formats.load import load
from poekin.formats.serial import serial_robot
from poekin.formats.urdf_text import has_text, own_urdf, to_urdf
from poekin.model.chain import Chain
from poekin.model.joint import FREE, MOVING, Joint, SafetyController
from poekin.model.robot import Robot
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle, pinocchio
from poekin.testing.strategies.chain_strategies import chains
from tests.model.laws.chain_bounds import budget
from tests.model.test_robot import random_q, robots, seeds, size
from tests.model.test_robot import rounding as poses_rounding

INF = math.inf


def quietly(make: Callable, *args, **options):
    """What `make` makes, whatever it warns of."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        return make(*args, **options)


DRIVE = ("velocity", "effort", "damping", "friction", "safety_controller")


def again(model: Robot | Chain) -> Robot:
    """The robot that is read from the model's text."""
    return quietly(urdf.read_text, quietly(to_urdf, model))


def differences(robot: Robot, other: Robot) -> list[str]:
    """What a URDF says of a robot that is not the same of the other, to the last digit but for
    rotations.
    """
    found = [
        what
        for what in ("name", "links", "q_names", "root", "leaves")
        if getattr(robot, what) != getattr(other, what)
    ] + ([] if np.array_equal(robot.limits, other.limits) else ["limits"])
    for a, b in zip(robot.joints, other.joints, strict=True):
        kind = "continuous" if a.kind == "revolute" and a.limits == (-INF, INF) else a.kind
        wanted = (a.name, kind, a.parent, a.child, a.mimic, a.origin[:3, 3].tolist())
        got = (b.name, b.kind, b.parent, b.child, b.mimic, b.origin[:3, 3].tolist())
        same = all(getattr(a, field) == getattr(b, field) for field in DRIVE)
        same &= wanted == got and np.abs(a.origin - b.origin).max() <= 1.5e-15
        same &= kind in ("fixed", "floating") or a.axis == b.axis
        same &= kind not in ("revolute", "prismatic") or a.limits == b.limits
        found += [] if same else [f"joint {a.name}"]
    return found


def text_off(robot: Robot, other: Robot, seed: int, rows: int = 1) -> np.ndarray:
    """How far the poses of links of the same name are apart ÷ what they may be, at so many
    configurations.

    The text turns the frame of each of n joints by up to 1e-15 an entry, 27 u in Frobenius' norm,
    and all that is behind it; the poses themselves are computed twice.
    """
    q = random_q(robot, seed, rows)
    mine, theirs = robot.fk(q), other.fk({name: q.get(name, 0.0) for name in other.q_names})
    within = poses_rounding(robot, q) + 27 * UNIT * len(robot.joints)
    worst = functools.reduce(
        np.maximum, (np.abs(mine[link] - theirs[link]).max(axis=(-2, -1)) for link in robot.links)
    )
    return np.atleast_1d(worst / size(robot) / within)


@st.composite
def drives(draw) -> dict[str, Any]:
    """What a joint may say of its drive, each with or without a number."""
    loss = st.floats(0, 1e6)
    bound = st.floats(1e-6, 9999)
    number = st.floats(-1e6, 1e6)
    return {
        "velocity": draw(bound | st.just(INF)),
        "effort": draw(bound | st.just(INF)),
        "damping": draw(loss),
        "friction": draw(loss),
        "safety_controller": draw(st.none() | st.builds(SafetyController, *[number] * 4)),
    }


@st.composite
def limited(draw, **options) -> Robot:
    """A robot as in the tests of robots, without pitch, with limits of all sorts."""
    robot = draw(robots(("revolute", "continuous", "prismatic", "fixed", *FREE), **options))
    bound = st.floats(-9999, 9999)
    ends = st.one_of(
        st.just((-INF, INF)), bound.map(lambda b: (b, INF)), bound.map(lambda b: (-INF, b)),
        st.tuples(bound, bound).map(sorted).filter(lambda pair: pair[0] < pair[1]),
    )  # fmt: skip
    joints = [replace(j, limits=draw(ends), **draw(drives())) for j in robot.joints]
    return quietly(Robot, robot.name, robot.links, joints)


@st.composite
def scaled_chains(draw) -> Chain:
    """Chains whose coordinates have any scale, some of them without a joint; no helical joints."""
    chain = draw(chains(joint_kinds=("revolute", "prismatic")))
    scale = [draw(st.sampled_from([1.0, -1.0, 0.5, -3.0, 0.0])) for _ in range(chain.dof)]
    low = [draw(st.floats(-9, 9)) for _ in range(chain.dof)]
    limits = [
        (-INF, INF) if draw(st.booleans()) else (a, a + draw(st.floats(1e-3, 9))) for a in low
    ]
    C = chain.coupling * (np.array(scale) if draw(st.booleans()) else 1.0)
    names = [f"q{k}" for k in range(chain.dof)]
    limits = np.reshape(limits, (chain.dof, 2))
    return Chain.from_space(
        chain.screws, chain.home, q_names=names, limits=limits, coupling=C, offset=chain.offset
    )


def pull() -> Chain:
    """Twelve turning joints in one another's line that all follow one coordinate, three times as
    fast.
    """
    place = [[0, 0, 1, 3 * np.sin(k), -3 * np.cos(k), 0] for k in range(12)]
    ratios = [3.0, -6.0, 1.5] * 4
    return Chain.from_space(
        place, np.eye(4), coupling=np.reshape(ratios, (12, 1)), offset=np.linspace(-1, 1, 12)
    )


@given(robot=limited(), seed=seeds)
def test_a_robot_comes_back_from_its_text(robot, seed):
    back = again(robot)
    assert differences(robot, back) == []
    assert text_off(robot, back, seed).max() <= 1


def rounding(chain: Chain, seed: int, samples: int = SAMPLES) -> np.ndarray:
    """What `pinocchio_errors` may come to by rounding alone; u = 2^-53, n joints, X = sum |C| |q| +
    |c|.

    A pose is off by u (8 (n + 1) + 4 X) by poekin and, as much again, by Pinocchio. The text turns
    each frame by up to 1e-15 an entry, 27 u in Frobenius' norm, and each reader does so again, as
    it takes sines of its angles.
    A follower's multiplier m and offset o, of |m| <= 4 and |o| <= 5 here, and m y + o are rounded:
    24 u a joint.
    A column is the sum of its joints' columns, each an axis and its moment: twice what a pose is
    off by, times the sum of the ratios. Lengths grow with what joints slide.
    """
    q = np.random.default_rng(seed).uniform(-3, 3, (samples, chain.dof))
    X, n = np.abs(q) @ np.abs(chain.coupling).T + np.abs(chain.offset), len(chain.screws)
    far = 1 + X @ np.abs(chain.local.slides) / chain.reach
    driven = max(1.0, np.abs(chain.coupling).sum(axis=0).max(initial=0))
    return UNIT * (94 * (n + 1) + 8 * X.sum(axis=1)) * far * 2 * driven


def pinocchio_off(chain: Chain, seed: int, samples: int = SAMPLES) -> np.ndarray:
    """How far Pinocchio's poses and Jacobians of a chain's text are from the chain's ÷ `rounding`."""
    return pinocchio_errors(chain, quietly(to_urdf, chain), seed, samples) / rounding(
        chain, seed, samples
    )


@given(chain=scaled_chains(), seed=seeds)
@example(pull(), 0)
def test_pinocchio_sees_a_chain_in_its_text(chain, seed):
    assert pinocchio_off(chain, seed).max() <= 1


@given(chain=chains(joint_kinds=("revolute", "prismatic"), offsets=False))
def test_a_chain_comes_back_from_its_text_to_the_last_digit_of_all_but_its_frames(chain):
    limits = np.random.default_rng(0).uniform(-1, 0, (chain.dof, 2)).cumsum(1)[:, ::-1]
    masters = [v[0] for v in values_of(chain) if v]
    limited = Chain.from_space(
        chain.screws, chain.home, limits=limits, coupling=chain.coupling, q_names=masters
    )
    back = again(limited).chain(tip="tool")
    still = [
        name
        for name, row in zip(limited.joint_names, limited.coupling, strict=True)
        if not row.any()
    ]
    rows = [i for i, name in enumerate(limited.joint_names) if name not in still]
    order = [limited.q_names.index(name) for name in back.q_names]
    assert back.joint_names == tuple(limited.joint_names[i] for i in rows)
    assert sorted(back.q_names) == sorted(limited.q_names)
    assert np.array_equal(back.coupling, limited.coupling[rows][:, order])
    assert np.array_equal(back.limits, limited.limits[order])
    # both chains' budgets, and for each frame the text's turn, the reader's sines and two products:
    # 70 u
    for q in limited.random(0, 3):
        own = 70 * UNIT * (len(limited.screws) + 1)
        far = limited.reach + np.abs(limited.local.slides * (limited.coupling @ q)).sum()
        angular, linear = np.add(budget(limited, q), budget(back, q[order]))
        off = np.abs(back.fk(q[order]) - limited.fk(q))
        assert off[:3, :3].max() <= angular + own
        assert off[:3, 3].max() <= linear + own * far


ROBOTS = tuple(example_robots()[0])


@pytest.mark.parametrize("name", ROBOTS)
def test_every_example_robot_comes_back_and_pinocchio_sees_each_of_its_chains(name):
    robot = quietly(load, f"erd:{name}")
    text = to_urdf(robot)
    back = quietly(urdf.read_text, text)
    assert differences(robot, back) == []
    q = random_q(robot, 1)
    mine, theirs, peers = robot.fk(q), back.fk(q), PinocchioOracle(text).link_poses(q)
    chains = [robot.chain(base, tip) for base, tip, _ in routes(robot)]
    reach = max(chain.reach for chain in chains)
    for link, T in mine.items():
        assert np.abs(T - theirs[link]).max() <= 1e-14 * reach
        assert np.abs(T - peers[link][0]).max() <= 1e-13 * reach
    for seed, chain in enumerate(chains):
        assert back.chain(chain.base, chain.tip).velocity_limits.tolist() == list(
            chain.velocity_limits
        )
        assert (pinocchio_errors(chain, to_urdf(chain), seed) <= rounding(chain, seed)).all()


def numbers_in_pinocchio(text: str, joint: Joint) -> dict[str, float]:
    """What Pinocchio reads of a joint's drive."""
    model = pinocchio().buildModelFromXML(text)
    k = model.joints[model.getJointId(joint.name)].idx_v
    return {
        "velocity": model.velocityLimit[k],
        "effort": model.effortLimit[k],
        "damping": model.damping[k],
        "friction": model.friction[k],
    }


@given(robot=limited())
def test_pinocchio_reads_the_drives_that_are_written(robot):
    text = quietly(to_urdf, robot)
    for joint in robot.joints:
        if joint.kind not in MOVING:
            continue
        for field, found in numbers_in_pinocchio(text, joint).items():
            wanted = getattr(joint, field)
            assert found == wanted or (wanted == INF and found == 0)


# Neighbours are variants of one robot; all of them come back, above.
@pytest.mark.parametrize("name", ROBOTS[::2])
def test_pinocchio_reads_the_drives_of_an_example_as_in_its_own_file(name):
    robot = quietly(load, f"erd:{name}")
    text = to_urdf(robot)
    assert 'effort="1e+16"' not in text
    path = example_robots()[0][name]
    own = pinocchio().buildModelFromUrdf(path)
    written = pinocchio().buildModelFromXML(text)
    for joint in robot.joints:
        if joint.kind not in MOVING:
            continue
        k, i = (m.joints[m.getJointId(joint.name)].idx_v for m in (own, written))
        assert own.damping[k] == written.damping[i]
        assert own.friction[k] == written.friction[i]
        if math.isfinite(joint.velocity):
            assert own.velocityLimit[k] == written.velocityLimit[i] == joint.velocity
        if math.isfinite(joint.effort):
            assert own.effortLimit[k] == written.effortLimit[i] == joint.effort


def limb() -> Chain:
    """A chain with all that the planted errors are planted in: no axis along another, a follower, a
    flip, an offset.
    """
    rng = np.random.default_rng(3)
    w = rng.normal(size=(5, 3))
    w /= np.linalg.norm(w, axis=1)[:, None]
    A = np.hstack([w, np.cross(rng.normal(size=(5, 3)), w)])
    A[2] = [0, 0, 0, *w[2]]
    C = np.array([[-1.0, 0, 0], [0, 1, 0], [0, -0.5, 0], [0, 0, 1], [0, 0, 1]])
    home = urdf.rpy.pose((0.1, 0.2, 0.3), (0.4, 0.5, 0.6))
    return Chain.from_space(
        A, home, coupling=C, offset=[0.25, 0, 0.125, 0, 0.5], q_names=["j1", "j2", "j4"]
    )


def sub(pattern: str, new: str | Callable, text: str) -> str:
    changed = re.sub(pattern, new, text)
    assert changed != text
    return changed


PLANTED = {
    "axis sign lost": lambda t: sub('<axis xyz="0 0 -1"', '<axis xyz="0 0 1"', t),
    "mimic offset lost": lambda t: sub(' offset="[^"]*"', "", t),
    "multiplier lost": lambda t: sub(' multiplier="[^"]*"', "", t),
    "mimic lost": lambda t: sub("<mimic .*", "", t),
    "rpy swapped": lambda t: sub(r'rpy="(\S+) (\S+) (\S+)"', r'rpy="\3 \2 \1"', t),
    "rpy lost": lambda t: sub('rpy="[^"]*"', "", t),
    "tool lost": lambda t: sub(r'(?s)("tool_joint".*?xyz)="[^"]*"', r'\1="0 0 0"', t),
    "a slide turned": lambda t: sub('type="prismatic"', 'type="revolute"', t),
    "nine digits": lambda t: sub(
        r"(?<!version=.)-?\d+\.\d+", lambda number: f"{float(number[0]):.9g}", t
    ),
}


@pytest.mark.parametrize("plant", PLANTED.values(), ids=PLANTED)
def test_planted_errors_are_found_by_pinocchio(plant):
    text = to_urdf(limb())
    assert (pinocchio_errors(limb(), text, 0) <= rounding(limb(), 0)).all()
    assert rounding(limb(), 0).max() < 1e-12
    assert pinocchio_errors(limb(), plant(text), 0).max() > 1e-10


@pytest.mark.parametrize("plant", PLANTED.values(), ids=PLANTED)
def test_planted_errors_are_found_by_reading_back(plant):
    robot = serial_robot(limb())
    text = to_urdf(robot)
    right, wrong = (quietly(urdf.read_text, t) for t in (text, plant(text)))
    assert text_off(robot, right, 0).max() <= 1
    assert text_off(robot, wrong, 0).max() > 10
    assert differences(robot, right) == []
    assert differences(robot, wrong)


@pytest.mark.parametrize("source", [None, "elsewhere.xml"])
def test_a_robot_that_was_read_from_no_urdf_is_written_as_a_new_one(source):
    robot = Robot("r", ["a"], [], source)
    assert not has_text(robot)
    assert own_urdf(robot) == to_urdf(robot).encode()
    text = "<robot name='r'><link name='a'/></robot>"
    read = urdf.read_text(text, "r")
    assert has_text(read)
    assert own_urdf(read) == text.encode()
