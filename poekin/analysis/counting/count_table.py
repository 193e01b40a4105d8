"""The paper's table of operation counts in full, for one arm: what it prints, leaves out, and what
can be had.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import InputError, safe_repr
from ...model.chain import Chain
from ...model.geometry.idealise import Idealised
from ...model.kinematics.compiled import CheapestFrame, CompiledChain
from .count import Count, count

__all__ = ["PRINTED", "CountRow", "CountTable", "count_table", "printed"]

PRINTED = {
    "direct": ((60, 96), (45, 72)),
    "recursive": ((42, 78), (30, 57)),
    "dh_recursive": ((42, 0), (30, 0)),
}
"""The table as printed, of n >= 2 revolute joints: multiplications a n - b and additions, (a, b) of
each.

Source: Park 1994, Section IV. The line of Denavit and Hartenberg is the paper's account of Orin and
Schrader 1984; their own table has not been looked up here.
"""


@dataclass(frozen=True)
class CountRow:
    """One way to a Jacobian and its cost.

    Attributes: group, a heading of `CountTable`; method, frame, counting, as `count` takes them;
    what, in words; jacobian and with_pose, the Counts of J alone and of J and the tool's pose (None
    where nobody printed it).
    """

    group: str
    method: str
    frame: str | int
    counting: str
    what: str
    jacobian: Count
    with_pose: Count | None


@dataclass(frozen=True)
class CountTable:
    """Costs of one arm's Jacobian in every way that `count` knows.

    Attributes: base, tip, names of the frames; joints n, coordinates m; rows; idealised, the
    `Idealised` whose rows there are, or None; cheapest, which frame "cheapest" is, of the arm as it is;
    verdict, sentences on which part of the printed advantage over Denavit and Hartenberg is
    bookkeeping.
    """

    base: str
    tip: str
    joints: int
    coordinates: int
    rows: tuple[CountRow, ...]
    idealised: Idealised | None
    cheapest: CheapestFrame | None
    verdict: tuple[str, ...]

    def __getitem__(self, key: tuple[str, str | int, str]) -> CountRow:
        """The first row of (method, frame, counting), as in `table["recursive", "body", "live"]`;
        else KeyError.
        """
        for row in self.rows:
            if (row.method, row.frame, row.counting) == key:
                return row
        raise KeyError(key)

    @property
    def groups(self) -> tuple[str, ...]:
        """The headings of the rows, in order."""
        return tuple(dict.fromkeys(row.group for row in self.rows))

    def of(self, group: str) -> tuple[CountRow, ...]:
        """The rows under a heading, `group`; none where there is no such heading. Raises: nothing."""
        return tuple(row for row in self.rows if row.group == group)

    def as_dict(self) -> dict[str, Any]:
        """Everything as plain dicts, lists, numbers and texts."""
        cheapest = None
        if self.cheapest is not None:
            cheapest = {
                "joint": self.cheapest.joint,
                "along": self.cheapest.along,
                "T_km": self.cheapest.T_km.tolist(),
            }
        idealised = None
        if self.idealised is not None:
            idealised = {
                "position_bound": self.idealised.position_bound,
                "rotation_bound": self.idealised.rotation_bound,
                "changes": list(self.idealised.changes),
            }
        return {
            "base": self.base,
            "tip": self.tip,
            "joints": self.joints,
            "coordinates": self.coordinates,
            "cheapest": cheapest,
            "idealised": idealised,
            "verdict": list(self.verdict),
            "groups": {group: MEANING[group] for group in self.groups},
            "rows": [_plain(row) for row in self.rows],
        }


PAPER = "printed in the paper"
COUNTINGS = "as the paper charges"
ALIKE = "with equal bookkeeping"
NEEDED = "as needed"
EVERYTHING = "with everything"
STRUCTURED = "two planar rotations a link"
THIS = "this arm's own program"
IDEAL = "the idealised arm's own program"

MEANING = {
    PAPER: "formulas for n revolute joints; DH as it reports Orin and Schrader, whose own table is unchecked here",
    COUNTINGS: "all that an algorithm does, the whole last product too; the links' poses are given",
    ALIKE: "the same; first link, last link and tool in or out for both sides alike",
    NEEDED: "only what reaches an output; the links' poses are given",
    EVERYTHING: "as needed, and what the table leaves out: sines, exponentials or links' poses, coupling",
    STRUCTURED: "as needed, general alpha, a and d, J in the last link's frame; sines and cosines are given",
    THIS: "what `Chain.compile` makes of its numbers, with everything: sums of angles, tool",
    IDEAL: "the same of the arm in exact geometry",
}
"""What the groups of rows are."""

_WAYS: tuple[tuple[str, str, str, str, str], ...] = (
    (COUNTINGS, "direct", "space", "paper", "POE, direct"),
    (COUNTINGS, "direct", "body", "paper", "POE, direct"),
    (COUNTINGS, "recursive", "body", "paper", "POE, recursive, tool in the last link's frame"),
    (COUNTINGS, "dh_recursive", "body", "paper", "DH, recursive: first link and tool charged"),
    (ALIKE, "recursive", "body", "paper", "POE, recursive"),
    (ALIKE, "dh_modified", "body", "paper", "DH, recursive on modified (Craig's) frames"),
    (ALIKE, "dh_paul", "body", "paper", "DH, recursive on standard (Paul's) frames"),
    (ALIKE, "recursive_with_tool", "body", "paper", "POE, recursive, a constant tool behind"),
    (
        ALIKE,
        "recursive_general_frames",
        "body",
        "paper",
        "POE, recursive, link frames attached anywhere",
    ),
    (NEEDED, "direct", "body", "live", "POE, direct"),
    (NEEDED, "recursive", "body", "live", "POE, recursive"),
    (
        NEEDED,
        "recursive_by_cross",
        "body",
        "live",
        "POE, recursive, third columns by cross product",
    ),
    (NEEDED, "dh_modified", "body", "live", "DH, recursive on modified frames"),
    (NEEDED, "dh_paul", "body", "live", "DH, recursive on standard frames"),
    (EVERYTHING, "direct", "space", "everything", "POE, direct, exponentials made"),
    (
        EVERYTHING,
        "recursive_with_tool",
        "body",
        "everything",
        "POE, recursive, z-aligned frames, tool",
    ),
    (EVERYTHING, "recursive", "body", "everything", "POE, recursive, z-aligned frames, no tool"),
    (EVERYTHING, "dh_modified", "body", "everything", "DH, recursive on modified frames, no tool"),
    (EVERYTHING, "dh_recursive", "body", "everything", "DH, recursive on standard frames, tool"),
    (STRUCTURED, "structured", "body", "live", "general links"),
)


def count_table(chain: Chain, *, idealise: float | None = None) -> CountTable:
    """The operation counts of one arm's Jacobian, in every way that `count` knows.

    Parameters: chain, of n joints; from n = 2 on the paper's methods are in it, and the printed
    formulas where all joints are revolute and uncoupled. idealise: a tolerance (rad and m), for the
    program of the idealised chain too. Returns: CountTable. Raises: InputError. Accuracy: exact, by
    running; only the printed lines are formulas.
    Source: Park 1994, Section IV; the programs are those that `Chain.compile` runs.
    """
    if not isinstance(chain, Chain):
        raise InputError(f"expected a Chain, as Robot.chain makes it, got {safe_repr(chain)}")
    ideal = None
    if idealise is not None:
        ideal = chain.idealised(idealise)
    n = len(chain.joint_names)
    rows: list[CountRow] = []
    if n >= 2:
        if plain(chain):
            rows += [
                CountRow(PAPER, m, "body", "printed", _words(m), printed(m, n), None)
                for m in PRINTED
            ]
        for group, method, frame, charged, what in _WAYS:
            J, both = (
                count(chain, method=method, frame=frame, counting=charged, pose=pose)
                for pose in (False, True)
            )
            rows.append(CountRow(group, method, frame, charged, what, J, both))
    arm = chain.compile()
    rows += _programs(arm, THIS)
    if ideal is not None:
        rows += _programs(ideal.chain.compile(), IDEAL)
    cheapest = None
    if n:
        cheapest = arm.cheapest
    return CountTable(
        chain.base, chain.tip, n, chain.dof, tuple(rows), ideal, cheapest, tuple(_verdict(chain))
    )


def printed(method: str, n: int) -> Count:
    """The paper's formula of a method of `PRINTED` for n revolute joints."""
    (a, b), (c, d) = PRINTED[method]
    return Count(multiplications=a * n - b, additions=c * n - d)


