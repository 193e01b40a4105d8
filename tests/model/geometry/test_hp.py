"""to_hp: directions and steps are the chain itself, and axes that meet share their points to the
last bit.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, target
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.testing.strategies import chain_strategies
from tests.model.laws.chain_bounds import budget

ARMS = ("puma560", "ur3", "ur5", "ur5e", "ur10", "ur10e", "ur16e", "irb140", "kr5", "jaco")


def rotation(h, angle):
    """e^{[h] angle} by Rodrigues' formula, of each angle (...)."""
    K = np.array([[0, -h[2], h[1]], [h[2], 0, -h[0]], [-h[1], h[0], 0]])
    angle = np.asarray(angle)[..., None, None]
    return np.eye(3) + np.sin(angle) * K + 2 * np.sin(angle / 2) ** 2 * (K @ K)


def poses(form, q):
    """The poses that the documented equation of the form has at configurations (rows, n)."""
    E, p = np.broadcast_to(np.eye(3), (len(q), 3, 3)), np.broadcast_to(form.P[0], (len(q), 3))
    for h, step, angle in zip(form.H, form.P[1:], q.T, strict=True):
        E = E @ rotation(h, angle)
        p = p + E @ step
    T = np.broadcast_to(np.eye(4), (len(q), 4, 4)).copy()
    T[:, :3, :3], T[:, :3, 3] = E @ form.R_nt, p
    return T


def excess(chain, form, q):
    """Error ÷ bound of the form's poses at configurations (rows, n); u = 2^-53.

    `fk` is within its budget. A point of the form is within 1e-14 reach of each axis that has it:
    turned about that point in place of the axis, what is behind is off by up to twice that, a
    joint. The steps are rounded, u each; the matrices of this test are off by 8 u each, product and
    rounded direction included, and carry the steps behind them.
    """
    n, reach = len(form.H), np.linalg.norm(form.P, axis=1).sum()
    own = 8 * 2.0**-53 * (n + 1)
    turned, moved = budget(chain, q)
    off = np.abs(poses(form, q) - chain.fk(q))
    far = off[:, :3, 3].max(axis=1) / (moved + 2e-14 * n * chain.reach + (own + 2.0**-53) * reach)
    return np.maximum(off[:, :3, :3].max(axis=(1, 2)) / (turned + own), far)


REVOLUTE = chain_strategies.chains(joint_kinds=("revolute",), max_joints=7, coupled=False)


@given(
    REVOLUTE.flatmap(lambda chain: st.tuples(st.just(chain), chain_strategies.coordinates(chain)))
)
def test_the_form_has_the_poses_of_the_chain(case):
    chain, q = case
    error = excess(chain, chain.to_hp(), q[None]).item()
    target(error)
    assert error <= 1


@pytest.mark.parametrize("name", ARMS)
def test_the_form_of_an_arm_has_its_poses(name):
    chain = pk.load(name).chain()
    form = chain.to_hp()
    assert form.H.shape == (6, 3)
    assert form.P.shape == (7, 3)
    assert excess(chain, form, chain.random(1, 50)).max() <= 1


def test_the_form_keeps_base_tool_and_zero_offsets():
    chain = pk.load("ur5").chain()
    P, Q = pk.se3.exp([0.3, -0.2, 0.9, 1.0, 2.0, -0.5]), pk.se3.exp([-1.0, 0.4, 0.1, 0.1, 0.0, 0.3])
    moved = chain.rebased(P).retooled(Q)
    offset = np.array([0.1, -0.4, 0.0, 2.0, 0.7, -3.0])
    moved = pk.Chain.from_space(moved.screws, moved.home, offset=offset)
    assert excess(moved, moved.to_hp(), moved.random(2, 50)).max() <= 1


