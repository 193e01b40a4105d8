"""Plane of an arm: the normal of the axes that turn, else of two slides, else there is none."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.groups import se3, so3
from poekin.model import screw
from poekin.solve.ik.joint_domain import make_joint_domain
from poekin.solve.ik.plane import plane_normal
from poekin.solve.joint_units import joint_units

N = np.array([2.0, 3.0, -6.0]) / 7
U = np.array([3.0, 6.0, 2.0]) / 7


def normal(*axes, lock=(), **options):
    units = joint_units(pk.Chain.from_space(list(axes), np.eye(4), **options).compile())
    return plane_normal(units.fast.chain, make_joint_domain(units, lock, True))


def test_axes_that_turn_either_way_have_one_normal_that_of_the_first():
    axes = [screw.revolute(s * N, [k, 1, 0]) for k, s in enumerate([1.0, -1.0, -1.0, 1.0])]
    np.testing.assert_allclose(normal(*axes), N, rtol=0, atol=1e-15)
    np.testing.assert_allclose(normal(screw.prismatic(U), *axes[1:]), -N, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(normal(screw.revolute([0, 0, 1], [1, 0, 0])), [0, 0, 1])


def test_axes_of_a_calibrated_arm_are_nearly_parallel_and_the_normal_is_their_mean():
    tilted = so3.exp(0.009 * U) @ N
    axes = [screw.revolute(N, [0, 0, 0]), screw.revolute(tilted, [1, 0, 0])]
    mean = (N + tilted) / np.linalg.norm(N + tilted)
    np.testing.assert_allclose(normal(*axes), mean, rtol=0, atol=1e-15)
    with pytest.raises(InputError, match="'joint2' not parallel to 'joint1'"):
        normal(axes[0], screw.revolute(so3.exp(0.012 * U) @ N, [1, 0, 0]))


def test_two_slides_span_a_plane():
    found = normal(screw.prismatic(N), screw.prismatic(U))
    across = np.cross(N, U) / np.linalg.norm(np.cross(N, U))
    assert abs(found @ across) == pytest.approx(1, abs=1e-14)


NO_PLANE = (
    "task 'planar': expected an arm that moves in a plane, all its turning axes parallel, or two "
    "slides alone; "
)
X, Y, Z = np.eye(3)


@pytest.mark.parametrize("axes, fault", [
    ([screw.revolute(Z, [0, 0, 0]), screw.prismatic(Y), screw.revolute(X, [0, 0, 0])],
     "'joint3' not parallel to 'joint1'"),
    ([screw.prismatic(X), screw.prismatic(Y), screw.prismatic(Z)],
     "it has no turning axis, and its slides span no plane"),
    ([screw.prismatic(X)], "it has no turning axis, and its slides span no plane"),
    ([screw.prismatic(X), screw.prismatic(X)], "it has no turning axis, and its slides span no plane"),
])  # fmt: skip
def test_an_arm_without_a_plane_is_refused(axes, fault):
    with pytest.raises(InputError, match=f"^{re.escape(NO_PLANE + fault)}$"):
        normal(*axes)


def test_locked_joints_turn_the_plane_with_them_and_do_not_count():
    axes = [screw.revolute(X, [0, 0, 0]), *(screw.revolute(Z, [k, 0, 0]) for k in range(2))]
    found = normal(*axes, lock=(("joint1", 0.5),))
    np.testing.assert_allclose(found, so3.exp([0.5, 0, 0]) @ Z, rtol=0, atol=1e-15)


def test_the_offset_of_a_joint_counts_as_its_angle():
    # joint 1 is 0.25 rad away from its zero, where q is 0
    axes = [screw.revolute(X, [0, 0, 0]), screw.revolute(Z, [0, 0, 0])]
    found = normal(*axes, lock=(("joint1", 0.5),), offset=[0.25, 0])
    np.testing.assert_allclose(found, so3.exp([0.75, 0, 0]) @ Z, rtol=0, atol=1e-15)


def test_a_joint_that_mimics_a_locked_one_does_not_count():
    axes = [
        screw.revolute(X, [0, 0, 0]),
        screw.revolute(Z, [0, 0, 0]),
        screw.revolute(X, [1, 0, 0]),
    ]
    found = normal(*axes, lock=(("q1", 0.5),), coupling=[[1, 0], [0, 1], [2, 0]])
    np.testing.assert_allclose(found, so3.exp([0.5, 0, 0]) @ Z, rtol=0, atol=1e-15)


def test_the_normal_is_in_the_base_frame_of_the_arm():
    P = se3.exp([0.4, -0.3, 0.9, 1, 2, 3])
    arm = pk.Chain.from_space([screw.revolute(Z, [0, 0, 0])], np.eye(4)).rebased(P)
    units = joint_units(arm.compile())
    found = plane_normal(units.fast.chain, make_joint_domain(units, (), True))
    np.testing.assert_allclose(found, P[:3, 2], rtol=0, atol=1e-15)
