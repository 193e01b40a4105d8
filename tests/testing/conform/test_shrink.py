"""Shrinking: to few numbers, few digits, few joints; and never to a case that does not fail or is
not allowed.
"""

from __future__ import annotations

import itertools
import math
import re

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from benchmarks.subjects.faulty import _Reader
from poekin.testing.conform import LAWS, Case, Grade, Subject, shrink
from poekin.testing.conform.grades import graded
from poekin.testing.conform.laws.arm_cases import ARM_LAWS
from poekin.testing.conform.laws.small_urdf import UrdfJoint, chain
from poekin.testing.conform.laws.urdf_cases import URDF_LAWS
from poekin.testing.conform.search import simplest
from poekin.testing.conform.shrink import cost, shrunk
from tests.testing.drawing import drawn

EXP = next(law for law in LAWS if law.name == "exp")
LOG = next(law for law in LAWS if law.name == "log")
XI = Case(np.array([0.3, -0.123456789, 7e-7, 12.34, -0.1, 1e-9]))


def test_vectors_are_whole_triples_of_the_numbers():
    starts = {n: list(EXP.triples(Case(np.zeros(n)))) for n in (0, 2, 3, 5, 6, 8)}
    assert starts == {0: [], 2: [], 3: [0], 5: [0], 6: [0, 3], 8: [0, 3]}


@pytest.mark.parametrize(
    ("fails", "expected"),
    [
        (lambda x: True, [0, 0, 0, 0, 0, 0]),
        (lambda x: x[1] != 0, [0, 1, 0, 0, 0, 0]),
        (lambda x: np.linalg.norm(x[:3]) > 0.2 and np.any(x[3:]), [1, 0, 0, 1, 0, 0]),
        (lambda x: 0.2 < np.linalg.norm(x[:3]) < 0.4, [0.3, 0, 0, 0, 0, 0]),
    ],
    ids=["nothing", "one place", "two vectors", "a size"],
)
def test_what_does_not_matter_goes(fails, expected):
    np.testing.assert_array_equal(
        shrunk(EXP, XI, lambda case: bool(fails(case.numbers))).numbers, expected
    )


def test_a_case_that_cannot_be_simpler_stays():
    assert shrunk(EXP, XI, lambda case: False) is XI


def test_near_pi_few_digits_of_the_gap_are_kept():
    start = Case(np.array([0, math.pi - 1.2345e-9, 0, 0, 0, 0]))
    small = shrunk(
        LOG, start, lambda case: bool(abs(math.pi - np.linalg.norm(case.numbers[:3])) < 1e-8)
    )
    assert np.count_nonzero(small.numbers) == 1
    assert small.numbers[0] == math.pi


def test_a_logarithm_is_not_shrunk_beyond_pi():
    start = Case(np.array([3.14159, 0, 0, 0, 0, 0]))
    small = shrunk(LOG, start, lambda case: bool(np.linalg.norm(case.numbers[:3]) > 3.1415))
    assert np.linalg.norm(small.numbers[:3]) <= math.pi


@pytest.mark.parametrize("law", [*ARM_LAWS, *URDF_LAWS], ids=lambda law: law.name)
def test_arms_shrink_to_one_joint_and_keep_their_axes(law):
    subject = Subject(Poekin)
    for case in drawn(law.cases(subject), 6):
        assert law.allowed(case)
        small = shrunk(law, case, lambda case: True)
        assert cost(small) <= cost(case)
        assert law.allowed(small)
        assert np.count_nonzero(small.numbers) == 1


def test_what_does_not_matter_of_a_tree_goes_and_its_joints_stay():
    law = next(law for law in URDF_LAWS if law.name == "robot mimic")
    for case in drawn(law.cases(Subject(Poekin)), 3):
        count = len(case.layout.joints)
        small = shrunk(
            law, case, lambda other, count=count: len(other.layout.joints) == count
        ).layout
        assert small == chain(small.joints)
        assert all(joint.follows < 0 for joint in small.joints)


