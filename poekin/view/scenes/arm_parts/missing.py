"""Links whose shapes cannot be drawn: bones in their place, and sentences that say why."""

from __future__ import annotations

from collections.abc import Sequence

from ....formats.visuals.visual import LeftOut
from ...nodes import Triangles
from .geometry import ArmGeometry
from .skeleton import bone_nodes

THICK = 0.02
"""Radius of a bone in place of a mesh, as a share of the arm's size."""
MOST = 6
"""Shapes that a sentence names."""


def stand_ins(
    arm: ArmGeometry,
    left_out: Sequence[LeftOut],
    bodies: Sequence[Triangles],
    size: float,
) -> list[Triangles]:
    """Bones of the links of which nothing is drawn though they have a shape."""
    drawn = {body.attachment.link for body in bodies}
    lost = {arm.links.index(left.link) for left in left_out if left.link}
    return bone_nodes(arm, dict.fromkeys(lost - drawn, THICK * size), size, "meshes")


def left_out_words(left_out: Sequence[LeftOut]) -> list[str]:
    """A sentence for each reason, with the shapes that are not drawn for it."""
    reasons: dict[str, list[str]] = {}
    words = []
    for left in left_out:
        if left.link:
            reasons.setdefault(left.why, []).append(left.what)
        else:  # of the whole robot
            words.append(f"{left.what}: {left.why}.")
    for why, shapes in reasons.items():
        names = list(dict.fromkeys(shapes))
        more = f" and {len(names) - MOST} more" if len(names) > MOST else ""
        words.append(f"Not drawn: {', '.join(names[:MOST])}{more}: {why}.")
    return words
