"""ik: joints for a pose, and a reason where there are none."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from numpy.typing import ArrayLike

from ...model.chain import Chain
from ...model.kinematics.compiled import CompiledChain
from .choice.redundancy import check_objective
from .ik_problem import Settings, compiled, hashable, items, make_problem
from .solution import Solution
from .solver import Wishes, solve
from .task import targets


def ik(
    chain: Chain | CompiledChain,
    T: ArrayLike,
    *,
    q0: Any = None,
    task: str = "pose",
    axis: ArrayLike | None = None,
    limits: bool = True,
    tol_position: float = 1e-9,
    tol_rotation: float = 1e-9,
    nearest_to: Any = None,
    secondary_objective: str | None = None,
    lock: Mapping[str, float] | None = None,
    weights: ArrayLike | None = None,
    restarts: int = 100,
    iterations: int = 30,
    seed: int = 0,
    parallel: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> Solution:
    """Joints q with f(q) = T, for one target or a batch.

    Damped least squares over the arm's own machine code, from q0 or from random starts within the
    limits, again and again until the true pose error is within both tolerances. A coordinate stays
    within its limits at every step.

    Parameters
    ----------
    chain: a `Chain`, or what its `compile` gives. T (..., 4, 4): poses of the tip in the base
    frame, m.
    q0 (m,), (..., m) or a dict: the first try begins there (outside the limits it is moved to them,
        with a warning); without it at `nearest_to`, or else at random.
    task: "pose"; "position" or "rotation" alone; "direction": the position, and the direction of
    the tool's `axis`
        (3,) (in the tool frame, by default its z axis), for arms of five joints.
    limits: whether q has to lie within the chain's limits.
    tol_position (m), tol_rotation (rad): what is solved, by |p* - p| and by the angle of the
    rotation between the two. nearest_to (m,), (..., m) or a dict, within the limits or not: of the
    solutions that some fifty tries find, the one
        with the least distance from it, in rad and m of the joints; `ik_all` finds them all.
    secondary_objective: null-space objective of an arm with more joints than the task needs:
        "middle" (of the limits), "nearest" (to q0), "manipulability" (Yoshikawa's measure of what
        the task asks, in rad and m). It is optimised as far as the arm can move within limits from
        the first solution, the tool at rest; other q0 may lead to a better one.
    lock: names of coordinates and the values that they keep.
    weights (6,): of the error's parts (rotation; position) in the axes of the base, while it is
    made small.
    restarts, iterations: the most tries after the first, and the most steps of a try. seed: of the
        random starts; the same seed gives the same result. parallel: share out a long batch among
        threads.
    progress(done, total): called from time to time on a long batch.

    Returns: Solution. Raises: PoseError that says which element is no pose and by how much;
    InputError, ShapeError, UnknownName. NaN or infinity in a target gives NaN in its q, the reason
    "bad target", and no error.
    Accuracy: `success` means what `tol_position` and `tol_rotation` say of `Chain.fk(q)`: the
    errors are computed anew. Source: Chan and Lawrence 1988, Sugihara 2011 (error-scaled damping).
    """
    fast = compiled(chain, "ik")
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
    if secondary_objective is not None:
        check_objective(secondary_objective, q0)
    problem = make_problem(fast, settings)
    wishes = Wishes(nearest_to, secondary_objective)
    return solve(problem, targets(T, "T"), q0, wishes, progress)
