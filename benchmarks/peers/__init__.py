"""The libraries that poekin is measured beside: each in a file of its own, used where it is
installed.

A new peer is one file with a `PEER`, and one name below.
"""

from __future__ import annotations

from collections.abc import Sequence

from . import (
    jaxlie,
    modern_robotics,
    mujoco,
    pinocchio,
    pytorch_kinematics,
    pytransform3d,
    robotics_toolbox,
    scipy,
)
from .peer import Arm, Found, Group, Kinematics, Peer, attempt, find, one_line

__all__ = ["OPTIONAL", "STANDARD", "Arm", "Found", "Group", "Kinematics", "Peer", "attempt", "chosen",
           "chosen_names", "find", "names", "one_line", "use"]  # fmt: skip

STANDARD: dict[str, Peer] = {
    "pinocchio": pinocchio.PEER,
    "scipy": scipy.PEER,
    "robotics_toolbox": robotics_toolbox.PEER,
    "modern_robotics": modern_robotics.PEER,
    "mujoco": mujoco.PEER,
    "jaxlie": jaxlie.PEER,
    "pytransform3d": pytransform3d.PEER,
}
OPTIONAL: dict[str, Peer] = {
    "pytorch_kinematics": pytorch_kinematics.PEER,
}

_chosen: list[Peer] = list(STANDARD.values())


def names() -> list[str]:
    """What `use` takes."""
    return [*STANDARD, *OPTIONAL, "standard", "all"]


def use(words: Sequence[str]) -> None:
    """Choose the peers of this run by their names; "standard" and "all" stand for several."""
    every = STANDARD | OPTIONAL
    groups = {"standard": list(STANDARD), "all": list(every)}
    wanted = {name for word in words for name in groups.get(word, [word])}
    _chosen[:] = [peer for name, peer in every.items() if name in wanted]


def chosen_names() -> list[str]:
    """Names of the peers of this run, for `use` in another process."""
    return [name for name, peer in (STANDARD | OPTIONAL).items() if peer in _chosen]


def chosen() -> list[Found]:
    """The peers of this run, as they are found on this machine."""
    return find(_chosen)
