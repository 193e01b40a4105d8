"""Scene of one arm: a robot or a chain, its screws, frames, Jacobian and reach."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from ...checks import whole
from ...errors import InputError, join_names, quote
from ...formats.visuals.visual import LeftOut
from ...groups.arrays import Array
from ...groups.vectors import norm
from ...model.chain import Chain
from ...model.joint import FREE
from ...model.kinematics.arm import chain_of
from ...model.kinematics.compiled import CompiledChain
from ...model.robot import Robot
from ..kinematics import Model, kinematics, page_tips, tip_chain
from ..meshes.mesh_nodes import mesh_nodes
from ..nodes import Layer, Node, Triangles
from ..scene import Scene, SceneArm, SceneTip, Slider
from ..shapes import transformed
from .arm_parts.axes import axis_nodes, frame_nodes, label_nodes, screw_table
from .arm_parts.geometry import ArmGeometry, beyond, opening_q, widened
from .arm_parts.jacobian import HANDLE, jacobian_nodes, singular_words
from .arm_parts.missing import left_out_words, stand_ins
from .arm_parts.of_chain import chain_geometry
from .arm_parts.of_robot import robot_geometry
from .arm_parts.reach import reach_cloud
from .arm_parts.regular import is_one_arm, opening_words, regular_opening
from .arm_parts.skeleton import glyph_radii, skeleton_nodes

CLOUD = "Cloud: {} points that {} reaches, blue to orange by the manipulability of its translation."
MOST_CLOUD = 1_000_000
"""Points of a cloud; a page of them has 20 MB."""
POINT = 1e-6
"""Size up to which an arm is a point, m."""


def arm_scene(
    model: Model | CompiledChain[Chain],
    *,
    q: ArrayLike | Mapping[str, float] | None = None,
    tip: str | None = None,
    meshes: bool = True,
    cloud: int = 0,
) -> Scene:
    """Scene of a robot or a chain.

    Parameters
    ----------
    model : Robot or Chain
        Model to show.
    q : (m,) array_like or dict, optional
        Configuration of all coordinates when the page opens, rad or m. Without it each is zero
        where that is within its limits, else in their middle; where an arm is singular there,
        some of its joints are turned, and a sentence says so. A slider reaches a value of q that
        is beyond the limits, and a sentence says so.
    tip : str, optional
        Link whose Jacobian is shown first, of a robot; the page offers the others beside it.
    meshes : bool, default True
        Whether the shapes of a robot's links are drawn, where they are found; links whose are not
        are drawn as bones, and named.
    cloud : int, default 0
        Number of random configurations whose tip positions are drawn as a cloud.

    Returns
    -------
    scene : Scene
        Data of the page.

    Raises
    ------
    UnknownName
        If the tip is no link, or q names a coordinate that the model has not.
    ShapeError
        If q has another number of coordinates.
    MissingExtra
        If the robot has meshes, and trimesh or pycollada is not installed.
    InputError
        If q is not finite, a tip is named for a chain, or the model is none.

    Notes
    -----
    Axes and frames are exact to the rounding of `Robot.fk` and `Chain.joint_poses`
    (tests/view/scenes/test_arm_scene.py).
    """
    model = model if isinstance(model, Robot) else chain_of(model, "model")
    if whole(cloud, "cloud", 0) > MOST_CLOUD:
        raise InputError(f"cloud: expected at most {MOST_CLOUD} points, got {cloud}")
    tips = page_tips(model, _asked(model, tip))
    arm = arm_geometry(model, tips)
    opening, turned = _opening(model, arm, tips, q)
    bodies: tuple[Triangles, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    if meshes and isinstance(model, Robot):
        bodies, left_out = mesh_nodes(model)
    size = arm_size(arm, opening, bodies)
    nodes = [*bodies, *arm_nodes(arm, opening, size, bool(bodies))]
    shown: set[Layer] = {"axes", "frames", "meshes" if bodies else "skeleton"}
    if bodies:
        nodes += stand_ins(arm, left_out, bodies, size)
    columns = max(len(tip.coordinates) for tip in tips)
    if columns:
        radii = glyph_radii(arm, opening, size)
        nodes += jacobian_nodes(columns, min(HANDLE * size, float(radii.max(initial=np.inf))))
    words = [*_model_words(model, arm), *turned]
    reached = widened(arm.sliders, opening[None])
    names = beyond(arm.sliders, reached)
    if names:
        words.append(f"The page opens beyond the limits of {names}.")
    words += left_out_words(left_out)
    chain = tip_chain(model, tips[0].name)
    if cloud and chain.dof:
        shown.add("cloud")
        nodes.append(reach_cloud(chain, cloud, size))
        words.append(CLOUD.format(cloud, quote(chain.tip)))
    if chain.dof and not turned:
        words += singular_words(chain, opening[list(tips[0].coordinates)])
    return Scene(
        title=arm.name,
        words=tuple(words),
        arms=(scene_arm(model, arm, tips, reached),),
        q=opening,
        nodes=tuple(nodes),
        shown=frozenset(shown),
        size=size,
        tables=(screw_table(arm),),
    )


def arm_geometry(model: Model, tips: Iterable[SceneTip]) -> ArmGeometry:
    """Geometry of a robot, with frames at its tips, or of a chain."""
    if isinstance(model, Robot):
        return robot_geometry(model, [tip.name for tip in tips])
    return chain_geometry(model)


def arm_size(arm: ArmGeometry, q: Array, bodies: Iterable[Triangles] = ()) -> float:
    """Diagonal of the box around the arm's points and bodies at q, m; 1 m where these are one point."""
    T = arm.poses(q)
    points = [arm.points(q)]
    for body in bodies:
        bounds = np.stack([body.vertices.min(axis=0), body.vertices.max(axis=0)], axis=1)
        corners = np.stack(np.meshgrid(*bounds), axis=-1).reshape(-1, 3)
        points.append(transformed(corners, T[body.attachment.link]))
    diagonal = norm(np.ptp(np.concatenate(points), axis=0))
    return diagonal if diagonal > POINT else 1.0


