"""ROS packages by name, without any package of ROS: beside a file, and where the environment says.

- AMENT_PREFIX_PATH (ROS 2): the first prefix with an entry of the package in its index,
  share/ament_index/resource_index/packages; the package is share/NAME below it.
- ROS_PACKAGE_PATH (ROS 1): the first folder below it, depth first, with a package.xml of that name,
  or a manifest.xml and that name itself; not below packages, names that begin with a dot, folders
  with CATKIN_IGNORE or rospack_nosubdirs.

Source: ament_index_python (packages.py, resources.py), rospack (src/rospack.cpp).
"""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Iterator

from ...errors import FileError, InputError, PoekinError, quote
from ..text import xml
from ..text.atomic_write import FilePath

SCHEME = "package://"
AMENT = "AMENT_PREFIX_PATH"
ROS = "ROS_PACKAGE_PATH"
MOST_FOLDERS = 20_000
"""Folders that are looked into for one package below ROS_PACKAGE_PATH."""
MOST_BESIDE = 1000
"""Folders that are looked at beside a folder above a file."""
_NAME = re.compile(r"[a-zA-Z0-9][a-zA-Z0-9_-]+")
_INDEX = os.path.join("share", "ament_index", "resource_index", "packages")
_MANIFEST = "package.xml"
_OLD_MANIFEST = "manifest.xml"


def local_path(name: FilePath) -> FilePath:
    """Path of a file that is named as package://PACKAGE/PATH; any other name as it is.

    Raises: InputError for a name that leads out of the package; FileError where there is no such
    package.
    """
    if not isinstance(name, str) or not name.startswith(SCHEME):
        return name
    package, _, rest = name.removeprefix(SCHEME).partition("/")
    steps = re.split(r"[/\\]", rest)
    if not _NAME.fullmatch(package) or not rest or ".." in steps:
        raise InputError(
            f"expected {SCHEME}PACKAGE/PATH, with a path inside of the package, got {quote(name)}"
        )
    folder = find(package)
    if folder is None:
        raise FileError(f"{quote(name)}: there is no package {quote(package)} in {places()}")
    return os.path.join(folder, rest)


def find(name: str) -> str | None:
    """Folder of a package by the environment, None where there is none.

    Raises: FileError where ROS_PACKAGE_PATH has more than `MOST_FOLDERS` folders.
    """
    if not _NAME.fullmatch(name):
        return None
    for prefix in _folders(AMENT):
        share = os.path.join(prefix, "share", name)
        if os.path.isfile(os.path.join(prefix, _INDEX, name)) and os.path.isdir(share):
            return share
    return next((folder for folder in _packages_below() if _is_package(folder, name)), None)


def find_near(name: str, path: FilePath) -> str | None:
    """Folder of a package among the folders above a file and those beside them, None without.

    A package is called after its package.xml, and a folder without one after itself. Folders that
    everybody may write to, as /tmp, are not searched for what is in them.
    """
    if not _NAME.fullmatch(name):
        return None
    folder = os.path.dirname(os.path.realpath(path))
    while True:
        if _is_package(folder, name):
            return folder
        for beside in _beside(folder, name):
            if _is_package(beside, name):
                return beside
        above = os.path.dirname(folder)
        if above == folder:
            return None
        folder = above


def places() -> str:
    """Words for where `find` looks."""
    words = []
    for variable in (AMENT, ROS):
        state = "not set"
        if variable in os.environ:
            state = f"folders: {len(_folders(variable))}"
        words.append(f"{variable} ({state})")
    return " or ".join(words)


def _folders(variable: str) -> list[str]:
    named = os.environ.get(variable, "").split(os.pathsep)
    return [folder for folder in named if folder and os.path.isdir(folder)]


def _packages_below() -> Iterator[str]:
    """Packages below ROS_PACKAGE_PATH, depth first, each folder once."""
    seen: set[str] = set()
    ahead = _folders(ROS)[::-1]
    while ahead:
        folder = ahead.pop()
        whole = os.path.realpath(folder)
        if whole in seen:
            continue
        seen.add(whole)
        if len(seen) > MOST_FOLDERS:
            raise FileError(
                f"{ROS}: expected at most {MOST_FOLDERS} folders below it, there are more: "
                "name the folders that hold the packages"
            )
        held = _names_in(folder)
        if _MANIFEST in held or _OLD_MANIFEST in held:
            yield folder
        elif "CATKIN_IGNORE" not in held and "rospack_nosubdirs" not in held:
            inner = [os.path.join(folder, name) for name in held if not name.startswith(".")]
            ahead += [below for below in reversed(inner) if os.path.isdir(below)]


def open_to_all(folder: str) -> bool:
    """Whether everybody may write to a folder, or it is not ours to look at."""
    try:
        return os.name == "posix" and bool(os.stat(folder).st_mode & stat.S_IWOTH)
    except OSError:
        return True


def _beside(folder: str, name: str) -> list[str]:
    """Folders in a folder that may be the package: the one of that name, then those that say so."""
    if open_to_all(folder):
        return []
    near = [os.path.join(folder, other) for other in _names_in(folder)[:MOST_BESIDE]]
    said = [other for other in near if os.path.isfile(os.path.join(other, _MANIFEST))]
    return [os.path.join(folder, name), *said]


def _names_in(folder: str) -> list[str]:
    try:
        return sorted(os.listdir(folder))
    except OSError:  # not ours to look into
        return []


def _is_package(folder: str, name: str) -> bool:
    """Whether a folder is the package of that name."""
    manifest = os.path.join(folder, _MANIFEST)
    if not os.path.isfile(manifest):
        return os.path.basename(folder) == name and os.path.isdir(folder)
    try:
        root = xml.parse(xml.read_bytes(manifest), manifest, tell=False)
    except PoekinError:
        return False
    return (root.findtext("name") or "").strip() == name
