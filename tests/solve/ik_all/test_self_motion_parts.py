"""The direction of a continuum: what a Jacobian takes to nothing of a step, and whose it is."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.ik_all.solution_sets.places import Places
from poekin.solve.ik_all.solution_sets.self_motion import SelfMotion, _null_vector, directions
from poekin.solve.joint_units import joint_units

STRETCHED = np.diag([1e3, 1.0, 1.0, 1.0, 1.0, 0.5e-6])


@pytest.mark.parametrize(("least", "lost"), [(0.99e-6, True), (1.01e-6, False)])
def test_a_direction_is_lost_by_a_billionth_of_the_largest_singular_value(least, lost):
    J = np.diag([1e3, 2.0, 1.0, 1.0, 1.0, least])
    found = _null_vector(J, np.array([0, 0, 0, 0, 0, 0.05]))
    assert (found is not None) == lost


def test_the_part_of_a_step_that_is_lost_is_the_direction():
    step = np.array([0.03, 0, 0, 0, 0, 0.04])
    found = _null_vector(STRETCHED, step)
    assert found is not None
    np.testing.assert_allclose(found, [0, 0, 0, 0, 0, 0.04], atol=1e-15)
    two = np.diag([1.0, 1, 1, 1, 0, 0])
    both = _null_vector(two, np.array([0.01, 0, 0, 0, -0.02, 0.03]))
    assert both is not None
    np.testing.assert_allclose(both, [0, 0, 0, 0, -0.02, 0.03], atol=1e-15)


@pytest.mark.parametrize(("along", "goes_on"), [(0.51, True), (0.49, False)])
def test_a_step_goes_on_by_half_of_it_at_least(along, goes_on):
    step = 0.05 * np.array([np.sqrt(1 - along**2), 0, 0, 0, 0, along])
    assert (_null_vector(STRETCHED, step) is not None) == goes_on


def test_each_target_has_the_directions_of_its_own_solutions():
    chain = pk.load("puma560").chain()
    straight = np.array([0.1, -0.7, 0.5, 0.3, 0.0, 0.2])
    bent = straight + 0.7 * np.eye(6)[4]
    q = np.stack([bent, straight, straight, straight, bent])
    places = Places(q, np.array([0, 0, 1, 2, 2]), np.ones(5, int), np.array([2, 1, 2]))
    step = np.array([0, 0, 0, 0.03, 0, -0.03])
    units = joint_units(chain.compile())
    free = np.ones(6, bool)
    for target, row in ((0, 1), (1, 2), (2, 3)):
        found = directions(units, free, places, {target: SelfMotion(("a",), step)})
        assert list(found) == [row]
        np.testing.assert_allclose(found[row], step / np.linalg.norm(step), atol=1e-9)
    assert directions(units, free, places, {}) == {}
