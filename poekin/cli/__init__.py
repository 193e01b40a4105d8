"""The command line `poekin`; its commands are listed in `commands`.

Exit codes: 0 done (validate: passed, compare: equal, singularity: regular, ik and follow: all
solved, calibrate: converged), 1 not so, 2 an error (one message on stderr), 130 interrupted, 141
where the reader of the output went away.
"""

from __future__ import annotations

import io
import os
import sys
import warnings
from collections.abc import Sequence
from typing import Any

from ..errors import MissingExtra, PoekinError, PoekinWarning

ERROR = 2
INTERRUPTED = 130
NOBODY_READS = 141


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command `poekin` on the arguments (sys.argv) and exit with its code."""
    for stream in ("stdout", "stderr"):
        if getattr(sys, stream) is None:  # started with it closed
            setattr(sys, stream, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115  open until the process ends
    for stream in (sys.stdout, sys.stderr):
        # A terminal or pipe that cannot take a character gets its code: no name may end a command.
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    sys.exit(run(arguments))


def run(arguments: Sequence[str] | None = None) -> int:
    """Exit code of one command; an error that a user can cause is one message on stderr."""
    try:
        code = _invoke(arguments)
        sys.stdout.flush()
    except BrokenPipeError:
        _write_no_more()
        return NOBODY_READS
    except KeyboardInterrupt:
        return INTERRUPTED
    except MissingExtra as error:
        # Without rich there is no output.py to print with, and nothing in this message comes out of
        # a file.
        print(f"poekin: error: {error}", file=sys.stderr)
        return ERROR
    except (PoekinError, OSError, MemoryError) as error:
        from .output import complain

        if isinstance(error, MemoryError):
            complain("error: there is not enough memory for this")
        else:
            complain(f"error: {error}")
        try:
            sys.stdout.flush()
        except OSError:  # a full disk
            _write_no_more()
        return ERROR
    return code


def _invoke(arguments: Sequence[str] | None) -> int:
    """Exit code of a command that is run, or whose arguments are refused."""
    try:
        import rich  # noqa: F401  the commands' tables need it: say so at once, not in the middle
        import typer
    except ModuleNotFoundError as missing:
        raise MissingExtra(missing.name or "typer", "cli", "the command line") from missing
    from .commands import command
    from .output import complain

    said: set[str] = set()

    def show(message: Warning | str, *_: object) -> None:
        words = str(message)
        if words not in said:  # a text may be read more than once
            said.add(words)
            complain(f"warning: {words}")

    if arguments is None:
        arguments = sys.argv[1:]
    # The base of all usage errors: Click's own, or typer's where typer does without Click.
    usage: Any = next(
        c for c in reversed(typer.BadParameter.__mro__) if hasattr(c, "format_message")
    )
    with warnings.catch_warnings():
        warnings.simplefilter("always", PoekinWarning)
        warnings.showwarning = show  # type: ignore[assignment]
        try:
            code = command(args=arguments or ["--help"], prog_name="poekin", standalone_mode=False)
        except usage as error:
            message = error.format_message()
            choices = getattr(getattr(error, "param", None), "help", None)
            if choices and message.startswith("Missing"):
                message = f"{message.removesuffix('.')}: {choices}"
            complain(f"error: {message}")
            return ERROR
        except typer.Abort:
            return INTERRUPTED
        except SystemExit:  # typer's answer to a broken pipe, its only own end of a process
            return NOBODY_READS
    return int(code or 0)


def _write_no_more() -> None:
    """Python flushes stdout once more at exit, which must find somewhere to write to."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
