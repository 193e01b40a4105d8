"""Functions of Python and all that they call, as the text of static functions of C."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from .c_types import INT, CRow, CTable, CType, Structures
from .function_source import FunctionSource
from .statements import FunctionWriter
from .values import FUNCTION, Argument, CValue, Instance, number, scalar

_WIDEST = 110
_OF_NONE = "as Python has it: a where one is not a number."
_OTHER_SIGN = "a % b != 0 && (a % b < 0) != (b < 0)"
_HELPERS = {
    "max": ("double", _OF_NONE, "b > a ? b : a"),
    "min": ("double", _OF_NONE, "b < a ? b : a"),
    "Mod": (
        "int",
        "as Python has it: a % b of the sign of b.",
        f"{_OTHER_SIGN} ? a % b + b : a % b",
    ),
    "FloorDiv": ("int", "as Python has it: a / b, rounded down.", f"a / b - ({_OTHER_SIGN})"),
}
"""Type, comment and value of functions of two numbers."""


@dataclass(frozen=True)
class External:
    """A function of C that is written elsewhere: its name, and the positions of rows it writes to."""

    name: str
    writes: tuple[int, ...] = ()
    returns: CType | None = None


class TranslationUnit:
    """The functions of one file, all of whose names begin with `prefix`."""

    def __init__(self, prefix: str, external: Mapping[Callable, External] | None = None) -> None:
        self.prefix = prefix
        self.structures = Structures(prefix)
        self._external = dict(external or {})
        self._instances: dict[object, Instance | None] = {}
        self._sources: dict[Callable, FunctionSource] = {}
        self._names: set[str] = set()
        self._helpers: dict[str, str] = {}
        self._constants: dict[str, str] = {}

    def table(self, name: str, values: np.ndarray) -> Argument:
        """A constant table (n, m), or row (n,), as an argument: functions are written for it, and its
        numbers that are 0 or +-1 but for rounding are multiplied by and added nowhere.
        """
        values = np.array(values, np.float64)
        full = f"{self.prefix}_{name}"
        table = np.atleast_2d(values).tolist()
        rows = [", ".join(map(number, row)) for row in table]
        body = ",\n".join(f"    {row}" for row in rows)
        self._constants[full] = f"static const double {full}[{values.size}] = {{\n{body}\n}};"
        kind: CType
        if values.ndim == 1:
            kind = CRow(len(values))
        else:
            kind = CTable(*values.shape)
        told = CValue(kind, full, constant=values, fixed=True)
        return Argument(kind, told)

    def function(self, function: Callable) -> Argument:
        """A function as an argument."""
        name = f"{function.__module__}.{function.__qualname__}"
        told = CValue(FUNCTION, name, constant=function, fixed=True)
        return Argument(FUNCTION, told)

    def integer(self, value: int) -> Argument:
        """A known integer as an argument: functions are written for it."""
        return Argument(INT, scalar(value, INT, True))

    def instance(self, function: Callable, arguments: list[Argument]) -> Instance | None:
        """The function for these arguments, None while it is being written."""
        key = (function, tuple(argument.key for argument in arguments))
        if key in self._instances:
            return self._instances[key]
        if function in self._external:
            found = self._outside(self._external[function], len(arguments))
            self._instances[key] = found
            return found
        self._instances[key] = None
        if function not in self._sources:
            self._sources[function] = FunctionSource(function)
        source = self._sources[function]
        instance = Instance(self._name(function), source.parameters, [])
        FunctionWriter(source, self, arguments).write(instance)
        if source.summary:
            instance.text = f"/* {_plain(source.summary)} */\n{instance.text}"
        self._instances[key] = instance
        return instance

    def _outside(self, external: External, count: int) -> Instance:
        names = [f"p{k}" for k in range(count)]
        written = {names[k] for k in external.writes}
        return Instance(external.name, names, names, external.returns, written=written)

    def _name(self, function: Callable) -> str:
        module = function.__module__.split(".")[-1].strip("_")
        stem = f"{self.prefix}_{module}_{function.__name__.strip('_')}"
        name = stem
        count = 1
        while name in self._names:
            count += 1
            name = f"{stem}_{count}"
        self._names.add(name)
        return name

    def helper(self, name: str) -> str:
        """C name of max or min, of NaN as Python has it, and Numba, or of Mod or FloorDiv."""
        full = f"{self.prefix}_{name.lower()}"
        kind, what, value = _HELPERS[name]
        self._helpers[full] = (
            f"/* {name.lower()}(a, b) {what} */\n"
            f"static inline {kind} {full}({kind} a, {kind} b)\n{{\n    return {value};\n}}"
        )
        return full

    def tuple_constant(self, function: Callable, name: str, value: CValue) -> CValue:
        """A module's tuple of numbers by its name in C."""
        module = function.__module__.split(".")[-1].strip("_")
        full = f"{self.prefix}_{module}_{name.strip('_')}"
        initial = value.text[value.text.index("{") :]
        spelled = self.structures.spell(value.type)
        self._constants[full] = f"static const {spelled} {full} = {initial};"
        return CValue(value.type, full, constant=value.constant)

    def text(self, entries: Iterable[Instance]) -> str:
        """Structures, constants and functions that the entries need, each before its use."""
        ordered: dict[Instance, None] = {}
        for entry in entries:
            _add(entry, ordered)
        functions = [instance.text for instance in ordered if instance.text]
        whole = "\n".join(functions)
        constants = _used_in(whole, self._constants)
        helpers = _used_in(whole, self._helpers)
        structures = self.structures.used_in("\n".join([*constants, whole]))
        parts = ["\n".join(structures), *constants, *helpers, *functions]
        return wrapped("\n\n".join(part for part in parts if part))


def wrapped(text: str) -> str:
    """The text with lines of at most 110 characters."""
    lines = []
    for line in text.splitlines():
        start = line[: len(line) - len(line.lstrip())]
        more = f"{start} * " if line.startswith("/*") else f"{start}        "
        parts = textwrap.wrap(
            line.strip(),
            _WIDEST,
            initial_indent=start,
            subsequent_indent=more.replace("/", " "),
            break_long_words=False,
            break_on_hyphens=False,
        )
        lines += parts or [""]
    return "\n".join(lines)


def _add(instance: Instance, ordered: dict[Instance, None]) -> None:
    if instance not in ordered:
        for called in instance.called:
            _add(called, ordered)
        ordered[instance] = None


def _used_in(text: str, definitions: dict[str, str]) -> list[str]:
    """The definitions whose names stand in a text."""
    return [
        definition
        for name, definition in definitions.items()
        if any(f"{name}{end}" in text for end in " ()[],.;")
    ]


def _plain(text: str) -> str:
    """Words for a comment in ASCII, which cannot end it."""
    plain = text.encode("ascii", "xmlcharrefreplace").decode("ascii")
    for special, harmless in (("*/", "* /"), ("/*", "/ *"), ("\\", "/"), ("??", "? ?")):
        plain = plain.replace(special, harmless)
    return plain
