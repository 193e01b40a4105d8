"""Two arms' axes as lines in space, side by side: what `compare` aligns.

A screw is carried by a pose D as Ad(D) S. Model b's base stands at P in model a's, and b's joint k
reads z_k where a's reads 0; so b's axis i is carried by D_i = P e^{B_1 z_1} ... e^{B_{i-1}
z_{i-1}}. All is computed about each arm's centre, the point nearest to all its axes, so that a far
base frame costs no digits. Leading axes are the batch: many `Alignments` (P, z) at once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import angular_part, applied, norms, rotation_part, translation_part
from ....model.chain import Chain
from ...axis_lines import (
    Marks,
    Tolerances,
    cross,
    direction,
    nearest_point,
    place,
    prismatic,
)
from .alignments import Alignments


@dataclass(frozen=True, eq=False)
class Lines:
    """The axes of one arm at rest about its centre.

    Attributes: screws (n, 6); axes (n, 6), the same without pitch; ways (n, 3), their unit
    directions; kinds (n), and slides (n), whether they are prismatic; pitches (n), m per rad;
    places (n, 3), the point of each axis nearest the centre (zero for prismatic joints, which have
    no place); centre (3,) and home (4, 4), in the own base.
    """

    screws: Array
    axes: Array
    ways: Array
    kinds: tuple[str, ...]
    slides: Marks
    pitches: Array
    places: Array
    centre: Array
    home: Array

    @property
    def revolute(self) -> Marks:
        """Whether each joint is revolute (n)."""
        return np.array(self.kinds) == "revolute"

    def part(self, k: int) -> slice:
        """The part of axis k that is its direction."""
        if self.slides[k]:
            return slice(3, 6)
        return slice(0, 3)


@dataclass(frozen=True, eq=False)
class Sides:
    """Two arms to be aligned, and how near is near enough: `tol`.

    `alike` (n,): same kind and pitch. `weights` (n, 6, 6): what makes of a change of an axis how
    far it moves, in tolerances: direction, then place at a's place on it. `ways` (n, 6): a's
    directions, as what b's axis has for one. `zero_tolerance` (n,): of a zero offset, an angle, or
    for a prismatic joint a length. `suspect_joint`: a joint of b whose axis is held to be wrong, so that
    its zero offset turns what is behind it about a's axis instead; -1 for none.
    """

    a: Lines
    b: Lines
    tol: Tolerances
    alike: Marks
    weights: Array
    ways: Array
    zero_tolerance: Array
    suspect_joint: int = -1

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.alike)

    @property
    def as_they_stand(self) -> Alignments:
        """The alignment that changes nothing."""
        return self._rigid(np.eye(4))

    @property
    def tool_as_it_stands(self) -> Alignments:
        """The alignment that leaves the tool where it is."""
        return self._rigid(self.a.home @ se3.inverse(self.b.home))

    def _rigid(self, P: Array) -> Alignments:
        return Alignments.rigid(self.on_centre(P)[None], self.n)

    def on_centre(self, P: Array, sign: float = 1.0) -> Array:
        """The poses (..., 4, 4) between the arms' centres, of those between their own bases; the
        other way round where the sign is -1.
        """
        T = P.copy()
        turned = rotation_part(P) @ self.b.centre
        T[..., :3, 3] += sign * (turned - self.a.centre)
        return T

    def off_centre(self, P: Array) -> Array:
        """The poses (..., 4, 4) between the arms' own bases, of those between their centres."""
        return self.on_centre(P, -1.0)

    def carriers(self, at: Alignments) -> Array:
        """D_1 ... D_{n+1} (m, n + 1, 4, 4): D_i = P e^{B_1 z_1} ... e^{B_{i-1} z_{i-1}}, about the
        centres.
        """
        D = [at.P]
        for i, x in enumerate(at.z.T):
            here = D[-1]
            screw = self.b.screws[i]
            if not x.any():
                D.append(here)
            elif i == self.suspect_joint:
                screws = self.suspect_screw(se3.adjoint(here) @ screw)
                D.append(se3.exp(screws * x[:, None]) @ here)
            else:
                D.append(here @ se3.exp(screw * x[:, None]))
        return np.stack(D, axis=1)

    def suspect_screw(self, carried: Array) -> Array:
        """a's screw (m, 6) of the joint that is held to be wrong, turning the way that b's carried
        screw (m, 6) does.
        """
        own = self.a.screws[self.suspect_joint]
        part = self.a.part(self.suspect_joint)
        opposite = carried[:, part] @ own[part] < 0
        return np.where(opposite[:, None], -own, own)

    def transformed(self, at: Alignments) -> Transformed:
        """Model b's axes under alignments."""
        D = at.P[:, None]
        if at.z.any():
            D = self.carriers(at)[:, :-1]
        Ad = se3.adjoint(D)
        axes = applied(Ad, self.b.axes)
        against = (self.ways * axes).sum(-1) < 0
        signs = np.where(against, -1.0, 1.0)
        return Transformed(self, applied(Ad, self.b.screws), axes, signs)

    def deviations(self, at: Alignments) -> Array:
        """The deviations (m, n) of b's axes under alignments."""
        return self.transformed(at).deviations


