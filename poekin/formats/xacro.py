"""Robots out of xacro files, evaluated on request only: xacro is code, whose expressions run."""

from __future__ import annotations

import glob
import io
import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr
from types import ModuleType
from typing import Any
from xml.parsers.expat import ExpatError

from ..errors import (
    InputError,
    MissingExtra,
    ModelError,
    escape_unprintable,
    quote,
    safe_repr,
    suggest,
)
from ..model.provenance import Source, warn
from ..model.robot import Robot
from . import urdf
from .common.xml_attribute import quote_attribute
from .content import compressed
from .ros import packages
from .text import xml
from .text.atomic_write import FilePath

# The packages xacro and xacrodoc keep what they are at in variables of their modules.
_one_at_a_time = threading.Lock()
_MACRO = "{*}macro"


def xacro(path: FilePath, /, **arguments: str | float) -> Robot:
    """Robot in a xacro file, evaluated by xacrodoc (extra `xacro`) and then read as URDF.

    Xacro evaluates the expressions in the file and in those which it includes: Python expressions
    with few names, files and environment variables that it may read. Take it for code in effect,
    and evaluate only files that you trust. `load` never does it.

    Parameters
    ----------
    path : str or os.PathLike
        Path of the file, or "package://NAME/PATH". Files to include are relative to the file that
        includes them. Packages, `$(find NAME)`, are looked for in the folders above the file and
        beside these, where `xacrodoc.packages.look_in` was told to, in AMENT_PREFIX_PATH, and in
        ROS_PACKAGE_PATH; no package of ROS is needed. Meshes need not be there.
    **arguments : str, float or bool
        Values of the file's <xacro:arg>. True and False become "true" and "false".

    Returns
    -------
    robot : Robot
        Robot of the evaluated text.

    Raises
    ------
    FileError
        If the file cannot be read, or the package of its name is nowhere.
    ModelError
        If xacro refuses the file, with its own words, if it is compressed, or the result cannot be
        understood as URDF; lines are then those of the evaluated text.
    InputError
        If an argument is no text, number or truth value.
    MissingExtra
        If the package xacrodoc is not installed.

    Warns
    -----
    PoekinWarning
        For what xacro warns of, for arguments that the file has not, and for what was repaired in
        the URDF.
    """
    path = packages.local_path(path)
    data = xml.read_bytes(path)
    name = os.fsdecode(path)
    if compressed.is_compressed(data):
        raise ModelError(
            f"{Source(name).place()}: xacro is evaluated where it lies, beside what it includes: "
            "decompress it first"
        )
    root = xml.parse(data, name, tell=False)  # refuses what is not safe before it is evaluated
    values = {key: _text(key, value) for key, value in arguments.items()}
    result = _evaluated(name, root, values)
    if "<link" not in result and next(root.iter(_MACRO), None) is not None:
        raise ModelError(
            f"{Source(name).place()}: xacro: the file defines macros only, and no robot: "
            "evaluate the file that uses them"
        )
    return urdf.read_text(result, f"{name} (evaluated)")


def is_xacro(path: FilePath) -> bool:
    """Whether a file is xacro: it ends in .xacro or declares xacro's namespace, also where it is
    compressed. Raises: FileError.
    """
    ends = os.fsdecode(path).lower().endswith(".xacro")
    return ends or b"ros.org/wiki/xacro" in compressed.read(path)


def _text(key: str, value: Any) -> str:
    if not isinstance(value, (str, int, float)):
        raise InputError(
            f"xacro: {escape_unprintable(key)}: expected a text, number or truth value, got {safe_repr(value)}"
        )
    if isinstance(value, bool):
        return str(value).lower()
    return str(value)


