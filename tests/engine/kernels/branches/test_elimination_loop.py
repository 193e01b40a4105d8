"""The loop of six joints: from either end and begun at any joint its motions make the one it says."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels.branches import elimination_loop as module
from tests.engine.kernels.branches.test_elimination_kernels import chain, table

U = 2.0**-53
ARM = chain(4)
Q = np.random.default_rng(1).uniform(-np.pi, np.pi, 6)
# lengths are up to 10 m here: six motions and as many changes of frame
WITHIN = 1000 * U


def looped(reverse: int, begin: int) -> tuple[np.ndarray, np.ndarray]:
    """Axes of the loop, directions and points, and the motion (4, 4) that they make."""
    arm = table(ARM, reverse, begin)
    axes = np.full((6, 6), np.nan)
    G = module.loop(arm, module.motion(arm, ARM.fk(Q)), axes)
    T = np.eye(4)
    T[:3, :3] = np.reshape(G[:9], (3, 3))
    T[:3, 3] = G[9:]
    return axes, T


@pytest.mark.parametrize("reverse", [0, 1])
@pytest.mark.parametrize("begin", range(6))
def test_motions_about_the_axes_in_the_loop_s_order_make_its_motion(reverse, begin):
    axes, G = looped(reverse, begin)
    order = np.roll(Q[::-1] if reverse else Q, -begin)
    made = np.eye(4)
    for (*h, x, y, z), angle in zip(axes, order, strict=True):
        made = made @ pk.se3.exp(angle * pk.screw.revolute(h, [x, y, z]))
    np.testing.assert_allclose(made, G, rtol=0, atol=WITHIN)


@pytest.mark.parametrize("reverse", [0, 1])
@pytest.mark.parametrize("begin", range(6))
def test_the_second_axis_is_the_z_axis_and_a_step_leads_from_each_axis_to_the_next(reverse, begin):
    axes, _ = looped(reverse, begin)
    np.testing.assert_allclose(axes[1], [0, 0, 1, 0, 0, 0], rtol=0, atol=20 * U)
    assert module.directions(axes) == tuple(tuple(axis[:3]) for axis in axes)
    steps = np.diff(axes[:, 3:], axis=0)
    np.testing.assert_array_equal(module.steps(axes), steps)


def test_numbers_of_a_rule_have_places_of_their_own():
    assert (module.UNIT, module.REVERSED, module.BEGIN, module.QUARTERS) == (0, 1, 2, 3)


def test_lengths_are_in_the_arm_s_unit():
    one, two = (table(ARM, 0, 2) for _ in range(2))
    one[8, module.UNIT] = 1.0
    two[8, module.UNIT] = 2.0
    rows = [np.empty((6, 6)), np.empty((6, 6))]
    G, H = (
        module.loop(arm, module.motion(arm, ARM.fk(Q)), axes)
        for arm, axes in zip((one, two), rows, strict=True)
    )
    np.testing.assert_array_equal(rows[0][:, :3], rows[1][:, :3])
    np.testing.assert_array_equal(rows[0][:, 3:], 2 * rows[1][:, 3:])
    assert G[:9] == H[:9]
    np.testing.assert_array_equal(G[9:], 2 * np.array(H[9:]))
    places = np.cumsum(ARM.to_hp().P[:6], axis=0)  # of the axes, in m
    found = np.linalg.norm(rows[0][:3, 3:] - rows[0][1, 3:], axis=1)
    np.testing.assert_allclose(found, np.linalg.norm(places[2:5] - places[3], axis=1), rtol=1e-12)


def test_the_target_moves_the_axes_among_themselves_unless_the_loop_is_cut_beside_the_first():
    fixed = [begin for begin in range(6) if module.is_far_side_fixed(table(ARM, 0, begin))]
    for begin in range(6):
        axes = [np.empty((6, 6)) for _ in range(2)]
        arm = table(ARM, 0, begin)
        for q, rows in zip((Q, -Q), axes, strict=True):
            module.loop(arm, module.motion(arm, ARM.fk(q)), rows)
        same = np.allclose(axes[0][1:], axes[1][1:], rtol=0, atol=WITHIN)
        assert same == (begin in fixed)
