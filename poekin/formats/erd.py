"""The robots of example-robot-data by name: that package ships URDF files, and no way to find them."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping
from functools import cache
from pathlib import PurePosixPath
from types import MappingProxyType

from ..errors import MissingExtra, UnknownName, quote, suggest
from ..model.robot import Robot
from . import urdf

PACKAGE = "example-robot-data"


@cache  # the package lists some thousand files
def available() -> Mapping[str, str]:
    """Paths of every URDF file of the package by name, in alphabetical order.

    The name is the file's, without `.urdf`; where two files share it, it is preceded by the name of
    the robot's folder: `anymal_b_simple_description/anymal`.
    Raises: MissingExtra when example-robot-data is not installed.
    """
    # Imported where it is used: it takes longer to import than all of this package's formats.
    from importlib.metadata import PackageNotFoundError, files

    try:
        files_ = [file for file in files(PACKAGE) or () if file.suffix == ".urdf"]
    except PackageNotFoundError as missing:
        raise MissingExtra(PACKAGE, "robots", 'a model named "erd:..."') from missing
    count = Counter(file.stem for file in files_)
    named = {}
    for file in files_:
        name = file.stem
        if count[name] > 1:
            name = f"{_folder(file)}/{name}"
        named[name] = os.fspath(file.locate())
    return MappingProxyType(dict(sorted(named.items())))


def example_robots() -> tuple[dict[str, str], dict[str, str]]:
    """URDF files of the package in two dicts from name to path: robots, and files without one.

    A file without a single `<link>` holds no robot; the standard library's XML reader decides that,
    not poekin's. Raises: MissingExtra when example-robot-data is not installed.
    """
    # Imported where it is used, which is for the command line alone.
    from xml.etree import ElementTree

    robots = {}
    empty = {}
    for name, path in available().items():
        has_link = ElementTree.parse(path).getroot().find("link") is not None
        (robots if has_link else empty)[name] = path
    return robots, empty


def read(name: str) -> Robot:
    """The robot of that name, one of `available()`.

    Raises: MissingExtra when example-robot-data is not installed; UnknownName with the closest
    names; otherwise as `urdf.read`.
    """
    paths = available()
    if name not in paths:
        ending = suggest(name, paths)
        both = [known for known in paths if known.endswith(f"/{name}")]
        if both:
            ending = "it is one of " + ", ".join(map(quote, both))
        raise UnknownName(f"{PACKAGE} has no robot {quote(name)}; {ending}")
    return urdf.read(paths[name])


def _folder(file: PurePosixPath) -> str:
    # .../robots/<folder>/urdf/<stem>.urdf or .../robots/<folder>/robots/<stem>.urdf
    if len(file.parts) >= 3:
        return file.parts[-3]
    return file.parent.name
