"""Parameters of an arm that a calibration may estimate: which are free, and their names."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import compress
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, UnknownName, quote, safe_repr, suggest
from ....groups.arrays import Array
from ....model.chain import Chain

ParameterKind = Literal["screws", "home", "offsets", "gains", "pitch"]
Unit = Literal[
    "rad", "m", "1", "m/rad", "rad/m", "rad/(N m)", "m/N", "rad/s", "m/s", "rad/K", "m/K"
]
Mask = NDArray[np.bool_]
KINDS: tuple[ParameterKind, ...] = get_args(ParameterKind)
ROTATIONS = ("turn about x", "turn about y", "turn about z")
TRANSLATIONS = ("shift along x", "shift along y", "shift along z")
# of an axis: a home pose is shifted "along x"
TILT = "tilt about ("
SHIFT = "shift along ("
# of the four directions in which an axis moves, tilt and shift: columns of its z-aligned frame
_SHIFT = slice(2, 4)


class Parameter(NamedTuple):
    """One number that a calibration estimates.

    Parameters
    ----------
    owner : str
        A joint, a coordinate, "home", or an unknown frame.
    what : str
        What it is, such as "tilt about (1, 0, 0)".
    unit : {"rad", "m", "1", "m/rad", "rad/m", "rad/(N m)", "m/N", "rad/s", "m/s", "rad/K", "m/K"}
        Its unit.
    """

    owner: str
    what: str
    unit: Unit

    @property
    def name(self) -> str:
        """Owner and what, as messages and files call it."""
        return f"{self.owner}: {self.what}"


class Free(NamedTuple):
    """Masks of the free parameters: tilts and shifts of the axes (n, 4), pitches (n,), the home pose
    (6,), offsets and gains (m,).
    """

    screws: Mask
    pitches: Mask
    home: Mask
    offsets: Mask
    gains: Mask


def free_parameters(
    nominal: Chain,
    kinds: tuple[str, ...],
    chosen: Mask,
) -> Free:
    """Parameters of these kinds of the chosen joints (n,), and of the coordinates that move them."""
    screws = np.tile(chosen[:, None], 4)
    screws[nominal.local.rotates == 0, _SHIFT] = False
    pitched = chosen & (np.array(nominal.kinds, "U9") != "prismatic")
    moved = np.abs(nominal.coupling[chosen]).sum(0) > 0
    return Free(
        screws=screws & ("screws" in kinds),
        pitches=pitched & ("pitch" in kinds),
        home=np.full(6, "home" in kinds),
        offsets=moved & ("offsets" in kinds),
        gains=moved & ("gains" in kinds),
    )


def names(
    nominal: Chain,
    free: Free,
    frames: Array,
) -> tuple[Parameter, ...]:
    """Names of the free parameters in the order of p; frames (n, 4, 4) of the joints at home."""
    found = _axis_names(nominal.joint_names, free, frames)
    pitched = compress(nominal.joint_names, free.pitches)
    found += [Parameter(name, "pitch", "m/rad") for name in pitched]
    if free.home.any():
        found += frame_parameters("home")
    for k in np.flatnonzero(free.offsets):
        unit: Unit = "rad" if nominal.is_angle(int(k)) else "m"
        found.append(Parameter(nominal.q_names[k], "offset", unit))
    scaled = compress(nominal.q_names, free.gains)
    found += [Parameter(name, "gain", "1") for name in scaled]
    return tuple(found)


def frame_parameters(owner: str, size: int = 6) -> list[Parameter]:
    """The six parameters of a pose, or the three of a point."""
    rotations = [Parameter(owner, what, "rad") for what in ROTATIONS]
    translations = [Parameter(owner, what, "m") for what in TRANSLATIONS]
    return [*rotations, *translations][-size:]


def _axis_names(
    joint_names: Sequence[str],
    free: Free,
    frames: Array,
) -> list[Parameter]:
    across = (np.round(frames[:, :3, :2], 6) + 0.0).tolist()
    found = []
    for i, k in np.argwhere(free.screws).tolist():
        direction = ", ".join(f"{row[k % 2]:.3g}" for row in across[i])
        if k < _SHIFT.start:
            found.append(Parameter(joint_names[i], f"{TILT}{direction})", "rad"))
        else:
            found.append(Parameter(joint_names[i], f"{SHIFT}{direction})", "m"))
    return found


def parse_kinds(kinds: Sequence[Any], others: Sequence[str] = ()) -> tuple[Any, ...]:
    """Kinds of parameters, one or several; those that are no words are passed. Raises: InputError."""
    every = _several(kinds, "parameters")
    names = (*KINDS, *others)
    known = ", ".join(map(repr, names))
    for kind in every:
        if isinstance(kind, str) and kind not in names:
            raise InputError(f"parameters: expected some of {known}, got {safe_repr(kind)}")
    if not every:
        raise InputError(f"parameters: nothing to calibrate; expected some of {known}")
    return every


def parse_joints(chain: Chain, joints: Sequence[str] | None) -> Mask:
    """Mask (n,) of the joints that are named, all of them for None. Raises: UnknownName."""
    if joints is None:
        return np.ones(len(chain.joint_names), bool)
    named = _several(joints, "joints")
    for name in named:
        if name not in chain.joint_names:
            near = suggest(str(name), chain.joint_names)
            raise UnknownName(f"joints: no joint {quote(name)}; {near}")
    return np.array([name in named for name in chain.joint_names], bool)


def _several(names: Sequence[Any], what: str) -> tuple[Any, ...]:
    if isinstance(names, str):
        return (names,)
    if not isinstance(names, Iterable):
        raise InputError(f"{what}: expected names, got {safe_repr(names)}")
    return tuple(names)
