"""Robust losses of a measurement's squared error s = e^T C^-1 e, its d numbers taken together.

rho(s) is s for small errors and grows more slowly, or not at all, for gross ones. Taken together,
the numbers of one measurement are trusted or doubted as one, whichever axes they are given in.
Source: Huber, Robust Statistics, 1981, chapters 3, 7; thresholds of 95 % efficiency for one number:
1.345 (Huber), 2.385 (Cauchy), 4.685 (Tukey's biweight), and for d numbers the same quantile of
chi-square.
"""

from __future__ import annotations

from typing import Literal, NamedTuple, get_args

import numpy as np

from ....groups.arrays import Array

LossName = Literal["linear", "huber", "cauchy", "tukey"]
LOSSES: tuple[LossName, ...] = get_args(LossName)
# The thresholds' quantiles of one squared normal number, as quantiles of the normal distribution.
_QUANTILE = {"huber": 0.917, "cauchy": 2.121, "tukey": 4.536}
OUTLIER = 3.719
"""Quantile of the normal distribution beyond which a measurement is named an outlier: one good one
in 10^4.
"""


class Loss(NamedTuple):
    """rho(s), the weight rho'(s) and rho''(s), each (N,)."""

    rho: Array
    weight: Array
    rho_second: Array


def chi_square(width: float, quantile: float) -> float:
    """The point of chi-square with `width` degrees of freedom at a quantile given as one of the
    normal distribution.

    Source: Wilson and Hilferty, 1931: (chi^2/d)^(1/3) is nearly normal. Accuracy: from the median
    to the quantile 3
    1.6 % for 3 and more and 4 % for 1, at 3.719 4 % and 8 %, at 4.536 7 % and 14 %.
    """
    k = 2.0 / (9.0 * width)
    return width * (1.0 - k + quantile * k**0.5) ** 3


def loss(name: LossName, s: Array, width: int) -> Loss:
    """The loss of that name for squared errors s (N,) of measurements of `width` numbers."""
    if name == "linear":
        return Loss(s, np.ones_like(s), np.zeros_like(s))
    return _BY_NAME[name](s, chi_square(width, _QUANTILE[name]))


def _huber(s: Array, c: float) -> Loss:
    near = s <= c
    root = np.sqrt(np.where(near, 1.0, s / c))
    return Loss(
        rho=np.where(near, s, c * (2.0 * root - 1.0)),
        weight=1.0 / root,
        rho_second=np.where(near, 0.0, -0.5 / (c * root**3)),
    )


def _cauchy(s: Array, c: float) -> Loss:
    u = s / c
    weight = 1.0 / (1.0 + u)
    return Loss(
        rho=c * np.log1p(u),
        weight=weight,
        rho_second=-(weight**2) / c,
    )


def _tukey(s: Array, c: float) -> Loss:
    u = np.minimum(s / c, 1.0)
    left = 1.0 - u
    return Loss(
        rho=c * u * (left + u * u / 3.0),
        weight=left**2,
        rho_second=-2.0 * left / c,
    )


_BY_NAME = {"huber": _huber, "cauchy": _cauchy, "tukey": _tukey}
