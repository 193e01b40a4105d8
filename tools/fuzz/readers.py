"""The readers that are fuzzed: how each is called, what makes its inputs, and what is done with
what it returns.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

import poekin as pk
from poekin.cli import npy
from poekin.errors import PoekinError
from poekin.formats import urdf
from poekin.formats.mjcf import mjcf
from poekin.formats.poses.layout import OF_CONTROLLERS
from poekin.solve import motion
from poekin.solve.calibration.measurements import data
from poekin.solve.calibration.report import toml_io

from . import seeds, table_grammar, xml_grammar
from .draw import Draw
from .mutate import encoded


@dataclass(frozen=True)
class Reader:
    """A reader under test.

    Fields: name, in the table; file, what the input is called when it is read; read(path), which
    returns what the file holds or raises; grammar, a document out of nothing; seeds(), real
    documents, at least one of them readable; use, what is done with what was read; share, how many
    inputs it has, as a part of those of the URDF reader; beside, names and contents of files in the
    same folder, of which an input may speak.
    """

    name: str
    file: str
    read: Callable[[str], Any]
    grammar: Callable[[Draw], str | bytes]
    seeds: Callable[[], Sequence[bytes]]
    use: Callable[[Any], None] = lambda read: None
    share: float = 0.1
    beside: tuple[tuple[str, bytes], ...] = ()


def of_name(name: str) -> Reader:
    """One of `READERS` by its name, or the one that "module:attribute" is."""
    if ":" in name:
        module, _, attribute = name.partition(":")
        return getattr(import_module(module), attribute)
    return READERS[name]


def move(robot: pk.Robot) -> None:
    """The poses of all links, and chains to the first leaves with their poses and Jacobians, at 0
    and at ±0.5.
    """
    repr(robot)
    robot.fk(np.zeros(robot.dof))
    for leaf in robot.leaves[:3]:
        chain = robot.chain(tip=leaf)
        q = np.stack([np.zeros(chain.dof), np.tile([0.5, -0.5], chain.dof)[: chain.dof]])
        chain.fk(q)
        chain.jacobian(q, "body")


def _text(path: str) -> pk.Robot:
    return urdf.read_text(_as_text(path))


def _mjcf_text(path: str) -> pk.Robot:
    """As str and as bytes, which are read in different ways."""
    return _first(mjcf.read_text, [_as_text(path), Path(path).read_bytes()])


def _as_text(path: str) -> str:
    return Path(path).read_bytes().decode("utf-8", "surrogateescape")


def _any_text(path: str) -> pk.Robot:
    return pk.from_text(Path(path).read_bytes())


def _message(d: Draw) -> bytes:
    return seeds.message(encoded(xml_grammar.urdf(d)), d.pick(seeds.MESSAGES))


def _nearest(deltas: Any) -> None:
    """The calibration that deltas of a DH table make."""
    nominal = pk.dh.published("ur10e")
    move(pk.ur.from_dh(pk.ur.add_deltas(nominal, **deltas), nominal=nominal).to_robot())


def _calibration_yaml(path: str) -> pk.Robot:
    """As the file says, and as Universal Robots' driver would mean it."""
    pk.vendors.read(path, rpy="moving")
    return pk.load(path)


def _poses(path: str) -> Any:
    """In each format: the file does not say which it is."""
    return _first(lambda said: motion.read_poses(path, said[0], quaternion=said[1]),
                  [("12", None), ("16", None), ("7", "wxyz"), ("7", "xyzw")])  # fmt: skip


def _pose_text(path: str) -> Any:
    """In the format of each controller, as a file and as a text."""
    text = _as_text(path)
    ways = [(source, format) for format in OF_CONTROLLERS for source in (Path(path), text)]
    return _first(lambda way: pk.poses.read(way[0], way[1]), ways)


def _measured(path: str) -> Any:
    """As each kind; and as two points, of which the file does not say where they are."""
    ways: list[dict[str, Any]] = [{"kind": kind} for kind in (None, *data.KINDS)]
    return _first(
        lambda known: data.read(path, seeds.chain(), ignore="x", **known),
        [*ways, {"points": np.eye(2, 3)}],
    )


def _first(read: Callable[[Any], Any], ways: Sequence[Any]) -> Any:
    """What is read in the first of the ways in which something is; all are tried."""
    found, refused = [], None
    for way in ways:
        try:
            found.append(read(way))
        except PoekinError as fault:
            refused = fault
    if not found and refused is not None:
        raise refused
    return found[0]


def _npy(path: str) -> Any:
    """As configurations, and as the poses of the format 16."""
    content = Path(path).read_bytes()
    return _first(
        lambda way: npy.configurations(content, way[0], "input.npy", way[1]),
        [(3, ()), (16, (4, 4))],
    )


def _saved(d: Draw) -> str:
    return table_grammar.jittered(d, d.pick(seeds.written()["arm"]).decode())


READERS: dict[str, Reader] = {
    reader.name: reader
    for reader in (
        Reader("URDF", "input.urdf", pk.load, xml_grammar.urdf, seeds.urdf, move, share=1.0),
        Reader("URDF as str", "input.urdf", _text, xml_grammar.urdf, seeds.urdf, move),
        Reader("any text", "input.txt", _any_text, _message, seeds.piped, move),
        Reader("MJCF", "input.xml", pk.load, xml_grammar.mjcf, seeds.mjcf, move, beside=xml_grammar.INCLUDED),
        Reader("MJCF as text", "input.xml", _mjcf_text, xml_grammar.mjcf, seeds.mjcf, move),
        Reader("xacro", "input.xacro", pk.xacro, xml_grammar.xacro, seeds.xacro, move, beside=xml_grammar.INCLUDED),
        Reader("DH TOML", "input.toml", pk.load, table_grammar.dh_toml, seeds.dh_toml, move),
        Reader("DH CSV", "input.csv", pk.load, table_grammar.dh_csv, seeds.dh_csv, move),
        Reader(
            "calibration YAML", "input.yaml", _calibration_yaml,
            table_grammar.calibration_yaml, seeds.calibration_yaml, move,
        ),
        Reader("UR conf", "input.conf", pk.ur.read_deltas, table_grammar.ur_conf, seeds.ur_conf, _nearest),
        Reader("poses CSV", "input.csv", _poses, table_grammar.poses_csv, lambda: seeds.written()["poses"]),
        Reader("pose texts", "input.txt", _pose_text, table_grammar.poses_csv, seeds.pose_texts),
        Reader(
            "joints CSV", "input.csv", lambda path: motion.read_joints(path, seeds.chain()),
            table_grammar.joints_csv, lambda: seeds.written()["joints"],
        ),
        Reader("npy", "input.npy", _npy, table_grammar.npy, lambda: seeds.written()["npy"]),
        Reader(
            "measured CSV", "input.csv", _measured, table_grammar.measurements_csv, lambda: seeds.written()["measured"]
        ),
        Reader(
            "calibration TOML", "input.toml", toml_io.load, _saved, lambda: seeds.written()["arm"]
        ),
        Reader(
            "calibrated arm", "input.toml", pk.load, _saved, lambda: seeds.written()["arm"], move
        ),
    )
}  # fmt: skip
