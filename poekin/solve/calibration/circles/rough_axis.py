"""Rough axis of a sweep, by linear least squares: what the fit of its circle starts from."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import (
    applied,
    norm,
    normalised,
    norms,
    rotation_part,
    translation_part,
)
from ..fit.initial_guess import mean_pose
from ..model.tsqr import least_squares
from .joint_sweep import JointSweep

LOOSE = 0.02
"""rad, and parts of the radius: an axis that is known less well is none."""
_SEEN = 3.0  # standard deviations by which a point has to move
_ROUNDING = 1e-12
_LONGER = 1.05


class RoughAxis(NamedTuple):
    """Screw (6,) in the frame of the measurements, and the pose of the tool at the middle reading."""

    screw: Array
    home: Array


def rough_axis(sweep: JointSweep, what: str) -> RoughAxis:
    """The axis by the readings as they are. Raises: InputError where nothing shows it."""
    if sweep.kind == "prismatic":
        screw = _line(sweep, what)
    elif sweep.has_poses:
        screw = _turned(sweep)
    else:
        screw = _circle(sweep, what)
    motions = sweep.readings[:, None] * screw
    home = carried_back(sweep, se3.exp(-motions))
    return RoughAxis(screw, home)


def carried_back(sweep: JointSweep, back: Array) -> Array:
    """Mean (4, 4) of the measured poses, or points, each moved by one of `back` (N, 4, 4)."""
    measured = sweep.measured
    if sweep.has_poses:
        return mean_pose(back @ measured)
    moved = applied(rotation_part(back), measured)
    positions = moved + translation_part(back)
    return se3.pose(np.eye(3), positions.mean(axis=0))


def _line(sweep: JointSweep, what: str) -> Array:
    """Screw of a joint that slides."""
    p = sweep.positions
    design = _design_of_line(sweep.readings)
    solution = least_squares(design, p)
    _check_seen(p, p - design @ solution, what)
    slope = normalised(solution[1])
    return np.concatenate([np.zeros(3), slope])


def _circle(sweep: JointSweep, what: str) -> Array:
    """Screw by p = c + a cos x + b sin x, with a x b along it and c on it.

    Raises: InputError for points that do not move, or an arc that does not show the axis.
    """
    x = sweep.readings
    p = sweep.positions
    design = _design_of_circle(x)
    solution = least_squares(design, p)
    misses = p - design @ solution
    _check_seen(p, misses, what)
    freedom = misses.size - solution.size
    sigma = norm(misses) / freedom**0.5
    # along the chord the readings show the radius however short the arc
    slope = least_squares(x[:, None], p - p.mean(axis=0))
    shift = sigma * _spread(sweep, x)
    check_arc(sweep, shift / norm(slope), shift, what)
    c, a, b = solution
    u = normalised(np.cross(a, b))
    return np.concatenate([u, np.cross(c, u)])


def _turned(sweep: JointSweep) -> Array:
    """Screw by the turns from each reading to the next, and by p = (I - R) c + R p_0 with R = e^[u x]
    and c on it.
    """
    order = np.argsort(sweep.readings)
    x = sweep.readings[order]
    R = rotation_part(sweep.measured)[order]
    steps = R[1:] @ np.swapaxes(R[:-1], 1, 2)
    u = normalised(np.diff(x) @ so3.log(steps))
    turned = so3.exp(x[:, None] * u)
    design = np.concatenate([np.eye(3) - turned, turned], axis=2)
    p = sweep.positions[order]
    solution = least_squares(design.reshape(-1, 6), p.ravel())
    return np.concatenate([u, np.cross(solution[:3], u)])


def _design_of_line(x: Array) -> Array:
    return np.column_stack([np.ones_like(x), x])


def _design_of_circle(x: Array) -> Array:
    return np.column_stack([np.ones_like(x), np.cos(x), np.sin(x)])


def _spread(sweep: JointSweep, x: Array) -> float:
    """Standard deviation that readings x leave, but for a factor: of a circle's centre by points, of
    a slope by poses or along a line.
    """
    design = _design_of_circle(x)
    if sweep.has_poses or sweep.kind == "prismatic":
        design = _design_of_line(x)
    covariance = np.linalg.inv(design.T @ design)
    return float(np.trace(covariance[1:, 1:])) ** 0.5


def check_arc(sweep: JointSweep, tilt: float, shift: float, what: str) -> None:
    """Refuse an arc, or a stroke, that leaves the axis known to no better than `LOOSE`, and say which
    would do.

    tilt: standard deviation of its direction, rad; shift: of its place, m.
    """
    if tilt <= LOOSE:
        return
    x = sweep.readings
    slides = sweep.kind == "prismatic"
    enough = _spread(sweep, x) * LOOSE / tilt
    most = np.inf if slides else 2.0 * np.pi / float(np.ptp(x))
    longer = 1.0
    while longer < most and _spread(sweep, longer * x) > enough:
        longer *= _LONGER
    would = f"with as many readings {_moved(sweep, longer)} would do"
    if longer >= most:
        would = "no arc would do: measure farther from the axis, or more readings"
    place = "" if slides else f" and {1e3 * shift:.2g} mm"
    raise InputError(
        f"{what}: {_moved(sweep, 1.0)} leaves the axis known to {tilt:.2g} rad{place} (one standard "
        f"deviation), expected {LOOSE:g} rad or less; {would}"
    )


def _moved(sweep: JointSweep, times: float) -> str:
    """An arc or a stroke that is so many times as long as that of the sweep, in words."""
    span = times * float(np.ptp(sweep.readings))
    if sweep.kind == "prismatic":
        return f"a stroke of {1e3 * span:.3g} mm"
    return f"an arc of {np.rad2deg(span):.3g}°"


def _check_seen(p: Array, misses: Array, what: str) -> None:
    """Refuse points (N, 3) that move no more than they scatter."""
    moves = norms(p - p.mean(axis=0))
    moved = float(moves.max())
    scatter = norm(misses) / len(misses) ** 0.5
    if moved > max(_SEEN * scatter, _ROUNDING):
        return
    raise InputError(
        f"{what}: the point moves by {1e3 * moved:.2g} mm and scatters by {1e3 * scatter:.2g} mm "
        "about what the readings say: it is on the axis (fix it farther away), or these are not "
        "this joint's readings, in rad or m"
    )