def plain(chain: Chain) -> bool:
    """Whether the paper's formulas speak of a chain: revolute joints only, each its own coordinate."""
    own = chain.coupling.shape == (chain.dof,) * 2 and bool(
        (chain.coupling == np.eye(chain.dof)).all()
    )
    return own and set(chain.kinds) == {"revolute"}


def _plain(row: CountRow) -> dict[str, Any]:
    """A row as plain dicts, numbers and texts."""
    names = ("group", "method", "frame", "counting", "what")
    plain = {name: getattr(row, name) for name in names}
    plain["jacobian"] = row.jacobian.as_dict()
    plain["with_pose"] = None
    if row.with_pose is not None:
        plain["with_pose"] = row.with_pose.as_dict()
    return plain


def _programs(arm: CompiledChain, group: str) -> Iterator[CountRow]:
    n = len(arm.joint_names)
    frames: list[str | int] = ["space", "body", "hybrid", *range(n)]
    if n:
        frames.append("cheapest")
    for frame in frames:
        what = f"{frame} Jacobian"
        if isinstance(frame, int):
            what = f"J in the frame of {arm.joint_names[frame]}"
        elif frame == "cheapest":
            what = f"J in the cheapest frame, that of {arm.joint_names[arm.cheapest.joint]}"
        J, both = (arm.program(frame, pose=pose).count for pose in (False, True))
        yield CountRow(group, "specialised", frame, "everything", what, J, both)


