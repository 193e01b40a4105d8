"""Two models side by side: the longer one without the joint that the other has not."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.planted_changes import random_arm
from poekin.analysis.compare.differences.conventions import BUT_NAMES, Asked
from poekin.analysis.compare.differences.matching import matched
from poekin.model import screw
from poekin.model.chain import Chain

ASKED = Asked(BUT_NAMES, False, 1e-5, np.radians(1e-3), samples=5, seed=0)


@pytest.mark.parametrize("longer", ["a", "b"])
def test_alignments_are_weighed_within_the_limits_of_both_models_whichever_is_longer(longer):
    short = random_arm(1, ("revolute",) * 4).replace(limits=np.tile([-0.5, 0.5], (4, 1)))
    extra = screw.revolute([1, 2, 0], [0.1, 0.3, 0.2])
    limits = np.array([[1, 1.1], [2, 2.1], [-3, -2.9], [3, 3.1], [-3.1, -3]])
    long = Chain.from_space(np.insert(short.screws, 2, extra, 0), short.home, limits=limits)
    arms = {"a": short, "b": short} | {longer: long}
    pair = matched(arms["a"], arms["b"], ASKED)
    assert pair is not None
    assert pair.extra == (longer, "joint3")
    for model, x in zip("ab", pair.both, strict=True):
        low, high = (np.delete(limits, 2, 0) if model == longer else short.limits).T
        assert x.shape == (60, 4)
        assert ((low <= x) & (x <= high)).all()
