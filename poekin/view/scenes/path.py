"""Scene of a path that was followed: its poses, and the joints along it to play."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...errors import InputError
from ...groups.arrays import Array
from ...groups.vectors import translation_part
from ...model.robot import Robot
from ...solve.path.path_events import PathEvent
from ...solve.path.path_result import PathResult
from ..nodes import Label, Node, Polyline, Triangles
from ..scene import Scene, SceneMotion
from ..shapes import sphere
from .stage import Stage, evenly, make_stage
from .targets import pose_nodes

SECONDS = 10.0
"""Duration of a path without times of its own."""
ROWS = 2000
"""Configurations that the page plays: of longer paths every second one, or third, ..."""
FRAMES = 24
"""Target poses that are drawn."""


def path_scene(path: PathResult, robot: Robot | None = None) -> Scene:
    """Scene of a path that was followed.

    Parameters
    ----------
    path : PathResult
        Result of `follow`.
    robot : Robot, optional
        The robot of the arm, to be drawn in its place.

    Returns
    -------
    scene : Scene
        The arm at the first pose; the way of the tip, its near-singular stretches and those beyond
        a limit marked, a ball at each change of branch; some of the target poses as frames; the
        joints over time.

    Raises
    ------
    InputError
        If no pose of the path is made of finite numbers.
    """
    q = path.q
    known = np.flatnonzero(np.isfinite(q).all(axis=1))
    if not len(known):
        raise InputError("view: a path with at least one finite pose expected")
    stage = make_stage(path.chain, q[known[0]], robot)
    points = np.full((len(q), 3), np.nan)
    points[known] = translation_part(path.chain.fk(q[known]))
    targets = path.solution.target
    frames: list[Node] = []
    if targets is not None:
        thinned = known[evenly(len(known), FRAMES)]
        frames = pose_nodes(stage, targets[thinned], 0.05 * stage.size, "pose")
    motion = _motion(path, known, stage)
    scene = stage.with_result(
        f"Path of {path.chain.tip} in {path.chain.base}",
        path.summary().splitlines()[:1],  # the others stand at the marks
        [*_way(path, points, stage), *frames],
        "path",
        rows=motion.q,
    )
    return replace(scene, motion=motion)


def _way(path: PathResult, points: Array, stage: Stage) -> Iterator[Node]:
    """The way of the tip, without what is no number, and what is marked on it."""
    reached = np.isfinite(points).all(axis=1)
    width = 0.005 * stage.size
    way = stage.attachment("path", "path", "way of the tip")
    yield Polyline(way, points[reached], width)
    for event in path.events:
        attachment = stage.attachment("path", "marked", event.text)
        stretch = points[event.first : event.last + 1]
        stretch = stretch[np.isfinite(stretch).all(axis=1)]
        if not len(stretch):
            continue
        if len(stretch) > 1:
            yield Polyline(attachment, stretch, 2.5 * width)
        else:
            ball = sphere(2.5 * width, 16)
            yield Triangles(attachment, ball.vertices + stretch, ball.faces)
        if event.kind == "switch":
            words = f"branch changes before pose {event.first}"
            yield Label(attachment, stretch[0] + 0.03 * stage.size, words)


def _motion(path: PathResult, known: np.ndarray, stage: Stage) -> SceneMotion:
    """Joints over time, every k-th row and those beside a change of branch; marks by these rows."""
    switches = np.array(path.branch_switches, int)
    some = known[evenly(len(known), ROWS)]
    wanted = np.concatenate([some, switches, switches - 1])
    rows = np.intersect1d(wanted, known)
    times = path.times
    if times is None:
        times = np.linspace(0.0, SECONDS, len(path.q))
    marks = tuple(_by_rows(event, rows) for event in path.events)
    configurations = stage.configurations(path.q[rows])
    return SceneMotion(configurations, times[rows], marks)


def _by_rows(event: PathEvent, rows: np.ndarray) -> PathEvent:
    """An event from the first to the last of the rows that are played in it, one at least."""
    after_first = int(np.searchsorted(rows, event.first))
    after_last = int(np.searchsorted(rows, event.last, side="right"))
    first = min(after_first, len(rows) - 1)
    return replace(event, first=first, last=max(first, after_last - 1))
