"""What a subject declares: twist order and frame are never guessed, and what is missing is said."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import poekin as pk
from benchmarks.subjects import Angular, Linear, Poekin
from poekin.errors import InputError, UnknownName
from poekin.testing.conform import (
    FUNCTIONS,
    LAWS,
    Case,
    Grade,
    Subject,
    Verdict,
    applicable,
    conform,
    law_names,
    run,
    search,
)
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


ORDER = 'expected twist_order = "angular first" or "linear first"'


def arms_function(self, A, M, q):
    return M


@pytest.mark.parametrize(
    ("members", "said"),
    [
        ({"exp": one, "log": lambda self, T: T}, f"Mine has exp, and does not declare twist_order: {ORDER}"),
        ({"fk": arms_function, "jacobian": arms_function}, f"Mine has fk, and does not declare twist_order: {ORDER}"),
        (
            {"read_urdf": arms_function, "jacobian_frame": "body"},
            f"Mine has jacobian_frame, and does not declare twist_order: {ORDER}",
        ),
        (
            {"read_urdf": arms_function, "jacobian_frame": "body", "adjoint": lambda self, T: T},
            f"Mine has adjoint, and does not declare twist_order: {ORDER}",
        ),
        (
            {"fk": lambda self, q: q, "exp": one, "arm": pk.load("panda").chain(tip="panda_hand")},
            f"Mine has exp, and does not declare twist_order: {ORDER}",
        ),
        (
            {"so3_exp": one, "twist_order": 1, "log": lambda self, T: T},
            'Mine: twist_order: expected "angular first" or "linear first", got 1',
        ),
        ({"so3_exp": one, "precision": "half"}, 'Mine: precision: expected "float64" or "float32", got \'half\''),
        (
            {"jacobian": arms_function, "twist_order": "angular first"},
            'Mine has jacobian, and does not declare jacobian_frame: '
            'expected jacobian_frame = "space" or "body" or "hybrid"',
        ),
        ({"so3_exp": one, "paste": "x"}, "Mine: paste: expected a text for each function, got 'x'"),
        ({"so3_exp": one, "helical": "yes"}, "Mine: helical: expected True or False, got 'yes'"),
        ({"so3_exp": one, "noise": 1.1e-5}, "Mine: noise: expected a number from 0 to 1e-5, got 1.1e-05"),
        ({"so3_exp": one, "noise": -1e-9}, "Mine: noise: expected a number from 0 to 1e-5, got -1e-09"),
        ({"so3_exp": one, "noise": "no"}, "Mine: noise: expected a number from 0 to 1e-5, got 'no'"),
        ({"so3_exp": one, "arm": "ur5e"}, "Mine: arm: expected a poekin.Chain, got 'ur5e'"),
        (
            {"fk": arms_function, "arm": pk.load("panda").chain(tip="panda_hand")},
            "Mine: fk: expected parameters (q) with `arm` declared, got (A, M, q)",
        ),
        ({"fk": one}, "Mine: fk: expected parameters (screws, home, q) (declare `arm` for fk(q) of one arm), got (x)"),
        ({"log": arms_function}, "Mine: log: expected parameters (T), got (A, M, q)"),
        ({"adjoint": arms_function}, "Mine: adjoint: expected parameters (T), got (A, M, q)"),
        ({"so3_log": arms_function}, "Mine: so3_log: expected parameters (R), got (A, M, q)"),
        ({"exp": arms_function}, "Mine: exp: expected parameters (xi), got (A, M, q)"),
        ({"read_robot": arms_function}, "Mine: read_robot: expected parameters (text), got (A, M, q)"),
        ({"so3_exp": lambda: None}, "Mine: so3_exp: expected parameters (self, w), got none"),
        ({"so3_exp": property(lambda self: 1 / 0)}, "Mine: so3_exp: ZeroDivisionError: division by zero"),
        ({"so3_exp": one, "__init__": lambda self: 1 / 0},
         "Mine cannot be made as Mine(): ZeroDivisionError: division by zero"),
        ({"size": 3}, f"Mine has none of the functions of a subject: {', '.join(FUNCTIONS)}"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_the_name_and_what_was_expected(members, said):
    with pytest.raises(InputError) as raised:
        Subject(kind(**members))
    assert str(raised.value) == said


def test_what_is_not_declared_is_nothing():
    subject = Subject(kind(so3_exp=one))
    assert (subject.noise, subject.batch, subject.helical, subject.arm) == (0.0, False, False, None)
    assert (subject.name, subject.version, subject.label, subject.title) == (
        "Mine",
        "",
        "Mine",
        "Mine",
    )
    assert (subject.linear_first, subject.frame, subject.pastes, subject.declared) == (
        False,
        "",
        {},
        None,
    )
    for noise in (0, 1e-5, 1e-9):
        assert Subject(kind(so3_exp=one, noise=noise)).noise == noise
    named = Subject(
        kind(
            so3_exp=one,
            name="Other",
            version=2,
            paste={"so3_exp": "f(x)"},
            batch=True,
            helical=True,
        )
    )
    assert (named.label, named.title, named.batch, named.helical) == ("Other 2", "Mine", True, True)
    assert named.pastes == {"so3_exp": "f(x)"}


class Both:
    twist_order = "linear first"
    jacobian_frame = "hybrid"
    fk = jacobian = arms_function
    exp = so3_exp = one


def test_a_subject_is_sent_with_all_but_itself():
    subject = Subject(Both)
    sent = pickle.loads(pickle.dumps(subject))
    assert vars(sent) == {key: value for key, value in vars(subject).items() if key != "own"}
    assert (sent.linear_first, sent.frame, sent.functions) == (
        True,
        "hybrid",
        ("so3_exp", "exp", "fk", "jacobian"),
    )


def test_a_call_is_written_as_it_was_asked_to_be_and_else_as_a_call_of_the_class():
    subject = Subject(Both)
    lines = "import numpy as np; from tests.testing.conform.subjects.test_subject import Both; "
    assert (
        subject.call("so3_exp", x="[1, 2, 3]")
        == lines + "print(np.asarray(Both().so3_exp([1, 2, 3])).tolist())"
    )
    assert (
        subject.call("fk", screws="A", home="M", q="q")
        == lines + "print(np.asarray(Both().fk(A, M, q)).tolist())"
    )
    subject.pastes = {"fk": "print(library.fk(screws, home, q))"}
    assert subject.call("fk", screws="A", home="M", q="[0]") == (
        "import numpy as np; screws = A; home = M; q = [0]; print(library.fk(screws, home, q))"
    )


@pytest.mark.parametrize(
    "shape", [(), (1,), (5,), (6,), (7,), (5, 6), (6, 5), (6, 7), (7, 6), (2, 5, 6), (2, 3, 3)]
)
@pytest.mark.parametrize("name", ["log", "left_jacobian", "adjoint", "exp"])
def test_a_result_of_another_shape_comes_as_it_was_made(name, shape):
    made = np.arange(float(np.prod(shape, dtype=int))).reshape(shape)
    subject = Subject(kind(**{name: lambda self, x: made}, twist_order="linear first"))
    turned = name == "log" and shape[-1:] == (6,)  # twists, one or more
    assert np.array_equal(
        subject.function(name)(np.zeros(6)), pk.se3.linear_first(made) if turned else made
    )


def test_functions_of_rotations_need_no_declaration():
    assert Subject(kind(so3_exp=one)).functions == ("so3_exp",)


def test_an_order_is_swapped_on_the_way_in_and_out():
    xi = np.array([0.1, 0.2, 0.3, 4.0, 5.0, 6.0])
    first, last = Subject(Angular), Subject(Linear)
    for name, x in [(n, xi) for n in ("exp", "left_jacobian")] + [
        (n, pk.se3.exp(xi)) for n in ("log", "adjoint")
    ]:
        np.testing.assert_array_equal(first.function(name)(x), last.function(name)(x))
        np.testing.assert_allclose(
            first.function(name)(x), getattr(pk.se3, name)(x), rtol=0, atol=1e-14
        )


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
    with pytest.raises(
        InputError,
        match=r"Mine: the law log does not apply: there is no log; those that do: so3_exp",
    ):
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
    ("row", "what"),
    [(1, "v of a column ÷ the arm's lengths"), (4, "ω of a column")],
    ids=["v", "omega"],
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
    report = conform(
        Poekin, [law], seconds=1e-6
    )  # a second law would have a tenth of a second, enough for more
    assert [outcome.examples for outcome in report.outcomes] == [10]
    assert str(report).count("which say little") == 1


def test_the_names_of_laws_are_a_list_for_parametrize():
    mine = kind(so3_exp=one, so3_log=one, batch=True)
    assert law_names(mine, "so3_log") == ["so3_exp", "so3_exp of batches", "so3_log of batches"]
    assert law_names("benchmarks.subjects:Poekin") == [law.name for law in LAWS]


def test_functions_of_any_kind_that_mean_nothing_are_named_and_other_values_are_not():
    functions = {"plain": one, "still": staticmethod(one), "shared": classmethod(one)}
    (note,) = Subject(kind(so3_exp=one, **functions, thickness=3)).misspelt
    assert note.endswith("and held to nothing: 'plain', 'still', 'shared'")


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
    for name, meant in [
        ("exp_so3", "so3_exp"),
        ("left_jacobain", "left_jacobian"),
        ("Batch", "batch"),
    ]:
        assert f"'{name}' is no name of a subject's; did you mean '{meant}'?" in notes
    assert notes.endswith("no function of a subject's, and held to nothing: 'helper'")
    with pytest.raises(
        InputError, match=r"none of the functions of a subject: .*did you mean 'so3_exp'"
    ):
        Subject(kind(so3exp=one))
    assert "note: 'exp_so3' is no name" in str(
        conform(kind(so3_exp=one, exp_so3=one), ["so3_exp"], examples=2)
    )


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
        return search.SearchResult(
            1, Case(np.zeros(3)), Verdict(Grade.EXACT, 0.0, "x"), None, False
        )

    monkeypatch.setattr(run, "worst", worst)
    monkeypatch.setattr(run.time, "monotonic", lambda: clock[0])
    laws = ["so3_exp", "so3_log", "fk"]
    said: list[tuple] = []
    run.conform(Poekin, laws, seconds=30.0, limits=None, say=lambda *words: said.append(words))
    assert [share[2] for share in shares] == [10.0, 13.0, 0.1]
    assert [share[1] for share in shares] == [
        next(law.examples for law in run.LAWS if law.name == n) for n in laws
    ]
    assert said == [(0, 3, "so3_exp"), (1, 3, "so3_log"), (2, 3, "fk")]
