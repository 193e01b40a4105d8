"""Decimals that numbers were rounded to are found again, and none where there are none."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.formats.rpy import pose
from poekin.groups import rpy, so3
from poekin.solve.calibration.exact.digits import (
    MOST,
    angle_grid,
    length_grid,
    rotation_grid,
)


def rotations(seed: int, count: int = 20) -> np.ndarray:
    return so3.exp(np.random.default_rng(seed).normal(size=(count, 3)))


def test_no_grid_is_coarser_than_whole_units():
    tens = np.deg2rad([10.0, -20.0, 70.0])
    assert getattr(angle_grid(tens), "places", None) == 0
    assert getattr(angle_grid(np.array([10.0, 20.0])), "symbol", None) == "rad"
    assert getattr(length_grid(np.array([0.01, 0.1])), "places", None) == 0


@given(places=st.integers(0, MOST), seed=st.integers(0, 99))
def test_decimals_of_angles_in_degrees_or_radians_and_of_millimetres_are_found(places, seed):
    drawn = np.random.default_rng(seed).uniform(-180, 180, (20, 6))
    drawn[0, 0] = 10.0**-places  # the last of them is in use
    degrees = angle_grid(np.deg2rad(drawn.round(places)))
    assert degrees is not None
    assert (degrees.symbol, degrees.places) == ("°", places)
    assert degrees.half == pytest.approx(np.deg2rad(0.5 * 10.0**-places), rel=1e-15)
    radians = angle_grid((drawn / 50).round(places) + 10.0**-places)
    assert radians is not None
    assert (radians.symbol, radians.places) == ("rad", places)
    lengths = length_grid(10 * drawn.round(places) / 1e4 * 10)
    assert lengths is not None
    assert (lengths.symbol, lengths.places) == ("mm", max(places - 1, 0))


@given(seed=st.integers(0, 99))
def test_doubles_lie_on_no_grid(seed):
    rng = np.random.default_rng(seed)
    assert angle_grid(rng.uniform(-3, 3, (20, 6))) is None
    assert length_grid(rng.uniform(-1, 1, (20, 3))) is None
    assert rotation_grid(rotations(seed)) is None


def as_rpy(R: np.ndarray, places: int) -> np.ndarray:
    rounded = np.degrees(rpy.angles(R)).round(places)
    return np.array([pose((0, 0, 0), np.radians(turns))[:3, :3] for turns in rounded])


PRINTED = {
    "roll, pitch, yaw": as_rpy,
    "rotation vector": lambda R, places: so3.exp(so3.log(R).round(places)),
    "matrix": lambda R, places: R.round(places + 4),
}

# sqrt(6), sqrt(3) and 3 / sqrt(2)
FACTORS = {"roll, pitch, yaw": 6**0.5, "rotation vector": 3**0.5, "matrix": 4.5**0.5}


@pytest.mark.parametrize("what", PRINTED)
@given(places=st.integers(2, 5), seed=st.integers(0, 99))
def test_rotations_turn_by_no_more_than_the_radius_of_their_grid(what, places, seed):
    R = rotations(seed)
    printed = PRINTED[what](R, places)
    found = rotation_grid(printed)
    assert found is not None
    assert found.what == what
    assert found.radius == pytest.approx(FACTORS[what] * found.grid.half)
    turned = np.linalg.norm(so3.log(R @ np.swapaxes(printed, 1, 2)), axis=1)
    # the radius is of first order: a rounding of h adds h^2
    assert turned.max() <= found.radius * (1 + 4 * found.grid.half)
    assert turned.max() >= found.radius / 10


def test_a_pose_at_gimbal_lock_does_not_hide_the_digits_of_the_others():
    R = as_rpy(rotations(3), 3)
    R[4] = pose((0, 0, 0), (0.3, np.pi / 2, 0.1))[:3, :3]
    found = rotation_grid(R)
    assert found is not None
    assert (found.what, found.grid.places) == ("roll, pitch, yaw", 3)


def test_a_grid_says_its_step():
    degrees = angle_grid(np.deg2rad([0.125, 3.0]))
    assert str(degrees) == "0.001°"
    assert str(length_grid(np.array([0.0121, 0.3]))) == "0.1 mm"
    assert str(angle_grid(np.array([0.25, 0.75]))) == "0.01 rad"
