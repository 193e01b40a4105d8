"""A group as the subject of its laws: one record of functions, so that a wrong one can be put in."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

Function = Callable[..., Any]


class Group(NamedTuple):
    """The functions of a group, as the subject of its laws; `_replace(exp=…)` plants an error.

    `size` is the length of its twists: 3 for SO(3), 6 for SE(3). The rest is named and shaped as in `poekin.se3`.
    """

    size: int
    hat: Function
    vee: Function
    exp: Function
    log: Function
    inverse: Function
    adjoint: Function
    ad: Function
    left_jacobian: Function
    right_jacobian: Function
    left_jacobian_inverse: Function
    right_jacobian_inverse: Function


def group_of(module: Any, size: int) -> Group:
    """The Group of a module or object that has its functions, such as `poekin.so3` (3) or `poekin.se3` (6)."""
    return Group(size, *(getattr(module, name) for name in Group._fields[1:]))
