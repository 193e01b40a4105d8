"""Ranks and verdicts do not depend on the units of the coordinates: gears, degrees, millimetres."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.analysis.dexterity.jacobian_part import ROWS, generic_rank
from poekin.analysis.dexterity.messages import rate_words
from tests.model.laws.chain_cases import chain_cases

FEW = settings(max_examples=max(settings().max_examples // 3, 20))
Z = [0, 0, 1]
UR5E = pk.load("ur5e").chain(tip="tool0")
LINKS = pk.Chain.from_space(
    [pk.screw.revolute(Z, [0, 0, 0]), pk.screw.revolute(Z, [0.5, 0, 0])],
    pk.se3.exp([0, 0, 0, 0.9, 0, 0]),
    q_names=["one", "two"],
)
LIFT = pk.Chain.from_space(
    [*LINKS.screws, pk.screw.prismatic(Z)], LINKS.home, q_names=["one", "two", "up"]
)
AT = {
    "UR5e": (UR5E, [0.0, -1.0, 1.5, -2.0, -1.5, 0.0]),
    "UR5e, wrist": (UR5E, [0.0, -1.0, 1.5, -2.0, 0.0, 0.0]),
    "two links": (LINKS, [0.3, 1.2]),
    "two links, stretched": (LINKS, [0.3, 0.0]),
    "with a lift, nearly stretched": (LIFT, [0.3, 2e-4, 0.1]),
}


def geared(arm, ratios):
    """The arm by coordinates of which each moves its joints by the ratio; limits are left out."""
    limits = np.tile([-np.inf, np.inf], (arm.dof, 1))
    return arm.replace(coupling=arm.coupling * ratios, limits=limits)


def verdict(found):
    return (found.singular, found.rank, found.generic_rank, found.part, found.unit)


@pytest.mark.parametrize("name", AT)
@FEW
@given(seed=st.integers(0, 10**6))
def test_a_verdict_is_the_same_in_every_unit(name, seed):
    arm, q = AT[name]
    ratios = 10.0 ** np.random.default_rng(seed).uniform(-5, 5, arm.dof)
    other, x = geared(arm, ratios), np.array(q) / ratios
    expected, found = pk.singularity(arm, q), pk.singularity(other, x)
    assert verdict(found) == verdict(expected)
    np.testing.assert_allclose(found.singular_values, expected.singular_values, atol=1e-12)
    np.testing.assert_allclose(found.distance, expected.distance, rtol=1e-6, atol=1e-10)
    np.testing.assert_allclose(found.joint_ratios, ratios)
    J = other.jacobian(x, "hybrid")[ROWS[found.part]]
    if found.part == "pose":
        J /= np.repeat([1.0, found.length], 3)[:, None]
    assert np.linalg.norm(J @ found.joint_direction) == pytest.approx(found.smallest, abs=1e-12)


@FEW
@given(data=st.data(), seed=st.integers(0, 10**6))
def test_the_largest_rank_is_the_same_in_every_unit(data, seed):
    arm = data.draw(chain_cases((), min_joints=1, max_joints=7))[0]
    ratios = 10.0 ** np.random.default_rng(seed).uniform(-5, 5, arm.dof)
    for part in ROWS:
        assert generic_rank(geared(arm, ratios), part) == generic_rank(arm, part)


def test_a_gear_is_a_factor_of_the_manipulability_and_leaves_no_motion_out():
    q = AT["UR5e"][1]
    ratios = np.array([1, 1, 1, 1, 1, 1e-4])
    whole = pk.manipulability(UR5E, q)
    found = pk.manipulability(geared(UR5E, ratios), q / ratios)
    assert found.pose.yoshikawa == pytest.approx(1e-4 * whole.pose.yoshikawa, rel=1e-9)
    J = UR5E.jacobian(q, "hybrid") * ratios
    s = np.linalg.svd(J, compute_uv=False)
    assert found.pose.smallest == pytest.approx(s[-1], rel=1e-9)
    assert found.pose.condition == pytest.approx(s[0] / s[-1], rel=1e-9)


def test_the_direction_of_the_nearest_singularity_is_in_the_unit_of_the_coordinates():
    ratios = np.array([1.0, 1e-3])
    q = np.array([0.3, 1e-3])
    found = pk.singularity(geared(LINKS, ratios), q / ratios)
    assert found.distance == pytest.approx(1e-3, rel=1e-3)
    led = q / ratios + found.distance * found.gradient_direction
    np.testing.assert_allclose(led * ratios, [0.3, 0.0], rtol=0, atol=1e-6)


def test_the_coordinate_that_leads_is_that_whose_joint_moves_most_and_rates_are_its_own():
    # a shoulder geared by 1/1000 turns so little that it leads nowhere, however fast it runs
    q, ratios = np.array([0.3, 0.4]), np.array([1e-3, 1.0])
    plain = pk.singularity(LINKS, q)
    found = pk.singularity(geared(LINKS, ratios), q / ratios)
    assert "most of it in 'two'" in plain.summary()
    assert "most of it in 'two'" in found.summary()
    one, two = plain.joint_direction
    words = f"'two' {two:+.2f}, 'one' {1e3 * one:+.3g}."
    assert found.summary().endswith(words)


def test_a_gear_that_makes_a_coordinate_run_fast_does_not_make_it_lead_to_the_singularity():
    q, ratios = np.array([0.0, -1.0, 0.5, -2.0, -1.5, 0.0]), np.array([1, 1, 1, 1, 1e-3, 1])
    found = pk.singularity(geared(UR5E, ratios), q / ratios)
    shares = np.abs(found.gradient_direction)
    assert UR5E.q_names[int(np.argmax(shares))] == "wrist_2_joint"
    assert "most of it in 'elbow_joint'" in found.summary()


def test_rates_are_those_of_joints_that_go_by_more_than_a_tenth():
    names, ratios = ("a", "b", "c", "d"), np.array([1.0, 1e-3, 1e3, 1.0])
    rates = np.array([-0.101, 500.0, 0.00075, 0.099])
    assert rate_words(names, rates, ratios) == "'c' +0.00075, 'b' +500, 'a' -0.10"
    assert rate_words(names[:2], np.array([99.996, -100.0]), np.ones(2)) == "'b' -100, 'a' +100.00"
    assert rate_words(names[:2], np.array([0.1, 0.1]), np.array([1.0, 2.0])) == "'b' +0.1"
    equal = rate_words(names[:2], np.array([0.5, -0.5]), np.ones(2))
    assert equal == "'a' +0.50, 'b' -0.50"
