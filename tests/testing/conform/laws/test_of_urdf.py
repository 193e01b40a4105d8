"""What a URDF reader is asked, what is said of its faults, and how a case is shown."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from poekin.testing.conform import Grade, Subject, confirm
from poekin.testing.conform.laws import arm_cases, of_urdf, small_urdf
from poekin.testing.conform.laws.law import Shown
from poekin.testing.conform.process.calls import Undeclared
from poekin.testing.oracles import exact, exact_chain
from tests.testing.small_tree import CASE

SUBJECT = Subject(Poekin)
WORDS = (
    "j0 revolute, axis [0, 0, 1.0]; j1 fixed, xyz [0, 0, 0.25]; "
    "j2 prismatic behind base, no axis written (which means x), xyz [0.5, 0, 0], rpy [0, 0, 0.1]; "
    "j3 revolute, axis [0, 1.0, 0], rpy [0.2, 0, 0], mimics j0 × 2 + 0.25; "
    "j4 prismatic behind link2, axis [0, 0, -1.0], xyz [0, 0.75, 0], mimics j2 × -1 + 0"
)


@pytest.mark.parametrize("function", ["fk", "jacobian", "poses"])
def test_a_case_is_shown_in_words_and_as_python(function):
    shown: Shown = of_urdf.show(SUBJECT, CASE, function)
    assert shown.words == f"q = {{'j0': 0.5, 'j2': -1.0}}, {WORDS}"
    text = small_urdf.text(CASE)
    whole = function == "poses"
    read = f"read_robot({text!r})" if whole else f"read_urdf({text!r}, 'base', 'tip')"
    links = ["link1", "link2", "link3", "link4", "tip"]
    call = f"[read.poses(q)[link] for link in {links!r}]" if whole else f"read.{function}(q)"
    assert shown.paste == "; ".join([
        "import numpy as np", "from benchmarks.subjects.own import Poekin", f"read = Poekin().{read}",
        "print(list(read.names))", "q = np.array([{'j0': 0.5, 'j2': -1.0}.get(name, 0.0) for name in read.names])",
        f"print(np.asarray({call}).tolist())",
    ])  # fmt: skip
    assert shown.names == ("j0", "j2")
    arms = [small_urdf.arm(CASE, k)[:2] for k in range(5)]
    expected = [
        arm_cases.truth(SUBJECT, arm, q, function == "jacobian")
        for arm, q in (arms if whole else arms[-1:])
    ]
    assert np.array_equal(np.asarray(shown.expected), expected if whole else expected[0])
    found: list[Any] = []
    exec(shown.paste, {"print": found.append})
    assert sorted(found[0]) == ["j0", "j2"]
    truth = np.asarray(shown.expected)
    order = (
        [("j0", "j2").index(name) for name in found[0]] if function == "jacobian" else slice(None)
    )
    assert np.array(found[1]) == pytest.approx(
        truth[:, order] if function == "jacobian" else truth, abs=1e-14
    )


class Read:
    """What a reader returns: as exact as floats can be, with a coordinate more, and with what a
    test puts in it.
    """

    def __init__(self, **members: Any):
        self.names = ["more", "j2", "j0"]
        self.asked: list[np.ndarray] = []
        vars(self).update(members)

    def exactly(self, k: int = small_urdf.TIP) -> np.ndarray:
        arm, q, _ = small_urdf.arm(CASE, k)
        return exact.rounded(exact_chain.pose(arm, q))

    def fk(self, q: np.ndarray) -> np.ndarray:
        self.asked.append(q)
        return self.exactly()

    def poses(self, q: np.ndarray) -> dict[str, np.ndarray]:
        self.asked.append(q)
        return {small_urdf.link(CASE, k): self.exactly(k) for k in range(5)}


def subject(read: Any, frame: str | None = None) -> Subject:
    class Reader:
        twist_order, jacobian_frame = "angular first", frame

        def read_urdf(self, text: str, base: str, tip: str) -> Any:
            return read

        def read_robot(self, text: str) -> Any:
            return read

    return Subject(Reader)


def test_coordinates_that_a_pose_does_not_depend_on_are_0():
    read = Read()
    assert of_urdf.check(subject(read), CASE, False).grade is Grade.EXACT
    assert of_urdf.check_robot(subject(read), CASE).grade is Grade.EXACT
    assert [q.tolist() for q in read.asked] == [[0, -1.0, 0.5]] * 2


@pytest.mark.parametrize(
    ("members", "fault"),
    [
        ({"names": ["j2"]}, "no coordinate j0 among those read: j2"),
        ({"names": ["x", "y"]}, "no coordinate j0, j2 among those read: x, y"),
        ({"names": []}, "no coordinate j0, j2 among those read: none"),
        ({"names": None}, "`names` of what was read: TypeError: 'NoneType' object is not iterable"),
    ],
)
def test_a_coordinate_that_is_missing_is_told_with_those_that_are_there(members, fault):
    for verdict in (of_urdf.check(subject(Read(**members)), CASE, False),
                    of_urdf.check_robot(subject(Read(**members)), CASE)):  # fmt: skip
        assert (verdict.grade, verdict.fault) == (Grade.BROKEN, fault)


def test_a_link_that_is_wrong_is_named():
    def poses(q: np.ndarray) -> dict[str, np.ndarray]:
        found = Read().poses(q)
        found["link3"][2, 3] += 1e-3
        return found

    verdict = of_urdf.check_robot(subject(Read(poses=poses)), CASE)
    assert (verdict.grade, verdict.what, verdict.fault) == (
        Grade.BROKEN,
        "t ÷ the arm's lengths, of link3",
        "",
    )
    flat = of_urdf.check_robot(
        subject(Read(poses=lambda q: {**Read().poses(q), "link2": np.zeros(3)})), CASE
    )
    assert flat.fault == "of link link2: shape (3,) where (4, 4) was expected"
    lost = of_urdf.check_robot(subject(Read(poses=lambda q: {"tip": np.eye(4)})), CASE)
    assert lost.fault == "of link link1: KeyError: 'link1'"
    assert of_urdf.check(subject(Read(fk=lambda q: np.zeros(3))), CASE, False).fault == (
        "shape (3,) where (4, 4) was expected"
    )


def test_a_jacobian_that_is_missing_is_undeclared_and_one_that_cannot_be_asked_is_a_fault():
    with pytest.raises(
        Undeclared, match=r"^what read_urdf returns has no `jacobian`, though the subject declares "
    ):
        of_urdf.check(subject(Read(), "space"), CASE, True)

    class Raises(Read):
        @property
        def jacobian(self) -> Any:
            raise ValueError("not today")

    assert of_urdf.check(subject(Raises(), "space"), CASE, True).fault == "ValueError: not today"
    arm, q, _ = small_urdf.arm(CASE)
    truth = exact.rounded(exact_chain.jacobians(arm, exact.exactly(q)))[0]
    wrong = of_urdf.check(subject(Read(jacobian=lambda q: truth), "space"), CASE, True)
    assert wrong.fault == "shape (6, 2) where (6, 3) was expected"
    ordered = np.column_stack([np.full(6, 7.0), truth[:, 1], truth[:, 0]])
    assert (
        of_urdf.check(subject(Read(jacobian=lambda q: ordered), "space"), CASE, True).grade
        is Grade.EXACT
    )


def test_both_oracles_are_asked_about_each_link(monkeypatch):
    assert of_urdf.confirmed(CASE, True)
    assert of_urdf.confirmed(CASE, False, range(5))
    asked: list[bool] = []

    def confirmed(arm: Any, q: np.ndarray, jacobian: bool) -> bool:
        asked.append(jacobian)
        return len(asked) < 3

    with monkeypatch.context() as patch:
        patch.setattr(arm_cases, "confirmed", confirmed)
        assert not of_urdf.confirmed(CASE, False, range(5))
        assert asked == [False] * 3
        assert not of_urdf.confirmed(CASE, True)
    monkeypatch.setattr(confirm, "near", lambda *_: False)
    assert not of_urdf.confirmed(CASE, False)
