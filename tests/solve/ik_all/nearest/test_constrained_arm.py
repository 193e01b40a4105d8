"""Arms whose axes meet or are parallel to the last bit, and the motions that keep them so."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.solve.ik_all.nearest.constrained_arm import ConstrainedArm, rounded_arm
from poekin.solve.ik_all.structure import Family
from tests.solve.ik_all.perturbed import calibrated_ur10e, perturbed

FAMILIES = [Family(kind, first, False) for kind in ("meeting", "parallel") for first in range(4)]


def holds(arm: ConstrainedArm) -> bool:
    """Whether the three axes meet or are parallel, to the last bit."""
    three = list(arm.family.joints)
    if arm.family.kind == "meeting":
        return bool((arm.points[three] == arm.points[three[0]]).all())
    return bool((np.abs(arm.directions[three]) == np.abs(arm.directions[three[0]])).all())


@pytest.mark.parametrize("family", FAMILIES, ids=str)
@settings(max_examples=max(settings().max_examples // 5, 10))
@given(seed=st.integers(0, 1000), size=st.floats(0, 0.1))
def test_motions_keep_the_family_to_the_last_bit(family, seed, size):
    arm = rounded_arm(perturbed(pk.load("ur5e").chain(), seed), family)
    assert holds(arm)
    motions = arm.motions()
    # 9 parameters of three axes that meet, 8 of parallel ones, 4 of each other
    assert motions.turns.shape[2] == {"meeting": 21, "parallel": 20}[family.kind]
    x = np.random.default_rng(seed).normal(size=motions.turns.shape[2]) * size
    assert holds(arm.moved(motions, x, np.zeros(6)))


@pytest.mark.parametrize("family", FAMILIES, ids=str)
def test_twists_are_the_derivatives_of_the_screws(family):
    arm = rounded_arm(calibrated_ur10e(), family)
    motions = arm.motions()
    twists = motions.twists()
    h = 1e-6
    nothing = np.zeros(6)
    for k, x in enumerate(np.eye(twists.shape[2])):
        more = arm.moved(motions, h * x, nothing).screws()
        less = arm.moved(motions, -h * x, nothing).screws()
        # d/dh Ad(e^{h eta}) S = ad(eta) S; differences are exact to h^2 and 1e-16 / h
        by_twist = (pk.se3.ad(twists[:, :, k]) @ arm.screws()[:, :, None])[..., 0]
        np.testing.assert_allclose((more - less) / (2 * h), by_twist, atol=1e-9)


def test_a_sliding_joint_has_two_motions_and_a_screw_keeps_its_pitch():
    chain = pk.load("stanford").chain()
    arm = rounded_arm(chain, Family("meeting", 3, False))
    assert arm.motions().turns.shape[2] == 4 + 4 + 2 + 9
    np.testing.assert_allclose(arm.screws(), chain.screws, atol=1e-15)
    helical = chain.replace(
        screws=[pk.screw.helical([0, 0, 1], [0.1, 0, 0], 0.02), *chain.screws[1:]]
    )
    moved = rounded_arm(helical, Family("meeting", 3, False))
    x = np.full(moved.motions().turns.shape[2], 1e-2)
    new = moved.moved(moved.motions(), x, np.zeros(6)).chain(helical)
    assert new.pitches[0] == pytest.approx(helical.pitches[0], rel=1e-14)
    assert new.kinds == helical.kinds
