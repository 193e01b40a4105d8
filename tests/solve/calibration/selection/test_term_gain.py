"""A line of a term says in millimetres what it brings, to two digits, or that nothing tells."""

from __future__ import annotations

import pytest

from poekin.solve.calibration.selection.term_gain import TermGain


@pytest.mark.parametrize(
    ("gain", "said"),
    [
        (
            TermGain("backlash", True, 6, 1.234e-4, 5.67e-5),
            "backlash: in the fit, brings 0.12 ± 0.057 mm on held-out readings (6 coefficients)",
        ),
        (
            TermGain("lag", False, 5, -2e-3, 0.0),
            "lag: not in the fit, would bring -2 ± 0 mm on held-out readings (5 coefficients)",
        ),
        (
            TermGain("lag", False, 5, -0.0, 1e-3),
            "lag: not in the fit, would bring 0 ± 1 mm on held-out readings (5 coefficients)",
        ),
        (
            TermGain("drift", True, 1, float("nan"), float("nan")),
            "drift: in the fit, too few readings to judge it",
        ),
    ],
)
def test_a_term_says_what_it_brings_on_held_out_readings(gain, said):
    assert str(gain) == said
