"""--repeats of calibrate: rows at one configuration kept as clusters, or averaged with their conditions."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.measurements.measurement import rows_of
from poekin.solve.calibration.measurements.points import Points
from poekin.solve.calibration.model.configurations import averages

TIMES = 3


@pytest.fixture
def file(crane, tmp_path):
    """Ten configurations, each measured three times, with a payload and a clock."""
    arm = pk.load(crane).chain(tip="hook")
    q = np.repeat(arm.random(4, 10), TIMES, axis=0)
    rng = np.random.default_rng(3)
    p = arm.fk(q)[:, :3, 3] + rng.normal(scale=1e-4, size=(len(q), 3))
    rows = np.column_stack([q, p, np.repeat(np.arange(10.0) % 2, TIMES), np.arange(len(q))])
    path = tmp_path / "a.csv"
    header = "turn,slide,x,y,z,payload,time"
    np.savetxt(path, rows, delimiter=",", header=header, comments="", fmt="%.17g")
    return path


BRIEF = ["--tip", "hook", "--folds", 0, "--parameters", "offsets,drift", "--on-rank-deficiency", "fix"]  # fmt: skip


def test_means_are_fitted_under_the_mean_of_their_conditions(poekin, crane, file, tmp_path):
    out = tmp_path / "a.toml"
    words = ["calibrate", crane, file, *BRIEF, "-o", out]
    code, _, err = poekin(*words, "--repeats", "average")
    assert code in (0, 1)
    assert err == "poekin: 30 rows are averaged: 10 configurations\n"
    averaged = pk.calibration.load(out)
    assert averaged.after.row.tolist() == list(range(10))
    assert poekin(*words)[2] == ""
    kept = pk.calibration.load(out)
    assert len(kept.after) == 30
    for name in ("payload", "time"):
        assert averaged.error_model.reference[name] == pytest.approx(
            kept.error_model.reference[name]
        )
    # Means of as many readings each have the minimum of all, but for the drift within a mean: 1 s
    # of 9 s, a tenth of the deviation of 1e-4 m / √30, here three times that.
    np.testing.assert_allclose(averaged.values, kept.values, rtol=0, atol=6e-6)


def test_a_mean_is_called_after_its_first_line(poekin, crane, file):
    lines = file.read_text().splitlines()
    cells = lines[14].split(",")
    lines[14] = ",".join([*cells[:2], "9", *cells[3:]])
    file.write_text("\n".join(lines))
    words = ["--tip", "hook", "--folds", 0, "--joints", "turn", "--loss", "tukey"]
    words += ["--ignore", "payload", "--ignore", "time"]
    words = ["calibrate", crane, file, *words]
    assert lines_of_outliers(poekin, *words, "--repeats", "keep") == ["15"]
    assert lines_of_outliers(poekin, *words, "--repeats", "average") == ["14"]


def lines_of_outliers(poekin, *words):
    _, out, _ = poekin(*words, "--json")
    return [o["source"].rpartition(":")[2] for o in json.loads(out)["outliers"]]


def test_another_word_and_exact_pairs_are_refused(refused, crane, file):
    said = refused("calibrate", crane, file, "--tip", "hook", "--repeats", "mean")
    assert "--repeats: expected 'keep' or 'average', got 'mean'" in said.replace("\n", " ")
    said = refused("calibrate", crane, file, "--tip", "hook", "--exact", "--repeats", "average")
    assert "--repeats: expected without --exact" in said.replace("\n", " ")


def test_readings_under_different_payloads_are_not_averaged():
    q = np.zeros((4, 2))
    points = Points(np.arange(12.0).reshape(4, 3), rows=[3, 2, 1, 0])
    conditions = {"payload": np.array([0.0, 5, 5.0005, 0]), "time": np.array([1.0, 2, 4, 8])}
    found = averages(q, rows_of(points, 4), points, conditions)
    assert found.first.tolist() == [0, 1]
    np.testing.assert_allclose(found.conditions["payload"], [0, 5.00025])
    np.testing.assert_allclose(found.conditions["time"], [4.5, 3])
    np.testing.assert_allclose(
        found.measurements.measured[:, 0], [[4.5, 5.5, 6.5], [4.5, 5.5, 6.5]]
    )
