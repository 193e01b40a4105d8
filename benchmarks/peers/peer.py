"""What a peer is: another library that does what poekin does, called in its fastest documented way.

A peer's own functions take and return what that library's users have in hand. What turns poekin's
arrays into that and back (`native`, `arrays`) is for setup and judgement: it stays outside the
clock.
"""

from __future__ import annotations

import importlib
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import Any, Literal

import numpy as np

from poekin import Chain, se3, to_urdf

Array = np.ndarray
Arrays = tuple[Array, Array]


def _same(x: Any) -> Any:
    return x


@dataclass(frozen=True)
class Arm:
    """An arm as every library can be given it: its screws, and URDF text with the same base, tip
    and joint names.

    The joints are revolute or prismatic, each with a coordinate of its own.
    """

    chain: Chain

    @property
    def urdf(self) -> str:
        """The text of `to_urdf`: links and joints, no mesh."""
        return to_urdf(self.chain)


@dataclass(frozen=True)
class Kinematics:
    """A peer's kinematics of one arm.

    frame: of its Jacobian; fk(q), fk_jacobian(q) -> (T, J): one configuration in the peer's own
    form; batch: whether both take many at once, in the peer's own form of a batch; native(q):
    configurations (N, m) in that form, a list of N where there is no batch; arrays(T, J): what the
    peer returned, of one or of a batch, as T_sb (..., 4, 4) and J (..., 6, m), rows (omega; v);
    pose(T), the same of what fk returned. fk_jacobian is None where there is no Jacobian. note:
    what a reader of the times ought to know.
    """

    frame: Literal["space", "body", "hybrid"]
    fk: Callable[[Any], Any]
    fk_jacobian: Callable[[Any], Any] | None
    pose: Callable[[Any], Array] = _same
    arrays: Callable[[Any, Any], Arrays] = lambda T, J: (T, J)
    native: Callable[[Array], Any] = list
    batch: bool = False
    note: str = ""


@dataclass(frozen=True)
class Group:
    """A peer's exp: twist (6,) -> pose (4, 4), and log.

    linear_first: whether its twists are (v; omega); batch: whether both take (N, 6) and (N, 4, 4)
    at once; native, twists and poses: arrays to its own form and back, where that is not the array
    itself.
    """

    exp: Callable[[Any], Any]
    log: Callable[[Any], Any]
    linear_first: bool
    batch: bool = False
    native: Callable[[Array], Any] = _same
    plain: Callable[[Any], Array] = np.asarray

    def twists(self, xi: Array) -> Array:
        """Twists (..., 6) between poekin's order (omega; v) and the peer's: the same way in both
        directions.
        """
        return se3.linear_first(xi) if self.linear_first else xi

    def exp_of(self, xi: Array) -> Array:
        """Poses (N, 4, 4) of twists (N, 6), (omega; v), by the peer."""
        return self._many(self.exp, self.twists(xi))

    def log_of(self, T: Array) -> Array:
        """Twists (N, 6), (omega; v), of poses (N, 4, 4), by the peer."""
        return self.twists(self._many(self.log, T))

    def _many(self, function: Callable[[Any], Any], x: Array) -> Array:
        if self.batch:
            return self.plain(function(self.native(x)))
        return np.stack([self.plain(function(self.native(np.ascontiguousarray(one)))) for one in x])


@dataclass(frozen=True)
class Peer:
    """A library: name, the distribution that holds it, the module it is imported as, and what it
    can do.

    group() -> Group and kinematics(arm) -> Kinematics import the library; None where it has no such
    thing.
    """

    name: str
    distribution: str
    module: str
    group: Callable[[], Group] | None = None
    kinematics: Callable[[Arm], Kinematics] | None = None

    @property
    def version(self) -> str:
        """The version installed, or "absent"."""
        try:
            return version(self.distribution)
        except PackageNotFoundError:
            return "absent"


@dataclass(frozen=True)
class Found:
    """A peer on this machine; problem says in one line why it cannot be used, empty where it can."""

    peer: Peer
    problem: str = ""

    @property
    def label(self) -> str:
        """Name, and version where there is one."""
        return (
            self.peer.name
            if self.peer.version == "absent"
            else f"{self.peer.name} {self.peer.version}"
        )


def find(peers: Iterable[Peer]) -> list[Found]:
    """Which of these peers can be imported, and why the others cannot."""
    return [Found(peer, _problem(peer)) for peer in peers]


def module(name: str) -> Any:
    """A module by its name, without types, as few peers have any, and without what its import warns
    of: a source that is compiled for the first time may say how it is written.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return importlib.import_module(name)


def _problem(peer: Peer) -> str:
    if peer.version == "absent":
        return "absent: not installed"
    _, problem = attempt(lambda: module(peer.module))
    return problem


def attempt(call: Callable[[], Any]) -> tuple[Any, str]:
    """(result, "") of a peer's call, or (None, what is wrong with it in one line)."""
    try:
        return call(), ""
    except Exception as error:  # noqa: BLE001  whatever is broken in a peer: its row says it, and the run goes on
        return None, f"broken: {one_line(error)}"


def one_line(error: BaseException) -> str:
    """The kind and the first words of an error."""
    words = " ".join(str(error).split())
    return f"{type(error).__name__}: {words[:200]}{'…' if len(words) > 200 else ''}"
