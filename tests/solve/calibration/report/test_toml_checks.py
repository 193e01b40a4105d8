"""Borders of what a calibration's file may say: rounding passes, and what is more does not."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.errors import ModelError
from poekin.formats.text.toml_text import Keys
from poekin.solve.calibration import Outlier
from poekin.solve.calibration.report import toml_checks

UNEVEN = "a.toml: covariance: expected a symmetric matrix with a diagonal that is not negative"


def covariance(C: Any, deviations: Any) -> Any:
    keys = Keys({"covariance": C}, "a.toml")
    rows = [Keys({"deviation": x}, f"a.toml: parameter {k + 1}") for k, x in enumerate(deviations)]
    return toml_checks._covariance(keys, rows)


@pytest.mark.parametrize("off", [0.0, 0.9e-9, -0.9e-9])
def test_a_covariance_may_be_uneven_by_a_part_in_1e9_of_its_deviations(off):
    C = [[4.0, 0.5], [0.5 + 6 * off, 9.0]]
    assert covariance(C, [2.0, 3.0]).tolist() == C


@pytest.mark.parametrize(
    "C",
    [
        [[4.0, 0.5], [0.5 + 6 * 1.1e-9, 9.0]],
        [[4.0, 0.5], [0.5 - 6 * 1.1e-9, 9.0]],
        [[-4.0, 0.0], [0.0, 9.0]],
        [[4.0, 1e308], [-1e308, 9.0]],
    ],
)
def test_an_uneven_covariance_and_a_negative_variance_are_refused(C):
    with pytest.raises(ModelError) as caught:
        covariance(C, [2.0, 3.0])
    assert str(caught.value) == UNEVEN


def test_a_variance_of_nothing_has_no_deviation():
    assert covariance([[0.0]], [0.0]).tolist() == [[0.0]]
    with pytest.raises(ModelError, match=r"parameter 1: deviation: expected 0\.0, as the"):
        covariance([[0.0]], [1e-300])


@pytest.mark.parametrize(("off", "fits"), [(0.8e-12, True), (1.3e-12, False), (-1.3e-12, False)])
def test_deviations_are_those_of_the_covariance_to_a_part_in_1e12(off, fits):
    C = [[4.0, 0.0], [0.0, 9.0]]
    given = [2.0, 3.0 * (1 + off)]
    if fits:
        assert covariance(C, given).tolist() == C
        return
    with pytest.raises(ModelError) as caught:
        covariance(C, given)
    said = "a.toml: parameter 2: deviation: expected 3.0, as the covariance says"
    assert str(caught.value) == said


@pytest.mark.parametrize("count", [8, 9, 10])
def test_a_frame_has_six_parameters_and_a_point_three(count):
    frames = {"device": np.eye(4), "point 1": np.zeros(3)}
    row = {"owner": "nowhere", "what": "x", "unit": "m", "value": 1.0}
    keys = Keys({"parameter": [row] * count}, "a.toml")
    model: Any = SimpleNamespace(parameters=())
    said = "parameter 1: owner: expected a name in frames, got 'nowhere'"
    if count != 9:
        said = f"parameter: expected 9 of them, as arm and frames have, got {count}"
    with pytest.raises(ModelError) as caught:
        toml_checks.parameters(keys, model, frames)
    assert str(caught.value) == f"a.toml: {said}"


def chain(**changed: Any) -> Any:
    """A chain that differs from others in nothing but what is said."""
    own = {"joint_names": ("a",), "q_names": ("a",), "base": "b", "tip": "t"}
    own |= {"screws": np.zeros((1, 6)), "home": np.eye(4), "coupling": np.eye(1), "reach": 2.0}
    return SimpleNamespace(**(own | changed))


def checked(own: Any, given: Any) -> None:
    used = []

    def made(values: Any) -> Any:
        used.append(list(values))
        return own

    model: Any = SimpleNamespace(parameters=("p", "r"), chain=made)
    toml_checks.check_chain(Keys({}, "a.toml"), model, np.array([1.0, 2.0, 3.0]), given)
    assert used == [[1.0, 2.0]]  # those of the frames are not the arm's


@pytest.mark.parametrize(
    "changed",
    [
        {"joint_names": ("z",)},
        {"q_names": ("z",)},
        {"base": "z"},
        {"tip": "z"},
        {"screws": np.array([[0.0, 0, 0, 0, 0, 2.1e-9]])},
        {"screws": np.array([[0.0, 0, 0, 0, 0, np.nan]])},
        {"home": np.eye(4) - 2.1e-9 * np.eye(4)[::-1]},
        {"coupling": np.array([[1.0 + 2.1e-9]])},
    ],
    ids=["joints", "coordinates", "base", "tip", "screws", "no number", "home", "coupling"],
)
def test_a_chain_of_other_names_or_off_by_a_part_in_1e9_of_the_reach_is_refused(changed):
    for own, given in ((chain(), chain(**changed)), (chain(**changed), chain())):
        with pytest.raises(ModelError, match="calibrated: the chain is not what the parameters"):
            checked(own, given)


def test_a_chain_that_is_nearer_than_a_part_in_1e9_of_the_reach_is_the_one():
    checked(chain(), chain(screws=np.full((1, 6), 1.9e-9), home=np.eye(4) + 1.9e-9))


def test_outliers_are_found_in_their_set_by_index_and_row():
    rows = np.array([4, 7])
    after = SimpleNamespace(set=np.array([0, 0]), of_set=lambda k: SimpleNamespace(row=rows))
    found: Any = SimpleNamespace(noise_std=(None,), after=after, outliers=(Outlier(0, 1, 7),))
    keys = Keys({}, "a.toml")
    toml_checks.check_sets(keys, found)
    for bad in (Outlier(0, 1, 4), Outlier(0, 2, 7)):
        found.outliers = (bad,)
        with pytest.raises(ModelError) as caught:
            toml_checks.check_sets(keys, found)
        said = "a.toml: outliers: expected set, index and row of a measurement, got "
        assert str(caught.value) == said + str(list(bad))
