"""A chain at a configuration as a figure in print: skeleton, joint axes, base and tool frame."""

from __future__ import annotations

from typing import Any

import numpy as np

from ... import svg
from ...groups.arrays import Array
from ...groups.blocks import rotation_part, translation_part
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
    points = np.array([np.zeros(3), *translation_part(frames), translation_part(tool)])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    half = max(np.ptp(points, axis=0).max() / 2, 0.05)

    figure = svg.new_figure(*size, "plot of an arm")
    axes = figure.add_subplot(projection="3d")
    axes.plot(*points.T, color=svg.PALE, linewidth=4, solid_capstyle="round", zorder=1)
    for number, (frame, kind) in enumerate(zip(frames, chain.kinds, strict=True), 1):
        _draw_axis(axes, frame, kind, number, 0.3 * half)
    for frame, name in ((np.eye(4), chain.base), (tool, chain.tip)):
        _draw_frame(axes, frame, name, 0.35 * half)
    box = np.stack([middle - 1.1 * half, middle + 1.1 * half], axis=1)
    axes.set(xlim=box[0], ylim=box[1], zlim=box[2], xlabel="x, m", ylabel="y, m", zlabel="z, m")
    axes.set_box_aspect((1, 1, 1), zoom=0.85)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_pane_color("white")
        axis.get_major_locator().set_params(nbins=5)
    return figure


def _draw_axis(axes: Any, frame: Array, kind: str, number: int, half: float) -> None:
    """A joint: its axis on both sides of the frame's origin, an arrow along +z, and its symbol."""
    origin = translation_part(frame)
    z = frame[:3, 2]
    line = np.stack([origin - half * z, origin + half * z], axis=1)
    axes.plot(*line, _OF_KIND[kind], color=svg.INK, linewidth=0.8)
    axes.quiver(*line[:, 1], *(0.3 * half * z), color=svg.INK, linewidth=0.8, arrow_length_ratio=1)
    axes.plot(*origin[:, None], "o", color=svg.INK, markersize=3)
    axes.text(*(origin + 1.5 * half * z), f"$A_{{{number}}}$", fontsize=9, ha="center", va="center")


def _draw_frame(axes: Any, T: Array, name: str, length: float) -> None:
    """A frame: x, y and z as arrows, and its name."""
    for direction, color in zip(rotation_part(T).T, AXES_COLORS, strict=True):
        axes.quiver(*translation_part(T), *(length * direction), color=color, linewidth=1.6)
    axes.text(*translation_part(T), f"  {svg.label(name, 20)}", fontsize=8, va="top")
