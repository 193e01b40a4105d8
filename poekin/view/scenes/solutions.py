"""Scene of all solutions of a pose: one of them solid, the others as ghosts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...errors import InputError, quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ...solve.ik_all.all_solutions import AllSolutions
from ..nodes import Hung, Node, Triangles
from ..scene import Scene, SceneChoice
from .arm import arm_scene
from .arm_parts.of_chain import chain_geometry
from .overlay import moved_node
from .targets import MOST, chain_kept, configuration_words, target_nodes

GHOST = 0.3
"""Opacity of a solution that is not the present one."""


def solutions_scene(found: AllSolutions) -> Scene:
    """Scene of every solution of a pose.

    Parameters
    ----------
    found : AllSolutions
        Result of `ik_all` for one target.

    Returns
    -------
    scene : Scene
        The arm at the first solution, each solution as a ghost and as a choice, and the target.

    Raises
    ------
    InputError
        If the result holds no chain, or is of several targets, or the target is not finite.
    """
    chain = chain_kept(found.chain, "AllSolutions")
    if found.count.ndim:
        raise InputError(
            f"view: all solutions of one target expected, got those of {found.count.size}"
        )
    target = np.reshape(found.target, (1, 4, 4))
    if not np.isfinite(target).all():
        raise InputError(f"view: a finite target expected, got {found.summary()}")
    q = found.solutions[:MOST]
    scene = arm_scene(chain, q=q[0] if len(q) else None, meshes=False)
    words = [found.summary()]
    if len(q) < len(found.solutions):
        words.append(f"The first {MOST} of {len(found.solutions)} solutions are shown.")
    return replace(
        scene,
        title=f"All solutions of {quote(chain.tip)} in {quote(chain.base)}",
        words=(*words, *scene.words),
        nodes=(*scene.nodes, *_ghosts(chain, q, scene), *target_nodes(target, scene.size)),
        shown=scene.shown | {"path", "solutions"},
        choices=tuple(SceneChoice(row, _words(found, chain, k)) for k, row in enumerate(q)),
    )


def _ghosts(chain: Chain, q: Array, scene: Scene) -> list[Node]:
    """The links of the skeleton at each solution, in the world."""
    bones = [
        node
        for node in scene.nodes
        if isinstance(node, Triangles) and node.hung.layer == "skeleton"
    ]
    poses = chain_geometry(chain).poses
    ghosts: list[Node] = []
    for k, row in enumerate(q):
        T = poses(row)
        for node in bones:
            role = "second" if node.hung.role == "first" else node.hung.role
            hung = Hung("solutions", role, name=f"solution {k + 1}", choice=k, opacity=GHOST)
            ghosts.append(moved_node(node, T[node.hung.link], hung))
    return ghosts


def _words(found: AllSolutions, chain: Chain, k: int) -> str:
    """Number of a solution, its coordinates, and for how many places it stands."""
    words = f"{k + 1}: {configuration_words(chain, found.solutions[k])}"
    places = int(found.n_revolutions[k])
    if places > 1:
        words += f" (one of {places} places, whole turns apart)"
    return words
