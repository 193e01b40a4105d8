"""What a change of the screws does to pose and Jacobian, against central differences."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from poekin.formulas.kinematics import screw_changes
from tests.formulas.matrices import Ad, exp, flat
from tests.formulas.moving_screws import (
    FRAMES,
    HOME,
    SCREWS,
    X,
    close,
    jacobian,
    products,
    slope,
    twist_of,
)


def moved(index, eta, count):
    """The screws and the home pose after A_i <- Ad(e^eta) A_i, or M <- M e^eta for i = n."""
    A, home = SCREWS[:count].copy(), HOME
    if index == count:
        return A, home @ exp(eta)
    A[index] = Ad(exp(eta)) @ A[index]
    return A, home


@pytest.mark.parametrize("count", [1, 3])
@FRAMES
def test_what_a_screw_s_change_does_is_the_difference_it_makes(frame, count):
    x = X[:count]
    before = products(SCREWS[:count], x)
    f = before[-1] @ HOME
    P, D = np.full((count + 2, 12), np.nan), np.full((6, count + 1, 6), np.nan)
    screw_changes.products(
        [flat(exp(S * q)) for S, q in zip(SCREWS[:count], x, strict=True)], flat(HOME), count, P
    )
    np.testing.assert_allclose(P, [flat(T) for T in (*before, f)], rtol=0, atol=1e-12)
    screw_changes.pose_changes(P, count, D)
    J_s = jacobian(SCREWS[:count], HOME, x, "space")
    C = np.full((6, count, count + 1, 6), np.nan)
    changes: Any = {"space": screw_changes.space_changes, "body": screw_changes.body_changes}
    changes.get(frame, screw_changes.hybrid_changes)(J_s, P, D, count, C)
    for i in range(count + 1):
        for e, unit in enumerate(np.eye(6)):

            def after(h, i=i, unit=unit):
                return moved(i, h * unit, count)

            pose = slope(lambda h, after=after: products(after(h)[0], x)[-1] @ after(h)[1])
            close(D[:, i, e], twist_of(pose, f))
            close(
                C[:, :, i, e],
                slope(lambda h, after=after: jacobian(after(h)[0], after(h)[1], x, frame)),
            )


@pytest.mark.parametrize("seed", range(3))
def test_a_source_moves_the_tool_as_differences_of_the_pose_say(seed):
    count = 3
    source = np.random.default_rng(seed).normal(size=(count + 1, 6))
    x = X[:count]
    P, D = np.full((count + 2, 12), np.nan), np.full((6, count + 1, 6), np.nan)
    joints = [flat(exp(S * q)) for S, q in zip(SCREWS[:count], x, strict=True)]
    screw_changes.products(joints, flat(HOME), count, P)
    screw_changes.pose_changes(P, count, D)
    V = screw_changes.source_twist(D.tolist(), tuple(P[-1, 9:]), source.tolist(), count)

    def tool(step):
        A = [Ad(exp(step * eta)) @ S for eta, S in zip(source, SCREWS[:count], strict=False)]
        return products(np.array(A), x)[-1] @ HOME @ exp(step * source[-1])

    step = 1e-5
    slope_of_pose = (tool(step) - tool(-step)) / (2 * step)
    spin = slope_of_pose[:3, :3] @ tool(0.0)[:3, :3].T
    dw = [spin[2, 1], spin[0, 2], spin[1, 0]]
    # third derivatives, of some hundred, times step² / 6, and roundings over the step
    np.testing.assert_allclose(V, [*dw, *slope_of_pose[:3, 3]], rtol=0, atol=1e-7)
    assert screw_changes.squared_rotation(V) == pytest.approx(np.dot(V[:3], V[:3]), rel=1e-15)
    assert screw_changes.squared_displacement(V) == pytest.approx(np.dot(V[3:], V[3:]), rel=1e-15)
