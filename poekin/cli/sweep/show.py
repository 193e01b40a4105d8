"""`poekin sweep show`: what a map of `poekin sweep reach` holds."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from typer import Argument

from ...sweep.maps.sweep_map import load_map
from ..kinematics.arm import Json
from ..output import as_json, name, number, say, table

MapFile = Annotated[Path, Argument(metavar="MAP", help="A map of poekin sweep reach.")]


def command(file: MapFile, json: Json = False) -> None:
    """Sweep of MAP, how much was reached, and its layers by height. Exit code 0 done, 2 error."""
    found = load_map(file)
    if json:
        print(as_json(found.to_dict()))
        return
    about = found.about
    say(f"{name(about['tip'])} in {name(about['base'])}\n{found.summary()}\n")
    heights = found.cells.centres()[0, 0, :, 2]
    reached = found.reached.sum(axis=(0, 1))
    area = found.cells.resolution**2
    rows = [
        (number(height, 4), number(cubes * area, 4))
        for height, cubes in zip(heights, reached, strict=True)
        if cubes
    ]
    table(("height of the layer (m)", "reached (m²)"), rows, left=0)
