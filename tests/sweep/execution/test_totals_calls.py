"""A sum's lower half has room for what one call of the kernel adds to it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from poekin.engine.kernels.sweep import sweep_kernel
from poekin.sweep import Cells, Random, Sweep
from poekin.sweep.execution.totals import Totals
from tests.sweep.arms import two_links

ARM = two_links()
ONE = Cells((-9.0, -9.0, -9.0), 18.0, (1, 1, 1))


@pytest.mark.parametrize("keep", ["mean", "best"])
def test_a_call_adds_2_to_the_30_samples_at_most(keep, monkeypatch):
    asked: list[tuple[int, int]] = []

    def call(address, first, last, *words):
        asked.append((first, last))
        lower_halves = words[-2]
        if keep == "mean":
            lower_halves += (last - first) * (2**32 - 1)  # the largest of each sample
        return 1

    monkeypatch.setattr(sweep_kernel, "swept", SimpleNamespace(call=call))
    totals = Totals(Sweep(ARM, Random.of(ARM, 2**32, seed=1), ONE, "manipulability", keep))
    totals.run(3, 2**31 + 5)
    assert asked == [(3, 2**30 + 3), (2**30 + 3, 2**31 + 3), (2**31 + 3, 2**31 + 5)]
    assert totals.outside == 3
    if keep == "mean":
        whole = int(totals.best[0]) * 2**32 + int(totals.attained[0])
        assert whole == (2**31 + 2) * (2**32 - 1)
        assert 0 <= totals.attained[0] < 2**32
    assert np.asarray(totals.counts).shape == (1,)
