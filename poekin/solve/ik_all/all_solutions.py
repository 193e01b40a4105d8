"""All solutions of targets, as they are handed out, and how sure it is that they are all."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ...errors import join_names
from ...groups.arrays import Array
from ...model.chain import Chain
from ...results import Result
from ..ik.solution import place
from .ik_all_search import Found

MethodUsed = Literal["closed form", "search"]


@dataclass(frozen=True, eq=False)
class AllSolutions(Result):
    """Every solution of each target, by `ik_all`.

    Attributes
    ----------
    solutions : (s, m) ndarray, or list of them
        Coordinates, rad or m, sorted; of a batch a list, its targets in C order.
    n_revolutions : (s,) ndarray of int, or list of them
        Number of places within the limits that each solution stands for, whole turns of some joints
        apart. A coordinate without limits counts once; 2^63 - 1 stands for more, too.
    complete : str, or list of them
        Statement of how sure it is that these are all.
    method : {"closed form", "search"}
        Method that found them.
    count : (...) ndarray of int
        Number of solutions.
    anywhere : (...) ndarray of int
        Number of solutions without limits.
    continuum : (...) ndarray of bool
        Whether there are infinitely many: one of them is listed, and those that stand alone.
    p_missing : (...) ndarray
        Probability of a solution missing: 0 for the closed form, NaN where nothing was found or
        there is a continuum.
    position_error, rotation_error : (...) ndarray
        Largest errors of the listed solutions by `Chain.fk`, m and rad; NaN without any.
    chain : Chain or None
        The arm; None of a result that was put together by hand.
    target : (..., 4, 4) ndarray or None
        Target poses of the tip in the base frame, m.
    """

    left_out = ("chain", "target")

    solutions: Any
    n_revolutions: Any
    complete: Any
    method: MethodUsed
    count: np.ndarray
    anywhere: np.ndarray
    continuum: np.ndarray
    p_missing: Array
    position_error: Array
    rotation_error: Array
    chain: Chain | None = None
    target: Array | None = None

    def of(self, *index: int) -> Array:
        """Solutions of one target of a batch.

        Parameters
        ----------
        *index : int
            Index of the target in the batch.

        Returns
        -------
        solutions : (s, m) ndarray
            Coordinates, rad or m.

        Raises
        ------
        ShapeError
            If the index has not as many numbers as the batch has axes.
        IndexError
            If there is no such target.

        Notes
        -----
        Source: those of `ik_all`.
        """
        flat = place(index, self.count.shape, "of")
        if not index:
            return self.solutions
        return self.solutions[flat]

    def summary(self) -> str:
        """`complete` of one target, or the number of all solutions of a batch.

        Returns
        -------
        text : str
            One sentence.
        """
        if self.count.ndim == 0:
            return self.complete
        return f"{int(self.count.sum())} solutions of {self.count.size} targets, by {self.method}"

    def __repr__(self) -> str:
        if self.count.ndim == 0:
            return f"<AllSolutions by {self.method}: {self.complete}>"
        return f"<AllSolutions of {self.count.size} targets by {self.method}: {int(self.count.sum())} in all>"


def missing_probability(found: Found) -> float:
    """The chance that a solution is missing which a try finds half as often as the rarest of those
    that were found.

    Of a solution that is the end of a share p of the tries that end at any, nothing is seen in N of
    them with the chance (1 - p)^N; p is set to half the smallest share seen. The closed form misses
    none.
    """
    nothing = found.restarts and not len(found.solutions)
    if found.self_motion_coordinates or found.full or nothing:
        return math.nan
    if not found.restarts:
        return 0.0
    share = 0.5 * found.hits.min() / found.ends
    return float((1.0 - share) ** found.ends)


def in_words(found: Found, inside: int, closed: str | None) -> str:
    """A sentence on the solutions of a target: their number, that inside the limits, the way they
    were found, and the chance of more.

    `closed` says which closed form found them, None is for the search.
    """
    s = len(found.solutions)
    if found.self_motion_coordinates:
        alone = ""
        if s > 1:
            alone = f" and {s - 1} that stand{'s' * (s == 2)} alone"
        names = join_names(found.self_motion_coordinates)
        said = f"infinitely many solutions, along which {names} move; one of them{alone}"
    else:
        said = f"{'at least ' * found.full}{s} solution{'s' * (s != 1)}"
    if inside != s:
        said += f", {inside} of them within the limits"
    if not found.restarts:
        return f"{said}: {closed}"
    said += f": search, {found.restarts} tries"
    if not s or found.self_motion_coordinates or found.full:
        return said
    said += (
        f", each found {int(found.hits.min())} times or more; one that is half as easy to find as the rarest is "
        f"missing with a chance of {missing_probability(found):.1g}"
    )
    odd = s % 2 == 1 and found.solutions.shape[1] == 6
    return said + "; the number is odd: one of them is a double one, or one is missing" * odd
