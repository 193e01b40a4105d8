"""Every algorithm for the Jacobian is one Jacobian: `METHODS`, each as floats, and the law that
they agree.

Parameters: chain, a `poekin.Chain` with a joint at least; x (n,), displacements of its joints, q,
dq (m,), coordinates and rates, rad or m, and per s; joint, not used; methods, by their names.
Returns: of a method the pose (4, 4) of the tool in the base frame, and the body Jacobian (6, n); of
the law error ÷ bound, 0 to 1.
Raises: LawViolation above 1, with the law, the error, its bound, the arguments, and the chain's
numbers.
Source: Park 1994, Sections III and IV: the direct method, the recursion on z-aligned link frames
(with the trailing tool, and without), and the recursion of Orin and Schrader on the frames of
Denavit and Hartenberg.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from poekin import algebra
from poekin.formulas.kinematics import recursive
from poekin.formulas.lie import exponential
from poekin.formulas.paper import dh_recursive, direct
from poekin.testing.laws.laws import Law, Pairs
from tests.model.laws.chain_bounds import (
    adjoint,
    check_chain_bounds,
    inverse,
    of_poses,
    of_twists,
)

Method = Callable[[Any, np.ndarray], tuple[np.ndarray, np.ndarray]]


def direct_space(chain: Any, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pose, and the body Jacobian (6, n) by way of the space Jacobian of the direct method."""
    screws = chain.space.screws
    exponentials = _exponentials(screws, x)
    J = _rows(len(x))
    before = direct.space(screws.tolist(), exponentials, len(x), J)
    T = _matrix(before) @ _of_several(exponentials, -1) @ chain.space.home
    return T, adjoint(inverse(T)) @ np.array(J)


def direct_body(chain: Any, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pose, and the body Jacobian (6, n) by the direct method."""
    screws = chain.body.screws
    exponentials = _exponentials(screws, x)
    J = _rows(len(x))
    after = direct.body(screws.tolist(), exponentials, len(x), J)
    T = chain.body.home @ _of_several(exponentials, 0) @ _matrix(after)
    return T, np.array(J)


def recursive_with_tool(chain: Any, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pose, and the body Jacobian (6, n) by the recursion with the trailing tool."""
    links = _links(chain, x)
    tool = _twelve(chain.local.frames[-1])
    J = _rows(len(x))
    seen = recursive.body_with_tool(links.poses, tool, links.rotates, links.slides, len(x), J)
    return _matrix(links.poses[0]) @ _matrix(seen), np.array(J)


def recursive_without_tool(chain: Any, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pose, and the body Jacobian (6, n) by the recursion as printed, the tool put behind it."""
    links = _links(chain, x)
    tool = chain.local.frames[-1]
    J = _rows(len(x))
    seen = recursive.body(links.poses, links.rotates, links.slides, len(x), J)
    T = _of_several(links.poses, 0) @ _matrix(seen) @ tool
    return T, adjoint(inverse(tool)) @ np.array(J)


def dh_recursion(chain: Any, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pose, and the body Jacobian (6, n) by the recursion of Orin and Schrader: A_i = e^{S x_i}
    M_{i+1}.
    """
    first, *frames = chain.local.frames
    rotates = chain.local.rotates.tolist()
    slides = chain.local.slides.tolist()
    J = _rows(len(x))
    links = []
    for r, s, amount, M in zip(rotates, slides, x, frames, strict=True):
        turned = _turned(np.eye(4), r, s, amount)
        links.append(algebra.compose(turned, _twelve(M)))
    T = dh_recursive.body(links, algebra.IDENTITY, rotates, slides, len(x), J)
    return first @ _matrix(T), np.array(J)


METHODS: Mapping[str, Method] = MappingProxyType(
    {
        "direct, space": direct_space,
        "direct, body": direct_body,
        "recursive with tool": recursive_with_tool,
        "recursive": recursive_without_tool,
        "DH recursive": dh_recursion,
    }
)


def methods_agree(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
    joint: int,
    methods: Mapping[str, Method] = METHODS,
) -> float:
    """Direct = recursive = DH recursive, pose and Jacobian, and the V recursion; `joint` says that
    there is one.
    """
    x = chain.coupling @ q + chain.offset
    rates = chain.coupling @ dq
    pairs = Pairs()
    V = chain.jacobian(q, "body") @ dq
    for method in methods.values():
        T, J = method(chain, x)
        pairs += of_poses(chain, q, T, chain.fk(q))
        pairs += of_twists(chain, q, dq, J @ rates - V, 4.0)
    links = _links(chain, x)
    tool = _twelve(chain.local.frames[-1])
    recursion = recursive.body_velocity(
        links.poses,
        tool,
        links.rotates,
        links.slides,
        len(x),
        rates.tolist(),
    )
    pairs += of_twists(chain, q, dq, np.array(recursion) - V, 4.0)
    return check_chain_bounds("methods agree", chain, *pairs, q=q, dq=dq, joint=joint)


METHOD_LAWS = (Law(methods_agree, ("q", "dq", "joint")),)
"""The battery; its chains have a joint at least, as the algorithms ask."""


def _exponentials(screws: np.ndarray, x: np.ndarray) -> list[tuple[float, ...]]:
    exponentials = []
    for S, amount in zip(screws.tolist(), x.tolist(), strict=True):
        w = tuple(S[:3])
        v = tuple(S[3:])
        exponentials.append(exponential.joint(w, v, amount, math.sin(amount), math.cos(amount)))
    return exponentials


class _Links(NamedTuple):
    """f_{i-1,i} = M_i e^{S_i x_i}, and r and s of each joint's S = (0, 0, r; 0, 0, s)."""

    poses: list[tuple[float, ...]]
    rotates: list[float]
    slides: list[float]


def _links(chain: Any, x: np.ndarray) -> _Links:
    rotates = chain.local.rotates.tolist()
    slides = chain.local.slides.tolist()
    joints = zip(chain.local.frames[:-1], rotates, slides, x, strict=True)
    poses = [_turned(M, r, s, amount) for M, r, s, amount in joints]
    return _Links(poses, rotates, slides)


def _of_several(poses: Sequence[tuple[float, ...]], place: int) -> np.ndarray:
    """The pose at a place, as a matrix; the identity where it is the only one."""
    if len(poses) == 1:
        return np.eye(4)
    return _matrix(poses[place])


def _turned(
    M: np.ndarray,
    r: float,
    s: float,
    x: float,
) -> tuple[float, ...]:
    return algebra.turned_about_z(_twelve(M), math.sin(r * x), math.cos(r * x), s * x)


def _twelve(T: np.ndarray) -> tuple[float, ...]:
    return algebra.make_pose(T[:3, :3].ravel().tolist(), T[:3, 3].tolist())


def _matrix(T: Any) -> np.ndarray:
    R = np.reshape(T[:9], (3, 3))
    p = np.reshape(T[9:], (3, 1))
    return np.block([[R, p], [np.zeros((1, 3)), np.ones((1, 1))]])


def _rows(n: int) -> list[list[float]]:
    return [[0.0] * n for _ in range(6)]
