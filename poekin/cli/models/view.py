"""`poekin view`: one offline page in which a model moves."""

from __future__ import annotations

import re
import webbrowser
from pathlib import Path
from typing import Annotated, NamedTuple

from typer import Option

from ...analysis.compare.compare import compare
from ...errors import InputError
from ...model.chain import Chain
from ...model.robot import Robot
from ...solve.ik.ik import ik
from ...solve.ik_all.ik_all import ik_all
from ...solve.path.joint_path import joint_path
from ...solve.path.path_result import PathResult
from ...view.page import Page, page
from ...view.scenes.comparison import comparison_scene
from ...view.scenes.stage import whole_q
from ...view.view import view
from .. import array_files
from ..formats import draw as pages
from ..formats.units import Deg, Mm, SaidUnits
from ..kinematics import poses
from ..kinematics.arm import Base, File, Tip
from ..model import model, models
from ..output import path_text, say
from .compare import chosen_chain

MOST_COORDINATES = 6
"""Coordinates up to which all solutions of a pose are shown; of arms with more, one."""

At = Annotated[
    str | None,
    Option("--q", metavar="Q,...", help="The coordinates of --tip when the page opens."),
]
Other = Annotated[
    str | None,
    Option("--compare", metavar="B", help="A second model, laid over the first as compare does."),
]
Joints = Annotated[
    str | None,
    Option("--path", metavar="FILE", help="Configurations to play: a .csv or .npy file, or -."),
]
Pose = Annotated[
    str | None,
    Option(
        "--pose",
        metavar="POSE",
        help="A pose of --tip in --format: all solutions, of an arm of seven joints or more one.",
    ),
]
NoMeshes = Annotated[bool, Option("--no-meshes", help="Draw a skeleton in place of meshes.")]
Output = Annotated[
    Path | None,
    Option("-o", "--output", metavar="PAGE.html", help="The page (default: the model's name)."),
]
Open = Annotated[bool, Option("--open", help="Open it in the browser.")]


def command(
    file: File,
    tip: Tip = None,
    base: Base = None,
    q: At = None,
    other: Other = None,
    path: Joints = None,
    pose: Pose = None,
    format: poses.Format = None,
    quaternion: poses.Quaternion = None,
    mm: Mm = None,
    deg: Deg = None,
    no_meshes: NoMeshes = False,
    output: Output = None,
    show: Open = False,
) -> None:
    """A page of a model that moves: sliders, screws, frames and numbers in one HTML file, offline."""
    asked = ViewOptions(tip, base, q, other, path, pose, SaidUnits(mm, deg), not no_meshes)
    asked.check(format, quaternion)
    pages.check(output)
    array_files.check_apart([output], model=file, second=other, path=path)
    if other is not None:
        drawn, name = _compared(file, asked)
    else:
        robot = model(file)
        name = robot.name
        drawn = _of_robot(robot, asked, format, quaternion)
    place = output or Path(_file_name(name))
    array_files.check_apart([place], model=file, second=other, path=path)
    drawn.save(place)
    say(f"written: {path_text(place)}")
    if show:
        webbrowser.open(place.resolve().as_uri())


class ViewOptions(NamedTuple):
    """Options of the command line, as given."""

    tip: str | None
    base: str | None
    q: str | None
    other: str | None
    path: str | None
    pose: str | None
    units: SaidUnits
    meshes: bool

    def check(self, format: str | None, quaternion: str | None) -> None:
        """Refuse options that do not go together. Raises: InputError."""
        given = {"--compare": self.other, "--path": self.path, "--pose": self.pose}
        said = [name for name, value in given.items() if value is not None]
        if len(said) > 1:
            raise InputError(f"{said[0]} and {said[1]}: expected one of them, got both")
        if self.q is not None and self.other is None and said:
            raise InputError(f"--q: expected without {said.pop()}, which says where the arm is")
        if self.pose is None and (format is not None or quaternion is not None):
            raise InputError("--format and --quaternion: expected together with --pose")


def _of_robot(robot: Robot, asked: ViewOptions, format: str | None, quaternion: str | None) -> Page:
    """Page of a robot, of one of its chains, a path or a pose."""
    units = asked.units
    if asked.path is None and asked.pose is None and asked.q is None and asked.base is None:
        return view(robot, tip=asked.tip, meshes=asked.meshes)
    chain = robot.chain(base=asked.base, tip=asked.tip)
    around = robot if asked.meshes else None
    if asked.pose is not None:
        (T,) = poses.read([asked.pose], None, format, quaternion, units)
        found = ik_all(chain, T) if chain.dof <= MOST_COORDINATES else ik(chain, T)
        return view(found, robot=around)
    if asked.path is not None:
        return view(_path(asked.path, chain, units), robot=around)
    q = poses.coordinates(asked.q, chain, "--q", units)
    if asked.base is not None:
        return view(chain, q=q)
    return view(robot, q=whole_q(robot, chain, q), tip=chain.tip, meshes=asked.meshes)


def _path(given: str, chain: Chain, units: SaidUnits) -> PathResult:
    """Path of the configurations in a file, with its times where it has them."""
    q, times = array_files.read_path(given, units.columns(chain))
    if not len(q):
        raise InputError("--path: expected a configuration at least, got none")
    return joint_path(chain, units.to_si(q, chain), times)


def _compared(file: str, asked: ViewOptions) -> tuple[Page, str]:
    """Page of two models, and its name."""
    other = asked.other or ""
    robot_a, robot_b = models(file, other)
    a = chosen_chain(robot_a, file, "--tip", asked.base, asked.tip).chain
    b = chosen_chain(robot_b, other, "--tip", None, None, asked.base, asked.tip).chain
    q = poses.coordinates(asked.q, a, "--q", asked.units)
    scene = comparison_scene(compare(a, b), q=q, title=f"{robot_a.name} and {robot_b.name}")
    return page(scene), robot_a.name


def _file_name(name: str) -> str:
    """File name of a page: the model's name, without what a file name cannot have."""
    plain = re.sub(r"[^\w.-]+", "_", name).strip("._")[:100]
    return f"{plain or 'arm'}.html"
