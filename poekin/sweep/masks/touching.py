"""Which pairs of links touch in configurations, by NumPy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...groups import se3
from ...groups.arrays import Array
from ...groups.vectors import norms, rotation_part, translation_part
from ...model.chain import Chain
from .spheres import MovedLink


def touching(
    chain: Chain,
    q: Array,
    links: Sequence[MovedLink],
    pairs: Sequence[tuple[int, int]],
) -> np.ndarray:
    """Whether each pair of links touches (N, pairs) in configurations q (N, m)."""
    poses = _products(chain, q)
    places = []
    for link in links:
        points = np.array(link.centres)
        T = poses[link.joints]
        turned = points @ np.swapaxes(rotation_part(T), -1, -2)
        places.append(turned + translation_part(T)[:, None])
    found = np.zeros((len(q), len(pairs)), bool)
    for k, (i, j) in enumerate(pairs):
        together = np.add.outer(links[i].radii, links[j].radii)
        # spheres of two links touch only where those do that hold all of them
        between = places[i][:, 0] - places[j][:, 0]
        near = norms(between) <= together[0, 0]
        between = places[i][near, 1:, None] - places[j][near, None, 1:]
        touching = norms(between) <= together[1:, 1:]
        found[near, k] = touching.any(axis=(1, 2))
    return found


def _products(chain: Chain, q: Array) -> list[Array]:
    """e^{A_1 x_1} ... e^{A_k x_k} (N, 4, 4) for k = 0 ... n, x = C q + c."""
    x = q @ chain.coupling.T + chain.offset
    poses = [np.tile(np.eye(4), (len(q), 1, 1))]
    for k, screw in enumerate(chain.screws):
        turned = se3.exp(x[:, k, None] * screw)
        poses.append(poses[-1] @ turned)
    return poses
