"""Every robot of example-robot-data against Pinocchio, and the proof that no mesh is read on the
way.
"""

from __future__ import annotations

import os
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from poekin import load, validate
from poekin.analysis.validate import BAR, Validation
from poekin.errors import PoekinError, PoekinWarning
from poekin.formats.erd import example_robots

from ..draw import dots
from ..report import Figure, Table, Topic

MESHES = (".stl", ".dae", ".obj", ".ply", ".png", ".jpg")

_opened: list[str] | None = None


def _note_open(event: str, arguments: tuple) -> None:  # type: ignore[type-arg]
    if _opened is not None and event == "open" and isinstance(arguments[0], (str, bytes)):
        _opened.append(os.fsdecode(arguments[0]))


@contextmanager
def opened_files() -> Iterator[list[str]]:
    """The names of all files that Python opens meanwhile."""
    global _opened
    if not _watching:
        sys.addaudithook(_note_open)
        _watching.append(True)
    _opened = names = []
    try:
        yield names
    finally:
        _opened = None


_watching: list[bool] = []


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    robots, empty = example_robots()
    samples = 10 if quick else 100
    done: list[tuple[str, Validation, float]] = []
    broken: list[tuple[str, str]] = []
    warned = 0
    with opened_files() as opened, warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", PoekinWarning)
        for i, (name, path) in enumerate(robots.items()):
            start = time.process_time()
            try:
                done.append((name, validate(path, samples=samples), time.process_time() - start))
            except PoekinError as error:
                broken.append((name, str(error)))
            if (i + 1) % 10 == 0:
                say(f"{i + 1} of {len(robots)} robots")
        refusals = [(name, _refusal(path)) for name, path in empty.items()]
    warned = len(caught)
    meshes = [name for name in opened if name.lower().endswith(MESHES)]
    rows = [row for _, v, _ in done for row in v.chains]
    passed = sum(v.passed for _, v, _ in done)
    worst = max(rows, key=lambda row: row.worst, default=None)
    refused = all(message for _, message in refusals)
    return Topic(
        "Every robot of example-robot-data, against Pinocchio",
        "Each URDF is loaded by poekin from its text and by Pinocchio from the same text. Every chain from the root to "
        f"a leaf is compared at the zero configuration and at {samples} random ones (revolute over ±π, prismatic over "
        "±1 m, whatever the limits; mimic joints follow their masters). Lengths are divided by the chain's reach R.",
        figures=[
            Figure(
                "URDFs of example-robot-data loaded and validated, mimic honoured",
                len(robots) - passed, 0,
                shown=f"{passed} of {len(robots)}", bar_shown=f"{len(robots)} of {len(robots)}",
                holds=passed == len(robots) and refused and not meshes,
                note=f"{len(opened)} files opened, {len(meshes)} of them meshes or pictures; {warned} warnings; "
                + "; ".join(f"{name} is refused: {message}" for name, message in refusals)
                + "".join(f"; {name} fails: {message}" for name, message in broken),
            ),
            Figure(
                "pose and J (space, body, hybrid) against Pinocchio, worst of all chains",
                worst.worst if worst else None, BAR, "R",
                note=f"{len(rows)} chains, {sum(r.joints == 0 for r in rows)} of them without a moving joint"
                + (f"; worst: {worst.base} → {worst.tip}" if worst else ""),
            ),
        ],
        pictures=[
            dots(
                "Worst error of each chain ÷ R (pose and three Jacobians), in ascending order; exact at the lower edge",
                [row.worst for row in rows], BAR, x_label="chain", y_label="error ÷ R",
            )
        ],
        tables=[
            Table(
                "Robots",
                ("robot", "chains", "longest (joints)", "pose ÷ R", "J space ÷ R", "J body ÷ R", "J hybrid ÷ R",
                 "worst chain ends at", "processor time (s)"),
                [_row(name, v, seconds) for name, v, seconds in done],
                folded=True,
            )
        ],
    )  # fmt: skip


def _refusal(path: str) -> str:
    try:
        load(path)
    except PoekinError as error:
        return str(error).replace(os.path.join(os.path.dirname(path), ""), "")
    return ""


def _row(name: str, v: Validation, seconds: float) -> tuple[str | int | float, ...]:
    errors = [
        max(getattr(row, what) for row in v.chains) for what in ("pose", "space", "body", "hybrid")
    ]
    return (
        name,
        len(v.chains),
        max(r.joints for r in v.chains),
        *errors,
        v.worst.tip if v.worst else "",
        seconds,
    )
