"""The pitch of a joint is data of the chain: moves and rezeroings keep it, and so the kind, however
far they go.
"""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ScrewError, ShapeError
from poekin.formats import chain_toml
from poekin.formats.text.toml_text import Keys
from poekin.model.joint import Joint
from tests.model.laws.chain_laws import fk_is_the_product_of_exponentials

UR5E = pk.load("ur5e").chain(tip="tool0")


def mixed(pitch: float) -> pk.Chain:
    """A revolute, a helical and a prismatic joint."""
    rows = [
        pk.screw.revolute([1, 2, 3], [0.3, 0, 0.1]),
        pk.screw.helical([0.2, -1, 0.5], [0, 0.4, 0.2], pitch),
        pk.screw.prismatic([1, 1, 0]),
    ]
    return pk.Chain.from_space(rows, pk.se3.exp([0.3, 0.2, 0.1, 1, 2, 3]), pitches=[0, pitch, 0])


@pytest.mark.parametrize("far", [10.0, 1e3, 1e8])
def test_a_chain_that_is_moved_far_away_and_back_keeps_kinds_and_pitches(far):
    rng = np.random.default_rng(0)
    for chain in (UR5E, mixed(0.02), mixed(1e-12)):
        for xi in rng.normal(size=(20, 6)):
            P = pk.se3.exp(xi * [1, 1, 1, far, far, far])
            away = chain.rebased(P).retooled(pk.se3.inverse(P)).rezeroed(rng.normal(size=chain.dof))
            back = away.rebased(pk.se3.inverse(P))
            for moved in (away, back, pickle.loads(pickle.dumps(away))):
                assert moved.kinds == chain.kinds
                assert np.array_equal(moved.pitches, chain.pitches)
                assert np.array_equal(moved.local.slides, chain.local.slides)


@pytest.mark.parametrize("far", [1.0, 1e3])
def test_exact_geometry_has_the_pitches_that_were_given(far):
    leaning = pk.screw.revolute([0, 1e-3, 1], [far, 0, 0])
    rng = np.random.default_rng(2)
    pitches = [0.0, *rng.normal(size=5)]
    rows = [pk.screw.helical(rng.normal(size=3), far * rng.normal(size=3), h) for h in pitches[1:]]
    chain = pk.Chain.from_space([leaning, *rows], np.eye(4), pitches=pitches)
    exact = chain.idealised(0.01)
    assert exact.changes
    assert exact.chain.kinds == chain.kinds
    assert exact.chain.pitches.tolist() == pitches


def test_far_arms_of_large_lengths_keep_their_kinds():
    # 36 to 57 of 60 came back with helical joints.
    rng = np.random.default_rng(1)
    for size in (100.0, 1000.0):
        chain = pk.Chain.from_space(UR5E.screws * [1, 1, 1, size, size, size], UR5E.home)
        for xi in rng.normal(size=(20, 6)):
            P = pk.se3.exp(xi)
            assert set(chain.rebased(P).rebased(pk.se3.inverse(P)).kinds) == {"revolute"}


def test_an_arm_behind_a_joint_of_a_kilometre_is_the_same_arm():
    joints = [
        Joint("mount", "fixed", "world", "base", pk.se3.exp([0, 0, 0, 600, 800, 0])),
        *pk.load("ur5e").joints,
    ]
    far = pk.Robot("far", ["world", *pk.load("ur5e").links], joints).chain(tip="tool0")
    near = far.rebased(pk.se3.exp([0, 0, 0, -600, -800, 0]))
    assert near.kinds == UR5E.kinds
    assert pk.compare(UR5E, near, samples=1).verdict == "the models are the same"


