"""A group as the subject of its laws: a record of those functions that there are; a wrong one can
be put in.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from ...errors import InputError, safe_repr

Function = Callable[..., Any]


class Absent:
    """A function that a subject does not have; who calls it is told so, by its name. Raises:
    InputError.
    """

    def __init__(self, name: str):
        self.name = name

    def __repr__(self) -> str:
        return "absent"

    def __call__(
        self,
        *arguments: Any,
        **options: Any,
    ) -> Any:
        """Never returns. Parameters: arguments, options, of any kind. Raises: InputError."""
        raise InputError(
            f"this law needs the function {self.name}, and the group under test was made without it"
        )


class Group(NamedTuple):
    """The functions of a group, as the subject of its laws; `_replace(exp=…)` puts another one in.

    Fields: size, the length of its twists, 3 for SO(3), 6 for SE(3); the functions, named and
    shaped as in
    `poekin.so3` and `poekin.se3` (hat, vee, exp, log, inverse, adjoint, ad, left_jacobian,
    right_jacobian, left_jacobian_inverse, right_jacobian_inverse), of single arrays: twists (size,)
    are ω or (ω; v), in rad and m, elements (3, 3) or poses (4, 4) of a frame in the base frame. One
    that is left out is asked for by name by the laws that need it.

        Group(6, exp=my_exp, log=my_log)
    """

    size: int
    hat: Function = Absent("hat")
    vee: Function = Absent("vee")
    exp: Function = Absent("exp")
    log: Function = Absent("log")
    inverse: Function = Absent("inverse")
    adjoint: Function = Absent("adjoint")
    ad: Function = Absent("ad")
    left_jacobian: Function = Absent("left_jacobian")
    right_jacobian: Function = Absent("right_jacobian")
    left_jacobian_inverse: Function = Absent("left_jacobian_inverse")
    right_jacobian_inverse: Function = Absent("right_jacobian_inverse")


def make_group(module: Any, size: int) -> Group:
    """The Group of a module or object with some of its functions, such as `poekin.so3` (3) or
    `poekin.se3` (6).

    Parameters: module; size, 3 or 6. Returns: Group, of the functions that are there.
    Raises: InputError for another size, and where there is none of the functions.
    """
    if size not in (3, 6):
        raise InputError(f"size: expected 3 for SO(3) or 6 for SE(3), got {safe_repr(size)}")
    found = {name: f for name in Group._fields[1:] if callable(f := getattr(module, name, None))}
    if not found:
        raise InputError(
            f"{safe_repr(module)} has none of the functions of a group: {', '.join(Group._fields[1:])}"
        )
    return Group(size, **found)