def test_axes_that_are_missing_are_written_where_that_is_not_the_point():
    law = next(law for law in URDF_LAWS if law.name == "urdf missing axis")
    (case,) = drawn(law.cases(Subject(Poekin)), 1)
    assert law.about(case)
    assert not law.about(shrunk(law, case, lambda other: True))
    assert law.about(shrunk(law._replace(allowed=law.about), case, lambda other: True))


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_a_law_may_shrink_to_what_it_draws(law):
    for case in drawn(law.cases(Subject(Poekin)), 20) if law.name != "noise" else ():
        # A rotation by π may be drawn a rounding beyond it.
        assert law.allowed(case._replace(numbers=case.numbers * (1 - 1e-12)))


class DropsSmallComponents(_Reader):
    """Takes components of an axis below 1e-8 for 0, and refuses an axis that is short."""

    def edited(self, text):
        def straight(found):
            axis = np.array([float(x) for x in found[1].split()])
            if np.linalg.norm(axis) < 1e-6:
                raise ValueError(f"axis of length {np.linalg.norm(axis):g}")
            return f'<axis xyz="{" ".join(repr(x if abs(x) > 1e-8 else 0.0) for x in axis.tolist())}"/>'

        return re.sub(r'<axis xyz="([^"]*)"/>', straight, text)


class RaisesTwice:
    """Refuses rotations about two axes or more, and, by another exception, those about x."""

    def so3_exp(self, w):
        if np.count_nonzero(w) > 1:
            raise NotImplementedError("about two axes")
        if w[0]:
            raise ZeroDivisionError
        return Poekin.so3_exp(w)


def test_a_poor_case_stays_poor_and_does_not_slide_to_what_the_law_does_not_draw():
    law = next(law for law in URDF_LAWS if law.name == "urdf oblique axis")
    subject = Subject(DropsSmallComponents)
    row = [0, 3e-9, 1, 0.3, 0, 0, 0, 0, 0.2, 0, 0, 2.0]
    case = Case(np.array(row), chain((UrdfJoint("revolute", "j0"),)))
    verdict = law.check(subject, case)
    assert verdict.grade is Grade.POOR
    small = simplest(law, subject, case, verdict)
    assert law.check(subject, small).manner == (Grade.POOR, "")
    np.testing.assert_array_equal(small.numbers[3:11], 0)
    assert sorted(small.numbers[:3]) in ([0, 1e-9, 1], [0, 3e-9, 1])


def test_a_fault_does_not_shrink_to_one_of_another_kind():
    law = next(law for law in LAWS if law.name == "so3_exp")
    subject, case = Subject(RaisesTwice), Case(np.array([0.3, 0.2, -0.7]))
    verdict = law.check(subject, case)
    assert verdict.manner == (Grade.BROKEN, "NotImplementedError")
    small = simplest(law, subject, case, verdict)
    assert np.count_nonzero(small.numbers) == 2


@pytest.mark.parametrize(
    ("fault", "kind"),
    [
        ("of link tip: KeyError: 'tip'", "KeyError"),
        ("shape (4, 4) where (3, 3) was expected", "shape"),
        ("NaN", "NaN"),
        ("no coordinate j0 among those read: none", "no coordinate"),
    ],
)
def test_the_kind_of_a_fault_leaves_out_its_particulars(fault, kind):
    assert graded("law", fault).manner == (Grade.BROKEN, kind)


def test_oblique_axes_are_shown_in_round_numbers():
    law = next(law for law in ARM_LAWS if law.name == "fk")
    every = drawn(law.cases(Subject(Poekin)), 60)
    case = next(case for case in every if np.count_nonzero(case.numbers[:3]) == 3)
    small = shrunk(law, case, lambda other: bool(np.count_nonzero(other.numbers[:3]) > 1))
    assert sorted(small.numbers[:3]) == [0, 0.6, 0.8]


