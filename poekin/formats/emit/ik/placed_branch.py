"""C of the pose of a branch, from the cosines and sines that its angles were made of."""

from __future__ import annotations

import math

from ....engine.straight_line.program import Angle
from ..c import CFunction
from ..messages import EmittedFunction
from ..statements import double


def columns(dof: int) -> int:
    """Numbers of a branch: coordinates, their cosines, their sines, and a margin."""
    return 3 * dof + 1


class PlacedBranch:
    """The C of the pose that an arm has at a branch: that of `task`, without an angle's sine or
    cosine.
    """

    def __init__(self, word: str, task: EmittedFunction, dof: int) -> None:
        self.name = f"{word}_placed"
        self._angles = task.program.angles
        self._dof = dof
        self._pose = CFunction(word, "double", double, task, dof, "static ")

    def text(self) -> str:
        """The definitions."""
        count = len(self._angles)
        given = "s, c" if count else "branch, branch"
        lines = [
            f"static void {self.name}(const double *branch, double *T)",
            "{",
            *[f"    double s[{count}], c[{count}];"] * bool(count),
            *(line for j, angle in enumerate(self._angles) for line in self._sum(j, angle)),
            f"    {self._pose.name}_sincos({given}, branch, T);",
            "}",
            "",
        ]
        return "\n".join([self._pose.sincos_text(), *lines])

    def _sum(self, j: int, angle: Angle) -> list[str]:
        """Cosine and sine of a sum of angles, by the addition theorems."""
        (first_c, first_s), *others = self._parts(angle)
        lines = [f"    c[{j}] = {first_c};", f"    s[{j}] = {first_s};"]
        for k, (c, s) in enumerate(others):
            turned = f"turned{j}_{k}"
            lines += [
                f"    const double {turned} = c[{j}] * {c} - s[{j}] * {s};",
                f"    s[{j}] = s[{j}] * {c} + c[{j}] * {s};",
                f"    c[{j}] = {turned};",
            ]
        return lines

    def _parts(self, angle: Angle) -> list[tuple[str, str]]:
        """Cosine and sine of each part of a sum."""
        parts = []
        if angle.base is not None:
            parts.append((f"c[{angle.base}]", f"s[{angle.base}]"))
        for k, factor in angle.terms:
            sign = "-" if factor < 0.0 else ""
            parts.append((f"branch[{self._dof + k}]", f"{sign}branch[{2 * self._dof + k}]"))
        if angle.offset:
            parts.append((double(math.cos(angle.offset)), double(math.sin(angle.offset))))
        return parts
