"""TermGain: what one term brings on held-out readings."""

from __future__ import annotations

import math
from typing import NamedTuple


class TermGain(NamedTuple):
    """Gain of one kind of parameters on held-out readings, beside the others that are in the fit.

    Parameters
    ----------
    name : str
        Name of the term.
    chosen : bool
        Whether it is in the fit.
    coefficients : int
        Number of its coefficients that the readings identify beside the others.
    gain : float
        By how much the root mean square error is smaller with it than without it, m; negative where
        it makes it larger, NaN where too few readings are left to tell.
    deviation : float
        Standard deviation of the gain, m.
    """

    name: str
    chosen: bool
    coefficients: int
    gain: float
    deviation: float

    def __str__(self) -> str:
        state = "in the fit" if self.chosen else "not in the fit"
        if math.isnan(self.gain):
            return f"{self.name}: {state}, too few readings to judge it"
        verb = "brings" if self.chosen else "would bring"
        return (
            f"{self.name}: {state}, {verb} {1e3 * self.gain + 0.0:.2g} ± {1e3 * self.deviation:.2g} mm "
            f"on held-out readings ({self.coefficients} coefficients)"
        )
