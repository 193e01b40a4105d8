"""Drawings of screws as SVG: what is drawn is computed with poekin, and seen through one oblique
projection.

Run it to look at them: python -m tools.docs_drawings DIRECTORY
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import poekin as pk

INK, AXIS, MOVED, VELOCITY, FRAME = (
    "#333333",
    "#c0392b",
    "#2471a3",
    "#7d3c98",
    ("#c0392b", "#1e8449", "#2471a3"),
)

# The camera: looks down on the x-y plane from in front, x to the right; distances along its own z
# are not drawn.
VIEW = pk.so3.exp([-np.deg2rad(62), 0, 0]) @ pk.so3.exp([0, 0, -np.deg2rad(28)])


class Drawing:
    """An SVG of points and lines in space; one metre is `scale` pixels."""

    def __init__(
        self, width: int, height: int, origin: tuple[float, float], scale: float, title: str
    ):
        self.scale, self.origin = scale, np.array(origin, dtype=float)
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
            f'height="{height}" role="img" font-family="sans-serif" font-size="16">',
            f"<title>{title}</title>",
            f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
        ]

    def flat(self, points) -> np.ndarray:
        """Pixels (..., 2) of points (..., 3) in space."""
        seen = np.asarray(points, dtype=float) @ VIEW.T
        return self.origin + self.scale * seen[..., :2] * [1, -1]

    def line(self, points, colour: str = INK, width: float = 1.5, dash: str = "") -> None:
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in self.flat(points))
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(
            f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}" '
            f'stroke-linecap="round" stroke-linejoin="round"{dashed}/>'
        )

    def arrow(self, tail, head, colour: str = INK, width: float = 2) -> None:
        self.line([tail, head], colour, width)
        a, b = self.flat([tail, head])
        along = (b - a) / max(np.hypot(*(b - a)), 1e-9)
        across = np.array([-along[1], along[0]])
        corners = (b + 2 * along, b - 9 * along + 4 * across, b - 9 * along - 4 * across)
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)
        self.parts.append(f'<polygon points="{path}" fill="{colour}"/>')

    def dot(self, point, colour: str = INK, radius: float = 3.5) -> None:
        x, y = self.flat(point)
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{colour}"/>')

    def text(
        self,
        point,
        words: str,
        dx: float = 8,
        dy: float = 4,
        colour: str = INK,
        anchor: str = "start",
    ) -> None:
        x, y = np.add(self.flat(point), (dx, dy))
        self.parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}" paint-order="stroke" '
            f'stroke="#ffffff" stroke-width="3">{words}</text>'
        )

    def frame(self, T: np.ndarray, size: float, name: str, dx: float = -8, dy: float = 18) -> None:
        o = T[:3, 3]
        for axis, colour in zip(T[:3, :3].T, FRAME, strict=True):
            self.arrow(o, o + size * axis, colour, 1.8)
        self.text(o, name, dx, dy, anchor="end" if dx < 0 else "start")

    def done(self) -> str:
        return "\n".join([*self.parts, "</svg>"]) + "\n"


def screws() -> str:
    """A revolute, a helical and a prismatic joint: what the same point does when q runs."""
    drawing = Drawing(600, 256, (88, 166), 100, "Three screws and the paths of a point")
    z = np.array([0.0, 0.0, 1.0])
    start = np.array([0.65, -0.15, 0.0, 1.0])
    kinds = (
        ("revolute", "(ω; −ω × p)", lambda p: pk.screw.revolute(z, p), np.linspace(0, 5.2, 90)),
        (
            "helical",
            "(ω; −ω × p + hω)",
            lambda p: pk.screw.helical(z, p, 0.09),
            np.linspace(0, 11.5, 180),
        ),
        ("prismatic", "(0; v)", lambda p: pk.screw.prismatic(z), np.linspace(0, 1.2, 20)),
    )
    for number, (name, numbers, screw, q) in enumerate(kinds):
        # Beside each other on the page: along the direction that the projection shows as
        # horizontal.
        p = 2.05 * number * VIEW[0]
        A = screw(p)
        path = (pk.se3.exp(q[:, None] * A) @ np.add(start, [*p, 0]))[:, :3]
        prismatic = number == 2
        drawing.line([p - 0.35 * z, p + 1.65 * z], AXIS, 1.5, "6 5" if prismatic else "")
        drawing.arrow(p + 1.35 * z, p + 1.65 * z, AXIS)
        drawing.text(p + 1.65 * z, "v" if prismatic else "ω", 8, 2, AXIS)
        drawing.line(path, MOVED, 2.2)
        drawing.arrow(path[-2], path[-1], MOVED)
        if not prismatic:
            drawing.line([p, path[0]], INK, 1, "2 4")
            drawing.dot(p, AXIS)
            drawing.text(p, "p", -10, 14, AXIS, "end")
        drawing.dot(path[0], MOVED)
        drawing.text(p - 0.35 * z, name, 0, 26, INK, "middle")
        drawing.text(p - 0.35 * z, numbers, 0, 46, INK, "middle")
    return drawing.done()


def arm() -> str:
    """Example 1 of the paper: the axes at home, and the arm at q with the axes carried along."""
    L1, L2 = 0.9, 0.65
    y, z = [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]
    home = np.eye(4)
    home[0, 3] = L1 + L2
    chain = pk.Chain.from_space(
        [
            pk.screw.revolute(z, [0, 0, 0]),
            pk.screw.revolute(y, [0, 0, 0]),
            pk.screw.revolute(y, [L1, 0, 0]),
        ],
        home,
    )
    drawing = Drawing(
        600, 300, (80, 172), 230, "Example 1 of the paper: three screws and the home pose"
    )
    joints = np.array([[0, 0, 0], [L1, 0, 0], [L1 + L2, 0, 0]])
    drawing.line(joints, "#aaaaaa", 7)
    for screw, name, dx, dy in zip(
        chain.screws, ("A₁", "A₂", "A₃"), (8, -6, -6), (4, 18, 18), strict=True
    ):
        axis = pk.screw.axis_of(screw)
        point = axis.point if axis.point is not None else np.zeros(3)
        drawing.line([point - 0.3 * axis.direction, point + 0.55 * axis.direction], AXIS, 1.3)
        drawing.arrow(point + 0.4 * axis.direction, point + 0.55 * axis.direction, AXIS)
        drawing.text(point + 0.55 * axis.direction, name, dx, dy, AXIS)
    drawing.frame(home, 0.22, "M", 4, 26)

    q = np.array([0.35, 0.75, -0.95])
    J = chain.jacobian(q, frame="space")
    bent = np.array([*chain.joint_poses(q)[1:, :3, 3], chain.fk(q)[:3, 3]])
    bent[0] = 0
    bent[1] = (
        pk.se3.exp(q[0] * chain.screws[0]) @ pk.se3.exp(q[1] * chain.screws[1]) @ [L1, 0, 0, 1]
    )[:3]
    drawing.line(bent, "#7fb3d5", 7)
    axis = pk.screw.axis_of(J[:, 2])
    drawing.arrow(bent[1] - 0.25 * axis.direction, bent[1] + 0.4 * axis.direction, MOVED, 1.5)
    drawing.text(bent[1] - 0.25 * axis.direction, "A₃, carried along by q₁ and q₂", 8, -2, MOVED)
    drawing.frame(chain.fk(q), 0.22, "f(q)", 12, 28)
    drawing.frame(np.eye(4), 0.22, "s", -10, 16)
    for point in (*joints[:2], bent[1]):
        drawing.dot(point)
    return drawing.done()


def frames() -> str:
    """One motion of a tool, and the point whose velocity each frame's v is."""
    drawing = Drawing(680, 250, (40, 180), 205, "Space, body and hybrid: which point v belongs to")
    T = pk.se3.exp([0, 0, 0, 1.75, 0.35, 0.35]) @ pk.se3.exp([0.35, 0, 0.75, 0, 0, 0])
    screw = pk.screw.revolute([0, 0, 1], [0.75, 0.3, 0])  # the tool turns about this line
    drawing.line([[0.75, 0.3, -0.25], [0.75, 0.3, 0.85]], AXIS, 1.5)
    drawing.arrow([0.75, 0.3, 0.7], [0.75, 0.3, 0.85], AXIS)
    drawing.text([0.75, 0.3, 0.85], "ω", 8, 2, AXIS)
    drawing.frame(np.eye(4), 0.3, "s", -10, 16)
    drawing.frame(T, 0.3, "b", 20, 24)
    p = T[:3, 3]
    v_s, v_b = screw[3:], screw[3:] + np.cross(screw[:3], p)
    for point, v, name, dx, dy in (
        (np.zeros(3), v_s, "v of “space”", 6, 18),
        (p, v_b, "v of “body” and “hybrid”", 8, -6),
    ):
        radius = np.linspace(0, 1, 2)[:, None]
        drawing.line(
            [0.75, 0.3, point[2]] + radius * (point - [0.75, 0.3, point[2]]), INK, 1, "2 4"
        )
        drawing.arrow(point, point + 0.45 * v, VELOCITY, 2.8)
        drawing.text(point + 0.45 * v, name, dx, dy, VELOCITY)
        drawing.dot(point)
    return drawing.done()


def drawings() -> dict[str, str]:
    """File name and text of each drawing."""
    return {"screws.svg": screws(), "arm.svg": arm(), "frames.svg": frames()}


if __name__ == "__main__":
    for file, content in drawings().items():
        (Path(sys.argv[1]) / file).write_text(content, encoding="utf-8")
