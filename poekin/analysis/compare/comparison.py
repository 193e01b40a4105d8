"""The result of `compare`: two models of one arm, joint by joint."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Literal

from ...groups.arrays import Array
from ...model.chain import Chain
from ...results import Result
from ..amounts import Unit, amount, joint_unit
from .alignment.diagnosis import AlignedTo

Outcome = Literal["same", "conventions", "differ"]
NOISE = 1e-11
"""Lengths (m) and angles (rad) below it are the rounding of poses, and no differences."""


@dataclass(frozen=True)
class JointComparison(Result):
    """One joint of model a beside the joint of model b, under the alignment found.

    Attributes
    ----------
    number : int
        Number of the joint in model a, from 1.
    name_a, name_b : str
        Names of the joint in the two models.
    kind_a, kind_b : str
        Kinds of the joint: "revolute", "prismatic" or "helical".
    angle : float
        Angle between the axes, rad.
    normal : float or None
        Length of the common normal of the axes, m; of axes parallel within tolerance, their
        distance. None of a prismatic joint, whose axis has no place.
    shift : float or None
        Distance of b's axis from the point of a's axis nearest to the arm's middle, m: what
        `normal` hides where two axes cross far from the arm. None as `normal`.
    zero_offset : float
        Position of b's joint where a's is at 0, rad, or m of a prismatic joint.
    reversed : bool
        Whether the sign of q is flipped.
    limits : tuple of float
        Lower and upper limit of b, in a's zero and direction, less a's, rad or m; 0 where both are
        unlimited, NaN where one joint slides and the other turns.
    axis_differs, zero_differs : bool
        Whether axis (or kind, or pitch) and zero position differ by more than the tolerances.
    follows_a, follows_b : str
        How the joint follows others of its model, as text; empty where it moves by itself.
    coupling_differs : bool
        Whether it follows others differently.
    effect : float
        Largest distance (m) by which axis, zero and direction of this joint alone move the tool,
        over the configurations; NaN where the kinds differ.
    limit_numbers : tuple of float
        Lower and upper limit of b less a's, as the numbers stand, rad or m.
    """

    derived: ClassVar = ("differs", "unit")

    number: int
    name_a: str
    name_b: str
    kind_a: str
    kind_b: str
    angle: float
    normal: float | None
    shift: float | None
    zero_offset: float
    reversed: bool
    limits: tuple[float, float]
    axis_differs: bool
    zero_differs: bool
    follows_a: str
    follows_b: str
    coupling_differs: bool
    effect: float
    limit_numbers: tuple[float, float]

    @property
    def differs(self) -> bool:
        """Whether axis, kind, zero position, direction or coupling differ; limits and names may."""
        return self.axis_differs or self.zero_differs or self.reversed or self.coupling_differs

    @property
    def unit(self) -> Unit:
        """Unit of `zero_offset` and `limits`: "rad", or "m" where b's joint is prismatic."""
        return joint_unit(self.kind_b)

    def summary(self) -> str:
        """Differences of axis, zero position and direction, in mm and degrees.

        Returns
        -------
        text : str
            Line such as "joint 4 (elbow): axes 0.1°, 3.2 mm apart at the arm, zero offset 0°".
        """
        found = [f"axes {_seen(self.angle, 'rad')}"]
        if self.shift is not None:
            found.append(f"{_seen(self.shift, 'm')} apart at the arm")
        found.append(f"zero offset {_seen(self.zero_offset, self.unit)}")
        if self.reversed:
            found.append("sign of q flipped")
        return f"joint {self.number} ({self.name_a}): {', '.join(found)}"


@dataclass(frozen=True)
class PoseDifferences(Result):
    """Differences of two models' poses over random configurations.

    Attributes
    ----------
    worst_position, mean_position : float
        Distance of the tool's origins, m.
    worst_rotation, mean_rotation : float
        Angle of the rotation between the tool frames, rad.
    """

    worst_position: float
    mean_position: float
    worst_rotation: float
    mean_rotation: float

    def summary(self) -> str:
        """Text with the worst and the mean difference, in mm and degrees."""
        worst = f"{_seen(self.worst_position, 'm', 3)}, {_seen(self.worst_rotation, 'rad', 3)}"
        mean = f"{_seen(self.mean_position, 'm', 3)}, {_seen(self.mean_rotation, 'rad', 3)}"
        return f"worst {worst}; mean {mean}"


