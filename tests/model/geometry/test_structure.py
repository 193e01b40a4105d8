"""A chain taken apart has the chain's kinematics, and its right angles, parallel and intersecting
axes cost nothing.
"""

from __future__ import annotations

import math
from decimal import Decimal
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

import poekin as pk
from poekin.engine.straight_line import interpret
from poekin.engine.straight_line.trace import FOLD_TOLERANCE
from poekin.model.geometry.structure import _angle, _in_local, structure
from tests.model.kinematics.test_compiled import LONGER, near
from tests.model.laws.chain_cases import chain_cases

FEW = settings(max_examples=max(settings().max_examples // 5, 20))
HOME = pk.se3.exp([0.3, -0.7, 0.5, 0.4, 0.1, 0.6])
UP, P = np.array([0.0, 0.0, 1.0]), np.array([0.3, -0.2, 0.4])


def turn(axis, offset=(0, 0, 0)):
    """A revolute axis through P and an offset from it."""
    axis = np.array(axis, float)
    return pk.screw.revolute(axis / np.linalg.norm(axis), P + np.array(offset, float))


def slide(axis):
    axis = np.array(axis, float)
    return np.concatenate([np.zeros(3), axis / np.linalg.norm(axis)])


SECOND = {
    "parallel": turn(UP, [0.5, 0.1, 0.2]),
    "opposite": turn(-UP, [0.5, 0.1, 0.2]),
    "one line": turn(UP, [0, 0, 0.3]),
    "one line, opposite": turn(-UP),
    "right angle, meeting": turn([1, 2, 0], [0, 0, 0.3]),
    "right angle, apart": turn([1, 0, 0], [0.2, 0.3, 0.4]),
    "oblique": turn([1, 0.5, 0.8], [0.2, 0.3, 0.4]),
    "oblique, opposite": turn([0.3, 0.2, -1], [0.2, 0.3, 0.4]),
    "slanted": turn([0.04, 0.03, 1], [0.2, 0.3, 0.4]),
    "slanted, opposite": turn([0.04, 0.03, -1], [0.2, 0.3, 0.4]),
    "sliding along": slide(UP),
    "sliding across": slide([1, 1, 0]),
    "sliding obliquely": slide([1, 1, -1]),
    "helical": turn([1, 0.5, 0.8], [0.2, 0.3, 0.4]) + 0.1 * slide([1, 0.5, 0.8]),
}
LAST = turn([0.2, -1, 0.4], [0.2, 0.8, 0.3])
CHAINS = {
    **{name: pk.Chain.from_space([turn(UP), second, LAST], HOME) for name, second in SECOND.items()},
    **{
        f"{name}, after a slide": pk.Chain.from_space([slide([0.2, 0.1, 1]), second], HOME)
        for name, second in SECOND.items()
    },
    "coupled": pk.Chain.from_space(
        np.array([turn(UP), SECOND["oblique"], LAST]), HOME, coupling=[[1, 0], [-0.5, 2], [0, 1]],
        offset=[0.1, math.pi / 2, -0.3],
    ),
    "no joint": pk.Chain.from_space(np.empty((0, 6)), HOME),
    **{name: pk.load(name).chain(tip={"panda": "panda_hand"}.get(name)) for name in ("panda", "puma560", "stanford")},
}  # fmt: skip


def check(chain, q, times=1.0):
    """The chain's poses and Jacobians, from the program that its structure makes, without machine
    code.
    """
    fast = chain.compile()
    frames = ["space", "body", "hybrid", *([0, "cheapest"] if chain.kinds else [])]
    for frame in frames:
        values = interpret.evaluate(fast.program(frame, pose=True), q)
        k = fast.cheapest.joint if frame == "cheapest" else frame
        T, J = chain.fk_jacobian(q, k)
        if frame == "cheapest":
            J = pk.se3.adjoint(pk.se3.inverse(fast.cheapest.T_km)) @ J
        lengths = np.array([1.0] * 9 + [chain.reach] * 3)
        poses = np.concatenate([T[:, :3, :3].reshape(-1, 9), T[:, :3, 3]], axis=1)
        allowed = near(chain, q) * times
        assert (np.abs((values[:, :12] - poses) / lengths).max(axis=1) <= allowed).all()
        off = values[:, 12:].reshape(J.shape) - J
        off = off / np.array([1.0] * 3 + [chain.reach] * 3)[:, None]
        assert (np.abs(off).max(axis=(1, 2), initial=0) <= allowed).all()


@pytest.mark.parametrize("name", CHAINS)
def test_the_parts_move_as_the_chain(name):
    chain = CHAINS[name]
    check(chain, chain.random(0, 7), 1 + LONGER * ("slanted" in name))


@FEW
@given(chain_cases(("q",), max_joints=5))
def test_the_parts_of_any_chain_move_as_it_does(case):
    chain, q = case
    check(chain, q[None], 1 + LONGER)


@pytest.mark.parametrize("name, parallel, sign, sine, cosine, step", [
    ("parallel", 1, 1, 0, 1, (math.hypot(0.5, 0.1), 0)),
    ("opposite", 1, -1, 0, 1, (math.hypot(0.5, 0.1), 0)),
    ("one line", 1, 1, 0, 1, (0, 0)),
    ("right angle, meeting", 0, 1, 1, 0, (0, 0)),
    ("right angle, apart", 0, 1, 1, 0, (0.3, 0)),
    ("sliding along", 1, 1, 0, 1, (0, 0)),
    ("sliding across", 0, 1, 1, 0, (0, 0)),
])  # fmt: skip
def test_what_is_parallel_perpendicular_or_meets_is_exactly_so(
    name, parallel, sign, sine, cosine, step
):
    arm = structure(CHAINS[name])
    assert arm.parallel[:2] == (0, parallel)
    assert (arm.rotates[1] or arm.slides[1]) == sign
    assert arm.links[0] == (0.0, 1.0, 0.0, 0.0)
    assert arm.links[1][:2] == pytest.approx((sine, cosine), abs=0)
    assert arm.links[1][2:] == pytest.approx(step, abs=1e-15)


@pytest.mark.parametrize("name, hybrid, middle", [
    ("puma560", (34, 14, 5), (15, 3, 4)), ("ur5e", (34, 15, 5), (9, 5, 4)), ("panda", (91, 44, 6), (35, 15, 5)),
    ("stanford", (45, 18, 4), (6, 0, 3)),
])  # fmt: skip
def test_a_nominal_arm_s_jacobian_costs_no_more_than_its_structure_lets_it(name, hybrid, middle):
    fast = pk.load(name).chain(tip={"panda": "panda_hand", "ur5e": "tool0"}.get(name)).compile()
    frames: list[tuple[Any, Any]] = [("hybrid", hybrid), ("cheapest", middle)]
    for frame, most in frames:
        count = fast.program(frame).count
        assert (np.array([count.multiplications, count.additions, count.sines]) <= most).all()


@pytest.mark.parametrize("quarter, cosine, sine", [(0, 1, 0), (1, 0, 1), (2, -1, 0), (3, 0, -1)])
def test_a_quarter_turn_is_one_within_rounding_and_else_an_angle(quarter, cosine, sine):
    for off, folded in (
        (0.0, True),
        (0.9, True),
        (-0.9, True),
        (1.1, False),
        (-1.1, False),
        (1e15, False),
    ):
        small = off * FOLD_TOLERANCE
        c, s = cosine - small * sine, sine + small * cosine
        quarters, angle = _angle(Decimal(c), Decimal(s))
        assert (quarters, angle) == ((quarter, 0) if folded else (0, math.atan2(s, c)))


def test_a_pose_is_seen_from_the_frame_of_each_joint():
    chain = chain_of_three()
    pose = pk.se3.exp([0.3, -0.2, 0.5, 1.0, 2.0, 3.0])
    row = (*pose[:3, :3].ravel().tolist(), *pose[:3, 3].tolist())
    for k, T in enumerate(chain.joint_poses(np.zeros(3))):
        seen = pk.se3.inverse(T) @ pose
        assert _in_local(chain, k, row) == pytest.approx(
            (*seen[:3, :3].ravel(), *seen[:3, 3]), abs=1e-14
        )


def chain_of_three():
    rows = np.random.default_rng(4).normal(size=(3, 2, 3))
    return pk.Chain.from_space([pk.screw.revolute(z, p) for z, p in rows], np.eye(4))


@pytest.mark.parametrize("tilt, slanted", [(0.09, False), (0.11, True)])
@pytest.mark.parametrize("flip", [1.0, -1.0])
def test_links_follow_common_normals_but_between_nearly_parallel_axes(tilt, slanted, flip):
    # The second axis passes the first at x = 0.5 and leans across x; the third is parallel to it.
    z = flip * np.array([0, np.sin(tilt), np.cos(tilt)])
    rows = [
        ([0, 0, 1], [0, 0, 0]),
        (z, [0.5, 0, 2.0]),
        (-z, np.array([0.5, 0, 2.0]) + 0.25 * np.array([1, 0, 0])),
    ]
    found = structure(pk.Chain.from_space([pk.screw.revolute(*row) for row in rows], np.eye(4)))
    assert found.links[0] == (0, 1, 0, 0)
    sine, cosine, across, aside = found.links[1]
    assert sine == pytest.approx(np.sin(tilt))
    assert cosine == pytest.approx(flip * np.cos(tilt))
    assert abs(across) == pytest.approx(0.5)
    assert abs(aside) == pytest.approx(0.0 if slanted else 2.0 * np.tan(tilt))
    assert found.links[2] == pytest.approx((0, 1, 0.25, 0))
    assert found.parallel == (0, 0, 1)
    assert found.rotates == (1, 1, -1)
