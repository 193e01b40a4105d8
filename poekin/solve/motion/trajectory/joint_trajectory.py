"""JointTrajectory of ROS as YAML or JSON text, which its command-line tools take as a message."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Literal

from ....groups.arrays import Array

MessageFormat = Literal["yaml", "json"]
NANOSECONDS = 1_000_000_000


def yaml_text(names: Sequence[str], times: Array, q: Array, dq: Array) -> str:
    """trajectory_msgs/JointTrajectory as YAML that versions 1.1 and 1.2 read alike, of times (N,),
    s, and q and dq (N, m).
    """
    lines = [
        f"joint_names: [{', '.join(map(_quoted, names))}]",
        "points:",
    ]
    for t, row, rates in zip(times.tolist(), q.tolist(), dq.tolist(), strict=True):
        time = _time(t)
        lines += [
            f"- positions: {number_list(row)}",
            f"  velocities: {number_list(rates)}",
            f"  time_from_start: {{sec: {time['sec']}, nanosec: {time['nanosec']}}}",
        ]
    return "\n".join(lines) + "\n"


def json_text(names: Sequence[str], times: Array, q: Array, dq: Array) -> str:
    """trajectory_msgs/JointTrajectory as JSON, one point a line, which is YAML 1.1 and 1.2, too."""
    points = [
        f'{{"positions": {number_list(row)}, "velocities": {number_list(rates)}, '
        f'"time_from_start": {json.dumps(_time(t))}}}'
        for t, row, rates in zip(times.tolist(), q.tolist(), dq.tolist(), strict=True)
    ]
    listed = ",\n".join(points)
    return f'{{"joint_names": {json.dumps(list(names))}, "points": [\n{listed}\n]}}\n'


def number(value: float) -> str:
    """A number in the shortest form that reads back as the same float, with a dot.

    YAML 1.1, which ROS reads, takes 1e-05 for a text, and 1.0e-05 for a number.
    """
    if not math.isfinite(value):
        raise ValueError(value)
    text = repr(value + 0.0)  # -0.0 is 0.0
    digits, exponent, power = text.partition("e")
    if exponent and "." not in digits:
        digits += ".0"
    return digits + exponent + power


def number_list(values: Sequence[float]) -> str:
    """Numbers in brackets, as YAML, JSON and URScript read them."""
    return f"[{', '.join(map(number, values))}]"


def _time(t: float) -> dict[str, int]:
    sec, nanosec = divmod(round(t * NANOSECONDS), NANOSECONDS)
    return {"sec": sec, "nanosec": nanosec}


def _quoted(name: str) -> str:
    """A text in double quotes, whatever YAML might take it for without them."""
    return f'"{"".join(map(_character, name))}"'


def _character(c: str) -> str:
    if c in '"\\':
        return f"\\{c}"
    if " " <= c <= "~":
        return c
    return f"\\U{ord(c):08X}"
