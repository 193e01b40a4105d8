"""The one cache of compiled kernels, kept between runs in the user's cache directory.

Its key covers all source of algebra, formulas and engine, Numba's options, and the versions of
Numba, llvmlite, NumPy, Python and the processor: an edit anywhere in the formulas makes a new key.
An entry is unpickled only after its SHA-256, its owner and its permissions have been checked. A
place that is damaged, foreign, read-only or absent costs a compilation and one log line, never an
error. `POEKIN_CACHE_DIR` names another place; empty, it switches the cache off. `POEKIN_CACHE_SIZE`
is the most that it may hold, in MiB, 100 unless it is set; see `cache_size`.
"""

from __future__ import annotations

import contextlib
import hashlib
import logging
import math
import os
import pickle
import platform
import stat
import sys
import tempfile
from pathlib import Path

import llvmlite
import numba
import numpy as np
from numba.core import config, serialize
from numba.core.compiler import CompileResult
from numba.core.runtime.nrt import rtsys

from . import cache_size, source_hash

MIB = 2**20
MAX_ENTRY = 64 * MIB
"""Bytes of an entry: a larger one is none."""
DEFAULT_SIZE = 100 * MIB
PLACES = {"win32": ("LOCALAPPDATA", "AppData/Local"), "darwin": ("", "Library/Caches")}
"""Variable with a user's cache directory, and its place below the home directory without it."""
log = logging.getLogger("poekin")
_logged: set[str] = set()
used: set[Path] = set()
"""Entries that this process has read or written."""


def log_once(topic: str, message: str, *details: object) -> None:
    """One log line for a topic in this process, however often it comes up."""
    if topic not in _logged:
        _logged.add(topic)
        log.warning("poekin: " + message, *details)


def log_no_cache(reason: str, *details: object) -> None:
    """One log line of this process on why no kernel is kept."""
    log_once("place", "kernels are compiled anew in each run: " + reason, *details)


def directory() -> Path | None:
    """Directory of the kernels: `POEKIN_CACHE_DIR`, else this user's cache directory; None for
    nowhere.
    """
    named = os.environ.get("POEKIN_CACHE_DIR")
    if named is None:
        return _usual_directory()
    if not named:
        return None
    try:
        return Path(named).expanduser().absolute()
    # a user who is not known, or no working directory any more
    except (RuntimeError, OSError) as error:
        log_no_cache("no cache in %s (%s)", named, error)
        return None


def _usual_directory() -> Path | None:
    """Place in this user's cache directory; None where no home directory can be found."""
    variable, below = PLACES.get(sys.platform, ("XDG_CACHE_HOME", ".cache"))
    try:
        base = Path(os.environ.get(variable) or Path.home() / below)
    except RuntimeError:
        return None
    if base.is_absolute():
        return base / "poekin"
    return None


def size_limit() -> float:
    """The bytes that all entries together may take: `POEKIN_CACHE_SIZE` in MiB."""
    said = os.environ.get("POEKIN_CACHE_SIZE", "").strip()
    try:
        size = float(said) * MIB if said else DEFAULT_SIZE
    except ValueError:
        size = math.nan
    if size >= 0:
        return size
    usual = DEFAULT_SIZE // MIB
    log_once(
        "size",
        "POEKIN_CACHE_SIZE=%.80s is no number of MiB from 0 on: %d are taken",
        said,
        usual,
    )
    return DEFAULT_SIZE


def machine_key() -> str:
    """SHA-256 over what machine code depends on besides its source, its signature and the
    processor.
    """
    versions = (
        numba.__version__,
        llvmlite.__version__,
        np.__version__,
        sys.version,
        platform.machine(),
        sys.platform,
    )
    options = (
        "OPT",
        "LOOP_VECTORIZE",
        "SLP_VECTORIZE",
        "BOUNDSCHECK",
        "DEBUGINFO_DEFAULT",
        "ENABLE_AVX",
    )
    return hashlib.sha256(
        repr((versions, [getattr(config, name, None) for name in options])).encode()
    ).hexdigest()


def _trusted(status: os.stat_result) -> bool:
    """Whether nobody but this user, or root, owns a file or directory or may write it."""
    return _owned_by_user(status) and (os.name == "nt" or not stat.S_IMODE(status.st_mode) & 0o022)


def _owned_by_user(status: os.stat_result) -> bool:
    return not hasattr(os, "geteuid") or status.st_uid in (os.geteuid(), 0)