@dataclass(frozen=True, eq=False, kw_only=True)
class Comparison(Result):
    """Two models of one arm, compared joint by joint; the result of `compare`.

    But for the axes that differ, f_a(x) = base f_b(direction x + zero) tool.

    Attributes
    ----------
    outcome : {"same", "conventions", "differ"}
        Whether the models are the same in all that may not differ (`same`), are the same arm in
        other conventions, or are other arms or have other limits.
    verdict : str
        What differs and what was aligned, in one sentence, with mm and degrees.
    findings : tuple of str
        Clauses of the verdict: one for each joint, frame and mistake.
    same_arm : bool
        Whether the models agree within tolerance, up to what is a free choice (base frame, tool
        frame, zero positions, joint directions). Limits and names never decide it.
    joints : tuple of JointComparison
        The joints, from base to tip.
    base, tool : (4, 4) ndarray or None
        Pose of b's base frame in a's, and of a's tool frame in b's, m; None where the models could
        not be matched, and `tool` of a strict comparison.
    before, after : PoseDifferences or None
        Pose errors at the same coordinates, as the models stand, and at the same joint values under
        the alignment.
    alternatives : tuple of str
        Other explanations of the same difference.
    unmatched_joints : tuple of str or None
        Model ("a" or "b") that has joints more, and the names of these; None where both have as
        many, or no joints can be dropped so that the rest agree.
    same : tuple of str
        Conventions that may not differ.
    aligned_to : {"agreeing axes", "all axes", "nothing"}
        What base and tool were aligned to: the axes that agree; all of them, by robust least
        squares, where fewer than half agree; or nothing, where neither halves the pose errors, and in
        a strict comparison.
    mistake : str
        Mistake in a whole file that explains the difference ("millimetres", "degrees",
        "mirrored"), or empty.
    strict : bool
        Whether the joints stand as they are, not aligned.
    tol_position, tol_rotation : float
        Tolerances, m and rad.
    samples, seed : int
        Number of random configurations for the pose errors, and their seed.
    length_ratio : float
        Lengths of b by lengths of a: 1000 or 0.001 where one model is in millimetres and the other
        in metres, 1 otherwise. All but `before` is then of both in one unit.
    a, b : Chain
        The models as they were compared, in one unit and of one hand; b with every joint its own
        coordinate, 0 where b's coordinates are, and without the joints that can be dropped.
    """

    derived: ClassVar = ("equal",)
    left_out: ClassVar = ("a", "b")

    outcome: Outcome
    verdict: str
    findings: tuple[str, ...] = ()
    same_arm: bool = False
    joints: tuple[JointComparison, ...] = ()
    base: Array | None = None
    tool: Array | None = None
    before: PoseDifferences | None = None
    after: PoseDifferences | None = None
    alternatives: tuple[str, ...] = ()
    unmatched_joints: tuple[str, ...] | None = None
    same: tuple[str, ...]
    aligned_to: AlignedTo = "agreeing axes"
    mistake: str = ""
    strict: bool
    tol_position: float
    tol_rotation: float
    samples: int
    seed: int
    length_ratio: float = 1.0
    a: Chain = field(repr=False)
    b: Chain = field(repr=False)

    @property
    def equal(self) -> bool:
        """Whether the outcome is "same"."""
        return self.outcome == "same"

    @property
    def differing(self) -> tuple[JointComparison, ...]:
        """The joints of which axis, kind, zero position, direction or coupling differ."""
        return tuple(joint for joint in self.joints if joint.differs)

    def summary(self) -> str:
        """Pose errors in mm and degrees, other explanations, what differs, and last the outcome.

        Returns
        -------
        text : str
            One line each: one a joint, and one a frame.
        """
        errors = {"as they stand": self.before, "aligned": self.after}
        lines = [
            f"Pose error {title}: {found.summary()}" for title, found in errors.items() if found
        ]
        lines += [f"Equivalent: {text}" for text in self.alternatives]
        lines += [_capital(text) for text in self.findings]
        outcome, *_ = self.verdict.partition("; ")
        lines.append(_capital(outcome))
        return "\n".join(lines)


def _seen(value: float, unit: Unit, digits: int = 4) -> str:
    """A length or an angle for reading, 0 where it is rounding alone."""
    return amount(value * (abs(value) >= NOISE) + 0.0, unit, digits)


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]
