"""Limits of the process that a subject runs in: how long a call may take, and how much memory it
may take up.
"""

from __future__ import annotations

import contextlib
import sys
from typing import NamedTuple

from ....checks import positive

STARTING = 120.0
"""Seconds that importing and making a subject may take, at least."""


class Limits(NamedTuple):
    """Limits of a subject's process.

    Parameters
    ----------
    seconds : float, default 60.0
        Time of one call, the first one with what it compiles, s; late, it is made again once.
    memory : int, default 4 GiB
        Bytes that the process may take beyond those of its start (Linux).
    """

    seconds: float = 60.0
    memory: int = 4 * 2**30

    def checked(self) -> Limits:
        """These limits, if they are positive numbers.

        Returns
        -------
        limits : Limits
            The same.

        Raises
        ------
        InputError
            If one is no positive number.
        """
        for what, value in self._asdict().items():
            positive(value, what)
        return self

    @property
    def starting(self) -> float:
        """Seconds that a subject may take until it can be called."""
        return max(STARTING, self.seconds)


def restrict(memory: int) -> None:
    """Hold this process to so many more bytes than it has, as far as the system can; it leaves no
    core file.
    """
    # Windows has no such module.
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if sys.platform == "linux":
            # Data and not address space, of which compilers and drivers reserve much that is never
            # used.
            _, hard = resource.getrlimit(resource.RLIMIT_DATA)
            resource.setrlimit(resource.RLIMIT_DATA, (_data() + int(memory), hard))


def _data() -> int:
    """Bytes of data of this process (Linux)."""
    with open("/proc/self/status", encoding="ascii") as file:
        sizes = dict(line.split(":", 1) for line in file)
    return int(sizes["VmData"].split()[0]) * 1024
