"""Options of sweeps: numbers of samples, measures and the errors that two of them are of."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.cli.sweep import options
from poekin.cli.sweep.options import (
    DrawnName,
    KeepName,
    MeasureName,
    count_from,
    measure_from,
    samples_from,
)
from poekin.errors import InputError

ARM = pk.load("stanford").chain()
DRAWN = DrawnName.configurations
SLIDES = np.array([kind == "prismatic" for kind in ARM.kinds])


@pytest.mark.parametrize(
    ("angle", "length"), [(1e-3, None), (None, 1e-4), (1e-3, 1e-4), (0.0, 1e-4), (1e-3, 0.0)]
)
@pytest.mark.parametrize("part", ["position", "orientation"])
def test_the_error_that_is_not_given_is_none(part, angle, length):
    """Of the other the tilts and shifts of axes, and the offsets of what turns or slides."""
    tilt, shift = angle or 0.0, length or 0.0
    own = pk.sweep.PoseUncertainty.by_tolerances(
        ARM, tilt=tilt, shift=shift, offset=np.where(SLIDES, shift, tilt), part=part
    )
    found = measure_from(MeasureName(f"{part}_error"), ARM, angle, length)
    samples = samples_from(ARM, "500", 1, DRAWN)
    one, other = (pk.sweep.top(ARM, m, 5, keep="worst", samples=samples) for m in (own, found))
    np.testing.assert_array_equal(one.values, other.values)
    np.testing.assert_array_equal(one.q, other.q)


@pytest.mark.parametrize("name", [n for n in MeasureName if not n.endswith("error")])
def test_other_measures_have_no_errors_and_the_two_have_one(name):
    assert measure_from(name, ARM, None, None) is not None
    for angle, length in ((1e-3, None), (None, 1e-3), (0.0, None)):
        with pytest.raises(InputError) as refused:
            measure_from(name, ARM, angle, length)
        assert str(refused.value) == (
            "--sigma-angle, --sigma-length: expected, one or both, with --measure position_error or "
            "orientation_error, and with no other"
        )
    for error in (MeasureName.position_error, MeasureName.orientation_error):
        with pytest.raises(InputError, match=r"^--sigma-angle, --sigma-length: expected, one or"):
            measure_from(error, ARM, None, None)


@pytest.mark.parametrize(("text", "count"), [("10", 10), ("1e8", 10**8), ("2.5e3", 2500)])
def test_a_number_of_samples_may_have_an_exponent(text, count):
    assert count_from(text) == count


@pytest.mark.parametrize("text", ["1.5", "some", "", "nan", "inf", "1e-3", "0", "-5"])
def test_what_is_no_whole_number_of_samples_is_refused(text):
    with pytest.raises(InputError) as refused:
        count_from(text)
    assert str(refused.value) == (
        f"--samples: expected a whole number from 1 on, as 10000000 or 1e8, got '{text}'"
    )


def test_samples_are_those_of_the_seed():
    first, again, other = (samples_from(ARM, "100", seed, DRAWN) for seed in (1, 1, 2))
    tops = [pk.sweep.top(ARM, "travel", 3, samples=s).q.tolist() for s in (first, again, other)]
    assert tops[0] == tops[1] != tops[2]
    assert first.count == 100


def test_poses_are_drawn_where_they_are_asked_for():
    drawn = samples_from(pk.load("ur5e").chain(), "100", 1, DrawnName.poses)
    assert isinstance(drawn, pk.sweep.PoseSamples)
    assert drawn.count == 100


def test_the_names_are_those_that_are_typed():
    assert [*KeepName] == ["best", "worst", "mean"]
    assert {name.name for name in MeasureName} == {name.value for name in MeasureName}
    assert options.mask_from(pk.load("stanford"), ARM, False) is None
