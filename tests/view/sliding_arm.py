"""A hand-made scene: an arm of two turning links and one that slides, its program by hand, and the
same kinematics in NumPy.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from poekin.solve.path.path_events import PathEvent
from poekin.view.nodes import Attachment, Cloud, Label, Node, Polyline, Triangles
from poekin.view.scene import (
    PageTable,
    Scene,
    SceneArm,
    SceneChoice,
    SceneMotion,
    SceneTip,
    Slider,
)

PROGRAM = """// A planar arm on a post, and a tool that slides down.
const chain = (q) => {
    const [a, b, d] = q;
    const c = Math.cos(a), s = Math.sin(a), e = Math.cos(a + b), f = Math.sin(a + b);
    const x = 0.6 * c, y = 0.6 * s, u = x + 0.4 * e, v = y + 0.4 * f;
    return { c, s, e, f, x, y, u, v, d };
};
const turned = (c, s, x, y, z) => [c, -s, 0, x, s, c, 0, y, 0, 0, 1, z, 0, 0, 0, 1];
export const links = (q) => {
    const { c, s, e, f, x, y, u, v, d } = chain(q);
    return Float64Array.of(
        ...turned(1, 0, 0, 0, 0), ...turned(c, s, 0, 0, 0.3), ...turned(e, f, x, y, 0.3),
        ...turned(e, f, u, v, 0.3 - d),
    );
};
export const tips = [
    { fk_jacobian: (q) => {
        const { e, f, x, y, u, v, d } = chain(q);
        return {
            T: Float64Array.from(turned(e, f, u, v, 0.3 - d)),
            J: Float64Array.of(0, 0, 0, 0, 0, 0, 1, 1, 0, -v, y - v, 0, u, u - x, 0, 0, 0, -1),
        };
    } },
    { fk_jacobian: (q) => {
        const { c, s, x, y } = chain(q);
        return {
            T: Float64Array.from(turned(c, s, 0, 0, 0.3)),
            J: Float64Array.of(0, 0, 1, 0, 0, 0),
        };
    } },
];
"""
Q = np.array([0.4, 0.9, 0.1])
LINKS = ("post", "upper arm", "forearm", "tool")


def poses(q: Any) -> np.ndarray:
    """Poses (4, 4, 4) of the links."""
    a, b, d = q

    def turned(angle: float, x: float, y: float, z: float) -> np.ndarray:
        c = np.cos(angle)
        s = np.sin(angle)
        return np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, z], [0, 0, 0, 1]])

    x, y = 0.6 * np.cos(a), 0.6 * np.sin(a)
    u, v = x + 0.4 * np.cos(a + b), y + 0.4 * np.sin(a + b)
    return np.stack(
        [
            np.eye(4),
            turned(a, 0, 0, 0.3),
            turned(a + b, x, y, 0.3),
            turned(a + b, u, v, 0.3 - d),
        ]
    )


def jacobian(q: Any) -> np.ndarray:
    """Hybrid Jacobian (6, 3) of the tool."""
    place = poses(q)[:, :3, 3]
    z = np.array([0.0, 0.0, 1.0])
    columns = [np.r_[z, np.cross(z, place[3] - place[k])] for k in (1, 2)]
    return np.stack([*columns, np.r_[np.zeros(3), -z]], axis=-1)


def arm(name: str = "sliding arm", **changes: Any) -> SceneArm:
    """The arm; changes: fields that are other than here."""
    fields: dict[str, Any] = {
        "name": name,
        "program": PROGRAM,
        "links": LINKS,
        "coordinates": (
            Slider("shoulder", "rad", -2.5, 2.5),
            Slider("elbow", "rad", -np.inf, np.inf),
            Slider("quill_with_a_very_long_name_out_of_a_file", "m", 0.0, 0.3),
        ),
        "tips": (SceneTip("tool", 3, (0, 1, 2), 1.0), SceneTip("upper arm", 1, (0,), 0.5)),
        "base": np.eye(4),
        "factors": np.eye(3),
        "shift": np.zeros(3),
    }
    return SceneArm(**(fields | changes))


def scene(name: str = "sliding arm", **changes: Any) -> Scene:
    """A scene with every kind of node and every part of a page."""
    fields: dict[str, Any] = {
        "title": name,
        "words": ("Two joints turn, one slides.", "Base to tool, 3 coordinates."),
        "arms": (arm(name),),
        "q": Q,
        "nodes": tuple(nodes(name)),
        "shown": frozenset({"meshes", "axes", "labels", "jacobian", "ellipsoids"}),
        "size": 1.3,
        "motion": SceneMotion(
            np.linspace([0, 0, 0], [1.5, 2, 0.3], 50),
            np.linspace(0, 4, 50),
            (PathEvent(10, 20, "singular", "Near a singularity."),),
        ),
        "choices": (
            SceneChoice(np.array([0.4, 0.9, 0.1]), "elbow left"),
            SceneChoice(np.array([1.1, -0.9, 0.1]), "elbow right"),
        ),
        "tables": (PageTable("Screw axes at q = 0", ("joint", "axis"), (("shoulder", "0 0 1"),)),),
    }
    return Scene(**(fields | changes))


def nodes(name: str) -> list[Node]:
    """Boxes for links, arrows for axes and columns, an octahedron for the unit sphere."""
    found: list[Node] = [
        box(Attachment("meshes", "first", 0, name=name), [0, 0, 0.13], [0.12, 0.12, 0.26]),
        box(Attachment("meshes", "first", 1, name="upper arm"), [0.3, 0, 0], [0.68, 0.1, 0.08]),
        box(Attachment("meshes", "first", 2, name="forearm"), [0.2, 0, 0.08], [0.48, 0.08, 0.07]),
        box(Attachment("meshes", "joint", 3, name="tool"), [0, 0, 0.1], [0.03, 0.03, 0.3]),
        Label(Attachment("labels", "joint", 1, name="shoulder"), np.array([0, 0, 0.1]), "shoulder"),
        Label(
            Attachment("labels", "joint", 2, name="elbow"),
            np.array([0, 0, 0.2]),
            f"elbow of {name}",
        ),
    ]
    for link in (1, 2):
        axis = np.array([[0, 0, -0.3], [0, 0, 0.4]])
        found.append(Polyline(Attachment("axes", "joint", link, name="axis"), axis, 0.008))
    for k in range(3):
        found.append(arrow(Attachment("jacobian", "linear", rule="column_v", index=k)))
        found.append(arrow(Attachment("jacobian", "angular", rule="column_w", index=k)))
    found.append(ball(Attachment("ellipsoids", "linear", rule="ellipsoid_v", opacity=0.35)))
    found.append(ball(Attachment("ellipsoids", "angular", rule="ellipsoid_w", opacity=0.35)))
    found.append(arrow(Attachment("singular", "differs", rule="singular")))
    for k in range(2):
        ghost = Attachment("solutions", "second", 2, choice=k, opacity=0.3)
        found.append(box(ghost, [0.2, 0, 0], [0.4, 0.06, 0.05]))
    turn = np.linspace(0, 1.5, 40)
    way = np.stack([np.cos(turn), np.sin(turn), 0 * turn + 0.3], axis=-1)
    found.append(Polyline(Attachment("path", "path"), way, 0.006))
    found.append(Cloud(Attachment("cloud", "linear"), way * 0.8, 0.02, turn))
    return found


def box(attachment: Attachment, middle: Any, sizes: Any) -> Triangles:
    """Box whose eight corners serve three faces each."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    halves = [[f[0], f[k], f[k + 1]] for f in faces for k in (1, 2)]
    flat = (np.array(middle) + 0.5 * corners * np.array(sizes))[np.ravel(halves)]
    return Triangles(attachment, flat, np.arange(36).reshape(12, 3))


def arrow(attachment: Attachment) -> Triangles:
    """Thin pyramid from the origin to (0, 0, 1)."""
    foot = 0.03 * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    faces: Any = [[k, (k + 1) % 4, 4] for k in range(4)]
    return Triangles(attachment, np.r_[foot, [[0, 0, 1]]], np.array(faces))


def ball(attachment: Attachment) -> Triangles:
    """Octahedron in the unit sphere."""
    corners = np.r_[np.eye(3), -np.eye(3)]
    faces = [[a, b, c] for a in (0, 3) for b in (1, 4) for c in (2, 5)]
    return Triangles(attachment, corners, np.array(faces))
