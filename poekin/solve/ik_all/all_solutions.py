"""All solutions of targets, as they are handed out, and how sure it is that they are all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal, get_args

import numpy as np

from ...checks import choice
from ...errors import InputError
from ...groups.arrays import Array
from ...model.chain import Chain
from ...results import Result
from ..ik.solution import place
from ..joint_units import bounds
from ..ragged import LazySequence, Ragged
from .solution_sets.evidence import Evidence
from .swivel import curves

MethodUsed = Literal["closed form", "elimination", "search"]
PerSolution = Literal["solutions", "n_revolutions"]


@dataclass(frozen=True, eq=False)
class AllSolutions(Result):
    """Every solution of each target, by `ik_all`; the solutions of all targets are one array.

    Attributes
    ----------
    q : (S, m) ndarray
        Coordinates of all solutions, rad or m: those of the first target of the batch, in C order,
        then those of the next; sorted within each target.
    revolutions : (S,) ndarray of int
        Number of places within the limits that each solution stands for, whole turns of some joints
        apart. A coordinate without limits counts once; 2^63 - 1 stands for more, too.
    counts : (...) ndarray of int
        Number of solutions of each target.
    method : {"closed form", "elimination", "search"}
        Method that found them.
    anywhere : (...) ndarray of int
        Number of solutions without limits.
    continuum : (...) ndarray of bool
        Whether there are infinitely many: one of them is listed, and those that stand alone; of a
        redundant arm those at some values of the coordinate `redundant`.
    complete : bool, or (...) ndarray of bool
        Whether these are all the solutions: by a closed form or elimination of the arm itself, or
        of a near arm whose branches are all clear of double ones. False for a search, a continuum,
        and a target that is not finite. `explanation` says why.
    p_missing : (...) ndarray
        Probability of a solution missing: 0 where `complete`, NaN where nothing was found by
        search, where there is a continuum, where only a near arm has a closed form, and of a target
        that is not finite.
    position_error, rotation_error : (...) ndarray
        Largest errors of the listed solutions by `Chain.fk`, m and rad; NaN without any.
    self_motion_coordinates : dict of int to tuple of str
        Names of the coordinates that move along a continuum, by number of the target in C order.
    self_motion_directions : dict of int to (m,) ndarray
        Direction in which the continuum goes on from the solution that is listed of it, by number of
        the row of `q`: the unit vector n of coordinates with J n = 0; q + h n moves the tool by some
        h² at most. -n leads along it the other way.
    redundant : str or None
        Name of the coordinate that was given values, of an arm with seven coordinates.
    sample : (S,) ndarray of int, or None
        Number of the value of `redundant` that each solution has.
    evidence : Evidence or None
        What `explanation` is made of; None of a result that was put together by hand.
    chain : Chain or None
        The arm; None of a result that was put together by hand.
    target : (..., 4, 4) ndarray or None
        Target poses of the tip in the base frame, m.
    limits : bool
        Whether only solutions within the arm's limits are listed.
    """

    derived: ClassVar = ("solutions", "n_revolutions", "explanation")
    left_out = ("q", "revolutions", "evidence", "chain", "target", "limits")

    q: Array
    revolutions: np.ndarray
    counts: np.ndarray
    method: MethodUsed
    anywhere: np.ndarray
    continuum: np.ndarray
    complete: Any
    p_missing: Array
    position_error: Array
    rotation_error: Array
    self_motion_coordinates: dict[int, tuple[str, ...]]
    self_motion_directions: dict[int, Array] = field(default_factory=dict)
    redundant: str | None = None
    sample: np.ndarray | None = None
    evidence: Evidence | None = None
    chain: Chain | None = None
    target: Array | None = None
    limits: bool = True

    @property
    def solutions(self) -> Any:
        """Coordinates (s, m), rad or m; of a batch a sequence of them, its targets in C order."""
        return self._parts(self.q)

    @property
    def n_revolutions(self) -> Any:
        """Numbers of places (s,) of the solutions; of a batch a sequence of them."""
        return self._parts(self.revolutions)

    @property
    def explanation(self) -> Any:
        """Sentence on how many solutions there are and how they were found; of a batch a sequence.

        Says how sure it is that they are all; of a batch each is made when it is asked for.
        """
        if not self.counts.ndim:
            return self._sentence(0)
        return LazySequence(self.counts.size, self._sentence)

    @property
    def target_number(self) -> np.ndarray:
        """Number of the target (S,), in C order, of each row of `q`."""
        return np.repeat(np.arange(self.counts.size), self.counts.ravel())

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
        flat = place(index, self.counts.shape, "of")
        return Ragged(self.q, self.counts.ravel())[flat]

    def padded(self, what: PerSolution = "solutions") -> np.ndarray:
        """Solutions of all targets in one array, filled up to as many for each.

        Parameters
        ----------
        what : {"solutions", "n_revolutions"}, default "solutions"
            Coordinates, or the numbers of places.

        Returns
        -------
        array : (..., most, m) ndarray, or (..., most) of int
            Coordinates, rad or m, then rows of NaN; numbers of places, then 0. `most` is the
            largest of `counts`.

        Raises
        ------
        InputError
            If `what` is none of these.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> T = arm.fk([[0.4, -1.2, 1.5, -0.3, 0.8, 0.0], [0.0, -1.2, 1.5, -0.3, 0.1, 0.2]])
        >>> every = pk.ik_all(arm, T, method="search")
        >>> every.counts.tolist(), every.padded().shape
        ([8, 8], (2, 8, 6))
        """
        choice(what, get_args(PerSolution), "what")
        rows = self.q if what == "solutions" else self.revolutions
        fill = np.nan if what == "solutions" else 0
        whole = Ragged(rows, self.counts.ravel()).padded(fill)
        return whole.reshape(*self.counts.shape, *whole.shape[1:])

    def families(self, *index: int) -> list[Array]:
        """Curves of self-motion of a redundant arm: the solutions of one target in order.

        Each solution is linked to that at the next value of `redundant` which continues it. A curve
        ends where a limit cuts it, where `redundant` turns back along it, and at a singularity; one
        that goes on over a whole turn of `redundant` begins and ends at the least and the largest
        value.

        Parameters
        ----------
        *index : int
            Index of the target in the batch.

        Returns
        -------
        families : list of (l, m) ndarray
            Configurations along each curve, rad or m, the longest curves first.

        Raises
        ------
        InputError
            If the result is not of a redundant arm with `n_swivel`.
        ShapeError
            If the index has not as many numbers as the batch has axes.
        IndexError
            If there is no such target.

        Notes
        -----
        Source: the tangent of the curve is the null vector of the Jacobian (Burdick 1989).
        """
        if self.redundant is None or self.sample is None or self.chain is None:
            raise InputError(
                "families: expected a result of ik_all with n_swivel, of a redundant arm"
            )
        flat = place(index, self.counts.shape, "families")
        counts = self.counts.ravel()
        q = Ragged(self.q, counts)[flat]
        within = bounds(self.chain, self.limits)
        return curves(self.chain, q, Ragged(self.sample, counts)[flat], self.redundant, within)

    def summary(self) -> str:
        """`explanation` of one target, or the number of all solutions of a batch.

        Returns
        -------
        text : str
            One sentence.
        """
        if not self.counts.ndim:
            return self.explanation
        return f"{len(self.q)} solutions of {self.counts.size} targets, by {self.method}"

    def _parts(self, rows: np.ndarray) -> np.ndarray | Sequence[np.ndarray]:
        return Ragged(rows, self.counts.ravel()) if self.counts.ndim else rows

    def _sentence(self, k: int) -> str:
        if self.evidence is not None:
            return self.evidence.sentence(k)
        s = int(self.counts.flat[k])
        return f"{s} solution{'s' * (s != 1)}"

    def __repr__(self) -> str:
        if not self.counts.ndim:
            return f"<AllSolutions by {self.method}: {self.explanation}>"
        return (
            f"<AllSolutions of {self.counts.size} targets by {self.method}: {len(self.q)} in all>"
        )
