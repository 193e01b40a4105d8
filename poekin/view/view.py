"""`view`: the page of a model or of a result."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..analysis.compare.comparison import Comparison
from ..analysis.dexterity.singularity import Singularity
from ..checks import true_or_false
from ..errors import InputError, quote, safe_repr
from ..model.chain import Chain
from ..model.kinematics.compiled import CompiledChain
from ..model.robot import Robot
from ..solve.calibration.calibration import Calibration
from ..solve.ik.solution import Solution
from ..solve.ik_all.all_solutions import AllSolutions
from ..solve.path.path_result import PathResult
from ..sweep.maps.sweep_map import SweepMap
from .page import Page, page
from .scene import Scene
from .scenes.arm import arm_scene
from .scenes.calibration import calibration_scene
from .scenes.comparison import comparison_scene
from .scenes.path import path_scene
from .scenes.singular import singularity_scene
from .scenes.solutions import solutions_scene
from .scenes.sweep_map import sweep_map_scene
from .scenes.targets import solution_scene

OF_ARMS: dict[type, Callable[..., Scene]] = {
    PathResult: path_scene,
    Solution: solution_scene,
    AllSolutions: solutions_scene,
    Singularity: singularity_scene,
    SweepMap: sweep_map_scene,
}
"""Scenes of results about one arm, each drawn alone or in its robot."""

_DEFAULTS = {"q": None, "tip": None, "meshes": True, "cloud": 0, "robot": None}
_EXPECTED = (
    "view: expected a Robot or a Chain, or what compare, follow, ik, ik_all, singularity, "
    "calibrate or sweep.reach returned"
)


def view(
    x: Any,
    *,
    q: Any = None,
    tip: str | None = None,
    meshes: bool = True,
    cloud: int = 0,
    robot: Robot | None = None,
) -> Page:
    """Page in which an arm moves: one HTML file that needs no network, with sliders and numbers.

    Parameters
    ----------
    x : Robot, Chain, Comparison, PathResult, Solution, AllSolutions, Singularity, Calibration or SweepMap
        What to show: a model, or a result of `compare`, `follow`, `ik`, `ik_all`, `singularity`,
        `calibrate` or `sweep.reach`.
    q : (m,) array_like or dict, optional
        Configuration of a model, or of model a of a comparison, when the page opens, rad or m; by
        default zero, or the middle of the limits where zero is beyond them; where an arm is
        singular there, some of its joints are turned.
    tip : str, optional
        Link of a robot whose Jacobian is shown first.
    meshes : bool, default True
        Whether the visual meshes of a robot x are drawn where they are found.
    cloud : int, default 0
        Number of random configurations of a model whose tip positions are drawn.
    robot : Robot, optional
        Robot in which the arm of a result of `follow`, `ik`, `ik_all`, `singularity` or
        `sweep.reach` is drawn, with its meshes and other branches.

    Returns
    -------
    page : Page
        Shows itself as the last line of a notebook's cell; `page.save("arm.html")` writes it.

    Raises
    ------
    InputError
        If x is none of these, an option does not go with it, or it holds nothing to draw, such as
        an `ik` of targets that are not finite.
    ShapeError, UnknownName
        If q or tip does not fit the model.
    MissingExtra
        If k3d is not installed (extra `view`).

    See Also
    --------
    compare, follow, ik, ik_all, singularity, calibrate : Results that can be shown.

    Notes
    -----
    The page's kinematics are the programs of `emit.javascript`, with their accuracy. A second model
    stands where `compare` aligned it; where an axis differs, the page enlarges the difference by
    the factor that it shows.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain()
    >>> page = pk.view(arm, q=[0, -1.2, 1.5, -0.3, 0.8, 0])
    >>> page.save("ur5e.html").name
    'ur5e.html'
    """
    return page(_scene(x, {"q": q, "tip": tip, "meshes": meshes, "cloud": cloud, "robot": robot}))


def _scene(x: Any, options: dict[str, Any]) -> Scene:
    """Scene of whatever can be shown."""
    true_or_false(options["meshes"], "meshes")
    if not isinstance(options["robot"], Robot | None):
        raise InputError(f"robot: expected a Robot, got {safe_repr(options['robot'])}")
    if isinstance(x, Robot | Chain | CompiledChain):
        _refuse(x, options, "robot")
        return arm_scene(x, **{name: options[name] for name in ("q", "tip", "meshes", "cloud")})
    if isinstance(x, Comparison):
        _refuse(x, options, "tip", "meshes", "cloud", "robot")
        return comparison_scene(x, q=options["q"])
    if isinstance(x, Calibration):
        _refuse(x, options, "q", "tip", "meshes", "cloud", "robot")
        return calibration_scene(x)
    for kind, scene in OF_ARMS.items():
        if isinstance(x, kind):
            _refuse(x, options, "q", "tip", "meshes", "cloud")
            return scene(x, options["robot"])
    raise InputError(f"{_EXPECTED}, got {safe_repr(x)}")


def _refuse(x: Any, options: dict[str, Any], *names: str) -> None:
    """Refuses options that do not go with what is shown."""
    for name in names:
        if options[name] is not _DEFAULTS[name]:
            raise InputError(f"{name}: no option of a page of {quote(type(x).__name__)}")
