"""What the options say of measurements: covariances, points in the unit of lengths, names, and refusals."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.cli.calibration import measured
from poekin.cli.calibration.measured import MeasurementOptions
from poekin.cli.calibration.options import columns
from poekin.errors import InputError
from poekin.solve.calibration.measurements.header import Convention

NOTHING = MeasurementOptions((), (), None, None, None, None, ())
MM = NOTHING._replace(convention=Convention.of(None, True, None))


def known(kind: str, points: int = 1, **said: object) -> dict[str, object]:
    return measured.known_arguments(NOTHING._replace(**said), kind, points)


@pytest.mark.parametrize("kind", ["poses", "eye-in-hand", "eye-to-hand"])
def test_the_covariance_of_a_pose_has_its_angles_first(kind):
    found = known(kind, sigma_angle=2.0, sigma_length=3.0)
    np.testing.assert_array_equal(found["covariance"], np.diag([4.0] * 3 + [9.0] * 3))


@pytest.mark.parametrize("points", [1, 2])
def test_the_covariance_of_points_and_of_a_distance_is_that_of_lengths(points):
    found = known("points", points, sigma_length=3.0)
    np.testing.assert_array_equal(found["covariance"], 9.0 * np.eye(3 * points))
    assert known("distances", points, sigma_length=3.0) == {"covariance": 9.0}
    assert known("points", points, sigma_angle=2.0) == {}


def test_points_are_all_given_and_distances_are_to_the_first():
    said = {"point": ("1,2,3", "4 5 6"), "centre": "7,8,9", "frame": "unknown"}
    points = known("points", **said)
    assert set(points) == {"points", "frame"}
    np.testing.assert_array_equal(points["points"], [[1, 2, 3], [4, 5, 6]])
    distances = known("distances", **said)
    assert set(distances) == {"point", "centre"}
    np.testing.assert_array_equal(distances["point"], [1, 2, 3])
    np.testing.assert_array_equal(distances["centre"], [7, 8, 9])
    assert known("poses", **said) == {"frame": "unknown"}
    assert known("eye-in-hand", **said) == {}


def test_a_point_is_in_the_unit_of_lengths():
    np.testing.assert_array_equal(measured.point("1,2,-3", "--point", NOTHING), [1, 2, -3])
    np.testing.assert_array_equal(
        measured.point("1000, 2500 -3", "--point", MM), [1.0, 2.5, -0.003]
    )


def test_points_and_the_centre_of_a_measurement_are_so_too():
    said = MM._replace(point=("1000,0,200",), centre="1000,2500,-3")
    found = measured.known_arguments(said, "distances", 1)
    np.testing.assert_array_equal(found["point"], [1.0, 0.0, 0.2])
    np.testing.assert_array_equal(found["centre"], [1.0, 2.5, -0.003])


@pytest.mark.parametrize(("text", "count"), [("1,2", 2), ("1 2 3 4", 4), ("", 0)])
def test_a_point_has_three_numbers(text, count):
    with pytest.raises(InputError) as refused:
        measured.vector(text, "--centre")
    assert str(refused.value) == (f"--centre: three numbers expected (x,y,z), got {count}")
    with pytest.raises(InputError, match=r"^--centre: number 2: a number expected, got 'x'$"):
        measured.vector("1,x,3", "--centre")


@pytest.mark.parametrize(
    ("said", "kinds", "message"),
    [
        ({"point": ("0,0,0",)}, ["poses"], "--point: expected with points or distances only, got"),
        ({"frame": "base"}, ["distances"], "--frame: expected with points or poses only, got dis"),
        ({"centre": "0,0,0"}, ["points", "poses", "points"], "--centre: expected with distances on"),
        ({"sigma_angle": 1e-3}, ["points"], "--sigma-angle: expected with measured poses only, an"),
        ({"sigma_angle": 1e-3}, ["points", "poses"], "--sigma-angle and --sigma-length: of measur"),
        ({"sigma_length": 1e-3}, ["poses"], "--sigma-angle and --sigma-length: of measured poses,"),
        ({"sigma_length": 0.0}, ["points"], "sigma_length: expected a positive number"),
        ({"sigma_angle": -1.0, "sigma_length": 1.0}, ["poses"], "sigma_angle: expected a positive"),
    ],
)  # fmt: skip
def test_an_option_that_no_file_knows_of_is_refused(said, kinds, message):
    with pytest.raises(InputError) as refused:
        measured.check_fit(NOTHING._replace(**said), kinds)
    assert str(refused.value).startswith(message)


@pytest.mark.parametrize(
    ("said", "kinds"),
    [
        ({}, ["poses"]),
        ({"point": ("0,0,0",), "centre": "0,0,0"}, ["poses", "distances"]),
        ({"frame": "base"}, ["distances", "points"]),
        ({"sigma_angle": 1e-3, "sigma_length": 1e-3}, ["points", "eye-in-hand"]),
        ({"sigma_length": 1e-3}, ["points", "distances"]),
    ],
)
def test_an_option_that_one_of_the_files_knows_of_is_taken(said, kinds):
    measured.check_fit(NOTHING._replace(**said), kinds)


def test_kinds_that_do_not_fit_are_named_once():
    with pytest.raises(InputError, match=r"only, got points, poses$"):
        measured.check_fit(NOTHING._replace(centre="0,0,0"), ["points", "poses", "points"])


def test_columns_are_renamed_by_pairs():
    assert columns.renamed_columns(None) == {}
    assert columns.renamed_columns(["x_t=x", "a=b=c"]) == {"x_t": "x", "a": "b=c"}
    for word in ("x", "=x", "x=", "="):
        with pytest.raises(InputError, match=r"^--rename: expected the column's name in the file"):
            columns.renamed_columns(["a=b", word])