def test_a_case_costs_its_numbers_then_what_is_not_zero_digits_signs_places_and_sizes():
    assert cost(Case(np.array([0, -0.25, 0, 100.0]))) == (
        4,
        2,
        3,
        1,
        4.0,
        pytest.approx(2 + math.log10(4)),
    )
    assert cost(Case(np.zeros(0))) == (0, 0, 0, 0, 0.0, 0.0)
    rising = (
        [0.0, 0.0],
        [1.0, 0.0],
        [10.0, 0.0],
        [0.0, 1.0],
        [-1.0, 0.0],
        [1.5, 0.0],
        [1.0, 1.0],
        [0.0, 0.0, 0.0],
    )
    costs = [cost(Case(np.array(numbers))) for numbers in rising]
    assert costs == sorted(costs)
    assert len(set(costs)) == len(costs)


@pytest.mark.parametrize(
    ("value", "digits"),
    [
        (1.0, 1), (-2.0, 1), (0.5, 1), (100.0, 1), (1e-12, 1), (1.5, 2), (0.25, 2), (-0.125, 3), (1.25e-7, 3),
        (math.pi, 1), (-math.pi, 1), (math.pi - 1e-9, 2), (-(math.pi - 1e-3), 2), (3.0, 1), (math.pi - 1.5e-9, 16),
        (math.pi - 0.1, 17), (math.pi + 1e-3, 16), (math.pi - 7e-10, 16),
    ],
)  # fmt: skip
def test_digits_are_those_that_people_write(value, digits):
    assert shrink._digits(value) == pytest.approx(digits, abs=digits > 10)


def test_rounder_numbers_come_the_simplest_first():
    found = list(shrink._rounder(-0.037654))
    assert found[:4] == [
        1.0,
        -1.0,
        math.pi,
        -0.1,
    ]  # the nearest power of ten, on a scale of logarithms
    assert found[4:10] == [-0.04, 0.04, -0.038, 0.038, -0.0377, 0.0377]
    assert found[-2:] == [-0.037654, 0.037654]
    assert len(found) == 4 + 32
    assert list(shrink._rounder(0.0))[3] == 0.0
    assert list(shrink._rounder(200.0))[3] == 100.0
    towards = list(shrink._rounder(-(math.pi - 2e-5)))
    assert len(towards) == 37
    assert towards[-1] == math.pi - 1e-5
    assert len(list(shrink._rounder(math.pi - 0.1001))) == len(list(shrink._rounder(math.pi))) == 36
    assert list(shrink._rounder(math.pi - 0.099))[-1] == math.pi - 0.1
    assert len(list(shrink._rounder(math.pi + 1e-3))) == 36


def test_directions_become_axes_then_planes_then_nearly_axes():
    n = np.array([0.28, -0.96, 0.0])
    found = [direction.tolist() for direction in shrink._simpler_directions(n)]
    units = np.eye(3).tolist()
    assert found[:3] == units
    assert np.array_equal(found[3:6], -np.eye(3))
    assert sorted(map(tuple, found[6:12])) == sorted(itertools.permutations((0.6, 0.8, 0.0)))
    assert found[12:] == [[0, -1, 0], [0.28, 1, 0]]
    tilted = [
        direction.tolist() for direction in shrink._simpler_directions(np.array([3e-7, 1.0, -2e-3]))
    ]
    assert tilted[12] == pytest.approx(
        [0, 1 / math.hypot(1, 2e-3), -2e-3 / math.hypot(1, 2e-3)], rel=1e-15
    )
    assert tilted[13:15] == [
        [1e-7, 1, -2e-3],
        [3e-7, 1, -2e-3],
    ]  # the nearest power of ten, without its sign
    assert tilted[15] == pytest.approx([3e-7, 1, 0], rel=1e-12, abs=0)
    assert tilted[16:] == [[3e-7, 1, -2e-3]]
    assert len(list(shrink._simpler_directions(np.array([0.9e-4, 1.0, 0])))) == 12 + 3 + 1
    for tilt in (1e-4, 1.1e-4):
        assert len(list(shrink._simpler_directions(np.array([tilt, 1.0, 0])))) == 12 + 1 + 1


