"""A straight-line program as statements of text that C and Python read alike: the same operations
in one order.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...engine.straight_line.program import Angle, Program
from ...errors import InputError

WriteNumber = Callable[[float], str]
_OF_SIGN = {1: "+", -1: "-"}


@dataclass(frozen=True)
class Statements:
    """s0, c0 ... are sine and cosine of angle number 0 ..., q0 ... the coordinates, x0 ... the
    angles.

    `reads` are (name, array, index) of the inputs in use and `lines` (name, expression). An output
    is an expression
    or, where it does not depend on the configuration, a number; an angle is an expression,
    `angle_reads` its inputs.
    """

    reads: tuple[tuple[str, str, int], ...]
    lines: tuple[tuple[str, str], ...]
    outputs: tuple[str | float, ...]
    angle_reads: tuple[tuple[str, str, int], ...]
    angles: tuple[str, ...]


def statements(program: Program, literal: WriteNumber) -> Statements:
    """The program's statements; literal writes a number."""
    names: dict[int, str] = {}
    constants: dict[int, float] = {}
    reads, lines = [], []
    for number, node in program.steps:
        if node.kind == "input":
            at = int(node.first)
            array, index = ("q", -1 - at) if at < 0 else ("sc"[at % 2], at // 2)
            names[number] = f"{array}{index}"
            reads.append((names[number], array, index))
            continue
        if node.kind == "constant":
            names[number], constants[number] = literal(node.first), node.first
            continue
        if node.kind == "scaled":
            expression = f"{literal(node.first)} * {names[node.second]}"
        else:
            operation = "*" if node.kind == "product" else _OF_SIGN[node.sign]
            expression = f"{names[int(node.first)]} {operation} {names[node.second]}"
        names[number] = f"v{len(lines)}"
        lines.append((names[number], expression))
    outputs: list[str | float] = []
    for number, sign in program.outputs:
        if number is None or number in constants:
            outputs.append(sign if number is None else sign * constants[number])
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


def _angle(angle: Angle, literal: WriteNumber) -> str:
    """An angle's sum, in the order in which `engine.kernels.arm_kernels` takes it."""
    parts = [literal(angle.offset)] if angle.offset else []
    parts += [] if angle.base is None else [f"x{angle.base}"]
    text = " + ".join(parts)
    for k, factor in angle.terms:
        term = f"q{k}" if abs(factor) == 1 else f"{literal(abs(factor))} * q{k}"
        if text:
            text += f" + {term}" if factor > 0 else f" - {term}"
        else:
            # the first factor of an angle without a base is positive (`Angles` of `program`)
            text = term
    return text


def by_outputs(
    outputs: Sequence[str | float], pose: bool
) -> tuple[list[str | float], list[str | float]]:
    """The sixteen entries of the pose row by row, none where the outputs do not begin with one, and
    those of J.
    """
    if not pose:
        return [], list(outputs)
    R, p, J = outputs[:9], outputs[9:12], outputs[12:]
    return [*R[:3], p[0], *R[3:6], p[1], *R[6:], p[2], 0.0, 0.0, 0.0, 1.0], list(J)


def double(value: float) -> str:
    """A number so that it reads back as the same double. Raises: InputError for one that is not
    finite.
    """
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
