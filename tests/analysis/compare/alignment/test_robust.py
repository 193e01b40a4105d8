"""Robust alignments come near to all axes, and a far one does not drag them along."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.planted_changes import random_arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment import robust
from poekin.analysis.compare.alignment.fit import fit
from poekin.analysis.compare.alignment.lines import sides
from poekin.analysis.compare.alignment.robust import robust_alignments
from poekin.groups import se3
from poekin.model import screw

TOL = Tolerances(1e-5, np.radians(1e-3))
BASE = se3.exp([0.3, -0.2, 0.5, 0.4, 0.1, -0.3])


def shifted(chain, sizes, rng):
    """The arm with each axis turned and moved by so many tolerances."""
    screws = chain.screws.copy()
    for k, size in enumerate(sizes):
        motion = size * rng.normal(size=6) * [*[TOL.rotation] * 3, *[TOL.position] * 3]
        screws[k] = se3.adjoint(se3.exp(motion)) @ screws[k]
    return chain.replace(screws=screws)


@pytest.mark.parametrize("far", [1e2, 1e4])
def test_one_axis_far_off_hardly_moves_either_alignment(far):
    chain = random_arm(1)
    sizes = [5, 5, far, 5, 5, 5]
    other = shifted(chain, sizes, np.random.default_rng(0)).rebased(se3.inverse(BASE))
    pair = sides(chain, other, TOL)
    miss = pair.deviations(robust_alignments(pair))
    # Of normal motions of five tolerances none is beyond five of their standard deviations.
    assert (np.delete(miss, 2, axis=1) < 5 * 5 * np.sqrt(6)).all()
    assert (miss[:, 2] > 0.1 * far).all()


def test_the_sharper_one_ends_at_axes_that_agree_exactly():
    chain = random_arm(2)
    sizes = [0, 0, 300, 300, 30, 3000]
    other = shifted(chain, sizes, np.random.default_rng(1)).rebased(se3.inverse(BASE))
    pair = sides(chain, other, TOL)
    wide, sharp = pair.deviations(robust_alignments(pair))
    assert sharp[:2] == pytest.approx([0, 0], abs=1e-6)
    assert wide.max() < 1.5 * sharp.max()


def test_arms_of_other_kinds_of_joints_alone_stay_where_they_are():
    chain = random_arm(3)
    slides = [screw.prismatic(S[:3]) for S in chain.screws]
    pair = sides(chain, type(chain).from_space(slides, chain.home), TOL)
    found = robust_alignments(pair)
    assert len(found) == 2
    assert np.isfinite(found.P).all()


@pytest.mark.parametrize("seed", range(4))
def test_the_wider_one_is_where_reweighting_settles(seed):
    chain = random_arm(seed)
    sizes = [5, 20, 300, 30, 3, 3000]
    other = shifted(chain, sizes, np.random.default_rng(seed)).rebased(se3.inverse(BASE))
    pair = sides(chain, other, TOL)
    wide = robust_alignments(pair)[:1]
    miss = pair.deviations(wide)
    scale = np.median(miss)
    again = fit(pair, wide, False, 1 / np.hypot(1, miss / scale))
    # Twelve steps leave some 1e-4 of the scale or less, three of them 5e-3 and more.
    np.testing.assert_allclose(pair.deviations(again), miss, rtol=0, atol=3e-3 * scale)


def test_the_scale_of_the_loss_is_the_median_twelve_times_and_then_falls_to_a_tolerance(
    monkeypatch,
):
    chain = random_arm(2)
    other = shifted(chain, [2, 20, 300, 300, 30, 3000], np.random.default_rng(1))
    pair = sides(chain, other, TOL)
    scales, medians = [], []

    def step(pair, at, scale):
        scales.append(scale)
        medians.append(np.median(pair.deviations(at), axis=1))
        return own_step(pair, at, scale)

    own_step = robust._step
    monkeypatch.setattr(robust, "_step", step)
    robust_alignments(pair)
    wide, falling = np.array(scales[:12]), np.array(scales[12:])
    assert wide.min() > 1
    assert wide == pytest.approx(np.array(medians[:12]))
    steps = np.arange(1, len(falling) + 1)
    expected = np.maximum(0.3 ** steps[:, None] * medians[12], 1)
    assert falling == pytest.approx(expected, rel=1e-9)
    assert falling[-1].max() == 1 < falling[-2].max()


def test_axes_that_all_but_agree_are_weighed_by_a_tolerance(monkeypatch):
    chain = random_arm(2)
    pair = sides(chain, shifted(chain, [0.01] * 6, np.random.default_rng(1)), TOL)
    scales = []
    own_step = robust._step
    monkeypatch.setattr(robust, "_step", lambda *x: scales.append(x[2]) or own_step(*x))
    robust_alignments(pair)
    assert np.array_equal(scales, np.ones_like(scales))
    assert len(scales) == 12
