"""Direction numbers of Sobol's sequence: what its coordinates are made of, and their scrambling.

Number n of a coordinate, as 64 bits after the point, is the exclusive or of v_k over the bits k of
the Gray code of n. `scrambled` multiplies them by a random lower triangular matrix of bits and
shifts all numbers alike: in each coordinate the digits of a number are changed by functions of
those before, so that the numbers stay as even as they are, and each is uniform by itself.

Sources: Joe and Kuo 2008 (new-joe-kuo-6.21201); Antonov and Saleev 1979 (Gray code); Matoušek 1998.
"""

from __future__ import annotations

import functools

import numpy as np

BITS = 64
# a line a coordinate, the second on: degree s and coefficients of a primitive polynomial, then m_1 ... m_s
_ROWS = """
1 0 1
2 1 1 3
3 1 1 3 1
3 2 1 1 1
4 1 1 1 3 3
4 4 1 3 5 13
5 2 1 1 5 5 17
5 4 1 1 5 5 5
5 7 1 1 7 11 19
5 11 1 1 5 1 1
5 13 1 1 1 3 11
5 14 1 3 5 5 31
6 1 1 3 3 9 7 49
6 13 1 1 1 15 21 21
6 16 1 3 1 13 27 49
6 19 1 1 1 15 7 5
6 22 1 3 1 15 13 25
6 25 1 1 5 5 19 61
7 1 1 3 7 11 23 15 103
7 4 1 3 7 13 13 15 69
7 7 1 1 3 13 7 35 63
7 8 1 3 5 9 1 25 53
7 14 1 3 1 13 9 35 107
7 19 1 3 1 5 27 61 31
7 21 1 1 5 11 19 41 61
7 28 1 3 5 3 3 13 69
7 31 1 1 7 13 1 19 1
7 32 1 3 7 5 13 19 59
7 37 1 1 3 9 25 29 41
7 41 1 3 5 13 23 1 55
7 42 1 3 7 3 13 59 17
"""
_TABLE = [[int(x) for x in row.split()] for row in _ROWS.split("\n") if row]
MOST = 1 + len(_TABLE)
"""Number of coordinates for which there are direction numbers."""


def directions(dimension: int) -> list[list[int]]:
    """Direction numbers v_0 ... v_63 of each coordinate, whole numbers of 64 bits."""
    first = [1 << (BITS - 1 - k) for k in range(BITS)]
    return [first, *map(_recurrence, _TABLE[: dimension - 1])]


def _recurrence(row: list[int]) -> list[int]:
    degree, polynomial, *initial = row
    v = [m << (BITS - 1 - k) for k, m in enumerate(initial)]
    for k in range(degree, BITS):
        value = v[k - degree] ^ (v[k - degree] >> degree)
        for i in range(1, degree):
            if polynomial >> (degree - 1 - i) & 1:
                value ^= v[k - i]
        v.append(value)
    return v


@functools.lru_cache(8)
def sobol_numbers(dimension: int, seed: int | None) -> np.ndarray:
    """Shifts (m), then direction numbers (m, 64), as 64-bit integers; seed None leaves the sequence
    as it is.
    """
    v = directions(dimension)
    shifts = [0] * dimension
    if seed is not None:
        rng = np.random.Generator(np.random.PCG64(seed))
        for i, row in enumerate(v):
            words = _words(rng)
            shifts[i] = words.pop()
            v[i] = [_times(words, value) for value in row]
    flat = shifts + [value for row in v for value in row]
    found = np.array(flat, np.uint64).view(np.int64)
    found.flags.writeable = False
    return found


def _words(rng: np.random.Generator) -> list[int]:
    """Rows of a lower triangular matrix with ones on its diagonal, the highest bit first, and a shift."""
    drawn = [int.from_bytes(rng.bytes(BITS // 8), "little") for _ in range(BITS + 1)]
    return [
        *(
            (word >> (BITS - k) << (BITS - k)) | (1 << (BITS - 1 - k))
            for k, word in enumerate(drawn[:-1])
        ),
        drawn[-1],
    ]


def _times(rows: list[int], value: int) -> int:
    """The matrix of bits times a column of bits."""
    product = 0
    for row in rows:
        product = product << 1 | (row & value).bit_count() & 1
    return product
