"""Samples whose cells and measures are known are counted, and the measures kept."""

import math

from .tiles import OUTSIDE

BINS, TOP = -1, -2
HALF = 32
FINE = 2.0**40
"""Units of a sum of measures in 1."""
_LARGEST = 2.0**62


def keep(cells, sign, values, found, begin, end, start, counts, best, attained, sums):
    """Keeps samples `begin` ... `end` - 1 of a block that begins with sample `start`, as
    `sweep_kernel.swept` says. Returns how many lie in no cell.
    """
    # in a loop of its own, so that the processor waits for the memory of many cells at once
    if best.size > 0 and cells[0] != TOP:
        return keep_best(sign, values, found, begin, end, start, counts, best, attained)
    outside = count_cells(found, begin, end, counts)
    if cells[0] == TOP:
        keep_top(sign, values, begin, end, start, best, attained)
    elif sums.size > 0:
        add(values, found, begin, end, sums, attained)
    return outside


def leave_out(masked, begin, end, found, values):
    """Puts samples that are masked into no cell, with no measure. Returns how many there are."""
    count = 0
    for k in range(begin, end):
        if masked[k]:
            found[k] = OUTSIDE
            values[k] = math.nan
            count += 1
    return count


def count_cells(found, begin, end, counts):
    """Counts samples in their cells. Returns how many lie in none."""
    outside = 0
    for k in range(begin, end):
        if found[k] == OUTSIDE:
            outside += 1
        else:
            counts[found[k]] += 1
    return outside


def keep_best(sign, values, found, begin, end, start, counts, best, attained):
    """Counts samples in their cells and keeps the best measure of each, in one pass over the memory.
    Returns how many lie in none.
    """
    outside = 0
    for k in range(begin, end):
        cell = found[k]
        if cell == OUTSIDE:
            outside += 1
        else:
            counts[cell] += 1
            value = sign * values[k]
            if value > best[cell]:
                best[cell] = value
                attained[cell] = start + k
    return outside


def keep_top(sign, values, begin, end, start, best, attained):
    """Inserts in descending order; of equal ones the first sample stays before the others."""
    for k in range(begin, end):
        value = sign * values[k]
        i = len(best) - 1
        if value > best[i]:
            while i > 0 and value > best[i - 1]:
                best[i] = best[i - 1]
                attained[i] = attained[i - 1]
                i -= 1
            best[i] = value
            attained[i] = start + k


def add(values, found, begin, end, sums, rest):
    """Adds measures to the sums of their cells, in whole units."""
    for k in range(begin, end):
        cell = found[k]
        if cell != OUTSIDE:
            units = math.floor(min(max(values[k] * FINE, -_LARGEST), _LARGEST) + 0.5)
            sums[cell] += units >> HALF
            rest[cell] += units & (2**HALF - 1)


def write_bins(cells, place, values, found):
    """Bins of the measures; where cells[0] is TOP, all are in the first."""
    for k in range(len(found)):
        found[k] = 0
        if cells[0] == BINS:
            along = (values[k] - place[0]) * place[3]
            found[k] = int(along) if 0.0 <= along < cells[1] else OUTSIDE
