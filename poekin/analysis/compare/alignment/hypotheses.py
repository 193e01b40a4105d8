"""One reading of two models' difference: an alignment, what it blames, and what that costs beside
other readings.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....groups import se3, so3
from ....groups.arrays import Array
from ....model.chain import Chain
from .lines import Marks, Sides, carriers, cross, deviations, signs, transformed

ONE = 2.5
"""Cost of one change in one joint, beside which no other conventions are looked for."""


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """One way to read the difference: f_a(x) = base f_b(direction x + zeros) tool, but for the axes
    that moved.

    Attributes: base (4, 4), b's base in a's; tool (4, 4), a's tool in b's; zeros (n), rad or m,
    where b stands when a is at 0; directions (n), +1 or -1; moved (n, bool), axes beyond tolerance;
    offset (n, bool), zeros beyond it;
    axes (n, 6), b's screws without pitch as they then stand in a's base; deviations (n), of each, in
    tolerances;
    frames, how many of base and tool moved; link, k > 0 where the axes behind joint k moved
    together, by a link that is another one: then the tool is the one behind them.
    """

    base: Array
    tool: Array
    zeros: Array
    directions: Array
    moved: Marks
    offset: Marks
    axes: Array
    deviations: Array
    frames: int
    link: int = 0

    @property
    def implicated(self) -> Marks:
        """Joints (n, bool) that differ in anything."""
        return self.moved | self.offset | (self.directions < 0)

    @property
    def cost(self) -> tuple[float, ...]:
        """The order of readings: the smaller, the better.

        One change in one joint comes first, whatever it is: base and tool that stay where they are
        decide, then a zero offset rather than a moved axis. One moved axis is likelier than two
        zero offsets; but where conventions differ they differ in many joints, and each more says
        little: where base and tool both moved, other zeros and directions alone come before one
        moved axis. One other link, which moves all axes behind it, is likelier than a moved axis
        that zero offsets help. Of several moved axes it counts how far they are: the few that agree
        by chance under a wild alignment prove nothing.
        """
        conventions = int((self.offset | (self.directions < 0)).sum())
        moved = int(self.moved.sum())
        changes = int(self.offset.sum() + (self.directions < 0).sum())
        near = float(np.minimum(self.deviations, 10.0).sum())
        if moved + changes <= 1:
            alone = ONE * (moved + changes)
            if moved and self.frames == 2:
                alone = 4.9
            return (alone, self.frames, moved, near)
        if self.link:
            return (5.25, self.frames, moved, near)
        weight = (0.0, 2.5, 3.5)[conventions] if conventions < 3 else 3.25 + 0.25 * conventions
        far = float((self.deviations[self.moved] ** 0.25).sum())
        if moved <= 1:
            far *= 0.05
        return (3.0 * moved + far + weight, self.frames, changes, near)


def read(pair: Sides, a: Chain, b: Chain, P: Array, z: Array) -> list[Hypothesis]:
    """The readings that alignments (P, z) of a's and b's axes (both at rest), (m, 4, 4) and (m, n),
    stand for.
    """
    axes = transformed(pair, P, z)[1]
    miss = deviations(pair, axes)
    s = signs(pair, axes)
    base = off_centre(pair, P)
    last = off_centre(pair, carriers(pair, P, z)[:, -1])
    tool = se3.inverse(last @ b.home) @ a.home
    axes[..., 3:] -= cross(axes[..., :3], pair.a.centre)
    frames = (~still(np.stack([base, tool]), pair.tol_m, pair.tol_rad)).sum(0)
    moved = miss > 1.0
    offset = abs(z) > pair.zero_tolerance
    far = np.minimum(miss, 1e9)
    return [
        Hypothesis(
            base[i], tool[i], z[i], s[i], moved[i], offset[i], axes[i], far[i], int(frames[i])
        )
        for i in range(len(z))
    ]


def still(T: Array, tol_m: float, tol_rad: float) -> Marks:
    """Whether poses (..., 4, 4) are the identity within tolerance (...)."""
    moved = np.linalg.norm(T[..., :3, 3], axis=-1)
    turned = np.linalg.norm(so3.log(T[..., :3, :3]), axis=-1)
    return (moved <= tol_m) & (turned <= tol_rad)


def off_centre(pair: Sides, P: Array) -> Array:
    """The poses (..., 4, 4) between the arms' own bases, of those between their centres."""
    T = P.copy()
    T[..., :3, 3] += pair.a.centre - P[..., :3, :3] @ pair.b.centre
    return T
