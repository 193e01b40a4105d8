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
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from poekin import algebra
from poekin.formulas.kinematics import recursive
from poekin.formulas.lie import exponential
from poekin.formulas.paper import dh_recursive, direct

from .chain_laws import adjoint, check_chain_bounds, displacements, inverse, of_poses, of_twists
from .laws import Law
from .measures import Pairs

Method = Callable[[Any, np.ndarray], tuple[np.ndarray, np.ndarray]]


def direct_space(chain: Any, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pose, and the body Jacobian (6, n) by way of the space Jacobian of the direct method."""
    exponentials = _exponentials(chain.space.screws, x)
    J = _rows(len(x))
    before = direct.space(chain.space.screws.tolist(), exponentials, len(x), J)
    last = exponentials[-1] if len(x) > 1 else algebra.IDENTITY
    T = _matrix(before) @ _matrix(last) @ chain.space.home
    return T, adjoint(inverse(T)) @ np.array(J)


def direct_body(chain: Any, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pose, and the body Jacobian (6, n) by the direct method."""
    exponentials = _exponentials(chain.body.screws, x)
    J = _rows(len(x))
    after = direct.body(chain.body.screws.tolist(), exponentials, len(x), J)
    first = exponentials[0] if len(x) > 1 else algebra.IDENTITY
    return chain.body.home @ _matrix(first) @ _matrix(after), np.array(J)


def recursive_with_tool(chain: Any, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pose, and the body Jacobian (6, n) by the recursion with the trailing tool."""
    links, rotates, slides, J = *_links(chain, x), _rows(len(x))
    seen = recursive.body_with_tool(
        links, _twelve(chain.local.frames[-1]), rotates, slides, len(x), J
    )
    return _matrix(links[0]) @ _matrix(seen), np.array(J)


def recursive_without_tool(chain: Any, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pose, and the body Jacobian (6, n) by the recursion as printed, the tool put behind it."""
    links, rotates, slides, J = *_links(chain, x), _rows(len(x))
    seen = recursive.body(links, rotates, slides, len(x), J)
    tool = chain.local.frames[-1]
    first = links[0] if len(x) > 1 else algebra.IDENTITY
    return _matrix(first) @ _matrix(seen) @ tool, adjoint(inverse(tool)) @ np.array(J)


def dh_recursion(chain: Any, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pose, and the body Jacobian (6, n) by the recursion of Orin and Schrader: A_i = e^{S x_i}
    M_{i+1}.
    """
    frames = chain.local.frames
    (_, rotates, slides) = _links(chain, x)
    J = _rows(len(x))
    turned = [
        _turned(np.eye(4), r, s, amount) for r, s, amount in zip(rotates, slides, x, strict=True)
    ]
    links = [algebra.compose(a, _twelve(M)) for a, M in zip(turned, frames[1:], strict=True)]
    T = dh_recursive.body(links, algebra.IDENTITY, rotates, slides, len(x), J)
    return frames[0] @ _matrix(T), np.array(J)


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
    chain: Any, q: np.ndarray, dq: np.ndarray, joint: int, methods: Mapping[str, Method] = METHODS
) -> float:
    """Direct = recursive = DH recursive, pose and Jacobian, and the V recursion; `joint` says that
    there is one.
    """
    x = displacements(chain, q)
    rates = chain.coupling @ dq
    pairs = Pairs()
    V = chain.jacobian(q, "body") @ dq
    for method in methods.values():
        T, J = method(chain, x)
        pairs += of_poses(chain, q, T, chain.fk(q)) + of_twists(chain, q, dq, J @ rates - V, 4.0)
    links, rotates, slides = _links(chain, x)
    tool = _twelve(chain.local.frames[-1])
    recursion = recursive.body_velocity(links, tool, rotates, slides, len(x), rates.tolist())
    pairs += of_twists(chain, q, dq, np.array(recursion) - V, 4.0)
    return check_chain_bounds("methods agree", chain, *pairs, q=q, dq=dq, joint=joint)


METHOD_LAWS = (Law(methods_agree, ("q", "dq", "joint")),)
"""The battery; its chains have a joint at least, as the algorithms ask."""


def _exponentials(screws: np.ndarray, x: np.ndarray) -> list[tuple[float, ...]]:
    return [
        exponential.joint(tuple(S[:3]), tuple(S[3:]), amount, math.sin(amount), math.cos(amount))
        for S, amount in zip(screws.tolist(), x.tolist(), strict=True)
    ]


def _links(chain: Any, x: np.ndarray) -> tuple[list[tuple[float, ...]], list[float], list[float]]:
    """f_{i-1,i} = M_i e^{S_i x_i}, and r and s of each joint's S = (0, 0, r; 0, 0, s)."""
    rotates = chain.local.rotates.tolist()
    slides = chain.local.slides.tolist()
    parts = zip(chain.local.frames[:-1], rotates, slides, x, strict=True)
    return [_turned(M, r, s, amount) for M, r, s, amount in parts], rotates, slides


def _turned(
    M: np.ndarray,
    r: float,
    s: float,
    x: float,
) -> tuple[float, ...]:
    return algebra.turned_about_z(_twelve(M), math.sin(r * x), math.cos(r * x), s * x)


def _twelve(T: np.ndarray) -> tuple[float, ...]:
    return algebra.pose_of(T[:3, :3].ravel().tolist(), T[:3, 3].tolist())


def _matrix(T: Any) -> np.ndarray:
    R = np.reshape(T[:9], (3, 3))
    p = np.reshape(T[9:], (3, 1))
    return np.block([[R, p], [np.zeros((1, 3)), np.ones((1, 1))]])


def _rows(n: int) -> list[list[float]]:
    return [[0.0] * n for _ in range(6)]
