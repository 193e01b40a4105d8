"""`parameters="auto"` finds what bends an arm, and nothing where nothing does."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.solve.calibration import Points, calibrate
from tests.solve.calibration.terms.sagging import ARMS, arm, case, true_term


def auto(chain, made, **options):
    return calibrate(
        chain, made.q, made.points, parameters="auto", on_rank_deficiency="fix", **options
    )


@pytest.mark.parametrize("name", ARMS)
def test_nothing_is_added_where_nothing_bends(name):
    # chance adds something in 1 case of 100; three right ones of these seeds stay so
    chain = arm(name)
    for seed in range(3):
        found = auto(chain, case(chain, seed))
        assert found.error_model.kinds == ("screws", "home"), seed
        assert not any(term.chosen for term in found.terms)
        assert len(found.terms) == 8


@pytest.mark.parametrize("name", ARMS)
def test_sag_of_a_millimetre_is_found_and_predicted_as_well_as_by_the_true_model(name):
    chain = arm(name)
    ratios = []
    for seed in range(3):
        made = case(chain, seed, sag=1e-3)
        found = auto(chain, made)
        assert "compliance" in found.error_model.kinds, seed
        (sag,) = (term for term in found.terms if term.name == "compliance")
        assert sag.chosen
        assert 3 * sag.deviation < sag.gain > 0.5e-3
        true = calibrate(
            chain, made.q, made.points, parameters=("screws", "home", true_term(chain)), folds=0,
            on_rank_deficiency="fix",
        )  # fmt: skip
        ratios.append(made.error(found) / made.error(true))
    # by mean of 100: 1.00 to 1.09, as there are up to four coefficients where two are right
    assert np.mean(ratios) < 1.3


def test_it_judges_by_held_out_readings_and_says_so_without_any():
    chain = arm("ur5")
    made = case(chain, 0)
    with pytest.raises(
        InputError, match=r"'auto' judges by held-out readings, expected folds >= 2"
    ):
        calibrate(chain, made.q, made.points, parameters="auto", folds=0)
    assert len(auto(chain, made, folds=2).terms) == 8


def test_a_robust_loss_finds_it_among_outliers():
    chain = arm("kr5")
    made = case(chain, 1, sag=1e-3)
    p = np.array(made.points.p)
    p[::10] += 0.1
    wrong = made._replace(points=Points(p, made.points.points))
    found = auto(chain, wrong, loss="tukey")
    assert found.error_model.kinds == ("screws", "home", "compliance")
    assert sorted(o.row for o in found.outliers) == list(range(0, 60, 10))
    assert made.error(found) < 1e-4  # of the noise, 5e-5 along each axis


def test_the_summary_says_what_each_term_brings():
    chain = arm("puma560")
    made = case(chain, 0, sag=1e-3)
    found = auto(chain, made)
    text = found.summary()
    assert "compliance: in the fit, brings 0." in text
    assert "drift: not in the fit, would bring " in text
    assert "the calibrated chain takes true_joints(q)" in text
    document: Any = found.to_dict()
    assert document["terms"][0]["name"] == "compliance"
