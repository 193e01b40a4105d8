"""Metrics of a design are those of the information of what was chosen and of what was measured before."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.solve.calibration.design.metrics import (
    Design,
    check_enough,
    design_metrics,
    root_information,
)


def design(seed: int, measured: int = 0) -> Design:
    """Nine candidates of two numbers each for three parameters, and some measured before."""
    rng = np.random.default_rng(seed)
    blocks = rng.normal(size=(9, 2, 3))
    before = rng.normal(size=(measured, 2, 3))
    return Design(blocks, before, rng.normal(size=(3, 3)))


def along(*directions: int, size: float = 1.0) -> np.ndarray:
    """Candidates (K, 1, 3) each of which shows one of three parameters."""
    return size * np.eye(3)[list(directions)][:, None]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("measured", [0, 4])
def test_the_metrics_are_their_definitions_in_the_information_matrix(seed, measured):
    made = design(seed, measured)
    rows = np.array([1, 4, 5, 8])
    found = design_metrics(made, rows)
    J = np.concatenate([*made.blocks[rows], *made.before])
    N = J.T @ J
    least, _, most = np.sqrt(np.linalg.eigvalsh(N))
    assert found.smallest == pytest.approx(least, rel=1e-9)
    assert found.condition == pytest.approx(most / least, rel=1e-9)
    assert found.amplification == pytest.approx(least**2 / most, rel=1e-9)
    mean = np.linalg.det(N) ** (1 / 6)
    assert pytest.approx(mean / np.sqrt(4 + measured), rel=1e-9) == found.O1
    covariance = made.root @ np.linalg.inv(N) @ made.root.T
    assert found.prediction == pytest.approx(np.trace(covariance) ** 0.5, rel=1e-9)


@pytest.mark.parametrize("blocks", [along(0, 1), np.zeros((4, 2, 3)), along(0, 1, 1, 0)])
def test_of_what_leaves_a_parameter_open_nothing_is_known(blocks):
    before = np.empty((0, *blocks.shape[1:]))
    found = design_metrics(Design(blocks, before, np.eye(3)), np.arange(len(blocks)))
    assert found == (0.0, np.inf, 0.0, 0.0, np.inf)


@pytest.mark.parametrize(("size", "seen"), [(0.9e-9, False), (1.1e-9, True)])
def test_a_direction_is_seen_from_a_billionth_of_the_best_one_on(size, seen):
    blocks = np.concatenate([along(0, size=4.0), along(1), along(2, size=4.0 * size)])
    found = design_metrics(Design(blocks, np.empty((0, 1, 3)), np.eye(3)), np.arange(3))
    assert found.smallest == (pytest.approx(4.0 * size) if seen else 0.0)
    assert np.isfinite(found.prediction) == seen


def test_roots_have_the_information_of_what_they_stand_for():
    made = design(0, 5)
    R = root_information(made.blocks)
    mean = sum(np.outer(number, number) for block in made.blocks for number in block) / 18
    np.testing.assert_allclose(R.T @ R, mean, rtol=0, atol=1e-12)
    given = made.given_rows
    before = sum(block.T @ block for block in made.before)
    np.testing.assert_allclose(given.T @ given, before, rtol=0, atol=1e-12)


def refused(blocks: np.ndarray, before: np.ndarray, n: int) -> str:
    with pytest.raises(InputError) as caught:
        check_enough(Design(blocks, before, np.eye(3)), n)
    return str(caught.value)


def words(n: int, equations: int, needed: int) -> str:
    return (
        f"n: {n} configurations of {equations} equations each are too few for 3 parameters: expected "
        f"at least {needed}, better three times as many; or calibrate less (parameters=, joints=)"
    )


def test_the_least_number_of_configurations_that_show_everything_is_said():
    none = np.empty((0, 1, 3))
    every = along(0, 0, 1, 1, 2, 2)
    for n in (1, 2):
        assert refused(every, none, n) == words(n, 1, 3)
    check_enough(Design(every, none, np.eye(3)), 3)
    both = np.concatenate([every[::2], every[1::2][[1, 2, 0]]], axis=1)
    assert refused(both, np.empty((0, 2, 3)), 1) == words(1, 2, 2)
    check_enough(Design(both, np.empty((0, 2, 3)), np.eye(3)), 2)


def test_what_was_measured_before_counts():
    every = along(0, 0, 1, 1, 2, 2)
    assert refused(every, along(0), 1) == words(1, 1, 2)
    check_enough(Design(every, along(0), np.eye(3)), 2)
    check_enough(Design(every, along(0, 2), np.eye(3)), 1)


@pytest.mark.parametrize(("count", "n", "said"), [(6, 1, 3), (6, 4, 4), (2, 1, 2)])
def test_where_none_of_those_tried_is_enough_their_number_is_said(count, n, said):
    """As many are tried as there are parameters, at least those that were asked for."""
    faint = along(2, size=1e-10) + along(0)
    blocks = np.concatenate([np.tile(along(0) + along(1), (count - 1, 1, 1)), faint])
    blocks = np.concatenate([blocks, np.tile(along(0), (count, 1, 1))], axis=1)
    message = refused(blocks, np.empty((0, 2, 3)), n)
    assert message == words(n, 2, said)
