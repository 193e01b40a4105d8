"""The formula of a tree's links run on scalars that record: one straight-line program of all poses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...algebra import IDENTITY
from ...formulas.kinematics import forward
from .program import Angles, Program, program
from .specialise import Pose
from .trace import Graph


@dataclass(frozen=True)
class TracedTree:
    """Links as `forward.child` takes them: joint j hangs link j + 1 on link parents[j] <= j.

    `origins` (J) are the joints' constant poses and `screws` (J) their (omega; v) in their own
    frames, zeros where a joint does not move. Joint j is at x_j, the sum of factors[j][k] * q_k over
    the m coordinates, plus shifts[j].
    """

    parents: Sequence[int]
    origins: Sequence[Pose]
    screws: Sequence[Sequence[float]]
    factors: Sequence[Sequence[float]]
    shifts: Sequence[float]


def tree_program(tree: TracedTree, links: Sequence[int]) -> Program:
    """Program of the poses of links, by number, in the frame of link 0. Outputs: the twelve numbers
    of each pose.
    """
    graph = Graph()
    angles = Angles(graph)
    poses: list[tuple[Any, ...]] = [IDENTITY]
    for j, parent in enumerate(tree.parents):
        factors = tree.factors[j]
        shift = tree.shifts[j]
        sine, cosine = angles.sine_cosine(factors, shift, 0)
        x = graph.linear(((k, factor) for k, factor in enumerate(factors) if factor), shift)
        origin = tree.origins[j]
        poses.append(forward.child(poses[parent], origin, tree.screws[j], x, sine, cosine))
    return program(graph, angles, [number for link in links for number in poses[link]])
