"""Effects at the tool: how far the difference of one joint, or of a frame, moves it by itself."""

from __future__ import annotations

from ....groups.arrays import Array
from ....model.chain import Chain
from ..alignment.hypotheses import Hypothesis
from ..reached import pose_differences


def joint_effects(
    a: Chain,
    b: Chain,
    reading: Hypothesis,
    x: Array,
) -> list[float]:
    """Largest distance (m) between the tool of a at joint values x (m, n), and that of a with one
    joint as b has it; one number a joint.

    A joint that is of another kind has no effect that could be told: NaN.
    """
    poses = a.fk(x)
    found = []
    for k, changes in enumerate(reading.changes.T):
        if a.kinds[k] != b.kinds[k]:
            found.append(float("nan"))
            continue
        if not changes.any():
            found.append(0.0)
            continue
        arm = a
        if reading.moved[k]:
            screws = a.screws.copy()
            pitches = a.pitches.copy()
            screws[k] = reading.directions[k] * reading.axes[k]
            pitches[k] = b.pitches[k]
            arm = Chain.from_space(screws, a.home, pitches=pitches)
        values = x.copy()
        values[:, k] = reading.directions[k] * (x[:, k] - reading.zeros[k])
        distance, _ = pose_differences(poses, arm.fk(values))
        found.append(float(distance.max()))
    return found


def base_effect(T: Array, poses: Array) -> float:
    """Largest distance (m) by which a moved base T (4, 4) moves the tool at its poses (m, 4, 4)."""
    distance, _ = pose_differences(poses, T @ poses)
    return float(distance.max())
