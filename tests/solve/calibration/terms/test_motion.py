"""Terms of the motion before a reading have the units of what they multiply."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.terms.motion import backlash, drift, lag

ARM = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([0, 0, 1])],
    np.eye(4),
    q_names=["turn", "slide"],
)


@pytest.mark.parametrize(
    ("term", "reference", "units"),
    [
        (backlash, {"time": 1.0}, ("rad", "m")),
        (lag, {"time": 1.0}, ("1", "1")),
        (drift, {}, ("rad", "m")),
        (drift, {"time": 1.0}, ("rad/s", "m/s")),
        (drift, {"temperature": 1.0}, ("rad/K", "m/K")),
        (drift, {"time": 1.0, "temperature": 1.0}, ("rad/K", "m/K")),
    ],
)
def test_a_coefficient_has_the_unit_of_its_coordinate_over_that_of_what_it_multiplies(
    term, reference, units
):
    (found,) = term(ARM, np.arange(2), reference)
    name = term.__name__
    assert found.name == name
    assert [tuple(p) for p in found.parameters] == [
        ("turn", name, units[0]),
        ("slide", name, units[1]),
    ]
    assert term(ARM, np.arange(0), reference) == []
