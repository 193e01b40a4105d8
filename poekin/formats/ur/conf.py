"""Deltas to the nominal DH table in calibration.conf, a file of Universal Robots' controllers."""

from __future__ import annotations

import os
import re

from ...errors import FileError, ModelError, escape_unprintable, quote, suggest
from ..text import xml
from ..text.numbers import real
from .calibration import JOINTS

DELTAS = ("delta_theta", "delta_a", "delta_d", "delta_alpha")
LARGEST = 64 * 2**10

_LINE = re.compile(r"\s*([A-Za-z_]\w*)\s*=\s*(.*)")


def read_text_file(path: str | os.PathLike[str]) -> tuple[str, str]:
    """The text of a small file, and what to call the file in messages.

    Raises: FileError where it cannot be read, is larger than 64 KiB (a calibration has 1 or 2) or
    not UTF-8.
    """
    data = xml.read_bytes(path)
    place = escape_unprintable(os.fsdecode(path), 400)
    if len(data) > LARGEST:
        raise FileError(
            f"{place}: expected a calibration of at most 64 KiB, the file has {len(data) / 2**10:.0f} KiB"
        )
    return xml.decode(data, place), place


def read_deltas(path: str | os.PathLike[str]) -> dict[str, tuple[float, ...]]:
    """The deltas in a calibration.conf: delta_theta, delta_alpha [rad], delta_a, delta_d [m], one
    number a joint.

    For `add_deltas`: `pk.ur.add_deltas(pk.dh.published("ur10e"), **pk.ur.read_deltas("calibration.conf"))`.

    The file has lines `delta_a = [ 1e-4, ... ]` under [mounting], and others that do not matter
    here.
    Parameters: path, of the file. Returns: dict of six numbers each.
    Raises: FileError for a file that cannot be read or is larger than 64 KiB; ModelError with file
    and line for a delta that is missing, there twice, not six numbers or not finite.
    Accuracy: numbers as they are written. Source: such files as owners of arms show them in the
    forum of Universal Robots, as "Calibrated kinamatics info"; there is no published description.
    """
    text, place = read_text_file(path)
    found: dict[str, tuple[float, ...]] = {}
    lines: dict[str, int] = {}
    similar: list[str] = []
    for number, line in enumerate(text.splitlines(), 1):
        match = _LINE.fullmatch(line.partition("#")[0].rstrip())
        if match is None:
            continue
        name, value = match.groups()
        if name not in DELTAS:
            similar.append(name)
            continue
        where = f"{place}:{number}: {name}"
        if name in found:
            raise ModelError(f"{where}: it is there twice (first: line {lines[name]})")
        found[name] = _numbers(value, where)
        lines[name] = number
    for name in DELTAS:
        if name not in found:
            message = f"{place}: {name} is missing; needed are {', '.join(DELTAS)}"
            if similar:
                message += f"; {suggest(name, similar)}"
            raise ModelError(message)
    return found


def _numbers(text: str, where: str) -> tuple[float, ...]:
    if not (text.startswith("[") and text.endswith("]")):
        raise ModelError(f"{where}: expected numbers in brackets, got {quote(text)}")
    words = text[1:-1].split(",")
    if len(words) != len(JOINTS):
        raise ModelError(
            f"{where}: expected {len(JOINTS)} numbers, one a joint, got {len(words)}: the calibration of another arm?"
        )
    values = [real(word.strip()) for word in words]
    for word, value in zip(words, values, strict=True):
        if value is None or not abs(value) < float("inf"):
            raise ModelError(f"{where}: expected a finite number, got {quote(word.strip())}")
    return tuple(value for value in values if value is not None)
