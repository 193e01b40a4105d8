"""Correction of readings as data: the program that both languages write, and words on its numbers."""

from __future__ import annotations

from typing import NamedTuple

from ....engine.straight_line.program import Program
from ....groups.arrays import Array
from ....model.chain import Chain
from ..messages import coordinate_lines, made_by, quote_ascii
from ..statements import Statements, double, statements


class Correction(NamedTuple):
    """True joint values of an arm's readings and conditions.

    Parameters
    ----------
    chain : Chain
        The nominal arm, whose coordinates are read.
    program : Program
        From q (m) and conditions (k), which follow it, to the m true joint values.
    conditions : tuple of str
        Words on each condition.
    terms : tuple of str
        Names of the terms.
    q, given, expected : (N, m), (N, k) and (N, m) ndarray
        Readings, conditions and true joint values to test the text with.
    """

    chain: Chain
    program: Program
    conditions: tuple[str, ...]
    terms: tuple[str, ...]
    q: Array
    given: Array
    expected: Array

    @property
    def statements(self) -> Statements:
        """Statements of the program."""
        return statements(self.program, double)

    def lines(self, origin: str) -> list[str]:
        """Lines on what the text computes, and from what."""
        count = self.program.count
        head = [
            *made_by(origin),
            f"Terms: {', '.join(map(quote_ascii, self.terms))}: {count.multiplications} multiplications, "
            f"{count.additions} additions or subtractions, {count.sines} pairs of sine and cosine.",
            "",
            "q are readings; the calibrated arm is where its kinematics has it at the true joint values.",
            "",
            *coordinate_lines(self.chain),
        ]
        if self.conditions:
            head += ["", "The conditions, and what they were at the calibration on average:"]
            numbered = enumerate(self.conditions)
            head += [f"  conditions[{k}]  {words}" for k, words in numbered]
        return head


def assignments(
    correction: Correction, sine: str, cosine: str, entry: str
) -> list[tuple[str, str]]:
    """Names and expressions in order: what is read, angles, sines and cosines, and what follows from them.

    sine and cosine are functions, and entry reads number {} of the array {}.
    """
    program = correction.statements
    dof = correction.chain.dof
    found: dict[str, str] = {}
    functions = {"s": sine, "c": cosine}
    inputs = [*program.angle_reads, *(read for read in program.reads if read[1] == "q")]
    for name, _, k in inputs:
        array = "q"
        if k >= dof:
            array = "conditions"
            k = k - dof
        found[name] = entry.format(array, k)
    angles = {f"x{j}": text for j, text in enumerate(program.angles)}
    turns = {name: f"{functions[array]}(x{j})" for name, array, j in program.reads if array != "q"}
    found |= angles
    found |= turns
    return [*found.items(), *program.lines]
