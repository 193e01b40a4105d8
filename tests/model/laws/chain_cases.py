"""Arguments of the laws of a chain, drawn by their kinds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from hypothesis import strategies as st

from poekin.model.chain import Chain
from poekin.testing.strategies import arguments
from poekin.testing.strategies.batch_strategies import batch_shapes
from poekin.testing.strategies.chain_strategies import chains, coordinates, placements, points
from poekin.testing.strategies.group_strategies import frozen

PARTS = ("q", "dq", "batch", "pose", "point", "joint", "frames")
"""What a law of a chain may ask for."""


def chain_cases(
    kinds: Sequence[str],
    **options: Any,
) -> st.SearchStrategy[tuple[Any, ...]]:
    """Chains with the arguments of their law, by their kinds."""
    parts: tuple[str, ...] = ()
    if kinds:
        parts = arguments.some("kinds", kinds, PARTS)
    if "joint" in parts:
        options = {"min_joints": 1, **options}
    return _cases(parts, chains(**options))


@st.composite
def _cases(
    draw: st.DrawFn,
    kinds: tuple[str, ...],
    some: st.SearchStrategy[Chain],
) -> tuple[Any, ...]:
    chain = draw(some)
    n = len(chain.screws)
    drawn: list[Any] = []
    for kind in kinds:
        if kind in ("q", "dq"):
            drawn.append(draw(coordinates(chain)))
        elif kind == "batch":
            drawn.append(draw(coordinates(chain, draw(batch_shapes()))))
        elif kind == "pose":
            drawn.append(draw(placements()))
        elif kind == "point":
            drawn.append(draw(points()))
        elif kind == "joint":
            drawn.append(draw(st.integers(0, n - 1)))
        else:
            drawn.append(
                frozen(np.reshape([draw(placements()) for _ in range(2 * n)], (n, 2, 4, 4)))
            )
    return (chain, *drawn)
