"""Plane in which an arm moves: the one across all the axes that turn."""

from __future__ import annotations

import numpy as np

from ...errors import InputError, join_names
from ...groups import so3
from ...groups.arrays import Array
from ...groups.vectors import norms
from ...model.chain import Chain
from .joint_domain import JointDomain

PARALLEL = 1e-2
"""rad: axes within this are parallel, so that a calibrated arm has a plane, too."""


def plane_normal(chain: Chain, domain: JointDomain) -> Array:
    """Unit normal (3,), in the base frame, of the plane in which the arm moves.

    It is the mean direction of the turning axes or, where nothing turns, across two slides. Raises:
    InputError for an arm without such a plane.
    """
    moves = (chain.coupling[:, ~domain.locked] != 0).any(axis=1)
    names = np.array(chain.joint_names)[moves]
    q = np.nan_to_num(domain.locked_values)
    turns, slides = _directions(chain, q)[:, moves]
    turning = turns.any(axis=1)
    if not turning.any():
        _, sizes, V = np.linalg.svd(slides)
        if (sizes > PARALLEL).sum() == 2:
            return V[2]
        raise _no_plane("it has no turning axis, and its slides span no plane")
    first = turns[turning][0]
    opposite = turns @ first < 0
    turns[opposite] *= -1
    sines = norms(np.cross(turns, first))
    slanted = sines > PARALLEL
    if slanted.any():
        raise _no_plane(
            f"{join_names(names[slanted])} not parallel to {join_names(names[turning][:1])}"
        )
    normal = turns.sum(axis=0)
    return normal / np.linalg.norm(normal)


def _no_plane(fault: str) -> InputError:
    return InputError(
        "task 'planar': expected an arm that moves in a plane, all its turning axes parallel, "
        f"or two slides alone; {fault}"
    )


def _directions(chain: Chain, q: Array) -> Array:
    """Directions about which joints turn, and along which those that do not turn slide, at q
    (2, n, 3); else 0.
    """
    R = np.eye(3)
    directions = np.zeros((2, len(chain.screws), 3))
    for k, x in enumerate(chain.coupling @ q + chain.offset):
        turn, slide = chain.screws[k].reshape(2, 3) @ R.T
        directions[0, k] = turn
        if not turn.any():
            directions[1, k] = slide
        R = R @ so3.exp(chain.screws[k, :3] * x)
    return directions
