"""What a subject declares: twist order and frame are never guessed, and what is missing is said."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from benchmarks.subjects import Angular, Linear, Poekin
from poekin.errors import InputError, UnknownName
from poekin.testing.conform import LAWS, Case, Grade, Subject, Verdict, applicable, conform, law_names, run, search
from tests.testing.drawing import drawn

LAWS_OF = {law.name: law for law in LAWS}


def kind(**members):
    return type("Mine", (), members)


def one(self, x):
    return x


@pytest.mark.parametrize(
    ("members", "words"),
    [
        ({}, r"Mine has none of the functions of a subject: so3_exp, "),
        (
            {"exp": one},
            r'Mine has exp, and does not declare twist_order: expected twist_order = "angular first" or "li',
        ),
        ({"exp": one, "twist_order": "v first"}, r"twist_order: expected .* got 'v first'"),
        ({"fk": lambda self, A, M, q: M}, r"Mine has fk, and does not declare twist_order"),
        ({"jacobian": lambda self, A, M, q: M, "twist_order": "angular first"}, r"does not declare jacobian_frame"),
        (
            {"jacobian": lambda self, A, M, q: M, "twist_order": "angular first", "jacobian_frame": "world"},
            r'jacobian_frame: expected "space" or "body" or "hybrid", got \'world\'',
        ),
        (
            {"fk": one, "twist_order": "angular first"},
            r"fk: expected parameters \(screws, home, q\) \(declare `arm` for fk\(q\) of one arm\), got \(x\)",
        ),
        ({"so3_log": one, "noise": 1.0}, r"noise: expected a number from 0 to 1e-5"),
        ({"fk": one, "arm": "ur5e"}, r"arm: expected a poekin.Chain, got 'ur5e'"),
        ({"read_urdf": lambda self, text, base, tip: None, "jacobian_frame": "body"}, r"does not declare twist_order"),
        ({"read_urdf": one}, r"read_urdf: expected parameters \(text, base, tip\), got \(x\)"),
        ({"so3_exp": lambda: None}, r"Mine: so3_exp: expected parameters \(self, w\), got none"),
        ({"so3_exp": lambda self, w, v: w}, r"so3_exp: expected parameters \(w\), got \(w, v\)"),
        ({"so3_exp": property(lambda self: 1 / 0)}, r"Mine: so3_exp: ZeroDivisionError"),
        ({"so3_exp": one, "batch": 1}, r"batch: expected True or False, got 1"),
        ({"so3_exp": one, "__init__": lambda self, robot: None}, r"cannot be made as Mine\(\): TypeError: .*robot"),
        ({"so3_exp": one, "__init__": lambda self: 1 / 0}, r"Mine cannot be made as Mine\(\): ZeroDivisionError"),
    ],
    ids=["nothing", "no order", "wrong order", "arms", "no frame", "wrong frame", "one arm", "noise", "arm", "reader",
         "parameters", "no self", "two arguments", "property", "batch", "constructor", "constructor fails"],
)  # fmt: skip
def test_what_is_not_declared_is_refused_with_what_to_declare(members, words):
    with pytest.raises(InputError, match=words):
        Subject(kind(**members))


def test_functions_of_rotations_need_no_declaration():
    assert Subject(kind(so3_exp=one)).functions == ("so3_exp",)


def test_an_order_is_swapped_on_the_way_in_and_out():
    xi = np.array([0.1, 0.2, 0.3, 4.0, 5.0, 6.0])
    first, last = Subject(Angular), Subject(Linear)
    for name, x in [(n, xi) for n in ("exp", "left_jacobian")] + [(n, pk.se3.exp(xi)) for n in ("log", "adjoint")]:
        np.testing.assert_array_equal(first.function(name)(x), last.function(name)(x))
        np.testing.assert_allclose(first.function(name)(x), getattr(pk.se3, name)(x), rtol=0, atol=1e-14)


def test_only_laws_of_functions_that_are_there_apply():
    assert [law.name for law in applicable(Subject(kind(so3_exp=one)))] == ["so3_exp"]
    batched = Subject(kind(so3_exp=one, batch=True))
    assert [law.name for law in applicable(batched)] == ["so3_exp", "so3_exp of batches"]
    assert len(applicable(Subject(Poekin))) == len(LAWS)


def test_a_law_that_does_not_exist_or_apply_is_refused():
    with pytest.raises(UnknownName, match=r"no law 'so3_expp'; did you mean 'so3_exp'"):
        conform(Poekin, ["so3_expp"])
    with pytest.raises(UnknownName, match=r"no law 'so3_expp'"):
        conform(Poekin, "so3_expp")
    with pytest.raises(InputError, match=r"Mine: the law log does not apply: there is no log; those that do: so3_exp"):
        conform(kind(so3_exp=one), ["log"])
    with pytest.raises(InputError, match=r"Mine: no law that applies is left"):
        conform(kind(so3_exp=one), leave_out="so3_exp")
    with pytest.raises(UnknownName, match=r"no law 'so3'"):
        conform(kind(so3_exp=one), leave_out=["so3"])
    with pytest.raises(InputError, match=r"examples ≥ 1 and seconds > 0 expected"):
        conform(Poekin, seconds=0)


def test_an_object_is_a_subject_as_well_as_a_class():
    assert conform(Poekin(), ["so3_exp"], examples=20).conforms


class Turntable:
    arm = pk.load("panda").chain(tip="panda_hand")
    twist_order = "linear first"
    jacobian_frame = "hybrid"

    def fk(self, q):
        return self.arm.fk(q)

    def jacobian(self, q):
        return pk.se3.linear_first(self.arm.jacobian(q, frame="hybrid"), axis=-2)


def test_one_arm_of_its_own_is_held_to_poekins_model_of_it():
    report = conform(Turntable, examples=40)
    assert [(outcome.law, outcome.grade) for outcome in report.outcomes] == [
        ("fk", Grade.EXACT), ("jacobian", Grade.EXACT),
    ]  # fmt: skip

    (q,) = [np.array(case.numbers) for case in drawn(LAWS_OF["fk"].cases(Subject(Turntable)), 1)]
    assert np.all(q >= Turntable.arm.limits[:, 0])

    class Strict(Turntable):
        def fk(self, q):
            if np.any(q < self.arm.limits[:, 0]) or np.any(q > self.arm.limits[:, 1]):
                raise ValueError("beyond the limits")
            T = super().fk(q)
            T[0, 3] += 1e-3
            return T

    (outcome,) = conform(Strict, ["fk"], examples=20).findings
    assert outcome.fault == ""

    class Longer(Turntable):
        def fk(self, q):
            T = super().fk(q)
            T[2, 3] += 1e-8
            return T

    (outcome,) = conform(Longer, ["fk"], examples=40).findings
    assert outcome.grade is Grade.POOR
    # The panda's fourth and sixth joints cannot be at 0.
    assert outcome.numbers <= 2


@pytest.mark.parametrize(
    ("row", "what"), [(1, "v of a column ÷ the arm's lengths"), (4, "ω of a column")], ids=["v", "omega"]
)
def test_an_error_in_one_row_of_the_last_column_of_a_jacobian_is_seen(row, what):
    class Off(Turntable):
        def jacobian(self, q):
            J = super().jacobian(q)
            J[row, -1] += 1e-7
            return J

    (outcome,) = conform(Off, ["jacobian"], examples=20).findings
    assert (outcome.what, outcome.grade) == (what, Grade.POOR)


@pytest.mark.parametrize("law", ["so3_exp", "urdf"])
def test_ten_cases_are_tried_however_little_time_there_is(law):
    report = conform(Poekin, [law], seconds=1e-6)  # a second law would have a tenth of a second, enough for more
    assert [outcome.examples for outcome in report.outcomes] == [10]
    assert str(report).count("which say little") == 1


def test_the_names_of_laws_are_a_list_for_parametrize():
    mine = kind(so3_exp=one, so3_log=one, batch=True)
    assert law_names(mine, "so3_log") == ["so3_exp", "so3_exp of batches", "so3_log of batches"]
    assert law_names("benchmarks.subjects:Poekin") == [law.name for law in LAWS]


def test_a_name_that_looks_misspelt_is_said_with_what_may_be_meant():
    misspelt = {
        "exp_so3": one,
        "left_jacobain": one,
        "Batch": True,
        "helper": staticmethod(one),
        "size": 3,
        "_own": one,
    }
    notes = " ".join(Subject(kind(so3_exp=one, **misspelt)).misspelt)
    for name, meant in [("exp_so3", "so3_exp"), ("left_jacobain", "left_jacobian"), ("Batch", "batch")]:
        assert f"'{name}' is no name of a subject's; did you mean '{meant}'?" in notes
    assert notes.endswith("no function of a subject's, and held to nothing: 'helper'")
    with pytest.raises(InputError, match=r"none of the functions of a subject: .*did you mean 'so3_exp'"):
        Subject(kind(so3exp=one))
    assert "note: 'exp_so3' is no name" in str(conform(kind(so3_exp=one, exp_so3=one), ["so3_exp"], examples=2))


def test_laws_that_do_not_apply_are_said_with_the_reason():
    notes = conform(kind(so3_log=lambda self, R: np.zeros(3)), examples=2, leave_out=["exp"]).notes
    assert notes[0] == "left out, as asked for: exp"
    assert notes[1].startswith("no law of what is not there: so3_exp, so3_left_jacobian, ")
    assert "noise is not declared, so there is no law of noise" in notes
    assert "batch = True is not declared, so there is no law of so3_log of batches" in notes


def test_where_the_time_runs_out_the_report_says_so():
    report = conform(Poekin, ["so3_exp"], seconds=1e-6)
    assert report["so3_exp"].late
    assert "10 examples, which say little; the time ran out" in str(report)
    assert "note: the time ran out: fewer examples than there should be of so3_exp" in str(report)
    assert not conform(Poekin, ["so3_exp"], examples=12)["so3_exp"].late


def test_the_time_that_is_left_is_shared_by_the_laws_that_are_left(monkeypatch):
    clock, shares = [100.0], []

    def worst(law, subject, examples, seconds, at_most):
        shares.append((law.name, examples, seconds))
        clock[0] += 4.0 if len(shares) == 1 else 100.0
        return search.Found(1, Case(np.zeros(3)), Verdict(Grade.EXACT, 0.0, "x"), None, False)

    monkeypatch.setattr(run, "worst", worst)
    monkeypatch.setattr(run.time, "monotonic", lambda: clock[0])
    laws = ["so3_exp", "so3_log", "fk"]
    said: list[tuple] = []
    run.conform(Poekin, laws, seconds=30.0, limits=None, say=lambda *words: said.append(words))
    assert [share[2] for share in shares] == [10.0, 13.0, 0.1]
    assert [share[1] for share in shares] == [next(law.examples for law in run.LAWS if law.name == n) for n in laws]
    assert said == [(0, 3, "so3_exp"), (1, 3, "so3_log"), (2, 3, "fk")]
