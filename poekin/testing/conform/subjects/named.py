"""Subjects by name: the class that "MODULE:CLASS" names, and the Python that makes a subject where
it is pasted.
"""

from __future__ import annotations

import importlib
import inspect
import sys
from pathlib import Path
from typing import Any, NamedTuple

from ....errors import InputError, escape_unprintable, quote, suggest
from ..process.calls import Attempt


class SubjectSource(NamedTuple):
    """Lines of Python to have a subject's class, and the expression that makes the subject."""

    lines: tuple[str, ...]
    made: str


def parted(text: str) -> tuple[str, str]:
    """MODULE and NAME of a text "MODULE:NAME". Raises: InputError, with what may have been meant."""
    module, colon, name = text.partition(":")
    if not colon or not module or not name:
        raise InputError(f"expected MODULE:CLASS, such as my_arm:Kinematics, got {quote(text)}")
    if not all(
        part.isidentifier() for part in [*module.split("."), *name.split(".")]
    ) or module.endswith(".py"):
        parts = [
            part for part in Path(module.strip().removesuffix(".py")).parts if part.isidentifier()
        ]
        meant = f"{'.'.join(parts) or 'my_arm'}:{escape_unprintable(name.strip(': '), 80)}"
        raise InputError(
            f"expected MODULE:CLASS as Python imports it from this directory, such as {meant}; got {quote(text)}"
        )
    return module, name


def loaded(text: str) -> Any:
    """Class or object by its name.

    Parameters
    ----------
    text : str
        "MODULE:NAME", where NAME may be OUTER.INNER.

    Returns
    -------
    thing : object
        The class or object.

    Raises
    ------
    InputError
        If it cannot be imported, with what the import says.
    """
    module, name = parted(text)
    thing: Any = None
    with Attempt() as attempt:
        thing = importlib.import_module(module)
    if attempt.fault:
        said = f"the module {quote(module)} cannot be imported: {attempt.fault}"
        if attempt.place:
            said += f" ({attempt.place})"
        raise InputError(said)
    for part in name.split("."):
        if not hasattr(thing, part):
            near = suggest(part, _classes(thing))
            raise InputError(
                f"{quote(module)}{_file(module)} has no {quote(name)}; of its classes: {near}"
            )
        thing = getattr(thing, part)
    return thing


def source(thing: Any, text: str = "") -> SubjectSource:
    """Python that makes a subject: by "MODULE:NAME" where it was named so, else by what its class's
    module calls it.

    What cannot be reached from the top of a module is called as it is there.
    """
    is_class = inspect.isclass(thing)
    kind = type(thing)
    brackets = ""
    if is_class:
        kind = thing
        brackets = "()"
    module, _, name = text.partition(":")
    if not text:
        module = kind.__module__
        names = getattr(sys.modules.get(module), "__dict__", {})
        name = next((key for key, value in names.items() if value is thing), "")
        if not name and is_class and "<locals>" not in kind.__qualname__:
            name = kind.__qualname__
    if name:
        return SubjectSource(
            (f"from {_importable(module)} import {name.partition('.')[0]}",),
            f"{name}{brackets}",
        )
    if is_class:
        return SubjectSource((), f"{kind.__name__}()")
    return SubjectSource((), "subject")


def _importable(module: str) -> str:
    """The name by which another process imports a module, also the one that is run as a script."""
    if module != "__main__":
        return module
    main = sys.modules[module]
    spec = getattr(main, "__spec__", None)
    file = getattr(main, "__file__", None)
    if spec:
        return spec.name
    if file:
        return Path(file).stem
    return module


def _classes(thing: Any) -> list[str]:
    return [key for key, value in getattr(thing, "__dict__", {}).items() if inspect.isclass(value)]


def _file(module: str) -> str:
    """File of a module, since another one may have its name."""
    file = getattr(sys.modules.get(module), "__file__", None)
    if not file:
        return ""
    return f" ({quote(file, 200)})"
