"""Scene of a map of a sweep: the arm, and the cubes that it reaches as a cloud."""

from __future__ import annotations

import numpy as np

from ...errors import InputError
from ...groups.arrays import Array
from ...model.robot import Robot
from ...sweep.maps.sweep_map import SweepMap
from ...sweep.measures.measure import MeasureLabel
from ...sweep.measures.names import LABELS
from ..nodes import Cloud
from ..scene import Scene
from .stage import make_stage

_SHARE = 0.2  # of a cube's side, that a point is wide


def sweep_map_scene(found: SweepMap, robot: Robot | None = None) -> Scene:
    """Scene of a map.

    Parameters
    ----------
    found : SweepMap
        Result of a sweep.
    robot : Robot, optional
        The robot of the arm, to be drawn in its place; a map out of a file does not know its arm.

    Returns
    -------
    scene : Scene
        The arm as a page of it opens, and a point in each cube that was reached, coloured by
        the measure that is kept, else the share of directions, else the number of samples there.

    Raises
    ------
    InputError
        If the map is out of a file and `robot` is left out, or nothing was reached.
    """
    chain = found.chain
    if chain is None and robot is not None:
        chain = robot.chain(base=found.about["base"], tip=found.about["tip"])
    if chain is None:
        raise InputError("view: a map out of a file does not know its arm; robot= names it")
    if not found.reached.any():
        raise InputError("view: no cube of the map was reached")
    stage = make_stage(chain, None, robot)
    what, values, unit = _values(found)
    attachment = stage.attachment("cloud", "first", f"cubes that {chain.tip} reaches, by {what}")
    points = found.cells.centres()[found.reached]
    cloud = Cloud(attachment, points, _SHARE * found.cells.resolution, values)
    words = [
        *found.summary().split("\n"),
        f"Blue to orange: {what}, 0 to {unit.value(values.max())}.",
    ]
    return stage.with_result(f"What {chain.tip} reaches", words, [cloud], "cloud")


def _values(found: SweepMap) -> tuple[str, Array, MeasureLabel]:
    """Words and values (K,) by which the cubes that were reached are coloured, and their unit."""
    if found.best is not None:
        label = LABELS[found.about["measure"]]
        keep = found.about["keep"]
        return f"{keep} {label.words}", _of_cubes(found, label.sign)[found.reached], label
    plain = MeasureLabel("")
    if found.cells.side:
        return "share of directions", found.capability[found.reached], plain
    return "number of samples", found.counts[found.reached].astype(float), plain


def _of_cubes(found: SweepMap, sign: int) -> Array:
    """The measure of each cube (nx, ny, nz), NaN in an empty one, of those of its directions."""
    kept = np.asarray(found.best)
    if not found.cells.side:
        return kept
    if found.about["keep"] == "mean":
        sums = np.nansum(kept * found.counts, axis=-1)
        return sums / np.maximum(found.counts.sum(axis=-1), 1)
    if found.about["keep"] == "worst":
        sign = -sign
    return sign * np.fmax.reduce(sign * kept, axis=-1)
