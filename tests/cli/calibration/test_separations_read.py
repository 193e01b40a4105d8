"""Known distances of unknown points: each with its own variance, in the order of the pairs."""

from __future__ import annotations

import math

import numpy as np
import pytest

from poekin.cli.calibration import reflectors
from poekin.errors import InputError
from poekin.solve.calibration.measurements.header import SI, Convention

MM = Convention.of(None, True, None)
# by their numbers: distance and deviation, m
PAIRS = {(2, 4): (0.5, 1e-3), (3, 1): (0.75, 2e-3), (1, 2): (1.25, 5e-4)}


@pytest.mark.parametrize(("convention", "scale"), [(SI, 1.0), (MM, 1000.0)])
def test_distances_are_symmetric_and_variances_are_in_the_order_of_the_pairs(
    convention, scale, tmp_path
):
    file = tmp_path / "plate.csv"
    rows = [f"{i},{j},{scale * d!r},{scale * s!r}" for (i, j), (d, s) in PAIRS.items()]
    file.write_text("\n".join(["from,to,distance,sigma", *rows]))
    found = reflectors._read(str(file), 4, convention)
    expected = np.full((4, 4), math.nan)
    for (i, j), (d, _) in PAIRS.items():
        expected[[i - 1, j - 1], [j - 1, i - 1]] = d
    np.testing.assert_allclose(found.d, expected, rtol=1e-15)
    pairs = sorted(PAIRS, key=sorted)
    # a division and a product
    np.testing.assert_allclose(found.variances, [PAIRS[p][1] ** 2 for p in pairs], rtol=1e-15)


@pytest.mark.parametrize(
    ("distance", "sigma", "which"), [("0", "1", "distance"), ("1", "0", "sigma")]
)
def test_neither_a_distance_nor_its_deviation_is_zero(distance, sigma, which, tmp_path):
    file = tmp_path / "plate.csv"
    file.write_text(f"from,to,distance,sigma\n1,2,{distance},{sigma}\n")
    with pytest.raises(InputError) as refused:
        reflectors._read(str(file), 2, SI)
    assert str(refused.value) == f"'{file}':2: expected a {which} above 0, got 0 m"


@pytest.mark.parametrize(
    ("points", "unknown"), [((), False), (("0,0,0",), False), ((" Unknown ",), True)]
)
def test_points_are_unknown_where_that_alone_is_said(points, unknown):
    assert reflectors.are_unknown(points) is unknown
    for more in (("0,0,0", "unknown"), ("unknown", "unknown"), ("unknown", "0,0,0", "0,0,1")):
        with pytest.raises(InputError, match=r"^--point unknown: expected once and alone, for all"):
            reflectors.are_unknown(more)
