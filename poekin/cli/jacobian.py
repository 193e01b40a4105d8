"""`poekin jacobian`: how the rates of the coordinates move a link."""

from __future__ import annotations

from typing import Annotated

import typer

from ..errors import InputError, shown
from . import files
from .arm import Base, File, Input, Json, Numbers, Output, Tip, compute, give, take
from .output import name

TWIST = ("wx", "wy", "wz", "vx", "vy", "vz")
FRAMES = ("space", "body", "hybrid")

FRAME_HELP = "space | body | hybrid (base axes, the tip's origin) | K (z-aligned frame of joint K)."
Frame = Annotated[str, typer.Option("--frame", help=FRAME_HELP)]


def command(
    file: File, frame: Frame, q: Numbers = None, tip: Tip = None, base: Base = None,
    given: Input = None, output: Output = None, json: Json = False,
) -> None:  # fmt: skip
    """Jacobian (6×m, rows omega then v, in rad/s and m/s per unit rate) of the link --tip relative to --base."""
    if output is not None:
        files.check_writable(output)
    which = _frame(frame)
    arm = take(file, tip, base, q, given)
    chain = arm.chain
    columns = compute(arm, lambda some: chain.jacobian(some, which), (6, chain.dof))
    title = f"{frame} Jacobian of {name(chain.tip)} relative to {name(chain.base)} (rows w rad/s, v m/s)"
    give(
        arm, columns, "J", title=title, rows=TWIST, columns=chain.q_names,
        output=output, json=json, extra={"frame": which},
    )  # fmt: skip


def _frame(word: str) -> str | int:
    if word in FRAMES:
        return word
    try:
        return int(word)
    except ValueError:
        raise InputError(f"--frame: {', '.join(FRAMES)} or the number of a joint expected, got {shown(word)}") from None