def arm_nodes(arm: ArmGeometry, q: Array, size: float, covered: bool = False) -> list[Node]:
    """Skeleton, axes, labels and frames, in sizes for the configuration q; larger where bodies cover
    them.
    """
    radii = glyph_radii(arm, q, size)
    return [
        *skeleton_nodes(arm, radii, size),
        *axis_nodes(arm, radii, size, covered),
        *label_nodes(arm, radii),
        *frame_nodes(arm, radii, size, covered),
    ]


def scene_arm(
    model: Model,
    arm: ArmGeometry,
    tips: tuple[SceneTip, ...],
    sliders: tuple[Slider, ...],
) -> SceneArm:
    """The model as an arm of a page with sliders of its own coordinates."""
    m = len(sliders)
    return SceneArm(
        name=arm.name,
        program=kinematics(model, tips),
        links=arm.links,
        coordinates=sliders,
        tips=tips,
        base=np.eye(4),
        factors=np.eye(m),
        shift=np.zeros(m),
    )


def _opening(
    model: Model,
    arm: ArmGeometry,
    tips: tuple[SceneTip, ...],
    q: ArrayLike | Mapping[str, float] | None,
) -> tuple[Array, list[str]]:
    """Configuration that the page opens with, and a sentence on it where it is none to expect."""
    given = opening_q(arm.sliders, q)
    if q is not None or not tips[0].coordinates or not is_one_arm(tips):
        return given, []
    opening = regular_opening(arm, tip_chain(model, tips[0].name), tips[0].coordinates, given)
    return opening, opening_words(arm, tips[0].name, given, opening)


def _asked(model: Model, tip: str | None) -> tuple[str, ...]:
    """The tip that is asked for, which a chain has already."""
    if tip is None:
        return ()
    if isinstance(model, Chain):
        raise InputError(f"tip: a chain has its own, {quote(model.tip)}; got {quote(tip)}")
    return (str(tip),)


def _model_words(model: Model, arm: ArmGeometry) -> list[str]:
    """Sentences on what the model is."""
    joints = len(arm.joints)
    coordinates = len(arm.sliders)
    words = [
        f"{joints} moving joint{'s' * (joints != 1)}, "
        f"{coordinates} coordinate{'s' * (coordinates != 1)}."
    ]
    if isinstance(model, Robot):
        free = [joint.name for joint in model.joints if joint.kind in FREE]
        if free:
            words.append(f"Floating and planar joints are at zero: {join_names(free)}.")
    return words
