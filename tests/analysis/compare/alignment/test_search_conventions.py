"""Beside other zeros of all joints, and another base, the axis that is wrong is found and no other."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.planted_changes import planted, random_arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment.search import search
from poekin.groups import se3

TOL = Tolerances(1e-5, np.radians(1e-3))


@pytest.mark.parametrize(("kind", "k"), [("tilt", 1), ("shift", 2), ("tilt", 3), ("shift", 4)])
def test_one_wrong_axis_is_told_from_zeros_that_all_differ(kind, k):
    rng = np.random.default_rng(k)
    chain = random_arm(k, ("revolute",) * 5)
    zeros = rng.normal(size=5)
    other = planted(chain, kind, k, rng).rezeroed(zeros)
    found, _ = search(chain, other.rebased(se3.exp(rng.normal(size=6))), TOL)
    assert np.flatnonzero(found.moved).tolist() == [k]
    # the zero of the joint in front of a wrong last axis, as its own, is one of the tool
    told = np.arange(1, 3 if k == 4 else 4)
    # a shift of 1 mm and a tilt of 0.1 degrees move the zeros of an axis by no more than they are
    np.testing.assert_allclose(found.zeros[told], -zeros[told], rtol=0, atol=5e-3)
    assert np.flatnonzero(found.offset).tolist() == told.tolist()
    assert found.frames == 2


def test_zeros_that_all_differ_and_nothing_else_move_no_axis():
    chain = random_arm(5, ("revolute",) * 5)
    zeros = np.array([0.4, -0.7, 1.2, -2.0, 0.9])
    found, _ = search(chain, chain.rezeroed(zeros), TOL)
    assert not found.moved.any()
    np.testing.assert_allclose(found.zeros[1:4], -zeros[1:4], rtol=0, atol=1e-9)


@pytest.mark.parametrize("seed", [31, 56, 59])
def test_of_two_wrong_axes_each_is_told_and_no_link_that_lies_between_them(seed):
    rng = np.random.default_rng(seed)
    chain = random_arm(seed, ("revolute",) * 4)
    screws = chain.screws.copy()
    for k in (2, 3):
        screws[k] = se3.adjoint(se3.exp(0.02 * rng.normal(size=6))) @ screws[k]
    found, _ = search(chain, chain.replace(screws=screws), TOL)
    assert np.flatnonzero(found.moved).tolist() == [2, 3]
    assert (found.link, found.frames) == (0, 0)
