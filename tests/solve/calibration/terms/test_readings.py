"""Terms of the readings themselves: coupling to the neighbours, and harmonics of the angles."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.terms.conditions import at_rest
from poekin.solve.calibration.terms.readings import coupling, harmonics, second_harmonics

# two joints that turn, beside one that slides
ARM = pk.Chain.from_space(
    [
        pk.screw.revolute([0, 0, 1], [0, 0, 0]),
        pk.screw.prismatic([0, 0, 1]),
        pk.screw.revolute([0, 1, 0], [0.3, 0, 0]),
    ],
    pk.se3.pose(np.eye(3), [1.0, 0, 0]),
    joint_names=["turn", "lift", "bend"],
)
Q = np.array([[0.3, 0.5, -1.2], [2.0, -0.25, 0.7]])
ALL = np.arange(3)


def basis(terms):  # type: ignore[no-untyped-def]
    """Names of the coefficients, and the basis (N, 3, k) of the only term."""
    (term,) = terms
    return [(p.owner, p.what, p.unit) for p in term.parameters], term.basis(Q, at_rest(Q, {}))


def test_each_coordinate_follows_the_one_before_it_and_the_one_behind_it():
    names, B = basis(coupling(ARM, ALL, {}))
    assert names == [
        ("turn", "coupling to lift", "1"),
        ("lift", "coupling to turn", "1"),
        ("lift", "coupling to bend", "1"),
        ("bend", "coupling to lift", "1"),
    ]
    expected = np.zeros((2, 3, 4))
    for k, (to, other) in enumerate([(0, 1), (1, 0), (1, 2), (2, 1)]):
        expected[:, to, k] = Q[:, other]
    np.testing.assert_array_equal(B, expected)


def test_one_coordinate_alone_has_its_own_neighbours():
    names, _ = basis(coupling(ARM, np.array([2]), {}))
    assert names == [("bend", "coupling to lift", "1")]
    one = pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [0, 0, 0])], np.eye(4))
    assert coupling(one, np.array([0]), {}) == []


@pytest.mark.parametrize(
    ("term", "k", "angle"), [(harmonics, 1, "q"), (second_harmonics, 2, "2 q")]
)
def test_what_turns_errs_by_the_sine_and_the_cosine_of_its_angle(term, k, angle):
    names, B = basis(term(ARM, ALL, {}))
    assert names == [
        (owner, f"{function} {angle}", "rad")
        for function in ("sin", "cos")
        for owner in ("turn", "bend")
    ]
    expected = np.zeros((2, 3, 4))
    for j, i in enumerate([0, 2]):
        turned = np.exp(1j * k * Q[:, i])
        expected[:, i, j] = turned.imag
        expected[:, i, 2 + j] = turned.real
    np.testing.assert_allclose(B, expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("term", "name"), [(coupling, "coupling"), (harmonics, "harmonics"), (second_harmonics, "second harmonics")]
)  # fmt: skip
def test_a_term_is_called_as_it_is_asked_for(term, name):
    assert [found.name for found in term(ARM, ALL, {})] == [name]


def test_what_slides_has_no_angle_that_an_error_could_repeat_with():
    assert harmonics(ARM, np.array([1]), {}) == second_harmonics(ARM, np.array([1]), {}) == []
