"""Accuracy of exp, log and the Jacobians of exp against 60 digits, in every decade and at every
switch.
"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings, target
from hypothesis import strategies as st

from benchmarks.accuracy.worst_errors import worst_errors
from poekin.groups import se3, so3
from poekin.testing.accuracy import error_bounds
from poekin.testing.accuracy.accuracy_laws import ACCURACY_LAWS
from poekin.testing.laws.group import make_group
from poekin.testing.oracles import exact
from poekin.testing.strategies import group_strategies

N = np.array([0.6, -0.64, 0.48])
# Where a formula changes over, one example in a hundred may be the only one that shows it.
MORE = settings(max_examples=2 * settings().max_examples)


@pytest.mark.parametrize("law", ACCURACY_LAWS, ids=lambda law: law.name)
@pytest.mark.parametrize(("module", "size"), [(so3, 3), (se3, 6)], ids=["so3", "se3"])
@MORE
@given(data=st.data())
def test_the_accuracy_is_kept(module, size, law, data):
    target(
        law.check(
            make_group(module, size), *data.draw(group_strategies.group_cases(law.kinds, size))
        )
    )


# The report judges eight times as many.
SOME = {"seed": 3, "samples": 40, "sweep": 5000}


@pytest.fixture(scope="module")
def rows():
    return worst_errors(**SOME)


def test_the_rows_of_the_report_keep_their_bars(rows):
    assert [row.what for row in rows if not row.passed] == []
    assert len({row.what for row in rows}) == 12
    assert all(row.cases >= SOME["samples"] for row in rows)


def test_the_rows_are_the_same_for_the_same_seed(rows):
    assert [row.error for row in rows] == [row.error for row in worst_errors(**SOME)]


def changed(module, **functions):
    return SimpleNamespace(**{name: getattr(module, name) for name in module.__all__} | functions)


def log_with_positive_z(T):
    xi = se3.log(T)
    return np.where(
        (np.linalg.norm(xi[..., :3], axis=-1) > math.pi - 1e-9)[..., None], np.abs(xi), xi
    )


def log_without_projection(R):
    s = so3.vee(R)
    sine = np.linalg.norm(s, axis=-1, keepdims=True)
    angle = np.arctan2(sine[..., 0], (np.trace(R, axis1=-2, axis2=-1) - 1) / 2)[..., None]
    return np.where(sine > 1e-2, s * angle / np.where(sine > 0, sine, 1), so3.log(R))


def longer_v(xi):
    return xi * np.repeat([1, 1 + 4e-15], 3)


# Errors in different functions show in different rows: one run shows several of them.
PLANTED = [
    {
        "exp: error": changed(se3, exp=lambda xi: se3.exp(xi * (1 + 1e-15))),
        "log: error": changed(se3, log=lambda T: se3.log(T) * (1 + 2e-15)),
        "left jacobian: 3×3": changed(
            se3, left_jacobian=lambda xi: se3.left_jacobian(xi) * (1 + 1e-15)
        ),
        "right jacobian: 3×3": changed(se3, right_jacobian=se3.left_jacobian),
        "left jacobian inverse: 3×3": changed(
            se3, left_jacobian_inverse=lambda xi: np.linalg.inv(se3.right_jacobian(xi))
        ),
    },
    {
        "log: largest": changed(se3, log=log_with_positive_z),
        "left jacobian: Q": changed(se3, left_jacobian=lambda xi: se3.left_jacobian(longer_v(xi))),
        "right jacobian inverse: Q": changed(
            se3, right_jacobian_inverse=lambda xi: se3.right_jacobian_inverse(longer_v(xi))
        ),
    },
]


@pytest.mark.parametrize("planted", PLANTED, ids=lambda planted: ", ".join(planted))
def test_planted_errors_show_in_their_rows(planted):
    together = {
        name: getattr(subject, name)
        for subject in planted.values()
        for name in se3.__all__
        if getattr(subject, name) is not getattr(se3, name)
    }
    rotation = changed(so3, log=log_without_projection)
    rows = worst_errors(
        seed=3, samples=20, sweep=100, rotation=rotation, pose=changed(se3, **together)
    )
    failed = [row.what for row in rows if not row.passed]
    assert "log of a noisy rotation: error" in failed
    for row in planted:
        assert any(what.startswith(row) for what in failed), (row, failed)


@pytest.mark.parametrize("angle", [5e-324, 1e-310, 1e-300, 1e-200, 1e-160])
def test_below_1e_150_there_is_no_nan_and_no_zero(angle):
    w = angle * N
    if not w.any():
        w = np.array([angle, 0, 0])
    xi = np.concatenate([w, [1.0, -2.0, 3.0]])
    T = se3.exp(xi)
    assert np.isfinite(T).all()
    assert np.array_equal(T[:3, 3], xi[3:])
    for found in (so3.log(so3.exp(w)), se3.log(T)[:3]):
        assert np.isfinite(found).all()
        assert found.any()
    for function in (
        se3.left_jacobian,
        se3.right_jacobian,
        se3.left_jacobian_inverse,
        se3.right_jacobian_inverse,
    ):
        assert np.isfinite(function(xi)).all()


@pytest.mark.parametrize("gap", [9e-16, 2e-15, 1e-12, 1e-8, 1e-4])
def test_the_sign_near_pi_is_that_of_the_matrix(gap):
    rng = np.random.default_rng(0)
    for n in rng.normal(size=(30, 3)):
        R = exact.rounded(
            exact.exp(exact.exactly(n / np.linalg.norm(n)) * (exact.mp.pi - exact.mp.mpf(gap)))
        )
        truth = exact.log(R)
        # Rounding the matrix moves its angle by a few u: the bar counts from the angle that it has
        # then.
        if exact.mp.pi - exact.norm(truth) >= error_bounds.BOTH_SIGNS:
            assert float(truth @ exact.exactly(so3.log(R))) > 0


@pytest.mark.parametrize("switch", [s for s in group_strategies.SWITCHES if s > 1e-3])
def test_both_sides_of_a_switch_agree(switch):
    v = np.array([0.3, 2.0, -1.1])
    for n in (np.array([1.0, 0, 0]), N):
        sides = [np.concatenate([x * n, v]) for x in group_strategies.around(switch)]
        for function in (se3.exp, se3.left_jacobian, se3.left_jacobian_inverse):
            values = [function(xi) for xi in sides]
            assert max(np.abs(value - values[0]).max() for value in values) < 5e-15
