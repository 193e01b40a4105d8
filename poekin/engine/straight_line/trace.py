"""A scalar that records: run a formula on it and get the expression graph of what it computes.

A product with 0 or +-1 and a sum with 0 are never recorded (`FOLD_TOLERANCE` says how near), equal nodes
are one node, signs stand beside nodes and cost nothing, and constants that meet are multiplied
beforehand. A constant that is added and taken away again leaves no trace: 1 - (1 - x) is x. What no
output needs is left out when the graph is read.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple

FOLD_TOLERANCE = 2.0**-52
"""A constant that differs from 0 or +-1 by at most this, the rounding of a cosine of a right angle,
counts as it.
"""


def folded(value: float) -> float:
    """A constant; one that is 0 or +-1 but for rounding is that."""
    near = round(value) if abs(value) < 2 else value
    if near in (-1, 0, 1) and abs(value - near) <= FOLD_TOLERANCE:
        return float(near)
    return float(value)


class Node(NamedTuple):
    """One operation: kind, and what it is of.

    - "input": number `first`
    - "constant": the positive number `first`
    - "scaled": the positive constant `first` times node `second`
    - "product": of nodes `first` and `second`
    - "reciprocal": 1 over node `second`
    - "sum": node `first` plus `sign` times node `second`
    """

    kind: str
    first: float
    second: int = 0
    sign: int = 0


class Graph:
    """The nodes recorded so far, each once, each after what it is made of."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self._numbers: dict[Node, int] = {}

    def input(self, number: int) -> Traced:
        """The scalar that stands for input `number`."""
        return self._node(Node("input", number))

    def scaled(self, x: Traced, factor: float) -> Traced | float:
        """A constant times a scalar."""
        factor = folded(factor)
        size = abs(factor)
        number = x.number
        node = self.nodes[x.number]
        if node.kind == "scaled":
            size = node.first * size
            number = node.second
        if size == 0.0:
            return 0.0
        sign = x.sign if factor > 0 else -x.sign
        if size == 1.0:
            return Traced(self, number, sign)
        return self._node(Node("scaled", size, number), sign)

    def product(self, x: Traced, y: Traced) -> Traced:
        """x y."""
        low, high = sorted((x.number, y.number))
        return self._node(Node("product", low, high), x.sign * y.sign)

    def reciprocal(self, x: Traced) -> Traced:
        """1 / x."""
        return self._node(Node("reciprocal", 1.0, x.number), x.sign)

    def sum(self, x: Traced, y: Traced) -> Traced | float:
        """x + y."""
        if x.number == y.number:
            if x.sign == y.sign:
                return self.scaled(x, 2.0)
            return 0.0
        first, second = (x, y) if x.number < y.number else (y, x)
        return self._node(
            Node("sum", first.number, second.number, first.sign * second.sign),
            first.sign,
        )

    def shifted(self, x: Traced, value: float) -> Traced | float:
        """A scalar plus a constant."""
        node = self.nodes[x.number]
        if node.kind == "sum":
            first = Traced(self, int(node.first), x.sign)
            second = Traced(self, node.second, x.sign * node.sign)
            for rest, other in ((first, second), (second, first)):
                constant = self.nodes[other.number]
                if constant.kind == "constant" and other.sign * constant.first == -value:
                    return rest
        if abs(value) <= FOLD_TOLERANCE:
            return x
        return self.sum(x, self.constant(value))

    def linear(self, terms: Iterable[tuple[int, float]], offset: float) -> Traced | float:
        """Sum of factor * q_k over terms (k, factor), plus an offset."""
        total: Any = offset
        for k, factor in terms:
            total = total + self.scaled(self.input(-1 - k), factor)
        return total

    def constant(self, value: float) -> Traced:
        """A number known beforehand, where it meets one that is not."""
        return self._node(Node("constant", abs(value)), 1 if value > 0 else -1)

    def _node(self, node: Node, sign: int = 1) -> Traced:
        number = self._numbers.setdefault(node, len(self.nodes))
        if number == len(self.nodes):
            self.nodes.append(node)
        return Traced(self, number, sign)


@dataclass(eq=False, slots=True)
class Traced:
    """A number known at run time only: a node of a graph, and a sign."""

    graph: Graph
    number: int
    sign: int

    def __mul__(self, other):
        if isinstance(other, Traced):
            return self.graph.product(self, other)
        return self.graph.scaled(self, other)

    def __rtruediv__(self, other):
        return other * self.graph.reciprocal(self)

    def __add__(self, other):
        if isinstance(other, Traced):
            return self.graph.sum(self, other)
        return self.graph.shifted(self, other)

    def __sub__(self, other):
        return self + -other

    def __rsub__(self, other):
        return -self + other

    __rmul__ = __mul__
    __radd__ = __add__

    def __neg__(self):
        return Traced(self.graph, self.number, -self.sign)
