"""--scheduler: a cluster of Dask that runs a sweep."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Annotated

from typer import Option

from ...errors import InputError, MissingExtra
from ...sweep.execution.run import Executor
from ..output import path_text

_PATIENCE = 10.0  # seconds until a scheduler that does not answer is called unreachable

Scheduler = Annotated[
    str | None,
    Option("--scheduler", metavar="ADDRESS", help="Run on a cluster of Dask, as tcp://host:8786."),
]


@contextlib.contextmanager
def executor(address: str | None) -> Iterator[Executor | None]:
    """Client of the scheduler, while the sweep runs; None without an address. Raises: InputError,
    MissingExtra.
    """
    if address is None:
        yield None
        return
    try:
        from distributed import Client
    except ImportError as missing:
        raise MissingExtra("distributed", "sweep", "--scheduler") from missing
    try:
        client = Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        reason = str(error).partition("\n")[0]
        raise InputError(f"--scheduler: {path_text(address)} gives no answer: {reason}") from error
    with client:
        yield client
