"""Solutions that branches lead to: the arm's, each once, by an oracle of its own numbers."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.formulas.inverse import confirmed

ARM = pk.load("puma560").chain()
SIZES = np.append(np.full(6, 2 * np.pi), [ARM.reach, confirmed.OUTSIDE_NEARBY])


def forward(x, T, J):
    T[:], J[:] = ARM.fk_jacobian(x, "hybrid")


def placed(branch, T):
    T[:] = ARM.fk(branch[:6])


def selected(T, branches, forward=forward, placed=placed, sizes=SIZES):
    m = len(sizes) - 2
    q = np.empty((len(branches), m))
    work = np.empty((m + 8, m))
    with np.errstate(all="ignore"):
        n = confirmed.select(forward, placed, T, branches, sizes, np.empty((4, 4)), work, q)
    return q[:n]


def branch(q, margin=0.5):
    return [*q, margin]


def said_at(pose):
    """Poses of branches that are said to be this one, whatever they are."""

    def placed(_, T):
        T[:] = pose

    return placed


class Watched:
    """Forward kinematics that keep where they were asked; `change` what they answer (T, J)."""

    def __init__(self, change=lambda T, J: None):
        self.at = []
        self.change = change

    def __call__(self, x, T, J):
        self.at.append(x.copy())
        forward(x, T, J)
        self.change(T, J)


@pytest.mark.parametrize("seed", range(20))
def test_a_start_nearby_is_led_to_the_solution(seed):
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, 6)
    q[[2, 4]] = (0.8, 1.1)  # the elbow and the wrist are bent
    found = selected(ARM.fk(q), np.array([branch(q + rng.normal(0, 1e-3, 6))]))
    assert len(found) == 1
    least = np.linalg.svd(ARM.jacobian(q, "hybrid"), compute_uv=False)[-1]
    assert np.abs(found[0] - q).max() <= 4e-14 * ARM.reach / least


def test_a_solution_is_listed_once_whatever_turns_it_has():
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    turned = q + np.array([2 * np.pi, 0, 0, -2 * np.pi, 0, 0])
    assert len(selected(ARM.fk(q), np.array([branch(q), branch(turned), branch(q)]))) == 1
    # rounding makes this turn a little less than one
    q[0] = 2.2
    turned = q + 2 * np.pi * np.eye(6)[0]
    assert turned[0] - q[0] < 2 * np.pi
    assert len(selected(ARM.fk(q), np.array([branch(q), branch(turned)]))) == 1


def test_each_solution_is_listed_and_no_other_coordinate_makes_two_alike():
    """The wrist turned over: three coordinates differ, the first ones do not."""
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    over = q * [1, 1, 1, 1, -1, 1] + [0, 0, 0, np.pi, 0, np.pi]
    # of the DH table of a Puma, whose last axes meet
    np.testing.assert_allclose(ARM.fk(over), ARM.fk(q), atol=1e-12)
    found = selected(ARM.fk(q), np.array([branch(q), branch(over), branch(q), branch(over)]))
    np.testing.assert_allclose(found, [q, over], atol=1e-12)


@pytest.mark.parametrize(("apart", "listed"), [(1e-3, 2), (1e-6, 2), (1e-8, 1)])
def test_solutions_that_are_near_each_other_are_told_apart_down_to_1e_7(apart, listed):
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    T = ARM.fk(q)
    # both are said to be at the target, as at an elbow that is nearly straight
    rows = np.array([branch(q), branch(q + apart * np.eye(6)[2])])
    assert len(selected(T, rows, placed=said_at(T))) == listed


@pytest.mark.parametrize(("error", "confirms"), [(8e-10, 1), (1.2e-9, 0)])
def test_a_solution_is_within_1e_9_of_the_target(error, confirms):
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    T = ARM.fk(q)
    T[0, 3] += error * ARM.reach

    def still(T, J):
        J *= 1e30  # no step gets nearer

    assert len(selected(T, np.array([branch(q)]), Watched(still))) == confirms


def test_an_arm_may_have_fewer_joints():
    five = pk.Chain(ARM.screws[:5], ARM.home, frame="space")
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5])

    def forward(x, T, J):
        T[:], J[:] = five.fk_jacobian(x, "hybrid")

    def given(branch, T):
        T[:] = five.fk(branch[:5])

    sizes = np.append(np.full(5, 2 * np.pi), [five.reach, confirmed.OUTSIDE_NEARBY])
    assert five.reach > 0.5
    rows = np.array([branch(q + 1e-3), branch(q, -0.5)])
    (found,) = selected(five.fk(q), rows, forward, given, sizes)
    np.testing.assert_allclose(found, q, atol=1e-12)


def test_a_branch_far_outside_or_of_no_number_is_passed_over():
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    T = ARM.fk(q)
    assert len(selected(T, np.array([branch(q, -0.5), branch(q, np.nan)]))) == 0
    assert len(selected(T, np.array([branch(q, -1e-3)]))) == 1
    assert len(selected(T, np.array([branch(q, -0.5), branch(q)]))) == 1


def test_what_a_rotation_may_miss_is_inside_and_an_arm_nearby_is_given_more():
    # poses are accepted within 1e-5; arms that are calibrated move by some millimetres a metre
    assert 1e-5 < -confirmed.OUTSIDE < 1e-3 < -confirmed.OUTSIDE_NEARBY < 0.1


@pytest.mark.parametrize("more", [0, 1])
def test_a_branch_may_have_more_numbers_before_its_margin(more):
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    T = ARM.fk(q)
    beside = [9.0] * more
    assert len(selected(T, [[*q, *beside, 0.5]])) == 1
    assert len(selected(T, [[*q, *beside, -0.5]])) == 0


@pytest.mark.parametrize("beyond", [0.01, 0.1, 0.3])
def test_out_of_reach_newton_s_rule_ends_without_a_solution(beyond):
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    T = ARM.fk(q)
    farthest = max(np.linalg.norm(ARM.fk(x)[:3, 3]) for x in ARM.random(0, 2000))
    T[:3, 3] *= (1.1 + beyond) * farthest / np.linalg.norm(T[:3, 3])
    asked = Watched()
    assert len(selected(T, np.array([branch(q)]), asked)) == 0
    assert len(asked.at) == 16


def test_a_half_turn_away_is_no_solution():
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    T = ARM.fk(q)
    e = confirmed.pose_error(T @ np.diag([-1.0, -1.0, 1.0, 1.0]), T)
    assert confirmed.size(e, 1.0) > 1.0


@pytest.mark.parametrize(("cosine", "sine"), [(0.0, 1.0), (-0.6, 0.8), (-1.0, 0.0)])
def test_of_a_quarter_turn_and_more_the_tip_is_very_far(cosine, sine):
    T, target = np.eye(4), np.eye(4)
    for k in range(3):  # about x, y and z
        turned = np.ix_([k - 2, k - 1], [k - 2, k - 1])
        target[:3, :3] = np.eye(3)
        target[:3, :3][turned] = [[cosine, -sine], [sine, cosine]]
        assert confirmed.size(confirmed.pose_error(T, target), 1.0) > 1e300
    target[:2, :2] = [[0.28, -0.96], [0.96, 0.28]]
    assert confirmed.pose_error(T, target) == (0.0, 0.0, 0.96, 0.0, 0.0, 0.0)


def test_no_coordinate_goes_farther_than_a_fifth_in_a_step():
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    asked = Watched()
    selected(ARM.fk(q), np.array([branch(q + 0.5 * np.eye(6)[0])]), asked, said_at(np.eye(4)))
    steps = np.abs(np.diff(asked.at, axis=0))
    # half a radian away the first step is one that is shortened
    assert steps[0].max() == pytest.approx(0.2, rel=1e-14)
    assert steps.max() <= 0.2 * (1 + 1e-14)


@pytest.mark.parametrize("spoil", [1.01, -1.0, -0.999999, np.nan, 0.0])
def test_of_what_is_no_pose_there_is_no_solution(spoil):
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    T = ARM.fk(q)
    T[:3, :3] *= spoil
    assert len(selected(T, np.array([branch(q)]))) == 0
    # even where a branch is said to be there
    assert len(selected(T, np.array([branch(q)]), placed=said_at(T))) == 0


def test_a_branch_whose_own_pose_is_the_target_is_taken_as_it_is():
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    rounded = ARM.fk(q)
    rounded[0, 3] += 5e-15 * ARM.reach
    others = (ARM.fk(q + 1e-5), ARM.fk(q + 1e-10))
    # what its pose is said to be decides: of another one Newton's rule is asked
    for poses, calls in ((ARM.fk(q), 0), (rounded, 0), (others[0], 1), (others[1], 1)):
        asked = Watched()
        (found,) = selected(ARM.fk(q), np.array([branch(q)]), asked, said_at(poses))
        assert len(asked.at) == calls
        np.testing.assert_array_equal(found, q)


def test_an_error_of_rounding_ends_the_rule_at_once():
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])

    def rounded(T, J):
        T[0, 3] += 5e-15 * ARM.reach

    asked = Watched(rounded)
    assert len(selected(ARM.fk(q), np.array([branch(q)]), asked, said_at(np.eye(4)))) == 1
    assert len(asked.at) == 1


def test_the_rule_ends_where_errors_within_1e_9_stop_falling_and_keeps_the_least():
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    T = ARM.fk(q)
    T[:3, :3] *= 1.0 + 1e-11  # no rotation: its error stays above rounding
    asked = Watched()
    (found,) = selected(T, np.array([branch(q + 1e-3)]), asked, said_at(np.eye(4)))
    # Newton's rule squares 1e-3 until rounding is met, and one step more tells that it is
    assert len(asked.at) <= 5
    errors = [confirmed.size(confirmed.pose_error(ARM.fk(x), T), ARM.reach) for x in asked.at]
    least = confirmed.size(confirmed.pose_error(ARM.fk(found), T), ARM.reach)
    # squares of 1e-11, which rounding changes by some 1e-5 of them
    assert least == pytest.approx(min(errors), rel=1e-3)


@pytest.mark.parametrize(
    ("share", "off", "most"), [(0.47, 3e-11, 15), (0.48, 1e-9, 16), (0.55, 3e-11, 2)]
)
def test_within_1e_9_the_rule_goes_on_while_a_step_halves_the_error(share, off, most):
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])

    def slower(T, J):
        J /= 1 - share  # which leaves this share of the error

    asked = Watched(slower)
    (found,) = selected(ARM.fk(q), np.array([branch(q + off)]), asked, said_at(np.eye(4)))
    # 0.47 of 1.3e-10, again and again, is 1e-14 after 13 steps, 0.48 of 4e-9 after 18
    assert most - 2 < len(asked.at) <= most
    # a step that has not halved the error, but made it smaller, is kept
    assert most != 2 or np.array_equal(found, asked.at[-1])


def test_a_last_step_that_makes_the_error_larger_is_taken_back():
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    T = ARM.fk(q)
    errors = []

    def farther(Tx, J):
        # never nearer than 1e-11, and once there it is farther
        Tx[0, 3] += 1e-11 * ARM.reach * (1 + (min(errors, default=1.0) < 1e-9))
        errors.append(np.sqrt(confirmed.size(confirmed.pose_error(Tx, T), ARM.reach)))

    asked = Watched(farther)
    (found,) = selected(T, np.array([branch(q + 1e-3)]), asked, said_at(np.eye(4)))
    assert errors[-1] > errors[-2]
    assert not np.array_equal(asked.at[-1], asked.at[-2])
    np.testing.assert_array_equal(found, asked.at[-2])


def test_a_size_is_the_sum_of_six_squares_lengths_by_the_reach():
    e = np.array([2.0, 3.0, 5.0, 7.0, 11.0, 13.0])
    assert confirmed.size(e, 1.0) == 4 + 9 + 25 + 49 + 121 + 169
    assert confirmed.size(e, 0.5) == 4 + 9 + 25 + 4 * (49 + 121 + 169)
