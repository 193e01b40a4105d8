"""Scene of all solutions of a pose: one of them solid, the others as ghosts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...errors import InputError
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.robot import Robot
from ...solve.ik_all.all_solutions import AllSolutions
from ..nodes import Triangles
from ..scene import Scene, SceneChoice
from ..shapes import transformed
from .arm_parts.of_chain import chain_geometry
from .arm_parts.skeleton import glyph_radii, skeleton_nodes
from .stage import Stage, make_stage
from .targets import MOST, asked_of, configuration_words, target_nodes

GHOST = 0.3
"""Opacity of a solution that is not the present one."""


def solutions_scene(found: AllSolutions, robot: Robot | None = None) -> Scene:
    """Scene of every solution of a pose.

    Parameters
    ----------
    found : AllSolutions
        Result of `ik_all` for one target.
    robot : Robot, optional
        The robot of the arm, to be drawn in its place.

    Returns
    -------
    scene : Scene
        The arm at the first solution, each solution as a ghost and as a choice, and the target.

    Raises
    ------
    InputError
        If the result holds no chain, or is of several targets, or the target is not finite.
    """
    chain, target = asked_of(found)
    if found.counts.ndim:
        raise InputError(
            f"view: all solutions of one target expected, got those of {found.counts.size}"
        )
    if not np.isfinite(target).all():
        raise InputError(f"view: a finite target expected, got {found.summary()}")
    q = found.solutions[:MOST]
    stage = make_stage(chain, q[0] if len(q) else None, robot)
    rows = stage.configurations(q)
    words = [found.summary()]
    if len(q) < len(found.solutions):
        words.append(f"The first {MOST} of {len(found.solutions)} solutions are shown.")
    scene = stage.with_result(
        f"All solutions of {chain.tip} in {chain.base}",
        words,
        [*_ghosts(chain, q, stage), *target_nodes(stage, target)],
        "path",
        "solutions",
        rows=rows,
    )
    choices = tuple(SceneChoice(row, _words(found, chain, k)) for k, row in enumerate(rows))
    return replace(scene, choices=choices)


def _ghosts(chain: Chain, q: Array, stage: Stage) -> Iterator[Triangles]:
    """The skeleton at each solution, in the frame of the chain's base."""
    arm = chain_geometry(chain)
    zero = np.zeros(chain.dof)
    bones = skeleton_nodes(arm, glyph_radii(arm, zero, stage.size), stage.size)
    for k, row in enumerate(q):
        T = arm.poses(row)
        for node in bones:
            words = f"solution {k + 1}"
            ghost = stage.attachment("solutions", "second", words, choice=k, opacity=GHOST)
            vertices = transformed(node.vertices, T[node.attachment.link])
            yield Triangles(ghost, vertices, node.faces)


def _words(found: AllSolutions, chain: Chain, k: int) -> str:
    """Number of a solution, its coordinates, and for how many places it stands."""
    words = f"{k + 1}: {configuration_words(chain, found.solutions[k])}"
    places = int(found.n_revolutions[k])
    if places > 1:
        words += f" (one of {places} places, whole turns apart)"
    return words
