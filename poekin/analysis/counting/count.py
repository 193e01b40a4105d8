"""Cost of a Jacobian, found by running its algorithm on scalars that count or record."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ...engine.count import Count
from ...engine.straight_line.specialise import specialised
from ...errors import InputError, safe_repr
from ...model.chain import Chain
from . import count_methods as methods
from . import count_scalars as scalars

__all__ = ["COUNTINGS", "METHODS", "Count", "count"]

COUNTINGS = ("paper", "live", "everything")


Run = Callable[[Chain, Any, str, bool], Count]


@dataclass(frozen=True)
class Method:
    """A way to count a chain's Jacobian in some frames: run(chain, frame, counting, pose); what may
    be charged.
    """

    run: Run
    frames: tuple[str, ...] = ("body",)
    countings: tuple[str, ...] = COUNTINGS


def _general(algorithm: scalars.Algorithm, form: scalars.Form) -> Run:
    """An algorithm on links of a form."""

    def run(chain: Chain, frame: Any, counting: str, pose: bool) -> Count:
        if counting == "paper":
            return scalars.paper_operations(algorithm, chain, pose)
        if counting == "live":
            return scalars.live_operations(algorithm, chain, pose)
        return scalars.all_operations(algorithm, form, chain, pose)

    return run


def _structured(chain: Chain, frame: Any, counting: str, pose: bool) -> Count:
    return specialised(
        scalars.generic_structure(chain, tool=counting == "everything"), frame, pose
    ).count


def _specialised(chain: Chain, frame: Any, counting: str, pose: bool) -> Count:
    return chain.compile().program(frame, pose=pose).count


METHODS: dict[str, tuple[Method, ...]] = {
    "direct": (
        Method(_general(methods.direct_body, scalars.exponential)),
        Method(_general(methods.direct_space, scalars.exponential), ("space",)),
    ),
    "recursive": (Method(_general(methods.z_aligned, scalars.z_link)),),
    "recursive_with_tool": (Method(_general(methods.with_tool, scalars.z_link)),),
    "recursive_by_cross": (Method(_general(methods.by_cross, scalars.z_link)),),
    "recursive_general_frames": (Method(_general(methods.general_frames, scalars.general_link)),),
    "dh_recursive": (Method(_general(methods.orin_schrader, scalars.paul_link)),),
    "dh_paul": (Method(_general(methods.paul, scalars.paul_link)),),
    "dh_modified": (Method(_general(methods.z_aligned, scalars.craig_link)),),
    "structured": (Method(_structured, ("body", "space", "hybrid"), ("live", "everything")),),
    "specialised": (
        Method(_specialised, ("body", "space", "hybrid", "cheapest"), ("everything",)),
    ),
}


def count(
    chain: Chain,
    *,
    method: str = "recursive",
    frame: str | int | None = "body",
    counting: str | None = None,
    pose: bool = False,
) -> Count:
    """Operations of one Jacobian, found by running the algorithm: nothing here is a formula in n.

    All methods but "specialised" are about any chain of joints like these: of `chain` they take the
    kinds of the joints and the coupling, and every constant is general.

    Parameters
    ----------
    chain: of n >= 2 joints (any number for "specialised").
    method: "direct" (Section III); "recursive" (Section IV, z-aligned frames, the tool in the last
        link's frame), and the same "recursive_with_tool" (a constant tool behind),
        "recursive_by_cross" (third columns of rotations as cross products) or
        "recursive_general_frames" (link frames attached anywhere); "dh_recursive" (Orin and
        Schrader on Paul's frames, with a tool); with the bookkeeping of "recursive" "dh_paul"
        (Paul's frames) and "dh_modified" (Craig's); "structured" (two planar rotations a link,
        `formulas.kinematics.structured`); "specialised" (the straight-line program of this very
        arm, `Chain.compile`).
    frame: "body"; "space" for "direct"; "structured" has "hybrid" too, "specialised" those,
        "cheapest", each joint's index k, and None, which is the pose alone.
    counting: "paper": all that the algorithm does, but not the making of the links' poses; "live":
        only what reaches an output; "everything": that and sines, cosines, links' poses, the
        coupling, and for "structured" a tool.
        By default "paper", for "structured" "live", for "specialised" "everything".
    pose: the tool's pose too, out of the same pass.

    Returns: Count: multiplications, additions (subtractions among them), sines, cosines; divisions
    and square roots are 0. A constant times a constant and a change of sign cost nothing; adding
    angles costs additions.
    Raises: InputError, UnknownName for a frame. Accuracy: exact, by running
    (tests/analysis/counting/test_count.py). Source: Park 1994, Section IV, the table: 60 n - 96 and
    45 n - 72, 42 n - 78 and 30 n - 57, 42 n and 30 n.
    """
    if not isinstance(chain, Chain):
        raise InputError(f"expected a Chain, as Robot.chain makes it, got {safe_repr(chain)}")
    if not isinstance(pose, bool):
        raise InputError(f"pose: expected True or False, got {safe_repr(pose)}")
    way = _way(method, frame)
    if counting is None:
        counting = way.countings[0]
    elif not isinstance(counting, str) or counting not in way.countings:
        raise InputError(
            f"counting: expected {' or '.join(way.countings)} for method {method!r}, got {safe_repr(counting)}"
        )
    n = len(chain.joint_names)
    if n < 2 and method != "specialised":
        raise InputError(f"method {method!r} counts from 2 joints on, the chain has {n}")
    return way.run(chain, frame, counting, pose)


def _way(method: object, frame: object) -> Method:
    ways = METHODS.get(method) if isinstance(method, str) else None
    if ways is None:
        raise InputError(f"no method {safe_repr(method)}; there are: {', '.join(METHODS)}")
    if method == "specialised":
        return ways[0]  # its program knows its frames, the joints' indices among them
    for way in ways:
        if isinstance(frame, str) and frame in way.frames:
            return way
    known = ", ".join(frame for way in ways for frame in way.frames)
    raise InputError(f"no method {method!r} in frame {safe_repr(frame)}; its frames: {known}")
