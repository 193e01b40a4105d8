"""Robots out of the FILE arguments of commands: files, names, pipes, on request xacro."""

from __future__ import annotations

import functools
import hashlib
import inspect
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

from typer import Context, Option

from ..errors import FileError, InputError, UnknownName, quote, suggest
from ..formats import vendors
from ..formats.content import compressed, pipes
from ..formats.content.robots import calibration_text, from_text, read_calibration
from ..formats.load import load
from ..formats.ros import packages
from ..formats.vendors.calibration import FactoryCalibration
from ..formats.xacro import is_xacro
from ..formats.xacro import xacro as evaluate_xacro
from ..model.chain import Chain
from ..model.robot import Robot

STDIN = ("-", "/dev/stdin", "/dev/fd/0", "/proc/self/fd/0")
"""Names of standard input."""
STANDARD_INPUT = "standard input"

_HOLD_ARMS = (*vendors.yaml_io.ENDINGS, ".gz", ".zip")
NO_ARMS = "--arm: expected with a vendor's .yaml file, which holds several arms, one name for each"

XACRO_HELP = "Evaluate each FILE that is xacro: this runs the expressions in it, so only do it with files you trust."
Xacro = Annotated[bool, Option("--xacro", help=XACRO_HELP)]
Given = Annotated[
    list[str] | None,
    Option(
        "--xacro-arg",
        metavar="NAME=VALUE",
        help="With --xacro: the value of a <xacro:arg>; may be repeated.",
    ),
]
Coupling = Annotated[
    list[str] | None,
    Option(
        "--coupling",
        metavar="'J3 = J2 + J3'",
        help="A joint of each FILE that does not say so itself, as a sum of readings, which Q then "
        "are; may be repeated.",
    ),
]
NamedArms = Annotated[
    list[str] | None,
    Option(
        "--arm",
        metavar="NAME",
        help="The arm of a vendor's file that holds several: ARM_1; of each file, or once for all.",
    ),
]


@dataclass
class _Run:
    """Run of a command.

    Fields: arguments, the values of --xacro-arg, None without --xacro; coupling, those of
    --coupling; options, what parameters that are options are called; arms, those of --arm, and
    arms_taken, how many files have taken one; arm_files, the arguments that may be files of several
    arms and are not read yet; stdin, what standard input was read for; piped, what came through a
    pipe, which can be read once only, by the name of the argument.
    """

    arguments: dict[str, str] | None = None
    coupling: Sequence[str] = ()
    options: Mapping[str, str] = field(default_factory=dict)
    arms: Sequence[str] = ()
    arms_taken: int = 0
    arm_files: list[str] = field(default_factory=list)
    stdin: str = ""
    piped: dict[str, bytes] = field(default_factory=dict)


_current: ContextVar[_Run | None] = ContextVar("run of a command", default=None)


def model(file: str) -> Robot:
    """The robot that a FILE argument names, its readings coupled as --coupling says. Raises: as
    `models`.
    """
    return models(file)[0]


def model_and_chain(file: str, base: str | None, tip: str | None) -> tuple[Robot, Chain]:
    """The model that a FILE argument names, and its chain from --base to --tip."""
    robot = model(file)
    return robot, robot.chain(base=base, tip=tip)


def models(*files: str) -> list[Robot]:
    """Robots of FILE arguments; --coupling is for those whose readings are not coupled yet.

    Raises: what `load`, `xacro` and `Robot.coupled` raise; InputError where all are coupled.
    """
    robots = [_loaded(file) for file in files]
    statements = _run().coupling
    if not statements:
        return robots
    every = all(robot.coupling for robot in robots)
    try:
        return [r if r.coupling and not every else r.coupled(statements) for r in robots]
    except InputError as fault:
        raise InputError(f"{fault}{'; leave --coupling out' * every}") from fault


def _loaded(file: str) -> Robot:
    """The robot, with its joints' own values."""
    arguments = _run().arguments
    if file in STDIN or pipes.is_pipe(file):
        content = _piped(file)
        if arguments is not None and b"<xacro:" in content:
            raise InputError(
                "--xacro: what is included is looked for from the file, and a pipe is none: give "
                "the file, or evaluate it before the pipe (xacro FILE | poekin ... -)"
            )
        of_arm = arm_calibration(file, content)
        return of_arm.to_robot() if of_arm else from_text(content, called(file))
    path = os.fspath(packages.local_path(file))
    if arguments is not None and os.path.isfile(path) and is_xacro(path):
        return evaluate_xacro(path, **arguments)
    of_arm = arm_calibration(file)
    return of_arm.to_robot() if of_arm else load(file)


def arm_calibration(file: str, piped: bytes = b"") -> FactoryCalibration | None:
    """Calibration of the arm that --arm names in a vendor's file; None of other files, or without
    it. Raises: InputError where no other file is left for an arm.
    """
    run = _run()
    if file not in run.arm_files:
        return None
    run.arm_files.remove(file)
    name = called(file)
    if piped:
        content = compressed.decompress(piped, name)
    else:
        content = compressed.read(packages.local_path(file))
    text = calibration_text(content, name)
    found = None
    if text is not None:
        arms = run.arms if len(run.arms) == 1 else run.arms[run.arms_taken :]
        found = read_calibration(text, name, next(iter(arms), None))
        run.arms_taken += 1
    if not run.arm_files and run.arms_taken < len(run.arms):
        raise InputError(NO_ARMS)
    return found


