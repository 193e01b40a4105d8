"""The recursion of Orin and Schrader against products of 4x4 and 6x6 matrices."""

from __future__ import annotations

import numpy as np

from poekin.formulas.paper import dh_recursive
from tests.formulas.four_joints import (
    COUNTS,
    LOCAL,
    MOVED,
    ROTATES,
    SLIDES,
    TOOL,
    rows,
    same,
)
from tests.formulas.matrices import Ad, flat, product


@COUNTS
def test_orin_and_schrader_s_frames_follow_their_joints(count):
    J = rows(count)
    T = dh_recursive.body([flat(T) for T in MOVED], flat(TOOL), ROTATES, SLIDES, count, J)
    behind = [product(*MOVED[i:count], TOOL) for i in range(count)]
    same(
        J,
        np.transpose(
            [Ad(np.linalg.inv(T)) @ S for T, S in zip(behind, LOCAL[:count], strict=True)]
        ),
    )
    same(T, flat(behind[0]))
