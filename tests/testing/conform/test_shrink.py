"""Shrinking: to few numbers, few digits, few joints; and never to a case that does not fail or is not allowed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from poekin.testing.conform import LAWS, Case, Subject
from poekin.testing.conform.arm_cases import ARM_LAWS
from poekin.testing.conform.shrink import cost, shrunk
from poekin.testing.conform.small_urdf import chain, layout_of
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
