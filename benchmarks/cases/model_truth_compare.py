"""Two models of one arm: changes planted in twenty arms, one at a time, and what `compare` says of
them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from poekin import compare

from ..planted_changes import (
    ARMS,
    CHANGES,
    alignment_fault,
    arm,
    fault,
    moves,
    planted,
)
from ..report import Figure, Table, Topic

WORDS = {
    "tilt": "axis tilted by 0.1° (angle found, °)",
    "shift": "axis shifted by 1 mm across itself (distance found, mm)",
    "zero": "zero moved by 0.5° (offset found, °)",
    "flip": "direction flipped",
}


@dataclass(frozen=True)
class Found:
    """One planted change: what it was, where, the size that was found, and what is wrong with the
    finding.
    """

    arm: str
    change: str
    joint: int
    size: float
    fault: str


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    names = list(ARMS)[:: 5 if quick else 1]
    found: list[Found] = []
    moved: list[Found] = []
    for number, name in enumerate(names, 1):
        chain, rng = arm(name), np.random.default_rng(0)
        for change in CHANGES:
            for k in range(1, chain.dof - 1):
                result = compare(chain, planted(chain, change, k, rng), samples=1)
                found.append(
                    Found(name, change, k + 1, size(result, change, k), fault(result, change, k))
                )
        for what, other, base, tool in moves(chain, rng):
            wrong = alignment_fault(compare(chain, other, samples=1), base, tool)
            moved.append(Found(name, f"{what} moved", 0, 0.0, wrong))
        if number % 5 == 0:
            say(f"{number} of {len(names)} arms")
    wrong = [f for f in (*found, *moved) if f.fault]
    return Topic(
        "Two models of one arm compared",
        f"{len(names)} arms of 6 or 7 revolute joints, real and random. One change at a time is planted in each "
        "interior joint, and the arm is compared with its changed self: the comparison has to name the joint, to give "
        "the change's size within 1 %, and to blame nothing else. A moved base and a moved tool are no differences: "
        "they have to come back as the alignment, and no joint may be implicated.",
        figures=[
            _figure("one change planted in an arm: joint named, size within 1 %, nothing else blamed", found),
            _figure("base, tool or both moved: alignment only", moved),
        ],
        tables=[
            Table(
                "What was planted, and what was found", ("change", "cases", "smallest found", "largest found", "wrong"),
                [_row(change, [f for f in found if f.change == change]) for change in CHANGES],
            ),
            *([Table("What went wrong", ("arm", "change", "joint", "fault"),
                     [(f.arm, f.change, f.joint, f.fault) for f in wrong])] if wrong else []),
            Table("Arms", ("arm", "joints"), [(name, arm(name).dof) for name in names], folded=True),
        ],
    )  # fmt: skip


def size(result, change: str, k: int) -> float:  # type: ignore[no-untyped-def]
    """The size of the change that a comparison has found in joint k, deg or mm; NaN where it
    matched nothing.
    """
    if not result.joints:
        return float("nan")
    joint = result.joints[k]
    return float(
        {
            "tilt": np.degrees(joint.angle),
            "shift": 1e3 * (joint.normal or 0.0),
            "zero": np.degrees(abs(joint.zero_offset)),
            "flip": joint.reversed,
        }[change]
    )


def _figure(what: str, cases: list[Found]) -> Figure:
    wrong = sum(bool(case.fault) for case in cases)
    return Figure(
        what, wrong, 0, shown=f"{len(cases) - wrong} of {len(cases)}", bar_shown=f"{len(cases)} of {len(cases)}",
        holds=bool(cases) and not wrong,
    )  # fmt: skip


def _row(change: str, cases: list[Found]) -> tuple[str | int, ...]:
    sizes = [case.size for case in cases]
    ends = ("", "") if change == "flip" else (f"{min(sizes):.6f}", f"{max(sizes):.6f}")
    return (WORDS[change], len(cases), *ends, sum(bool(case.fault) for case in cases))
