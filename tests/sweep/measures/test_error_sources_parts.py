"""Covariances to rounding, and tolerances that are none."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.sweep.measures.error_sources import covariance_sources, tolerance_sources
from tests.messages import says
from tests.sweep.arms import two_links

ARM = two_links()


def with_entry(value, at):
    C = np.diag(np.linspace(1, 2, 18))
    C[at] = value
    return C


def test_a_covariance_is_symmetric_and_has_no_negative_eigenvalue_up_to_rounding():
    C = with_entry(0.5, (0, 1))
    for lower, is_taken in ((0.5 * (1 + 0.9e-9), True), (0.5 * (1 + 1.1e-9), False)):
        C[1, 0] = lower
        if is_taken:
            flat = covariance_sources(ARM, C).reshape(-1, 18)
            # the entries' mean, to rounding
            assert (flat.T @ flat)[0, 1] == pytest.approx((0.5 + lower) / 2, abs=1e-14)
            continue
        with pytest.raises(InputError) as caught:
            covariance_sources(ARM, C)
        assert says(caught.value, "covariance: expected a symmetric matrix of finite numbers")
    # of the largest eigenvalue, 2
    assert len(covariance_sources(ARM, with_entry(-1.98e-10, (0, 0)))) == 17
    with pytest.raises(InputError) as caught:
        covariance_sources(ARM, with_entry(-2.02e-10, (0, 0)))
    assert says(caught.value, "covariance: expected no negative eigenvalue, got -2.02e-10")
    with pytest.raises(InputError):
        covariance_sources(ARM, with_entry(np.nan, (0, 0)))


def test_a_source_of_an_offset_moves_all_screws_behind_it_and_the_home_pose():
    sources = tolerance_sources(ARM, 0, 0, [0.0, 3.0], 0, 0)
    # both axes are along z; the second is at (0.5, 0), 0.3 m before the tool
    assert sources.shape == (1, 3, 6)
    np.testing.assert_allclose(sources[0, :2], 0, atol=0)
    np.testing.assert_allclose(sources[0, 2], [0, 0, 3, 0, 3 * 0.3, 0], atol=1e-15)
    first = tolerance_sources(ARM, 0, 0, [2.0, 0.0], 0, 0)
    np.testing.assert_allclose(first[0, 1], [0, 0, 2, 0, 0, 0], atol=1e-15)
    np.testing.assert_allclose(first[0, 2], [0, 0, 2, 0, 2 * 0.8, 0], atol=1e-15)


def test_there_are_as_many_sources_as_numbers_that_are_off():
    all_of_them = tolerance_sources(ARM, 1.0, [1.0, 2.0], 1.0, 1.0, 1.0)
    assert all_of_them.shape == (2 * 2 + 2 * 2 + 2 + 3 + 3, 3, 6)
    assert tolerance_sources(ARM, 0, 0, 0, 1e-300, 0).shape == (3, 3, 6)
    seven = pk.load("iiwa14").chain()
    assert tolerance_sources(seven, 1.0, 1.0, 1.0, 1.0, 1.0).shape == (4 * 7 + 7 + 6, 8, 6)
    assert tolerance_sources(ARM, 0, 0, 0, 0, 0).shape == (0, 3, 6)


@pytest.mark.parametrize(
    ("place", "value", "kind", "words"),
    [
        (0, [1, 1, 1], ShapeError, "tilt: expected one or 2 numbers, got (3,)"),
        (1, [[1, 1]], ShapeError, "shift: expected one or 2 numbers, got (1, 2)"),
        (2, -0.1, InputError, "offset: expected finite numbers from 0 on, got -0.1"),
        (3, np.nan, InputError, "home_rotation: expected finite numbers from 0 on, got [nan]"),
        (4, -1, InputError, "home_position: expected finite numbers from 0 on, got [-1]"),
    ],
)
def test_what_is_no_tolerance_is_refused(place, value, kind, words):
    given = [0, 0, 0, 0, 0]
    given[place] = value
    with pytest.raises(kind) as caught:
        tolerance_sources(ARM, *given)
    assert says(caught.value, words)
