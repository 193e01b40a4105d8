"""Each way to a Jacobian gives the chain's, and takes the columns that it says from the point seen."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

import poekin as pk
from poekin.engine.straight_line import interpret, specialise
from poekin.model import screw
from tests.model.kinematics.test_compiled import near

NAMED = ("space", "body", "hybrid")
WAYS = tuple(product((False, True), repeat=2))


def mixed() -> pk.Chain:
    """Parallel, crossing and skew axes, a slide, and a coordinate that drives two joints."""
    screws = [
        screw.revolute([0, 0, 1], [0.1, 0, 0]),
        screw.revolute([0, 0, 1], [0.5, 0.2, 0]),
        screw.prismatic([0, 0.6, 0.8]),
        screw.revolute([1, 0, 0], [0, 0.3, 0.7]),
        screw.revolute([0.6, 0.8, 0], [0.2, 0, 0.4]),
    ]
    coupling = np.eye(5)[:, :4] + 0.5 * np.eye(5, 4, -1)
    return pk.Chain.from_space(screws, pk.se3.exp([0.3, 0.1, 0.2, 0.5, 0, 0.9]), coupling=coupling)


CHAINS = {"panda": pk.load("panda").chain(tip="panda_hand"), "mixed": mixed()}


@pytest.mark.parametrize("way", WAYS, ids=str)
@pytest.mark.parametrize("name", CHAINS)
def test_each_way_to_a_jacobian_is_the_chain_s(name, way):
    chain = CHAINS[name]
    arm = chain.compile().structure
    q = np.random.default_rng(1).uniform(-2, 2, (5, chain.dof))
    size = np.repeat([1.0, chain.reach], 3 * chain.dof)
    for frame in (*NAMED, *range(len(chain.kinds))):
        T, J = chain.fk_jacobian(q, frame)
        made = specialise._traced(arm, frame, True, *way)
        found = interpret.evaluate(made, q)
        off = np.abs(found[:, 12:] - J.reshape(5, -1)) / size
        assert (off.max(axis=1) <= near(chain, q)).all()
        rotation = np.abs(found[:, :9] - T[:, :3, :3].reshape(5, 9))
        origin = np.abs(found[:, 9:12] - T[:, :3, 3]) / chain.reach
        assert (np.hstack([rotation, origin]).max(axis=1) <= near(chain, q)).all()


@pytest.mark.parametrize("frame", [None, *NAMED, 0, 3, 4], ids=str)
def test_a_program_is_the_cheapest_of_all_ways_of_which_each_is_traced_once(frame, monkeypatch):
    arm = CHAINS["mixed"].compile().structure
    every = [specialise._traced(arm, frame, True, *way) for way in WAYS]
    traced = []

    def noted(*arguments):
        traced.append(whole(*arguments))
        return traced[-1]

    whole = specialise._traced
    monkeypatch.setattr(specialise, "_traced", noted)
    made = specialise.cheapest_program(arm, frame, True)
    assert specialise._cost(made) == min(map(specialise._cost, every))
    # in all frames but a joint's own two of the four ways go one way alone: they are the others
    assert len(traced) == (4 if isinstance(frame, int) else 2)


@pytest.mark.parametrize("inner, outer", WAYS)
def test_columns_are_taken_from_the_point_seen_up_to_the_joint_of_the_frame_and_behind_it(
    inner, outer, monkeypatch
):
    arm = CHAINS["panda"].compile().structure
    seen: set[int] = set()
    whole = specialise.structured.columns_of_axes

    def noted(rows, points, rotates, slides, begin, end, J):
        seen.update(range(begin, end))
        whole(rows, points, rotates, slides, begin, end, J)

    monkeypatch.setattr(specialise.structured, "columns_of_axes", noted)
    for k in range(7):
        seen.clear()
        specialise._traced(arm, k, False, inner, outer)
        assert seen == {i for i in range(7) if (inner if i <= k else outer)}
    for frame, way in (("space", outer), ("hybrid", outer), ("body", inner)):
        seen.clear()
        specialise._traced(arm, frame, False, inner, outer)
        assert len(seen) == 7 * way


@pytest.mark.parametrize("name", CHAINS)
def test_what_is_measured_is_the_pose_and_the_volume_of_the_jacobian_and_costs_least(name):
    chain = CHAINS[name]
    arm = chain.compile().structure
    made = specialise.measured_program(arm)
    q = np.random.default_rng(2).uniform(-2, 2, (5, chain.dof))
    found = interpret.evaluate(made, q)
    T, J = chain.fk_jacobian(q, "hybrid")
    np.testing.assert_allclose(found[:, :9], T[:, :3, :3].reshape(5, 9), rtol=0, atol=1e-14)
    np.testing.assert_allclose(found[:, 9:12], T[:, :3, 3], rtol=0, atol=1e-14)
    across = J.transpose(0, 2, 1)
    square = J @ across if chain.dof >= 6 else across @ J
    # of a determinant of conditions below 1e6
    np.testing.assert_allclose(found[:, 12], np.linalg.det(square), rtol=1e-8)
    if chain.dof < 6:  # it depends on the frame
        assert made == specialise.manipulability_program(arm, "hybrid")
    else:
        named = [specialise.manipulability_program(arm, frame) for frame in NAMED]
        assert specialise._cost(made) < min(map(specialise._cost, named))
