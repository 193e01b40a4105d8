"""How laws are measured and told."""

from __future__ import annotations

import math
import pickle
import subprocess
import sys
import types
from pathlib import Path

import numpy as np
import pytest
from hypothesis import strategies as st

import poekin.testing
from poekin.errors import InputError
from poekin.groups import se3
from poekin.model.chain import Chain
from poekin.testing.accuracy import falsify
from poekin.testing.laws import group_laws, measures
from poekin.testing.laws.group import Group, make_group
from poekin.testing.laws.laws import Law, LawViolation, check_bounds, checked
from tests.model.laws import chain_bounds

ROOT = Path(__file__).resolve().parents[3]


def test_a_law_returns_its_worst_error_over_bound():
    assert check_bounds("a law", (0.1, 1.0), (3.0, 4.0), (0.0, 0.0)) == 0.75


@pytest.mark.parametrize(
    "pair", [(1.1, 1.0), (math.nan, 1.0), (math.inf, 1.0), (1e-300, 0.0), (0.5, math.nan)]
)
def test_an_error_above_its_bound_is_a_violation(pair):
    with pytest.raises(LawViolation, match="a law") as first_violation:
        check_bounds("a law", (0.0, 1.0), pair, q=np.zeros(2))
    assert first_violation.value.law == "a law"
    assert first_violation.value.error == pytest.approx(pair[0], nan_ok=True)
    assert "q = np.array([0.0, 0.0])" in str(first_violation.value)
    assert isinstance(first_violation.value, AssertionError)


def test_the_arguments_of_a_violation_can_be_pasted_to_the_last_digit():
    xi, none, long = np.array([[1 / 3, -0.0], [5e-324, np.pi]]), np.zeros((0, 6)), np.zeros(1001)
    said = str(LawViolation("a law", 2.0, 1.0, {"xi": xi, "none": none, "long": long, "k": 3}))
    lines = dict(line.split(" = ") for line in said.splitlines() if " = " in line)
    assert eval(lines["  xi"], {"np": np}).tobytes() == xi.tobytes()
    assert eval(lines["  none"], {"np": np}).shape == (0, 6)
    assert lines["  k"] == "3"
    assert "long = array([0., 0., 0., ..., 0., 0., 0." in said


def test_a_message_says_law_error_and_bound_and_an_array_of_400_numbers_whole():
    said = str(LawViolation("a law", 2.0, 1.0, {"x": np.zeros(400)}))
    assert said == f"a law: error 2 exceeds 1\n  x = np.array({[0.0] * 400})"


def test_arguments_by_name_are_in_the_message_too():
    law = checked()(lambda subject, q, step: [(2.0, 1.0)])
    with pytest.raises(LawViolation) as first_violation:
        law(None, 1.0, step=3)
    assert first_violation.value.seen == {"q": 1.0, "step": 3}


def test_a_chain_that_breaks_a_law_is_in_the_message_with_its_numbers():
    rows = [[0, 0, 1, 1 / 3, 0, 0], [0, 1, 0, 0, 0, 0]]
    arm = Chain.from_space(rows, np.eye(4), coupling=[[1], [2]], offset=[0, 0.5], q_names=["q"])
    with pytest.raises(
        LawViolation, match=r"coupling = np\.array\(\[\[1\.0\], \[2\.0\]\]\)"
    ) as first_violation:
        chain_bounds.check_chain_bounds("a law", arm, (2.0, 1.0), q=np.zeros(1))
    assert "screws = np.array([[0.0, 0.0, 1.0, 0.3333333333333333, 0.0, 0.0], " in str(
        first_violation.value
    )
    assert list(first_violation.value.seen) == ["q", "screws", "home", "coupling", "offset"]
    with pytest.raises(LawViolation) as plain:
        chain_bounds.check_chain_bounds("a law", Chain.from_space(rows, np.eye(4)), (2.0, 1.0))
    assert list(plain.value.seen) == ["screws", "home"]


def test_a_law_asks_by_name_for_a_function_that_is_not_there():
    alone = Group(6, exp=se3.exp)
    xi = np.array([0.1, 0.2, 0.3, 1.0, 2.0, 3.0])
    assert group_laws.exp_adds_along_a_line(alone, xi) <= 1
    with pytest.raises(InputError, match="needs the function log"):
        group_laws.log_undoes_exp(alone, xi)
    assert group_laws.log_undoes_exp(alone._replace(log=se3.log), xi) <= 1


