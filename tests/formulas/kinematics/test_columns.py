"""Columns of a Jacobian from the joints' axes, against cross products."""

from __future__ import annotations

import numpy as np

from poekin.formulas.kinematics import columns
from tests.formulas.four_joints import (
    COUNTS,
    ROTATES,
    SLIDES,
    TOOL,
    rng,
    rows,
    same,
)


@COUNTS
def test_columns_are_velocities_of_a_point_turned_and_coupled(count):
    axes, p = rng.normal(size=(6, count)), rng.normal(size=3)
    z, o = axes[:3].T, axes[3:].T
    J = axes.copy()
    columns.about_point(J, ROTATES, SLIDES, count, p)
    v = [
        r * np.cross(zi, p - oi) + s * zi
        for r, s, zi, oi in zip(ROTATES[:count], SLIDES[:count], z, o, strict=True)
    ]
    expected = np.concatenate([(ROTATES[:count, None] * z).T, np.transpose(v)])
    same(J, expected)
    R = TOOL[:3, :3]
    columns.rotate_columns(J, count, R.ravel())
    same(J, np.concatenate([R.T @ expected[:3], R.T @ expected[3:]]))
    coupling, J_q = rng.normal(size=(count, 3)), rows(3)
    columns.coupled(expected, coupling, count, 3, J_q)
    same(J_q, expected @ coupling)
