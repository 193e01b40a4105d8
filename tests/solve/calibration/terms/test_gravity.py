"""The wrist that a weight hangs on, and the kinds of loads that joints yield to."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.terms.gravity import (
    STANDARD_GRAVITY,
    levers,
    point_mass,
    wrist,
    wrist_in_tip,
)

TIP = pk.se3.pose(pk.so3.exp([0.3, -0.2, 0.5]), [0.7, 0.2, 0.9])
AXES = [([0, 0, 1.0], [0.0, 0, 0]), ([0, 1.0, 0], [0.4, 0, 0.5]), ([1.0, 0, 0], [0, 0.1, 0.7]),
        ([0, 0.6, 0.8], [0.6, -0.1, 0])]  # fmt: skip


def arm(*screws: np.ndarray) -> pk.Chain:
    return pk.Chain.from_space(screws, TIP)


def squares(point: np.ndarray) -> float:
    """Sum of the squared distances of a point from the last three axes that turn."""
    return sum(
        float(np.sum(np.cross(point - place, direction) ** 2)) for direction, place in AXES[1:]
    )


@pytest.mark.parametrize("slide", [None, 1, 2, 3, 4])
@pytest.mark.parametrize("along", [[1.0, 0, 0], [0, 0.6, 0.8]])
def test_the_wrist_is_nearest_to_the_last_three_axes_that_turn(slide, along):
    screws = [pk.screw.revolute(direction, place) for direction, place in AXES]
    if slide is not None:
        screws.insert(slide, pk.screw.prismatic(along))
    chain = arm(*screws)
    found = wrist(chain)
    for step in 1e-3 * np.concatenate([np.eye(3), -np.eye(3)]):
        assert squares(found) < squares(found + step)
    in_tip = TIP[:3, :3] @ wrist_in_tip(chain) + TIP[:3, 3]
    np.testing.assert_allclose(in_tip, found, rtol=0, atol=1e-12)


@pytest.mark.parametrize("tilt", [0.0, 1e-11])
def test_on_parallel_axes_the_wrist_is_beside_the_tip(tilt):
    """They would meet 1e10 m away."""
    places = [(0.5, 0.0, 0), (0.5, 0.1, 0), (0.5, 0.5, 0)]
    screws = [pk.screw.revolute([0, k * tilt, 1.0], place) for k, place in enumerate(places)]
    np.testing.assert_allclose(wrist(arm(*screws)), [0.5, 0.2, 0.9], rtol=0, atol=1e-9)


def test_where_nothing_turns_the_wrist_is_the_tip():
    np.testing.assert_allclose(wrist(arm(pk.screw.prismatic([0, 0, 1.0]))), TIP[:3, 3])


def test_a_weight_is_a_mass_of_one_on_the_last_link():
    screws = [pk.screw.revolute(direction, place) for direction, place in AXES]
    rows = point_mass(arm(*screws), np.array([1.0, 2.0, 3.0]))
    np.testing.assert_array_equal(rows, [[0] * 4] * 3 + [[1, 1, 2, 3]])
    assert point_mass(arm(), np.zeros(3)).shape == (0, 4)


@pytest.mark.parametrize("lever", [0.0, 0.9e-6, 1.1e-6, 0.3])
def test_a_joint_carries_from_a_millionth_of_the_reach_on(lever):
    """A mass above a level axis, that far beside it: through small angles its lever stays as long."""
    upright = pk.screw.revolute([0, 0, 1.0], [0, 0, 0])
    level = pk.screw.revolute([0, 1.0, 0], [0, 0, 0.5])
    chain = pk.Chain.from_space([upright, level], pk.se3.pose(np.eye(3), [0.0, 0, 1.0]))
    masses = [[1.0, 0, 0, 0], [1.0, 2.0 * lever * chain.reach, 0, 0.5]]
    loaded = chain.replace(masses=masses, limits=[[-1e-9, 1e-9]] * 2)
    owners = [p.owner for p in ErrorModel(loaded, ("home", "compliance"), None).parameters[6:]]
    assert owners == ([chain.q_names[1]] if lever > 1e-6 else [])


def test_a_torque_is_that_of_the_mass_in_newton_metres():
    level = pk.screw.revolute([0, 1.0, 0], [0, 0, 0])
    chain = pk.Chain.from_space([level], np.eye(4), masses=[[3.0, 0.5, 0, 0]])
    model = ErrorModel(chain, ("compliance",), None)
    (parameter,) = model.parameters
    assert (parameter.what, parameter.unit) == ("compliance", "rad/(N m)")
    np.testing.assert_allclose(model.basis(np.zeros((1, 1))), [[[1.5 * STANDARD_GRAVITY]]])


def test_a_torque_is_that_at_the_joint_s_own_zero():
    level = pk.screw.revolute([0, 1.0, 0], [0, 0, 0])
    chain = pk.Chain.from_space([level], np.eye(4), masses=[[3.0, 0.5, 0, 0]], offset=[0.4])
    found = ErrorModel(chain, ("compliance",), None).basis(np.array([[0.3]]))
    np.testing.assert_allclose(found, [[[1.5 * STANDARD_GRAVITY * np.cos(0.7)]]])


def test_gravity_is_that_of_the_general_conference_of_1901():
    assert STANDARD_GRAVITY == 9.80665


def test_a_lever_is_that_of_the_wrist_in_metres():
    screws = [pk.screw.revolute(direction, place) for direction, place in AXES]
    chain = arm(*screws)
    model = ErrorModel(chain, ("compliance",), None)
    q = np.random.default_rng(0).normal(size=(3, 4))
    every = levers(chain, q, np.tile([0.0, 0, -1], (3, 1)), wrist_in_tip(chain))
    owners = [chain.q_names.index(p.owner) for p in model.parameters]
    assert {p.unit for p in model.parameters} == {"rad/m"}
    np.testing.assert_allclose(model.basis(q).sum(axis=1), every[:, owners], rtol=0, atol=1e-12)
