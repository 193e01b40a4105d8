"""Shrinking: to few numbers, few digits, few joints; and never to a case that does not fail or is not allowed."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from benchmarks.subjects.faulty import _Reader
from poekin.testing.conform import LAWS, Case, Grade, Subject
from poekin.testing.conform.arm_cases import ARM_LAWS
from poekin.testing.conform.grades import judged
from poekin.testing.conform.search import simplest
from poekin.testing.conform.shrink import cost, shrunk
from poekin.testing.conform.small_urdf import Joint, chain, layout_of
from poekin.testing.conform.urdf_cases import URDF_LAWS
from tests.testing.drawing import drawn

EXP = next(law for law in LAWS if law.name == "exp")
LOG = next(law for law in LAWS if law.name == "log")
XI = Case(np.array([0.3, -0.123456789, 7e-7, 12.34, -0.1, 1e-9]))


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
    np.testing.assert_array_equal(shrunk(EXP, XI, lambda case: bool(fails(case.numbers))).numbers, expected)


def test_a_case_that_cannot_be_simpler_stays():
    assert shrunk(EXP, XI, lambda case: False) is XI


def test_near_pi_few_digits_of_the_gap_are_kept():
    start = Case(np.array([0, math.pi - 1.2345e-9, 0, 0, 0, 0]))
    small = shrunk(LOG, start, lambda case: bool(abs(math.pi - np.linalg.norm(case.numbers[:3])) < 1e-8))
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
        count = len(layout_of(case).joints)
        small = layout_of(shrunk(law, case, lambda other, count=count: len(layout_of(other).joints) == count))
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
    case = Case(np.array(row), chain((Joint("revolute", "j0"),)))
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
    assert judged("law", fault).manner == (Grade.BROKEN, kind)


def test_oblique_axes_are_shown_in_round_numbers():
    law = next(law for law in ARM_LAWS if law.name == "fk")
    every = drawn(law.cases(Subject(Poekin)), 60)
    case = next(case for case in every if np.count_nonzero(case.numbers[:3]) == 3)
    small = shrunk(law, case, lambda other: bool(np.count_nonzero(other.numbers[:3]) > 1))
    assert sorted(small.numbers[:3]) == [0, 0.6, 0.8]
