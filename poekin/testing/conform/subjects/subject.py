"""A subject: a small class of somebody's functions, and what it declares about their meaning.
Nothing is guessed.

    class Mine:
        twist_order = "angular first"       # or "linear first": of every twist in and out, and of
        rows of Jacobians jacobian_frame = "body"             # or "space", "hybrid": of `jacobian`

        def exp(self, xi): ...              # (6,) -> (4, 4)

What a subject may have, each with unbatched arrays in and out, rad and m:

    so3_exp(w) (3,) -> (3, 3); so3_log(R); so3_left_jacobian(w) (3,) -> (3, 3), so3_right_jacobian,
        and the same with _inverse: none of them needs a declaration
    exp(xi) (6,) -> (4, 4); log(T); adjoint(T) (4, 4) -> (6, 6); left_jacobian(xi) (6,) -> (6, 6),
        right_jacobian, and the same with _inverse: these need `twist_order`
    fk(screws, home, q): screws (n, 6) in the base frame, home (4, 4), q (n,) -> T_sb (4, 4):
    `twist_order` jacobian(screws, home, q) -> (6, n): `twist_order` and `jacobian_frame`
    read_urdf(text, base, tip) -> an object with `names` (of coordinates, in the order of q: those
        that the pose depends on, or more), `fk(q)` -> the pose (4, 4) of the link tip in the link
        base; where `jacobian_frame` is declared, also `jacobian(q)` (6, len(names))
    read_robot(text) -> an object with `names`, and `poses(q)` -> of each link by its name the pose
    (4, 4) in the root

With `arm`, a `poekin.Chain`, declared, fk(q) and jacobian(q) are those of this one arm. More
declarations: `batch`, True where exp, log and the Jacobians of exp take leading axes; `helical`,
True where fk and jacobian take screws with a pitch; `noise`, up to which the entries of a rotation
may be off for log to return the logarithm of the nearest rotation (0: not asked); `precision`,
"float64" or "float32", what it computes in (default: the type of its results: one in float32 gets
arguments that float32 can hold, and bounds with u = 2⁻²⁴); `name` and `version`, for the report;
`paste`, of a function by its name, a Python text that makes the same call of an argument `x`.

A function that writes into an argument is broken: an array is its caller's.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ....errors import InputError, safe_repr
from ....groups import se3
from ....model.chain import Chain
from ....model.kinematics.pose_jacobian import FRAME_NAMES
from ..process.calls import made, real, untouched
from .misspelt import misspelt
from .named import Source, loaded, source
from .precision import DOUBLE, PRECISIONS, Precision, seen

ORDERS = ("angular first", "linear first")
JACOBIANS = tuple(
    f"{side}_jacobian{inverse}" for inverse in ("", "_inverse") for side in ("left", "right")
)
SO3 = ("so3_exp", "so3_log", *(f"so3_{name}" for name in JACOBIANS))
SE3 = ("exp", "log", "adjoint", *JACOBIANS)
ARMS = ("fk", "jacobian")
PARAMETERS = {
    **dict.fromkeys(SO3, "w"),
    **dict.fromkeys(SE3, "xi"),
    "so3_log": "R",
    "log": "T",
    "adjoint": "T",
    "read_urdf": "text, base, tip",
    "read_robot": "text",
}
FUNCTIONS = (*SO3, *SE3, *ARMS, "read_urdf", "read_robot")
DECLARATIONS = (
    "twist_order",
    "jacobian_frame",
    "arm",
    "batch",
    "helical",
    "noise",
    "precision",
    "name",
    "version",
    "paste",
)

Function = Callable[..., Any]


class Subject:
    """A subject's functions with twists as (omega; v), and its declarations, checked.

    Parameters: thing, a class without parameters or an object, as the module's text says, or
    "MODULE:NAME" of one. Raises: InputError where it cannot be made, has none of the functions or
    one with other parameters, or a
    declaration is missing or none of the words expected; as `named.loaded`.
    """

    def __init__(self, thing: Any):
        where = ""
        if isinstance(thing, str):
            where = thing
            thing = loaded(where)
        self.source: Source = source(thing, where)
        self.title = type(thing).__name__
        self.own: Any = thing
        if inspect.isclass(thing):
            self.title = thing.__name__
            self.own, fault = made(thing)
            if fault:
                raise InputError(f"{self.title} cannot be made as {self.title}(): {fault}")
        self.functions = tuple(name for name in FUNCTIONS if callable(self._attribute(name)))
        self.misspelt = misspelt(self.own, (*FUNCTIONS, *DECLARATIONS))
        if not self.functions:
            names = "; ".join([", ".join(FUNCTIONS), *self.misspelt])
            raise InputError(f"{self.title} has none of the functions of a subject: {names}")
        self.name = str(self._attribute("name") or self.title)
        self.version = str(self._attribute("version") or "")
        self.noise = self._noise()
        self.pastes = self._pastes()
        self.declared: Precision | None = None
        if self._attribute("precision") is not None:
            self.declared = PRECISIONS[self._declared("precision", (*PRECISIONS,), "results")]
        self._seen: dict[str, Precision] = {}
        self.batch = self._flag("batch")
        self.helical = self._flag("helical")
        self.arm: Chain | None = self._attribute("arm")
        if not isinstance(self.arm, Chain | None):
            raise InputError(
                f"{self.title}: arm: expected a poekin.Chain, got {safe_repr(self.arm)}"
            )
        for name in self.functions:
            self._check_parameters(name)
        self.linear_first = False
        self.frame = ""
        self._declare_conventions()

    def _declare_conventions(self) -> None:
        """Set the order of twists and the frame of Jacobians, as far as any function needs them."""
        twisted = [name for name in self.functions if name in SE3 or name in ARMS]
        if twisted == ["fk"] and self.arm is not None:
            twisted = []  # of one arm, known to poekin: no twist goes in or comes out
        read = "read_urdf" in self.functions and self._attribute("jacobian_frame") is not None
        if read and not twisted:  # what it reads has a Jacobian
            twisted = ["jacobian_frame"]
        if twisted:
            self.linear_first = self._declared("twist_order", ORDERS, twisted[0]) == ORDERS[1]
        if read or "jacobian" in self.functions:
            self.frame = self._declared("jacobian_frame", FRAME_NAMES, "jacobian")

    def __getstate__(self) -> dict[str, Any]:
        # What another process is told of a subject: all but the subject itself.
        return {key: value for key, value in vars(self).items() if key != "own"}

    def _pastes(self) -> dict[str, str]:
        value = self._attribute("paste")
        if not isinstance(value, Mapping | None):
            raise InputError(
                f"{self.title}: paste: expected a text for each function, got {safe_repr(value)}"
            )
        return {str(name): str(text) for name, text in (value or {}).items()}

    def _attribute(self, name: str) -> Any:
        value, fault = made(lambda: getattr(self.own, name, None))
        if fault:
            raise InputError(f"{self.title}: {name}: {fault}")
        return value

    def _declared(
        self,
        what: str,
        words: tuple[str, ...],
        function: str,
    ) -> str:
        value = self._attribute(what)
        choice = " or ".join(f'"{word}"' for word in words)
        if value is None:
            raise InputError(
                f"{self.title} has {function}, and does not declare {what}: expected {what} = {choice}"
            )
        if not isinstance(value, str) or value not in words:
            raise InputError(f"{self.title}: {what}: expected {choice}, got {safe_repr(value)}")
        return value

    def _flag(self, what: str) -> bool:
        value = self._attribute(what)
        if not isinstance(value, bool | None):
            raise InputError(
                f"{self.title}: {what}: expected True or False, got {safe_repr(value)}"
            )
        return bool(value)

    def _noise(self) -> float:
        value = self._attribute("noise")
        if value is None:
            return 0.0
        if not isinstance(value, int | float) or not 0 <= value <= 1e-5:
            raise InputError(
                f"{self.title}: noise: expected a number from 0 to 1e-5, got {safe_repr(value)}"
            )
        return float(value)

    def _check_parameters(self, name: str) -> None:
        hint = ""
        if name in ARMS:
            expected = "screws, home, q"
            hint = " (declare `arm` for fk(q) of one arm)"
            if self.arm is not None:
                expected = "q"
                hint = " with `arm` declared"
        else:
            expected = PARAMETERS[name]
        function = getattr(self.own, name)
        try:
            given = inspect.signature(function)
            given.bind(*expected.split(", "))
        except TypeError:
            raise InputError(
                f"{self.title}: {name}: expected parameters ({expected}){hint}, got {given}"
            ) from None
        except (
            ValueError
        ):  # compiled, without a signature; or a method that does not even take itself
            if inspect.ismethod(function):
                raise InputError(
                    f"{self.title}: {name}: expected parameters (self, {expected}), got none"
                ) from None

    def precision(self, name: str) -> Precision:
        """The precision of a function: as declared, else that of its results so far.

        Parameters: name, one of `FUNCTIONS`. Returns: `precision.Precision`. Raises: nothing.
        """
        return self.declared or self._seen.get(name, DOUBLE)

    def noted(
        self,
        name: str,
        value: Any,
    ) -> Any:
        """The result of a function, whose precision is remembered.

        Parameters: name, one of `FUNCTIONS`; value, the result. Returns: the value. Raises:
        nothing.
        """
        self._seen.setdefault(name, seen(value))
        return value

    @property
    def label(self) -> str:
        """Name and version."""
        return f"{self.name} {self.version}".strip()

    def twist(self, x: np.ndarray) -> np.ndarray:
        """Twists x (..., 6), (omega; v), of any frame, in the subject's order, and back.

        Returns: the same shape. Source: `poekin.se3.linear_first`.
        """
        if not self.linear_first:
            return x
        return se3.linear_first(x)

    def square(self, X: np.ndarray) -> np.ndarray:
        """A matrix X (..., 6, 6) between twists of one frame in the subject's order, and back.

        Returns: the same shape. Source: `poekin.se3.linear_first`.
        """
        return self.twist(self.rows(X))

    def rows(self, J: np.ndarray) -> np.ndarray:
        """A Jacobian J (6, m), of any frame, its rows in the subject's order, and back.

        Returns: the same shape. Source: `poekin.se3.linear_first`.
        """
        if not self.linear_first:
            return J
        return se3.linear_first(J, axis=-2)

    def plain(self, name: str) -> Function:
        """A function as the subject has it, but that it raises ArgumentChanged where it writes into
        an argument.

        Parameters: name, one of `FUNCTIONS`. Returns: the function, in the subject's own order.
        Raises: AttributeError where the subject has none.
        """
        function = untouched(getattr(self.own, name))
        return lambda *arguments: self.noted(name, function(*arguments))

    def function(self, name: str) -> Function:
        """The function of a group of that name, with twists as (omega; v)."""
        own = self.plain(name)
        if name in SO3:
            return own
        if name == "exp":
            return lambda x: own(self.twist(x))

        def ordered(x: np.ndarray) -> Any:
            if name not in ("log", "adjoint"):
                x = self.twist(x)
            result = real(own(x))
            if name == "log" and result.shape[-1:] == (6,):
                return self.twist(result)
            if name != "log" and result.shape[-2:] == (6, 6):
                return self.square(result)
            return result  # of a wrong shape, which the judge sees as it came

        return ordered

    def call(
        self,
        name: str,
        **arguments: str,
    ) -> str:
        """Python that calls a function of the subject and prints its result.

        Parameters: name, of the function; arguments, Python texts by their names. Returns: the
        text.
        """
        text = self.pastes.get(name)
        if text is not None:
            lines = [f"{key} = {value}" for key, value in arguments.items()]
            return "; ".join(["import numpy as np", *lines, str(text)])
        values = ", ".join(arguments.values())
        return "; ".join(
            [
                "import numpy as np",
                *self.source.lines,
                printed(f"{self.source.made}.{name}({values})"),
            ]
        )


def printed(text: str) -> str:
    """Python that prints the array of a Python text as lists, to the last digit."""
    return f"print(np.asarray({text}).tolist())"
