"""Functions of JAX around those of one arm: its configurations by number, their cells, and the counts."""

from __future__ import annotations

COMMON = '''
REAL = xp.{precision}


def configurations(numbers, samples, bounds):
    """q (N, {dof}) of samples by their numbers (N,), 64-bit integers."""
    if xp.zeros((), xp.uint64).dtype.itemsize < 8:
        raise RuntimeError('numbers have 32 bits: jax.config.update("jax_enable_x64", True) before')
    numbers = numbers[:, None]
    if samples[{kind}] not in ({grid}, {random}):
        raise ValueError("samples: expected those of pk.sweep.Random or Grid")
    if samples[{kind}] == {grid}:
        counts = samples[{counts}:]
        parts = [1]
        for count in counts[:0:-1]:
            parts.insert(0, parts[0] * count)
        numbers = numbers // xp.asarray(parts, xp.int64)
        q = {divided}(numbers, xp.asarray(counts, xp.int64), bounds[0], bounds[1])
    else:
        start = {mixed}(xp.full((1, 1), samples[{seed}], xp.uint64))
        numbers = numbers * {dof} + xp.arange(1, {dof} + 1)
        q = {drawn}(start, numbers, bounds[0], bounds[1])
    return xp.asarray(q, REAL)


def cells_of(T, cells, place):
    """Cells (...) of poses T (..., 4, 4); -1 outside."""
    p = T[..., 0, 3], T[..., 1, 3], T[..., 2, 3]
    axis = T[..., 0, 2], T[..., 1, 2], T[..., 2, 2]
    return {cell_of}(cells, xp.asarray(place, REAL), p, axis)
'''

REACH = '''

def sweep(first, count, samples, bounds, cells, place, counts):
    """The counts, with samples first ... first + count - 1 added; the last one is of those outside."""
    q = configurations(first + xp.arange(count), samples, bounds)
    found = cells_of(fk(q, xp), cells, place)
    return counts.at[found].add(1)
'''

MEASURED = '''

def sweep(first, count, samples, bounds, cells, place, counts, best, attained):
    """The counts, with samples first ... first + count - 1 added; the best manipulability of each cell,
    and the first sample that has it. The last number of each is of those outside.
    """
    numbers = first + xp.arange(count)
    T, J = measured(configurations(numbers, samples, bounds), xp)
    measure = {root}(J[:, 0, 0])
    found = cells_of(T, cells, place)
    raised = best.at[found].max(measure)
    kept = xp.where(raised > best, NONE, attained)
    first_of = xp.where(measure == raised[found], numbers, NONE)
    return counts.at[found].add(1), raised, kept.at[found].min(first_of)


NONE = 2**63 - 1
'''

USE = """
A module for JAX, with 64-bit numbers on: jax.config.update("jax_enable_x64", True). Functions of (q, xp)
take jax.numpy for xp; jit, vmap and gradients go through them.

  sweep(first, count, samples, bounds, cells, place, counts{more}): samples of a map of poekin.sweep.
Its arguments are those of a poekin.sweep.Sweep of Random or Grid samples: tuples of the integers samples.numbers() and
cells.numbers(), samples.bounds, cells.place(); counts, int64, has cells.count + 1 zeros before, the last for
what lies outside{rest}. For jit, count, samples and cells are static:
jax.jit(sweep, static_argnums=(1, 2, 4)).

Random numbers are those of poekin.sweep to the last bit; what follows from them is as the compiler rounds
and fuses, so that a sample within rounding of a cell's border may fall into another one than in
poekin.sweep.run: few at random, but a grid may have whole rows of them, at y = 0 say.
"""

BEST = """; best, -infinity before, gets the largest
manipulability; attained, 2**63 - 1 before, gets the first sample that has it"""
