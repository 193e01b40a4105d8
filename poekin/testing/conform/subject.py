"""A subject: a small class of somebody's functions, and what it declares about their meaning. Nothing is guessed.

    class Mine:
        twist_order = "angular first"       # or "linear first": of every twist in and out, and of rows of Jacobians
        jacobian_frame = "body"             # or "space", "hybrid": of `jacobian`

        def exp(self, xi): ...              # (6,) -> (4, 4)

What a subject may have, each with unbatched arrays in and out, rad and m:

    so3_exp(w) (3,) -> (3, 3); so3_log(R); so3_left_jacobian(w) (3,) -> (3, 3), so3_right_jacobian, and the same with
        _inverse: none of them needs a declaration
    exp(xi) (6,) -> (4, 4); log(T); adjoint(T) (4, 4) -> (6, 6); left_jacobian(xi) (6,) -> (6, 6), right_jacobian, and
        the same with _inverse: these need `twist_order`
    fk(screws, home, q): screws (n, 6) in the base frame, home (4, 4), q (n,) -> T_sb (4, 4): `twist_order`
    jacobian(screws, home, q) -> (6, n): `twist_order` and `jacobian_frame`
    read_urdf(text, base, tip) -> an object with `names` (its coordinates in order), `fk(q)` -> the pose (4, 4) of the
        link tip in the link base; where `jacobian_frame` is declared, also `jacobian(q)` (6, len(names))

With `arm`, a `poekin.Chain`, declared, fk(q) and jacobian(q) are those of this one arm. More declarations: `batch`,
True where exp, log and the Jacobians of exp take leading axes; `noise`, up to which the entries of a rotation may be
off for log to return the logarithm of the nearest rotation (0: not asked); `name` and `version`, for the report;
`paste`, of a function by its name, a Python text that makes the same call of an argument `x`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from ...errors import InputError, shown, told
from ...groups import se3
from ...model.chain import Chain
from ...model.evaluation import FRAME_NAMES

ORDERS = ("angular first", "linear first")
JACOBIANS = tuple(f"{side}_jacobian{inverse}" for inverse in ("", "_inverse") for side in ("left", "right"))
SO3 = ("so3_exp", "so3_log", *(f"so3_{name}" for name in JACOBIANS))
SE3 = ("exp", "log", "adjoint", *JACOBIANS)
ARMS = ("fk", "jacobian")
FUNCTIONS = (*SO3, *SE3, *ARMS, "read_urdf")

Function = Callable[..., Any]


class Subject:
    """A subject's functions with twists as (omega; v), and its declarations, checked.

    Parameters: thing, a class without parameters or an object, as the module's text says.
    Raises: InputError where it has none of the functions, or a declaration is missing or none of the words expected.
    """

    def __init__(self, thing: Any):
        self.own: Any = thing() if inspect.isclass(thing) else thing
        kind = thing if inspect.isclass(thing) else type(thing)
        self.title = kind.__name__
        self.module = kind.__module__
        self.functions = tuple(name for name in FUNCTIONS if callable(getattr(self.own, name, None)))
        if not self.functions:
            raise InputError(f"{self.title} has none of the functions of a subject: {', '.join(FUNCTIONS)}")
        self.name = str(getattr(self.own, "name", self.title))
        self.version = str(getattr(self.own, "version", ""))
        self.noise = _number(self, "noise")
        self.batch = getattr(self.own, "batch", False) is True
        self.arm: Chain | None = getattr(self.own, "arm", None)
        if not isinstance(self.arm, Chain | None):
            raise InputError(f"{self.title}: arm: expected a poekin.Chain, got {told(self.arm)}")
        twisted = [name for name in self.functions if name in SE3 or name in ARMS]
        if twisted == ["fk"] and self.arm is not None:
            twisted = []  # of one arm, known to poekin: no twist goes in or comes out
        self.linear_first = bool(twisted) and self._declared("twist_order", ORDERS, twisted[0]) == "linear first"
        read = "read_urdf" in self.functions and getattr(self.own, "jacobian_frame", None) is not None
        if read and not twisted:  # what it reads has a Jacobian
            self.linear_first = self._declared("twist_order", ORDERS, "jacobian_frame") == "linear first"
        framed = read or "jacobian" in self.functions
        self.frame = self._declared("jacobian_frame", FRAME_NAMES, "jacobian") if framed else ""
        for name in ARMS:
            self._check_parameters(name)

    def _declared(self, what: str, words: tuple[str, ...], function: str) -> str:
        value = getattr(self.own, what, None)
        choice = " or ".join(f'"{word}"' for word in words)
        if value is None:
            raise InputError(f"{self.title} has {function}, and does not declare {what}: expected {what} = {choice}")
        if value not in words:
            raise InputError(f"{self.title}: {what}: expected {choice}, got {told(value)}")
        return str(value)

    def _check_parameters(self, name: str) -> None:
        if name not in self.functions:
            return
        expected = "q" if self.arm is not None else "screws, home, q"
        try:
            inspect.signature(getattr(self.own, name)).bind(*expected.split(", "))
        except TypeError:
            hint = "with `arm` declared" if self.arm is not None else "(declare `arm` for fk(q) of one arm)"
            raise InputError(f"{self.title}: {name}: expected parameters ({expected}) {hint}") from None
        except ValueError:  # compiled, without a signature
            return

    @property
    def label(self) -> str:
        """Name and version."""
        return f"{self.name} {self.version}".strip()

    def twist(self, x: np.ndarray) -> np.ndarray:
        """(omega; v), on the last axis, in the subject's order, and back."""
        return se3.linear_first(x) if self.linear_first else x

    def square(self, X: np.ndarray) -> np.ndarray:
        """A matrix (..., 6, 6) between twists in the subject's order, and back."""
        return se3.linear_first(se3.linear_first(X, axis=-2)) if self.linear_first else X

    def rows(self, J: np.ndarray) -> np.ndarray:
        """A Jacobian (6, m), its rows in the subject's order, and back."""
        return se3.linear_first(J, axis=-2) if self.linear_first else J

    def function(self, name: str) -> Function:
        """A function of a group with twists as (omega; v)."""
        own = getattr(self.own, name)
        if name in SO3:
            return own
        enters = (lambda x: x) if name in ("log", "adjoint") else self.twist
        leaves = {"exp": lambda x: x, "log": self.twist}.get(name, self.square)
        size = {"exp": (4, 4), "log": (6,)}.get(name, (6, 6))

        def ordered(x: np.ndarray) -> Any:
            result = np.asarray(own(enters(x)), dtype=float)
            # A wrong shape is for the judge to see, as it came.
            return leaves(result) if result.shape[-len(size) :] == size else result

        return ordered

    def own_text(self, name: str, **arguments: str) -> str:
        """Python that calls a function of the subject; the values of the arguments are Python texts."""
        text = getattr(self.own, "paste", {}).get(name)
        if text is not None:
            lines = [f"{key} = {value}" for key, value in arguments.items()]
            return "; ".join(["import numpy as np", *lines, str(text)])
        values = ", ".join(arguments.values())
        return f"import numpy as np; from {self.module} import {self.title}; print({self.title}().{name}({values}))"


def _number(subject: Subject, what: str) -> float:
    value = getattr(subject.own, what, 0.0)
    if not isinstance(value, int | float) or not 0 <= value <= 1e-5:
        raise InputError(f"{subject.title}: {what}: expected a number from 0 to 1e-5, got {told(value)}")
    return float(value)


def loaded(text: str) -> Any:
    """The class or object that "MODULE:NAME" names.

    Raises: InputError where it cannot be imported, with what the import says.
    """
    import importlib

    from .calls import Attempt

    module, colon, name = text.partition(":")
    if not colon or not module or not name:
        raise InputError(f"expected MODULE:CLASS, such as my_arm:Kinematics, got {shown(text)}")
    found: Any = None
    with Attempt() as attempt:
        found = importlib.import_module(module)
    if attempt.fault:
        raise InputError(f"the module {shown(module)} cannot be imported: {attempt.fault}")
    if not hasattr(found, name):
        classes = [key for key, value in vars(found).items() if inspect.isclass(value)]
        raise InputError(f"{shown(module)} has no {shown(name)}; classes in it: {', '.join(map(shown, classes))}")
    return getattr(found, name)
