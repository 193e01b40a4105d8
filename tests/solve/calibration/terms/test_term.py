"""Terms as data: equal by name and coefficients, refused where they do not fit, sums by their factors."""

from __future__ import annotations

from dataclasses import FrozenInstanceError
from typing import Any

import numpy as np
import pytest

from poekin.errors import InputError, ShapeError
from poekin.solve.calibration import Parameter, Term
from poekin.solve.calibration.terms.conditions import at_rest, parse_conditions
from poekin.solve.calibration.terms.scalars import linear, of_rows
from poekin.solve.calibration.terms.term import checked_basis, make_term, name_of
from tests.messages import says

Q = np.random.default_rng(0).normal(size=(5, 3))
REST = at_rest(Q, {})
PARAMETERS = (Parameter("a", "ripple", "rad"), Parameter("b", "ripple", "rad"))


def term(basis: Any, name: str = "own", formula: Any = None) -> Term:
    return Term(name, PARAMETERS, basis, formula)


@pytest.mark.parametrize(
    "shape", [(5, 3), (5, 3, 1), (5, 3, 3), (5, 4, 2), (5, 2, 2), (4, 3, 2), (6, 3, 2)]
)
def test_a_basis_of_another_shape_is_refused_with_both(shape):
    with pytest.raises(ShapeError) as caught:
        checked_basis(term(lambda q, c: np.ones(shape)), Q, REST)
    words = f"basis of the term 'own': expected shape (5, 3, 2), got {shape}"
    assert says(caught.value, words)
    B = np.ones((5, 3, 2))
    np.testing.assert_array_equal(checked_basis(term(lambda q, c: B), Q, REST), B)


def test_a_name_of_sixty_letters_is_said_whole_and_a_longer_one_is_cut():
    for length, said in ((60, 60 * "x"), (61, None)):
        with pytest.raises(ShapeError) as caught:
            checked_basis(term(lambda q, c: q, name=length * "x"), Q, REST)
        quoted = str(caught.value).split("'")[1]
        assert len(quoted) == 60
        assert said is None or quoted == said


def test_terms_are_equal_by_their_names_and_coefficients_alone():
    one, other = term(lambda q, c: q), term(lambda q, c: -q, formula=object())
    assert one == other
    assert one != term(lambda q, c: q, name="another")
    assert "basis" not in repr(one)
    assert "formula" not in repr(other)
    with pytest.raises(FrozenInstanceError):
        one.name = "another"  # type: ignore[misc]
    assert (name_of(one), name_of("lag")) == ("own", "lag")


@pytest.mark.parametrize(("name", "count"), [("", 2), ("own", 0), ("", 0)])
def test_a_term_has_a_name_and_coefficients(name, count):
    with pytest.raises(InputError, match=r"^Term: expected a name and at least one coefficient$"):
        Term(name, PARAMETERS[:count], lambda q, c: q)


def test_each_column_is_added_at_the_coordinate_that_it_belongs_to():
    owners = np.array([2, 0])
    (made,) = make_term("own", iter(PARAMETERS), owners, lambda x: [x.q[1], 3.0 * x.payload])
    conditions, _ = parse_conditions({"payload": [1.0, 2, 3, 4, 5]}, Q)
    B = made.basis(Q, conditions)
    expected = np.zeros((5, 3, 2))
    expected[:, 2, 0], expected[:, 0, 1] = Q[:, 1], [3, 6, 9, 12, 15]
    np.testing.assert_array_equal(B, expected)
    assert made.parameters == PARAMETERS
    assert made.formula is not None
    assert made.formula.owners is owners
    assert make_term("own", [], owners[:0], lambda x: []) == []


def test_a_sum_has_the_offset_and_what_has_a_factor():
    assert linear([2.0, -1.0], [3.0, 5.0], 0.25) == 1.25
    # what has none is not looked at, as code that is written for it has no such term
    assert linear([0.0, 2.0], [None, 3.0], 1.0) == 7.0
    assert linear([], [], 0.5) == 0.5
    with pytest.raises(ValueError, match="zip"):
        linear([1.0], [3.0, 5.0], 0.0)


def test_readings_and_conditions_of_rows_are_scalars_one_a_column():
    given = {"payload": np.arange(5.0), "gravity": [0.6, 0.0, -0.8], "time": np.arange(5.0)}
    conditions, _ = parse_conditions(given, Q)
    found = of_rows(Q, conditions)
    for k in range(3):
        np.testing.assert_array_equal(found.q[k], Q[:, k])
        np.testing.assert_array_equal(found.gravity[k], conditions.gravity[:, k])
        np.testing.assert_array_equal(found.approach[k], conditions.approach[:, k])
        np.testing.assert_array_equal(found.previous[k], conditions.previous[:, k])
    np.testing.assert_array_equal(found.payload, np.arange(5.0))
    np.testing.assert_array_equal(found.drift, conditions.drift)
    x = 2.0 * Q[:, 0] - Q[:, 2] + 0.3
    sine, cosine = found.sine_cosine([2.0, 0.0, -1.0], 0.3)
    np.testing.assert_allclose(sine, np.sin(x), rtol=0, atol=1e-15)
    np.testing.assert_allclose(cosine, np.cos(x), rtol=0, atol=1e-15)
