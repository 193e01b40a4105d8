"""An arm's kinematics as a JavaScript module, for a page in a browser or for Node."""

from __future__ import annotations

from collections.abc import Iterable

from ...checks import REQUIRED
from ...errors import InputError, safe_repr
from ...model.kinematics.arm import Arm
from ...model.kinematics.pose_jacobian import AnyFrame
from ...model.robot import Robot
from .assignments import INDENT, angle_assignments, comment, result_assignments
from .messages import (
    EmittedFunction,
    angle_lines,
    compile_checked,
    header_lines,
    made_by,
    make_tasks,
    robot_lines,
)
from .statements import double, statements


def javascript(
    chain: Arm | Robot,
    frame: AnyFrame = REQUIRED,
    *,
    origin: str = "",
) -> str:
    """JavaScript module of a chain's pose and Jacobian, or of the poses of a robot's links.

    Parameters
    ----------
    chain : Chain, CompiledChain or Robot
        Model to write.
    frame : {"space", "body", "hybrid", "cheapest"} or int
        Frame of a chain's Jacobian, or the index of a joint, as in `CompiledChain.jacobian`; not
        given with a robot.
    origin : str, default ""
        Words for the head of the text on where the arm is from: a file and its SHA-256, say.

    Returns
    -------
    text : str
        ASCII, a straight-line module of ECMAScript 2015 without imports that exports fk(q), jacobian_FRAME(q) and
        fk_jacobian_FRAME(q) of an array q, rad or m: T row by row (16) and J row by row (6 m) as
        Float64Array, the last one both as {T, J}. Of a robot with L links it exports link_poses(q):
        T (16 L), pose after pose in the order of `Robot.links`, as `Robot.fk` has them. Arrays for
        the results may be given behind q; each function also as ..._angles(q) and
        ..._sincos(s, c, q), where the sines and cosines of the angles are known. The text may stand
        in a page's script element: no name in it can end that.

    Raises
    ------
    InputError
        If `chain` is no Chain and no Robot, the frame is no frame, or is given with a Robot, or
        `origin` is no text.

    Notes
    -----
    Accuracy: that of `Chain.fk` and `Robot.program` (tests/formats/test_emit_javascript.py).
    Source: Park 1994, Section IV, two planar rotations a link; of a robot, Lemma 2 a joint.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.dh.to_chain(pk.dh.published("puma560"))
    >>> text = pk.emit.javascript(arm, "hybrid")
    >>> "export function fk(q, T = new Float64Array(16)) {" in text
    True
    >>> text = pk.emit.javascript(pk.load("panda"))
    >>> "export function link_poses(q, T = new Float64Array(192)) {" in text
    True
    """
    if isinstance(chain, Robot):
        if frame is not REQUIRED:
            raise InputError(
                "frame: expected with a Chain only, a Robot's module has poses of links and no"
                f" Jacobian; got {safe_repr(frame)}"
            )
        return module("one robot", [links_task(chain)], robot_lines(chain), origin)
    arm = compile_checked(chain, frame)
    return module("one serial arm", make_tasks(arm, frame), header_lines(arm, frame), origin)


def links_task(robot: Robot) -> EmittedFunction:
    """The function of the poses of all links of a robot."""
    return EmittedFunction("link_poses", len(robot.links), False, robot.program())


def module(
    what: str,
    tasks: Iterable[EmittedFunction],
    lines: Iterable[str],
    origin: str,
) -> str:
    """Text of a module of some functions, and lines on them for its head."""
    tasks = list(tasks)
    head = [
        f"The kinematics of {what} as straight-line code. Generated: change the arm instead.",
        *made_by(origin),
        "",
        *(task.cost for task in tasks),
        "",
        *lines,
        "",
        "q is an array of numbers. The results are written into the arrays behind it, new ones where",
        "none are given, and returned; they may overlap q.",
    ]
    return "\n".join([comment(head), *map(_functions, tasks)])


def _functions(task: EmittedFunction) -> str:
    program = statements(task.program, double)
    results = ", ".join(f"{name} = {_array(task.sizes[name])}" for name in task.results)
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
