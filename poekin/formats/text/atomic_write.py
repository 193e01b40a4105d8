"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import secrets
import stat
from pathlib import Path

from ...errors import FileError, quote

FilePath = str | os.PathLike[str]
"""Path of a file, as users give it."""


def write_whole(path: FilePath, content: bytes) -> None:
    """Write a file so that it appears whole or not at all; an old one stays until then.

    A new file has the mode that the process's umask leaves of 0666; one that was there keeps its
    own.
    A device or a pipe, of which there is nothing to replace, is written to. Raises: FileError.
    """
    try:
        target = Path(os.path.realpath(path))
        mode = None
        if target.exists():
            mode = target.stat().st_mode
            if not stat.S_ISREG(mode):
                target.write_bytes(content)
                return
        temporary = target.parent / f".{target.name[:50]}.{secrets.token_hex(8)}.part"
        # The umask is the kernel's to apply: it can be read only by changing it, for all threads.
        handle = os.open(temporary, _NEW, 0o666 if mode is None else 0o600)
        try:
            with open(handle, "wb") as stream:
                stream.write(content)
                stream.flush()
                os.fsync(stream.fileno())
            if mode is not None:
                os.chmod(temporary, stat.S_IMODE(mode))
            os.replace(temporary, target)
        finally:
            if os.path.exists(temporary):
                os.unlink(temporary)
    except (OSError, ValueError) as fault:
        raise FileError(f"cannot write {quote(os.fsdecode(path), 400)}: {reason(fault)}") from fault


def reason(fault: OSError | ValueError) -> str:
    """Reason of a failure to open a file: the system's own words where there are some."""
    return getattr(fault, "strerror", None) or str(fault)


# a link in its place, too, is refused by O_EXCL
_NEW = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
