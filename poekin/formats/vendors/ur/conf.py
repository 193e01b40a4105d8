"""Deltas to the nominal DH table in calibration.conf, a file of Universal Robots' controllers."""

from __future__ import annotations

import re

from ....errors import ModelError, quote, suggest
from ...text import xml
from ...text.atomic_write import FilePath
from ...text.numbers import real
from ..naming import JOINTS

DELTAS = ("delta_theta", "delta_a", "delta_d", "delta_alpha")
LARGEST = 64 * 2**10
"""Bytes of a file: a calibration has one or two thousand."""

_LINE = re.compile(r"\s*([A-Za-z_]\w*)\s*=\s*(.*)")


def read_deltas(path: FilePath) -> dict[str, tuple[float, ...]]:
    """Deltas in a calibration.conf, the file of a controller of Universal Robots, for `add_deltas`.

    The file has lines `delta_a = [ 1e-4, ... ]` under [mounting], and others that do not matter
    here.

    Parameters
    ----------
    path : str or os.PathLike
        Path of the file.

    Returns
    -------
    deltas : dict
        The columns delta_theta, delta_alpha [rad], delta_a and delta_d [m], six numbers each.

    Raises
    ------
    FileError
        If the file cannot be read or is larger than 64 KiB.
    ModelError
        If a delta is missing, there twice, not six numbers or not finite, with file and line.

    Notes
    -----
    Accuracy: numbers as they are written. Source: such files as owners of arms show them in the
    forum of Universal Robots, as "Calibrated kinamatics info"; there is no published description.

    Examples
    --------
    >>> import poekin as pk
    >>> with open("calibration.conf", "w") as file:
    ...     for name in ("delta_theta", "delta_a", "delta_d", "delta_alpha"):
    ...         print(f"{name} = [ 1e-4, 0, 0, 0, 0, 0 ]", file=file)
    >>> deltas = pk.ur.read_deltas("calibration.conf")
    >>> table = pk.ur.add_deltas(pk.dh.published("ur10e"), **deltas)
    >>> round(float(table.a[0]), 9)
    0.0001
    """
    text, place = xml.read_text(path, LARGEST)
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
            raise ModelError(f"{where}: it appears twice (first: line {lines[name]})")
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
