"""A straight-line program: what a traced formula leaves to be computed, for one arm, in the order
of computing.

Its inputs are the sine and cosine of some angles, which are sums of coordinates, and the
coordinates themselves where joints slide. Its outputs are numbers, one after the other, each a node
with a sign or a constant.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ..count import Count
from .trace import FOLD_TOLERANCE, Graph, Node, Traced, folded

HALF_PI = math.pi / 2


Terms = tuple[tuple[int, float], ...]
"""Coordinates (k, factor) of a sum."""


@dataclass(frozen=True)
class Angle:
    """Sum of factor * q_k over `terms` (k, factor), plus `offset` (rad), plus angle number `base`
    if there is one.
    """

    base: int | None
    terms: Terms
    offset: float

    @property
    def multiplications(self) -> int:
        """Multiplications that it takes."""
        return sum(abs(factor) != 1 for _, factor in self.terms)

    @property
    def additions(self) -> int:
        """Additions that it takes."""
        parts = len(self.terms)
        parts += self.base is not None
        parts += self.offset != 0
        return max(parts - 1, 0)

    @property
    def operations(self) -> int:
        """Multiplications and additions."""
        return self.multiplications + self.additions


class Angles:
    """The angles whose sines and cosines are needed, each once: up to sign and whole quarter turns."""

    def __init__(self, graph: Graph):
        self.graph = graph
        self.numbers: dict[tuple[Terms, float], int] = {}

    def sine_cosine(self, factors: Sequence[float], offset: float, quarters: int):
        """Sine and cosine of sum factors[k] q_k + offset + quarters * 90 degrees. An offset that is a
        right angle but for rounding is that.
        """
        whole = round(offset / HALF_PI)
        if abs(offset - whole * HALF_PI) <= FOLD_TOLERANCE:
            offset = 0.0
            quarters = quarters + whole
        terms = tuple((k, float(f)) for k, f in enumerate(factors) if f)
        if not terms:
            sine = math.sin(offset) if offset else 0.0
            cosine = math.cos(offset) if offset else 1.0
            sign = 1
        else:
            sign = 1 if terms[0][1] > 0 else -1
            if sign < 0:
                terms = tuple((k, -f) for k, f in terms)
                offset = -offset
                quarters = -quarters
            form = (terms, offset)
            number = self.numbers.setdefault(form, len(self.numbers))
            sine = self.graph.input(2 * number)
            cosine = self.graph.input(2 * number + 1)
        for _ in range(quarters % 4):
            sine, cosine = cosine, -sine
        return sign * sine, cosine


@dataclass(frozen=True)
class Program:
    """Statements in order; `angles` are numbered as the inputs 2 j (sine) and 2 j + 1 (cosine);
    input -1 - k is q_k.

    `steps` are (number, node) of all nodes that an output needs; `outputs` are a node's number and
    sign, or a constant (None, value).
    """

    angles: tuple[Angle, ...]
    steps: tuple[tuple[int, Node], ...]
    outputs: tuple[tuple[int | None, float], ...]
    count: Count = field(compare=False)


def program(graph: Graph, angles: Angles, outputs: Sequence[Traced | float]) -> Program:
    """Nodes of a graph that the outputs need, and their cost."""
    nodes = graph.nodes
    needed = set()
    stack = [x.number for x in outputs if isinstance(x, Traced)]
    while stack:
        number = stack.pop()
        if number not in needed:
            needed.add(number)
            stack += _operands(nodes[number])
    angle_of = {k: _angle_number(nodes[k]) for k in needed}
    used = sorted({j for j in angle_of.values() if j is not None})
    forms = list(angles.numbers)
    chosen, order = _sums([forms[j] for j in used])
    place = {used[j]: position for position, j in enumerate(order)}
    steps = []
    for number in sorted(needed):
        node = nodes[number]
        j = angle_of[number]
        if j is not None:
            part = int(node.first) % 2
            node = Node("input", 2 * place[j] + part)
        steps.append((number, node))
    ends = tuple(map(_end, outputs))
    return Program(tuple(chosen), tuple(steps), ends, _count(chosen, steps))


def joined(first: Program, second: Program) -> Program:
    """Both programs as one, its outputs those of the first, with its bits, and of the second behind
    them: what they have in common is computed once.
    """
    angles = list(first.angles)
    places: list[int] = []
    for angle in second.angles:
        base = None if angle.base is None else places[angle.base]
        moved = replace(angle, base=base)
        if moved not in angles:
            angles.append(moved)
        places.append(angles.index(moved))
    steps = list(first.steps)
    known = {node: number for number, node in steps}
    after = max(known.values(), default=-1) + 1
    moved_to: dict[int, int] = {}
    for number, node in second.steps:
        here = _renumbered(node, places, moved_to)
        there = known.setdefault(here, after + number)
        if there == after + number:
            steps.append((there, here))
        moved_to[number] = there
    ends = list(first.outputs)
    for end, sign in second.outputs:
        if end is not None:
            end = moved_to[end]
        ends.append((end, sign))
    count = _count(angles, steps)
    return Program(tuple(angles), tuple(steps), tuple(ends), count)


def _renumbered(node: Node, angles: Sequence[int], numbers: dict[int, int]) -> Node:
    """A node by other numbers of angles and nodes."""
    j = _angle_number(node)
    if j is not None:
        part = int(node.first) % 2
        return Node("input", 2 * angles[j] + part)
    if node.kind in ("product", "sum"):
        node = node._replace(first=numbers[int(node.first)])
    if node.kind in ("scaled", "reciprocal", "product", "sum"):
        node = node._replace(second=numbers[node.second])
    return node


def _angle_number(node: Node) -> int | None:
    """Number of the angle whose sine or cosine a node is."""
    if node.kind == "input" and node.first >= 0:
        return int(node.first) // 2
    return None


def _end(x: Traced | float) -> tuple[int | None, float]:
    """Number and sign of an output's node; None and the value of a constant."""
    if isinstance(x, Traced):
        return x.number, float(x.sign)
    return None, folded(x)


