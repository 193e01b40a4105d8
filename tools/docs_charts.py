"""Charts of errors on the pages of docs/, as SVG: what hasty formulas do, beside the exact ones."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

import poekin as pk
from poekin.groups.arrays import Array
from poekin.svg import GRID, INK, PALE, plain, svg

HASTY = 1e-5
"""Angle below which the formulas on the pages drop V, rad."""
GRADES = {"exact": 1e-15, "good": 1e-10, "poor": 1e-6, "broken": 1e-3}
WRONG = "#D55E00"


def hasty_error(angle: Array, length: Array) -> Array:
    """Largest error of exp with t = v below `HASTY`, for ω along z and v along x."""
    zero = np.zeros_like(angle)
    xi = np.stack([zero, zero, angle, length, zero, zero], axis=-1)
    exact = pk.se3.exp(xi)
    hasty = np.einsum("...ij,...j->...i", exact[..., :3, :3], xi[..., 3:])
    error = np.abs(hasty - exact[..., :3, 3]).max(axis=-1)
    return np.where(angle < HASTY, error, 0.0)


def hasty() -> str:
    """Where the hasty exponential is wrong, in the plane of angle and length."""
    powers = np.logspace(-12, 2, 141)

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        error = hasty_error(*np.meshgrid(powers[powers <= 3], powers))
        levels = (1e-9, 1e-7, 1e-5, 1e-3)
        filled = axes.contourf(
            powers[powers <= 3], powers, error, levels, cmap="Oranges", norm="log", extend="max"
        )
        figure.colorbar(filled, label="error of the position (m)")
        axes.plot(powers, powers, ":", color=INK, linewidth=1.2)
        axes.text(1e-7, 1e-8, "scaled as a whole", color=INK)
        axes.set(xscale="log", yscale="log", xlim=(1e-12, 3), ylim=(1e-12, 1e2))
        axes.set(xlabel="angle |ω| (rad)", ylabel="length |v| (m)")
        plain(axes)

    return svg(6.4, 3.2, "a chart of errors", draw)


def grades() -> str:
    """Error of the hasty exponential by angle, over the grades of `poekin conform`."""
    angle = np.logspace(-12, 0.4, 400)

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        lower = 1e-17
        for shade, (name, upper) in zip((0.2, 0.45, 0.7, 1.0), GRADES.items(), strict=True):
            axes.axhspan(lower, upper, color=GRID, alpha=shade, linewidth=0)
            axes.text(1.6, np.sqrt(lower * upper), name, ha="right", va="center", color=INK)
            lower = upper
        error = hasty_error(angle, np.ones_like(angle))
        axes.plot(angle[error > 0], error[error > 0], color=WRONG, linewidth=1.8)
        axes.axvline(HASTY, color=PALE, linewidth=0.8, linestyle=":")
        axes.set(xscale="log", yscale="log", xlim=(1e-12, 3), ylim=(1e-17, 1e-3))
        axes.set(xlabel="angle |ω| (rad)", ylabel="error (m)")
        plain(axes)

    return svg(6.4, 2.8, "a chart of errors", draw)


@functools.cache
def charts() -> dict[str, str]:
    """File name and text of each chart."""
    return {"hasty.svg": hasty(), "grades.svg": grades()}
