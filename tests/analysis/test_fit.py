"""fit steps many starts at once, each as if it were alone, along the residuals' true derivatives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from poekin.analysis.fit import _linearised, fit
from poekin.analysis.lines import carried, misses, sides
from poekin.groups import se3
from poekin.testing.planted_changes import planted, random_arm

KINDS = ("revolute", "revolute", "prismatic", "revolute", "revolute")


def near(seed, count):
    """Two arms that differ in one axis, alignments that all but hold, and joints free and used at random."""
    rng = np.random.default_rng(seed)
    chain = random_arm(seed + 50, KINDS)
    pair = sides(chain, planted(chain, "shift", 3, rng), 1e-5, 1e-5)
    P, z = se3.exp(1e-3 * rng.normal(size=(count, 6))), 1e-3 * rng.normal(size=(count, 5))
    return pair, P, z, rng.random((count, 5)) < 0.4, rng.random((count, 5)) < 0.8


@pytest.mark.parametrize("hinge", [-1, 0, 1, 2, 3])
def test_the_derivatives_are_those_of_the_residuals(hinge):
    pair, P, z, free, used = near(0, 4)
    pair, h = replace(pair, hinge=hinge), 1e-6
    J = _linearised(pair, P, z, free, used)[1]
    for c, xi in enumerate(np.eye(11)):
        ahead, back = (
            _linearised(pair, se3.exp(t * xi[:6]) @ P, z + t * xi[6:] * free, free, used)[0] for t in (h, -h)
        )
        # 1e5 tolerances a metre or radian: of central differences they leave h^2 and, by rounding, u / h.
        assert J[:, :, c] == pytest.approx((ahead - back) / (2 * h), abs=1e-3)
    assert np.abs(J).max() > 1e4


def test_starts_fitted_together_come_out_as_each_alone():
    pair, P, z, free, used = near(1, 6)
    together = fit(pair, P, z, free, used)
    for i in range(6):
        alone = fit(pair, P[i : i + 1], z[i : i + 1], free[i], used[i])
        for ours, theirs in zip(together, alone, strict=True):
            assert ours[i] == pytest.approx(theirs[0], abs=1e-12)
    assert (together[1] == z)[~free].all()


def test_a_fit_takes_the_base_and_the_free_zero_offsets_to_where_the_used_axes_agree():
    pair, P, z, _, _ = near(2, 3)
    inner = np.array([False, True, True, True, False])
    used = np.arange(5) != 3
    start = z * inner
    fitted = fit(pair, P, start, inner, used)
    miss = misses(pair, carried(pair, *fitted)[1])
    assert miss[:, used].max() < 1e-6
    assert miss[:, ~used].min() > 99  # the shift of 1 mm, in tolerances of 0.01 mm
    base = np.eye(4)
    base[:3, 3] = pair.b.hub - pair.a.hub
    assert fitted[0] == pytest.approx(np.tile(base, (3, 1, 1)), abs=1e-9)
    assert fitted[1] == pytest.approx(np.zeros((3, 5)), abs=1e-9)
