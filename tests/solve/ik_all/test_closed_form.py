"""When EAIK is asked for a closed form, what is asked of it, and when its answers are believed;
without EAIK.
"""

from __future__ import annotations

import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, MissingExtra
from poekin.model import screw
from poekin.model.chain import Chain
from poekin.solve.ik_all import closed_form as module
from poekin.solve.ik_all.closed_form import ClosedForm

R_NT = pk.so3.exp([0.3, -0.2, 0.5])


class Solver:
    """What EAIK makes of an arm, as far as it is asked."""

    def __init__(self, Q: Any = (), family: str = "6R-TEST", known: bool = True):
        self.Q, self.family, self.known, self.asked = Q, family, known, list[np.ndarray]()

    def getKinematicFamily(self) -> str:
        return self.family

    def hasKnownDecomposition(self) -> bool:
        return self.known

    def getOriginal_H(self) -> np.ndarray:
        return np.zeros((3, 6))

    def IK(self, T: np.ndarray) -> Any:
        self.asked.append(T)
        return SimpleNamespace(Q=self.Q)


def made(solver: Solver, position: float = 0.0, rotation: float = 0.0) -> ClosedForm:
    form: Any = SimpleNamespace(R_nt=R_NT)
    return ClosedForm(form, solver, position, rotation)


@pytest.mark.parametrize(
    ("position", "rotation", "more"),
    [
        (0.0, 0.0, ""),
        (
            1.26e-4,
            0.0,
            " of the arm made exact, at most 0.0001 m and 0 rad away, tried down to the target",
        ),
        (
            0.0,
            3e-6,
            " of the arm made exact, at most 0 m and 3e-06 rad away, tried down to the target",
        ),
    ],
)
def test_a_closed_form_says_its_family_and_how_far_the_arm_is_that_it_is_of(
    position, rotation, more
):
    assert made(Solver(), position, rotation).said() == f"closed form (EAIK, 6R-TEST){more}"


def test_the_last_frame_is_taken_off_a_target_and_what_is_no_number_off_the_answers():
    Q = np.arange(24.0).reshape(4, 6)
    Q[1, 5], Q[2, 0] = np.nan, np.inf
    solver = Solver(Q)
    T = pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3])
    before = T.copy()
    np.testing.assert_array_equal(made(solver).starts(T), Q[[0, 3]])
    np.testing.assert_array_equal(T, before)
    (asked,) = solver.asked
    np.testing.assert_allclose(asked[:3, :3], T[:3, :3] @ R_NT.T, atol=1e-15)
    np.testing.assert_array_equal(asked[:, 3], T[:, 3])
    np.testing.assert_array_equal(asked[3], [0, 0, 0, 1])
    assert made(Solver([])).starts(T).shape == (0, 6)
    assert made(Solver(list(range(12)))).starts(T).shape == (2, 6)


def form(angles: list[float], places: tuple[int, ...] = ()) -> Any:
    """Six axes in a plane with these angles between one and the next, and the steps that are not 0."""
    turned = np.cumsum([0.0, *angles])
    P = np.zeros((7, 3))
    P[list(places)] = 0.5
    return SimpleNamespace(H=np.stack([np.cos(turned), np.sin(turned), 0 * turned], axis=1), P=P)


@pytest.mark.parametrize(
    ("angles", "places", "safe"),
    [
        ([1, 1, 1, 1, 1], (), True),
        ([1, 1, 1, 1, 1], (0, 1, 2, 3, 6), True),
        ([1, 1, 1, 1, 1], (4,), False),
        ([1, 1, 1, 1, 1], (5,), False),
        ([1, 1, 1, 0.0101, 1], (), True),
        ([1, 1, 1, 0.0099, 1], (), False),
        ([1, 1, 1, 1, 0.0101], (), True),
        ([1, 1, 1, 1, 0.0099], (), False),
        ([1, 1, 0.0099, 1, 1], (), True),
        ([1, 0, 0, 1, 1], (4, 5), True),
        ([1, 0, 0, 0, 0], (4, 5), True),
        ([0, 0, 0, 1, 1], (4, 5), True),
        ([1, 0, 1, 1, 1], (4, 5), False),
        ([1, 1, 0, 1, 1], (4, 5), False),
        ([5e-5, 1, 1, 1, 1], (), False),
        ([1.1e-4, 1, 1, 1, 1], (), True),
        ([1, 1, 9e-5, 1, 1], (), False),
        ([1e-13, 1, 1, 1, 1], (), False),
        ([1, 0, 0, 1, 9e-5], (4, 5), False),
    ],
)
def test_an_arm_is_asked_of_where_its_last_axes_meet_or_its_middle_ones_are_parallel_and_none_is_nearly_so(
    angles, places, safe
):
    assert module._is_safe(form(angles, places)) is safe


