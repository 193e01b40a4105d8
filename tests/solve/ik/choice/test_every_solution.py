"""Every solution beside a configuration: for which arms and tasks there are all, and their order."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.model import screw
from poekin.solve.ik.choice import every_solution as module
from poekin.solve.ik.choice.every_solution import every_solution
from poekin.solve.ik.ik_problem import Settings, make_problem

GIVEN = Settings("pose", None, True, 1e-9, 1e-9, None, None, 7, 30, 3, False)
UR5 = pk.load("ur5").chain()
PANDA = pk.load("panda").chain(tip="panda_hand")
FIVE = pk.Chain.from_space(UR5.screws[:5], UR5.home, limits=UR5.limits[:5])
EIGHT = pk.Chain.from_space([screw.prismatic([1, 0, 0]), *PANDA.screws], PANDA.home)


def problem(arm, **options):
    return make_problem(arm.compile(), GIVEN._replace(**options))


def test_solutions_are_those_of_ik_all_each_target_s_nearest_first_and_whole_turns_away():
    q = UR5.random(1, 20)
    T = UR5.fk(q)
    near = UR5.random(2, 20)
    T[7] = np.nan
    found = every_solution(problem(UR5), T, near)
    assert found is not None
    places = pk.ik_all(UR5, T, all_revolutions=True)
    assert found.complete.tolist() == [k != 7 for k in range(20)]
    assert not (found.owner == 7).any()
    for k in range(20):
        u = found.u[found.owner == k]
        away = np.linalg.norm(u - near[k], axis=1)
        assert (np.diff(away) >= 0).all()
        least = np.linalg.norm(places.of(k) - near[k], axis=1).min(initial=np.inf)
        assert away[:1].min(initial=np.inf) == pytest.approx(least, abs=1e-9)
        assert len(u) == pk.ik_all(UR5, T[k]).counts


@pytest.mark.parametrize("arm, options, known", [
    (UR5, {}, True), (UR5, {"task": "position"}, False), (UR5, {"task": "direction"}, False),
    (PANDA, {}, False), (PANDA, {"lock": (("panda_joint7", 0.8),)}, True),
    (UR5.replace(pitches=np.full(6, 0.1)), {}, False),
    (FIVE, {}, True), (EIGHT, {}, False),
], ids=["pose", "position", "direction", "seven", "locked", "helical", "five", "eight"])  # fmt: skip
def test_there_are_all_of_a_pose_by_an_arm_of_six_coordinates_that_no_search_is_needed_for(
    arm, options, known, monkeypatch
):
    asked = problem(arm, **options)
    q = arm.random(0, 1)
    q[:, 6:] = 0.8
    if not known:
        monkeypatch.setattr(module, "ik_all", None)
    found = every_solution(asked, arm.fk(q), q)
    assert (found is not None) == known
    if found is not None:
        np.testing.assert_allclose(found.u[0], q[0], atol=1e-6)


def test_limits_and_joint_units_are_the_problem_s():
    degrees = 180 / np.pi
    arm = UR5.replace(limits=[[-1.5, 4.5]] * 6)
    scaled = arm.replace(coupling=np.eye(6) / degrees, limits=arm.limits * degrees)
    q = arm.random(5, 10)
    T = arm.fk(q)
    near = np.full((10, 6), 5.0)
    found = every_solution(problem(arm), T, near)
    same = every_solution(problem(scaled), T, near)
    free = every_solution(problem(arm, limits=False), T, near)
    assert found is not None
    assert same is not None
    assert free is not None
    np.testing.assert_allclose(same.u, found.u, atol=1e-9)
    assert ((found.u >= -1.5) & (found.u <= 4.5)).all()
    assert (np.abs(free.u - near[free.owner]) <= np.pi + 1e-9).all()
    assert len(free.u) > len(found.u)


def test_a_slide_s_coordinate_is_not_turned():
    arm = pk.Chain.from_space(
        [*map(screw.prismatic, np.eye(3)), *(screw.revolute(w, [0, 0, 0]) for w in np.eye(3))],
        pk.se3.exp([0, 0, 0, 0, 0, 0.1]),
        limits=[[-9, 9]] * 6,
    )
    q = np.array([[0.3, -0.2, 0.5, 0.4, 0.5, 0.6]])
    found = every_solution(problem(arm), arm.fk(q), q + np.repeat([7.0, 0.0], 3))
    assert found is not None
    np.testing.assert_allclose(found.u[0], q[0], atol=1e-9)
