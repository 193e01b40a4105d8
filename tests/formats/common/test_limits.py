"""Limits as files have them: what stands for none, up to the last number that does not."""

from __future__ import annotations

import math

import pytest

from poekin.formats.common.limits import (
    UNBOUNDED,
    known_effort,
    known_loss,
    known_velocity,
    without_absurd,
)

INF = math.inf
LEAST = 5e-324


@pytest.mark.parametrize(("known", "absurd"), [(known_velocity, 1e4), (known_effort, 1e16)])
def test_a_limit_of_a_drive_is_known_between_0_and_what_is_absurd(known, absurd):
    most = math.nextafter(absurd, 0)
    for value in (LEAST, 0.5, 1.0, most):
        assert known(value) == value
    for value in (None, -INF, -1.0, -LEAST, 0.0, absurd, 2 * absurd, INF, math.nan):
        assert known(value) == INF


def test_a_loss_is_a_positive_finite_number_or_0():
    for value in (LEAST, 0.5, 1.0, 1e300):
        assert known_loss(value) == value
    for value in (None, -INF, -1.0, -LEAST, 0.0, -0.0, INF, math.nan):
        assert math.copysign(1.0, known_loss(value)) == 1.0
        assert known_loss(value) == 0.0


def test_bounds_of_ten_thousand_and_more_bound_nothing_on_their_side():
    assert UNBOUNDED == (-INF, INF)
    most = math.nextafter(1e4, 0)
    for value in (-most, -0.5, 0.0, 2.0, most):
        assert without_absurd(value, None) == (value, INF)
        assert without_absurd(None, value) == (-INF, value)
        assert without_absurd(value, value) == (value, value)
    for value in (None, -INF, -2e4, -1e4, 1e4, 2e4, INF):
        assert without_absurd(value, 1.0) == (-INF, 1.0)
        assert without_absurd(1.0, value) == (1.0, INF)
