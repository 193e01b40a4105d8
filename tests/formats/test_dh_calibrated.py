"""A factory-calibrated arm: DH's numbers run away where the screws stay put."""

import numpy as np
import pytest

import poekin as pk
from benchmarks.calibrated_arm import UR10E, single_precision_errors


def test_no_entry_of_a_screw_is_large_although_two_of_the_table_s_are_440_m():
    chain = pk.dh.to_chain(UR10E)
    assert np.abs(chain.screws).max() == pytest.approx(1.184, abs=5e-4)
    assert np.abs(chain.home).max() <= 1.2
    assert np.abs(UR10E.d).max() > 440


def test_single_precision_keeps_a_micrometre_of_the_screws_and_loses_ten_of_the_table():
    errors = single_precision_errors(
        UR10E, np.random.default_rng(0).uniform(-np.pi, np.pi, (1000, 6))
    )
    assert errors["POE"].max() <= 1e-6
    assert errors["DH"].max() > 1e-5


def test_the_table_comes_back_from_its_screws_with_a_warning_in_numbers():
    result = pk.dh.from_chain(pk.dh.to_chain(UR10E), convention="standard")
    assert result.error <= result.bound
    np.testing.assert_allclose(np.abs(result.table.d[1:3]), np.abs(UR10E.d[1:3]), rtol=1e-6)
    (warning,) = result.warnings
    assert "nearly parallel, 0.00139 rad: d is 439 m on an arm of 1.77 m" in warning
