"""`poekin emit`: an arm's kinematics as C for a controller, Python for arrays, JavaScript for a page,
CUDA and JAX for accelerators.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

from typer import Option

from ...checks import alternatives
from ...errors import FileError, InputError, quote
from ...formats import emit
from ...formats.emit.messages import identifier
from ...formats.text.atomic_write import reason, write_whole
from ...model.chain import Chain
from ...model.kinematics.pose_jacobian import FRAME_NAMES
from ...model.robot import Robot
from .. import array_files
from ..calibration.true_joints import (
    add_true_joints,
    tell_of_terms,
    terms_are_told,
    with_terms,
)
from ..kinematics.arm import Base, File, Tip
from ..kinematics.jacobian import parse_frame
from ..model import model
from ..model import origin as model_origin
from ..output import path_text, say

FRAMES = (*FRAME_NAMES, "cheapest")
ENDINGS = {
    "c": (),
    "python": (".py",),
    "javascript": (".js", ".mjs"),
    "cuda": (".cu",),
    "jax": (".py",),
}
"""Languages, and how the one file of theirs may end."""
WRITERS: dict[str, tuple[Callable[..., str | emit.CSource], tuple[str, ...]]] = {
    "c": (emit.c, ("name", "real", "origin")),
    "python": (emit.python, ("origin",)),
    "javascript": (emit.javascript, ("origin",)),
    "cuda": (emit.cuda, ("name", "precision", "measure", "origin")),
    "jax": (emit.jax, ("precision", "measure", "origin")),
}
"""What writes a language, and the options that it takes."""
NUMBERS: dict[bool, emit.Real] = {False: "double", True: "float"}
FRAME_HELP = "The Jacobian's: space | body | hybrid | cheapest (an intermediate link frame) | K (of joint K, from 0)."

Language = Annotated[
    str,
    Option(
        "--lang",
        help="c (C99, math.h only) | python (NumPy, JAX, PyTorch arrays) | javascript (a module) | "
        "cuda, jax (batches, and the sweep of a workspace).",
    ),
]
Output = Annotated[
    Path,
    Option(
        "-o",
        "--output",
        help="A directory for the files (made where there is none); or a .py for python or jax, a .js or .mjs for "
        "javascript, a .cu for cuda.",
    ),
]
Frame = Annotated[str | None, Option("--frame", help=f"{FRAME_HELP} Default: hybrid.")]
Single = Annotated[bool, Option("--float/--double", help="C only: the type of its numbers.")]
Precision = Annotated[
    str | None,
    Option("--precision", help="CUDA and JAX only: float64 (default) | float32, of the numbers."),
]
Kept = Annotated[
    str | None,
    Option(
        "--measure",
        help="CUDA and JAX only: reach (counts, default) | manipulability (the best of each cell too).",
    ),
]
Name = Annotated[
    str | None,
    Option(
        "--name",
        help="What names of files, and in C of functions, begin with (default: the robot's name).",
    ),
]
AllLinks = Annotated[
    bool,
    Option("--all-links", help="JavaScript only: the poses of all links, no Jacobian."),
]
InverseKinematics = Annotated[
    bool,
    Option(
        "--ik",
        help="C only: all solutions of the inverse kinematics, in place of pose and Jacobian.",
    ),
]
Force = Annotated[bool, Option("--force", help="Replace files that exist.")]
Idealise = Annotated[
    float | None,
    Option("--idealise", metavar="TOL", help="The arm made exact within TOL (rad and m)."),
]


def command(
    file: File,
    language: Language,
    output: Output,
    tip: Tip = None,
    base: Base = None,
    frame: Frame = None,
    all_links: AllLinks = False,
    single: Single = False,
    precision: Precision = None,
    measure: Kept = None,
    name: Name = None,
    idealise: Idealise = None,
    inverse: InverseKinematics = False,
    force: Force = False,
) -> None:
    """Pose and Jacobian of one chain, poses of all links, or all solutions of the inverse kinematics,
    as source text that needs no poekin; of a calibration with non-geometric terms also its true joints.
    """
    if language not in ENDINGS:
        raise InputError(f"--lang: {alternatives(ENDINGS)} expected, got {quote(language)}")
    if single and language != "c":
        raise InputError(
            "--float: expected together with --lang c only; Python computes in the numbers it is given, "
            "JavaScript in double precision"
        )
    if inverse:
        _check_inverse(language, {"--frame": frame, "--float": single, "--all-links": all_links})
    accelerated = {"precision": precision, "measure": measure}
    _check_accelerated(language, accelerated)
    with terms_are_told():
        robot = model(file)
    origin = _origin(file, robot)
    name = robot.name if name is None else name
    ideal = None
    if all_links:
        of_chain = {"--tip": tip, "--base": base, "--frame": frame, "--idealise": idealise}
        _check_all_links(language, of_chain)
        tell_of_terms(file, "--all-links")
        texts = {_file_name(name, language): emit.javascript(robot, origin=origin)}
    else:
        chain = robot.chain(base=base, tip=tip)
        if idealise is not None:
            ideal = chain.idealised(idealise)
            chain = ideal.chain
            origin += f", idealised within {idealise:g} (rad and m)"
        if inverse:
            tell_of_terms(file, "--ik")
            texts = emit.c_ik(chain, name=name, origin=origin).files
        else:
            which = parse_frame("hybrid" if frame is None else frame, FRAMES)
            options = {"real": NUMBERS[single], "origin": origin, **accelerated}
            texts = _texts(chain, language, which, name, options)
            add_true_joints(texts, with_terms(file), chain, language, options)
    places, directory = _places(output, language, texts)
    array_files.check_apart(places, model=file)
    _write(places, directory, force)
    for line in next(iter(texts.values())).splitlines():
        if re.search(r"\d+ multiplications", line):
            say(line.removeprefix(" * "))
    if ideal is not None:
        say(f"The idealised arm: {ideal.summary()}")
    say(f"Written: {', '.join(path_text(place) for place in places)}")


def _origin(file: str, robot: Robot) -> str:
    """The robot, and the file or pipe with its checksum where it came from one."""
    words = (f"the robot {robot.name[:80]}", model_origin(file))
    return ", ".join(filter(None, words))


def _texts(
    chain: Chain,
    language: str,
    frame: Any,
    name: str,
    options: dict[str, Any],
) -> dict[str, str]:
    """Texts by the names of their files."""
    options["name"] = name
    write, takes = WRITERS[language]
    given = {option: options[option] for option in takes if options[option] is not None}
    text = write(chain, frame, **given)
    if isinstance(text, str):
        return {_file_name(name, language): text}
    return text.files


def _file_name(name: str, language: str) -> str:
    return f"{identifier(name)}{ENDINGS[language][0]}"


def _check_inverse(language: str, others: dict[str, object]) -> None:
    """Refuses --ik in another language than C, or with an option of pose and Jacobian."""
    if language != "c":
        raise InputError(
            f"--ik: expected together with --lang c only, it is not written in {language} yet"
        )
    for option, value in others.items():
        if value:
            raise InputError(f"--ik: expected without {option}, which is of pose and Jacobian")


def _check_accelerated(language: str, options: dict[str, str | None]) -> None:
    """Refuses options of a sweep in a language that has none."""
    for option, value in options.items():
        if value is not None and language not in ("cuda", "jax"):
            raise InputError(f"--{option}: expected together with --lang cuda or jax only")


def _check_all_links(language: str, of_chain: dict[str, object]) -> None:
    """Refuses --all-links in another language, or with an option of one chain."""
    if language != "javascript":
        raise InputError("--all-links: expected together with --lang javascript only")
    for option, value in of_chain.items():
        if value is not None:
            raise InputError(f"--all-links: expected without {option}, which is of one chain")


def _places(
    output: Path,
    language: str,
    texts: dict[str, str],
) -> tuple[dict[Path, str], Path]:
    """Texts by where they go, and the directory of that. Raises: InputError for another ending."""
    ending = output.suffix.lower()
    if ending in {".c", ".h"}.union(*ENDINGS.values()).difference(ENDINGS[language]):
        expected = " or ".join(("a directory", *(f"a {e} file" for e in ENDINGS[language])))
        raise InputError(
            f"--output: {expected} expected with --lang {language}, got {path_text(output)}"
        )
    if ending in ENDINGS[language]:
        return dict.fromkeys([output], *texts.values()), output.parent
    return {output / file_name: text for file_name, text in texts.items()}, output


def _write(places: dict[Path, str], directory: Path, force: bool) -> None:
    """All files, or none where one exists already and `force` is not set. Raises: FileError."""
    there = [place for place in places if os.path.lexists(place)]
    if there and not force:
        raise FileError(
            f"{', '.join(path_text(place) for place in there)}: exists already; --force replaces it"
        )
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(
            f"cannot make the directory {path_text(directory)}: {reason(error)}"
        ) from error
    for place, text in places.items():
        write_whole(place, text.encode("ascii"))
