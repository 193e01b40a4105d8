"""Robots out of the FILE arguments of commands, read by `load` or, on request, by xacro."""

from __future__ import annotations

import functools
import inspect
import os
from collections.abc import Callable, Sequence
from contextvars import ContextVar
from typing import Annotated, Any

from typer import Option

from ..errors import InputError, quote, suggest
from ..formats.load import load
from ..formats.xacro import is_xacro
from ..formats.xacro import xacro as evaluate_xacro
from ..model.robot import Robot

XACRO_HELP = "Evaluate each FILE that is xacro: this runs the expressions in it, so only do it with files you trust."
Xacro = Annotated[bool, Option("--xacro", help=XACRO_HELP)]
Given = Annotated[
    list[str] | None,
    Option(
        "--xacro-arg",
        metavar="NAME=VALUE",
        help="With --xacro: the value of a <xacro:arg>; may be repeated.",
    ),
]
OPTIONS = ("--xacro", "--xacro-arg")

# The values of --xacro-arg while a command with --xacro runs, else None.
_arguments: ContextVar[dict[str, str] | None] = ContextVar("xacro arguments", default=None)


def model(file: str) -> Robot:
    """The robot that a FILE argument names. Raises: what `load` and `xacro` raise."""
    arguments = _arguments.get()
    if arguments is not None and os.path.isfile(file) and is_xacro(file):
        return evaluate_xacro(file, **arguments)
    return load(file)


def refuse_options(words: Sequence[str], options: Sequence[str]) -> None:
    """Refuse what looks like an option and came through as a number might. Raises: InputError."""
    for word in words:
        if word.startswith("--"):
            every = (*options, *OPTIONS)
            raise InputError(f"there is no option {quote(word)}; {suggest(word, every)}")


def takes_models(command: Callable[..., None]) -> Callable[..., None]:
    """Command with the options --xacro and --xacro-arg, which `model` obeys while it runs."""

    @functools.wraps(command)
    def run(
        *args: Any,
        xacro: bool = False,
        xacro_arg: Sequence[str] | None = None,
        **options: Any,
    ) -> None:
        if xacro_arg and not xacro:
            raise InputError("--xacro-arg: expected together with --xacro only")
        values = None
        if xacro:
            values = dict(map(_pair, xacro_arg or ()))
        before = _arguments.set(values)
        try:
            command(*args, **options)
        finally:
            _arguments.reset(before)

    # Typer makes the options out of the signature and the annotations.
    own = inspect.signature(command, eval_str=True)
    more = [
        inspect.Parameter(
            name,
            inspect.Parameter.KEYWORD_ONLY,
            default=default,
            annotation=annotation,
        )
        for name, default, annotation in (("xacro", False, Xacro), ("xacro_arg", None, Given))
    ]
    whole = own.replace(parameters=[*own.parameters.values(), *more])
    vars(run)["__signature__"] = whole
    run.__annotations__ = {
        parameter.name: parameter.annotation for parameter in whole.parameters.values()
    }
    return run


def _pair(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name:
        raise InputError(f"--xacro-arg: expected NAME=VALUE, got {quote(text)}")
    return name, value
