"""Sentences of a comparison name the joints and sizes that they are about."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import poekin as pk
from poekin.analysis import wording
from poekin.analysis.compare import compare
from poekin.analysis.reading import Reading
from poekin.model.chain import Chain

UR = pk.load("ur5e").chain(tip="tool0")


def test_another_link_is_named_by_the_joints_at_both_of_its_ends():
    S = UR.screws.copy()
    S[3:] = (pk.se3.adjoint(pk.se3.exp([0, 0, 0, 0.01, 0.02, 0])) @ S[3:].T).T
    verdict = compare(UR, Chain(S, UR.home, joint_names=UR.joint_names), samples=1).verdict
    names = UR.joint_names
    assert f"the link between joint 3 ('{names[2]}') and joint 4 ('{names[3]}') differs: from joint 4 on" in verdict


@pytest.mark.parametrize(
    "kind, words", [("revolute", "a zero offset of 0.5°"), ("prismatic", "a zero offset of 8.727 mm")]
)
def test_another_reading_says_the_size_of_its_zero_offset(kind, words):
    n, k, zero = 3, 1, np.radians(0.5)
    joint = pk.screw.revolute([0, 0, 1], [0, 0, 0]) if kind == "revolute" else pk.screw.prismatic([0, 0, 1])
    chain = Chain([pk.screw.revolute([1, 0, 0], [0, 0, 0]), joint, pk.screw.revolute([0, 1, 0], [0, 0, 0])], np.eye(4))
    marks, ones = np.zeros(n, bool), np.ones(n)
    same = Reading(np.eye(4), np.eye(4), np.zeros(n), ones, marks, marks, chain.screws, np.zeros(n), 0)
    other = replace(same, zeros=zero * (np.arange(n) == k), offset=np.arange(n) == k)
    (sentence,) = wording.equivalents(chain, chain, same, [other], 1e-5, 1e-5)
    assert sentence.startswith(f"{words} of joint 2 ('joint2'), ")
