"""A group as the subject of its laws: a record of those functions that there are; a wrong one can
be put in.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from ...errors import InputError, safe_repr

Function = Callable[..., Any]


class Absent:
    """Function that a subject does not have; a call of it is refused by its name.

    Parameters
    ----------
    name : str
        Name of the function.

    Raises
    ------
    InputError
        If it is called.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def __repr__(self) -> str:
        return "absent"

    def __call__(self, *_: Any, **__: Any) -> Any:
        """Refuse the call, whatever the arguments are.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(
            f"this law needs the function {self.name}, and the group under test was made without it"
        )


class Group(NamedTuple):
    """Functions of SO(3) or SE(3), as the subject of their laws.

    They are named and shaped as in `poekin.so3` and `poekin.se3`, and take single arrays: twists
    (size,) are ω or (ω; v), in rad and m, elements rotations (3, 3) or poses (4, 4) of a frame in the
    base frame. One that is left out is asked for by name by the laws that need it; `_replace(exp=…)`
    puts another one in.

    Parameters
    ----------
    size : {3, 6}
        Length of the twists, 3 for SO(3), 6 for SE(3).
    hat, vee : callable, optional
        Matrix of a twist, and the twist of a matrix.
    exp, log : callable, optional
        Exponential and logarithm.
    inverse, adjoint, ad : callable, optional
        Inverse of an element, its adjoint matrix, and the matrix of the Lie bracket.
    left_jacobian, right_jacobian : callable, optional
        Jacobians of exp.
    left_jacobian_inverse, right_jacobian_inverse : callable, optional
        Their inverses.

    Examples
    --------
    >>> import poekin as pk
    >>> from poekin.testing.laws.group import Group
    >>> Group(6, exp=pk.se3.exp, log=pk.se3.log).inverse
    absent
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
    """Group of the functions that a module or object has.

    Parameters
    ----------
    module : module or object
        Holder of functions named as in `Group`, such as `poekin.so3` or `poekin.se3`.
    size : {3, 6}
        Length of the twists, 3 for SO(3), 6 for SE(3).

    Returns
    -------
    group : Group
        The functions that are there.

    Raises
    ------
    InputError
        For another size, and if there is none of the functions.
    """
    if size not in (3, 6):
        raise InputError(f"size: expected 3 for SO(3) or 6 for SE(3), got {safe_repr(size)}")
    found = {name: f for name in Group._fields[1:] if callable(f := getattr(module, name, None))}
    if not found:
        raise InputError(
            f"{safe_repr(module)} has none of the functions of a group: {', '.join(Group._fields[1:])}"
        )
    return Group(size, **found)
