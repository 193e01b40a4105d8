"""Chains and robots as short HTML tables, which a notebook shows where they end a cell."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from ...groups.vectors import angular_part, linear_part
from ...html_page import caption, row, table
from ..chain_data import ChainData
from ..joint import Joint

_OF_CHAIN = ("joint", "kind", "ω", "v, m", "limits, rad or m")
_OF_ROBOT = ("joint", "kind", "parent", "child", "limits, rad or m", "follows")
UNLIMITED = (-math.inf, math.inf)
ROWS = 60
"""Rows of the longest table; of more joints the number is said."""


def chain_table(chain: ChainData) -> str:
    """Screws of a chain in the base frame, joint by joint."""
    rows = []
    limits = dict(zip(chain.q_names, chain.limits, strict=True))
    for name, kind, screw in zip(chain.joint_names, chain.kinds, chain.screws, strict=True):
        bounds = limits.get(name, UNLIMITED)
        rows.append(
            (
                name,
                kind,
                numbers(angular_part(screw)),
                numbers(linear_part(screw)),
                _interval(bounds),
            )
        )
    words = f"Chain {chain.base} → {chain.tip}, space screws at q = 0, reach {chain.reach:.3g} m"
    return _with_caption(words, _OF_CHAIN, rows)


def robot_table(name: str, joints: Iterable[Joint]) -> str:
    """Joints of a robot."""
    rows = []
    for joint in joints:
        follows = ""
        if joint.mimic is not None:
            follows = joint.mimic.joint
        limits = _interval(joint.limits)
        rows.append((joint.name, joint.kind, joint.parent, joint.child, limits, follows))
    return _with_caption(f"Robot {name}", _OF_ROBOT, rows)


def numbers(values: Iterable[float], between: str = ", ") -> str:
    """Numbers for reading, to four digits; -0 is 0."""
    return between.join(f"{float(value) + 0.0:.4g}" for value in values)


def _interval(limits: Iterable[float]) -> str:
    """Limits as text, nothing for a joint without."""
    if tuple(limits) == UNLIMITED:
        return ""
    return numbers(limits, " … ")


def _with_caption(words: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    kinds = ["word"] * len(heads)
    lines = [row(cells, kinds) for cells in rows[:ROWS]]
    if len(rows) > ROWS:
        words += f"; the first {ROWS} of {len(rows)} joints"
    return caption(words) + table(heads, kinds, lines)
