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
from collections.abc import Callable
from typing import Any, Literal, get_args

import numpy as np

from ....errors import InputError
from ....groups import se3
from ....model.kinematics.pose_jacobian import FRAME_NAMES
from ..process.calls import made, real, untouched
from .declarations import Declarations
from .misspelt import misspelt
from .named import SubjectSource, loaded, source
from .precision import DOUBLE, PRECISIONS, Precision, seen

ORDERS = ("angular first", "linear first")
JacobianName = Literal[
    "left_jacobian",
    "right_jacobian",
    "left_jacobian_inverse",
    "right_jacobian_inverse",
]
JACOBIANS: tuple[JacobianName, ...] = get_args(JacobianName)
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
    """Functions of a subject with twists as (ω; v), and its declarations, checked.

    Parameters
    ----------
    thing : type, object or str
        Class without parameters or object, as the module's text says, or "MODULE:NAME" of one.

    Raises
    ------
    InputError
        If it cannot be imported or made, has none of the functions or one with other parameters, or
        if a declaration is missing or none of the words expected.

    Examples
    --------
    >>> import poekin as pk
    >>> from poekin.testing.conform import Subject
    >>> class Mine:
    ...     twist_order = "angular first"
    ...     def exp(self, xi):
    ...         return pk.se3.exp(xi)
    >>> Subject(Mine).functions
    ('exp',)
    """

    def __init__(self, thing: Any) -> None:
        where = ""
        if isinstance(thing, str):
            where = thing
            thing = loaded(where)
        self.source: SubjectSource = source(thing, where)
        self.title = type(thing).__name__
        self.own: Any = thing
        if inspect.isclass(thing):
            self.title = thing.__name__
            self.own, fault = made(thing)
            if fault:
                raise InputError(f"{self.title} cannot be made as {self.title}(): {fault}")
        has = Declarations(self.title, self.own)
        self.functions = tuple(name for name in FUNCTIONS if callable(has.attribute(name)))
        self.misspelt = misspelt(self.own, (*FUNCTIONS, *DECLARATIONS))
        if not self.functions:
            names = "; ".join([", ".join(FUNCTIONS), *self.misspelt])
            raise InputError(f"{self.title} has none of the functions of a subject: {names}")
        self.name = str(has.attribute("name") or self.title)
        self.version = str(has.attribute("version") or "")
        self.noise = has.noise()
        self.pastes = has.pastes()
        self.declared: Precision | None = None
        if has.attribute("precision") is not None:
            self.declared = PRECISIONS[has.choice("precision", (*PRECISIONS,), "results")]
        self._seen: dict[str, Precision] = {}
        self.batch = has.flag("batch")
        self.helical = has.flag("helical")
        self.arm = has.arm()
        for name in self.functions:
            has.check_parameters(name, *self._parameters(name))
        self.linear_first = False
        self.frame = ""
        self._declare_conventions(has)

    def _parameters(self, name: str) -> tuple[str, str]:
        """Parameters expected of a function, and a hint on them."""
        if name not in ARMS:
            return PARAMETERS[name], ""
        if self.arm is None:
            return "screws, home, q", " (declare `arm` for fk(q) of one arm)"
        return "q", " with `arm` declared"

    def _declare_conventions(self, has: Declarations) -> None:
        """Set the order of twists and the frame of Jacobians, as far as any function needs them."""
        twisted = [name for name in self.functions if name in SE3 or name in ARMS]
        if twisted == ["fk"] and self.arm is not None:
            twisted = []  # of one arm, known to poekin: no twist goes in or comes out
        read = "read_urdf" in self.functions and has.attribute("jacobian_frame") is not None
        if read and not twisted:  # what it reads has a Jacobian
            twisted = ["jacobian_frame"]
        if twisted:
            self.linear_first = has.choice("twist_order", ORDERS, twisted[0]) == ORDERS[1]
        if read or "jacobian" in self.functions:
            self.frame = has.choice("jacobian_frame", FRAME_NAMES, "jacobian")

    def __getstate__(self) -> dict[str, Any]:
        # Another process is told all of a subject but the subject itself.
        return {key: value for key, value in vars(self).items() if key != "own"}

    def precision(self, name: str) -> Precision:
        """Precision of a function: as declared, else that of its results so far.

        Parameters
        ----------
        name : str
            Name of the function, of `FUNCTIONS`.

        Returns
        -------
        precision : Precision
            The precision.
        """
        return self.declared or self._seen.get(name, DOUBLE)

    def noted(
        self,
        name: str,
        value: Any,
    ) -> Any:
        """Result of a function, whose precision is remembered.

        Parameters
        ----------
        name : str
            Name of the function, of `FUNCTIONS`.
        value : object
            The result.

        Returns
        -------
        value : object
            The same.
        """
        self._seen.setdefault(name, seen(value))
        return value

    @property
    def label(self) -> str:
        """Name and version."""
        return f"{self.name} {self.version}".strip()

    def twist(self, x: np.ndarray) -> np.ndarray:
        """Twists in the subject's order, and back.

        Parameters
        ----------
        x : (..., 6) ndarray
            Twists (ω; v) of any frame, rad and m.

        Returns
        -------
        x : (..., 6) ndarray
            Twists in the subject's order.

        Notes
        -----
        Source: `poekin.se3.linear_first`.
        """
        if not self.linear_first:
            return x
        return se3.linear_first(x)

    def square(self, X: np.ndarray) -> np.ndarray:
        """Matrices between twists of one frame in the subject's order, and back.

        Parameters
        ----------
        X : (..., 6, 6) ndarray
            Matrices between twists (ω; v), rad and m.

        Returns
        -------
        X : (..., 6, 6) ndarray
            Matrices in the subject's order.

        Notes
        -----
        Source: `poekin.se3.linear_first`.
        """
        return self.twist(self.rows(X))

    def rows(self, J: np.ndarray) -> np.ndarray:
        """Jacobians of any frame with rows in the subject's order, and back.

        Parameters
        ----------
        J : (6, m) ndarray
            Jacobian with rows (ω; v), rad and m per unit of a coordinate.

        Returns
        -------
        J : (6, m) ndarray
            Jacobian with rows in the subject's order.

        Notes
        -----
        Source: `poekin.se3.linear_first`.
        """
        if not self.linear_first:
            return J
        return se3.linear_first(J, axis=-2)

    def plain(self, name: str) -> Function:
        """Function as the subject has it, which raises where it writes into an argument.

        Parameters
        ----------
        name : str
            Name of the function, of `FUNCTIONS`.

        Returns
        -------
        function : callable
            The function, in the subject's own order; it raises ArgumentChanged where it leaves other numbers
            in an argument.

        Raises
        ------
        AttributeError
            If the subject has none.
        """
        function = untouched(getattr(self.own, name))
        return lambda *arguments: self.noted(name, function(*arguments))

    def function(self, name: str) -> Function:
        """Function of a group of that name, with twists as (ω; v).

        Parameters
        ----------
        name : str
            Name of the function, of `FUNCTIONS`.

        Returns
        -------
        function : callable
            The function.

        Raises
        ------
        AttributeError
            If the subject has none.
        """
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

        Parameters
        ----------
        name : str
            Name of the function, of `FUNCTIONS`.
        **arguments : str
            Python texts by their names.

        Returns
        -------
        text : str
            The Python, in one line.
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
