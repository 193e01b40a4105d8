"""Kernels of CUDA around the functions of one arm: the sweep, and what turns its arguments to theirs."""

from __future__ import annotations

THREADS = """/* The first number of a thread, and how far the next one is. */
static __device__ inline long long {word}_thread(void)
{{
    return (long long)blockIdx.x * blockDim.x + threadIdx.x;
}}

static __device__ inline long long {word}_threads(void)
{{
    return (long long)gridDim.x * blockDim.x;
}}
"""

BATCH = """
extern "C" __global__ void {function}_batch(long long count, const {real} *q{parameters})
{{
    for (long long k = {word}_thread(); k < count; k += {word}_threads()) {{
        {function}(q + {dof} * k{results});
    }}
}}
"""

SAMPLE = """
/* The cell of one sample, and its measure where there is one. */
static __device__ inline long long {word}_sample(
    long long number,{arguments}{measure})
{{
    const {word}_i4 shape = {word}_i4{{{{cells[0], cells[1], cells[2], cells[3]}}}};
    {real} q[{dof}], T[16];
    if (samples[{KIND}] == {GRID}) {{
        {word}_i{dof} parts;
        for (int k = 0; k < {dof}; k++) {{
            parts.v[k] = samples[{COUNTS} + k];
        }}
        {write_grid}(number, parts, bounds, q);
    }} else if (samples[{KIND}] == {RANDOM}) {{
        {write_random}((unsigned long long)samples[{SEED}], number, bounds, q);
    }} else {{
        return -1;
    }}
    {pose};{rooted}
    const {word}_d3 p = {word}_d3{{{{T[3], T[7], T[11]}}}};
    const {word}_d3 axis = {word}_d3{{{{T[2], T[6], T[10]}}}};
    return {cell_of}(shape, place, p, axis);
}}
"""

ARGUMENTS = "\n    const long long *samples, const {real} *bounds, const long long *cells, const {real} *place"

COUNT = """
extern "C" __global__ void {word}_sweep(
    long long first, long long last,{arguments},
    unsigned long long *counts, unsigned long long *outside)
{{
    for (long long k = first + {word}_thread(); k < last; k += {word}_threads()) {{
        const long long cell = {word}_sample(k, samples, bounds, cells, place);
        atomicAdd(cell < 0 ? outside : counts + cell, 1ULL);
    }}
}}
"""

MEASURE = """
/* best = max(best, measure), which is passed over where it is no number. */
static __device__ inline void {word}_raise({real} *best, {real} measure)
{{
    {bits} *place = ({bits} *)best;
    {bits} seen = *place;
    while (measure > {to_real}(seen)) {{
        const {bits} found = atomicCAS(place, seen, ({bits}){to_bits}(measure));
        if (found == seen) {{
            break;
        }}
        seen = found;
    }}
}}

extern "C" __global__ void {word}_sweep(
    long long first, long long last,{arguments},
    unsigned long long *counts, unsigned long long *outside, {real} *best)
{{
    for (long long k = first + {word}_thread(); k < last; k += {word}_threads()) {{
        {real} measure;
        const long long cell = {word}_sample(k, samples, bounds, cells, place, &measure);
        atomicAdd(cell < 0 ? outside : counts + cell, 1ULL);
        if (cell >= 0) {{
            {word}_raise(best + cell, measure);
        }}
    }}
}}

/* Run when every sample is counted: the first sample that has the best measure of its cell. */
extern "C" __global__ void {word}_attained(
    long long first, long long last,{arguments},
    const {real} *best, unsigned long long *attained)
{{
    for (long long k = first + {word}_thread(); k < last; k += {word}_threads()) {{
        {real} measure;
        const long long cell = {word}_sample(k, samples, bounds, cells, place, &measure);
        if (cell >= 0 && measure == best[cell]) {{
            atomicMin(attained + cell, (unsigned long long)k);
        }}
    }}
}}
"""

USE = """
Kernels, of pointers to the device's memory; any number of blocks and threads will do:
  {word}_fk_batch(count, q, T), {word}_fk_jacobian_{frame}_batch(count, q, T, J) and so on: count configurations.
  {word}_sweep(first, last, samples, bounds, cells, place, counts, outside{best}): adds samples
first ... last - 1 of a map of poekin.sweep to its counts, one number a cell, and to outside[0]. Its
arguments are those of a poekin.sweep.Sweep: samples.numbers(), samples.bounds (in the precision of
this text), cells.numbers() and cells.place() (likewise). Samples are Random or Grid; others lie outside.
"""

BEST = """best, one number a cell, has to be -infinity before: it becomes the largest manipulability.
  {word}_attained(first, last, samples, bounds, cells, place, best, attained): then, with all of attained at
its largest number before, the first sample of each cell that has it.
"""

EXACT = """In double precision no number depends on the processor, and the map is that of poekin.sweep.run to the
last bit, where products and sums are not fused: nvcc -fmad=false, clang -ffp-contract=off, and angles
stay within 1e6 rad. Fused, a sample within rounding of a cell's border may fall into the next one.
"""

ROUNDED = """In single precision random numbers are whole numbers of 64 bits all the same; all else is rounded to 24
bits, so that samples near a cell's border may fall into another one than in poekin.sweep.run.
"""
