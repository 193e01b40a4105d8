"""`poekin compare`: where two models of one arm differ."""

from __future__ import annotations

import math
from typing import Annotated

from typer import Argument, Exit, Option

from ...analysis.compare.compare import compare
from ...analysis.compare.comparison import Comparison, JointComparison
from ...checks import positive
from ...errors import InputError, join_names
from ...model.chain import Chain
from ..kinematics.arm import FILE_HELP, Base, Json, Seed, Tip
from ..model import model
from ..output import as_json, name, number, path_text, say, table

DIFFER = 1

A = Annotated[str, Argument(metavar="A", help=FILE_HELP)]
B = Annotated[str, Argument(metavar="B", help="The model that it is compared with.")]
TipB = Annotated[
    str | None,
    Option("--tip-b", help="The link in B (default: as --tip where B has that link)."),
]
BaseB = Annotated[
    str | None,
    Option("--base-b", help="B's base (default: as --base where B has that link)."),
]
TolMm = Annotated[float, Option("--tol-mm", help="Lengths up to this are the same, mm.")]
TolDeg = Annotated[
    float,
    Option("--tol-deg", help="Angles up to this are the same, degrees."),
]
Strict = Annotated[
    bool,
    Option("--strict", help="Align nothing: frames, zero positions and directions count."),
]
Samples = Annotated[
    int,
    Option("--samples", help="Random configurations for the pose errors.", min=1),
]


def command(
    a: A,
    b: B,
    tip: Tip = None,
    tip_b: TipB = None,
    base: Base = None,
    base_b: BaseB = None,
    tol_mm: TolMm = 0.01,
    tol_deg: TolDeg = 0.001,
    strict: Strict = False,
    samples: Samples = 200,
    seed: Seed = 0,
    json: Json = False,
) -> None:
    """Two models of one arm, joint by joint: axes, zero positions, directions. Exit code 0 equal, 1
    differ, 2 error.
    """
    one = _chain(a, "--tip", base, tip)
    other = _chain(b, "--tip-b", base_b, tip_b, base, tip)
    positive(tol_mm, "--tol-mm")
    positive(tol_deg, "--tol-deg")
    result = compare(
        one,
        other,
        strict=strict,
        tol_position=tol_mm / 1e3,
        tol_rotation=math.radians(tol_deg),
        samples=samples,
        seed=seed,
    )
    if json:
        print(as_json({"a": _where(a, one), "b": _where(b, other)} | result.to_dict()))
    else:
        _show(result, one, other)
    raise Exit(0 if result.equal else DIFFER)


def _chain(
    file: str,
    option: str,
    base: str | None,
    tip: str | None,
    base_like: str | None = None,
    tip_like: str | None = None,
) -> Chain:
    robot = model(file)
    if base is None and base_like in robot.links:
        base = base_like
    if tip is None and tip_like in robot.links:
        tip = tip_like
    if tip is None and len(robot.leaves) > 1:
        raise InputError(
            f"{path_text(file)} is a tree: say which tip with {option}; tips: {join_names(robot.leaves)}"
        )
    return robot.chain(base=base, tip=tip)


def _where(file: str, chain: Chain) -> dict[str, str]:
    return {"file": file, "base": chain.base, "tip": chain.tip}


def _show(result: Comparison, a: Chain, b: Chain) -> None:
    say(f"A: {name(a.base)} → {name(a.tip)}; B: {name(b.base)} → {name(b.tip)}\n")
    rows = [_joint_row(joint, result) for joint in result.joints]
    if rows:
        lengths = ("angle (deg)", "normal (mm)", "at the arm (mm)")
        heads = ("", "joint", "kind", "axis", *lengths, "zero", "direction", "limits")
        table(heads, rows, left=4)
    say(result.summary())


def _joint_row(joint: JointComparison, result: Comparison) -> tuple[object, ...]:
    slides = joint.unit == "m"
    coordinate = _mm if slides else _deg
    tol = result.tol_position if slides else result.tol_rotation
    return (
        joint.number,
        " / ".join(dict.fromkeys((joint.name_a, joint.name_b))),
        " / ".join(dict.fromkeys((joint.kind_a, joint.kind_b))),
        "DIFFERS" if joint.axis_differs else "same",
        _deg(joint.angle, result.tol_rotation),
        _mm(joint.normal, result.tol_position),
        _mm(joint.shift, result.tol_position),
        f"{coordinate(joint.zero_offset, tol)} {'mm' if slides else 'deg'}",
        "flipped" if joint.reversed else "same",
        " ".join(coordinate(bound, tol) for bound in joint.limits),
    )


def _mm(value: float | None, tol: float) -> str:
    """A length in mm to four digits, 0 far below the tolerance; nothing for None."""
    if value is None:
        return ""
    return number(1e3 * value * (abs(value) >= 1e-6 * tol), 4)


def _deg(value: float, tol: float) -> str:
    """An angle in degrees to four digits, 0 far below the tolerance."""
    return number(math.degrees(value) * (abs(value) >= 1e-6 * tol), 4)
