"""`poekin jacobian`: how the rates of the coordinates move a link."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Annotated, Any

import typer

from ...errors import InputError, quote
from ...model.kinematics.pose_jacobian import FRAME_NAMES
from .. import array_files
from ..formats.units import Deg, Mm, SaidUnits
from ..output import name
from .arm import Base, File, Input, Json, Numbers, Output, Results, Tip, compute, give, take

TWIST = ("wx", "wy", "wz", "vx", "vy", "vz")

FRAME_HELP = "space | body | hybrid (base axes, the tip's origin) | K (z-aligned frame of joint K, counted from 0)."
Frame = Annotated[str, typer.Option("--frame", help=FRAME_HELP)]


def command(
    file: File,
    frame: Frame,
    q: Numbers = None,
    tip: Tip = None,
    base: Base = None,
    given: Input = None,
    mm: Mm = None,
    deg: Deg = None,
    output: Output = None,
    json: Json = False,
) -> None:
    """Jacobian (6×m, rows omega then v, in rad/s and m/s per unit rate) of the link --tip relative
    to --base.
    """
    array_files.check_place(output)
    array_files.check_apart([output], model=file, configurations=given)
    which = parse_frame(frame, FRAME_NAMES)
    arm = take(file, tip, base, q, given, units=SaidUnits(mm, deg))
    chain = arm.chain
    values = compute(arm, lambda some: chain.jacobian(some, which), (6, chain.dof))
    kind = f"{which} Jacobian"
    where = ""
    if isinstance(which, int):
        kind = "Jacobian"
        where = f" in the frame of joint {which}, {name(chain.joint_names[which])}"
    title = (
        f"{kind} of {name(chain.tip)} relative to {name(chain.base)}{where} (rows w rad/s, v m/s)"
    )
    results = Results(values, "J", title, TWIST, chain.q_names, {"frame": which})
    give(arm, results, output, json)


def parse_frame(word: str, names: Sequence[str]) -> Any:
    """Frame that --frame names, one of the names or a joint's number. Raises: InputError."""
    if word in names:
        return word
    if re.fullmatch("-?[0-9]{1,18}", word):
        return int(word)
    raise InputError(
        f"--frame: {', '.join(names)} or the number of a joint (from 0) expected, got {quote(word)}"
    )
