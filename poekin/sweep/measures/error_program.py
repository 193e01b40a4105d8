"""Straight-line program of an arm's pose and of how far errors of its screws move the tool."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...algebra import translation
from ...engine.straight_line.program import Angles, Program, program
from ...engine.straight_line.trace import Graph
from ...formulas.kinematics.screw_changes import (
    pose_changes,
    products,
    source_twist,
    squared_displacement,
    squared_rotation,
)
from ...formulas.lie import exponential
from ...groups.vectors import rotation_part, translation_part
from ...model.chain import Chain

Rows = Sequence[Sequence[float]]


class TracedProducts(NamedTuple):
    """Poses P_0 ... P_n, f as rows of scalars that record, as `formulas.kinematics.screw_changes` has
    them.
    """

    graph: Graph
    angles: Angles
    P: list[Any]


def traced_products(chain: Chain) -> TracedProducts:
    """Products of an arm's exponentials."""
    graph = Graph()
    angles = Angles(graph)
    n = len(chain.screws)
    exponentials: list[Any] = []
    joints = (chain.screws.tolist(), chain.coupling.tolist(), chain.offset.tolist())
    for S, row, shift in zip(*joints, strict=True):
        w = tuple(S[:3])
        sine: Any = 0.0
        cosine: Any = 1.0
        if any(w):
            sine, cosine = angles.sine_cosine(row, shift, 0)
        x = graph.linear([(k, factor) for k, factor in enumerate(row) if factor], shift)
        exponentials.append(exponential.joint(w, tuple(S[3:]), x, sine, cosine))
    R = rotation_part(chain.home).ravel()
    p = translation_part(chain.home)
    home = (*R.tolist(), *p.tolist())
    P: list[Any] = np.zeros((n + 2, 12)).tolist()
    products(exponentials, home, n, P)
    return TracedProducts(graph, angles, P)


def error_program(
    chain: Chain,
    sources: Sequence[Rows],
    is_rotation: bool,
    summed: bool,
) -> Program:
    """The pose's twelve numbers, and the squares of the tool's displacement (m²) or rotation (rad²) by
    each source, or their sum.
    """
    graph, angles, P = traced_products(chain)
    n = len(chain.screws)
    D: list[Any] = np.zeros((6, n + 1, 6)).tolist()
    pose_changes(P, n, D)
    p = translation(P[n + 1])
    squared = squared_rotation if is_rotation else squared_displacement
    squares = [squared(source_twist(D, p, source, n)) for source in sources]
    total: Any = 0.0
    for square in squares:
        total = total + square
    return program(graph, angles, [*P[n + 1], *([total] if summed else squares)])