def test_smaller_cases_are_vectors_and_numbers_away_then_rounder():
    law = EXP._replace(directions=lambda case: (), triples=lambda case: (3,))
    case = Case(np.array([0, 2.5, 0, 3.0, 0, -4.0, 0.5]))
    found = [other.numbers.tolist() for other in shrink._smaller(law, case)]
    assert found[:5] == [
        [0, 2.5, 0, 0, 0, 0, 0.5], [0, 0, 0, 3, 0, -4, 0.5], [0, 2.5, 0, 0, 0, -4, 0.5], [0, 2.5, 0, 3, 0, 0, 0.5],
        [0, 2.5, 0, 3, 0, -4, 0],
    ]  # fmt: skip
    assert found[5:8] == [[0, 2.5, 0, *np.eye(3)[k] * 5, 0.5] for k in range(3)]
    assert [0, 2.5, 0, 0, 1, 0, 0.5] in found
    assert found[-1] == [0, 2.5, 0, 3, 0, -4, 0.5]
    assert case.numbers.tolist() == [0, 2.5, 0, 3, 0, -4, 0.5]
    directed = EXP._replace(directions=lambda case: (0,), triples=lambda case: ())
    case = Case(np.array([0, 0.6, 0.8, 2.0]))
    found = [other.numbers.tolist() for other in shrink._smaller(directed, case)]
    assert found[0] == [0, 0.6, 0.8, 0], "an axis is no number of its own"
    assert found[1:4] == [[*np.eye(3)[k], 2.0] for k in range(3)]
    assert all(other[3] == 2 for other in found[1:15])
    assert not list(shrink._smaller(law, Case(np.zeros(7))))
    directed = directed._replace(directions=lambda case: (1,))
    found = [
        other.numbers.tolist()
        for other in shrink._smaller(directed, Case(np.array([5.0, 0.6, 0.8, 0, 2.0])))
    ]
    assert found[:2] == [[0, 0.6, 0.8, 0, 2], [5, 0.6, 0.8, 0, 0]]
    assert found[2] == [5, 1, 0, 0, 2]
    last = EXP._replace(directions=lambda case: (), triples=lambda case: (0, 3))
    found = [
        other.numbers.tolist()
        for other in shrink._smaller(last, Case(np.array([0, 0, 0, 0, 0, 4.0])))
    ]
    assert found[:2] == [[0] * 6, [0] * 6], "the vector away, and the number"
    assert found[2] == [0, 0, 0, 4, 0, 0]


@pytest.mark.parametrize(
    "keeps",
    [lambda x: x[1] != 0, lambda x: abs(x[0]) > 0.2, lambda x: np.any(x[3:])],
    ids=["place", "size", "vector"],
)
def test_each_step_is_the_first_simpler_case_that_fails(keeps):
    def candidates(case: Case) -> list[Case]:
        smaller = [other for other in shrink._smaller(EXP, case) if cost(other) < cost(case)]
        return [other for other in smaller if EXP.allowed(other)]

    now, ahead = XI, candidates(XI)

    def fails(case: Case) -> bool:
        nonlocal now, ahead
        assert case.numbers.tolist() == ahead.pop(0).numbers.tolist()
        if keeps(case.numbers):
            now, ahead = case, candidates(case)
        return bool(keeps(case.numbers))

    assert shrunk(EXP, XI, fails).numbers.tolist() == now.numbers.tolist()
    assert not ahead


def test_no_more_cases_are_tried_than_are_allowed():
    tried: list[Case] = []

    def fails(case: Case) -> bool:
        tried.append(case)
        return False

    assert shrunk(EXP, XI, fails, budget=7) is XI
    assert len(tried) == 7
    assert shrunk(EXP, XI, fails, budget=270) is XI
    assert len(tried) == 277
    calls = len(tried)
    shrunk(EXP._replace(allowed=lambda case: False), XI, fails)
    assert len(tried) == calls
