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
from tests.formulas.matrices import Ad, exp, flat, matrix, product


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


def test_example_1_of_the_paper():
    """A 3R arm with L1 = 0.4, L2 = 0.3: M, w_i and v_i as printed; the pose by trigonometry."""
    screws = [(0, 0, 1, 0, 0, 0), (0, -1, 0, 0, 0, 0), (0, -1, 0, 0, 0, -0.4)]
    q1, q2, q3 = q = np.array([0.3, 0.8, -1.1])
    moves = [exp(x * np.array(S)) for S, x in zip(screws, q, strict=True)]
    J = rows(3)
    before = direct.space(screws, [flat(E) for E in moves], 3, J)
    f = product(*moves) @ matrix(np.eye(3), (0.7, 0, 0))
    along = 0.4 * np.cos(q2) + 0.3 * np.cos(q2 + q3)
    up = 0.4 * np.sin(q2) + 0.3 * np.sin(q2 + q3)
    same(f[:3, 3], [along * np.cos(q1), along * np.sin(q1), up])
    same(before, flat(product(*moves[:2])))
    # the axes of joints 2 and 3 are horizontal, and joint 3's passes through the elbow
    z, elbow = np.array([np.sin(q1), -np.cos(q1), 0]), 0.4 * np.cos(q2)
    o = np.array([elbow * np.cos(q1), elbow * np.sin(q1), 0.4 * np.sin(q2)])
    same(J, np.transpose([[0, 0, 1, 0, 0, 0], [*z, 0, 0, 0], [*z, *np.cross(o, z)]]))


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
