"""`poekin follow --fastest`: the fastest trajectory along a path, for a robot's controller."""

from __future__ import annotations

from pathlib import Path

from ...errors import FileError, InputError
from ...formats.text.atomic_write import write_whole
from ...groups.arrays import Array
from ...solve.motion.plot import plot_joints
from ...solve.motion.trajectory.trajectory import ENDINGS, Trajectory
from ...solve.path.path_result import PathResult
from .. import array_files
from ..output import as_json, complain, path_text, say
from . import poses


def check(output: Path | None, duration: float | None, acceleration: str | None) -> None:
    """Refuses options that --fastest cannot have. Raises: InputError, FileError."""
    if duration is not None:
        raise InputError("--fastest: expected without --duration, which it finds itself")
    if acceleration is None:
        raise InputError(
            "--fastest: expected together with --acceleration, as no model states its limits"
        )
    array_files.check_place(output, ENDINGS)


def check_unasked(output: Path | None) -> None:
    """Refuses a file for a controller where --fastest is not given. Raises: FileError."""
    if output is not None and output.suffix.lower() in (".yaml", ".yml", ".script"):
        raise FileError(
            f"cannot write {path_text(output)}: expected together with --fastest, which times it"
        )


def give(
    path: PathResult,
    acceleration: Array | float | None,
    speed: Array | float | None,
    output: Path | None,
    plot: Path | None,
    json: bool,
    report: dict[str, object],
) -> int:
    """Writes the fastest trajectory along a path; the exit code. Nothing is written where the path
    breaks.
    """
    if not path.success.all() or path.branch_switches:
        if json:
            print(as_json(report | {"trajectory": None}))
        for sentence in path.summary().splitlines():
            complain(sentence)
        complain("no trajectory is made of a path that breaks")
        return poses.UNSOLVED
    if not path.largest_step:
        raise InputError("--input: with --fastest two poses or more expected, not all the same")
    trajectory = path.time_optimal(acceleration, speed=speed)
    svg = ""
    if plot is not None:
        svg = plot_joints(trajectory.q, path.chain, times=trajectory.times)
    _write(trajectory, path, output, json, report)
    if plot is not None:
        write_whole(plot, svg.encode())
        if not json:
            say(f"joints drawn in {path_text(plot)}")
    beyond = trajectory.beyond_limits.any() or trajectory.joints_beyond_limits.any()
    return poses.UNSOLVED if beyond else 0


def _write(
    trajectory: Trajectory,
    path: PathResult,
    output: Path | None,
    json: bool,
    report: dict[str, object],
) -> None:
    document = trajectory.to_dict()
    sentences = [*trajectory.summary().splitlines(), *path.summary().splitlines()]
    if output is not None:
        trajectory.write(output)
        report = {"written": str(output)} | report
        del report["q"]
        for rows in ("times", "q", "dq"):
            del document[rows]
    if json:
        print(as_json(report | {"trajectory": document}))
    elif output is not None:
        say(f"trajectory written to {path_text(output)}")
        say("\n".join(sentences))
    else:
        print(trajectory.to_csv(), end="")
        for sentence in sentences:
            complain(sentence)
