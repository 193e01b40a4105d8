"""Chains as tables of TOML, to the last bit, and the calibrated chain of a calibration's file."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import ModelError, PoekinError, join_names
from ..model.chain import Chain
from ..model.provenance import warn
from ..model.robot import Robot
from .serial import serial_robot
from .text import toml_text, xml
from .text.atomic_write import FilePath
from .text.toml_text import Keys

FORMAT = "poekin calibration"
"""`format` in the file of a calibration (`poekin.solve.calibration.report.toml_io`)."""
VERSION = 1
"""`version` in the file of a calibration."""
NOMINAL = "nominal"
CALIBRATED = "calibrated"
"""Keys of the nominal and of the calibrated chain in the file of a calibration."""
TERMS = "the calibration has non-geometric terms"
"""What a warning says first where the calibrated chain is not all of a calibration."""
GEOMETRIC = ("screws", "home", "offsets", "gains", "pitch")
"""Kinds of parameters that a chain has; all others are terms of the readings."""
_NAMES = ("base", "tip", "joint_names", "q_names")
_ARRAYS = ("screws", "home", "limits", "offset")
_LIMITS = ("velocity_limits", "joint_limits", "joint_velocity_limits")
_KEYS = (*_NAMES, *_ARRAYS, "coupling", "pitches", "masses", *_LIMITS)


def to_data(chain: Chain) -> dict[str, Any]:
    """Table of a chain: frames, names, screws, home pose, limits, offset; coupling, pitches, masses
    and further limits where there are such.
    """
    data: dict[str, Any] = {
        "base": chain.base,
        "tip": chain.tip,
        "joint_names": list(chain.joint_names),
        "q_names": list(chain.q_names),
    }
    data |= {key: getattr(chain, key).tolist() for key in _ARRAYS}
    if chain.nontrivial_coupling is not None:
        data["coupling"] = chain.nontrivial_coupling.tolist()
    if chain.pitches.any():
        data["pitches"] = chain.pitches.tolist()
    if chain.masses is not None:
        data["masses"] = chain.masses.tolist()
    for key in _LIMITS:
        limits = getattr(chain, key)
        if np.isfinite(limits).any():
            data[key] = limits.tolist()
    return data


def to_chain(keys: Keys) -> Chain:
    """The chain in a table. Raises: ModelError with file and key. Accuracy: equal to the chain that
    was written.
    """
    keys = Keys(keys.data, keys.place, _KEYS)
    joints = keys.texts("joint_names")
    names = keys.texts("q_names")
    n = len(joints)
    m = len(names)
    shapes = {
        "coupling": (n, m),
        "pitches": (n,),
        "masses": (n, 4),
        "velocity_limits": (m,),
        "joint_limits": (n, 2),
        "joint_velocity_limits": (n,),
    }
    arrays = {
        key: keys.array(key, shape, finite=key not in _LIMITS)
        for key, shape in shapes.items()
        if key in keys.data
    }
    try:
        return Chain.from_space(
            keys.array("screws", (n, 6)),
            keys.array("home", (4, 4)),
            joint_names=joints,
            q_names=names,
            limits=keys.array("limits", (m, 2), finite=False),
            offset=keys.array("offset", (n,)),
            **arrays,
            base=keys.text("base"),
            tip=keys.text("tip"),
        )
    except ModelError:
        raise
    except PoekinError as fault:
        raise ModelError(f"{keys.place}: {fault}") from fault


def is_calibration(path: FilePath) -> bool:
    """Whether a .toml file says that it is a calibration; what cannot be read is none."""
    try:
        return toml_text.read(path).get("format") == FORMAT
    except PoekinError:
        return False


def _warn_of_terms(keys: Keys) -> None:
    """Warns where the calibrated chain takes other values than the readings."""
    if "kinds" not in keys.data:
        return
    terms = [kind for kind in keys.texts("kinds") if kind not in GEOMETRIC]
    if terms:
        warn(
            f"{keys.place}: {TERMS} ({join_names(terms)}): the arm takes true joint values, not readings;"
            " pk.calibration.load(path) has true_joints, compensate and emit for these"
        )


def opened(path: FilePath) -> Keys:
    """The file of a calibration, of a version that is known. Raises: FileError; ModelError with
    file and key.
    """
    return opened_text(*xml.read_text(path))


def opened_text(text: str, place: str) -> Keys:
    """The text of such a file; place is what messages call it. Raises: ModelError."""
    keys = Keys(toml_text.parse(text, place), place)
    keys.text("format", (FORMAT,))
    if keys.whole("version") != VERSION:
        raise keys.fault(
            "version",
            f"expected {VERSION}, got {keys.whole('version')}: another version of poekin's",
        )
    return keys


def read_chains(path: FilePath) -> tuple[Chain | None, Chain]:
    """The nominal and the calibrated chain in the file of a calibration, None without a nominal one.

    Raises: FileError; ModelError with file and key. Warns: where there are non-geometric terms.
    """
    keys = opened(path)
    _warn_of_terms(keys)
    nominal = None
    if NOMINAL in keys.data:
        nominal = to_chain(keys.table(NOMINAL))
    return nominal, to_chain(keys.table(CALIBRATED))


def read(path: FilePath) -> Robot:
    """The robot of one branch that moves as the calibrated chain in the file of a calibration.

    Raises: FileError; ModelError with file and key. Warns: as `serial_robot`, where q is not that
    of the chain; where there are non-geometric terms.
    """
    return read_text(*xml.read_text(path))


def read_text(text: str, place: str) -> Robot:
    """The robot in the text of such a file. Raises and warns: as `read`."""
    keys = opened_text(text, place)
    chain = to_chain(keys.table(CALIBRATED))
    _warn_of_terms(keys)
    try:
        return serial_robot(chain)
    except PoekinError as fault:
        raise ModelError(f"{keys.place}: {CALIBRATED}: {fault}") from fault
