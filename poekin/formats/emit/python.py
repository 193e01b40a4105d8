"""An arm's kinematics as plain Python functions for NumPy, JAX and PyTorch arrays."""

from __future__ import annotations

import textwrap

from ...checks import REQUIRED
from ...model.kinematics.arm import Arm
from ...model.kinematics.pose_jacobian import AnyFrame
from .messages import (
    EmittedFunction,
    angle_lines,
    compile_checked,
    header_lines,
    made_by,
    make_tasks,
)
from .statements import Statements, by_outputs, double, statements


def python(
    chain: Arm,
    frame: AnyFrame = REQUIRED,
    *,
    origin: str = "",
) -> str:
    """Python module with a chain's pose and Jacobian: straight-line, without imports.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Chain to write.
    frame : {"space", "body", "hybrid", "cheapest"} or int
        Frame of the Jacobian, or the index of a joint, as in `CompiledChain.jacobian`.
    origin : str, default ""
        Words for the head of the text on where the arm is from: a file and its SHA-256, say.

    Returns
    -------
    text : str
        ASCII with the functions fk, jacobian_FRAME and fk_jacobian_FRAME of (q, xp), q (..., m) an
        array of the module xp: numpy, jax.numpy or torch; each also as ..._angles(q, xp) and
        ..._sincos(sines, cosines, q, xp). Nothing is written in place, so vmap, jit and gradients
        go through.

    Raises
    ------
    InputError
        If `chain` is no Chain, the frame is no frame, or `origin` no text.

    Notes
    -----
    Accuracy: that of `Chain.fk` in the arithmetic of q (tests/formats/test_emit_python.py). Source:
    Park 1994, Section IV, two planar rotations a link.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> arm = pk.dh.to_chain(pk.dh.published("puma560"))
    >>> functions = {}
    >>> exec(pk.emit.python(arm, "hybrid"), functions)
    >>> functions["fk"](np.zeros(6), np).round(3)[:3, 3]
    array([ 0.452, -0.15 ,  1.104])
    """
    arm = compile_checked(chain, frame)
    functions = make_tasks(arm, frame)
    head = [
        '"""The kinematics of one serial arm as straight-line code. Generated: change the arm instead.',
        *made_by(origin),
        "",
        *(task.cost for task in functions),
        "",
        *header_lines(arm, frame),
        "",
        "q is (..., m), an array of floats of the module xp: numpy, jax.numpy, torch.",
        '"""',
        "",
    ]
    return "\n".join(
        [*(line.rstrip() for line in head), *(array_functions(task, arm.dof) for task in functions)]
    )


def array_functions(task: EmittedFunction, dof: int) -> str:
    """The functions of one task, of arrays q of the module xp."""
    program = statements(task.program, double)
    shapes = {"T": "T (..., 4, 4)", "J": f"J (..., {task.rows}, {task.columns})"}
    what = ", ".join(shapes[result] for result in task.results)
    angles = len(program.angles)
    return "\n".join(
        [
            "",
            f"def {task.name}(q, xp):",
            f'    """{what} at q (..., {dof})."""',
            f"    x = {task.name}_angles(q, xp)",
            f"    return {task.name}_sincos(xp.sin(x), xp.cos(x), q, xp)",
            "",
            "",
            f"def {task.name}_sincos(sines, cosines, q, xp):",
            f'    """{what} from sines and cosines (..., {angles}) of the angles, and from q (..., {dof})."""',
            *_statements(program, task),
            f"    return {', '.join(task.results)}",
            "",
            "",
            f"def {task.name}_angles(q, xp):",
            *_doc(
                f"The angles x (..., {angles}) whose sines and cosines are needed.",
                angle_lines(task),
            ),
            *_angles(program),
            "",
        ]
    )


def _doc(first: str, more: list[str]) -> list[str]:
    if not more:
        return [f'    """{first}"""']
    return [f'    """{first}', "", *(f"    {line}" for line in more), '    """']


def _angles(program: Statements) -> list[str]:
    if not program.angles:
        return ["    return q[..., :0]"]
    return [
        *(f"    {name} = q[..., {k}]" for name, _, k in program.angle_reads),
        *(f"    x{j} = {text}" for j, text in enumerate(program.angles)),
        *stack("return", [f"x{j}" for j in range(len(program.angles))]),
    ]


def _statements(program: Statements, task: EmittedFunction) -> list[str]:
    arrays = {"s": "sines", "c": "cosines", "q": "q"}
    T, J = by_outputs(program.outputs, task.poses)
    lines = [f"    {name} = {arrays[array]}[..., {k}]" for name, array, k in program.reads]
    lines += [f"    {name} = {text}" for name, text in program.lines]
    constants = dict.fromkeys(x for x in (*T, *J) if not isinstance(x, str))
    names: dict[float | str, str] = {x: f"k{i}" for i, x in enumerate(constants)}
    if names:
        # Of the batch's shape, on q's device, even where m = 0.
        lines.append("    zero = xp.sum(q[..., :0], -1)")
        lines += [f"    {names[x]} = xp.full_like(zero, {double(x)})" for x in constants]
    if task.poses:
        lines += stack("T =", [names.get(x, str(x)) for x in T])
        lines.append("    T = xp.reshape(T, tuple(q.shape[:-1]) + (4, 4))")
    if task.jacobian:
        entries = "q"
        if task.columns:
            entries = "J"
            lines += stack("J =", [names.get(x, str(x)) for x in J])
        lines.append(
            f"    J = xp.reshape({entries}, tuple(q.shape[:-1]) + ({task.rows}, {task.columns}))"
        )
    return lines


def stack(head: str, parts: list[str]) -> list[str]:
    """A call of xp.stack over a list, in lines of no more than 110 characters."""
    body = textwrap.wrap(", ".join(parts), 102, break_long_words=False, break_on_hyphens=False)
    return [f"    {head} xp.stack([", *(f"        {line}" for line in body), "    ], -1)"]
