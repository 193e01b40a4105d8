"""Nominal arms of the vendors: those of the public files, each of which fits itself alone."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import poekin as pk
from poekin.formats.vendors.deviations import origins
from poekin.formats.vendors.known_arms import best_fit, known_arms
from poekin.formats.vendors.yaml_io import read_text
from tests.formats.vendors.origins import (
    FLEXIV,
    RIZON_4S,
    RIZON_AXES,
    UFACTORY,
    UR5E,
    UR_LINKS,
    yaml,
)

ARMS = [arm for n in (5, 6, 7) for arm in known_arms(n)]


def named(name):
    return next(arm for arm in ARMS if arm.name == name)


def test_every_arm_has_the_joints_that_it_is_listed_with():
    assert {n: len(known_arms(n)) for n in (4, 5, 6, 7)} == {4: 0, 5: 1, 6: 10, 7: 7}
    assert len({arm.name for arm in ARMS}) == len(ARMS)


@pytest.mark.parametrize("name", UFACTORY)
def test_ufactory_s_numbers_are_those_of_its_files(name):
    mine = named(name)
    theirs = read_text(yaml(UFACTORY[name]))
    # three turns of 1.5708 or 3.1416, which are 4e-6 and 7e-6 rad off
    np.testing.assert_allclose(mine.calibration.poses, theirs.poses, rtol=0, atol=2e-5)


@pytest.mark.parametrize("name", FLEXIV)
def test_flexiv_s_numbers_are_those_of_its_files(name):
    arm = named(name)
    theirs = read_text(yaml(FLEXIV[name]), vendor="Flexiv")
    # three half turns of 3.141592654
    np.testing.assert_allclose(arm.calibration.poses, theirs.poses, rtol=0, atol=2e-9)


PAIRS = [
    (a, b)
    for a, b in itertools.permutations(ARMS, 2)
    if len(a.chain.joint_names) == len(b.chain.joint_names)
]


@pytest.mark.parametrize("a, b", PAIRS, ids=lambda arm: arm.name)
def test_no_arm_fits_another_before_its_own(a, b):
    assert a.fit(a.chain).worst.score <= 1e-12
    assert a.fit(b.chain).worst.score > 0.5
    fit = best_fit(b.chain)
    assert fit is not None
    assert fit.arm.name == b.name


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name)
def test_the_places_of_joints_are_the_origins_of_the_links_that_they_move(arm):
    robot = arm.calibration.to_robot()
    np.testing.assert_allclose(arm.places, origins(robot, robot.chain()), rtol=0, atol=1e-15)


@pytest.mark.parametrize("name", ["Rizon4 or 4s", "Rizon10 or 10s"])
def test_a_rizon_r_is_the_mirror_image_of_the_arm(name):
    arm = named(name)
    mirrored = named(f"{name.partition(' ')[0]}R")
    mirror = np.diag([1.0, -1.0, 1.0])
    np.testing.assert_allclose(mirrored.places, arm.places @ mirror, rtol=0, atol=1e-15)
    # a turn is mirrored to the opposite turn about the mirrored axis
    axes = -arm.chain.screws[:, :3] @ mirror
    np.testing.assert_allclose(mirrored.chain.screws[:, :3], axes, rtol=0, atol=1e-15)


def test_the_wrist_of_a_rizon_10_is_that_of_a_rizon_4():
    small = named("Rizon4 or 4s")
    large = named("Rizon10 or 10s")
    np.testing.assert_allclose(
        large.places[4:] - large.places[4], small.places[4:] - small.places[4], rtol=0, atol=1e-15
    )
    np.testing.assert_allclose(
        large.chain.screws[4:, :3], small.chain.screws[4:, :3], rtol=0, atol=1e-15
    )


@pytest.mark.parametrize("name", ["Rizon4 or 4s", "Rizon10 or 10s", "Enlight-L"])
def test_the_axes_of_flexiv_s_arms_are_along_the_base_s_at_zero(name):
    chain = named(name).chain
    axes = np.abs(chain.screws[:, :3])
    np.testing.assert_allclose(axes, axes.round(), rtol=0, atol=1e-15)
    assert (np.abs(chain.home[:3, :3]).round(15).max(axis=1) == 1).all()
    for one, other in itertools.pairwise(axes):
        assert one @ other == pytest.approx(0, abs=1e-15)


def test_measured_arms_fit_the_model_that_they_are():
    ur5e = read_text(yaml(UR5E, names=UR_LINKS)).to_chain()
    rizon = read_text(yaml(RIZON_4S, axes=RIZON_AXES)).to_chain()
    for chain, name in ((ur5e, "ur5e"), (rizon, "Rizon4 or 4s")):
        fit = best_fit(chain)
        assert fit is not None
        assert fit.arm.name == name
        assert 1e-4 < fit.worst.position < 5e-3


def test_an_arm_that_nobody_knows_fits_none():
    assert best_fit(pk.load("puma560").chain()) is None
    assert best_fit(pk.load("ur5e").chain(tip="wrist_1_link")) is None
