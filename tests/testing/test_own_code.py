"""Somebody's own code, held to laws and oracles on drawn cases."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.testing.conform.laws import of_arms
from poekin.testing.laws import group_laws
from poekin.testing.laws.group import Group
from poekin.testing.laws.laws import LawViolation
from poekin.testing.oracles import differences, exact
from poekin.testing.strategies import chain_strategies, group_strategies, near_strategies

quick = settings(max_examples=25, deadline=None)  # the first call may compile


def my_exp(xi):
    w, v = xi[:3], xi[3:]
    t = math.hypot(*w)
    W, unit = np.cross(np.eye(3), w), np.eye(3)
    a, b = np.sinc(t / math.pi), np.sinc(t / 2 / math.pi) ** 2 / 2
    series = ((-1) ** k * t ** (2 * k) / math.factorial(2 * k + 3) for k in range(9))
    c = (1 - a) / t**2 if t > 1 else sum(series)
    return group_strategies.pose(unit + a * W + b * W @ W, (unit + b * W + c * W @ W) @ v)


def hasty_exp(xi):
    if math.hypot(*xi[:3]) < 1e-5:
        R = my_exp(xi)[:3, :3]
        return group_strategies.pose(R, R @ xi[3:])  # V is not R
    return my_exp(xi)


@quick
@given(xi=st.one_of(group_strategies.twists(), near_strategies.near_twists(0.0)))
def test_my_exp_is_exact_to_rounding(xi):
    error = np.abs(my_exp(xi) - exact.rounded(exact.exp(xi))).max()
    assert error <= 1e-14 * (1 + np.abs(xi).max())


@quick
@given(xi=group_strategies.twists(largest=10.0))
def test_my_exp_adds_along_a_line(xi):
    group_laws.exp_adds_along_a_line(Group(6, exp=my_exp), xi)


def test_a_hasty_exp_does_not():
    @settings(quick, max_examples=300, database=None, derandomize=True)
    @given(xi=group_strategies.twists(lengths=(1e-3, 1e3)))
    def law(xi):
        group_laws.exp_adds_along_a_line(Group(6, exp=hasty_exp), xi)

    with pytest.raises(LawViolation, match=r"exp adds along a line: error .* exceeds"):
        law()


SCREWS = np.array([[0, 0, 1, 0, 0, 0], [0, 1, 0, -0.4, 0, 0], [0, 1, 0, -0.4, 0, 0.5]])
ARM = pk.Chain.from_space(SCREWS, np.eye(4))


def my_fk(q):
    return my_exp(SCREWS[0] * q[0]) @ my_exp(SCREWS[1] * q[1]) @ my_exp(SCREWS[2] * q[2])


@quick
@given(q=chain_strategies.coordinates(ARM))
def test_my_fk_is_the_product_of_exponentials(q):
    of_arms.fk_is_the_product_of_exponentials(my_fk, ARM, q)


@quick
@given(q=chain_strategies.coordinates(ARM))
def test_a_jacobian_is_the_derivative_of_my_fk(q):
    J = differences.jacobian(my_fk, q, "space")
    assert np.abs(ARM.jacobian(q, "space") - J).max() < 1e-12
