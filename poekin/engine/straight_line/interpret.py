"""A straight-line program run on NumPy arrays, statement by statement: where there is no machine
code.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .program import Program

Array = np.ndarray[Any, np.dtype[np.float64]]


def evaluate(program: Program, q: Array) -> Array:
    """The outputs (N, k) of a program at configurations q (N, m)."""
    x = angles(program, q)
    return outputs(program, np.sin(x), np.cos(x), q)


def angles(program: Program, q: Array) -> Array:
    """The angles (N, j) whose sines and cosines a program takes, at configurations q (N, m): sums in
    the order of `machine_code`.
    """
    x = np.zeros((len(q), len(program.angles)))
    for j, angle in enumerate(program.angles):
        if angle.base is not None:
            x[:, j] = x[:, angle.base]
        for k, factor in angle.terms:
            x[:, j] += factor * q[:, k]
        x[:, j] += angle.offset
    return x


def outputs(program: Program, sines: Array, cosines: Array, q: Array) -> Array:
    """The outputs (N, k) of a program where sines and cosines (N, j) of its angles are known."""
    values: dict[int, Any] = {}
    for number, node in program.steps:
        if node.kind == "input":
            values[number] = _input(int(node.first), sines, cosines, q)
            continue
        if node.kind == "constant":
            values[number] = node.first
            continue
        second = values[node.second]
        if node.kind == "scaled":
            values[number] = node.first * second
        elif node.kind == "reciprocal":
            values[number] = 1.0 / second
        elif node.kind == "product":
            values[number] = values[int(node.first)] * second
        else:
            values[number] = values[int(node.first)] + node.sign * second
    result = np.empty((len(q), len(program.outputs)))
    for column, (number, sign) in zip(result.T, program.outputs, strict=True):
        if number is None:
            column[:] = sign
        else:
            column[:] = sign * values[number]
    return result


def _input(number: int, sines: Array, cosines: Array, q: Array) -> Array:
    """Values (N,) of an input: a coordinate, or the sine or cosine of an angle."""
    if number < 0:
        return q[:, -1 - number]
    return (sines, cosines)[number % 2][:, number // 2]
