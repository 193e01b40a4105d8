"""Straight-line programs as statements of text that C and Python read alike, in one order."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...engine.straight_line.program import Angle, Program
from ...errors import InputError

WriteNumber = Callable[[float], str]
Read = tuple[str, str, int]
_OF_SIGN = {1: "+", -1: "-"}


@dataclass(frozen=True)
class Statements:
    """Statements over s0, c0 ..., sines and cosines of the angles x0 ..., and coordinates q0 ....

    `reads` are (name, array, index) of the inputs in use and `lines` (name, expression). An output
    is an expression or, where it does not depend on the configuration, a number; an angle is an
    expression, `angle_reads` its inputs.
    """

    reads: tuple[Read, ...]
    lines: tuple[tuple[str, str], ...]
    outputs: tuple[str | float, ...]
    angle_reads: tuple[Read, ...]
    angles: tuple[str, ...]


def statements(program: Program, literal: WriteNumber) -> Statements:
    """The program's statements; literal writes a number."""
    names: dict[int, str] = {}
    constants: dict[int, float] = {}
    reads: list[Read] = []
    lines: list[tuple[str, str]] = []
    for number, node in program.steps:
        if node.kind == "input":
            read = _read(int(node.first))
            reads.append(read)
            names[number] = read[0]
            continue
        if node.kind == "constant":
            names[number] = literal(node.first)
            constants[number] = node.first
            continue
        second = names[node.second]
        if node.kind == "scaled":
            expression = f"{literal(node.first)} * {second}"
        elif node.kind == "reciprocal":
            expression = f"{literal(1.0)} / {second}"
        else:
            operation = "*" if node.kind == "product" else _OF_SIGN[node.sign]
            expression = f"{names[int(node.first)]} {operation} {second}"
        names[number] = f"v{len(lines)}"
        lines.append((names[number], expression))
    outputs: list[str | float] = []
    for number, sign in program.outputs:
        if number is None:
            outputs.append(sign)
        elif number in constants:
            outputs.append(sign * constants[number])
        else:
            outputs.append(names[number] if sign > 0 else f"-{names[number]}")
    used = sorted({k for angle in program.angles for k, _ in angle.terms})
    return Statements(
        reads=tuple(sorted(reads, key=lambda read: read[1:])),
        lines=tuple(lines),
        outputs=tuple(outputs),
        angle_reads=tuple((f"q{k}", "q", k) for k in used),
        angles=tuple(_angle(angle, literal) for angle in program.angles),
    )


def _read(at: int) -> Read:
    """Input of a program: coordinate -1 - at where `at` is negative, else a sine or cosine."""
    array = "sc"[at % 2]
    index = at // 2
    if at < 0:
        array = "q"
        index = ~at
    return f"{array}{index}", array, index


def _angle(angle: Angle, literal: WriteNumber) -> str:
    """An angle's sum, in the order in which `engine.straight_line.machine_code` takes it."""
    text = ""
    if angle.base is not None:
        text += f" + x{angle.base}"
    for k, factor in angle.terms:
        term = f"q{k}"
        if abs(factor) != 1:
            term = f"{literal(abs(factor))} * {term}"
        sign = "+" if factor > 0 else "-"
        text += f" {sign} {term}"
    if angle.offset:
        text += f" + {literal(angle.offset)}"
    # The first factor of an angle without a base is positive (`Angles` of `program`).
    return text.removeprefix(" + ")


def by_outputs(
    outputs: Sequence[str | float],
    poses: int,
) -> tuple[list[str | float], list[str | float]]:
    """Entries of the poses row by row, and those of J."""
    T: list[str | float] = []
    for k in range(poses):
        T += [outputs[12 * k + i] for i in (0, 1, 2, 9, 3, 4, 5, 10, 6, 7, 8, 11)]
        T += [0.0, 0.0, 0.0, 1.0]
    return T, list(outputs[12 * poses :])


def double(value: float) -> str:
    """Number that reads back as the same double. Raises: InputError unless it is finite."""
    return _finite(repr(float(value)), value, "double")


def single(value: float) -> str:
    """The nearest single-precision number, as C writes it. Raises: InputError where there is none."""
    with np.errstate(over="ignore"):
        return _finite(str(np.float32(value)), value, "single") + "f"


def _finite(text: str, value: float, precision: str) -> str:
    if "inf" in text or "nan" in text:
        raise InputError(
            f"emit: the arm needs the number {value!r}, which {precision} precision cannot hold"
        )
    return text
