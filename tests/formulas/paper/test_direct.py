"""The direct method against products of 4x4 and 6x6 matrices."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.formulas.paper import direct
from tests.formulas.four_joints import (
    COUNTS,
    EXPONENTIALS,
    SCREWS,
    rows,
    same,
)
from tests.formulas.matrices import Ad, exp, flat, product


@COUNTS
def test_the_direct_method_carries_each_screw_by_the_exponentials_before_or_behind_it(count):
    exponentials = [flat(E) for E in EXPONENTIALS[:count]]
    J = rows(count)
    before = direct.space(SCREWS, exponentials, count, J)
    same(J, np.transpose([Ad(product(*EXPONENTIALS[:i])) @ SCREWS[i] for i in range(count)]))
    same(before, flat(product(*EXPONENTIALS[: max(count - 1, 1)])))
    behind = direct.body(SCREWS, exponentials, count, J)
    after = [product(*EXPONENTIALS[i + 1 : count]) for i in range(count)]
    same(
        J,
        np.transpose(
            [Ad(np.linalg.inv(T)) @ S for T, S in zip(after, SCREWS[:count], strict=True)]
        ),
    )
    same(behind, flat(product(*EXPONENTIALS[min(1, count - 1) : count])))


@pytest.mark.parametrize("space", [True, False])
def test_three_hundred_joints_are_as_good_as_three(space):
    n, step = 300, exp((0.01, -0.02, 0.015, 0.002, 0.001, -0.003))
    S, J = np.array([0, 0, 1, 0, 0, 0.1]), rows(n)
    formula = direct.space if space else direct.body
    formula([tuple(S)] * n, [flat(step)] * n, n, J)
    for i in (0, 1, 2, 150, n - 3, n - 2, n - 1):
        T = np.linalg.matrix_power(step, i if space else n - 1 - i)
        expected = Ad(T if space else np.linalg.inv(T)) @ S
        np.testing.assert_allclose(J[:, i], expected, rtol=0, atol=1e-11)
