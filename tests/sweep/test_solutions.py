"""The best solution of each pose, and arms that have none to choose from."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import Cells, PoseGrid, PoseSamples, SelfCollision, Sweep
from poekin.sweep.measures.names import measure_of
from poekin.sweep.solutions import best_solutions
from tests.messages import says
from tests.sweep.arms import two_links

ROBOT = pk.load("ur5e")
ARM = ROBOT.chain(tip="tool0")
CELLS = Cells.box([-1] * 3, [1] * 3, 1.0)
T = PoseSamples.random([-0.6, -0.6, -0.2], [0.6, 0.6, 0.8], 300, seed=1).poses(np.arange(300))
EVERY = pk.ik_all(ARM, T)
# limits that are not symmetric, and an elbow that turns less than once
NARROW = ARM.replace(limits=[[-4, 1], [-6, 6], [-3, 3], [-np.inf, np.inf], [-1, 6], [0, 6]])
LENGTH = 0.3
SHOULDER, WRIST = "upper_arm_link", "wrist_3_link"


def yoshikawa(chain, q):
    return pk.manipulability(chain, q).pose.yoshikawa


def inverse_condition(chain, q):
    J = chain.jacobian(q, frame="hybrid") / np.array([1, 1, 1, LENGTH, LENGTH, LENGTH])[:, None]
    lengths = np.linalg.svd(J, compute_uv=False)
    return lengths[:, -1] / lengths[:, 0]


@pytest.mark.parametrize(
    ("measure", "own"),
    [
        (measure_of("manipulability"), yoshikawa),
        (pk.sweep.InverseCondition(LENGTH), inverse_condition),
    ],
    ids=lambda x: getattr(x, "name", None),
)
def test_the_measure_of_a_pose_is_that_of_its_best_solution(measure, own):
    found = best_solutions(ARM, T, measure, None)
    q = found.configurations()
    start = 0
    for k, count in enumerate(EVERY.counts):
        every = EVERY.q[start : start + count]
        start += count
        if not count:
            assert np.isnan(found.values[k])
            assert np.isnan(q[k]).all()
            continue
        # the root of a determinant that is right to some 1e-13
        assert found.values[k] == pytest.approx(own(ARM, every).max(), abs=1e-6)
        assert own(ARM, q[k : k + 1])[0] == pytest.approx(found.values[k], abs=1e-6)
        assert (every == q[k]).all(axis=1).any()
    assert 0 < np.isnan(found.values).sum() < len(T)


def test_a_count_is_that_of_all_solutions_within_the_limits():
    for chain in (ARM, NARROW):
        found = best_solutions(chain, T, measure_of("solutions"), None)
        counts = pk.ik_all(chain, T).counts
        np.testing.assert_array_equal(np.nan_to_num(found.values), counts)


def turned_everywhere(chain, T):
    """All solutions with all their whole turns within the limits, by ik_all."""
    wide = np.where(np.isfinite(chain.limits), chain.limits, [-30.0, 30.0])
    return pk.ik_all(chain.replace(limits=wide), T, all_revolutions=True)


@pytest.mark.parametrize("chain", [ARM, NARROW], ids=["whole turns", "narrow"])
@pytest.mark.parametrize("name", ["limit_margin", "travel"])
def test_whole_turns_are_those_with_the_best_measure(chain, name):
    few = T[:60]
    reference = (2.0, -3.0, 1.0, 14.0, 2.0, 6.0)
    measure = measure_of(name) if name == "limit_margin" else pk.sweep.JointTravel(reference)
    found = best_solutions(chain, few, measure, None)
    every = turned_everywhere(chain, few)
    start = 0
    for value, count in zip(found.values, every.counts, strict=True):
        q = every.q[start : start + count]
        start += count
        if not count:
            assert np.isnan(value)
            continue
        if name == "travel":
            best = np.abs(q - reference).max(axis=1).min()
        else:
            lower, upper = chain.limits.T
            with np.errstate(invalid="ignore"):
                margins = 2 * np.minimum(q - lower, upper - q) / (upper - lower)
            best = np.where(np.isfinite(margins), margins, np.inf).min(axis=1).max()
        # both solve to 1e-10 rad of the target, of a Jacobian whose inverse is below 1e4 here
        assert value == pytest.approx(best, abs=1e-6)
    q = found.configurations()
    reached = ~np.isnan(q[:, 0])
    slack = 1e-12
    assert (q[reached] >= chain.limits[:, 0] - slack).all()
    assert (q[reached] <= chain.limits[:, 1] + slack).all()
    np.testing.assert_allclose(chain.fk(q[reached]), few[reached], atol=1e-9)


def test_solutions_in_which_spheres_touch_are_none():
    spheres = [(SHOULDER, (0, 0, 0.13), 0.1), (WRIST, (0, 0, 0), 0.35)]
    mask = SelfCollision.of_spheres(ROBOT, ARM, spheres)
    count = measure_of("solutions")
    found = best_solutions(ARM, T, count, mask)
    start = 0
    for k, all_of_it in enumerate(EVERY.counts):
        q = EVERY.q[start : start + all_of_it]
        start += all_of_it
        free = touches_not(q) if all_of_it else np.zeros(0, bool)
        np.testing.assert_equal(found.values[k], free.sum() or np.nan)
    plain = best_solutions(ARM, T, count, None)
    assert np.nansum(found.values) < np.nansum(plain.values)


def touches_not(q):
    """Whether the two spheres are apart, by the poses of their links."""
    apart = np.empty(len(q), bool)
    for k, row in enumerate(q):
        poses = ROBOT.fk(dict(zip(ARM.q_names, row, strict=True)))
        p = (poses[SHOULDER] @ [0, 0, 0.13, 1])[:3]
        apart[k] = np.linalg.norm(p - poses[WRIST][:3, 3]) > 0.45
    return apart


def helical():
    """Six joints of which one is helical, so that only a search solves them."""
    axes = [pk.screw.helical([0, 0, 1], [0, 0, 0], 0.1), *ARM.screws[1:]]
    return pk.Chain(np.array(axes), ARM.home, frame="space", limits=[[-3, 3]] * 6)


@pytest.mark.parametrize(
    ("chain", "words"),
    [
        (
            pk.load("panda").chain(tip="panda_hand"),
            "sweep of poses: expected an arm of up to six coordinates, got 7: a pose has infinitely "
            "many solutions; samples of configurations map any arm",
        ),
        (
            helical(),
            f"sweep of poses: {helical()!r} is solved neither in closed form nor by elimination, and a "
            "search of each pose takes milliseconds; samples of configurations map any arm",
        ),
    ],
    ids=["seven", "helical"],
)
def test_arms_whose_solutions_are_not_known_one_by_one_are_refused(chain, words):
    with pytest.raises(InputError) as caught:
        Sweep(chain, PoseGrid.of(CELLS), CELLS)
    assert says(caught.value, words)


@pytest.mark.parametrize("joints", [1, 3, 5])
def test_an_arm_of_fewer_than_six_joints_whose_solutions_are_known_is_taken(joints):
    whole = pk.load("ur5e").chain()
    arm = pk.Chain.from_space(whole.screws[:joints], whole.home)
    assert Sweep(arm, PoseGrid.of(CELLS), CELLS).chain.dof == joints


def test_a_number_of_solutions_is_asked_of_poses_alone():
    samples = pk.sweep.Random.of(two_links(), 5)
    with pytest.raises(InputError) as caught:
        Sweep(two_links(), samples, CELLS, "solutions")
    assert says(
        caught.value, "measure 'solutions': expected samples of poses, PoseSamples or PoseGrid"
    )
