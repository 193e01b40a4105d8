"""The paper's table of operation counts in full, for one arm: what it prints, leaves out, and what
can be had.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, Literal

from ...checks import choice
from ...model.chain import Chain
from ...model.geometry.idealise import Idealised
from ...model.kinematics.arm import Arm, chain_of
from ...model.kinematics.compiled import CompiledChain
from ...model.kinematics.pose_jacobian import AnyFrame
from ...model.kinematics.programs import CheapestFrame
from ...results import Result, plain
from .count import Count, Counting, CountMethod, count

Charged = Literal["printed", "paper", "live", "everything"]

PRINTED: dict[CountMethod, tuple[tuple[int, int], tuple[int, int]]] = {
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
class CountRow(Result):
    """Cost of one way to a Jacobian.

    Attributes
    ----------
    group : str
        Heading of `CountTable` that it is under.
    method, frame, counting : str
        Arguments of `count`; a frame may be the index of a joint.
    what : str
        Description of the method.
    jacobian, with_pose : Count
        Operations of J alone, and of J and the tool's pose (None where nobody printed it).
    """

    group: str
    method: CountMethod
    frame: AnyFrame
    counting: Charged
    what: str
    jacobian: Count
    with_pose: Count | None

    def summary(self) -> str:
        """Method, frame and operations.

        Returns
        -------
        text : str
            Line such as "POE, direct, body: 264 multiplications, 198 additions".
        """
        return f"{self.what}, {self.frame}: {self.jacobian}"


@dataclass(frozen=True)
class CountTable(Result):
    """Costs of one arm's Jacobian in every way that `count` knows; the result of `count_table`.

    Attributes
    ----------
    base, tip : str
        Names of the frames.
    joints, coordinates : int
        Numbers n and m.
    rows : tuple of CountRow
        Costs, group by group.
    idealised : Idealised or None
        The idealised arm whose rows there are.
    cheapest : CheapestFrame or None
        Frame that "cheapest" is, of the arm as it is.
    verdict : tuple of str
        Sentences on which part of the printed advantage over Denavit and Hartenberg is bookkeeping.
    """

    left_out: ClassVar = ("idealised", "cheapest")

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
        """Rows under a heading.

        Parameters
        ----------
        group : str
            One of `groups`.

        Returns
        -------
        rows : tuple of CountRow
            The rows in order.

        Raises
        ------
        InputError
            If there is no such heading.
        """
        choice(group, self.groups, "group")
        return tuple(row for row in self.rows if row.group == group)

    def summary(self) -> str:
        """Every row under its heading, and the verdict.

        Returns
        -------
        text : str
            One line each.
        """
        lines = [
            f"Operations of one Jacobian: {self.joints} joints, {self.coordinates} coordinates"
        ]
        for group in self.groups:
            lines += [f"{group}:", *(f"  {row}" for row in self.of(group))]
        return "\n".join([*lines, *self.verdict])

    def to_dict(self) -> dict[str, object]:
        """All counts, the meaning of their groups, the cheapest frame, and bounds of the idealising.

        Returns
        -------
        document : dict
            Dicts, lists, numbers and texts.
        """
        ideal = self.idealised
        return super().to_dict() | {
            "cheapest": plain(self.cheapest),
            "idealised": ideal
            and {
                "position_bound": ideal.position_bound,
                "rotation_bound": ideal.rotation_bound,
                "changes": list(ideal.changes),
            },
            "groups": {group: MEANING[group] for group in self.groups},
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

_WAYS: tuple[tuple[str, Counting, tuple[tuple[CountMethod, AnyFrame, str], ...]], ...] = (
    (COUNTINGS, "paper", (
        ("direct", "space", "POE, direct"),
        ("direct", "body", "POE, direct"),
        ("recursive", "body", "POE, recursive, tool in the last link's frame"),
        ("dh_recursive", "body", "DH, recursive: first link and tool charged"),
    )),
    (ALIKE, "paper", (
        ("recursive", "body", "POE, recursive"),
        ("dh_modified", "body", "DH, recursive on modified (Craig's) frames"),
        ("dh_paul", "body", "DH, recursive on standard (Paul's) frames"),
        ("recursive_with_tool", "body", "POE, recursive, a constant tool behind"),
        ("recursive_general_frames", "body", "POE, recursive, link frames attached anywhere"),
    )),
    (NEEDED, "live", (
        ("direct", "body", "POE, direct"),
        ("recursive", "body", "POE, recursive"),
        ("recursive_by_cross", "body", "POE, recursive, third columns by cross product"),
        ("dh_modified", "body", "DH, recursive on modified frames"),
        ("dh_paul", "body", "DH, recursive on standard frames"),
    )),
    (EVERYTHING, "everything", (
        ("direct", "space", "POE, direct, exponentials made"),
        ("recursive_with_tool", "body", "POE, recursive, z-aligned frames, tool"),
        ("recursive", "body", "POE, recursive, z-aligned frames, no tool"),
        ("dh_modified", "body", "DH, recursive on modified frames, no tool"),
        ("dh_recursive", "body", "DH, recursive on standard frames, tool"),
    )),
    (STRUCTURED, "live", (("structured", "body", "general links"),)),
)  # fmt: skip


def count_table(chain: Arm, *, idealise: float | None = None) -> CountTable:
    """Operation counts of one arm's Jacobian, in every way that `count` knows.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Arm of n joints; from n = 2 on the paper's methods are in the table, and the printed
        formulas where all joints are revolute and uncoupled.
    idealise : float, optional
        Tolerance, rad and m: the program of the idealised chain is counted too.

    Returns
    -------
    table : CountTable
        Rows of counts in groups.

    Raises
    ------
    InputError
        If `chain` is no Chain, or `idealise` out of range.

    Notes
    -----
    Accuracy: exact, by running; only the printed lines are formulas. Source: Park 1994, Section IV;
    the programs are those that `Chain.compile` runs.

    Examples
    --------
    >>> import poekin as pk
    >>> table = pk.count_table(pk.load("ur5e").chain(tip="tool0"))
    >>> print(table["recursive", "body", "paper"])
    POE, recursive, tool in the last link's frame, body: 174 multiplications, 123 additions
    """
    chain = chain_of(chain)
    ideal = None
    if idealise is not None:
        ideal = chain.idealised(idealise)
    n = len(chain.joint_names)
    rows: list[CountRow] = []
    if n >= 2:
        rows += _methods(chain)
    arm = chain.compile()
    rows += _programs(arm, THIS)
    if ideal is not None:
        rows += _programs(ideal.chain.compile(), IDEAL)
    cheapest = None
    if n:
        cheapest = arm.cheapest
    return CountTable(
        chain.base,
        chain.tip,
        n,
        chain.dof,
        tuple(rows),
        ideal,
        cheapest,
        tuple(_verdict(chain)),
    )


def _methods(chain: Chain) -> Iterator[CountRow]:
    """Rows of the paper's methods and of their variants."""
    if uncoupled_revolute(chain):
        for method in PRINTED:
            cost = printed(method, len(chain.joint_names))
            yield CountRow(PAPER, method, "body", "printed", _words(method), cost, None)
    for group, counting, ways in _WAYS:
        for method, frame, what in ways:
            J, both = (
                count(chain, method=method, frame=frame, counting=counting, pose=pose)
                for pose in (False, True)
            )
            yield CountRow(group, method, frame, counting, what, J, both)


def printed(method: CountMethod, n: int) -> Count:
    """The paper's formula of a method of `PRINTED` for n revolute joints."""
    (a, b), (c, d) = PRINTED[method]
    return Count(multiplications=a * n - b, additions=c * n - d)


def uncoupled_revolute(chain: Chain) -> bool:
    """Whether all joints are revolute, each its own coordinate, as in the paper's formulas."""
    return set(chain.kinds) == {"revolute"} and chain.nontrivial_coupling is None


def _programs(arm: CompiledChain, group: str) -> Iterator[CountRow]:
    n = len(arm.joint_names)
    frames: list[AnyFrame] = ["space", "body", "hybrid", *range(n)]
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


def _words(method: CountMethod) -> str:
    mult, add = (f"{a}n - {b}".removesuffix(" - 0") for a, b in PRINTED[method])
    names = {"direct": "POE, direct", "recursive": "POE, recursive"}
    return f"{names.get(method, 'DH, recursive')}: {mult} and {add}"


def _verdict(chain: Chain) -> Iterator[str]:
    """Sentences on the bookkeeping in the printed advantage, in this arm's own numbers."""
    if len(chain.kinds) < 2:
        return

    def of(method: CountMethod) -> Count:
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