def _evaluated(
    name: str,
    root: xml.Element,
    values: dict[str, str],
) -> str:
    """URDF text of an evaluated file with this root element."""
    xacrodoc, xacro_ = _evaluators()
    # Included from another document, by its whole path, the file is where its own includes are
    # relative to. `$` and what stands for other characters in patterns must not mean anything
    # there.
    whole = glob.escape(os.path.abspath(name)).replace("${", "$${").replace("$(", "$$(")
    include = f"<xacro:include filename={quote_attribute(whole, 'file')}/>"
    attributes = ['xmlns:xacro="http://www.ros.org/wiki/xacro"']
    for key in ("name", "version"):
        value = root.get(key)
        if value is not None:
            attributes.append(f"{key}={quote_attribute(value, key)}")
    text = f"<robot {' '.join(attributes)}>{include}</robot>"
    refusals = (
        xacro_.XacroException,
        xacrodoc.packages.PackageNotFoundError,
        ValueError,
        LookupError,
        TypeError,
        AttributeError,
        RuntimeError,
        OSError,
        SyntaxError,
        ArithmeticError,
        ExpatError,
    )
    said = io.StringIO()
    given = _Arguments(values)
    try:
        with _one_at_a_time, _packages_of(name, xacrodoc.packages), redirect_stderr(said):
            result = xacrodoc.XacroDoc.from_string(
                text,
                subargs=given,
                resolve_packages=False,
            ).dom.toxml()
    except refusals as fault:
        raise ModelError(f"{Source(name).place()}: xacro: {_reason(fault, xacrodoc)}") from fault
    for line in dict.fromkeys(said.getvalue().splitlines()):  # said again at each of its rounds
        if line.startswith("warning: "):
            warn(
                f"{Source(name).place()}: xacro: {escape_unprintable(line.removeprefix('warning: '), 400)}"
            )
    for key in values.keys() - given.asked:
        warn(
            f"{Source(name).place()}: xacro: it has no <xacro:arg> {quote(key)};"
            f" {suggest(key, sorted(given.asked))}"
        )
    return result


class _Arguments(dict[str, str]):
    """Values of arguments, and the names that xacro asks for."""

    def __init__(self, values: dict[str, str]) -> None:
        super().__init__(values)
        self.asked: set[str] = set()

    def __contains__(self, name: object) -> bool:
        self.asked.add(str(name))
        return super().__contains__(name)

    def __getitem__(self, name: str) -> str:
        self.asked.add(name)
        return super().__getitem__(name)


def _evaluators() -> tuple[ModuleType, ModuleType]:
    try:
        import xacro as xacro_
        import xacrodoc
        import xacrodoc.packages
    except ModuleNotFoundError as missing:
        raise MissingExtra("xacrodoc", "xacro", "evaluating xacro") from missing
    return xacrodoc, xacro_


@contextmanager
def _packages_of(name: str, known: Any) -> Iterator[None]:
    """Context in which xacro finds packages as `xacro` says, those near a file for this file only."""
    before = known._finder  # noqa: SLF001 - xacrodoc has no other way to set it

    def asking(find: Callable[[str], str | None]) -> tuple[Callable[[str], str], type]:
        def found(package: str) -> str:
            folder = find(package)
            if folder is None:
                raise known.PackageNotFoundError(package)
            return folder

        return found, known.PackageNotFoundError

    finder = known.PackageFinder()
    finder.finder_funcs = [
        asking(lambda package: packages.find_near(package, name)),
        asking(before.package_cache.get),
        *before.finder_funcs[:-1],
        asking(packages.find),
        *before.finder_funcs[-1:],  # xacrodoc's own, by packages of ROS
    ]
    known._finder = finder  # noqa: SLF001
    try:
        yield
    finally:
        known._finder = before  # noqa: SLF001


def _reason(fault: BaseException, xacrodoc: Any) -> str:
    if isinstance(fault, RecursionError):
        return "it goes round in circles: a macro or file that uses itself?"
    cause: Any = fault
    while cause is not None:
        if isinstance(cause, xacrodoc.packages.PackageNotFoundError):
            where = (
                f"in the folders above the file and beside these, in {packages.places()}, "
                "and where xacrodoc.packages.look_in was told to"
            )
            return f"there is no package {escape_unprintable(' '.join(map(str, cause.args)), 80)!r} {where}"
        cause = getattr(cause, "exc", None) or cause.__cause__
    # Of an error in $(...) xacro says the class, and its words twice.
    said: object = fault
    if str(fault).startswith("<class "):
        said = getattr(fault, "exc", None) or fault
    words = " ".join(str(said).split())
    return escape_unprintable(words or type(fault).__name__, 400)
