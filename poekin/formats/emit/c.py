"""Kinematics of an arm as C99 for a controller: a header, a source, and a program that tests them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...checks import REQUIRED, choice
from ...model.kinematics.arm import Arm
from ...model.kinematics.pose_jacobian import AnyFrame
from .assignments import angle_assignments, comment, result_assignments
from .c_selftest import selftest
from .messages import (
    EmittedFunction,
    angle_lines,
    compile_checked,
    header_lines,
    identifier,
    made_by,
    make_tasks,
)
from .statements import Statements, WriteNumber, double, single, statements
from .vectors import vectors

Real = Literal["double", "float"]
KINDS: dict[Real, tuple[WriteNumber, type[np.floating]]] = {
    "double": (double, np.float64),
    "float": (single, np.float32),
}


@dataclass(frozen=True)
class CSource:
    """C99 of a chain's kinematics, as texts in ASCII.

    Attributes
    ----------
    name : str
        Identifier with which the names of files and functions begin.
    header : str
        Declarations, NAME.h.
    source : str
        Definitions, NAME.c.
    selftest : str
        Program that tests them, NAME_selftest.c.
    """

    name: str
    header: str
    source: str
    selftest: str

    @property
    def files(self) -> dict[str, str]:
        """Texts by the names of their files."""
        return {
            f"{self.name}.h": self.header,
            f"{self.name}.c": self.source,
            f"{self.name}_selftest.c": self.selftest,
        }


def c(
    chain: Arm,
    frame: AnyFrame = REQUIRED,
    *,
    name: str = "arm",
    real: Real = "double",
    origin: str = "",
) -> CSource:
    """C99 of a chain's pose and Jacobian: straight-line, without allocation, with math.h alone.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Chain to write.
    frame : {"space", "body", "hybrid", "cheapest"} or int
        Frame of the Jacobian, or the index of a joint, as in `CompiledChain.jacobian`.
    name : str, default "arm"
        Name of which the C names are made; only a-z, 0-9 and _ are kept.
    real : {"double", "float"}, default "double"
        Type of the numbers.
    origin : str, default ""
        Words for the head of the text on where the arm is from: a file and its SHA-256, say.

    Returns
    -------
    source : CSource
        Functions NAME_fk, NAME_jacobian_FRAME and NAME_fk_jacobian_FRAME of q, rad or m; each also
        as ..._angles and ..._sincos, for who has sines and cosines of the angles. T row by row
        (16), J row by row (6 m).

    Raises
    ------
    InputError
        If `chain` is no Chain, `real` or the frame is unknown, `origin` is no text, or the arm needs a number that the
        type cannot hold.

    Notes
    -----
    Accuracy: that of `Chain.fk` in the arithmetic of `real` (tests/formats/test_emit_c.py). Source:
    Park 1994, Section IV, two planar rotations a link.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.dh.to_chain(pk.dh.published("puma560"))
    >>> source = pk.emit.c(arm, "hybrid", name="puma")
    >>> list(source.files)
    ['puma.h', 'puma.c', 'puma_selftest.c']
    >>> "void puma_fk(const double *q, double *T);" in source.header
    True
    """
    choice(real, tuple(KINDS), "real")
    word = identifier(name)
    literal, kind = KINDS[real]
    arm = compile_checked(chain, frame)
    functions = [CFunction(word, real, literal, task, arm.dof) for task in make_tasks(arm, frame)]
    head = [
        f"{word}: the kinematics of one serial arm as straight-line C99, in {real}. Generated: change the arm instead.",
        *made_by(origin),
        "",
        *(f"{word}_{function.task.cost}" for function in functions),
    ]
    texts = [function.text() for function in functions]
    tasks = [function.task for function in functions]
    return CSource(
        word,
        _header(word, [*head, "", *header_lines(arm, frame)], functions),
        "\n".join([comment(head), f'#include "{word}.h"\n\n#include <math.h>', *texts]),
        selftest(word, real, literal, tasks, vectors(arm, frame, kind)),
    )


class CFunction:
    """The C of one task: its angles, its statements, and both together; `linkage` stands before them,
    and `sines` are statements from x to s[j] and c[j], of math.h where none are given.
    """

    def __init__(
        self,
        word: str,
        real: str,
        literal: WriteNumber,
        task: EmittedFunction,
        dof: int,
        linkage: str = "",
        sines: Sequence[str] = (),
    ) -> None:
        self.task = task
        self.real = real
        self.literal = literal
        self.dof = dof
        suffix = {"float": "f"}.get(real, "")
        self.sines = sines or (f"s[j] = sin{suffix}(x);", f"c[j] = cos{suffix}(x);")
        self.name = f"{word}_{task.name}"
        self.count = len(task.program.angles)
        parameters = "".join(f", {real} *{result}" for result in task.results)
        self.heads = (
            f"{linkage}void {self.name}_angles(const {real} *q, {real} *x)",
            f"{linkage}void {self.name}_sincos(const {real} *s, const {real} *c, const {real} *q{parameters})",
            f"{linkage}void {self.name}(const {real} *q{parameters})",
        )

    def declared(self) -> str:
        """The declarations, and what they are."""
        sizes = ", ".join(f"{result}[{self.task.sizes[result]}]" for result in self.task.results)
        words = [
            f"{self.name}: from q[{self.dof}] to {sizes}; they may overlap q.",
            f"..._sincos: the same from s[{self.count}] = sin x and c[{self.count}] = cos x, where the angles x are",
            *(f"  {line}" for line in angle_lines(self.task)),
            "..._angles: those angles from q.",
        ]
        angles, sincos, whole = (f"{head};" for head in self.heads)
        return "\n".join([comment(words), whole, sincos, angles, ""])

    def text(self) -> str:
        """The definitions."""
        program = statements(self.task.program, self.literal)
        bodies = (self._angles(program), self._statements(program), self._whole())
        blocks = zip(self.heads, bodies, strict=True)
        lines = [line for head, body in blocks for line in ("", head, "{", *body, "}")]
        return "\n".join([*lines, ""])

    def sincos_text(self) -> str:
        """The definition of the function of sines and cosines alone."""
        body = self._statements(statements(self.task.program, self.literal))
        return "\n".join(["", self.heads[1], "{", *body, "}", ""])

    def _angles(self, program: Statements) -> list[str]:
        unused = [
            name for name, used in (("q", program.angle_reads), ("x", program.angles)) if not used
        ]
        return [*_ignored(unused), *angle_assignments(program, f"const {self.real}")]

    def _statements(self, program: Statements) -> list[str]:
        used = {array for _, array, _ in program.reads}
        unused = [array for array in "scq" if array not in used]
        if self.task.jacobian and not self.dof:
            unused.append("J")
        return [
            *_ignored(unused),
            *result_assignments(program, self.task, self.literal, f"const {self.real}"),
        ]

    def _whole(self) -> list[str]:
        results = self.task.arguments
        if not self.count:
            return [f"    {self.name}_sincos(q, q, q{results});"]
        return [
            f"    {self.real} s[{self.count}], c[{self.count}];",
            "    int j;",
            f"    {self.name}_angles(q, s);",
            f"    for (j = 0; j < {self.count}; j++) {{",
            f"        const {self.real} x = s[j];",
            *(f"        {line}" for line in self.sines),
            "    }",
            f"    {self.name}_sincos(s, c, q{results});",
        ]


def _ignored(names: list[str]) -> list[str]:
    """Statements that keep a compiler from warning of parameters that are not used."""
    return [f"    (void){name};" for name in names]


HEADER = """{comment}
#ifndef {guard}
#define {guard}

#ifdef __cplusplus
extern "C" {{
#endif

{declarations}
#ifdef __cplusplus
}}
#endif

#endif
"""


def _header(
    word: str,
    lines: list[str],
    functions: list[CFunction],
) -> str:
    declarations = "\n".join(function.declared() for function in functions)
    guard = f"{word.upper()}_H_INCLUDED"
    return HEADER.format(comment=comment(lines), guard=guard, declarations=declarations)
