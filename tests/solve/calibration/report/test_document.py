"""A calibration as plain data: its figures, parameters and frames, without the single measurements."""

from __future__ import annotations

import json

import pytest

import poekin as pk
from poekin.solve.calibration import calibrate, simulated

ARM = pk.load("ur5").chain()


@pytest.fixture(scope="module", params=[0, 3], ids=["no folds", "folds"])
def found(request):
    made = simulated(ARM, 20, kind="eye-in-hand", seed=1, outliers=0.1)
    return calibrate(ARM, made.q, made.measurements, loss="tukey", folds=request.param)


def test_json_is_the_dict(found):
    assert json.loads(found.to_json()) == found.to_dict()


def test_figures_are_those_of_the_residuals(found):
    data = found.to_dict()
    assert data["before"]["rms_length"] == found.before.rms_length
    assert data["after"]["median_angle"] == found.after.median_angle
    assert data["measurements"] == 20
    assert data["steps"] == len(found.steps)
    assert data["identification"] == found.identification.to_dict()
    if found.cross_validation is None:
        assert data["cross_validation"] is None
    else:
        assert data["cross_validation"]["folds"] == 3
        held_out = found.cross_validation.after.rms_length
        assert data["cross_validation"]["after"]["rms_length"] == held_out


def test_parameters_frames_and_outliers_have_their_names(found):
    data = found.to_dict()
    values = [row["value"] for row in data["parameters"]]
    assert values == found.values.tolist()
    assert data["parameters"][0] == found.parameters[0]._asdict() | {
        "value": found.values[0],
        "deviation": found.deviations[0],
    }
    assert data["frames"] == {name: T.tolist() for name, T in found.frames.items()}
    assert data["outliers"] == [o._asdict() for o in found.outliers]
    assert data["outliers"]


def test_residuals_hold_each_measurement_and_their_statistics(found):
    data = found.after.to_dict()
    assert data["length"] == found.after.length.tolist()
    assert data["rms_length"] == found.after.rms_length
