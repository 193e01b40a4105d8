"""Events of a path, each with its sentence."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Literal

from ...errors import quote
from .path_interval import PathInterval

EventKind = Literal["missed", "switch", "limit", "speed", "acceleration", "singular"]


@dataclass(frozen=True)
class PathEvent:
    """Event on a path, and where.

    Attributes
    ----------
    first, last : int
        Numbers of the first and the last point.
    kind : {"missed", "switch", "limit", "speed", "acceleration", "singular"}
        Poses not reached, a change of branch, a coordinate at its limit, a rate or an acceleration
        above it, or the neighbourhood of a singularity.
    text : str
        Sentence.
    """

    first: int
    last: int
    kind: EventKind
    text: str


def events_of(
    kind: EventKind,
    stretches: Iterable[PathInterval],
    words: Callable[[PathInterval], str],
) -> Iterator[PathEvent]:
    """An event of a kind for each stretch, with its words."""
    for s in stretches:
        yield PathEvent(s.first, s.last, kind, words(s))


def at_limit(s: PathInterval) -> str:
    """Sentence on a coordinate at its limit."""
    return f"{points(s)}: {quote(s.name)} at its limit {s.bound:.6g}"


def joint_at_limit(s: PathInterval) -> str:
    """Sentence on a joint at its own limit."""
    return f"{points(s)}: joint {quote(s.name)} at its own limit {s.bound:.6g}"


def exceeds(s: PathInterval, what: str, unit: str) -> str:
    """Sentence on a rate or an acceleration above its bound."""
    return (
        f"{points(s)}: {quote(s.name)} exceeds its {what}, "
        f"{s.value:.4g} of {s.bound:.4g} (rad or m)/{unit} at {s.worst}"
    )


def points(s: PathInterval) -> str:
    """The points of an interval, in words."""
    return f"pose {s.first}" if s.first == s.last else f"poses {s.first} to {s.last}"