KNOWN = np.random.default_rng(0).uniform(-np.pi, np.pi, (8, 6))
ARM = pk.load("ur5").chain()


class Answers:
    """Starts for the poses that are asked for, off by so much from where they were made."""

    def __init__(self, off: np.ndarray, wrong: int = 8):
        self.off, self.wrong, self.asked = off, wrong, 0

    def starts(self, T: np.ndarray) -> np.ndarray:
        k = self.asked
        self.asked += 1
        np.testing.assert_allclose(T, ARM.fk(KNOWN[k]), atol=1e-12)
        if k == self.wrong:
            return np.empty((0, 6))
        return np.stack([KNOWN[k] + 1, KNOWN[k] + self.off])


@pytest.mark.parametrize("joint", range(6))
@pytest.mark.parametrize(("by", "found"), [(9e-4, True), (-9e-4, True), (1.1e-3, False), (-1.1e-3, False),
                                           (2 * np.pi, True), (-4 * np.pi + 9e-4, True), (np.pi, False)])  # fmt: skip
def test_a_closed_form_is_believed_where_it_finds_what_eight_poses_were_made_of(joint, by, found):
    answers: Any = Answers(by * np.eye(6)[joint])
    assert module._finds_what_is_known(answers, ARM) is found
    assert answers.asked == (8 if found else 1)


def test_one_pose_without_a_known_solution_is_enough_to_disbelieve():
    for wrong in (0, 7):
        answers: Any = Answers(np.zeros(6), wrong)
        assert not module._finds_what_is_known(answers, ARM)
        assert answers.asked == wrong + 1


@pytest.mark.parametrize(
    ("solver", "safe", "believed", "taken"),
    [
        (Solver(), True, True, True), (Solver(), False, True, False), (Solver(), True, False, False),
        (Solver(known=False), True, True, False), (Solver(family="6R-Unknown Kinematic Class"), True, True, False),
        (RuntimeError("cannot say where"), True, True, False),
    ],
)  # fmt: skip
def test_what_eaik_knows_is_taken_where_it_is_safe_and_believed(
    solver, safe, believed, taken, monkeypatch
):
    asked: list[tuple[np.ndarray, np.ndarray]] = []

    def robot(H: np.ndarray, P: np.ndarray) -> Any:
        asked.append((H, P))
        if isinstance(solver, Exception):
            raise solver
        return solver

    monkeypatch.setattr(module, "_is_safe", lambda form: safe)
    monkeypatch.setattr(
        module, "_finds_what_is_known", lambda found, chain: believed and chain is ARM
    )
    found = module._of(module.Idealised(ARM, 0.25, 0.5, ()), robot)
    assert len(asked) == safe
    assert (found is not None) == taken
    if found is not None:
        assert (found.family, found.position_bound, found.rotation_bound) == ("6R-TEST", 0.25, 0.5)
        np.testing.assert_array_equal(asked[0][0], ARM.to_hp().H)
        np.testing.assert_array_equal(asked[0][1], ARM.to_hp().P)


def test_the_arm_itself_is_asked_of_before_the_one_with_exact_geometry(monkeypatch):
    monkeypatch.setitem(sys.modules, "eaik", SimpleNamespace())
    monkeypatch.setitem(sys.modules, "eaik.IK_HP", SimpleNamespace(HPRobot="EAIK"))
    asked: list[Any] = []
    answers = iter([None, "of the exact one"])

    def of(near: Any, robot: Any) -> Any:
        asked.append(near)
        assert robot == "EAIK"
        return next(answers)

    monkeypatch.setattr(module, "_of", of)
    monkeypatch.setattr(Chain, "idealised", lambda chain, tol: ("exact within", tol))
    assert module.closed_form(ARM) == "of the exact one"  # type: ignore[comparison-overlap]
    first, second = asked
    assert (first.chain, first.position_bound, first.rotation_bound, first.changes) == (
        ARM,
        0.0,
        0.0,
        (),
    )
    assert second == ("exact within", 1e-5)
    answers = iter(["of the arm"])
    assert module.closed_form(ARM) == "of the arm"  # type: ignore[comparison-overlap]
    axes = [screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in range(7)]
    for count in (5, 7):
        assert module.closed_form(pk.Chain.from_space(axes[:count], np.eye(4))) is None
    with pytest.raises(InputError):  # a joint that slides is in the way of any closed form
        module.closed_form(
            pk.Chain.from_space([*axes[:4], screw.prismatic([0, 0, 1.0])], np.eye(4))
        )
    assert len(asked) == 3


def test_without_eaik_the_extra_is_named(monkeypatch):
    for name in ("eaik", "eaik.IK_HP"):  # the second may be there already
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(
        MissingExtra, match=r"inverse kinematics in closed form needs the package EAIK: pip install"
    ):
        module.closed_form(ARM)
