"""Nodes that follow the Jacobian of a tip: its columns, ellipsoids and singular direction, and the
handle by which the tip is dragged.
"""

from __future__ import annotations

from ....analysis.dexterity.singularity import singularity
from ....errors import quote
from ....groups.arrays import Array
from ....model.chain import Chain
from ...nodes import Attachment, Layer, Node, Role, Rule, Triangles
from ...shapes import arrow, sphere

NEAR = 0.1
"""Distance of a singularity, rad or m to first order, within which a page speaks of it."""

UNIT_ARROW = arrow(1.0, 0.012, 0.03, 0.1)
HANDLE = 0.018
"""Radius of the handle as a share of the arm's size, where no joint's glyph is smaller."""


def jacobian_nodes(columns: int, radius: float) -> list[Node]:
    """Nodes for Jacobians of up to so many columns: unit geometry that the page scales and turns, and
    a handle of a radius, m.
    """
    nodes = [
        *(_node("jacobian", "linear", "column_v", k) for k in range(columns)),
        *(_node("jacobian", "angular", "column_w", k) for k in range(columns)),
        _node("ellipsoids", "linear", "ellipsoid_v"),
        _node("ellipsoids", "angular", "ellipsoid_w"),
        _node("singular", "marked", "singular"),
    ]
    handle = Attachment("frames", "marked", rule="target", name="target", opacity=0.6)
    return [*nodes, Triangles(handle, *sphere(radius, 16))]


def _node(layer: Layer, role: Role, rule: Rule, index: int = 0) -> Triangles:
    shape = sphere(1.0, 48) if layer == "ellipsoids" else UNIT_ARROW
    opacity = 0.35 if layer == "ellipsoids" else 1.0
    words = {
        "column_v": f"column {index + 1} of J, v",
        "column_w": f"column {index + 1} of J, ω",
        "ellipsoid_v": "linear manipulability",
        "ellipsoid_w": "angular manipulability",
        "singular": "singular direction",
    }
    attachment = Attachment(layer, role, rule=rule, index=index, name=words[rule], opacity=opacity)
    return Triangles(attachment, *shape)


def singular_words(chain: Chain, q: Array) -> tuple[str, ...]:
    """Sentence on the singularity that is at hand at q, if there is one."""
    found = singularity(chain, q)
    if not found.singular and found.distance > NEAR:
        return ()
    return (f"{quote(chain.tip)} where the page opens: {found.summary()}",)
