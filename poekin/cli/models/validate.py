"""`poekin validate`: every chain of a robot against Pinocchio."""

from __future__ import annotations

from typing import Annotated

from typer import Argument, Exit, Option

from ...analysis.validate import BAR, Validation, validate
from ...errors import InputError, MissingExtra, PoekinError
from ...formats.erd import example_robots
from ...model.kinematics.pose_jacobian import FRAME_NAMES
from ...progress_line import ProgressLine
from ..kinematics.arm import Json, Seed
from ..model import model
from ..output import as_json, complain, name, number, say, table

FAILED = 1
ERROR = 2

Files = Annotated[
    list[str] | None,
    Argument(metavar="FILE...", help="Model files, built-in names, or erd:NAME."),
]
Every = Annotated[
    bool,
    Option("--all", help="Every robot of the package example-robot-data."),
]
Samples = Annotated[int, Option("--samples", help="Random configurations a chain.", min=0)]


def command(
    files: Files = None,
    every: Every = False,
    samples: Samples = 100,
    seed: Seed = 0,
    json: Json = False,
) -> None:
    """Poses and Jacobians of every chain from root to leaf against Pinocchio. Exit code 0 pass, 1
    fail, 2 error.
    """
    names = list(files or ())
    skipped: list[str] = []
    if every:
        robots, empty = example_robots()
        names += [f"erd:{name}" for name in robots]
        skipped = [f"erd:{name}" for name in empty]
    if not names:
        raise InputError("nothing to validate: give FILE… or --all")
    results, errors = _validate_each(names, samples, seed)
    passed = not errors and all(v.passed for v in results)
    if json:
        robots = [v.to_dict() for v in results]
        document = {"passed": passed, "robots": robots, "errors": errors, "skipped": skipped}
        print(as_json(document))
    else:
        _show(results, len(errors), skipped)
    for file, message in errors.items():
        if file not in message:
            message = f"{name(file)}: {message}"
        complain(f"error: {message}")
    if errors:
        raise Exit(ERROR)
    raise Exit(0 if passed else FAILED)


def _validate_each(
    names: list[str],
    samples: int,
    seed: int,
) -> tuple[list[Validation], dict[str, str]]:
    """Results of the models, and the messages for those that could not be validated."""
    results: list[Validation] = []
    errors: dict[str, str] = {}
    with ProgressLine("validating") as progress:
        for done, file in enumerate(names):

            def tell(chain: int, chains: int, tip: str, done: int = done, file: str = file) -> None:
                progress(done, len(names), f"{file}: chain {chain} of {chains}, {tip}")

            try:
                results.append(validate(model(file), samples=samples, seed=seed, progress=tell))
            except MissingExtra:
                raise
            except (PoekinError, OSError) as error:
                errors[file] = str(error)
    return results, errors


def _show(results: list[Validation], unread: int, skipped: list[str]) -> None:
    rows = []
    for v in results:
        errors = [
            number(max(getattr(row, what) for row in v.chains), 3)
            for what in ("pose", *FRAME_NAMES)
        ]
        worst = v.worst
        way = ""
        if worst:
            way = f"{worst.base} → {worst.tip}"
        rows.append((v.robot, "pass" if v.passed else "FAIL", way, len(v.chains), *errors))
    if rows:
        say(
            f"Worst error of all chains from root to leaf against Pinocchio, each ÷ R; the bar is {number(BAR)}"
        )
        table(
            ("robot", "", "worst chain", "chains", "pose", "J space", "J body", "J hybrid"),
            rows,
            left=3,
        )
    for v in results:
        for row in v.chains:
            if not row.passed:
                say(f"{v.robot}: {row.summary()}")
            elif row.note:
                say(f"{v.robot}: {row.base} → {row.tip} {row.note}")
    for file in skipped:
        say(f"{file} is left out: there is no robot in it")
    rest = f"; {unread} could not be validated" if unread else ""
    say(f"{sum(v.passed for v in results)} of {len(results) + unread} robots pass{rest}")
