"""Poses and Jacobians of a chain, formula by formula, against products of 4x4 and 6x6 matrices.

Four joints between generic constant poses: one that only turns, one that only slides, two helical
ones. A chain of one joint and one of two go the ways that longer ones do not.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

from poekin.formulas import dh
from poekin.formulas.kinematics import columns, forward, recursive
from poekin.formulas.lie import exponential
from poekin.formulas.paper import dh_recursive, direct

rng = np.random.default_rng(3)
MOST = 4
ROTATES, SLIDES = np.array([1.0, 0.0, 0.8, -0.9]), np.array([0.0, 1.0, 0.2, 0.3])
X, RATES = rng.normal(size=MOST), rng.normal(size=MOST)
LOCAL = [np.array([0, 0, r, 0, 0, s]) for r, s in zip(ROTATES, SLIDES, strict=True)]
ANGLES = ROTATES * X
MOTION = (np.sin(ANGLES), np.cos(ANGLES), SLIDES * X)
FEW = 1e-13  # eleven products of poses whose entries reach 10
COUNTS = pytest.mark.parametrize("count", [1, 2, 3, 4])


def hat(w):
    return np.cross(np.eye(3), w)


def brackets(xi):
    X = np.zeros((4, 4))
    X[:3, :3], X[:3, 3] = hat(xi[:3]), xi[3:]
    return X


def flat(T):
    return (*T[:3, :3].ravel().tolist(), *T[:3, 3].tolist())


def Ad(T):
    """[R 0; [p] R R], twists with the angular part first."""
    R, p = T[:3, :3], T[:3, 3]
    return np.block([[R, np.zeros((3, 3))], [hat(p) @ R, R]])


def product(*poses):
    return np.linalg.multi_dot([np.eye(4), np.eye(4), *poses])


LINKS = [expm(brackets(xi)) for xi in rng.normal(size=(MOST + 1, 6))]
TOOL, PARENT = expm(brackets(rng.normal(size=6))), expm(brackets(rng.normal(size=6)))
SCREWS = rng.normal(size=(MOST, 6))
MOVES = [expm(brackets(S * x)) for S, x in zip(LOCAL, X, strict=True)]
EXPONENTIALS = [expm(brackets(S * x)) for S, x in zip(SCREWS, X, strict=True)]
MOVED = [L @ E for L, E in zip(LINKS[:MOST], MOVES, strict=True)]  # f_{i-1,i} = M_i e^{S_i x_i}
FRAMES = [product(*MOVED[: i + 1]) for i in range(MOST)]


def rows(count):
    return np.full((6, count), np.nan)


def same(got, expected):
    np.testing.assert_allclose(got, expected, rtol=0, atol=FEW)


@COUNTS
def test_the_pose_is_the_product_of_links_and_motions(count):
    links = [flat(T) for T in LINKS]
    same(forward.frame(links, *MOTION, count), flat(FRAMES[count - 1]))
    f = FRAMES[count - 1] @ LINKS[count]
    same(forward.tip(links, *MOTION, count), flat(f))
    axes = rows(count)
    same(forward.tip_and_axes(links, *MOTION, count, axes), flat(f))
    begins = [F @ np.linalg.inv(E) for F, E in zip(FRAMES, MOVES, strict=True)]
    same(axes, np.transpose([np.r_[B[:3, 2], B[:3, 3]] for B in begins[:count]]))


def test_a_link_of_a_tree_is_behind_its_parent_and_its_joint():
    S = np.array([0.6, 0.0, 0.8, 0.3, -0.2, 0.5])
    got = forward.child(flat(PARENT), flat(TOOL), S, 0.7, np.sin(0.7), np.cos(0.7))
    same(got, flat(PARENT @ TOOL @ expm(brackets(S * 0.7))))


@COUNTS
def test_the_direct_method_carries_each_screw_by_the_exponentials_before_or_behind_it(count):
    exponentials = [flat(E) for E in EXPONENTIALS[:count]]
    J = rows(count)
    before = direct.space(SCREWS, exponentials, count, J)
    same(J, np.transpose([Ad(product(*EXPONENTIALS[:i])) @ SCREWS[i] for i in range(count)]))
    same(before, flat(product(*EXPONENTIALS[: max(count - 1, 1)])))
    behind = direct.body(SCREWS, exponentials, count, J)
    after = [product(*EXPONENTIALS[i + 1 : count]) for i in range(count)]
    same(
        J,
        np.transpose(
            [Ad(np.linalg.inv(T)) @ S for T, S in zip(after, SCREWS[:count], strict=True)]
        ),
    )
    same(behind, flat(product(*EXPONENTIALS[min(1, count - 1) : count])))


@COUNTS
def test_the_recursions_give_the_tool_s_screws_in_its_own_frame(count):
    moved = [flat(T) for T in MOVED]
    formulas: list[tuple[Any, tuple]] = [
        (recursive.body, ()),
        (recursive.body_with_tool, (flat(TOOL),)),
    ]
    for formula, tool in formulas:
        J = rows(count)
        T = formula(moved, *tool, ROTATES, SLIDES, count, J)
        last = TOOL if tool else np.eye(4)
        behind = [product(*MOVED[i + 1 : count], last) for i in range(count)]
        same(
            J,
            np.transpose(
                [Ad(np.linalg.inv(T)) @ S for T, S in zip(behind, LOCAL[:count], strict=True)]
            ),
        )
        # of one joint without a tool there is no frame between the joint's and the tool's, and
        # f_{1,n} stands for f
        same(T, flat(behind[0] if tool or count > 1 else MOVED[0]))


@COUNTS
def test_orin_and_schrader_s_frames_follow_their_joints(count):
    J = rows(count)
    T = dh_recursive.body([flat(T) for T in MOVED], flat(TOOL), ROTATES, SLIDES, count, J)
    behind = [product(*MOVED[i:count], TOOL) for i in range(count)]
    same(
        J,
        np.transpose(
            [Ad(np.linalg.inv(T)) @ S for T, S in zip(behind, LOCAL[:count], strict=True)]
        ),
    )
    same(T, flat(behind[0]))


@COUNTS
def test_the_velocity_is_that_of_the_body_jacobian(count):
    behind = [product(*MOVED[i + 1 : count], TOOL) for i in range(count)]
    steps = zip(behind, LOCAL[:count], RATES[:count], strict=True)
    expected = sum(Ad(np.linalg.inv(T)) @ S * rate for T, S, rate in steps)
    moved = [flat(T) for T in MOVED]
    same(recursive.body_velocity(moved, flat(TOOL), ROTATES, SLIDES, count, RATES), expected)


@COUNTS
def test_the_screws_of_a_table_are_carried_by_the_links_before_them(count):
    A = np.full((count, 6), np.nan)
    home = dh.screws([flat(T) for T in LINKS], ROTATES, SLIDES, count, A)
    same(A, [Ad(product(*LINKS[: i + 1])) @ LOCAL[i] for i in range(count)])
    same(home, flat(product(*LINKS[: count + 1])))


@COUNTS
def test_columns_are_velocities_of_a_point_turned_and_coupled(count):
    axes, p = rng.normal(size=(6, count)), rng.normal(size=3)
    z, o = axes[:3].T, axes[3:].T
    J = axes.copy()
    columns.about_point(J, ROTATES, SLIDES, count, p)
    v = [
        r * np.cross(zi, p - oi) + s * zi
        for r, s, zi, oi in zip(ROTATES[:count], SLIDES[:count], z, o, strict=True)
    ]
    expected = np.concatenate([(ROTATES[:count, None] * z).T, np.transpose(v)])
    same(J, expected)
    R = TOOL[:3, :3]
    columns.turned_into(J, count, R.ravel())
    same(J, np.concatenate([R.T @ expected[:3], R.T @ expected[3:]]))
    coupling, J_q = rng.normal(size=(count, 3)), rows(3)
    columns.coupled(expected, coupling, count, 3, J_q)
    same(J_q, expected @ coupling)


@pytest.mark.parametrize("w", [(0.6, 0.0, -0.8), (0.0, 0.0, 0.0)], ids=["axis", "no axis"])
def test_a_joint_moves_by_the_exponential_of_its_screw(w):
    for v, q in (((0.3, -0.2, 0.7), 1.9), ((0.1, 0.4, -0.5), -0.6)):
        same(
            exponential.joint(w, v, q, np.sin(q), np.cos(q)), flat(expm(brackets(np.r_[w, v] * q)))
        )


def test_three_hundred_joints_are_as_good_as_three():
    """Columns near the tip, in the middle and near the base; rounding grows with the number of
    products.
    """
    n, step = 300, expm(brackets(np.array([0.01, -0.02, 0.015, 0.002, 0.001, -0.003])))
    rotates, slides = np.ones(n), np.full(n, 0.1)
    S, links = np.array([0, 0, 1, 0, 0, 0.1]), [flat(step)] * n
    powers = [np.linalg.matrix_power(step, k) for k in range(n)]
    formulas: list[tuple[Any, bool]] = [
        (recursive.body, False),
        (direct.body, False),
        (direct.space, True),
    ]
    for formula, first in formulas:
        J: Any = rows(n)
        if formula is recursive.body:
            formula(links, rotates, slides, n, J)
        else:
            formula([tuple(S)] * n, links, n, J)
        for i in (0, 1, 2, 150, n - 3, n - 2, n - 1):
            T = powers[i] if first else np.linalg.inv(powers[n - 1 - i])
            np.testing.assert_allclose(J[:, i], Ad(T) @ S, rtol=0, atol=1e-11)
