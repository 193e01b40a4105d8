"""`poekin sweep base`: where the base of the arm of a map is best put for a list of poses."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from typer import Argument, Exit, Option

from ...sweep.maps.base_placement import base_placement
from ...sweep.maps.sweep_map import load_map
from ..formats.units import Deg, Mm, SaidUnits
from ..kinematics.arm import Json
from ..kinematics.poses import Format, Quaternion, read
from ..output import as_json, say, table

_LISTED = 10

MapFile = Annotated[
    Path, Argument(metavar="MAP", help="A map of poekin sweep reach, in the arm's base frame.")
]
Targets = Annotated[
    str,
    Option("--input", metavar="FILE", help="Poses of the tool, one a row, in a frame of the cell."),
]
Bases = Annotated[
    str,
    Option("--bases", metavar="FILE", help="Candidates for the base, poses in the same frame."),
]


def command(
    file: MapFile,
    targets: Targets,
    bases: Bases,
    format: Format = None,
    quaternion: Quaternion = None,
    mm: Mm = None,
    deg: Deg = None,
    json: Json = False,
) -> None:
    """Ranks candidates for the base by how many poses of the tool MAP says they reach. Exit code 0
    one reaches all, 1 none does, 2 error.
    """
    units = SaidUnits(mm, deg)
    found = load_map(file)
    T_wt = read(None, targets, format, quaternion, units)
    T_wb = read(None, bases, format, quaternion, units)
    ranking = base_placement(found, T_wt, T_wb)
    if json:
        print(as_json(ranking.to_dict()))
    else:
        say(f"{ranking.summary()}\n")
        columns = (ranking.order, ranking.reached, ranking.rarest)
        rows = zip(*(column[:_LISTED].tolist() for column in columns), strict=True)
        table(("candidate", "poses reached", "samples at the rarest"), rows, left=0)
    raise Exit(int(ranking.reached[0] < ranking.poses))
