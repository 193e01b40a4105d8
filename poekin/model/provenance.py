"""Source: where a robot was read from, so that a message can say file and line."""

from __future__ import annotations

import sys
import warnings
from dataclasses import dataclass, field

from ..errors import PoekinWarning, quote


@dataclass(frozen=True, slots=True)
class Source:
    """Origin of a robot: file or text, and the lines of its links and joints.

    Fields: name, a file or whatever else the text came from; link_lines and joint_lines, the line
    of each link and joint in the robot's order, empty where there are no lines to speak of; text,
    the text itself where it was URDF, which others can then read, and which can be edited in place;
    mjcf, the text where it was MJCF. What the robot looks like is read out of these when it is drawn.
    """

    name: str
    link_lines: tuple[int, ...] = ()
    joint_lines: tuple[int, ...] = ()
    text: str | bytes = field(default=b"", repr=False, compare=False)
    mjcf: str | bytes = field(default=b"", repr=False, compare=False)

    def __str__(self) -> str:
        return self.name

    def place(self, line: int | None = None) -> str:
        """The place as compilers write it, `file:line`, or the name alone; harmless for plain text."""
        plain = quote(self.name, 400)[1:-1]
        return plain if line is None else f"{plain}:{line}"

    def of_link(self, index: int) -> str:
        """The place of link number `index`."""
        return self.place(*self.link_lines[index : index + 1])

    def of_joint(self, index: int) -> str:
        """The place of joint number `index`."""
        return self.place(*self.joint_lines[index : index + 1])


def warn(message: str) -> None:
    """A `PoekinWarning` that Python shows at the first line outside of poekin: the line that asked
    for the robot.
    """
    frame = sys._getframe(1)  # noqa: SLF001 - the way to the caller
    level = 2
    while (
        frame.f_back is not None
        and frame.f_globals.get("__name__", "").partition(".")[0] == "poekin"
    ):
        frame = frame.f_back
        level += 1
    warnings.warn(message, PoekinWarning, stacklevel=level)
