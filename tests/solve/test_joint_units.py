"""The unit of a coordinate changes nothing but its numbers: every solver works with the joints."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.ik.ik import ik
from poekin.solve.ik_all.ik_all import ik_all
from poekin.solve.joint_units import MOST_TURNS, has_sums, joint_units, period
from poekin.solve.path.follow import follow

UR5E = pk.load("ur5e").chain(tip="tool0")
PANDA = pk.load("panda").chain(tip="panda_hand")
SCALES = {
    "degrees": 180 / np.pi,
    "hundredths": 100.0,
    "thousands": 1e-3,
    "gears": np.array([10.0, -100.0, 1e4, 1e-3, -1.0, 3.3, 50.0]),
}
"""How many units of a coordinate are 1 rad of its joint."""


def geared(arm: pk.Chain, scale: float | np.ndarray) -> tuple[pk.Chain, np.ndarray]:
    """The same arm with coordinates q = scale x, and the scale of each of them."""
    sizes = np.broadcast_to(scale, (7,))[: arm.dof] if np.ndim(scale) else np.full(arm.dof, scale)
    limits = np.sort(arm.limits * sizes[:, None], axis=1)
    C = arm.coupling / sizes
    return pk.Chain.from_space(
        arm.screws, arm.home, coupling=C, offset=arm.offset, q_names=arm.q_names, limits=limits
    ), sizes


def coupled() -> pk.Chain:
    """A turning joint that goes half as fast as another one, and a slide."""
    C = np.eye(7)[:, :6]
    C[6, 3] = -0.5
    home = pk.se3.exp([0.1, 0.2, 0.3, 0.5, 0, 0.8])
    limits = [[-3, 3], [-3, 2], [-2, 2], [-2, 2], [-0.4, 0.5], [-2, 2]]
    axes = [*UR5E.screws[:4], pk.screw.prismatic([0, 0.6, 0.8]), *UR5E.screws[4:]]
    return pk.Chain.from_space(axes, home, coupling=C, q_names=list("abcdef"), limits=limits)


def test_coordinates_in_the_units_of_their_joints_need_no_scale():
    assert joint_units(UR5E.compile()).scale is None
    assert joint_units(coupled().compile()).scale is None


ARMS = {"ur5e": UR5E, "panda": PANDA, "coupled": coupled()}


@pytest.fixture(params=SCALES)
def scale(request):
    return SCALES[request.param]


@pytest.mark.parametrize("options", [{}, {"limits": False}, {"task": "direction"}], ids=str)
@pytest.mark.parametrize("name", ARMS)
def test_ik_finds_the_same_joints_in_every_unit(name, options, scale):
    arm = ARMS[name]
    other, sizes = geared(arm, scale)
    T = arm.fk(arm.random(1, 20))
    T[0, :3, 3] *= 50
    expected, found = ik(arm, T, **options), ik(other, T, **options)
    np.testing.assert_allclose(found.q[1:] / sizes, expected.q[1:], rtol=0, atol=1e-6)
    np.testing.assert_array_equal(found.reason, expected.reason)
    np.testing.assert_array_equal(found.iterations[1:], expected.iterations[1:])
    assert found.limits_hit == expected.limits_hit
    lower, upper = other.limits.T
    assert options or ((found.q >= lower) & (found.q <= upper)).all()
    at = other.fk(found.q[found.success])
    assert np.linalg.norm((at - T[found.success])[:, :3, 3], axis=1).max() <= 1e-9 + 1e-14


def test_the_target_of_the_report_is_reached_in_degrees():
    deg = pk.Chain.from_space(
        UR5E.screws,
        UR5E.home,
        coupling=np.eye(6) * np.pi / 180,
        q_names=list("abcdef"),
        limits=[[-360, 360]] * 6,
    )
    q = [10.0, -80, 100, -20, 60, 30]
    T = deg.fk(q)
    assert ik(deg, T).success
    for method in ("auto", "search"):
        solutions = ik_all(deg, T, method=method).solutions
        assert len(solutions) == 8
        assert np.abs(solutions - q).max(axis=1).min() <= 1e-4


@pytest.mark.parametrize("name", ["ur5e", "panda"])
def test_a_secondary_aim_and_the_nearest_are_the_same_in_every_unit(name, scale):
    arm = ARMS[name]
    other, sizes = geared(arm, scale)
    T, q0 = arm.fk(arm.random(2, 8)), arm.random(3, 8)
    near, task = arm.random(4, 8), "pose" if arm is PANDA else "position"
    expected, found = ik(arm, T, nearest_to=near), ik(other, T, nearest_to=near * sizes)
    np.testing.assert_allclose(found.q / sizes, expected.q, rtol=0, atol=1e-6)
    for aim in ("middle", "nearest", "manipulability"):
        expected = ik(arm, T, q0=q0, secondary_objective=aim, task=task)
        found = ik(other, T, q0=q0 * sizes, secondary_objective=aim, task=task)
        np.testing.assert_allclose(found.q / sizes, expected.q, rtol=0, atol=1e-4)


def test_a_locked_coordinate_keeps_its_value_to_the_last_digit_in_every_unit(scale):
    other, sizes = geared(PANDA, scale)
    T, value = PANDA.fk(PANDA.random(8, 10)), 0.3 * float(sizes[2])
    found = ik(other, T, lock={PANDA.q_names[2]: value})
    assert found.success.any()
    assert (found.q[:, 2] == value).all()
    far = float(10 * np.abs(sizes[2]))
    with pytest.raises(pk.errors.InputError, match=r"expected a number within \[-"):
        ik(other, T, lock={PANDA.q_names[2]: far})


def test_what_is_at_a_limit_is_within_it_in_every_unit(scale):
    q = np.array([0.3, -0.5, 0.2, -1.5, 0.4, 1.0, 0.1])
    tight = pk.Chain.from_space(
        PANDA.screws, PANDA.home, limits=np.stack([q - 0.17, q + 0.13], axis=1)
    )
    other, _ = geared(tight, scale)
    found = ik(other, PANDA.fk(PANDA.random(3, 60)), restarts=2)
    lower, upper = other.limits.T
    assert ((found.q >= lower) & (found.q <= upper)).all()
    assert ((found.q == lower) | (found.q == upper)).any()


def test_of_a_bad_target_not_even_a_locked_coordinate_is_known(scale):
    other, sizes = geared(PANDA, scale)
    T = PANDA.fk(PANDA.random(8, 2))
    T[1, 0, 0] = np.nan
    found = ik(other, T, lock={PANDA.q_names[2]: 0.3 * float(sizes[2])})
    assert np.isnan(found.q[1]).all()
    assert not np.isnan(found.q[0]).any()


@pytest.mark.parametrize("method", ["auto", "search"])
@pytest.mark.parametrize("name", ["ur5e", "coupled"])
def test_ik_all_lists_the_same_solutions_in_every_unit(name, method, scale):
    arm = ARMS[name]
    other, sizes = geared(arm, scale)
    T = arm.fk(arm.random(5, 3))
    for copies in (False, True):
        expected, found = (
            ik_all(a, T, method=method, all_revolutions=copies) for a in (arm, other)
        )
        assert found.method == expected.method
        for k in range(3):
            a, b = expected.solutions[k], found.solutions[k] / sizes
            assert len(a) == len(b) >= 1
            np.testing.assert_allclose(
                b[np.lexsort(np.round(b, 5).T)], a[np.lexsort(np.round(a, 5).T)], rtol=0, atol=1e-6
            )
            q = np.round(found.solutions[k] * np.abs(1 / sizes), 9)
            assert [*map(tuple, q)] == sorted(map(tuple, q))
            assert sorted(found.n_revolutions[k]) == sorted(expected.n_revolutions[k])


def test_follow_goes_the_same_way_in_every_unit(scale):
    other, sizes = geared(PANDA, scale)
    q = np.array([0, -0.5, 0, -2.0, 0, 1.6, 0.8]) + np.linspace(0, 0.4, 50)[:, None] * np.cos(
        np.arange(7)
    )
    T = PANDA.fk(q)
    for start in (None, q[0]):
        expected = follow(PANDA, T, q0=start)
        found = follow(other, T, q0=None if start is None else start * sizes)
        np.testing.assert_allclose(found.q / sizes, expected.q, rtol=0, atol=1e-6)
        assert found.branch_switches == expected.branch_switches
        np.testing.assert_allclose(found.inverse_condition, expected.inverse_condition, rtol=1e-3)
        assert found.ok
    steps = follow(other, T, q0=q[0] * sizes, max_step=0.1 * np.abs(sizes))
    np.testing.assert_array_equal(steps.q, follow(other, T, q0=q[0] * sizes, max_step=0.1).q)


@pytest.mark.parametrize("start", [None, [1.0, -1.0, 0.0]], ids=["free", "q0"])
def test_follow_changes_its_branch_and_comes_as_near_in_every_unit(start, scale):
    # two links in a plane and a lift: bent one way the shoulder's limit is in the way, and the end
    # is out of reach
    axes = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0, 1)]
    limits = [[-0.2, 3.0], [-2.5, 2.5], [-1, 1]]
    arm = pk.Chain.from_space(
        [*axes, pk.screw.prismatic([0, 0, 1])], pk.se3.exp([0, 0, 0, 2, 0, 0]), limits=limits
    )
    other, sizes = geared(arm, scale)
    T = arm.fk(np.linspace([0.0, 1.0, 0.0], [2.9, 1.0, 0.0], 60))
    T[50:, :3, 3] += np.linspace(0, 1, 10)[:, None] * [-1.0, 0, 0]
    q0 = None if start is None else np.array(start)
    expected = follow(arm, T, q0=q0, task="position")
    found = follow(other, T, q0=None if q0 is None else q0 * sizes, task="position")
    assert found.branch_switches == expected.branch_switches
    assert bool(found.branch_switches) == (start is not None)
    np.testing.assert_array_equal(found.reason, expected.reason)
    assert set(found.reason) == {"solved", "unreachable"}
    np.testing.assert_allclose(found.q / sizes, expected.q, rtol=0, atol=1e-6)


@pytest.mark.parametrize("ratios, turns", [
    ([1.0], 1), ([-1.0], 1), ([1.0, -0.5], 2), ([1 / 3, 1.0], 3), ([1.0, 0.5, 1 / 3], 6),
    ([1.0, 0.3333], 0), ([1.0, 1 / (MOST_TURNS + 1)], 0), ([1.0, 1 / MOST_TURNS], MOST_TURNS), ([2.0, 4.0], 2),
])  # fmt: skip
def test_the_period_of_a_coordinate_brings_every_joint_back(ratios, turns):
    axes = [pk.screw.revolute([0, 0, 1], [0.3 * k, 0, 0]) for k in range(len(ratios))]
    for unit in (1.0, np.pi / 180, 1e4):
        arm = pk.Chain.from_space(
            axes, np.eye(4), coupling=np.array([ratios]).T * unit, q_names=["a"]
        )
        units = joint_units(arm.compile())
        found = period(units.fast.chain, 0)
        assert found == pytest.approx(2 * np.pi * turns, abs=1e-12)
        if turns:
            q = found / (1.0 if units.scale is None else units.scale)
            np.testing.assert_allclose(arm.fk(np.ravel(q)), arm.home, rtol=0, atol=1e-13)


def test_a_coordinate_that_slides_or_screws_has_no_period():
    for joint in (pk.screw.prismatic([0, 0, 1]), pk.screw.helical([0, 0, 1], [0, 0, 0], 0.1)):
        assert period(pk.Chain.from_space([joint], np.eye(4)), 0) == 0


@pytest.mark.parametrize("unit", [1.0, 100.0])
def test_a_joint_that_turns_half_as_fast_is_told_apart_over_both_its_turns(unit):
    axes = [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.revolute([1, 0, 0], [0, 0.4, 0])]
    home = pk.se3.exp([0, 0, 0, 0.1, 0.7, 0.2])
    arm = pk.Chain.from_space(axes, home, coupling=np.array([[1.0], [0.5]]) * unit, q_names=["a"])
    for x in (-5.0, 1.0, 5.0):  # of ±2 pi: outside ±pi there are others
        np.testing.assert_allclose(
            ik_all(arm, arm.fk([x / unit])).solutions, [[x / unit]], rtol=1e-9
        )


def test_of_a_bad_target_among_others_the_locked_coordinate_is_unknown_too():
    arm, sizes = geared(PANDA, 180 / np.pi)
    T = arm.fk(arm.random(2, 5))
    T[3] = np.nan
    name, value = arm.q_names[2], 0.25 * sizes[2]
    found = ik(arm, T, lock={name: value}, restarts=0)
    assert np.isnan(found.q[3]).all()
    assert found.q[[0, 1, 2, 4], 2].tolist() == [value] * 4


@pytest.mark.parametrize(
    ("gear", "turns"), [(1.0, 1), (0.5, 2), (1 / 12, 12), (5 / 12, 12), (1 / 13, 0), (2**-0.5, 0)]
)
def test_a_period_is_of_up_to_twelve_turns_of_the_fastest_joint(gear, turns):
    axes = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0, 1)]
    chain = pk.Chain.from_space(axes, np.eye(4), coupling=[[1.0], [gear]])
    assert period(chain, 0) == pytest.approx(2 * np.pi * turns, rel=1e-15)


@pytest.mark.parametrize("gear", [1.0, -0.5])
@pytest.mark.parametrize("axis", [[1.0, 0, 0], [-1.0, 0, 0]])
def test_a_coordinate_that_slides_a_joint_too_has_no_period(gear, axis):
    chain = pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic(axis)], np.eye(4),
                     coupling=[[1.0], [gear]])  # fmt: skip
    assert period(chain, 0) == 0


@pytest.mark.parametrize(
    ("coupling", "are_sums"),
    [
        ([[2.0, 0.0], [0.0, -1.0]], False),
        ([[1.0, 0.0], [1.0, 1.0]], True),
        ([[1.0, 1.0], [1.0, 1.0]], False),  # which do not determine the coordinates
        ([[1.0, 1.0, 0.0], [0.0, 0.0, 1.0]], False),
    ],
)
def test_joints_are_sums_where_one_has_two_coordinates_and_these_follow_from_the_joints(
    coupling, are_sums
):
    screws = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 1.0)]
    chain = pk.Chain.from_space(screws, np.eye(4), coupling=coupling)
    assert has_sums(chain) == are_sums


def test_joints_that_are_sums_are_the_coordinates_unless_some_are_locked():
    screws = [pk.screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in (0, 1)]
    sums = np.array([[1.0, 0.0], [0.5, 2.0]])
    chain = pk.Chain.from_space(
        screws, np.eye(4), coupling=sums, q_names=["a", "b"], joint_limits=[[-1, 1], [-1, 1]]
    )
    fast = chain.compile()
    np.testing.assert_array_equal(np.asarray(joint_units(fast).scale), sums)
    np.testing.assert_array_equal(np.asarray(joint_units(fast, locked=True).scale), np.diag([1, 2]))
    assert joint_units(fast).fast.chain.q_names == chain.joint_names
