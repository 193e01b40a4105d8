"""Cost of a Jacobian, found by running its algorithm on scalars that count or record."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, get_args

from ...checks import choice, true_or_false
from ...engine.count import Count
from ...engine.straight_line.specialise import cheapest_program
from ...errors import InputError, safe_repr
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ...model.kinematics.pose_jacobian import AnyFrame
from . import count_methods as methods
from . import count_scalars as scalars

__all__ = ["COUNTINGS", "METHODS", "Count", "count"]

Counting = Literal["paper", "live", "everything"]
CountMethod = Literal[
    "direct",
    "recursive",
    "recursive_with_tool",
    "recursive_by_cross",
    "recursive_general_frames",
    "dh_recursive",
    "dh_paul",
    "dh_modified",
    "structured",
    "specialised",
]
COUNTINGS: tuple[Counting, ...] = get_args(Counting)

Run = Callable[[Chain, Any, Counting, bool], Count]


@dataclass(frozen=True)
class Method:
    """A way to count a chain's Jacobian in some frames: run(chain, frame, counting, pose); what may
    be charged.
    """

    run: Run
    frames: tuple[str, ...] = ("body",)
    countings: tuple[Counting, ...] = COUNTINGS


def _general(algorithm: scalars.Algorithm, form: scalars.Form) -> Run:
    """An algorithm on links of a form."""

    def run(
        chain: Chain,
        _frame: Any,
        counting: Counting,
        pose: bool,
    ) -> Count:
        if counting == "paper":
            return scalars.paper_operations(algorithm, chain, pose)
        if counting == "live":
            return scalars.live_operations(algorithm, chain, pose)
        return scalars.all_operations(algorithm, form, chain, pose)

    return run


def _structured(
    chain: Chain,
    frame: Any,
    counting: Counting,
    pose: bool,
) -> Count:
    general = scalars.generic_structure(chain, tool=counting == "everything")
    return cheapest_program(general, frame, pose).count


def _specialised(
    chain: Chain,
    frame: Any,
    _counting: Counting,
    pose: bool,
) -> Count:
    return chain.compile().program(frame, pose=pose).count


_BODY: dict[CountMethod, tuple[scalars.Algorithm, scalars.Form]] = {
    "direct": (methods.direct_body, scalars.exponential),
    "recursive": (methods.z_aligned, scalars.z_link),
    "recursive_with_tool": (methods.with_tool, scalars.z_link),
    "recursive_by_cross": (methods.by_cross, scalars.z_link),
    "recursive_general_frames": (methods.general_frames, scalars.general_link),
    "dh_recursive": (methods.orin_schrader, scalars.paul_link),
    "dh_paul": (methods.paul, scalars.paul_link),
    "dh_modified": (methods.z_aligned, scalars.craig_link),
}
METHODS: dict[CountMethod, tuple[Method, ...]] = {
    **{name: (Method(_general(*way)),) for name, way in _BODY.items()},
    "structured": (Method(_structured, ("body", "space", "hybrid"), ("live", "everything")),),
    "specialised": (
        Method(_specialised, ("body", "space", "hybrid", "cheapest"), ("everything",)),
    ),
}
_IN_SPACE = _general(methods.direct_space, scalars.exponential)
METHODS["direct"] += (Method(_IN_SPACE, ("space",)),)


def count(
    chain: Arm,
    *,
    method: CountMethod = "recursive",
    frame: AnyFrame | None = "body",
    counting: Counting | None = None,
    pose: bool = False,
) -> Count:
    """Operations of one Jacobian, found by running the algorithm.

    Nothing here is a formula in n. All methods but "specialised" are about any chain of joints like
    these: of `chain` they take the kinds of the joints and the coupling, and every constant is
    general.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Arm of at least two joints (any number for "specialised").
    method : str, default "recursive"
        Algorithm, see Notes.
    frame : {"body", "space", "hybrid", "cheapest"}, int or None
        Frame of the Jacobian: "body"; "space" for "direct"; "structured" has "hybrid" too,
        "specialised" those, "cheapest", each joint's index k, and None, which is the pose alone.
    counting : {"paper", "live", "everything"}, optional
        Operations that are charged. "paper": all that the algorithm does, but not the making of the
        links' poses; "live": only those that reach an output; "everything": these and sines,
        cosines, links' poses, the coupling, and for "structured" a tool. By default "paper", for
        "structured" "live", for "specialised" "everything".
    pose : bool, default False
        Whether the same pass gives the tool's pose too.

    Returns
    -------
    cost : Count
        Multiplications, additions (subtractions among them), sines and cosines; divisions and
        square roots are 0. A constant times a constant and a change of sign cost nothing; adding
        angles costs additions.

    Raises
    ------
    InputError
        If `chain` is no Chain or too short, or method, frame, counting and pose do not go together.

    See Also
    --------
    count_table : The counts of one arm by every method.

    Notes
    -----
    Methods: "direct" (Section III); "recursive" (Section IV, z-aligned frames, the tool in the last
    link's frame), and the same "recursive_with_tool" (a constant tool behind), "recursive_by_cross"
    (third columns of rotations as cross products) or "recursive_general_frames" (link frames
    attached anywhere); "dh_recursive" (Orin and Schrader on Paul's frames, with a tool); with the
    bookkeeping of "recursive", "dh_paul" (Paul's frames) and "dh_modified" (Craig's); "structured"
    (two planar rotations a link, `formulas.kinematics.structured`); "specialised" (the
    straight-line program of this very arm, `Chain.compile`).

    Accuracy: exact, by running (tests/analysis/counting/test_count.py). Source: Park 1994,
    Section IV, the table: 60 n - 96 and 45 n - 72, 42 n - 78 and 30 n - 57, 42 n and 30 n.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> print(pk.count(arm, method="recursive"))
    174 multiplications, 123 additions
    >>> print(pk.count(arm, method="specialised", frame="body"))
    45 multiplications, 21 additions, 5 sines, 5 cosines
    """
    chain = chain_of(chain)
    true_or_false(pose, "pose")
    way = _way(method, frame)
    if counting is None:
        counting = way.countings[0]
    choice(counting, way.countings, "counting", f", for method {method!r}")
    n = len(chain.joint_names)
    if n < 2 and method != "specialised":
        raise InputError(f"method {method!r} counts from 2 joints on, the chain has {n}")
    return way.run(chain, frame, counting, pose)


def _way(method: object, frame: object) -> Method:
    if not isinstance(method, str) or method not in METHODS:
        raise InputError(f"no method {safe_repr(method)}; there are: {', '.join(METHODS)}")
    ways = METHODS[method]
    if method == "specialised":
        return ways[0]  # its program knows its frames, the joints' indices among them
    for way in ways:
        if isinstance(frame, str) and frame in way.frames:
            return way
    known = ", ".join(frame for way in ways for frame in way.frames)
    raise InputError(f"no method {method!r} in frame {safe_repr(frame)}; its frames: {known}")
