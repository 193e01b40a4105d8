"""A factory-calibrated arm: DH's numbers run away where the screws stay put."""

import numpy as np
import pytest

import poekin as pk
from poekin.algebra import IDENTITY, compose
from poekin.formats.dh import Row, Table
from poekin.formulas import dh as dh_formulas
from poekin.formulas import exponential

# Published in the documentation of the Universal Robots ROS 2 driver, package ur_calibration: a real UR10e-size arm.
D = [0.180539811714259, 439.140974079901, -446.027059806332, 7.0603368964236, 0.119811341150314, 0.115670917257426]
A = [2.12234865571206e-05, 0.0193171326277006, -0.569251663611088, -4.61409023720934e-05, -6.39280053471802e-05, 0.0]
ALPHA = [1.57014608044242, 0.0013941666682559, 0.00693818880325995, 1.56998468543761, -1.57038520649543, 0.0]
THETA = [
    *(-2.4147806894359e-07, 1.60233952386695, -1.68607190752171),
    *(0.0837331147700119, -1.01260355871158e-07, 3.91986209186124e-08),
]
TABLE = Table("standard", [Row(*row) for row in zip(THETA, D, A, ALPHA, strict=True)], name="ur10e")


def test_no_entry_of_a_screw_is_large_although_two_of_the_table_s_are_440_m():
    chain = pk.dh.to_chain(TABLE)
    assert np.abs(chain.screws).max() == pytest.approx(1.184, abs=5e-4)
    assert np.abs(chain.home).max() <= 1.2
    assert np.abs(TABLE.d).max() > 440


def test_single_precision_keeps_a_micrometre_of_the_screws_and_loses_ten_of_the_table():
    chain, single = pk.dh.to_chain(TABLE), np.float32
    screws = [[single(x) for x in S] for S in chain.screws.tolist()]
    home = [single(x) for x in (*chain.home[:3, :3].ravel(), *chain.home[:3, 3])]
    rows = np.array([THETA, D, A, ALPHA], dtype=single).T
    worst = {"POE": 0.0, "DH": 0.0}
    for q in np.random.default_rng(0).uniform(-np.pi, np.pi, (1000, 6)):
        true = chain.fk(q)[:3, 3]
        poe = dh = tuple(map(single, IDENTITY))
        for S, (theta, d, a, alpha), x in zip(screws, rows, q.astype(single), strict=True):
            poe = compose(poe, exponential.joint(tuple(S[:3]), tuple(S[3:]), x, np.sin(x), np.cos(x)))
            turn = theta + x
            dh = compose(dh, dh_formulas.link(np.sin(turn), np.cos(turn), d, a, np.sin(alpha), np.cos(alpha)))
        poe = compose(poe, home)
        assert all(type(value) is single for value in poe[9:])
        worst["POE"] = max(worst["POE"], float(np.abs(np.array(poe[9:], float) - true).max()))
        worst["DH"] = max(worst["DH"], float(np.abs(np.array(dh[9:], float) - true).max()))
    assert worst["POE"] <= 1e-6
    assert worst["DH"] > 1e-5


def test_the_table_comes_back_from_its_screws_with_a_warning_in_numbers():
    result = pk.dh.from_chain(pk.dh.to_chain(TABLE))
    assert result.error <= result.bound
    np.testing.assert_allclose(np.abs(result.table.d[1:3]), np.abs(D[1:3]), rtol=1e-6)
    (warning,) = result.warnings
    assert "nearly parallel, 0.00139 rad: d is 439 m on an arm of 1.77 m" in warning
