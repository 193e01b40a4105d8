"""Cases of exp, log, adjoint and the Jacobians of exp: what is drawn, allowed, confirmed and shown
of them.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from poekin.testing.conform import Subject, confirm
from poekin.testing.conform.laws import group_cases
from poekin.testing.conform.laws.group_cases import GROUP_LAWS
from poekin.testing.conform.laws.law import Case
from poekin.testing.oracles import exact
from tests.testing.drawing import drawn

LAWS = {law.name: law for law in GROUP_LAWS}
SUBJECT = Subject(Poekin)
XI = np.array([0.4, -0.2, 0.7, 1.5, -2.0, 0.25])
TO_PI = {"so3_log", "log", "adjoint", *(name for name in LAWS if "inverse" in name)}
SINGLE = [name for name in LAWS if name != "noise" and " of batches" not in name]


def size(x: np.ndarray) -> float:
    return float(np.linalg.norm(x))


@pytest.mark.parametrize("name", SINGLE)
def test_angles_go_to_pi_or_to_10(name):
    law, largest = LAWS[name], math.pi if name in TO_PI else 10.0
    cases = drawn(law.cases(SUBJECT), 80)
    count = 3 if name.startswith("so3") else 6
    assert {len(case.numbers) for case in cases} == {count}
    angles = [size(case.numbers[:3]) for case in cases]
    assert 0.9 * largest < max(angles) <= largest * (1 + 1e-15)
    assert all(law.allowed(case) for case in cases)
    n = np.array([0.6, 0, 0.8])
    rest = np.zeros(count - 3)
    assert law.allowed(Case(np.concatenate([n * largest * 0.999, rest])))
    assert not law.allowed(Case(np.concatenate([n * largest * 1.001, rest])))
    assert not law.allowed(Case(np.concatenate([n * 1e-151, rest])))
    assert law.allowed(Case(np.zeros(count)))
    for k in range(3):
        assert law.allowed(Case(np.concatenate([largest * np.eye(3)[k], rest])))
    assert law.allowed(Case(np.concatenate([[0, 0, 1e-100], rest])))
    if count == 6:
        assert law.allowed(Case(np.concatenate([n * largest, [2.0, 0, 0]])))
        assert not law.allowed(Case(np.concatenate([n, [1.1e3, 0, 0]])))
        for length, allowed in ((1e3, True), (1.1e3, False), (1e-9, True)):
            v = np.array([0, length, 0])
            assert law.allowed(Case(np.concatenate([n, v]))) == (
                allowed and drawable_length(length)
            )


def drawable_length(length: float) -> bool:
    low, high = group_cases.LENGTHS
    return low <= length <= high


@pytest.mark.parametrize("name", SINGLE)
def test_what_is_shown_can_be_pasted_and_is_exact(name):
    law, count = LAWS[name], 3 if name.startswith("so3") else 6
    shown = law.show(SUBJECT, Case(XI[:count]))
    words = "ω = (0.4, -0.2, 0.7)" + (", v = (1.5, -2, 0.25)" if count == 6 else "")
    element = name.endswith("log") or name == "adjoint"
    assert shown.words == ("e^ξ, rounded, of " + words if element else words)
    found: list[Any] = []
    exec(shown.paste, {"print": found.append})
    assert np.array(found[0]) == pytest.approx(shown.expected, abs=1e-14)
    function = getattr(exact, name.removeprefix("so3_"))
    x = exact.rounded(exact.exp(XI[:count])) if element else XI[:count]
    expected = exact.rounded(function(x))
    if SUBJECT.twist(np.arange(6.0)).tolist() == list(range(6)):
        assert np.array_equal(np.asarray(shown.expected), expected)


def test_coordinates_are_written_to_the_last_digit():
    assert group_cases.coordinates(np.array([-0.0, 1.0, 1 / 3])) == "ω = (0, 1, 0.3333333333333333)"
    assert (
        group_cases.coordinates(np.array([0, 0, 1e-9, 0, -2, 0.5]))
        == "ω = (0, 0, 1e-09), v = (0, -2, 0.5)"
    )


def test_linear_first_subjects_are_shown_in_their_own_order():
    class Swapped(Poekin):
        twist_order = "linear first"

    subject = Subject(Swapped)
    x = np.arange(36.0)
    swapped = np.concatenate([x[3:6], x[:3]])
    assert group_cases._in_order(subject, "exp", x[:6]).tolist() == swapped.tolist()
    assert group_cases._in_order(subject, "so3_log", x[:3]).tolist() == x[:3].tolist()
    T = x[:16].reshape(4, 4)
    assert group_cases._in_order(subject, "exp", T) is T
    J = x.reshape(6, 6)
    order = [3, 4, 5, 0, 1, 2]
    assert np.array_equal(
        group_cases._in_order(subject, "left_jacobian", J), J[np.ix_(order, order)]
    )
    stack = np.stack([J, J + 1])
    assert np.array_equal(
        group_cases._in_order(subject, "left_jacobian", stack)[1], (J + 1)[np.ix_(order, order)]
    )
    rows = np.stack([x[:6], x[6:12]])
    assert group_cases._in_order(subject, "exp", rows)[0].tolist() == swapped.tolist()


@pytest.mark.parametrize("name", SINGLE)
def test_the_second_oracle_is_asked(name, monkeypatch):
    law, case = LAWS[name], Case(XI[: 3 if name.startswith("so3") else 6])
    assert law.confirm(SUBJECT, case)
    plain = name.removeprefix("so3_")
    asked = {
        "exp": ["of_exp"],
        "log": ["of_exp", "of_log"],
        "adjoint": ["of_exp", "of_adjoint"],
    }.get(plain, ["of_jacobian"])
    for function in asked:
        with monkeypatch.context() as patch:
            patch.setattr(confirm, function, lambda *_: False)
            assert not law.confirm(SUBJECT, case)


@pytest.mark.parametrize("name", ["so3_exp", "so3_log", "exp", "log", "left_jacobian"])
def test_batches_are_judged_by_their_worst_and_have_their_shape(name, monkeypatch):
    law, count = LAWS[f"{name} of batches"], 3 if name.startswith("so3") else 6
    cases = drawn(law.cases(SUBJECT), 60)
    assert {case.layout for case in cases} >= {(), (1,), (0,), (3, 1, 2)}
    assert all(len(case.numbers) == count * math.prod(case.layout) for case in cases)
    assert all(law.allowed(case) for case in cases)
    rows = np.stack([XI[:count], 0.5 * XI[:count], np.zeros(count)])
    case = Case(rows.ravel(), (3, 1))
    assert law.check(SUBJECT, case).grade == 0
    assert law.check(SUBJECT, Case(np.zeros(0), (0,))) == (0, 0.0, "empty batch", "")
    assert law.confirm(SUBJECT, case)
    assert np.asarray(law.show(SUBJECT, case).expected).shape[:2] == (3, 1)
    assert law.show(SUBJECT, case).words.startswith("a batch (3, 1) of ω = (0.4, -0.2, 0.7)")
    found: list[Any] = []
    exec(law.show(SUBJECT, case).paste, {"print": found.append, "np": np})
    assert found[0] == pytest.approx(law.show(SUBJECT, case).expected, abs=1e-14)
    assert len(np.asarray(law.show(SUBJECT, Case(np.zeros(0), (0,))).expected)) == 0
    rows[1, 0] = 11.0
    assert not law.allowed(Case(rows.ravel(), (3, 1)))
    true = SUBJECT.function(name)

    def wrong(x: np.ndarray) -> np.ndarray:
        result = np.array(true(x))
        result[1] *= 1 + 1e-3
        return result

    monkeypatch.setattr(SUBJECT, "function", lambda name: wrong)
    rows[1, 0] = 0.2
    assert law.check(SUBJECT, Case(rows.ravel(), (3,))).grade == 3
    monkeypatch.setattr(SUBJECT, "function", lambda name: lambda x: np.zeros(3))
    assert "shape" in law.check(SUBJECT, case).fault
    assert law.says.endswith("in shapes (), (1,), (0,), (3, 1, 2)")


def test_noise_is_as_large_as_is_declared():
    class Noisy(Poekin):
        noise = 1e-6

    subject, law = Subject(Noisy), LAWS["noise"]
    assert law.applies(subject)
    cases = drawn(law.cases(subject), 60)
    off = [
        np.abs(R.T @ R - np.eye(3)).max() for R in (case.numbers.reshape(3, 3) for case in cases)
    ]
    assert 1e-8 < max(off) < 1e-5
    assert law.check(subject, cases[0]).grade == 0
    assert not law.allowed(cases[0])
    assert not list(law.triples(cases[0]))
    assert law.confirm(subject, cases[0])
    R = cases[0].numbers.reshape(3, 3)
    shown = law.show(subject, cases[0])
    assert shown.words == "a rotation with noise"
    assert np.array_equal(np.asarray(shown.expected), exact.rounded(exact.log(R)))


def test_what_is_held_is_said_with_the_largest_angle():
    to_pi, far = ", |ω| up to π", ", |ω| up to 10"
    says = {
        "so3_exp": f"exp ξ = e^ξ{far}", "exp": f"exp ξ = e^ξ{far}",
        "so3_log": f"log of a rotation is its principal logarithm{to_pi}",
        "log": f"log of a pose is its principal logarithm{to_pi}", "adjoint": "Ad(T) = [R 0; [t] R R]",
        "noise": "log of a rotation with noise is that of the nearest rotation",
    }  # fmt: skip
    for prefix in ("so3_", ""):
        says |= {
            f"{prefix}left_jacobian": f"(d e^ξ) e^-ξ = J_l dξ{far}",
            f"{prefix}right_jacobian": f"e^-ξ (d e^ξ) = J_r dξ{far}",
            f"{prefix}left_jacobian_inverse": f"the inverse of J_l{to_pi}",
            f"{prefix}right_jacobian_inverse": f"the inverse of J_r{to_pi}",
        }
    shapes = ", in shapes (), (1,), (0,), (3, 1, 2)"
    says |= {
        f"{n} of batches": f"{n} of a batch is {n} of each{shapes}"
        for n in SINGLE
        if n != "adjoint"
    }
    assert {law.name: law.says for law in GROUP_LAWS} == says
    assert {law.name: law.examples for law in GROUP_LAWS} == {
        n: 100 if "batches" in n else 400 for n in says
    }


def test_an_adjoint_is_confirmed_within_a_hundred_roundings(monkeypatch):
    asked: list[float] = []
    monkeypatch.setattr(confirm, "of_adjoint", lambda T, within: asked.append(within) or True)
    assert LAWS["adjoint"].confirm(SUBJECT, Case(XI))
    assert asked == [100 * 2.0**-53]
