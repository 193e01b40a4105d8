"""Hypothesis strategies for serial chains: screws of all joint kinds, chains with and without coupling, coordinates."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from poekin.model.chain import Chain

from .reader import Reader
from .strategies import Arrays, axes, frozen, poses, read, st, vectors

KINDS = ("revolute", "prismatic", "helical")
REACHES = (1e-3, 3.0)
QUARTERS = (0.0, math.pi / 2, -math.pi / 2, math.pi)
RATIOS = (1.0, -1.0, 0.5, -2.0, 0.0)


@functools.cache
def points() -> Arrays:
    """Points of an arm (3,) in m: the origin, or at a log-uniform distance of 1 mm to 3 m."""
    return vectors(REACHES)


@functools.cache
def screws(kinds: tuple[str, ...] = KINDS) -> Arrays:
    """Screws (6,) of joints: axis, point and pitch (1 mm to 1 m per rad, either sign) independent of each other."""

    def screw(kind: str, axis: np.ndarray, point: np.ndarray, pitch: float) -> np.ndarray:
        if kind == "prismatic":
            return frozen([0, 0, 0, *axis])
        return frozen([*axis, *(np.cross(point, axis) + (pitch * axis if kind == "helical" else 0))])

    pitches = read(5, lambda r: r.pick([1.0, -1.0]) * max(r.magnitude(1e-3, 1.0), 1e-3))
    return st.builds(screw, read(1, lambda r: r.pick(kinds)), axes(), points(), pitches)


@functools.cache
def placements() -> Arrays:
    """Poses (4, 4) of frames of an arm: any rotation, and an origin as in `points`."""
    return poses(REACHES)


@st.composite
def chains(
    draw: st.DrawFn,
    min_joints: int = 0,
    max_joints: int = 12,
    joint_kinds: tuple[str, ...] = KINDS,
    coupled: bool | None = None,
    offsets: bool = True,
) -> Chain:
    """Chains of any joint kinds; shrinks towards no joint, revolute joints about x through the origin, and M = I.

    coupled: joints may follow a coordinate by a ratio (also 0: they stand still), with an offset unless `offsets` is
    False; None draws both coupled and uncoupled chains.
    """
    n = draw(read(1, lambda r: r.pick(range(min_joints, max_joints + 1))))
    A = [draw(screws(joint_kinds)) for _ in range(n)]
    home = draw(placements())
    if n == 0 or not (draw(st.booleans()) if coupled is None else coupled):
        return Chain(np.reshape(A, (n, 6)), home)
    m = draw(st.integers(1, n))
    C, c = np.zeros((n, m)), np.zeros(n)
    # The first m joints are masters in an order of their own; the others follow one of them.
    for i in range(n):
        C[i, i if i < m else draw(st.integers(0, m - 1))] = 1.0 if i < m else draw(st.sampled_from(RATIOS))
        c[i] = draw(read(3, lambda r: r.fraction(-1.0, 1.0))) if offsets else 0.0
    order = list(draw(st.permutations(range(n))))
    return Chain(A, home, coupling=C[order], offset=c[order])


def coordinates(chain: Chain, shape: Sequence[int] = ()) -> Arrays:
    """Configurations (*shape, m) of a chain: 0, quarter turns, and anything up to ±π (rad or m)."""
    count = math.prod(shape) * chain.dof

    def value(r: Reader) -> float:
        return r.pick(QUARTERS) if r.byte() < 64 else r.fraction(-math.pi, math.pi)

    return read(4 * count, lambda r: frozen(np.reshape([value(r) for _ in range(count)], (*shape, chain.dof))))


@st.composite
def chain_cases(draw: st.DrawFn, kinds: Sequence[str], **options: Any) -> tuple[Any, ...]:
    """A chain (`chains(**options)`) and the arguments of its law by their kinds (`laws.Law`).

    "q", "dq": configuration and rates (m,); "batch": configurations (*shape, m); "pose": a pose (4, 4); "point": a
    point (3,); "joint": the number of a joint (of a chain that has one); "frames": poses (n, 2, 4, 4), to re-attach
    the frame of each joint and of each link.
    """
    chain = draw(chains(**{"min_joints": 1, **options} if "joint" in kinds else options))
    n = len(chain.screws)
    drawn: list[Any] = []
    for kind in kinds:
        if kind in ("q", "dq"):
            drawn.append(draw(coordinates(chain)))
        elif kind == "batch":
            drawn.append(draw(coordinates(chain, draw(st.sampled_from([(), (0,), (1,), (3, 1, 2)])))))
        elif kind == "pose":
            drawn.append(draw(placements()))
        elif kind == "point":
            drawn.append(draw(points()))
        elif kind == "joint":
            drawn.append(draw(st.integers(0, n - 1)))
        elif kind == "frames":
            drawn.append(frozen(np.reshape([draw(placements()) for _ in range(2 * n)], (n, 2, 4, 4))))
        else:
            raise ValueError(f"no such kind of argument: {kind!r}")
    return (chain, *drawn)
