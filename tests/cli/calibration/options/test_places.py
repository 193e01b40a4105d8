"""Boxes and cones of `poekin choose-poses`, in the units that are said."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.cli.calibration.measured import MeasurementOptions
from poekin.cli.calibration.options import places
from poekin.cli.formats.units import SaidUnits
from poekin.errors import InputError
from poekin.solve.calibration.measurements.header import Convention

TIP = np.array([0.1, 0.2, 0.3])
SI = SaidUnits()


@pytest.mark.parametrize(("units", "k"), [(SI, 1.0), (SaidUnits(mm=True), 1000.0)])
def test_a_box_has_two_corners_in_any_order(units, k):
    numbers = np.array([1.0, -2.0, 3.0, -4.0, 5.0, -6.0]) * k
    found = places.box(",".join(map(str, numbers)), "--box", units, TIP)
    assert found is not None
    np.testing.assert_allclose(found.lower, [-4, -2, -6], rtol=1e-15)
    np.testing.assert_allclose(found.upper, [1, 5, 3], rtol=1e-15)
    np.testing.assert_array_equal(found.point, TIP)
    assert places.box(None, "--box", units, TIP) is None


@pytest.mark.parametrize(
    ("units", "text"),
    [
        (SI, "1,2,3,0,0,2,0.5"),
        (SaidUnits(mm=True), "1000,2000,3000,0,0,2,0.5"),
        (SaidUnits(deg=True), f"1,2,3,0,0,2,{np.degrees(0.5)}"),
        (SaidUnits(mm=True, deg=True), f"1000 2000 3000 0 0 2 {np.degrees(0.5)}"),
    ],
)
def test_a_cone_has_a_place_a_direction_and_half_its_angle(units, text):
    found = places.cone(text, units, TIP)
    assert found is not None
    np.testing.assert_allclose(found.apex, [1, 2, 3], rtol=1e-15)
    np.testing.assert_allclose(np.asarray(found.axis) / np.linalg.norm(found.axis), [0, 0, 1])
    assert found.half_angle == pytest.approx(0.5, rel=1e-15)
    np.testing.assert_array_equal(found.target, TIP)
    assert places.cone(None, units, TIP) is None


def test_other_than_the_numbers_that_it_takes_is_refused_and_so_is_no_cone():
    for text, option, what in (
        ("1,2,3,4,5", "--box", "6 numbers expected (two corners, x,y,z,x,y,z), got 5"),
        ("1,2,3,4,5,6,7", "--workspace", "6 numbers expected (two corners, x,y,z,x,y,z), got 7"),
        ("1,2,3,4,5,x", "--box", "number 6: a number expected, got 'x'"),
    ):
        with pytest.raises(InputError) as refused:
            places.box(text, option, SI, TIP)
        assert str(refused.value) == f"{option}: {what}"
    with pytest.raises(InputError) as refused:
        places.cone("1,2,3,4,5,6", SI, TIP)
    assert str(refused.value) == (
        "--cone: 7 numbers expected (a place, a direction and an angle), got 6"
    )
    with pytest.raises(InputError, match=r"^--cone: "):
        places.cone("0,0,0,0,0,0,0.5", SI, TIP)


def test_the_point_is_the_first_that_is_measured_else_the_origin():
    said = MeasurementOptions((), (), None, None, None, None, ())
    np.testing.assert_array_equal(places.tool_point(said), np.zeros(3))
    said = said._replace(point=("10,20,30", "1,1,1"))
    np.testing.assert_array_equal(places.tool_point(said), [10, 20, 30])
    said = said._replace(convention=Convention.of(None, True, None))
    np.testing.assert_allclose(places.tool_point(said), [0.01, 0.02, 0.03], rtol=1e-15)
