"""Robots out of MJCF: MuJoCo reads the file, and the kinematics is taken over; no mesh is opened.

Defaults, classes, angles in degrees, autolimits, `<frame>`, `<replicate>` and `<include>` are
resolved by MuJoCo. What has no part in kinematics (meshes, textures, actuators, sensors, tendons,
keyframes, ...) is thrown away before it compiles the model, so that no file of an asset is opened.
What becomes of the rest:
- body -> link, the world -> the root link "world". A body without a name is `bodyN`, N its number
  in MuJoCo; a joint without one is called after its link. `fusestatic` and `alignfree` are not
  obeyed: bodies stay as they are written.
- hinge -> revolute, continuous without a range; slide -> prismatic. q is MuJoCo's qpos: a joint's
  `ref` goes into its origin, e^{S (q - ref)} = e^{-S ref} e^{S q}, and ranges and equalities are
  about q as well. Several joints of one body, and one whose anchor `pos` is off the body's origin,
  get links of their own in between.
- free -> floating, its pose that of qpos, in the world, and identity where none is given. ball ->
  floating too, with a warning: only a rotation about its anchor makes sense there.
- `<equality><joint>` -> mimic where its polynomial is linear; a joint that is held at a constant is
  fixed there. Only active ones count. MuJoCo's constraints are soft, a mimic is exact. All others
  are left out, with a warning.
- a site with a name -> a link, fixed to that of its body; where a body has that name too, it is
  `NAME_site`.
- an <inertial> gives its body a mass; what geoms would give it is not known, as none is looked at.
- a mocap body is placed by whoever runs the simulation: it is left out with all that hangs on it,
  and a warning.

Source: the MJCF reference of MuJoCo; its function mj_kinematics for the order of what happens in a
body.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any, TypeVar

import numpy as np

from ...errors import (
    MissingExtra,
    ModelError,
    PoekinError,
    escape_unprintable,
    quote,
)
from ...formulas.lie import quaternion
from ...groups import se3
from ...model.provenance import Source, warn
from ...model.robot import Robot
from ...model.tree.link_masses import is_mass
from ..text import xml
from ..text.atomic_write import FilePath
from .mjcf_files import look_through
from .mjcf_robot import OF_GIVEN_MASS, ModelReader

T = TypeVar("T")
LIGHTEST = 1e-12  # kg: MuJoCo refuses bodies that are lighter than 1e-15

# What is named first refers to what comes after it.
WITHOUT_KINEMATICS = (
    "keys",
    "sensors",
    "actuators",
    "tendons",
    "pairs",
    "excludes",
    "tuples",
    "skins",
    "flexes",
    "cameras",
    "lights",
    "materials",
    "textures",
    "meshes",
    "hfields",
    "numerics",
    "texts",
    "plugins",
)


def read(path: FilePath) -> Robot:
    """The robot in an MJCF file, as MuJoCo reads it (extra `mjcf`); its q is MuJoCo's qpos, in the
    order of the joints.

    Raises: FileError for a file that cannot be read, is empty, a directory or larger than 64 MiB;
    ModelError for a root other than <mujoco>, a document type declaration, a file to include that
    is not there, a model that attaches itself, <replicate> that makes more than 5000 elements, and
    whatever MuJoCo refuses, with its own words (a plugin that is not loaded, too); MissingExtra
    without the package mujoco.
    Warns: PoekinWarning for what is left out or not what it was (see the top of this module).
    Accuracy: poses within 1e-13 reach of MuJoCo's own (tests/formats/mjcf/test_mjcf.py).
    """
    data = xml.read_bytes(path)
    name = os.fsdecode(path)
    return _read(data, name, os.path.abspath(name))


def read_text(text: str | bytes, name: str = "<text>") -> Robot:
    """The robot in the text of an MJCF; `name` stands for the file in messages. Files to include:
    as seen from here.

    Raises and warns as `read`; InputError where text is neither str nor bytes, or name no str.
    """
    return _read(text, name)


def is_mjcf(path: FilePath) -> bool:
    """Whether the root element of an XML file is <mujoco>. Raises: as `read` for what is no file or
    no safe XML.
    """
    return xml.parse(xml.read_bytes(path), os.fsdecode(path), tell=False).tag == "mujoco"


def _read(data: str | bytes, name: str, path: str = "") -> Robot:
    root, model, other = compiled(data, name, path, _bare)
    source = Source(name, mjcf=data if isinstance(data, str) else bytes(data))
    title = root.get("model") or os.path.splitext(os.path.basename(name))[0]
    try:
        bodies = poses(model.body_pos, model.body_quat)
        sites = poses(model.site_pos, model.site_quat)
        # What comes of numbers too large is refused as a joint's origin.
        with np.errstate(all="ignore"):
            robot, said = ModelReader(model).robot(bodies, sites, title, source, other)
    except UnicodeDecodeError as fault:
        raise ModelError(
            f"{source.place()}: MuJoCo reads UTF-8 only, and a name is in another encoding: {fault}"
        ) from fault
    except PoekinError as fault:
        raise ModelError(
            f"{source.place()}: {str(fault).removeprefix(f'{source.place()}: ')}"
        ) from fault
    for message in said:
        warn(f"{source.place()}: {message}")
    return robot


def compiled(
    data: str | bytes,
    name: str,
    path: str,
    prepare: Callable[[Any, ModuleType], T],
) -> tuple[xml.Element, Any, T]:
    """Root element of an MJCF, MuJoCo's model of it, and what `prepare` says of its MjSpec, which
    it changes before the model is compiled.

    Parameters: data, the text, and name, which stands for it; path, where it is a file with this
    content. Raises: as `read`.
    """
    root = xml.parse(data, name, tell=False)
    source = Source(name)
    if root.tag != "mujoco":
        raise ModelError(
            f"{source.place(root.sourceline)}: expected the root element <mujoco>, got {quote(root.tag)}"
        )
    look_through(root, source, os.path.dirname(path), path)
    mujoco = _mujoco()
    try:
        with _unsaid(mujoco):
            spec = _parsed(mujoco.MjSpec, data, path)
            prepared = prepare(spec, mujoco)
            return root, spec.compile(), prepared
    except (ValueError, RuntimeError, mujoco.FatalError) as refusal:
        said = "; ".join(line.strip() for line in str(refusal).splitlines() if line.strip())
        raise ModelError(
            f"{source.place()}: MuJoCo refuses this model: {escape_unprintable(said, 400)}"
        ) from refusal


def _parsed(MjSpec: Any, data: str | bytes, path: str) -> Any:
    if path:
        path.encode()  # which of another path says why MuJoCo cannot open it
        return MjSpec.from_file(path)
    if isinstance(data, str):
        return MjSpec.from_string(data)
    return MjSpec.from_string(bytes(data).decode("utf-8-sig"))


def _mujoco() -> ModuleType:
    try:
        import mujoco
    except ModuleNotFoundError as missing:
        raise MissingExtra("mujoco", "mjcf", "reading MJCF") from missing
    return mujoco


@contextmanager
def _unsaid(mujoco: ModuleType) -> Iterator[None]:
    """Context without MuJoCo's warnings: they are of physics, and it would write a log of them."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _: None)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            yield
    finally:
        mujoco.set_mju_user_warning(before)


