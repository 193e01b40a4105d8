"""Whole messages of the measurements that `poekin calibrate` is given."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.cli.calibration import measured
from poekin.errors import InputError

NOTHING = measured.MeasurementOptions((), (), None, None, None, None, ())
LOAD = np.array([1.0, 2.0])


def test_a_column_that_one_file_lacks_is_told_with_that_file_and_that_column():
    columns = [
        {"payload": LOAD},
        {"payload": 3 * LOAD, "time": LOAD},
        {"payload": LOAD, "time": LOAD},
    ]
    with pytest.raises(InputError) as refused:
        measured._conditions(columns, ["a.csv", "b.csv", "c.csv"])
    assert str(refused.value) == (
        "'a.csv': expected a column 'time', as another file has one; --ignore time passes that over"
    )
    found = measured._conditions(columns[1:], ["b.csv", "c.csv"])
    assert {name: column.tolist() for name, column in found.items()} == {
        "payload": [3.0, 6.0, 1.0, 2.0],
        "time": [1.0, 2.0, 1.0, 2.0],
    }


@pytest.mark.parametrize(
    ("said", "kinds", "message"),
    [
        ({"frame": "base"}, ["distances", "eye-in-hand", "distances"],
         "--frame: expected with points or poses only, got distances, eye-in-hand"),
        ({"centre": "0,0,0"}, ["poses"], "--centre: expected with distances only, got poses"),
        ({"point": ("unknown",)}, ["poses", "distances"],
         "--point unknown: expected with points only, got poses, distances"),
        ({"point": ("unknown",)}, ["poses"],
         "--point: expected with points or distances only, got poses"),
        ({"separations": "s.csv"}, ["points"],
         "--separations: expected with --point unknown only"),
        ({"sigma_angle": 1e-3, "sigma_length": 1e-3}, ["points", "distances"],
         "--sigma-angle: expected with measured poses only, and there are lengths alone"),
        ({"sigma_angle": 1e-3}, ["points", "poses"],
         "--sigma-angle and --sigma-length: of measured poses, both expected or neither"),
    ],
)  # fmt: skip
def test_an_option_that_does_not_fit_is_told_with_what_it_fits(said, kinds, message):
    with pytest.raises(InputError) as refused:
        measured.check_fit(NOTHING._replace(**said), kinds)
    assert str(refused.value) == message
