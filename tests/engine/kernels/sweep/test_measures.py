"""Measures of a block, uncompiled: sums of roots of outputs, and what coordinates alone say."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from poekin.engine.kernels.sweep import measures
from poekin.formulas.kinematics import joint_ranges, singular_values
from tests.engine.kernels.branches.four_at_once import FOUR

RNG = np.random.default_rng(0)


def test_a_sum_of_roots_is_of_the_outputs_above_zero():
    outputs = RNG.uniform(-1, 1, (3, measures.LANES))
    outputs[1, 2] = math.nan
    values = np.full(10, 77.0)
    said = (measures.ROOT, 1, 3, 0, 0)
    measures.measure_lanes(said, np.empty(0), outputs, np.empty((0, 0)), np.empty(4), values, 5)
    expected = np.sqrt(np.fmax(outputs, 0.0)).sum(axis=0)
    np.testing.assert_allclose(values[5:9], expected, rtol=4 * 2.0**-53)
    assert values[[0, 1, 2, 3, 4, 9]].tolist() == [77] * 6


@pytest.mark.parametrize(
    ("kind", "formula"),
    [(measures.TRAVEL, joint_ranges.travel), (measures.MARGIN, joint_ranges.limit_margin)],
)
def test_a_measure_of_coordinates_is_its_formula_of_references_and_weights(kind, formula):
    q = RNG.uniform(-1, 1, (3, 7))
    numbers = RNG.uniform(0.5, 2, 6)
    values = np.full(7, 77.0)
    measures.measure_coordinates((kind, 1, 0, 0, 0), numbers, q, values)
    assert values.tolist() == [formula(column, numbers[:3], numbers[3:], 3) for column in q.T]


@pytest.mark.parametrize("kind", [measures.SMALLEST, measures.INVERSE_CONDITION])
@pytest.mark.parametrize("m", [2, 7])
def test_a_jacobian_of_nothing_but_zeros_measures_zero_without_a_sign(kind, m):
    said = (kind, 1, 6 * m, min(m, 6), max(m, 6))
    values = np.full(measures.LANES, 77.0)
    outputs = np.zeros((6 * m, measures.LANES))
    W = measures.matrix_room(said)
    measures.measure_lanes(said, np.ones(1), outputs, W, np.zeros(measures.LANES), values, 0)
    assert values.tolist() == [0.0] * measures.LANES
    assert not np.signbit(values).any()


@pytest.mark.parametrize("general", range(measures.LANES))
def test_sweeps_go_on_until_each_of_four_matrices_is_orthogonal(general, monkeypatch):
    monkeypatch.setattr(measures, "lanes", FOUR)
    of_four = SimpleNamespace(sqrt=np.sqrt, where_less=lambda a, b, x, y: np.where(a < b, x, y))
    monkeypatch.setattr(singular_values, "elementary", of_four)
    J = np.zeros((measures.LANES, 6, 6))
    J[:] = np.diag(np.arange(1.0, 7.0))
    J[general] = RNG.normal(size=(6, 6))
    outputs = np.moveaxis(J, 0, -1).reshape(36, measures.LANES)
    said = (measures.SMALLEST, 1, 36, 6, 6)
    values = np.full(measures.LANES, 77.0)
    W = measures.matrix_room(said)
    measures.measure_lanes(said, np.ones(1), outputs, W, np.empty(measures.LANES), values, 0)
    expected = np.linalg.svd(J, compute_uv=False)
    # both within 64 u of the largest
    assert np.abs(values - expected[:, -1]).max() <= 128 * 2.0**-53 * expected.max()


def test_a_kind_of_no_coordinates_measures_none():
    values = np.full(2, 77.0)
    for kind in (measures.NONE, *measures.OF_OUTPUTS):
        measures.measure_coordinates((kind, 1, 0, 0, 0), np.ones(2), np.ones((1, 2)), values)
    assert values.tolist() == [77, 77]
