"""Effects at the tool are those of one joint alone, as its forward kinematics have them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.planted_changes import CHANGES, arm, planted, random_arm
from poekin.analysis.compare.compare import compare
from poekin.analysis.compare.differences.effects import base_effect
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain


def apart(a, b, q):
    """The largest distance between the tools of two chains."""
    return np.linalg.norm(a.fk(q)[:, :3, 3] - b.fk(q)[:, :3, 3], axis=1).max()


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", ["panda", "random 6a"])
def test_the_effect_of_one_change_is_the_pose_error_as_the_models_stand(change, name):
    chain = arm(name)
    other = planted(chain, change, 2, np.random.default_rng(0))
    result = compare(chain, other, samples=30, seed=4)
    q = chain.random(4, 30)
    effects = [joint.effect for joint in result.joints]
    # Sizes of planted changes are found again to a tenth of a thousandth.
    assert effects[2] == pytest.approx(apart(chain, other, q), rel=1e-4)
    assert effects[:2] + effects[3:] == [0.0] * (chain.dof - 1)
    assert f"{1e3 * effects[2]:.0f}" in result.verdict or effects[2] < 0.01


def test_each_joint_has_its_own_effect():
    chain = random_arm(1)
    rng = np.random.default_rng(0)
    one = planted(chain, "zero", 1, rng)
    other = planted(chain, "flip", 3, rng)
    both = planted(one, "flip", 3, rng)
    result = compare(chain, both, samples=20)
    q = chain.random(0, 20)
    assert result.joints[1].effect == pytest.approx(apart(chain, one, q), rel=1e-6)
    assert result.joints[3].effect == pytest.approx(apart(chain, other, q), rel=1e-6)


def test_a_joint_both_reversed_and_at_another_zero_has_the_effect_of_both():
    chain = random_arm(1)
    rng = np.random.default_rng(0)
    other = planted(planted(chain, "zero", 2, rng), "flip", 2, rng)
    joint = compare(chain, other, samples=20).joints[2]
    assert (joint.reversed, joint.zero_differs) == (True, True)
    assert joint.effect == pytest.approx(apart(chain, other, chain.random(0, 20)), rel=1e-6)


def test_another_kind_has_no_effect_that_could_be_told():
    chain = random_arm(1)
    screws = chain.screws.copy()
    screws[2] = screw.prismatic(screws[2, :3])
    result = compare(chain, Chain.from_space(screws, chain.home), samples=1)
    assert math.isnan(result.joints[2].effect)
    assert "at the tool" not in result.findings[0]
    assert result.to_dict()["joints"][2]["effect"] is None  # type: ignore[index]


def test_another_pitch_has_the_effect_of_the_thread():
    rows = [screw.revolute([0, 0, 1], [0, 0, 0]), screw.revolute([1, 0, 0], [0, 0.2, 0])]
    limits = [[-1.0, 1.0]] * 3
    one, other = (
        Chain.from_space(
            [*rows, screw.helical([0, 1, 0], [0.3, 0, 0], p)], np.eye(4), limits=limits
        )
        for p in (0.02, 0.03)
    )
    result = compare(one, other, samples=50)
    assert result.joints[2].effect == pytest.approx(apart(one, other, one.random(0, 50)), rel=1e-9)


def test_a_moved_base_moves_each_pose_as_it_does():
    rng = np.random.default_rng(0)
    T = se3.exp(rng.normal(size=6))
    poses = se3.exp(rng.normal(size=(5, 6)))
    moved = (T @ poses)[:, :3, 3] - poses[:, :3, 3]
    assert base_effect(T, poses) == pytest.approx(np.linalg.norm(moved, axis=1).max(), rel=1e-14)
    assert base_effect(np.eye(4), poses) == 0.0