def _words(method: str) -> str:
    mult, add = (f"{a}n" + (f" - {b}" if b else "") for a, b in PRINTED[method])
    return {
        "direct": "POE, direct",
        "recursive": "POE, recursive",
        "dh_recursive": "DH, recursive",
    }[method] + (f": {mult} and {add}")


def _verdict(chain: Chain) -> Iterator[str]:
    """Sentences on the bookkeeping in the printed advantage, in this arm's own numbers."""
    if len(chain.kinds) < 2:
        return

    def of(method: str) -> Count:
        return count(chain, method=method, counting="paper")

    def gap(a: Count, b: Count) -> str:
        x = a.multiplications - b.multiplications
        y = a.additions - b.additions
        if x == y == 0:
            return "nothing"
        return f"{x} multiplications and {y} additions"

    poe = of("recursive")
    dh = of("dh_recursive")
    craig = of("dh_modified")
    paul = of("dh_paul")
    yield f"The paper's way of counting gives POE an advantage of {gap(dh, poe)} over DH."
    yield (
        "That is bookkeeping at the chain's two ends, not POE: DH is charged for a product with its first link, for "
        "one with a tool, and for one column more, POE for none of them. Charged alike, DH on modified frames costs "
        f"{gap(craig, poe)} more: it is the same recursion."
    )
    yield (
        f"On standard frames {gap(paul, poe)} stay, because there a joint moves before its link and not behind it. "
        f"A constant tool costs POE {gap(of('recursive_with_tool'), poe)}."
    )
    yield (
        f"With link frames attached anywhere, the recursion costs {gap(of('recursive_general_frames'), of('direct'))} "
        "more than the direct method."
    )
