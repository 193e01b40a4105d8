"""Nodes: what a scene draws, each attached to a link of an arm, as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..groups.arrays import Array

Layer = Literal[
    "meshes", "skeleton", "axes", "frames", "labels", "jacobian", "ellipsoids", "singular", "path",
    "solutions", "differences", "cloud",
]  # fmt: skip
"""Nodes that a reader of the page shows or hides as one."""

Role = Literal[
    "first", "second", "joint", "linear", "angular", "differs", "path", "marked", "x", "y", "z"
]
"""Meaning of a node; its colour follows from it, unless it has one of its own."""

Rule = Literal["column_v", "column_w", "ellipsoid_v", "ellipsoid_w", "singular", "target", "tip"]
"""Rule by which the page moves a node that depends on the Jacobian or the tip's pose."""


@dataclass(frozen=True, slots=True)
class Attachment:
    """Attachment of a node: the link that it moves with, and what it stands for.

    Attributes
    ----------
    layer : Layer
        Layer that it belongs to.
    role : Role
        What it stands for.
    link : int or None
        Link of the arm whose frame its points are given in; None for the world's frame.
    arm : int
        Arm of the scene: 0, or 1 for the second of two models.
    name : str
        Words for it: the link, the joint.
    rule : Rule or None
        How the page moves it beyond its link, from unit geometry; None where the link says all.
    index : int
        Column of the Jacobian that the rule reads.
    choice : int or None
        Solution of the scene that it belongs to.
    color : int or None
        Colour 0xRRGGBB out of a file, in place of the role's.
    opacity : float
        1 for what cannot be looked through.
    """

    layer: Layer
    role: Role
    link: int | None = None
    arm: int = 0
    name: str = ""
    rule: Rule | None = None
    index: int = 0
    choice: int | None = None
    color: int | None = None
    opacity: float = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class Triangles:
    """Triangles: vertices (n, 3), m, and faces (k, 3), numbers of vertices."""

    attachment: Attachment
    vertices: Array
    faces: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class Polyline:
    """Line through points (n, 3), m; width in m."""

    attachment: Attachment
    points: Array
    width: float


@dataclass(frozen=True, slots=True, eq=False)
class Cloud:
    """Point cloud (n, 3), m; size in m; values (n,), by which points are coloured, or None."""

    attachment: Attachment
    points: Array
    size: float
    values: Array | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Label:
    """Words at a point (3,), m, that always face the reader."""

    attachment: Attachment
    point: Array
    text: str


Node = Triangles | Polyline | Cloud | Label
