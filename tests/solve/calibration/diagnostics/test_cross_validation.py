"""Parts of the readings are held out, each once, and judged by a calibration from the others."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.calibration import CrossValidation, Distances, Poses, Residuals, calibrate
from poekin.solve.calibration.diagnostics import cross_validation
from poekin.solve.calibration.fit.minimise import FitOptions
from poekin.solve.calibration.model.configurations import configurations
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem

ARM = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.revolute([0, 1, 0], [0.3, 0, 0.5])],
    pk.se3.exp([0.1, -0.2, 0.3, 0.9, 0.1, 0.4]),
)


@pytest.mark.parametrize("value, words", [
    (True, "folds: expected 0 for none, or 2 and more, got True"), (1, "folds: expected .*, got 1"),
    (-1, "folds: expected .*, got -1"), (2.0, "folds: expected .*, got 2.0"),
    (7, "folds: 7 parts of 6 readings; folds=0 holds none out"),
])  # fmt: skip
def test_what_is_no_number_of_parts_is_refused(value, words):
    with pytest.raises(InputError, match=f"^{words}$"):
        cross_validation.check_folds(value, 6, 0)


def test_as_many_parts_as_readings_two_and_none_are_numbers_of_parts():
    assert [
        cross_validation.check_folds(np.int64(value), 6, np.int64(value)) for value in (6, 2, 0)
    ] == [6, 2, 0]


def test_what_was_held_out_is_said_before_and_after():
    row = np.zeros(1, int)
    before = Residuals(np.array([4e-3]), np.array([2e-3]), row, row)
    after = Residuals(np.array([1e-3]), np.array([np.nan]), row, row)
    found = CrossValidation(before, after, 3)
    assert str(found) == f"3 folds\nbefore: {before}\nafter: {after}"
    document = found.to_dict()
    assert (document["folds"], document["before"]) == (3, before.to_dict())


@pytest.mark.parametrize("seed", [True, -1, 0.0])
def test_what_is_no_seed_is_refused(seed):
    with pytest.raises(InputError, match=f"^seed: expected a whole number from 0 on, got {seed}$"):
        cross_validation.check_folds(2, 6, seed)


@pytest.mark.parametrize("count, parts, kept", [
    (4, 2, False), (5, 2, False), (6, 2, True), (4, 3, False), (5, 3, True), (3, 3, False), (4, 4, True), (6, 0, False),
])  # fmt: skip
def test_nothing_is_kept_aside_where_the_rest_has_no_more_numbers_than_parameters(
    count, parts, kept
):
    """Two parameters, and a number a reading."""
    q = ARM.random(0, count)
    d = np.linalg.norm(ARM.fk(q)[:, :3, 3] - [1.0, 2.0, 0.5], axis=1)
    measured = Distances(d, [1.0, 2.0, 0.5], covariance=1e-8)
    found = calibrate(ARM, q, measured, parameters=["offsets"], folds=parts)
    assert (found.cross_validation is not None) == kept


def test_each_reading_is_judged_once_by_a_calibration_without_it(monkeypatch):
    trained, given, said = [], [], []
    fit = SimpleNamespace(p=np.array([1e-3, 0.0]))
    monkeypatch.setattr(
        cross_validation,
        "fit_frames",
        lambda training, name: trained.append(training.q) or np.zeros(2),
    )
    monkeypatch.setattr(
        cross_validation, "fit_with_refit", lambda training, *others: given.append(others) or fit
    )
    q, free = ARM.random(0, 7), np.eye(2)
    problem = Problem(ErrorModel(ARM, ("offsets",), None), q, [Poses(ARM.fk(q))])
    options = FitOptions("huber", None, 40)
    found = cross_validation.cross_validate(
        problem, free, options, 3, 5, lambda *step: said.append(step)
    )
    assert said == [(0, 3), (1, 3), (2, 3), (3, 3)]
    assert found.folds == 3
    assert found.before.row.tolist() == found.after.row.tolist() == list(range(7))
    assert found.before.rms_length < 1e-15
    assert found.after.angle == pytest.approx(1e-3)
    assert sorted(map(len, trained)) == [4, 5, 5]
    assert [sum((row == rows).all(axis=1).any() for rows in trained) for row in q] == [2] * 7
    for directions, start, asked in given:
        assert (directions is free, start.tolist(), asked) == (True, [0, 0], options)
    cross_validation.cross_validate(problem, free, options, 3, 5, None)
    assert all(map(np.array_equal, trained[:3], trained[3:]))  # the seed draws the parts
    cross_validation.cross_validate(problem, free, options, 3, 6, None)
    assert not all(map(np.array_equal, trained[:3], trained[6:]))


def test_where_nothing_is_said_five_parts_are_drawn_by_the_seed_0():
    q = ARM.random(0, 12)
    T = ARM.fk(q) @ pk.se3.exp(1e-4 * np.random.default_rng(1).normal(size=(12, 6)))
    said: tuple[dict[str, Any], ...] = (
        {},
        {"folds": 5, "seed": 0, "iterations": 100},
        {"seed": 1},
    )
    found, same, other = (
        calibrate(ARM, q, Poses(T), parameters=["offsets"], **options).cross_validation
        for options in said
    )
    assert found is not None
    assert same is not None
    assert other is not None
    assert (found.folds, other.folds) == (5, 5)
    np.testing.assert_array_equal(found.after.length, same.after.length)
    assert not np.array_equal(found.after.length, other.after.length)


def test_equal_and_nearly_equal_readings_are_held_out_together(monkeypatch):
    trained = []
    fit = SimpleNamespace(p=np.zeros(2))
    monkeypatch.setattr(cross_validation, "fit_frames", lambda training, name: np.zeros(2))
    monkeypatch.setattr(
        cross_validation,
        "fit_with_refit",
        lambda training, *others: trained.append(training.q) or fit,
    )
    q = np.tile(ARM.random(0, 6), (3, 1))
    q[6:12] += 5e-4
    problem = Problem(ErrorModel(ARM, ("offsets",), None), q, [Poses(ARM.fk(q))])
    found = cross_validation.cross_validate(problem, np.eye(2), FitOptions("linear"), 3, 0, None)
    assert found.after.row.tolist() == list(range(18))
    for rows in trained:
        assert len(rows) == 12
        assert configurations(rows).max() + 1 == 4


def test_there_are_no_more_folds_than_configurations():
    q = np.repeat(ARM.random(0, 4), 3, axis=0)
    T = ARM.fk(q) @ pk.se3.exp(1e-4 * np.random.default_rng(1).normal(size=(12, 6)))
    found = calibrate(ARM, q, Poses(T), parameters=["offsets"])
    assert found.cross_validation is not None
    assert found.cross_validation.folds == 4
    one = calibrate(ARM, q[:3], Poses(T[:3]), parameters=["offsets"], folds=2)
    assert one.cross_validation is None
