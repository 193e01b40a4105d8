"""Two models side by side: the longer one without the joint that the other has not."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.planted_changes import random_arm
from poekin.analysis.compare.compare import compare
from poekin.analysis.compare.differences.conventions import BUT_NAMES, Asked
from poekin.analysis.compare.differences.matching import leading_signs, matched
from poekin.formats.load import load
from poekin.model import screw
from poekin.model.chain import Chain

ASKED = Asked(BUT_NAMES, False, 1e-5, np.radians(1e-3), samples=5, seed=0)


@pytest.mark.parametrize("longer", ["a", "b"])
def test_alignments_are_weighed_within_the_limits_of_both_models_whichever_is_longer(longer):
    short = random_arm(1, ("revolute",) * 4).replace(limits=np.tile([-0.5, 0.5], (4, 1)))
    extra = screw.revolute([1, 2, 0], [0.1, 0.3, 0.2])
    limits = np.array([[1, 1.1], [2, 2.1], [-3, -2.9], [3, 3.1], [-3.1, -3]])
    long = Chain.from_space(np.insert(short.screws, 2, extra, 0), short.home, limits=limits)
    arms = {"a": short, "b": short} | {longer: long}
    pair = matched(arms["a"], arms["b"], ASKED)
    assert pair is not None
    assert pair.extra == (longer, "joint3")
    for model, x in zip("ab", pair.both, strict=True):
        low, high = (np.delete(limits, 2, 0) if model == longer else short.limits).T
        assert x.shape == (60, 4)
        assert ((low <= x) & (x <= high)).all()


@pytest.mark.parametrize(("longer", "wrist", "end"), [("a", 5, 7), ("b", 4, 6)])
def test_a_joint_has_the_number_that_it_has_in_a_though_one_before_it_is_dropped(
    longer, wrist, end
):
    arm = load("ur5e").chain(tip="tool0")
    extra = screw.revolute([1, 2, 0], [0.1, 0.3, 0.2])
    names = [*arm.joint_names[:2], "extra", *arm.joint_names[2:]]
    long = Chain.from_space(np.insert(arm.screws, 2, extra, 0), arm.home, joint_names=names)

    def compared(k):
        arms = {"a": arm, "b": arm} | {longer: long.rezeroed(0.1 * np.eye(7)[k])}
        return compare(arms["a"], arms["b"], samples=3)

    result = compared(4)
    (joint,) = result.differing
    assert (joint.number, joint.name_a) == (wrist, "wrist_1_joint")
    assert f"; joint {wrist} ('wrist_1_joint') has its zero 5.73° elsewhere" in result.verdict
    assert f"the axis of joint {end} ('wrist_3_joint') is the same" in compared(6).alternatives[0]


def test_a_joint_leads_by_the_sign_of_the_first_coordinate_that_none_before_it_follows():
    C = np.array([[-1, 0, 0], [2, 0, 0], [1, 3, -1], [0, 0, -1], [0, 0, 0]], float)
    assert leading_signs(C).tolist() == [-1, 1, 1, 1, 1]
    assert leading_signs(-C).tolist() == [1, 1, -1, 1, 1]


@pytest.mark.parametrize("chain", [
    random_arm(7, ("revolute", "prismatic", "helical", "revolute")),
    load("ur5e").chain(),
])  # fmt: skip
def test_a_coordinate_that_moves_its_joint_the_other_way_is_a_sign_of_q(chain):
    """And, with the joint's screw reversed beside that, nothing: f(q) is the same."""
    name = chain.joint_names[1]
    backwards = chain.coupled(f"{name} = -{name}")
    for a, b in ((chain, backwards), (backwards, chain)):
        result = compare(a, b, samples=5)
        assert result.outcome == "conventions"
        assert f"joint 2 ({name!r}) has the sign of q flipped" in result.verdict
        assert result.before is not None
        assert result.before.worst_position > 0.01
        assert result.after is not None
        assert result.after.worst_position < 1e-14
        assert [joint.reversed for joint in result.joints].count(True) == 1
        assert not any(any(joint.limits) for joint in result.joints)
    signs = np.where(np.arange(len(chain.screws)) == 1, -1.0, 1.0)[:, None]
    same = chain.replace(
        screws=signs * chain.screws, coupling=np.diag(signs[:, 0]), q_names=chain.q_names
    )
    result = compare(chain, same, samples=5)
    assert result.outcome == "same"
    assert result.before is not None
    assert result.before.worst_position < 1e-14


def test_a_joint_that_the_coordinate_of_another_moves_differs():
    arm = load("ur5e").chain()
    swapped = ["elbow_joint = wrist_1_joint", "wrist_1_joint = elbow_joint"]
    result = compare(arm, arm.coupled(swapped), samples=5)
    assert result.outcome == "differ"
    assert (
        "joint 3 ('elbow_joint') moves by itself in one model and follows 1 × the coordinate of"
        " 'wrist_1_joint' in the other"
    ) in result.verdict