@pytest.mark.parametrize(
    ("name", "zero"),
    [
        pytest.param("puma560", (1, 4, 5), id="puma560"),
        pytest.param("irb140", (4, 5), id="irb140"),
        pytest.param("kr5", (4, 5), id="kr5"),
        pytest.param("ur5", (1, 5), id="ur5"),
        pytest.param("ur10e", (1, 5), id="ur10e"),
        pytest.param("jaco", (1, 3, 5), id="jaco"),
    ],
)
def test_steps_between_axes_that_meet_are_zero_to_the_last_bit(name, zero):
    P = pk.load(name).chain().to_hp().P
    assert [i for i in range(1, 6) if not P[i].any()] == list(zero)


def test_a_step_between_parallel_axes_is_perpendicular_to_them():
    form = pk.load("ur5").chain().to_hp()
    assert abs(form.H[1] @ form.P[2]) <= 1e-16
    assert abs(form.H[2] @ form.P[3]) <= 1e-16


def screw(w, p):
    w = np.array(w, float) / np.linalg.norm(w)
    return [*w, *np.cross(p, w)]


def test_three_axes_that_meet_come_before_two():
    # 2 meets 1 in one point, and 3 and 4 in another
    o = (0, 0, 0)
    S = [screw((0, 0, 1), (1, 0, 0)), screw((1, 0, 0), o), screw((0, 1, 0), o), screw((0, 0, 1), o)]
    P = pk.Chain.from_space(S, np.eye(4)).to_hp().P
    assert not P[2:].any()
    assert P[1].tolist() == [-1.0, 0.0, 0.0]


def test_axes_that_pass_each_other_by_more_than_rounding_do_not_share_a_point():
    S = [screw((0, 0, 1), (0, 0, 0)), screw((1, 0, 0), (0, 1e-12, 0.5))]
    P = pk.Chain.from_space(S, np.eye(4)).to_hp().P
    assert P[1].any()


def test_a_chain_without_joints_has_one_step():
    T = pk.se3.exp([0.1, 0.2, 0.3, 1.0, 2.0, 3.0])
    form = pk.Chain.from_space(np.empty((0, 6)), T).to_hp()
    assert form.H.shape == (0, 3)
    assert form.P.tolist() == [T[:3, 3].tolist()]


@pytest.mark.parametrize("plant", ["direction", "step", "rotation"])
def test_a_planted_error_is_seen(plant):
    chain = pk.load("puma560").chain()
    form = chain.to_hp()
    H, P, R = (a.copy() for a in form)
    if plant == "direction":
        H[3] = rotation(np.array([1.0, 0.0, 0.0]), 1e-12) @ H[3]
    elif plant == "step":
        P[2, 0] += 1e-12
    else:
        R = rotation(np.array([0.0, 1.0, 0.0]), 1e-12) @ R
    assert excess(chain, form._replace(H=H, P=P, R_nt=R), chain.random(1, 50)).max() > 1


def test_joints_that_slide_are_refused_by_name():
    with pytest.raises(InputError, match=r"revolute joints only, 'joint3' is prismatic"):
        pk.load("stanford").chain().to_hp()


def test_coupled_joints_are_refused():
    S = [screw((0, 0, 1), (0, 0, 0)), screw((0, 0, 1), (1, 0, 0))]
    chain = pk.Chain.from_space(S, np.eye(4), coupling=[[1.0], [1.0]], q_names=["q"])
    with pytest.raises(
        InputError, match=r"the 2 joints of 'base' -> 'tool' are coupled to 1 coordinates"
    ):
        chain.to_hp()


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_axes_share_a_point_where_they_pass_each_other_within_rounding_of_the_reach(size):
    home = pk.se3.pose(np.eye(3), [0, 0, 2 * size])

    def steps(gap):
        rows = [
            pk.screw.revolute([0, 0, 1], [0, 0, 0]),
            pk.screw.revolute([1, 0, 0], [0, gap, size]),
        ]
        chain = pk.Chain.from_space(rows, home)
        return chain.reach, chain.to_hp().P

    reach, P = steps(0.0)
    assert P[1].tolist() == [0, 0, 0]
    _, P = steps(1e-14 * reach)
    assert P[1].tolist() == [0, 0, 0]
    _, P = steps(4e-14 * reach)
    assert P[1][1:] == pytest.approx([4e-14 * reach, size], rel=1e-3)
