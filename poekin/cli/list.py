"""`poekin list`: the names of robots that are there without a file."""

from __future__ import annotations

from ..errors import MissingExtra
from ..formats import catalogue, erd
from ..formats.dh.published_tables import NAMES as TABLES
from ..formats.load import BUILT_IN, PREFIX
from .kinematics.arm import Json
from .output import as_json, complain, table


def command(json: Json = False) -> None:
    """Names of all built-in robots and of those of example-robot-data, as each FILE may be."""
    examples, missing = _examples()
    if json:
        print(as_json({"built_in": BUILT_IN, "example_robot_data": examples}))
        return
    rows = [(name, _origin(name)) for name in BUILT_IN]
    rows += [(name, f"URDF of {erd.PACKAGE}") for name in examples or ()]
    table(("name", "comes from"), rows, left=2)
    if missing:
        complain(missing)


def _examples() -> tuple[list[str] | None, str]:
    """Names of example-robot-data, else None and what brings them."""
    try:
        robots, _ = erd.example_robots()
    except MissingExtra as missing:
        return None, str(missing)
    return [f"{PREFIX}{name}" for name in robots], ""


def _origin(name: str) -> str:
    kind = "DH table"
    if name in catalogue.NAMES:
        kind = "URDF"
    if name in catalogue.NAMES and name in TABLES:
        kind += " (its DH table: poekin.dh.published)"
    return f"{kind}, with poekin"
