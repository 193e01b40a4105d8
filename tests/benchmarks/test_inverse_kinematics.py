"""The page on inverse kinematics: what a solver says about itself is not believed, and each peer is
asked rightly.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import poekin as pk
from benchmarks import peers
from benchmarks.cases import inverse_kinematics as topic
from benchmarks.cases import inverse_kinematics_arms as arms
from benchmarks.cases import inverse_kinematics_list as named_list
from benchmarks.cases import inverse_kinematics_peers as ik_peers
from benchmarks.cases import inverse_kinematics_reasons as reasons
from benchmarks.cases.inverse_kinematics_judge import Judgement, judged
from benchmarks.cases.inverse_kinematics_rows import peer_row
from benchmarks.page import html, markdown
from poekin.solve.ik.ik import ik
from tests.versions import needs

UR5 = pk.load("ur5").chain()
ABOUT = {"when": "now", "commit": "c", "processor": "p", "cores": 2, "load": 0.0, "system": "s", "python": "3",
         "versions": {}}  # fmt: skip


def reachable(chain: pk.Chain, count: int) -> tuple[np.ndarray, np.ndarray]:
    q = chain.random(np.random.default_rng(0), count)
    return q, chain.fk(q)


def judgement_of(solution, chain, T) -> Judgement:  # type: ignore[no-untyped-def]
    return judged(chain, T, solution.q, solution.success)


def usable(name: str) -> None:
    (found,) = peers.find([ik_peers.EAIK if name == "eaik" else peers.STANDARD[name]])
    if found.problem:
        pytest.skip(f"{name} is {found.problem}")


@pytest.mark.parametrize("size", [2e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("part", ["position", "rotation"])
def test_the_judge_sees_an_error_of_its_true_size(part, size):
    q, T = reachable(UR5, 5)
    if part == "position":
        T[2, :3, 3] += size * np.array([0.6, 0.0, 0.8])
    else:
        T[2, :3, :3] = T[2, :3, :3] @ pk.so3.exp([0.0, size, 0.0])
    found = judged(UR5, T, q, np.ones(5, bool))
    assert found.solved.tolist() == [True, True, False, True, True]
    assert found.false_claims == 1
    # fk rounds at 1e-15, a millionth of the smallest size.
    assert getattr(found, part)[2] == pytest.approx(size, rel=1e-6)


def test_of_a_direction_a_turn_about_it_is_no_error_and_any_other_is():
    q, T = reachable(UR5, 2)
    T[0, :3, :3] = T[0, :3, :3] @ pk.so3.exp([0.0, 0.0, 1.0])
    T[1, :3, :3] = T[1, :3, :3] @ pk.so3.exp([1e-6, 0.0, 0.0])
    found = judged(UR5, T, q, np.ones(2, bool), axis=np.array([0.0, 0.0, 1.0]))
    assert found.solved.tolist() == [True, False]
    assert found.rotation[1] == pytest.approx(1e-6, rel=1e-6)


def test_joints_outside_the_limits_are_no_solution_and_no_joints_are_none():
    q, T = reachable(UR5, 3)
    q[0, 2] += 2 * np.pi * np.sign(-q[0, 2]) * 2
    q[1] = np.nan
    found = judged(UR5, T, q, np.array([True, True, False]))
    assert found.solved.tolist() == [False, False, False]
    assert found.false_claims == 2
    assert judged(UR5, T, q, np.ones(3, bool), limits=False).solved.tolist() == [True, False, True]


def liar(chain, T, **options):  # type: ignore[no-untyped-def]
    """Its joints are a micrometre and more off, and it says: solved, without error."""
    found = ik(chain, T, **options)
    zero = np.zeros_like(found.position_error)
    return replace(found, q=found.q + 1e-6, success=np.ones_like(found.success), position_error=zero,
                   rotation_error=zero)  # fmt: skip


def modest(chain, T, **options):  # type: ignore[no-untyped-def]
    """It solves, and does not say so, and always blames the limits."""
    found = ik(chain, T, **options)
    return replace(
        found, success=np.zeros_like(found.success), reason=np.full_like(found.reason, "limits")
    )


def page_of(solve, monkeypatch):  # type: ignore[no-untyped-def]
    """The topic on few targets and two arms, one of five joints, with a solver planted."""
    list_of_two = [
        arm
        for arm in arms.named_arms()
        if arm.name in ("so101 → gripper_link", "puma560 (catalogue)")
    ]
    monkeypatch.setattr(named_list, "named_arms", lambda: list_of_two)
    for name in ("TARGETS", "LIST_TARGETS", "WITHOUT"):
        monkeypatch.setattr(topic, name, 400)
    monkeypatch.setattr(
        topic, "in_turn", lambda cases, rounds: in_turn(cases, rounds=1, slice_s=0.0)
    )
    return topic.topic(True, lambda _: None, solve)


in_turn = topic.in_turn


def verdicts(page, words: str) -> list[bool | None]:  # type: ignore[no-untyped-def]
    found = [figure.verdict for figure in page.figures if words in figure.what]
    assert found
    return found


def test_the_page_of_the_true_solver_claims_nothing_false_and_holds_what_time_does_not_decide(
    monkeypatch,
):
    page = page_of(ik, monkeypatch)
    for words in (
        "solved to 1e-9",
        "the arm with the fewest",
        "beyond the reach bound",
        "bear out",
    ):
        assert all(verdicts(page, words)), words
    text = html([page], ABOUT, 1.0) + markdown([page], ABOUT, 1.0)
    assert all(
        name in text for name in ("so101", "puma560", "Robotics Toolbox", "Pinocchio", "EAIK")
    )
    assert "Traceback" not in text


def test_a_solver_that_lies_is_caught_in_every_figure_of_truth(monkeypatch):
    needs("roboticstoolbox-python", "1.5")  # whose time its own stands beside
    page = page_of(liar, monkeypatch)
    for words in ("solved to 1e-9", "the arm with the fewest", "success claimed", "bear out"):
        assert not any(verdicts(page, words)), words
    (lies,) = (figure for figure in page.figures if "bear out" in figure.what)
    assert lies.value == 2 * 20 + 2 * 20  # every target of two arms, and of the two of the list
    # Its true errors stand beside its time, whatever it says they are.
    (beside,) = (f for f in page.figures if f.what.startswith("inverse kinematics, UR5: time"))
    assert float(beside.error.split()[0]) > 1e-7


def test_a_solver_that_does_not_claim_success_has_solved_nothing_and_a_wrong_reason_is_seen(
    monkeypatch,
):
    page = page_of(modest, monkeypatch)
    assert not any(verdicts(page, "solved to 1e-9"))
    assert verdicts(page, "bear out") == [True]
    assert verdicts(page, "the reason is 'unreachable'") == [False]


def test_targets_beyond_the_reach_are_beyond_the_sum_of_the_links():
    T = reasons.beyond_reach(UR5, np.random.default_rng(0), 200)
    far = np.linalg.norm(T[:, :3, 3], axis=1)
    assert (far > UR5.reach).all()
    assert far.min() < UR5.reach * (1 + 1e-4)  # some of them barely
    np.testing.assert_allclose(
        T[:, :3, :3] @ T[:, :3, :3].transpose(0, 2, 1),
        np.tile(np.eye(3), (200, 1, 1)),
        rtol=0,
        atol=1e-14,
    )


def test_whole_turns_bring_an_angle_into_the_limits_where_they_can():
    limits = np.array([[-6.0, 6.0], [3.0, 4.0], [-np.inf, np.inf]])
    beyond, turned = ik_peers.outside(
        limits, np.array([[-5.0, -3.0, 9.0], [1.0, 1.0, 0.0], [1.0, 4.5, 0.0]])
    )
    # -3 + 2 pi = 3.28 is within; 1 is 2 below 3, and 1 + 2 pi is 3.28 above 4.
    np.testing.assert_allclose(beyond, [0.0, 2.0, 0.5], rtol=0, atol=1e-14)
    np.testing.assert_allclose(turned[0, :2], [-5.0, 2 * np.pi - 3.0])


def test_blocked_poses_have_solutions_but_none_within_the_limits():
    usable("eaik")
    tight = reasons.tightened(UR5, 0.25)
    np.testing.assert_allclose(tight.limits, np.tile([-np.pi / 2, np.pi / 2], (6, 1)))
    T, passed = reasons.blocked_poses(tight, np.random.default_rng(0), 20)
    assert passed <= 1
    free = pk.Chain.from_space(UR5.screws, UR5.home, limits=np.tile([-np.pi, np.pi], (6, 1)))
    assert judgement_of(ik(free, T), free, T).solved.all()
    # A search of another kind than EAIK's: many starts, and no one gets there.
    assert not ik(tight, T, restarts=1000).success.any()


@pytest.mark.parametrize("name", ["robotics_toolbox", "pinocchio", "eaik"])
def test_a_peer_is_asked_for_the_pose_of_the_chain_and_at_equal_tolerance_it_is_that_near(name):
    usable(name)
    make = {
        "robotics_toolbox": partial(ik_peers.robotics_toolbox, UR5, tol=ik_peers.EQUAL_E),
        "pinocchio": partial(ik_peers.pinocchio_clik, UR5, eps=1e-9),
        "eaik": lambda: ik_peers.ClosedForm(UR5).solver(),
    }[name]
    _, T = reachable(UR5, 8)
    found = peer_row(name, make, UR5, T).judgement
    assert found is not None
    assert found.claimed.sum() >= 4  # Pinocchio's loop knows no restarts
    assert (
        max(found.worst) < 2e-9
    )  # the tool is 0.1 m from the joint that Pinocchio's loop looks at


def test_the_default_tolerance_of_robotics_toolbox_is_a_millimetre():
    usable("robotics_toolbox")
    _, T = reachable(UR5, 100)
    found = peer_row("robotics_toolbox", partial(ik_peers.robotics_toolbox, UR5), UR5, T).judgement
    assert found is not None
    # ½ |e|² = 1e-6 lets |e| be 1.4e-3, and no more.
    assert 1e-4 < found.worst[0] < 1.5e-3


def test_a_peer_that_cannot_solve_an_arm_says_why():
    usable("eaik")
    seven = pk.load("iiwa14").chain()
    row = peer_row(
        "eaik", lambda: ik_peers.ClosedForm(seven).solver(), seven, seven.fk(np.zeros((1, 7)))
    )
    assert row.judgement is None
    assert "six revolute joints" in row.problem


def test_without_peers_the_page_says_so_and_poekin_s_own_figures_stand(monkeypatch):
    absent = {name: replace(peers.STANDARD[name], distribution="no-such-distribution")
              for name in ("robotics_toolbox", "pinocchio")}  # fmt: skip
    monkeypatch.setattr(ik_peers, "STANDARD", absent)
    monkeypatch.setattr(
        ik_peers, "EAIK", replace(ik_peers.EAIK, distribution="no-such-distribution")
    )
    page = page_of(ik, monkeypatch)
    assert all(verdicts(page, "solved to 1e-9"))
    unmeasured = [figure for figure in page.figures if figure.value is None]
    assert (
        len(unmeasured) == 4
    )  # two ratios, and the poses of two arms that EAIK would have to vouch for
    assert all("absent: not installed" in figure.note for figure in unmeasured)
    assert verdicts(page, "Robotics Toolbox") == [False, False]


def test_the_named_list_has_arms_of_five_to_seven_joints_and_none_twice():
    found = arms.named_arms()
    assert len({arm.name for arm in found}) == len(found) == 43
    assert all(
        5 <= arm.chain.dof <= 7 and len(arm.chain.q_names) == len(arm.chain.joint_names)
        for arm in found
    )
    assert [arm.name for arm in found if arm.task == "direction"] == [
        "hextilt_flying_arm_5 → flying_arm_5__link_5", "so100 → gripper", "so101 → gripper_link",
    ]  # fmt: skip
    # Twins have the same axes in the same frame of the first joint, and the same limits.
    prints = [_print(arm.chain) for arm in found]
    same = [(a.name, b.name) for i, a in enumerate(found) for j, b in enumerate(found[:i])
            if len(prints[i]) == len(prints[j]) and np.allclose(prints[i], prints[j], rtol=0, atol=2e-3)]  # fmt: skip
    assert same == []


def _print(chain: pk.Chain) -> np.ndarray:
    """What does not depend on where the base stands: how each two axes lie to each other, at some
    q; and the limits.
    """
    numbers = []
    for q in np.random.default_rng(0).normal(size=(3, 7)):
        J = chain.jacobian(q[: chain.dof], "space").T
        w, v = J[:, :3], J[:, 3:]
        numbers += [w @ w.T, w @ v.T + v @ w.T]
    bounds = np.nan_to_num(chain.limits, posinf=99.0, neginf=-99.0)
    return np.concatenate([*(np.abs(x).ravel() for x in numbers), bounds.ravel()])
