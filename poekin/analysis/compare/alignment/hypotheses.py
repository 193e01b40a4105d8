"""One reading of two models' difference: an alignment, what it blames, and what that costs beside
other readings.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import angular_part, applied, norms, rotation_part, translation_part
from ....model.chain import Chain
from ...axis_lines import Marks, Tolerances, cross, wrapped
from .alignments import Alignments
from .lines import Sides, sides


class Costs(NamedTuple):
    """Costs of what differs between two models, of which only the order matters.

    One change in one joint < two or more zeros and directions alone < one other link < a moved axis
    that zeros help < several moved axes.
    """

    # One change in one joint, whatever it is: beside it no other conventions are looked for.
    one_change: float = 2.5
    # One moved axis where base and tool moved too: behind six other zeros alone (4.75), which are
    # likelier where conventions differ at all, and before seven (5).
    axis_in_moved_frames: float = 4.9
    # All axes behind a link: before one moved axis and one other zero (5.55 or more).
    link: float = 5.25
    # One other zero or direction beside another link, and each further one.
    first_beside_link: float = 1.0
    more_beside_link: float = 2.5
    # Base or tool that moved, beside another link or several axes: an axis that is farther off is
    # likelier, another one that moved with two zeros is not.
    frame: float = 1.4
    # Each of several moved axes: likelier than two zeros (3.5), less so than one (2.5).
    axis: float = 3.0
    # Share of its distance that one moved axis counts: a tie-break. Of several it counts in full,
    # as the few axes that agree by chance under a wild alignment prove nothing.
    distance_of_one_axis: float = 0.05
    # One and two joints of another zero or direction, then a start and a step for each: models
    # whose conventions differ do so in many joints, so that each more says little.
    conventions: tuple[float, float, float] = (0.0, 2.5, 3.5)
    conventions_start: float = 3.25
    conventions_step: float = 0.25
    # Tolerances beyond which a deviation counts no more where all else is equal.
    largest_deviation: float = 10.0


COSTS = Costs()


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
    together, by a link that is another one: then the tool is the one behind them; carriers
    (n, 4, 4), the poses that carry b's axes to where they stand in a's base; apart (n, bool or
    empty), axes behind another link that differ from those beside them as well.
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
    carriers: Array = field(default_factory=lambda: np.zeros((0, 4, 4)))
    apart: Marks = field(default_factory=lambda: np.zeros(0, bool))

    def poses(self, b: Chain, x: Array) -> Array:
        """Poses (m, 4, 4) of b that are to be those of a at joint values x (m, n)."""
        q = self.directions * x + self.zeros
        return self.base @ b.fk(q) @ self.tool

    def swapped(self, a: Chain) -> Hypothesis:
        """Reading of models b and a that says the same: f_b(x) = base⁻¹ f_a(direction (x - zeros)) tool⁻¹."""
        back = se3.inverse(self.carriers)
        axes = a.screws.copy()
        axes[:, 3:] -= a.pitches[:, None] * axes[:, :3]
        return replace(
            self,
            base=se3.inverse(self.base),
            tool=se3.inverse(self.tool),
            zeros=-self.directions * self.zeros,
            axes=applied(se3.adjoint(back), axes),
            carriers=back,
        )

    @property
    def changes(self) -> Marks:
        """Changes (3, n, bool) of each joint: another axis, another zero, another direction."""
        return np.stack([self.moved, self.offset, self.directions < 0])

    @property
    def beside_link(self) -> Marks:
        """Axes (n, bool) that differ otherwise than by another link."""
        own = self.moved.copy()
        if self.link:
            own[self.link :] = False
        own[np.flatnonzero(self.apart)] = True
        return own

    @property
    def implicated(self) -> Marks:
        """Joints (n, bool) that differ in anything."""
        return np.asarray(self.changes.any(axis=0))

    @property
    def cost(self) -> tuple[float, ...]:
        """The order of readings: the smaller, the better; the reasons stand in `Costs`.

        Of readings that cost the same, base and tool that stay where they are decide, then a zero
        offset rather than a moved axis, then how near the axes are.
        """
        of_convention = self.changes[1:]
        conventions = int(of_convention.any(axis=0).sum())
        changes = int(of_convention.sum())
        moved = int(self.moved.sum())
        deviations = np.minimum(self.deviations, COSTS.largest_deviation)
        near = float(deviations.sum())
        if moved + changes <= 1:
            alone = COSTS.one_change * (moved + changes)
            if moved and self.frames == 2:
                alone = COSTS.axis_in_moved_frames
            return (alone, self.frames, moved, near)
        frames = COSTS.frame * self.frames
        if self.link:
            own = self.deviations[self.beside_link]
            beside = COSTS.axis * len(own) + float((own**0.25).sum())
            if changes:
                beside += COSTS.first_beside_link + COSTS.more_beside_link * (changes - 1)
            return (COSTS.link + beside + frames, self.frames, moved, near)
        weight = COSTS.conventions_start + COSTS.conventions_step * conventions
        if conventions < len(COSTS.conventions):
            weight = COSTS.conventions[conventions]
        distances = self.deviations[self.moved] ** 0.25
        far = float(distances.sum())
        if moved <= 1:
            far *= COSTS.distance_of_one_axis
        # Rounded, as how near axes are is not to decide before frames that stay where they are.
        several = round(COSTS.axis * moved + far + weight + frames * (moved > 1), 2)
        return (several, self.frames, changes, near)


def make_hypotheses(pair: Sides, at: Alignments) -> list[Hypothesis]:
    """Hypotheses that alignments of both models' axes stand for.

    An axis is the same where its deviation is at most 1: the larger of the angle between the
    directions by `tol_rotation` and of the distance between the lines by `tol_position`
    (`lines.Transformed.deviations`); kind and pitch have agreed before.
    """
    at = Alignments(at.P, wrapped(at.z, pair.b.revolute))
    b = pair.transformed(at)
    miss = b.deviations
    base = pair.off_centre(at.P)
    carriers = pair.carriers(at)
    tool = tool_behind(pair, carriers[:, -1])
    axes = b.axes
    axes[..., 3:] -= cross(axes[..., :3], pair.a.centre)
    columns = (
        base,
        tool,
        at.z,
        b.signs,
        miss > 1.0,
        abs(at.z) > pair.zero_tolerance,
        axes,
        np.minimum(miss, 1e9),
        frames_moved(pair, base, tool).tolist(),
        [0] * len(miss),
        pair.off_centre(carriers[:, :-1]),
    )
    return [Hypothesis(*row) for row in zip(*columns, strict=True)]


def as_they_stand(a: Chain, b: Chain, tol: Tolerances) -> Hypothesis:
    """The reading that aligns nothing."""
    pair = sides(a, b, tol)
    return make_hypotheses(pair, pair.as_they_stand)[0]


def tool_behind(pair: Sides, P: Array) -> Array:
    """Poses (..., 4, 4) of a's tool in b's, where b's last link is carried by poses P."""
    end = pair.off_centre(P) @ pair.b.home
    return se3.inverse(end) @ pair.a.home


def frames_moved(
    pair: Sides,
    base: Array,
    tool: Array,
) -> NDArray[np.intp]:
    """Number (...) of the two frames that are not where they were."""
    moved = ~still(np.stack([base, tool]), pair.tol)
    return moved.sum(0)


def still(T: Array, tol: Tolerances) -> Marks:
    """Whether poses (..., 4, 4) are the identity within tolerance (...)."""
    moved, turned = motion_sizes(T)
    return (moved <= tol.position) & (turned <= tol.rotation)


def motion_sizes(T: Array) -> tuple[Array, Array]:
    """Lengths (m) and angles (rad) of motions (..., 4, 4)."""
    turns = so3.log(rotation_part(T))
    moved = norms(translation_part(T))
    turned = norms(turns)
    return moved, turned


def turn_about(T: Array, S: Array, tol: Tolerances) -> float | None:
    """z with T = e^{S z} within tolerance, or None."""
    xi = se3.log(T)
    part = slice(0, 3)
    if not angular_part(S).any():
        part = slice(3, 6)
    z = float(xi[part] @ S[part])
    for value in (z, -z):  # at half a turn the logarithm may come with either sign
        if still(se3.inverse(se3.exp(S * value)) @ T, tol):
            return value
    return None
