"""Evidence on the solutions of each target: the way they were found, and how sure it is that they
are all, in numbers and in words.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ....errors import join_names
from ....groups.arrays import Array
from .found import Tally
from .self_motion import SelfMotion

BAD_TARGET = "0 solutions: bad target, it is not made of finite numbers"


@dataclass(frozen=True)
class SolverUsed:
    """The closed form or elimination that found solutions: `method`; `said`, which one, in words."""

    method: Literal["closed form", "elimination"]
    said: str


@dataclass(frozen=True)
class Sampling:
    """The coordinate of a redundant arm that was given values: its name, and how many values."""

    name: str
    count: int


@dataclass(frozen=True, eq=False)
class Evidence:
    """Evidence on the way the solutions of N targets were found; arrays over them (N,).

    Attributes: finite, whether a target is made of finite numbers; found, solutions without limits;
    within, those within the limits; least_hits, how often the rarest of them was found; ends, tries
    that ended at any; restarts, random tries, 0 where a closed form was enough; full, whether there
    may be more for want of room; sure, as of `Tally`; p_missing, see `missing_probability`; self_motion, by number of
    the target its continuum; free, how many coordinates may move;
    solver, None for the search; sampling, None but for redundant arms.
    """

    finite: np.ndarray
    found: np.ndarray
    within: np.ndarray
    least_hits: Array
    ends: np.ndarray
    restarts: np.ndarray
    full: np.ndarray
    sure: np.ndarray
    p_missing: Array
    self_motion: Mapping[int, SelfMotion]
    free: int
    solver: SolverUsed | None
    sampling: Sampling | None = None

    @property
    def continuum(self) -> np.ndarray:
        """Whether each target has infinitely many solutions (N,)."""
        if self.sampling is not None:
            return self.found > 0
        return has_self_motion(self.self_motion, len(self.found))

    @property
    def complete(self) -> np.ndarray:
        """Whether each target's solutions are surely all (N,): a solver of the arm itself found them
        (`sure`), and no search had to begin again, ran out of room or met a continuum.
        """
        return self.sure & self.finite & (self.restarts == 0) & ~self.full & ~self.continuum

    def sentence(self, k: int) -> str:
        """Number of the solutions of target k, and of those inside the limits, the way they were
        found, and the chance of more.
        """
        if not self.finite[k]:
            return BAD_TARGET
        said = self._number(k)
        found = self.found[k]
        if self.within[k] != found:
            said += f", {self.within[k]} of them within the limits"
        if not self.restarts[k] and self.solver is not None:
            return f"{said}: {self.solver.said}"
        said += f": search, {self.restarts[k]} tries"
        if not found or k in self.self_motion or self.full[k]:
            return said
        p_missing = self.p_missing[k]
        if np.isnan(p_missing):
            return f"{said}; at some values it is not known whether one is missing"
        said += f", each found {int(self.least_hits[k])} times or more; "
        if self.sampling is not None:
            return f"{said}one is missing with a chance of {p_missing:.1g}"
        said += (
            "one that is half as easy to find as the rarest is missing with a chance of "
            f"{p_missing:.1g}"
        )
        if found % 2 == 1 and self.free == 6:
            said += "; the number is odd: one of them is a double one, or one is missing"
        return said

    def _number(self, k: int) -> str:
        s = int(self.found[k])
        counted = f"{s} solution{'s' * (s != 1)}"
        if self.full[k]:
            counted = f"at least {counted}"
        if self.sampling is not None:
            values = f"{self.sampling.count} values of {join_names([self.sampling.name])}"
            if not s:
                return f"0 solutions at {values}"
            return f"infinitely many solutions; {counted} at {values}"
        if k not in self.self_motion:
            return counted
        alone = ""
        if s > 1:
            alone = f" and {s - 1} that stand{'s' * (s == 2)} alone"
        names = join_names(self.self_motion[k].names)
        return f"infinitely many solutions, along which {names} move; one of them{alone}"


def has_self_motion(self_motion: Mapping[int, SelfMotion], count: int) -> np.ndarray:
    """Whether each of `count` targets has coordinates that move along a continuum."""
    has = np.zeros(count, bool)
    has[list(self_motion)] = True
    return has


def missing_probability(tally: Tally) -> Array:
    """The chance (N,) that a solution is missing which a try finds half as often as the rarest of
    those that were found.

    Of a solution that is the end of a share p of the tries that end at any, nothing is seen in N of
    them with the chance (1 - p)^N; p is set to half the smallest share seen. An exact closed form
    misses none. NaN where nothing is known: without solutions of a search, of a continuum, without
    room for more, and of the closed form of another arm.
    """
    searched = tally.restarts > 0
    ends = np.maximum(tally.ends, 1)
    chance = (1.0 - 0.5 * tally.least_hits / ends) ** ends
    chance = np.where(searched, chance, np.where(tally.sure, 0.0, np.nan))
    nothing = searched & (tally.found == 0)
    moving = has_self_motion(tally.self_motion, len(tally.found))
    chance[nothing | tally.full | moving] = np.nan
    return chance
