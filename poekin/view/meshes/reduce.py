"""Meshes with fewer triangles: vertices that share a cell of a grid become one.

A vertex moves by less than the diagonal of a cell. Source: Rossignac, Borrel, "Multi-resolution 3D
approximations for rendering complex scenes" (1993).
"""

from __future__ import annotations

import numpy as np

from .load import proper

FIRST = 1000.0
"""Cells along the longest edge of a mesh's box that are tried first."""


def limit_for(counts: list[int], budget: int) -> int:
    """Triangles that each mesh may keep so that all have `budget`; small ones keep their own."""
    left = budget
    for done, count in enumerate(sorted(counts)):
        share = left // (len(counts) - done)
        if count > share:
            return share
        left -= count
    return max(counts, default=0)


def reduced(
    vertices: np.ndarray,
    faces: np.ndarray,
    limit: int,
) -> tuple[np.ndarray, np.ndarray, float]:
    """Vertices and faces, at most `limit` of these, and the length [m] of a cell's diagonal.

    A mesh that is small enough comes back as it is, with 0. The number of triangles grows with the
    square of the number of cells along the longest edge of the box, which is sought by that.
    """
    if len(faces) <= limit:
        return vertices, faces, 0.0
    low = vertices.min(axis=0)
    longest = float((vertices.max(axis=0) - low).max())
    cells = FIRST
    while True:
        found = _clustered(vertices, faces, low, longest / cells)
        count = len(found[1])
        if count <= limit:
            return *found, longest / cells * 3**0.5
        cells *= 0.95 * (limit / count) ** 0.5


def _clustered(
    vertices: np.ndarray,
    faces: np.ndarray,
    low: np.ndarray,
    cell: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces, with the mean of all vertices of a cell in its place."""
    keys = _number(((vertices - low) / cell).astype(np.int64))  # none is negative
    _, place, count = np.unique(keys, return_inverse=True, return_counts=True)
    means = np.stack(
        [np.bincount(place, weights=column) / count for column in vertices.T.astype(float)],
        axis=1,
    )
    kept = proper(place[faces])
    turned = np.argmin(kept, axis=1)[:, None] + np.arange(3)  # each face from its smallest vertex
    kept = np.take_along_axis(kept, turned % 3, axis=1)
    _, first = np.unique(_number(kept.astype(np.int64)), return_index=True)
    return means.astype(np.float32), kept[first]


def _number(rows: np.ndarray) -> np.ndarray:
    """A number for each row of three, equal for equal rows alone: they are below 2^21."""
    i, j, k = rows.T
    return (i << 42) + (j << 21) + k
