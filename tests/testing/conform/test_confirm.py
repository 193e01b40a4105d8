"""The second oracle agrees with the truth, and does not where the truth is off in the 40th digit."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.testing import exact
from poekin.testing.conform import confirm

XI = np.array([0.4, -0.2, 0.7, 1.5, -2.0, 0.1])
SMALL = np.concatenate([1e-12 * XI[:3], XI[3:]])
T = exact.rounded(exact.exp(XI))
SCREWS, HOME, X = np.array([[0, 0, 1.0, 0, 0, 0], [0, 1.0, 0, -0.3, 0, 0]]), T, np.array([0.3, -1.0])

CASES = {
    "exp": ("exp", lambda: confirm.of_exp(XI)),
    "exp of a small angle": ("exp", lambda: confirm.of_exp(SMALL)),
    "exp of SO(3)": ("exp", lambda: confirm.of_exp(XI[:3])),
    "log": ("log", lambda: confirm.of_log(T)),
    "log of SO(3)": ("log", lambda: confirm.of_log(T[:3, :3])),
    "left": ("left_jacobian", lambda: confirm.of_jacobian("left_jacobian", XI)),
    "right": ("right_jacobian", lambda: confirm.of_jacobian("right_jacobian", XI)),
    "left inverse": ("left_jacobian_inverse", lambda: confirm.of_jacobian("left_jacobian_inverse", XI)),
    "right inverse": ("right_jacobian_inverse", lambda: confirm.of_jacobian("right_jacobian_inverse", XI[:3])),
    "pose": ("forward", lambda: confirm.of_pose(SCREWS, HOME, X)),
}


@pytest.mark.parametrize("name", CASES)
def test_the_oracles_agree_and_a_planted_error_of_1e_40_is_seen(name, monkeypatch):
    function, agrees = CASES[name]
    assert agrees()
    true = getattr(exact, function)

    def wrong(*arguments):
        result = np.array(true(*arguments), dtype=object)
        result.flat[1] += exact.mp.mpf(10) ** -40
        return result

    monkeypatch.setattr(exact, function, wrong)
    assert not agrees()


def test_another_branch_is_no_logarithm(monkeypatch):
    true = exact.log

    def longer(R):
        w = true(R)
        return w * (1 - 2 * exact.mp.pi / exact.norm(w))

    monkeypatch.setattr(exact, "log", longer)
    assert not confirm.of_log(T[:3, :3])


def test_the_adjoint_and_velocities_are_confirmed_and_a_wrong_one_is_not(monkeypatch):
    columns = np.stack([exact.exactly(SCREWS[0]), exact.adjoint(exact.exp(SCREWS[0] * X[0])) @ SCREWS[1]], axis=1)
    assert confirm.of_velocities(SCREWS, HOME, X, columns)
    columns[2, 0] += exact.mp.mpf(10) ** -30
    assert not confirm.of_velocities(SCREWS, HOME, X, columns)
    assert confirm.of_adjoint(T)
    true = exact.adjoint
    monkeypatch.setattr(exact, "adjoint", lambda T: true(T) + exact.mp.mpf(10) ** -10)
    assert not confirm.of_adjoint(T)
