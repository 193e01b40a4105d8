"""Files of meshes by the names that models have for them; nothing is fetched over a network.

- package://PACKAGE/PATH and model://PACKAGE/PATH: the folder of the package near the model, then by
  AMENT_PREFIX_PATH and ROS_PACKAGE_PATH, then that of the Python package example-robot-data; then
  PACKAGE/PATH below each folder above the model.
- file://PATH, and a path: as seen from the model's folder; one that is not absolute also from each
  folder above it.

Source: rospack and ament_index by `formats.ros.packages`; pinocchio, whose users name the folders
above a package.
"""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Iterator
from urllib.parse import unquote

from ...errors import FileError, MissingExtra, quote
from ...formats import erd
from ...formats.ros import packages

_SCHEME = re.compile(r"([a-z][a-z0-9+.-]*)://", re.IGNORECASE)
_OF_PACKAGES = ("package", "model")


class MeshFinder:
    """Finder of the meshes of one model, whose file is `model`."""

    def __init__(self, model: str) -> None:
        self.model = model
        self.folder = os.path.dirname(os.path.abspath(model))
        self._folders: dict[str, list[str]] = {}

    def find(self, name: str) -> str:
        """Path of the file that a mesh is read from.

        Raises: FileError that says where it was looked for.
        """
        scheme = _SCHEME.match(name)
        word = scheme[1].lower() if scheme else "file"
        path = name[scheme.end() :] if scheme else name
        path = path.replace("\\", "/")
        package = ""
        if word in _OF_PACKAGES:
            package, _, inside = path.lstrip("/").partition("/")
            candidates = self._in_package(package, inside)
        elif word == "file":
            candidates = self._by_path(path)
        else:
            raise FileError("only files are read, nothing over a network")
        for candidate in candidates:
            if os.path.isfile(candidate):
                return candidate
        if word == "file":
            raise FileError("there is no such file")
        where = f"no package {quote(package)} near the model or in {packages.places()} has it"
        if package == erd.PACKAGE and erd_folder() is None:
            where += ": pip install 'poekin[robots]' brings it"
        raise FileError(where)

    def _in_package(self, package: str, inside: str) -> Iterator[str]:
        for folder in self._folders_of(package):
            yield os.path.join(folder, inside)
        yield from self._above(os.path.join(package, inside))

    def _by_path(self, path: str) -> Iterator[str]:
        for written in dict.fromkeys((path, unquote(path))):
            yield os.path.join(self.folder, written)
            if not os.path.isabs(written):
                yield from self._above(written)

    def _above(self, path: str) -> Iterator[str]:
        """The path below each folder above the model that not everybody may write to."""
        folder = self.folder
        while os.path.dirname(folder) != folder:
            folder = os.path.dirname(folder)
            if not packages.open_to_all(folder):
                yield os.path.join(folder, path)

    def _folders_of(self, package: str) -> list[str]:
        if package not in self._folders:
            found = [packages.find_near(package, self.model)]
            with contextlib.suppress(FileError):  # of too many folders to look into
                found.append(packages.find(package))
            if package == erd.PACKAGE and not any(found):
                found.append(erd_folder())
            self._folders[package] = [folder for folder in found if folder]
        return self._folders[package]


def erd_folder() -> str | None:
    """Folder that the package of example-robot-data is in, None where it is not installed."""
    try:
        paths = erd.available()
    except MissingExtra:
        return None
    middle = f"{os.sep}{erd.PACKAGE}{os.sep}"
    for path in paths.values():
        head, found, _ = path.rpartition(middle)
        if found:
            return os.path.join(head, erd.PACKAGE)
    return None
