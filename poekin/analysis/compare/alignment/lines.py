"""Two arms' axes as lines in space, side by side: what `compare` aligns.

A screw is carried by a pose D as Ad(D) S. Model b's base stands at P in model a's, and b's joint k
reads z_k where a's reads 0; so b's axis i is carried by D_i = P e^{B_1 z_1} ... e^{B_{i-1}
z_{i-1}}. All is computed about each arm's centre, the point nearest to all its axes, so that a far
base frame costs no digits. Leading axes are the batch: many alignments (P, z) at once, P (..., 4,
4) and z (..., n).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....groups import se3, so3
from ....groups.arrays import Array
from ....model.chain import Chain
from ...axis_lines import cross, direction

Marks = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Lines:
    """The axes of one arm at rest about its centre.

    Attributes: screws (n, 6); axes (n, 6), the same without pitch; ways (n, 3), their unit
    directions; kinds (n); pitches (n), m per rad; places (n, 3), the point of each axis nearest the
    centre (zero for prismatic joints, which have no place); centre (3,) and home (4, 4), in the own
    base.
    """

    screws: Array
    axes: Array
    ways: Array
    kinds: tuple[str, ...]
    pitches: Array
    places: Array
    centre: Array
    home: Array


@dataclass(frozen=True, eq=False)
class Sides:
    """Both arms' lines, and how near is near enough: tol_m (m) and tol_rad (rad).

    `alike` (n,): same kind and pitch. `weights` (n, 6, 6): what makes of a change of an axis how
    far it moves, in tolerances: direction, then place at a's place on it. `ways` (n, 6): a's
    directions, as what b's axis has for one. `zero_tolerance` (n,): of a zero offset, an angle, or
    for a prismatic joint a length. `suspect_joint`: a joint of b whose axis is held to be wrong, so that
    its zero offset turns what is behind it about a's axis instead; -1 for none.
    """

    a: Lines
    b: Lines
    tol_m: float
    tol_rad: float
    alike: Marks
    weights: Array
    ways: Array
    zero_tolerance: Array
    suspect_joint: int = -1

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.a.kinds)


def lines(chain: Chain) -> Lines:
    """The axes of a chain at rest about its centre."""
    centre = _centre(chain)
    screws = chain.screws.copy()
    screws[:, 3:] += cross(screws[:, :3], centre)
    axes = screws.copy()
    axes[:, 3:] -= chain.pitches[:, None] * screws[:, :3]
    places = cross(axes[:, :3], axes[:, 3:])
    ways = direction(axes, chain.kinds)
    kinds = chain.kinds
    return Lines(screws, axes, ways, kinds, chain.pitches, places, centre, chain.home)


def sides(a: Chain, b: Chain, tol_m: float, tol_rad: float) -> Sides:
    """Both chains at rest, with equal numbers of joints, ready to be aligned."""
    one = lines(a)
    other = lines(b)
    # A pitch shows after one turn as a length.
    alike = [
        k == j and abs(g - h) * 2 * np.pi <= tol_m
        for k, j, g, h in zip(one.kinds, other.kinds, one.pitches, other.pitches, strict=True)
    ]
    ours, theirs = (np.array(side.kinds) == "prismatic" for side in (one, other))
    weights = np.zeros((len(alike), 6, 6))
    weights[:, :3, :3] = np.eye(3) / tol_rad
    weights[:, 3:, :3] = -so3.hat(one.places)
    weights[:, 3:, 3:] = np.eye(3)
    weights[:, 3:] /= np.where(ours, tol_rad, tol_m)[:, None, None]
    ways = np.concatenate([one.ways, one.ways], axis=1) * np.repeat(
        np.stack([~theirs, theirs], axis=1),
        3,
        axis=1,
    )
    zero_tolerance = np.where(theirs, tol_m, tol_rad)
    return Sides(one, other, tol_m, tol_rad, np.array(alike, bool), weights, ways, zero_tolerance)


def carriers(pair: Sides, P: Array, z: Array) -> Array:
    """D_1 ... D_{n+1} (..., n + 1, 4, 4): D_i = P e^{B_1 z_1} ... e^{B_{i-1} z_{i-1}}, about the
    centres.
    """
    D = np.empty((*z.shape[:-1], pair.n + 1, 4, 4))
    here = P
    for i in range(pair.n):
        D[..., i, :, :] = here
        if z[..., i].any():
            turn = z[..., i, None]
            if i == pair.suspect_joint:
                here = (
                    se3.exp(suspect_screw(pair, se3.adjoint(here) @ pair.b.screws[i]) * turn) @ here
                )
            else:
                here = here @ se3.exp(pair.b.screws[i] * turn)
    D[..., pair.n, :, :] = here
    return D


def suspect_screw(pair: Sides, carried: Array) -> Array:
    """a's screw (..., 6) of the joint that is held to be wrong, turning the way that b's carried
    one (..., 6) does.
    """
    own = pair.a.screws[pair.suspect_joint]
    part = slice(0, 3)
    if pair.a.kinds[pair.suspect_joint] == "prismatic":
        part = slice(3, 6)
    return np.where((carried[..., part] @ own[part] < 0)[..., None], -own, own)


def transformed(pair: Sides, P: Array, z: Array) -> tuple[Array, Array]:
    """Model b's screws and pitch-free axes (..., n, 6) in model a's base, about a's centre."""
    D = P[..., None, :, :]
    if z.any():
        D = carriers(pair, P, z)[..., :-1, :, :]
    Ad = se3.adjoint(D)
    return (Ad @ pair.b.screws[..., None])[..., 0], (Ad @ pair.b.axes[..., None])[..., 0]


def signs(pair: Sides, axes: Array) -> Array:
    """+1 or -1 (..., n): whether each of b's carried axes (..., n, 6) points the same way as a's."""
    return np.where((pair.ways * axes).sum(-1) < 0, -1.0, 1.0)


def residuals(pair: Sides, axes: Array) -> Array:
    """Distances of b's carried axes from a's, in tolerances (..., n, 6): direction, then place at
    a's place on each.
    """
    change = signs(pair, axes)[..., None] * axes - pair.a.axes
    return (pair.weights @ change[..., None])[..., 0]


def deviations(pair: Sides, axes: Array) -> Array:
    """Tolerances (..., n) by which each of b's carried axes is off in direction or place; inf where
    kinds differ.
    """
    r = residuals(pair, axes)
    worst = np.linalg.norm(r.reshape(*r.shape[:-1], 2, 3), axis=-1).max(-1)
    return np.where(pair.alike, worst, np.inf)


def aligned_deviations(pair: Sides, P: Array, z: Array) -> Array:
    """The `deviations` (m, n) under alignments (P, z)."""
    return deviations(pair, transformed(pair, P, z)[1])


def _centre(chain: Chain) -> Array:
    """The point (3,) nearest to all axes; where they leave it free (parallel axes), as near the
    tool as they let it.
    """
    tool = chain.home[:3, 3]
    rows = [S for S, kind in zip(chain.screws, chain.kinds, strict=True) if kind != "prismatic"]
    if not rows:
        return tool.copy()
    across = [np.eye(3) - np.outer(S[:3], S[:3]) for S in rows]
    reach = [A @ (cross(S[:3], S[3:]) - tool) for A, S in zip(across, rows, strict=True)]
    # Axes parallel within a degree or so leave it free, else it would fly away.
    return tool + np.linalg.lstsq(np.concatenate(across), np.concatenate(reach), rcond=0.02)[0]
