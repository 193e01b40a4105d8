"""ik: joints for a pose, and a reason where there are none."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from numpy.typing import ArrayLike

from ...model.kinematics.arm import Arm, compiled
from ...results import Progress
from ..lock import items
from .choice.redundancy import Objective, check_objective
from .ik_problem import Settings, hashable, make_problem
from .solution import Solution
from .solver import solve
from .task import TaskName, targets


def ik(  # noqa: PLR0913 - options by keyword
    chain: Arm,
    T: ArrayLike,
    *,
    q0: Any = None,
    task: TaskName = "pose",
    axis: ArrayLike | None = None,
    limits: bool = True,
    tol_position: float = 1e-9,
    tol_rotation: float = 1e-9,
    nearest_to: Any = None,
    secondary_objective: Objective | None = None,
    lock: Mapping[str, float] | None = None,
    weights: ArrayLike | None = None,
    restarts: int = 100,
    iterations: int = 30,
    seed: int = 0,
    parallel: bool = False,
    progress: Progress | None = None,
) -> Solution:
    """Joint coordinates q with f(q) = T, for one target pose or a batch.

    Damped least squares over the arm's own machine code, from q0 or near the middle of the limits,
    then from random starts within them, until the true pose error is within both tolerances. A coordinate stays
    within its limits at every step. An arm may have any number of coordinates: what it can reach is
    solved, and else q is the nearest that was found.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The arm.
    T : (..., 4, 4) array_like
        Target poses of the tip in the base frame, m.
    q0 : (m,) or (..., m) array_like or dict, optional
        Start of the first try, rad or m; outside the limits it is moved to them. Without it the
        first try begins at `nearest_to`, or else near the middle of the limits, 0 where there are
        none: near solutions are found first.
    task : {"pose", "position", "rotation", "direction", "planar"}, default "pose"
        Part of the target to be reached. "direction" is the position and the direction of the
        tool's `axis`, for arms of five joints; "planar" the position in the plane in which the arm
        moves and the angle about its normal, for arms whose turning axes are all parallel.
    axis : (3,) array_like, optional
        Direction in the tool frame for the task "direction"; by default its z axis.
    limits : bool, default True
        Whether q has to lie within the limits of the chain.
    tol_position : float, default 1e-9
        Largest |p* - p| of a solution, m.
    tol_rotation : float, default 1e-9
        Largest angle of the rotation between target and solution, rad.
    nearest_to : (m,) or (..., m) array_like or dict, optional
        Configuration, within the limits or not, to be near to: the solution with the least distance
        from it is taken, in rad and m of the joints. For a pose it is the nearest of all, without a
        search, where `ik_all` has them all; else the nearest that some fifty tries find.
    secondary_objective : {"middle", "nearest", "manipulability"}, optional
        Null-space objective of an arm with more joints than the task needs: the middle of the
        limits, nearness to q0, or Yoshikawa's measure of what the task asks, in rad and m. It is
        optimised as far as the arm can move within limits from the first solution, the tool at
        rest; another q0 may lead to a better one.
    lock : dict of str to float, optional
        Names of coordinates and the values that they keep.
    weights : (6,) array_like, optional
        Weights of the error's parts (rotation; position) in the axes of the base, while it is made
        small.
    restarts : int, default 100
        Largest number of tries after the first.
    iterations : int, default 30
        Largest number of steps of a try.
    seed : int, default 0
        Seed of the random starts; the same seed gives the same result.
    parallel : bool, default False
        Whether a long batch is shared out among threads.
    progress : callable, optional
        Function of (done, total), called from time to time on a long batch.

    Returns
    -------
    solution : Solution
        Coordinates, errors, and the reason where there is no solution. NaN or infinity in a target
        gives NaN in its q and the reason "bad target".

    Raises
    ------
    PoseError
        If an element of T is no pose; the message says which, and by how much.
    ShapeError
        If an array does not have the shape above.
    InputError
        If an argument is none of those above, or no coordinate may move.
    UnknownName
        If `lock` or a dict names a coordinate that the chain has not.

    Warns
    -----
    PoekinWarning
        If q0 is outside the limits.

    See Also
    --------
    ik_all : Every solution.
    follow : Joints along a path of poses.

    Notes
    -----
    Accuracy: `success` means what `tol_position` and `tol_rotation` say of `Chain.fk`: the errors
    are computed anew. Where an arm has fewer coordinates than the task constrains and no
    configuration reaches the target, q is a nearby minimum of the weighted squares of p* - p and of
    2 sin(phi / 2) n, where `rotation_error` is phi about n.
    Source: Chan and Lawrence 1988, Sugihara 2011 (error-scaled damping).

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> T = arm.fk([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])
    >>> found = pk.ik(arm, T)
    >>> bool(found.success), found.q.shape
    (True, (6,))
    >>> T[:3, 3] = 2.0, 0.0, 0.0
    >>> print(pk.ik(arm, T).summary().split(";")[0])
    unreachable: the target is farther than the arm's reach by ... mm

    Five joints hold a position and a direction:

    >>> bool(pk.ik(arm, arm.fk([0.3] * 6), task="direction", lock={arm.q_names[5]: 0.0}).success)
    True
    """
    fast = compiled(chain)
    settings = Settings(
        task,
        hashable(axis, "axis"),
        limits,
        tol_position,
        tol_rotation,
        items(lock),
        hashable(weights, "weights"),
        restarts,
        iterations,
        seed,
        parallel,
    )
    check_objective(secondary_objective, q0)
    problem = make_problem(fast, settings)
    return solve(
        problem,
        targets(T, "T"),
        q0,
        nearest_to=nearest_to,
        objective=secondary_objective,
        progress=progress,
    )
