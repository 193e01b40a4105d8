"""No bad fit ends well: wrong data are refused or found not fit for use, and their cause is named."""

from __future__ import annotations

import warnings

from poekin.errors import InputError, PoekinWarning
from poekin.solve.calibration import calibrate
from tests.solve.calibration.causes.wrong_data import ARMS, Wrong, arm, wrong_data

CASES = {(name, wrong.name): (name, wrong) for name in ARMS for wrong in wrong_data(arm(name), 1)}
NAMED = 0.85


def verdict(name: str, wrong: Wrong) -> str:
    """The first line of the verdict, or of the refusal; "" where a fit ends well."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        try:
            found = calibrate(arm(name), wrong.q, wrong.measured, folds=2)
        except InputError as refusal:
            return str(refusal)
    return next(iter(found.verdict), "")


def test_wrong_data_never_end_well_and_their_cause_is_named_first():
    said = {case: verdict(*given) for case, given in CASES.items()}
    assert [case for case, words in said.items() if not words] == []
    named = [case for case, words in said.items() if CASES[case][1].words in words]
    assert len(named) >= NAMED * len(said), set(said) - set(named)
