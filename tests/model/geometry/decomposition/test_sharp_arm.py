"""The completion of an arm that is chosen: of the arm's own poses it knows the joints."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.model.geometry.decomposition import sharp_arm as module
from poekin.model.geometry.decomposition.sharp_arm import branch_rows, sharp_arm


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("ur5e", "axes 2, 3 and 4 are parallel"),
        ("puma560", "spherical wrist: axes 4, 5 and 6 meet"),
        ("stanford", "spherical wrist: axes 4, 5 and 6 meet"),
    ],
)
def test_the_joints_of_a_pose_are_among_its_branches(name, words):
    chain = pk.load(name).chain()
    found = sharp_arm(chain)
    assert found is not None
    assert found.words == words
    q = np.random.default_rng(2).uniform(-1.0, 1.0, (50, 6))
    branches = branch_rows(found.arm, 6, chain.fk(q))
    margins = branches[:, :, 6]
    off = np.abs((branches[:, :, :6] - q[:, None] + np.pi) % (2 * np.pi) - np.pi).max(axis=2)
    best = np.where(np.isnan(off), np.inf, off).argmin(axis=1)
    at = np.arange(len(q))
    assert off[at, best].max() <= 1e-8
    assert margins[at, best].min() >= -1e-9


def test_arms_are_tried_all_around_where_they_turn_and_within_half_the_reach_where_they_slide():
    chain = pk.load("stanford").chain()
    q, T = module._known(chain)
    slides = np.array([kind == "prismatic" for kind in chain.kinds])
    assert slides.any()
    assert np.abs(q[:, slides]).max() <= chain.reach / 2
    assert np.abs(q[:, ~slides]).max() > chain.reach / 2
    assert np.abs(q[:, ~slides]).max() <= np.pi
    np.testing.assert_array_equal(T, chain.fk(q))


@pytest.mark.parametrize("by", [1e-9, 1e-6])
def test_an_arm_that_is_not_exact_has_none(by):
    whole = pk.load("ur5e").chain()
    tilt = pk.se3.adjoint(pk.se3.exp([by, -by, 0.0, 0.0, 0.0, 0.0]))
    screws = [*whole.screws[:2], tilt @ whole.screws[2], *whole.screws[3:]]
    assert sharp_arm(pk.Chain.from_space(screws, whole.home)) is None


@pytest.mark.parametrize(
    ("errors", "taken"),
    [
        ([1e-8, 1e-9, 1e-7], 1),
        ([1e-8, 2e-8, 1e-12, 1e-13], 2),
        ([1e-12, 1e-13], 0),
        ([np.inf, 2e-6, 5e-7], 2),
        ([2e-6, np.inf], None),
    ],
)
def test_else_the_sharpest_completion_is_taken_unless_none_finds_the_joints(
    monkeypatch, errors, taken
):
    chain = pk.Chain.from_space(pk.load("ur5").chain().screws[:5], np.eye(4))
    arms = []

    def error(arm, q, T):
        arms.append(arm)
        return errors[len(arms) - 1] if len(arms) <= len(errors) else np.inf

    monkeypatch.setattr(module, "_error", error)
    found = sharp_arm(chain)
    assert (found is None) == (taken is None)
    if found is not None:
        assert found.arm is arms[taken]


def test_the_first_completion_that_is_sharp_is_taken(monkeypatch):
    chain = pk.load("puma560").chain()
    asked = []
    whole = module.branch_rows

    def counted(*given):
        asked.append(given)
        return whole(*given)

    monkeypatch.setattr(module, "branch_rows", counted)
    assert sharp_arm(chain) is not None
    assert len(asked) == 1
