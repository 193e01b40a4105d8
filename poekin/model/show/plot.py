"""A chain at a configuration as a figure in print: skeleton, joint axes, base and tool frame."""

from __future__ import annotations

from typing import Any

import numpy as np

from ... import svg
from ...groups.arrays import Array
from ...groups.vectors import rotation_part, translation_part
from ..chain_data import ChainData
from ..coordinates import one_configuration
from ..kinematics import pose_jacobian

AXES_COLORS = ("#D55E00", "#009E73", "#0072B2")
"""Colours of x, y and z that the colour-blind can tell apart."""
_OF_KIND = {"revolute": "-.", "prismatic": ":", "helical": "--"}


def plot(chain: ChainData, q: Any, size: tuple[float, float]) -> Any:
    """Figure of Matplotlib; q: configuration (m,) or None for zero."""
    values = np.zeros(chain.dof)
    if q is not None:
        values = one_configuration(q, chain.q_names)
    frames = pose_jacobian.joint_poses(chain, values)
    tool = pose_jacobian.fk(chain, values)
    origins = [np.zeros(3), *translation_part(frames), translation_part(tool)]
    points = np.array(origins)
    low = points.min(axis=0)
    high = points.max(axis=0)
    middle = (low + high) / 2
    half = max((high - low).max() / 2, 0.05)

    figure = svg.new_figure(*size, "plot of an arm")
    axes = figure.add_subplot(projection="3d")
    axes.plot(
        *points.T,
        color=svg.PALE,
        linewidth=4,
        solid_capstyle="round",
        zorder=1,
    )
    joints = zip(frames, chain.kinds, strict=True)
    for number, (frame, kind) in enumerate(joints, 1):
        _draw_axis(axes, frame, kind, number, 0.3 * half)
    _draw_frame(axes, np.eye(4), chain.base, 0.35 * half)
    _draw_frame(axes, tool, chain.tip, 0.35 * half)
    box = zip(middle - 1.1 * half, middle + 1.1 * half, strict=True)
    for name, limits in zip("xyz", box, strict=True):
        axes.set(**{f"{name}lim": limits, f"{name}label": f"{name}, m"})
    axes.set_box_aspect((1, 1, 1), zoom=0.85)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_pane_color("white")
        axis.get_major_locator().set_params(nbins=5)
    return figure


def _draw_axis(axes: Any, frame: Array, kind: str, number: int, half: float) -> None:
    """A joint: its axis on both sides of the frame's origin, an arrow along +z, and its symbol."""
    origin = translation_part(frame)
    z = frame[:3, 2]
    start = origin - half * z
    end = origin + half * z
    ink = {"color": svg.INK, "linewidth": 0.8}
    axes.plot(*np.stack([start, end], axis=1), _OF_KIND[kind], **ink)
    axes.quiver(*end, *(0.3 * half * z), arrow_length_ratio=1, **ink)
    axes.plot(*origin[:, None], "o", color=svg.INK, markersize=3)
    place = origin + 1.5 * half * z
    axes.text(*place, f"$A_{{{number}}}$", fontsize=9, ha="center", va="center")


def _draw_frame(axes: Any, T: Array, name: str, length: float) -> None:
    """A frame: x, y and z as arrows, and its name."""
    origin = translation_part(T)
    directions = length * rotation_part(T).T
    for direction, color in zip(directions, AXES_COLORS, strict=True):
        axes.quiver(*origin, *direction, color=color, linewidth=1.6)
    label = svg.label(name, 20)
    axes.text(*origin, f"  {label}", fontsize=8, va="top")