def test_pitches_that_are_given_decide_and_the_screws_are_made_exact():
    S = pk.screw.helical([0, 0, 1], [1, 0, 0], 1e-9)
    found, turned = (
        pk.Chain.from_space([S], np.eye(4)),
        pk.Chain.from_space([S], np.eye(4), pitches=[0]),
    )
    assert (found.kinds, found.pitches) == (("helical",), pytest.approx([1e-9]))
    assert (turned.kinds, turned.pitches.tolist()) == (("revolute",), [0.0])
    assert turned.screws[0].tolist() == [0, 0, 1, 0, -1, 0]
    assert turned.fk([2.0])[2, 3] == 0.0
    fine = pk.Chain.from_space(
        [pk.screw.revolute([0, 0, 1], [1, 0, 0])], np.eye(4), pitches=[1e-18]
    )
    assert (fine.kinds, fine.fk([2.0])[2, 3]) == (("helical",), 2e-18)
    assert fine != turned
    assert pickle.loads(pickle.dumps(fine)) == fine
    assert not fine.pitches.flags.writeable


def test_a_chain_in_a_file_keeps_the_velocity_limits_that_it_has():
    for limits in (None, [np.inf, 2.5, np.inf]):
        chain = UR5E.replace(velocity_limits=limits and limits * 2)
        data = chain_toml.to_data(chain)
        assert ("velocity_limits" in data) == (limits is not None)
        assert chain_toml.to_chain(Keys(data, "file.toml")) == chain


def test_a_chain_in_a_file_keeps_its_pitches():
    for chain in (UR5E, mixed(1e-18).rebased(pk.se3.exp([1, 2, 3, 4, 5, 6]))):
        data = chain_toml.to_data(chain)
        assert ("pitches" in data) == ("helical" in chain.kinds)
        assert chain_toml.to_chain(Keys(data, "file.toml")) == chain


@pytest.mark.parametrize(
    "pitches, error, message",
    [
        ([0, 0], ShapeError, r"pitches: expected shape \(3,\), one number a joint, got \(2,\)"),
        (
            [0, 0, 0.1],
            ScrewError,
            r"pitches\[2\] \(joint 'slide'\): expected 0 for a prismatic joint, .*, got 0\.1",
        ),
        (
            [0, -1e101, 0],
            ScrewError,
            r"pitches\[1\] \(joint 'bolt'\): expected at most 1e\+100 m per rad, got -1e\+101",
        ),
        ([0, np.nan, 0], InputError, r"pitches\[1\]: expected a finite number, got nan"),
    ],
    ids=["too few", "prismatic", "endless", "nan"],
)
def test_pitches_that_make_no_sense_are_refused(pitches, error, message):
    chain = mixed(0.1)
    with pytest.raises(error, match=message):
        pk.Chain.from_space(
            chain.screws, chain.home, joint_names=["turn", "bolt", "slide"], pitches=pitches
        )


def test_the_joints_of_a_robot_say_what_the_pitches_are_however_far_away_they_stand():
    far, back = pk.se3.exp([0.1, 0.2, 0.3, 1e6, 2e6, 0]), pk.se3.exp([0.3, 0, 0, 0, 1e6, 0])
    joints = [
        Joint("mount", "fixed", "a", "b", far),
        Joint("turn", "revolute", "b", "c", back, (1, 2, 3)),
        Joint("bolt", "helical", "c", "d", np.linalg.inv(far @ back), (3, 2, 1), pitch=1e-9),
        Joint("slide", "prismatic", "d", "e", far, (1, 1, 1)),
    ]
    robot = pk.Robot("far", list("abcde"), joints)
    for chain, bolt in ((robot.chain(), 1), (robot.chain(base="e", tip="a"), 1)):
        assert sorted(chain.kinds) == ["helical", "prismatic", "revolute"]
        assert chain.pitches[bolt] == 1e-9


@pytest.mark.parametrize("pitch", [1e-3, 1.0, 1e3, 1e6])
def test_a_pitch_far_beyond_the_reach_is_in_the_bound_of_fk(pitch):
    rng = np.random.default_rng(0)
    for place in rng.normal(size=(10, 3)):
        chain = pk.Chain.from_space(
            [pk.screw.helical([1, 2, 3], place, pitch), UR5E.screws[1]],
            UR5E.home,
            pitches=[pitch, 0],
        )
        fk_is_the_product_of_exponentials(chain, rng.uniform(-20, 20, 2))
        fk_is_the_product_of_exponentials(
            chain.rebased(pk.se3.exp(rng.normal(size=6))), rng.uniform(-20, 20, 2)
        )
