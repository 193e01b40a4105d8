"""Metrics of a design, and whether it shows what all candidates show."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ....groups.arrays import Array
from ..diagnostics.identification import RANK
from ..model.tsqr import qr_r
from . import observability
from .choice import DesignMetrics
from .greedy import greedy


class Design(NamedTuple):
    """Rows (K, r, L) of the candidates and (M, r, L) of what was measured before, and a root (L, L) of
    the mean information of a measured number in the workspace.
    """

    blocks: Array
    before: Array
    root: Array

    @property
    def given_rows(self) -> Array:
        """Triangular rows (k, L) with the information of what was measured before."""
        size = self.blocks.shape[2]
        return qr_r(self.before.reshape(-1, size))


def root_information(blocks: Array) -> Array:
    """Root R (L, L) of the mean information R^T R of one number of blocks (K, r, L)."""
    count, rows, size = blocks.shape
    return qr_r(blocks.reshape(-1, size)) / np.sqrt(count * rows)


def design_metrics(design: Design, rows: np.ndarray) -> DesignMetrics:
    """The metrics of the candidates `rows` with what was measured before."""
    size = design.blocks.shape[2]
    J = np.concatenate([design.blocks[rows], design.before])
    _, s, Vt = np.linalg.svd(qr_r(J.reshape(-1, size)))
    if len(s) < size or s[-1] <= RANK * s[0]:
        return DesignMetrics(*observability.UNOBSERVED, np.inf)
    indices = observability.from_singular_values(s, len(rows) + len(design.before))
    # the errors of what is predicted are B dp, and the covariance of dp is (J^T J)^-1 = V s^-2 V^T
    spread = design.root @ (Vt.T / s)
    prediction = np.linalg.norm(spread)
    return DesignMetrics(*indices, float(prediction))


def check_enough(design: Design, n: int) -> None:
    """Raises InputError that says how many configurations show what all candidates show, where n do
    not.
    """
    count, equations, size = design.blocks.shape
    given = design.given_rows
    start = np.array(greedy(design.blocks, n, given=given))
    if design_metrics(design, start).smallest > 0:
        return
    start = np.array(greedy(design.blocks, min(count, max(n, size)), given=given))

    def shows(enough: int) -> bool:
        return design_metrics(design, start[:enough]).smallest > 0

    needed = next(filter(shows, range(n, len(start))), len(start))
    raise InputError(
        f"n: {n} configurations of {equations} equations each are too few for {size} "
        f"parameters: expected at least {needed}, better three times as many; or calibrate less"
        " (parameters=, joints=)"
    )