def _bare(spec: Any, mujoco: ModuleType) -> list[str]:
    """Remove everything but kinematics; returns the constraints that are no joint equalities."""
    # Spheres need no file; deleting geoms one by one takes MuJoCo minutes.
    for geom in spec.geoms:
        make_sphere(geom, mujoco)
        geom.fromto = [np.nan] * 6
    return without_dynamics(spec, mujoco)


def make_sphere(geom: Any, mujoco: ModuleType) -> None:
    """Make a sphere of a geom, which MuJoCo compiles whatever it was."""
    geom.type = mujoco.mjtGeom.mjGEOM_SPHERE
    geom.size = [1.0] * 3
    geom.meshname = geom.hfieldname = ""


def without_dynamics(spec: Any, mujoco: ModuleType) -> list[str]:
    """Remove everything but kinematics and geoms; returns the constraints that are no joint
    equalities.
    """
    for element in (*spec.geoms, *spec.bodies):
        # Before the plugins go: MuJoCo reads them once more otherwise, and dies of it.
        element.plugin.active = False
    for kind in WITHOUT_KINEMATICS:
        for element in list(getattr(spec, kind)):
            spec.delete(element)
    other = []
    for equality in list(spec.equalities):
        if equality.type != mujoco.mjtEq.mjEQ_JOINT:
            if equality.active:
                kind = equality.type.name.removeprefix("mjEQ_").lower()
                other.append(
                    f"{kind} {equality.name or f'{equality.name1} {equality.name2}'.strip()}"
                )
            spec.delete(equality)
    for element in (*spec.geoms, *spec.sites):
        element.material = ""
    spec.nkey = 0  # MuJoCo is slow to make keyframes, and makes as many as are asked for
    compiler = spec.compiler
    compiler.fusestatic = False
    compiler.inertiafromgeom = int(mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE)
    compiler.settotalmass = -1.0
    compiler.boundmass = 0.0
    compiler.boundinertia = 0.0
    for body in spec.bodies:
        # A body that moves needs a mass, and the geoms that gave it one are gone.
        given = body.explicitinertial and is_mass(body.mass, body.ipos.tolist())
        given = given and body.mass > LIGHTEST
        if not given:
            body.mass = 1.0
            body.ipos = [0.0] * 3
        body.explicitinertial = True
        body.inertia = [OF_GIVEN_MASS if given else 1.0] * 3
        body.fullinertia = [np.nan] * 6
        body.iquat = [1.0, 0.0, 0.0, 0.0]
    return other


def poses(places: np.ndarray, quaternions: np.ndarray) -> np.ndarray:
    """Poses (N, 4, 4) [m] of places (N, 3) and unit quaternions (N, 4), w first."""
    R = [quaternion.rotation(*row) for row in quaternions.tolist()]
    return se3.pose(np.reshape(R, (-1, 3, 3)), places)
