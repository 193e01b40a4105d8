"""Cells of samples by the numbers of their poses, uncompiled."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.engine.kernels.sweep import sweep_kernel as kernel
from poekin.engine.kernels.sweep.tiles import cell_of


@pytest.mark.parametrize("side", [0, 2])
def test_cells_of_a_block_of_poses_are_those_of_their_places_and_z_axes(side):
    rng = np.random.default_rng(0)
    R_p = rng.uniform(-1.1, 1.1, (12, kernel.BLOCK))
    found = np.full(kernel.BLOCK, 77)
    cells, place = (side, 4, 5, 6), (-1.0, -0.9, -1.1, 2.5)
    kernel._write_cells(cells, place, R_p, found)
    for k in range(kernel.BLOCK):
        R, p = R_p[:9, k].reshape(3, 3), R_p[9:, k]
        assert found[k] == cell_of(cells, place, p, R[:, 2])