@dataclass(frozen=True, eq=False)
class Transformed:
    """Model b's screws and pitch-free axes (m, n, 6) in model a's base, about a's centre.

    `signs` (m, n): +1 or -1, whether each axis points the same way as a's.
    """

    pair: Sides
    screws: Array
    axes: Array
    signs: Array

    @property
    def residuals(self) -> Array:
        """Distances from a's axes in tolerances (m, n, 6): direction, then place at a's place on
        each.
        """
        change = self.signs[..., None] * self.axes - self.pair.a.axes
        return applied(self.pair.weights, change)

    @property
    def deviations(self) -> Array:
        """Tolerances (m, n) by which each axis is off in direction or place; inf where kinds
        differ.
        """
        r = self.residuals
        parts = r.reshape(*r.shape[:-1], 2, 3)
        worst = norms(parts).max(-1)
        return np.where(self.pair.alike, worst, np.inf)


def lines(chain: Chain) -> Lines:
    """The axes of a chain at rest about its centre."""
    slides = prismatic(chain)
    centre = _centre(chain, slides)
    screws = chain.screws.copy()
    screws[:, 3:] += cross(angular_part(screws), centre)
    axes = screws.copy()
    axes[:, 3:] -= chain.pitches[:, None] * angular_part(screws)
    return Lines(
        screws,
        axes,
        direction(axes, slides),
        chain.kinds,
        slides,
        chain.pitches,
        place(axes),
        centre,
        chain.home,
    )


def sides(a: Chain, b: Chain, tol: Tolerances) -> Sides:
    """Both chains at rest, with equal numbers of joints, ready to be aligned."""
    one = lines(a)
    other = lines(b)
    # A pitch shows after one turn as a length.
    pitched = abs(one.pitches - other.pitches) * 2 * np.pi
    same = [k == j for k, j in zip(one.kinds, other.kinds, strict=True)]
    length = np.where(one.slides, tol.rotation, tol.position)
    weights = np.zeros((len(same), 6, 6))
    weights[:, :3, :3] = np.eye(3) / tol.rotation
    weights[:, 3:, :3] = -so3.hat(one.places)
    weights[:, 3:, 3:] = np.eye(3)
    weights[:, 3:] /= length[:, None, None]
    theirs = np.stack([~other.slides, other.slides], axis=1)
    return Sides(
        one,
        other,
        tol,
        np.array(same, bool) & (pitched <= tol.position),
        weights,
        (theirs[..., None] * one.ways[:, None]).reshape(-1, 6),
        np.where(other.slides, tol.position, tol.rotation),
    )


def _centre(chain: Chain, slides: Marks) -> Array:
    """The point (3,) nearest to all axes; where they leave it free (parallel axes), as near the
    tool as they let it.
    """
    tool = translation_part(chain.home)
    if slides.all():
        return tool.copy()
    # Axes parallel within a degree or so leave it free, else it would fly away.
    return nearest_point(chain.screws[~slides], tool, 0.02)
