"""Direction in which infinitely many solutions go on from the one that is listed."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.ik_all.all_solutions import AllSolutions

STRAIGHT = [0.1, -0.7, 0.5, 0.3, 0.0, 0.2]
# Rounding of a Jacobian, some 10 u of the reach, and that of a solution, 1e-13 of it by AIM, times
# the slopes of the Jacobian, of the order of the reach: ten times both.
NULL = 1e-12


def arm(name: str) -> pk.Chain:
    robot = pk.load(name)
    tip = {"ur5e": "tool0", "panda": "panda_hand"}.get(name)
    return robot.chain(tip=tip) if tip else robot.chain()


def off(chain: pk.Chain, q: np.ndarray, way: np.ndarray, h: float) -> float:
    """Distance of the poses at q and at q + h n, m and rad together."""
    return float(np.abs(chain.fk(q + h * way) - chain.fk(q)).max())


def check(chain: pk.Chain, found: AllSolutions, row: int) -> None:
    q = found.q[row]
    way = found.self_motion_directions[row]
    assert np.isclose(np.linalg.norm(way), 1.0, rtol=0, atol=1e-14)
    assert np.abs(chain.jacobian(q, frame="hybrid") @ way).max() <= NULL * chain.reach
    # to second order: half as far is a quarter as much, and nothing of it is of first order
    far = off(chain, q, way, 1e-3)
    assert far <= 1e-6 * chain.reach * chain.dof
    assert off(chain, q, way, 5e-4) <= 0.3 * far + NULL * chain.reach


@pytest.mark.parametrize("method", ["auto", "search"])
@pytest.mark.parametrize("name", ["puma560", "ur5e", "irb140"])
def test_it_is_the_null_vector_of_the_jacobian_and_keeps_the_pose_to_second_order(name, method):
    chain = arm(name)
    found = pk.ik_all(chain, chain.fk(STRAIGHT), limits=False, method=method)
    assert found.continuum
    (row,) = found.self_motion_directions
    check(chain, found, row)
    moved = np.abs(found.self_motion_directions[row]) > 1e-6
    assert set(np.array(chain.q_names)[moved]) <= set(found.self_motion_coordinates[0])
    # a planted fault: the direction of another solution's least singular value does move the tool
    others = [q for k, q in enumerate(found.q) if k != row]
    assert others
    for q in others:
        worst = chain.jacobian(q, frame="hybrid") @ found.self_motion_directions[row]
        assert np.abs(worst).max() > 1e-3


def test_of_a_batch_each_continuum_has_one_and_what_stands_alone_none():
    chain = arm("puma560")
    q = chain.random(1, 4)
    q[[1, 3]] = STRAIGHT, [0.4, -0.5, 0.3, 1.0, 0.0, -0.2]
    found = pk.ik_all(chain, chain.fk(q), limits=False)
    assert found.continuum.tolist() == [False, True, False, True]
    owners = [int(found.target_number[row]) for row in found.self_motion_directions]
    assert owners == [1, 3]
    for row in found.self_motion_directions:
        check(chain, found, row)


def test_it_is_in_the_user_s_coordinates_where_these_are_no_joints():
    whole = arm("puma560")
    C = np.eye(6)
    # the last joint turns with the fourth coordinate, which is a motor's: both coordinates go on, in
    # another ratio than the joints
    C[5, 3] = 1.0
    C[:, 3] *= 0.5
    chain = whole.replace(coupling=C, limits=np.tile([-500.0, 500.0], (6, 1)), joint_limits=None)
    q = np.linalg.solve(C, STRAIGHT)
    found = pk.ik_all(chain, chain.fk(q), limits=False)
    assert found.continuum
    (row,) = found.self_motion_directions
    check(chain, found, row)


def test_a_locked_joint_does_not_move():
    chain = arm("panda")
    q = np.array([0.1, -0.5, 0.2, -2.0, 0.3, 1.6, 0.8])
    q[4] = 0.0
    q[2] = 0.0
    q[1] = 0.0
    found = pk.ik_all(chain, chain.fk(q), lock={"panda_joint7": 0.8}, limits=False)
    if not found.continuum:
        pytest.fail("the first and the third axis are one: there are infinitely many")
    for row, way in found.self_motion_directions.items():
        assert way[6] == 0.0
        assert np.abs(chain.jacobian(found.q[row], frame="hybrid") @ way).max() <= NULL


def test_where_there_is_no_continuum_there_is_none_and_a_document_holds_them():
    chain = arm("puma560")
    assert not pk.ik_all(chain, chain.fk(chain.random(0))).self_motion_directions
    found = pk.ik_all(chain, chain.fk(STRAIGHT), limits=False)
    document = found.to_dict()["self_motion_directions"]
    assert isinstance(document, dict)
    ((row, way),) = found.self_motion_directions.items()
    assert document == {str(row): way.tolist()}
    with pytest.raises(InputError):
        found.families(0)
