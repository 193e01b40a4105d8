"""The table of a comparison: numbers as they are, down to far below the tolerance."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.analysis.compare.joint_table import HEADS, _deg, _mm, joint_row

ARM = pk.load("ur5").chain()
TOL = 1e-3


def shown(angle: float, gap: float) -> tuple[float, float]:
    """Angle (deg) and normal (mm) in the row of a joint whose axis is so much elsewhere."""
    axis = pk.screw.axis_of(ARM.screws[2])
    assert axis.point is not None
    across = np.cross(axis.direction, [0, 0, 1])
    turned = pk.se3.exp(pk.screw.revolute(across, axis.point) * angle)
    aside = pk.se3.exp([0, 0, 0, *gap * across])
    screws = ARM.screws.copy()
    screws[2] = pk.se3.adjoint(aside @ turned) @ screws[2]
    found = pk.compare(
        ARM, ARM.replace(screws=screws), strict=True, tol_position=TOL, tol_rotation=TOL
    )
    row = joint_row(found.joints[2], found)
    angle_deg, gap_mm = (str(row[HEADS.index(head)]) for head in ("angle (deg)", "normal (mm)"))
    return float(angle_deg), float(gap_mm)


@pytest.mark.parametrize("size", [0.5 * TOL, 2 * TOL])
def test_what_is_within_the_tolerance_is_shown_too(size):
    angle, gap = shown(size, size)
    assert angle == pytest.approx(np.degrees(size), rel=5e-3)
    assert gap == pytest.approx(1e3 * size, rel=5e-3)


def test_what_is_far_below_the_tolerance_is_zero():
    assert shown(1e-8 * TOL, 1e-8 * TOL) == (0.0, 0.0)


@pytest.mark.parametrize("tol", [1e-5, 1e-3, 0.5])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_number_is_shown_from_a_millionth_of_the_tolerance_on(tol, sign):
    least = 1e-6 * tol
    for size, share in ((least, 1), (2 * least, 2), (0.9 * least, 0), (0.0, 0)):
        length, angle = _mm(sign * size, tol), _deg(sign * size, tol)
        assert float(length) == pytest.approx(sign * share * 1e3 * least, rel=1e-3)
        assert float(angle) == pytest.approx(sign * share * np.degrees(least), rel=1e-3)
        assert share or length == angle == "0"
    assert _mm(None, tol) == ""
