"""The paper's recursions against products of 4x4 and 6x6 matrices."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from poekin.formulas.kinematics import recursive
from tests.formulas.four_joints import (
    COUNTS,
    LOCAL,
    MOVED,
    RATES,
    ROTATES,
    SLIDES,
    TOOL,
    rng,
    rows,
    same,
)
from tests.formulas.matrices import Ad, exp, flat, product


@COUNTS
def test_the_recursions_give_the_tool_s_screws_in_its_own_frame(count):
    moved = [flat(T) for T in MOVED]
    formulas: list[tuple[Any, tuple]] = [
        (recursive.body, ()),
        (recursive.body_with_tool, (flat(TOOL),)),
    ]
    for formula, tool in formulas:
        J = rows(count)
        T = formula(moved, *tool, ROTATES, SLIDES, count, J)
        last = TOOL if tool else np.eye(4)
        behind = [product(*MOVED[i + 1 : count], last) for i in range(count)]
        same(
            J,
            np.transpose(
                [Ad(np.linalg.inv(T)) @ S for T, S in zip(behind, LOCAL[:count], strict=True)]
            ),
        )
        # of one joint without a tool there is no frame between the joint's and the tool's, and
        # f_{1,n} stands for f
        same(T, flat(behind[0] if tool or count > 1 else MOVED[0]))


@pytest.mark.parametrize("begin, end", [(0, 1), (0, 2), (0, 3), (0, 4), (1, 2), (1, 4)])
def test_the_velocity_is_that_of_the_body_jacobian(begin, end):
    behind = [product(*MOVED[i + 1 : end], TOOL) for i in range(begin, end)]
    steps = zip(behind, LOCAL[begin:end], RATES[begin:end], strict=True)
    expected = sum(Ad(np.linalg.inv(T)) @ S * rate for T, S, rate in steps)
    moved = [flat(T) for T in MOVED[begin:]]
    kinds = ROTATES[begin:], SLIDES[begin:], end - begin, RATES[begin:]
    same(recursive.body_velocity(moved, flat(TOOL), *kinds), expected)


def test_a_column_is_the_screw_seen_from_a_frame():
    T = exp(rng.normal(size=6))
    same(recursive.z_column(flat(T), 0.7, 0.4), np.linalg.inv(Ad(T)) @ [0, 0, 0.7, 0, 0, 0.4])


def test_three_hundred_joints_are_as_good_as_three():
    """Columns near the tip, in the middle and near the base; rounding grows with the number of
    products.
    """
    n, step = 300, exp((0.01, -0.02, 0.015, 0.002, 0.001, -0.003))
    S, links, J = np.array([0, 0, 1, 0, 0, 0.1]), [flat(step)] * n, rows(n)
    recursive.body(links, np.ones(n), np.full(n, 0.1), n, J)
    for i in (0, 1, 2, 150, n - 3, n - 2, n - 1):
        behind = np.linalg.inv(np.linalg.matrix_power(step, n - 1 - i))
        np.testing.assert_allclose(J[:, i], Ad(behind) @ S, rtol=0, atol=1e-11)
