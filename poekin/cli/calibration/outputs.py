"""Files that a calibration is written to, and what there is to say of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ...formats import dh
from ...formats.text.atomic_write import write_whole
from ...formats.urdf_text import has_text, own_urdf
from ...model.robot import Robot
from ...solve.calibration.calibration import Calibration
from ...solve.calibration.report import html_report
from ..output import complain, path_text, say

ENDINGS: tuple[str, ...] = (".toml", ".urdf", ".csv")


@dataclass
class Outputs:
    """Places to write to, the convention of a DH table, and the report.

    `written` says what was done up to now, should a later file fail.
    """

    paths: Sequence[Path]
    convention: str
    report: Path | None
    written: list[str] = field(default_factory=list)

    def write(self, found: Calibration, robot: Robot, sources: Sequence[str]) -> None:
        """Write each file, whole; first the one that keeps everything, and none of the others
        should one of them fail for what is in it.
        """
        for path in self.paths:
            if path.suffix.lower() == ".toml":
                found.save(path)
                self.written.append(str(path))
        endings = {path.suffix.lower() for path in self.paths}
        made: dict[str, bytes] = {}  # once for all files of a kind, and so are its warnings
        if ".urdf" in endings:
            made[".urdf"] = own_urdf(found.to_robot(robot))
        if ".csv" in endings:
            made[".csv"] = self._dh(found)
        contents = [(p, made[p.suffix.lower()]) for p in self.paths if p.suffix.lower() in made]
        if self.report is not None:
            title = f"Calibration of {robot.name}: {found.chain.base} to {found.chain.tip}"
            page = html_report.html(found, title, sources)
            contents.append((self.report, page.encode()))
        for path, content in contents:
            write_whole(path, content)
            self.written.append(str(path))

    def _dh(self, found: Calibration) -> bytes:
        made = found.to_dh(self.convention)  # type: ignore[arg-type]  # refused there with the choices
        for words in made.warnings:
            complain(f"warning: {words}")
        return dh.table_io.make_text(made.table, ".csv").encode()


def say_written(paths: Sequence[str], robot: Robot) -> None:
    """Say where files are, and of a calibrated URDF whose text it is."""
    for path in paths:
        say(f"written: {path_text(path)}")
    if not any(path.lower().endswith(".urdf") for path in paths):
        return
    if has_text(robot):
        say(
            "the URDF is the model's own text with other origins and axes of joints that moved: all"
            " else is as it was"
        )
    else:
        say("the URDF is a new text, as the model came from none: no meshes, no masses")