def _operands(node: Node) -> list[int]:
    if node.kind in ("scaled", "reciprocal"):
        return [node.second]
    if node.kind in ("product", "sum"):
        return [int(node.first), node.second]
    return []


def _sums(forms) -> tuple[list[Angle], list[int]]:
    """The angles, each from an earlier one where that saves additions; and which form each one is."""
    lengths = [len(terms) for terms, _ in forms]
    order = sorted(range(len(forms)), key=lambda j: (lengths[j], j))
    chosen: list[Angle] = []
    # the angles so far that have a coordinate: no other one saves an addition
    having: dict[int, list[int]] = {}
    for position, j in enumerate(order):
        terms, offset = forms[j]
        best = Angle(None, terms, offset)
        bases = {base for k, _ in terms for base in having.get(k, ())}
        for base in sorted(bases):
            known, known_offset = forms[order[base]]
            rest = dict(terms)
            for k, factor in known:
                rest[k] = rest.get(k, 0.0) - factor
            rest = {k: factor for k, factor in rest.items() if factor}
            left = tuple(sorted(rest.items()))
            candidate = Angle(base, left, offset - known_offset)
            if candidate.operations < best.operations:
                best = candidate
        chosen.append(best)
        for k, _ in terms:
            having.setdefault(k, []).append(position)
    return chosen, order


def _count(angles: Sequence[Angle], steps: Sequence[tuple[int, Node]]) -> Count:
    kinds = [node.kind for _, node in steps]
    products = kinds.count("scaled") + kinds.count("product")
    return Count(
        multiplications=products + sum(angle.multiplications for angle in angles),
        additions=kinds.count("sum") + sum(angle.additions for angle in angles),
        divisions=kinds.count("reciprocal"),
        sines=len(angles),
        cosines=len(angles),
    )
