"""Samples of a sweep: configurations by number, drawn at random, by Sobol's sequence or on a grid."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..checks import KERNEL_INT, whole
from ..errors import InputError, ShapeError
from ..groups.arrays import Array
from ..model.chain import Chain
from ..model.readings.coupled import beyond_own_limits
from ..model.sampling import sampling_range
from .direction_numbers import MOST, sobol_numbers

_TRIED = 4096
MOST_SAMPLES = 2**56
"""Bound of the number of samples: times up to 64 coordinates it is a 64-bit number too."""


@dataclass(frozen=True, eq=False)
class Samples:
    """Configurations by their numbers 0 ... count - 1, each a function of its number alone.

    Attributes
    ----------
    lower, upper : (m,) ndarray
        Bounds of the coordinates, rad or m.
    count : int
        Number of samples.
    """

    kind: ClassVar[int]

    lower: Array
    upper: Array
    count: int

    @abstractmethod
    def numbers(self) -> np.ndarray:
        """Whole numbers of the kernel: the kind, the seed, the counts of a grid."""

    @abstractmethod
    def describe(self) -> dict[str, object]:
        """Plain data from which the same samples are made again."""

    @property
    def bounds(self) -> Array:
        """Lower bounds and widths (2, m)."""
        widths = self.upper - self.lower
        return np.array([self.lower, widths])

    def configurations(self, numbers: ArrayLike) -> Array:
        """Configurations of samples.

        Parameters
        ----------
        numbers : (N,) array_like of int
            Numbers of samples, each below `count`.

        Returns
        -------
        q : (N, m) ndarray
            Their configurations, rad or m.

        Raises
        ------
        InputError
            If a number is no sample's.
        """
        from ..engine.kernels.sweep import sweep_kernel  # which imports Numba

        rows = sample_numbers(numbers, self.count)
        q = np.empty((len(rows), len(self.lower)))
        sweep_kernel.sampled.call(rows, self.numbers(), self.bounds, q)
        return q


@dataclass(frozen=True, eq=False)
class Random(Samples):
    """Configurations drawn evenly between bounds.

    Attributes
    ----------
    lower, upper : (m,) ndarray
        Bounds of the coordinates, rad or m.
    count : int
        Number of samples.
    seed : int
        Seed of the random numbers; the same seed gives the same samples on every machine.
    """

    kind = 1

    seed: int = 0

    @classmethod
    def of(cls, chain: Chain, count: int, seed: int = 0) -> Random:
        """Samples within a chain's limits.

        Parameters
        ----------
        chain : Chain
            The arm; a coordinate without limits is drawn from one turn, or from 2 m.
        count : int
            Number of samples.
        seed : int, default 0
            Seed of the random numbers.

        Returns
        -------
        samples : Random
            The samples.

        Raises
        ------
        InputError
            If a number cannot be used, the arm has no coordinate, or coordinates within their
            limits take joints beyond their own.
        """
        whole(count, "count", 1, MOST_SAMPLES)
        whole(seed, "seed", 0, KERNEL_INT)
        return cls(*_range_of(chain), count, seed)

    def numbers(self) -> np.ndarray:
        """Whole numbers of the kernel."""
        return np.array([self.kind, self.seed], np.int64)

    def describe(self) -> dict[str, object]:
        """Plain data of the samples."""
        return {"random": self.count, "seed": self.seed} | _bounds(self)


@dataclass(frozen=True, eq=False)
class Sobol(Samples):
    """Configurations of Sobol's sequence: more even between the bounds than random ones.

    Attributes
    ----------
    lower, upper : (m,) ndarray
        Bounds of the coordinates, rad or m.
    count : int
        Number of samples; a power of 2 is most even.
    seed : int or None
        Seed of the scrambling, the same on every machine; None leaves the sequence as it is, whose
        first configuration is at all lower bounds.
    """

    kind = 2

    seed: int | None = 0

    @classmethod
    def of(cls, chain: Chain, count: int, seed: int | None = 0) -> Sobol:
        """Samples within a chain's limits.

        Parameters
        ----------
        chain : Chain
            The arm, of at most 32 coordinates; one without limits is drawn from one turn, or from
            2 m.
        count : int
            Number of samples.
        seed : int or None, default 0
            Seed of the scrambling, None for none.

        Returns
        -------
        samples : Sobol
            The samples.

        Raises
        ------
        InputError
            If a number cannot be used, the arm has no coordinate or more than 32, or coordinates
            within their limits take joints beyond their own.

        Notes
        -----
        The scrambling is a random matrix of bits and a shift for each coordinate. Sources: Sobol
        1967; Joe and Kuo 2008 (direction numbers); Matoušek 1998.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5e").chain(tip="tool0")
        >>> samples = pk.sweep.Sobol.of(arm, 2**20)
        >>> samples.configurations([0, 1]).shape
        (2, 6)
        """
        whole(count, "count", 1, MOST_SAMPLES)
        if seed is not None:
            whole(seed, "seed", 0, KERNEL_INT)
        if chain.dof > MOST:
            raise InputError(f"sobol: expected at most {MOST} coordinates, got {chain.dof}")
        return cls(*_range_of(chain), count, seed)

    def numbers(self) -> np.ndarray:
        """Whole numbers of the kernel."""
        of_sequence = sobol_numbers(len(self.lower), self.seed)
        return np.append(self.kind, of_sequence)

    def describe(self) -> dict[str, object]:
        """Plain data of the samples."""
        return {"sobol": self.count, "seed": self.seed} | _bounds(self)


@dataclass(frozen=True, eq=False)
class Grid(Samples):
    """Configurations in the middles of equal parts of each coordinate's range.

    Attributes
    ----------
    lower, upper : (m,) ndarray
        Bounds of the coordinates, rad or m.
    count : int
        Number of samples.
    counts : tuple of int
        Number of parts of each coordinate; the last coordinate changes first.
    """

    kind = 0

    counts: tuple[int, ...] = ()

    @classmethod
    def of(cls, chain: Chain, counts: int | Sequence[int]) -> Grid:
        """A grid within a chain's limits.

        Parameters
        ----------
        chain : Chain
            The arm; a coordinate without limits has one turn, or 2 m.
        counts : int or sequence of int
            Number of parts of every coordinate, or of each.

        Returns
        -------
        samples : Grid
            The samples.

        Raises
        ------
        InputError
            If a number cannot be used, the arm has no coordinate, or coordinates within their
            limits take joints beyond their own.
        ShapeError
            If there is another number of counts than of coordinates.
        """
        each: Any = counts
        if np.ndim(each) == 0:
            each = [counts] * chain.dof
        each = list(each)
        if len(each) != chain.dof:
            raise ShapeError(f"counts: expected one or {chain.dof} numbers, got {len(each)}")
        parts = tuple(whole(part, "counts", 1, KERNEL_INT) for part in each)
        count = whole(math.prod(parts), "product of the counts", 1, MOST_SAMPLES)
        return cls(*_range_of(chain), count, parts)

    def numbers(self) -> np.ndarray:
        """Whole numbers of the kernel."""
        return np.array([self.kind, 0, *self.counts], np.int64)

    def describe(self) -> dict[str, object]:
        """Plain data of the samples."""
        return {"grid": list(self.counts)} | _bounds(self)


def sample_numbers(numbers: ArrayLike, count: int) -> np.ndarray:
    """Numbers (N,) of samples, each below `count`. Raises: InputError, ShapeError."""
    try:
        asked = np.asarray(numbers)
    except ValueError:
        problem = "numbers: expected whole numbers (N,), got rows of different lengths"
        raise ShapeError(problem) from None
    if asked.ndim != 1 or asked.dtype.kind not in "iu":
        raise ShapeError(f"numbers: expected whole numbers (N,), got {asked.dtype} {asked.shape}")
    if len(asked) and not (asked.min() >= 0 and asked.max() < count):
        raise InputError(
            f"numbers: expected 0 ... {count - 1}, got {asked.min()} ... {asked.max()}"
        )
    return asked.astype(np.int64)


def samples_from(document: dict[str, Any]) -> Samples:
    """The samples that `describe` has described."""
    lower, upper = np.array([document["lower"], document["upper"]])
    if "random" in document:
        return Random(lower, upper, document["random"], document["seed"])
    if "sobol" in document:
        return Sobol(lower, upper, document["sobol"], document["seed"])
    counts = tuple(document["grid"])
    return Grid(lower, upper, math.prod(counts), counts)


def _bounds(samples: Samples) -> dict[str, object]:
    return {"lower": samples.lower.tolist(), "upper": samples.upper.tolist()}


def _range_of(chain: Chain) -> tuple[Array, Array]:
    """Bounds of the coordinates. Raises: InputError where the joints' own limits cut corners off."""
    if not chain.dof:
        raise InputError(f"sweep: {chain!r} has no coordinate")
    lower, upper = sampling_range(chain)
    rng = np.random.default_rng(0)
    q = rng.uniform(lower, upper, (_TRIED, chain.dof))
    if beyond_own_limits(chain, q).any():
        raise InputError(
            "sweep: coordinates within their limits take joints beyond their own (joint_limits); "
            "a sweep needs limits of each coordinate by itself"
        )
    return lower, upper