def usable_directory() -> Path | None:
    """The cache directory, made if needed, or None where it cannot be trusted or used.

    One that `POEKIN_CACHE_DIR` names is made so that others may read it: of an image, say.
    """
    place = directory()
    if place is None:
        return None
    mode = 0o755 if "POEKIN_CACHE_DIR" in os.environ else 0o700
    try:
        place.mkdir(mode=mode, parents=True, exist_ok=True)
        status = place.stat()
    except OSError as error:
        log_no_cache("no cache in %s (%s)", place, error.strerror)
        return None
    if not stat.S_ISDIR(status.st_mode) or not _trusted(status):
        reason = "it belongs to another user"
        if _owned_by_user(status):
            reason = "others may write it (expected mode 0755 or 0700)"
        log_no_cache("%s is not used, %s", place, reason)
        return None
    return place


def entry(name: str, key: object) -> Path | None:
    """Path of the entry of a name and a key; None for nowhere."""
    place = usable_directory()
    # without a key where the package runs from where its source cannot be read
    if place is None or source_hash.LOADED is None:
        return None
    whole = (source_hash.LOADED, machine_key(), key)
    return place / f"{name}-{hashlib.sha256(repr(whole).encode()).hexdigest()[:32]}.kernel"


def read(path: Path) -> bytes | None:
    """Content of an entry; None where there is none, or none that can be trusted."""
    try:
        with open(path, "rb", opener=_open_regular) as file:
            status = os.fstat(file.fileno())
            trusted = (
                stat.S_ISREG(status.st_mode) and status.st_size <= MAX_ENTRY and _trusted(status)
            )
            data = file.read(MAX_ENTRY) if trusted else b""
    except FileNotFoundError:
        return None
    except OSError as error:
        log_once("entry", "a kernel is compiled anew: %s cannot be read (%s)", path, error.strerror)
        return None
    digest = data[:32]
    payload = data[32:]
    if not trusted or hashlib.sha256(payload).digest() != digest:
        log_once("entry", "a kernel is compiled anew: %s is damaged, or others may write it", path)
        return None
    with contextlib.suppress(OSError):  # in a directory that is read-only
        os.utime(path)  # it is in use: the last that the bound on the cache's size removes
    used.add(path)
    return payload


def write(path: Path, payload: bytes) -> None:
    """Keep an entry; the file appears whole or not at all."""
    partial = None
    try:
        handle, partial = tempfile.mkstemp(dir=path.parent, prefix=path.name)
        with os.fdopen(handle, "wb") as file:
            file.write(hashlib.sha256(payload).digest() + payload)
        os.chmod(partial, 0o644)  # whoever may read the directory may read its entries
        os.replace(partial, path)
        used.add(path)
        cache_size.bound(path.parent, len(payload) + 32, size_limit())
    except OSError as error:
        log_once("write", "%s is not kept: it cannot be written (%s)", path, error.strerror)
        if partial is not None:
            with contextlib.suppress(OSError):
                os.unlink(partial)


class KernelCache:
    """Cache that a Numba dispatcher of one kernel takes machine code from and gives it to."""

    def __init__(self, name: str):
        self.name = name

    def _path(self, signature, codegen) -> Path | None:
        return entry(self.name, (str(signature), codegen.magic_tuple()))

    def load_overload(self, signature, target_context):
        """The kept machine code of this signature; None, after saying that it compiles, where there
        is none.
        """
        path = self._path(signature, target_context.codegen())
        kept = None if path is None else read(path)
        if kept is None:
            where = "not kept" if path is None else f"kept in {path.parent}"
            log_once(
                "compiling",
                "compiling kernels for this machine, a few seconds each (%s)",
                where,
            )
            return None
        # Of what Numba loads before it compiles, code that is complete needs the runtime alone,
        # which counts references; all of it takes four times as long as the rest, more so where
        # SciPy is installed.
        rtsys.initialize(target_context)
        return CompileResult._rebuild(target_context, *pickle.loads(kept))

    def save_overload(self, signature, compiled) -> None:
        """Keep the machine code of this signature."""
        path = self._path(signature, compiled.codegen)
        if path is not None:
            write(path, serialize.dumps(compiled._reduce()))


def _open_regular(path, flags):
    """Opened without following a link, and without waiting where it is a pipe."""
    return os.open(path, flags | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
