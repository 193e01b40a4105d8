"""Subjects in float32: held to what float32 can attain, with arguments that it can hold; detected
or declared.
"""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.subjects import Angular
from poekin.errors import InputError
from poekin.testing.conform import Grade, Subject, applicable, conform
from poekin.testing.conform.search import worst
from poekin.testing.conform.subjects.precision import DOUBLE, SINGLE, seen

NAMES = (
    "so3_exp",
    "so3_log",
    "exp",
    "log",
    "adjoint",
    "left_jacobian",
    "right_jacobian_inverse",
    "fk",
    "jacobian",
)


def nearest(function):
    """The exact result of what float32 makes of the arguments, rounded to float32."""

    def call(self, *arguments):
        rounded = [np.asarray(x, np.float32).astype(float) for x in arguments]
        return np.asarray(function(*rounded)).astype(np.float32)

    return call


class Read32:
    def __init__(self, read):
        self.read, self.names = read, read.names

    def fk(self, q):
        return self.read.fk(q).astype(np.float32)

    def poses(self, q):
        return {link: T.astype(np.float32) for link, T in self.read.poses(q).items()}


class Reader32:
    def read_urdf(self, text, base, tip):
        return Read32(Angular().read_urdf(text, base, tip))

    def read_robot(self, text):
        return Read32(Angular().read_robot(text))


def made(**more):
    functions = {name: nearest(getattr(Angular(), name)) for name in NAMES}
    return type(
        "Nearest",
        (Reader32,),
        {"twist_order": "angular first", "jacobian_frame": "space", **functions} | more,
    )


SUBJECT = Subject(made())
PAIRS = [law for law in applicable(SUBJECT) if law.name in (*NAMES, "urdf", "robot mimic")]


@pytest.mark.parametrize("law", PAIRS, ids=lambda law: law.name)
def test_who_rounds_the_truth_to_float32_is_exact(law):
    found = worst(law, SUBJECT, examples=12, seconds=60.0)
    assert found.verdict.grade is Grade.EXACT, found
    assert SUBJECT.precision(law.needs) is SINGLE
    assert law.confirm(SUBJECT, found.case)
    np.testing.assert_array_equal(found.case.numbers, found.case.numbers.astype(np.float32))


@pytest.mark.parametrize(
    ("error", "grade"), [(3e-6, Grade.GOOD), (1e-4, Grade.POOR), (1e-2, Grade.BROKEN)]
)
def test_the_grades_of_float32_end_where_they_are_said_to(error, grade):
    class Off:
        def so3_exp(self, w):
            R = Angular().so3_exp(w)
            return (R + error * np.eye(3)).astype(np.float32)

    report = conform(Off, ["so3_exp"], examples=10)
    assert (report["so3_exp"].grade, report["so3_exp"].precision) == (grade, "float32")
    assert "10 examples in float32" in str(report)


def test_what_is_computed_in_float32_and_returned_in_float64_is_declared():
    class Wide:
        precision: str | None = None

        def so3_exp(self, w):
            return Angular().so3_exp(np.asarray(w, np.float32)).astype(np.float32).astype(float)

    assert conform(Wide, ["so3_exp"], examples=40)["so3_exp"].grade > Grade.EXACT
    Wide.precision = "float32"
    assert conform(Wide, ["so3_exp"], examples=40)["so3_exp"].grade is Grade.EXACT
    Wide.precision = "half"
    with pytest.raises(
        InputError, match=r"precision: expected \"float64\" or \"float32\", got 'half'"
    ):
        conform(Wide, ["so3_exp"])


def test_the_first_result_of_a_function_says_its_precision_and_a_declaration_goes_before_it():
    class Exp:
        precision: str | None = None

        def so3_exp(self, w):
            return np.eye(3)

    subject = Subject(Exp)
    for kind in (np.float32, np.float64):
        subject.noted("so3_exp", np.eye(3, dtype=kind))
        assert subject.precision("so3_exp") is SINGLE
    assert subject.precision("so3_log") is DOUBLE
    Exp.precision = "float64"
    subject = Subject(Exp)
    subject.noted("so3_exp", np.eye(3, dtype=np.float32))
    assert subject.precision("so3_exp") is DOUBLE


def test_a_precision_is_that_of_the_type_of_the_result():
    class Tensor:
        dtype = "torch.float32"

    assert seen(Tensor()) is SINGLE
    assert seen(np.zeros(3, np.float32)) is SINGLE
    assert seen(np.zeros(3)) is seen([1.0]) is DOUBLE


def test_numbers_are_rounded_to_what_is_no_subnormal_of_the_precision():
    x = np.array([1 / 3, -1e-29, 1e-31, -1e-31, 0.0, 2.0])
    assert DOUBLE.rounded(x) is x
    assert SINGLE.rounded(x).tolist() == [
        float(np.float32(1 / 3)),
        float(np.float32(-1e-29)),
        0.0,
        0.0,
        0.0,
        2.0,
    ]
    assert (DOUBLE.coarser, SINGLE.coarser) == (1.0, 2.0**29)


def test_the_smallest_angle_has_a_square_that_is_no_subnormal():
    for precision, kind in ((DOUBLE, np.float64), (SINGLE, np.float32)):
        assert 1 <= precision.smallest**2 / np.finfo(kind).tiny < 1e8