def test_a_group_is_made_of_the_functions_that_an_object_has():
    assert make_group(se3, 6) == Group(6, *(getattr(se3, name) for name in Group._fields[1:]))
    assert make_group(types.SimpleNamespace(exp=se3.exp, log=3), 6) == Group(6, exp=se3.exp)
    with pytest.raises(InputError, match="none of the functions of a group: hat, vee, exp"):
        make_group(types, 6)
    with pytest.raises(InputError, match=r"expected 3 for SO\(3\) or 6 for SE\(3\), got 4"):
        make_group(se3, 4)


def test_a_violation_survives_pickling():
    violation = LawViolation("a law", 2.0, 1.0, {"q": 3})
    again = pickle.loads(pickle.dumps(violation))
    assert (str(again), again.error, again.bound, again.seen) == (
        str(violation),
        2.0,
        1.0,
        {"q": 3},
    )


def below_a_million(limit: float, x: float) -> float:
    return check_bounds("below", (x, limit), x=x)


def test_a_hunt_climbs_to_a_case_that_sampling_would_miss():
    cases = st.tuples(st.integers(0, 10**6).map(float))
    with pytest.raises(LawViolation):
        falsify.hunt(lambda x: below_a_million(999_000.0, x), cases, examples=300)
    falsify.hunt(lambda x: below_a_million(1e6, x), cases, examples=300)


def test_a_battery_names_the_law_that_caught_an_error():
    laws = (
        Law(lambda subject, x: check_bounds("sound", (0.0, 1.0)), ("q",)),
        Law(below_a_million, ("q",)),
    )
    violation = falsify.first_violation(
        laws, lambda law, x: law.check(5.0, x), lambda kinds: st.tuples(st.floats(0, 100))
    )
    assert violation is not None
    assert violation.law == "below"
    assert (
        falsify.first_violation(
            laws, lambda law, x: law.check(500.0, x), lambda kinds: st.tuples(st.floats(0, 100))
        )
        is None
    )


def test_a_size_neither_underflows_nor_hides_nan():
    assert measures.size(np.array([3e-200, 4e-200])) == pytest.approx(5e-200)
    assert measures.size(np.array([5e-324, 0.0])) == 5e-324
    assert measures.size(np.array([3e200, 4e200])) == pytest.approx(5e200)
    assert math.isnan(measures.size(np.array([1.0, math.nan])))
    assert measures.size(np.array([math.inf, 1.0])) == math.inf
    assert measures.size(np.empty(0)) == 0


def test_a_size_with_an_infinite_number_is_infinite_however_large_the_others():
    assert measures.size(np.array([-np.inf, 1e300])) == np.inf


def run(code: str) -> str:
    command = f"import sys; sys.path.insert(0, {str(ROOT)!r})\n{code}"
    return subprocess.run(
        [sys.executable, "-I", "-c", command], capture_output=True, text=True, check=True
    ).stdout


def test_importing_the_room_imports_no_optional_package():
    loaded = run(
        "import poekin.testing\nprint({'hypothesis', 'mpmath', 'pinocchio'} & set(sys.modules) or 'none')"
    )
    assert loaded.strip() == "none"


@pytest.mark.parametrize(
    ("modules", "package"),
    [
        (("oracles.exact", "accuracy.error_bounds"), "mpmath"),
        (("strategies", "accuracy.falsify"), "hypothesis"),
    ],
)
def test_a_missing_package_is_named_with_the_extra_that_brings_it(modules, package):
    said = run(
        f"sys.modules[{package!r}] = None\nfrom poekin.errors import MissingExtra\n"
        + "".join(
            f"try: import poekin.testing.{module}\nexcept MissingExtra as error: print(error)\n"
            for module in modules
        )
    ).splitlines()
    assert len(said) == len(modules)
    assert all(package in line and "poekin[testing]" in line for line in said)


@pytest.mark.parametrize("name", poekin.testing.__all__)
def test_every_room_can_be_reached_by_name(name):
    assert getattr(poekin.testing, name).__doc__
    assert name in dir(poekin.testing)


def test_an_unknown_room_is_an_attribute_error():
    with pytest.raises(
        AttributeError, match=r"module 'poekin\.testing' has no attribute 'nowhere'"
    ):
        poekin.testing.nowhere  # noqa: B018
