"""An arm's kinematics as a JavaScript module, for a page in a browser or for Node."""

from __future__ import annotations

from ...checks import REQUIRED
from ...model.kinematics.arm import Arm
from ...model.kinematics.pose_jacobian import AnyFrame
from .assignments import INDENT, angle_assignments, comment, result_assignments
from .messages import (
    EmittedFunction,
    angle_lines,
    compile_checked,
    header_lines,
    made_by,
    make_tasks,
)
from .statements import double, statements


def javascript(
    chain: Arm,
    frame: AnyFrame = REQUIRED,
    *,
    origin: str = "",
) -> str:
    """JavaScript module with a chain's pose and Jacobian: straight-line, without imports.

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
        ASCII, a module of ECMAScript 2015 that exports fk(q), jacobian_FRAME(q) and
        fk_jacobian_FRAME(q) of an array q, rad or m: T row by row (16) and J row by row (6 m) as
        Float64Array, the last one both as {T, J}. Arrays for the results may be given behind q;
        each function also as ..._angles(q) and ..._sincos(s, c, q), where the sines and cosines of
        the angles are known.

    Raises
    ------
    InputError
        If `chain` is no Chain, the frame is no frame, or `origin` no text.
    UnknownName
        If the frame is a name that there is not.

    Notes
    -----
    Accuracy: that of `Chain.fk` (tests/formats/test_emit_javascript.py). Source: Park 1994,
    Section IV, two planar rotations a link.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.dh.to_chain(pk.dh.published("puma560"))
    >>> text = pk.emit.javascript(arm, "hybrid")
    >>> "export function fk(q, T = new Float64Array(16)) {" in text
    True
    """
    arm = compile_checked(chain, frame)
    tasks = make_tasks(arm, frame)
    head = [
        "The kinematics of one serial arm as straight-line code. Generated: change the arm instead.",
        *made_by(origin),
        "",
        *(task.cost for task in tasks),
        "",
        *header_lines(arm, frame),
        "",
        "q is an array of numbers. The results are written into the arrays behind it, new ones where",
        "none are given, and returned; they may overlap q.",
    ]
    return "\n".join([comment(head), *(_functions(task, arm.dof) for task in tasks)])


def _functions(task: EmittedFunction, dof: int) -> str:
    program = statements(task.program, double)
    sizes = {"T": 16, "J": 6 * dof}
    results = ", ".join(f"{name} = {_array(sizes[name])}" for name in task.results)
    count = len(program.angles)
    returned = f"{{ {', '.join(task.results)} }}" if len(task.results) > 1 else task.results[0]
    return "\n".join(
        [
            "",
            f"export function {task.name}(q, {results}) {{",
            f"{INDENT}const x = {task.name}_angles(q);",
            f"{INDENT}return {task.name}_sincos(x.map(Math.sin), x.map(Math.cos), q{task.arguments});",
            "}",
            "",
            f"export function {task.name}_sincos(s, c, q, {results}) {{",
            *result_assignments(program, task, double, "const"),
            f"{INDENT}return {returned};",
            "}",
            "",
            *(f"// {line}" for line in angle_lines(task)),
            f"export function {task.name}_angles(q, x = {_array(count)}) {{",
            *angle_assignments(program, "const"),
            f"{INDENT}return x;",
            "}",
            "",
        ]
    )


def _array(size: int) -> str:
    return f"new Float64Array({size})"
