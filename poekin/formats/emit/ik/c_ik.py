"""All solutions of an arm's inverse kinematics as C99: its closed form, written from the formulas."""

from __future__ import annotations

import numpy as np

from ....engine.transpile.c_types import CTable
from ....engine.transpile.translation_unit import External, TranslationUnit
from ....engine.transpile.values import Argument, Instance
from ....errors import InputError
from ....formulas.inverse import confirmed
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.kinematics.arm import Arm, compiled
from ....model.sampling import angle_mask
from ..assignments import comment
from ..c import HEADER, CFunction, CSource
from ..messages import coordinate_lines, identifier, made_by, make_tasks, quote_ascii
from ..statements import double
from .c_ik_selftest import selftest
from .closed_arm import ClosedArm, closed_arm
from .ik_vectors import targets
from .placed_branch import PlacedBranch, columns


def c_ik(
    chain: Arm,
    *,
    near: Arm | None = None,
    name: str = "arm",
    origin: str = "",
) -> CSource:
    """C99 of all solutions of a chain's inverse kinematics: without allocation, with math.h alone.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Arm whose solutions are computed.
    near : Chain or CompiledChain, optional
        Arm nearby with a closed form, from whose branches Newton's rule leads to those of `chain`,
        a calibrated arm, say. By default it is `chain` itself.
    name : str, default "arm"
        Name of which the C names are made; only a-z, 0-9 and _ are kept.
    origin : str, default ""
        Words for the head of the text on where the arm is from: a file and its SHA-256, say.

    Returns
    -------
    source : CSource
        Function `int NAME_ik(const double T[16], double q[NAME_IK_MOST][m])`: it writes the
        solutions q, rad or m, for the pose T (row by row, m) and returns their number; limits are
        not looked at. Files NAME_ik.h, NAME_ik.c and NAME_ik_selftest.c.

    Raises
    ------
    InputError
        If no closed form of the arm is known (the message says why), of joints that are helical or
        coupled, or if `name` or `origin` is no text.

    Notes
    -----
    The functions are written from `poekin.formulas.ik` itself, one for each formula and what the arm
    tells of its arguments: products with 0 and 1 are left out. Every solution
    is held against the arm's own pose (`emit.c`), the last digits come from Newton's rule, and
    equal ones are listed once.
    Of a continuum of solutions some are listed. Of an arm nearby, branches that it has and `chain`
    has not, or the other way round, are missed: close to where two solutions meet.
    Accuracy: a solution's pose is the target within 1e-9 (rad, and m by the reach), and within 1e-12
    unless the arm is singular there (tests/formats/emit_ik/test_c_ik.py). Source: Elias and Wen
    2025, and Pieper 1968.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.dh.to_chain(pk.dh.published("puma560"))
    >>> source = pk.emit.c_ik(arm, name="puma")
    >>> list(source.files)
    ['puma_ik.h', 'puma_ik.c', 'puma_ik_selftest.c']
    """
    word = f"{identifier(name)}_ik"
    arm = compiled(chain).chain
    form = closed_arm(arm if near is None else compiled(near).chain)
    if form.columns != arm.dof + 1:
        raise InputError(
            f"near: expected an arm with {arm.dof} coordinates, got one with {form.columns - 1}"
        )
    head = _head(word, arm, form, origin)
    periods = np.where(angle_mask(arm), 2.0 * np.pi, 0.0)
    outside = confirmed.OUTSIDE if near is None else confirmed.OUTSIDE_NEARBY
    sizes = np.append(periods, [arm.reach, outside])
    return CSource(
        word,
        _header(word, head, arm.dof, form.rows),
        _source(word, head, arm, form, sizes),
        selftest(word, periods, targets(arm, form, sizes)),
    )


def _head(word: str, chain: Chain, form: ClosedArm, origin: str) -> list[str]:
    return [
        f"{word}: all solutions of the inverse kinematics of one arm. Generated: change the arm instead.",
        *made_by(origin),
        "",
        f"Base frame {quote_ascii(chain.base)}, tip frame {quote_ascii(chain.tip)}. Units: rad, m.",
        f"In closed form: {form.family}. Each solution is held against the arm's own pose.",
        "",
        *coordinate_lines(chain),
    ]


def _header(word: str, head: list[str], dof: int, rows: int) -> str:
    most = f"{word.upper()}_MOST"
    said = [
        f"{word}: from T[16] = (R, p; 0, 1), row by row, the pose of the tip in the base frame, to the solutions q.",
        "Returns their number. Limits are not looked at. Of a continuum some are listed.",
    ]
    declarations = (
        f"/* Rows that q needs. */\n#define {most} {rows}\n\n{comment(said)}\n"
        f"int {word}(const double T[16], double q[{most}][{dof}]);\n"
    )
    guard = f"{word.upper()}_H_INCLUDED"
    return HEADER.format(comment=comment(head), guard=guard, declarations=declarations)


def _source(word: str, head: list[str], chain: Chain, form: ClosedArm, sizes: Array) -> str:
    pose, _, both = make_tasks(compiled(chain), "hybrid")
    forward = CFunction(word, "double", double, both, chain.dof, "static ")
    placed = PlacedBranch(word, pose, chain.dof)
    outside = {_forward: External(forward.name, (1, 2)), _placed: External(placed.name, (1,))}
    unit = TranslationUnit(word, outside)
    fill, select = _instances(unit, form, sizes, chain.dof)
    texts = [
        comment(head),
        f'#include "{word}.h"\n\n#include <math.h>\n',
        forward.text(),
        placed.text(),
        unit.text([fill, select]),
        _whole(word, chain.dof, form, fill, select),
    ]
    return "\n".join(texts)


def _forward(x: Array, T: Array, J: Array) -> None:
    """Stands for the pose and hybrid Jacobian of the arm, a function of C."""


def _placed(branch: Array, T: Array) -> None:
    """Stands for the pose of a branch, a function of C."""


def _instances(
    unit: TranslationUnit, form: ClosedArm, sizes: Array, dof: int
) -> tuple[Instance, Instance]:
    """Functions that compute the branches, and that select the solutions."""
    matrix = Argument(CTable(4, 4))
    rows = Argument(CTable(form.rows, columns(dof)))
    fill = unit.instance(form.fill, [unit.table("arm", form.arm), matrix, rows])
    select = unit.instance(
        confirmed.select,
        [
            unit.function(_forward),
            unit.function(_placed),
            matrix,
            rows,
            unit.table("sizes", sizes),
            matrix,
            Argument(CTable(dof + 8, dof)),
            Argument(CTable(form.rows, dof)),
        ],
    )
    if fill is None or select is None:
        raise RuntimeError("a function that is being written was asked for")
    return fill, select


def _whole(word: str, dof: int, form: ClosedArm, fill: Instance, select: Instance) -> str:
    """The function that users call."""
    width = columns(dof)
    lines = [
        "",
        f"int {word}(const double T[16], double q[{word.upper()}_MOST][{dof}])",
        "{",
        f"    double branches[{form.rows * width}], pose[16], work[{(dof + 8) * dof}];",
        f"    for (int k = {fill.name}(T, branches); k < {form.rows}; k++) {{",
        f"        branches[{width} * k + {width - 1}] = -1.0;",
        "    }",
        f"    return {select.name}(T, branches, pose, work, q[0]);",
        "}",
        "",
    ]
    return "\n".join(lines)