def _may_hold_arms(file: str) -> bool:
    in_archive = bool(compressed.split(file)[1])
    return in_archive or file.lower().endswith(_HOLD_ARMS) or file in STDIN or pipes.is_pipe(file)


def _arm_files(options: Mapping[str, Any], arms: Sequence[str]) -> list[str]:
    """Arguments of a command with --arm that may be files of several arms. Raises: InputError."""
    words = [str(options.get(name, "")) for name in ("file", "a", "b", "calibration")]
    words += options.get("files") or ()
    files = list(filter(_may_hold_arms, words))
    if len(files) < len(arms):
        raise InputError(NO_ARMS)
    return files


def called(file: str) -> str:
    """A FILE argument as messages call it."""
    if file in STDIN:
        return STANDARD_INPUT
    return file


def origin(file: str) -> str:
    """Words for where a model came from: the file, or pipe, with its checksum; none of a name."""
    piped = _run().piped.get(file)
    if piped is not None:
        kind = STANDARD_INPUT if file in STDIN else "a pipe"
        return f"{kind} with the SHA-256 {_sha256(piped)}"
    path = Path(compressed.split(packages.local_path(file))[0])
    if not path.is_file():
        return ""
    return f"file {path.name} with the SHA-256 {_sha256(path.read_bytes())}"


def content(file: str) -> bytes:
    """Decompressed content of a FILE argument of which the model was read; none of a name."""
    piped = _run().piped.get(file)
    if piped is not None:
        return compressed.decompress(piped, called(file))
    path = packages.local_path(file)
    archive, _ = compressed.split(path)
    if not os.path.isfile(archive):
        return b""
    return compressed.read(path)


def take_stdin(what: str) -> None:
    """Take standard input for one argument of a command, which no other has then.

    Parameters: what, the argument, as messages call it. Raises: InputError where it is taken;
    FileError where it is closed.
    """
    run = _run()
    if run.stdin:
        raise stdin_taken(what, run.stdin)
    if sys.stdin is None:
        raise FileError("cannot read standard input: it is closed")
    run.stdin = what


def stdin_taken(what: str, other: str) -> InputError:
    """Error of an argument whose standard input another one has."""
    return InputError(
        f"{what}: standard input is read for the {other} already: "
        "only one argument of a command can be -"
    )


def _piped(file: str) -> bytes:
    if file in STDIN:
        take_stdin("model")
        if sys.stdin.isatty():
            raise InputError(
                "a model on standard input: expected a pipe or a file, got a terminal: "
                "as in xacro arm.urdf.xacro | poekin info -"
            )
        content = pipes.read_stream(sys.stdin.buffer, STANDARD_INPUT)
    else:
        content = pipes.read(file)
    _run().piped[file] = content
    return content


def _run() -> _Run:
    """Record of the command that runs; outside of any, one that nobody keeps."""
    return _current.get() or _Run()


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _check_no_option(words: Sequence[str], options: Iterable[str]) -> None:
    """Refuse what looks like an option and came through as a number might. Raises: InputError."""
    for word in words:
        if word.startswith("--"):
            raise InputError(f"there is no option {quote(word)}; {suggest(word, options)}")


def takes_models(command: Callable[..., None]) -> Callable[..., None]:
    """Command with the options of `_run_of`, which `model` obeys while it runs. Messages about a
    parameter that is an option speak of the option.
    """
    own = inspect.signature(command, eval_str=True).parameters
    more = inspect.signature(_run_of, eval_str=True).parameters
    every = [*own.values(), *more.values()]

    @functools.wraps(command)
    def run(**options: Any) -> None:
        arms = options["arm"]
        record = _run_of(**{name: options.pop(name) for name in more})
        named = record.options
        if arms:
            record.arm_files = _arm_files(options, arms)
        _check_no_option(options.get("q") or options.get("words") or (), named.values())
        before = _current.set(record)
        try:
            command(**options)
        except (InputError, UnknownName) as fault:  # of the library, about a parameter of its own
            parameter, colon, rest = str(fault).partition(": ")
            raise type(fault)(named.get(parameter, parameter) + colon + rest) from fault
        finally:
            _current.reset(before)

    # Typer makes the options out of the signature and the annotations.
    vars(run)["__signature__"] = inspect.Signature(every)
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in every}
    return run


def _run_of(
    *,
    context: Context,
    xacro: Xacro = False,
    xacro_arg: Given = None,
    coupling: Coupling = None,
    arm: NamedArms = None,
) -> _Run:
    """Run with these options. Raises: InputError."""
    if xacro_arg and not xacro:
        raise InputError("--xacro-arg: expected together with --xacro only")
    arguments = dict(map(_pair, xacro_arg or ())) if xacro else None
    words = {p.name: p.opts[-1] for p in context.command.params if p.opts[-1].startswith("--")}
    return _Run(arguments, coupling or (), words, arm or ())


def _pair(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name:
        raise InputError(f"--xacro-arg: expected NAME=VALUE, got {quote(text)}")
    return name, value
