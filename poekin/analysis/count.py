"""What a Jacobian costs, found by running its algorithm on scalars that count."""

from __future__ import annotations

from collections.abc import Callable

from ..engine.count import Count, Counted, counted
from ..errors import InputError, told
from ..formulas import dh_recursive, direct, recursive
from ..model.chain import Chain

__all__ = ["METHODS", "count"]


def count(chain: Chain, *, method: str = "recursive", frame: str = "body") -> Count:
    """Operations of one Jacobian of a chain of this many joints, as the paper charges them.

    The algorithm itself runs, on scalars that count; every number that depends on q counts as variable, and so does
    every entry of a link's pose, whatever its value. Making the links' poses (sines, cosines, exponentials) is not
    charged, as in the paper's table.

    Parameters
    ----------
    chain: of n >= 2 joints; its joints' kinds matter (a column of a prismatic joint costs less).
    method: "direct" (Section III), "recursive" (Section IV, z-aligned frames, the tool in the last link's frame),
        "recursive_with_tool" (with the constant tool behind it) or "dh_recursive" (Orin and Schrader).
    frame: "body", or "space" for the direct method.

    Returns: Count, with .multiplications and .additions. Raises: InputError. Accuracy: exact, by running.
    Source: Park 1994, Section IV, the table: 60 n - 96 and 45 n - 72, 42 n - 78 and 30 n - 57, 42 n and 30 n.
    """
    if not isinstance(chain, Chain):
        raise InputError(f"expected a Chain, as Robot.chain makes it, got {told(chain)}")
    words = isinstance(method, str) and isinstance(frame, str)
    algorithm = METHODS.get((method, frame)) if words else None
    if algorithm is None:
        known = ", ".join(f"{m} in {f}" for m, f in METHODS)
        raise InputError(f"no method {told(method)} in frame {told(frame)}; there are: {known}")
    n = len(chain.joint_names)
    if n < 2:
        raise InputError(f"the paper's counts hold from 2 joints on, the chain has {n}")
    total = Count()
    algorithm(chain, n, total)
    return total


def _poses(n: int, total: Count) -> list[tuple[Counted, ...]]:
    """n poses whose twelve numbers are variables; the algorithms never look at a value."""
    return [counted((1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.1, 0.2, 0.3), total) for _ in range(n)]


def _structure(chain: Chain) -> tuple[list, list]:
    """r and s of the joints, 0 and 1 as integers."""
    rows = (chain.local.rotates, chain.local.slides)
    return tuple([int(x) if x in (0.0, 1.0) else float(x) for x in row] for row in rows)  # type: ignore[return-value]


def _rows(n: int) -> list[list]:
    return [[0.0] * n for _ in range(6)]


def _direct_space(chain: Chain, n: int, total: Count) -> None:
    direct.space(chain.space.screws.tolist(), _poses(n, total), n, _rows(n))


def _direct_body(chain: Chain, n: int, total: Count) -> None:
    direct.body(chain.body.screws.tolist(), _poses(n, total), n, _rows(n))


def _recursive(chain: Chain, n: int, total: Count) -> None:
    recursive.body(_poses(n, total), *_structure(chain), n, _rows(n))


def _recursive_with_tool(chain: Chain, n: int, total: Count) -> None:
    recursive.body_with_tool(_poses(n, total), _tool(chain), *_structure(chain), n, _rows(n))


def _dh_recursive(chain: Chain, n: int, total: Count) -> None:
    dh_recursive.body(_poses(n, total), _tool(chain), *_structure(chain), n, _rows(n))


def _tool(chain: Chain) -> tuple[float, ...]:
    T = chain.local.frames[-1]
    return (*T[:3, :3].ravel().tolist(), *T[:3, 3].tolist())


METHODS: dict[tuple[str, str], Callable[[Chain, int, Count], None]] = {
    ("direct", "space"): _direct_space,
    ("direct", "body"): _direct_body,
    ("recursive", "body"): _recursive,
    ("recursive_with_tool", "body"): _recursive_with_tool,
    ("dh_recursive", "body"): _dh_recursive,
}
