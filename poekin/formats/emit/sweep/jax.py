"""Kinematics and sweeps of an arm as a module for JAX."""

from __future__ import annotations

from typing import get_args

from ....checks import REQUIRED, choice
from ....engine.kernels.sweep import root, samples, tiles
from ....engine.straight_line import arctangent
from ....engine.straight_line.specialise import measured_program
from ....engine.transpile.arrays.array_functions import ArrayFunctions
from ....errors import InputError
from ....model.kinematics.arm import Arm
from ....model.kinematics.pose_jacobian import AnyFrame
from ..messages import EmittedFunction, compile_checked, header_lines, made_by, make_tasks
from ..python import array_functions
from . import jax_text
from .cuda import Measure, Precision


def jax(
    chain: Arm,
    frame: AnyFrame = REQUIRED,
    *,
    precision: Precision = "float64",
    measure: Measure = "reach",
    origin: str = "",
) -> str:
    """Module for JAX of a chain: poses and Jacobians of arrays, and the sweep of its workspace.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Chain to write, with one coordinate at least.
    frame : {"space", "body", "hybrid", "cheapest"} or int
        Frame of the Jacobian, or the index of a joint, as in `CompiledChain.jacobian`.
    precision : {"float64", "float32"}, default "float64"
        Precision of the sweep's configurations, and of all that follows from them.
    measure : {"reach", "manipulability"}, default "reach"
        Whether the sweep only counts, or keeps the best manipulability of each cell too.
    origin : str, default ""
        Words for the head of the text on where the arm is from: a file and its SHA-256, say.

    Returns
    -------
    text : str
        ASCII that imports jax.numpy alone: the functions of `emit.python`, and configurations,
        cells_of and sweep. The head says what their arguments are.

    Raises
    ------
    InputError
        If `chain` is no Chain or has no coordinate, an option is unknown, or `origin` is no text.

    Notes
    -----
    Samples and cells are the functions that `poekin.sweep` compiles, written for arrays. Accuracy:
    random numbers are those of `poekin.sweep` to the last bit, and what follows is rounded in the
    precision and as JAX fuses it; poses are within the bound of `Chain.fk`, u its roundoff
    (tests/formats/emit_sweep/test_jax.py, on the CPU; it was not run on a GPU). Source: Park 1994,
    Section IV; Steele, Lea and Flood 2014; Górski et al. 2005.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("panda").chain(tip="panda_hand")
    >>> text = pk.emit.jax(arm, "hybrid", precision="float32")
    >>> "def sweep(first, count, samples, bounds, cells, place, counts):" in text
    True
    """
    choice(precision, get_args(Precision), "precision")
    choice(measure, get_args(Measure), "measure")
    arm = compile_checked(chain, frame)
    if not arm.dof:
        raise InputError(f"emit: expected an arm with a coordinate, {arm.chain!r} has none")
    tasks = list(make_tasks(arm, frame))
    is_measured = measure != "reach"
    if is_measured:
        tasks.append(EmittedFunction("measured", 1, True, measured_program(arm.structure), 1))
    more = ", best, attained" * is_measured
    head = [
        "The kinematics of one serial arm for JAX. Generated: change the arm instead.",
        *made_by(origin),
        "",
        *(task.cost for task in tasks),
        "",
        *header_lines(arm, frame),
        *jax_text.USE.format(more=more, rest=jax_text.BEST * is_measured).splitlines(),
    ]
    lines = "\n".join(line.rstrip() for line in head)
    parts = [
        f'"""{lines}\n"""\n\nimport jax.numpy as xp\n',
        *(array_functions(task, arm.dof) for task in tasks),
        _sweep(arm.dof, precision, is_measured),
    ]
    return "\n".join(parts)


def _sweep(dof: int, precision: Precision, is_measured: bool) -> str:
    """The functions of samples and cells, and those of a sweep."""
    functions = ArrayFunctions({arctangent.atan2: "xp.arctan2"})
    common = jax_text.COMMON.format(
        precision=precision,
        dof=dof,
        kind=samples.KIND,
        grid=samples.GRID,
        random=samples.RANDOM,
        seed=samples.SEED,
        counts=samples.COUNTS,
        mixed=functions.add(samples.mixed),
        drawn=functions.add(samples.drawn),
        divided=functions.add(samples.divided),
        cell_of=functions.add(tiles.cell_of, ("cells",)),
    )
    last = jax_text.REACH
    if is_measured:
        last = jax_text.MEASURED.format(root=functions.add(root.root))
    return f"\n{functions.text}\n{common}{last}"
