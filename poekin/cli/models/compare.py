"""`poekin compare`: where two models of one arm differ."""

from __future__ import annotations

from typing import Annotated

import typer

from ...analysis.compare.compare import compare
from ...analysis.compare.comparison import Comparison, PoseErrors
from ...errors import InputError, join_names
from ...model.chain import Chain
from ..kinematics.arm import FILE_HELP, Base, Json, Tip
from ..model import model
from ..output import as_json, name, number, path_text, say, table

DIFFER = 1

A = Annotated[str, typer.Argument(metavar="A", help=FILE_HELP)]
B = Annotated[str, typer.Argument(metavar="B", help="The model that it is compared with.")]
TipB = Annotated[
    str | None,
    typer.Option("--tip-b", help="The link in B (default: as --tip where B has that link)."),
]
BaseB = Annotated[
    str | None,
    typer.Option("--base-b", help="B's base (default: as --base where B has that link)."),
]
TolMm = Annotated[float, typer.Option("--tol-mm", help="Lengths up to this are the same, mm.")]
TolDeg = Annotated[
    float, typer.Option("--tol-deg", help="Angles up to this are the same, degrees.")
]
Strict = Annotated[
    bool,
    typer.Option("--strict", help="Align nothing: frames, zero positions and directions count."),
]
Samples = Annotated[
    int, typer.Option("--samples", help="Random configurations for the pose errors.", min=1)
]
Seed = Annotated[int, typer.Option("--seed", help="Seed of the random configurations.", min=0)]


def command(
    a: A, b: B, tip: Tip = None, tip_b: TipB = None, base: Base = None, base_b: BaseB = None, tol_mm: TolMm = 0.01,
    tol_deg: TolDeg = 0.001, strict: Strict = False, samples: Samples = 200, seed: Seed = 0, json: Json = False,
) -> None:  # fmt: skip
    """Two models of one arm, joint by joint: axes, zero positions, directions. Exit code 0 equal, 1
    differ, 2 error.
    """
    one, other = _chain(a, "--tip", base, tip), _chain(b, "--tip-b", base_b, tip_b, base, tip)
    result = compare(
        one, other, strict=strict, tol_mm=tol_mm, tol_deg=tol_deg, samples=samples, seed=seed
    )
    if json:
        print(as_json({"a": _where(a, one), "b": _where(b, other)} | result.as_dict()))
    else:
        _show(result, one, other)
    raise typer.Exit(0 if result.equal else DIFFER)


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
    rows = []
    for j in result.joints:
        title = j.name_a if j.name_a == j.name_b else f"{j.name_a} / {j.name_b}"
        kind = j.kind_a if j.kind_a == j.kind_b else f"{j.kind_a} / {j.kind_b}"
        lengths = ["" if x is None else _rounded(x, result.tol_mm) for x in (j.normal, j.shift)]
        tol = result.tol_mm if j.unit == "mm" else result.tol_deg
        bounds = [_rounded(x, tol) for x in j.limits]
        rows.append((
            j.number, title, kind, "DIFFERS" if j.axis_differs else "same", _rounded(j.angle, result.tol_deg), *lengths,
            f"{_rounded(j.zero, tol)} {j.unit}", "flipped" if j.flipped else "same", " ".join(bounds),
        ))  # fmt: skip
    if rows:
        lengths = ("angle (deg)", "normal (mm)", "at the arm (mm)")
        heads = ("", "joint", "kind", "axis", *lengths, "zero", "direction", "limits")
        table(heads, rows, left=4)
    for title, errors in (("as they stand", result.before), ("aligned", result.after)):
        if errors is not None:
            say(f"Pose error {title}: {_errors(errors)}")
    for words in result.equivalent:
        say(f"Equivalent: {words}")
    say(result.verdict[0].upper() + result.verdict[1:])


def _rounded(value: float, tol: float) -> str:
    """A number to four digits, without those far below tolerance."""
    return number(0.0 if abs(value) < 1e-6 * tol else value, 4)


def _errors(errors: PoseErrors) -> str:
    worst, mean = (errors.worst_mm, errors.worst_deg), (errors.mean_mm, errors.mean_deg)
    return "; ".join(
        f"{what} {number(mm, 3)} mm, {number(deg, 3)}°"
        for what, (mm, deg) in (("worst", worst), ("mean", mean))
    )
