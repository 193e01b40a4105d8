"""The result of `compare`: two models of one arm, joint by joint."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np

from ...groups.arrays import Array


@dataclass(frozen=True)
class JointComparison:
    """One joint of model a beside the one of model b, under the alignment found.

    Attributes
    ----------
    number: of the joint, from 1. name_a, name_b, kind_a, kind_b: what the models call it, and what
    it is.
    angle: between the axes, deg. normal: length of their common normal, mm; of axes parallel within
        tolerance, their distance. shift: distance of b's axis from the point of a's axis nearest to
        the arm's middle, mm: what normal hides where two axes cross far from the arm. None of
        prismatic joints, which have no place.
    zero_offset: where b's joint stands when a's is at 0, deg (mm of a prismatic joint). reversed: the sign of
    q is flipped. limits: b's lower and upper limit, in a's zero and direction, less a's; deg or
    mm; 0 where both are unlimited. axis_differs, zero_differs: beyond tolerance (or another kind or
    pitch).
    follows_a, follows_b: how the joint follows others of its model, in words; "" where it moves by
    itself. coupling_differs: whether they do so differently.
    """

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
    follows_a: str = ""
    follows_b: str = ""
    coupling_differs: bool = False

    @property
    def differs(self) -> bool:
        """Whether anything but limits and name differs: axis, kind, zero position, direction, or
        what it follows.
        """
        return self.axis_differs or self.zero_differs or self.reversed or self.coupling_differs

    @property
    def unit(self) -> str:
        """Unit of zero and limits: "deg", or "mm" of a prismatic joint."""
        return "mm" if self.kind_a == "prismatic" else "deg"


@dataclass(frozen=True)
class PoseErrors:
    """Differences of two models' poses over random configurations: worst and mean, mm and deg."""

    worst_mm: float
    mean_mm: float
    worst_deg: float
    mean_deg: float


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two models of one arm: f_a(x) = base f_b(direction x + zero) tool, but for the axes that
    differ.

    Attributes
    ----------
    equal: whether the models agree within tolerance, up to what is a free choice (base frame, tool
        frame, zero positions, joint directions); of a strict comparison, with those too. Limits and
        names never decide it.
    verdict: the same in words. joints: one `JointComparison` each. base (4, 4): pose of b's base
    frame in a's; tool
        (4, 4): pose of a's tool frame in b's; m; None where the models could not be matched.
    before, after: `PoseErrors` at the same joint values, as the models stand and under the
    alignment. strict. alternatives: other readings that say the same. unmatched_joints: which model ("a" or "b")
    has joints that the other has not, and
        their names, one or two; None where both have as many, or no joints can be dropped so that
        the rest agree.
    tol_mm, tol_deg, samples, seed: as asked. length_ratio: b's lengths by a's, 1000 or 0.001 where
        one model is in millimetres and the other in metres, then all but `before` is of both in one
        unit; 1 otherwise.
    """

    equal: bool
    verdict: str
    joints: tuple[JointComparison, ...]
    base: Array | None
    tool: Array | None
    before: PoseErrors | None
    after: PoseErrors | None
    alternatives: tuple[str, ...]
    unmatched_joints: tuple[str, ...] | None
    strict: bool
    tol_mm: float
    tol_deg: float
    samples: int
    seed: int
    length_ratio: float = 1.0

    @property
    def differing(self) -> tuple[JointComparison, ...]:
        """The joints of which axis, kind, zero position, direction or coupling differ."""
        return tuple(joint for joint in self.joints if joint.differs)

    def as_dict(self) -> dict[str, object]:
        """Everything as plain dicts, lists, strings and numbers; a number that is not finite is
        None.
        """
        plain = {f.name: getattr(self, f.name) for f in fields(self)}
        plain["joints"] = [asdict(j) | {"differs": j.differs, "unit": j.unit} for j in self.joints]
        for name in ("before", "after"):
            if plain[name] is not None:
                plain[name] = asdict(plain[name])
        return {name: _plain(value) for name, value in plain.items()}

    def to_json(self) -> str:
        """`as_dict` as JSON text."""
        return json.dumps(self.as_dict(), indent=2, allow_nan=False)

    def __str__(self) -> str:
        return self.verdict


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, dict):
        return {name: _plain(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
