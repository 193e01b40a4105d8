"""The command line of the fuzzer: a table of the readers, and each failure as something to paste
and run.
"""

from __future__ import annotations

import argparse
import sys
import time

from .campaign import Found, Row, counts_of, run
from .readers import READERS

HEAD = ("reader", "inputs", "accepted", "refused", "failures", "worst time", "inputs/s")
_SHOWN = 2000


def table(rows: list[Row]) -> str:
    """One line a reader; worst time in seconds of the processor, inputs/s of one worker."""
    lines: list[tuple[str, ...]] = [HEAD]
    for row in rows:
        t, failed = row.tally, str(row.failures)
        lines.append(
            (row.reader, f"{t.inputs:,}", f"{t.accepted:,}", f"{t.inputs - t.accepted:,}", failed,
             f"{t.slowest:.3f} s (no. {t.slowest_at})", f"{t.inputs / max(row.seconds, 1e-9):,.0f}")
        )  # fmt: skip
    widths = [max(len(line[k]) for line in lines) for k in range(len(HEAD))]
    return "\n".join("  ".join(cell.ljust(w) if not k else cell.rjust(w) for k, (cell, w) in enumerate(
        zip(line, widths, strict=True))) for line in lines)  # fmt: skip


def told(row: Row, found: Found, seed: int) -> str:
    """A failure: what, where, how often, its input and its traceback."""
    f = found.first
    again = "" if found.again else "; not again when the input was alone"
    data = repr(found.data)
    call = f"attempt(of_name({row.reader!r}), {data})" if len(data) <= _SHOWN else (
        f"attempt(of_name({row.reader!r}), make(of_name({row.reader!r}), {seed}, {f.index}))  # {len(found.data)} bytes"
    )  # fmt: skip
    return (
        f"{row.reader}: {f.what} in {f.where or 'no function of poekin'}: {found.count} inputs, the first no. {f.index}"
        f" of seed {seed}{again}\n  from tools.fuzz.trial import attempt; from tools.fuzz.readers import of_name;"
        f" from tools.fuzz.inputs import make\n  print({call})\n{f.trace}"
    )


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz", description=__doc__)
    parser.add_argument(
        "--count",
        type=int,
        default=1_000_000,
        help="inputs to the URDF reader, ten times those of others",
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument(
        "--reader", action="append", choices=READERS, help="only this one (may be said again)"
    )
    said = parser.parse_args(arguments)
    counts = counts_of(said.reader or list(READERS), said.count)
    start = last = time.monotonic()

    def progress(row: Row, count: int) -> None:
        nonlocal last
        if time.monotonic() - last > 15:
            last = time.monotonic()
            done = f"{row.tally.inputs:,} of {count:,} inputs, {row.failures} failures"
            print(f"{last - start:6.0f} s  {row.reader}: {done}", file=sys.stderr, flush=True)

    rows = run(counts, said.seed, said.workers, progress=progress)
    print(table(rows))
    for row in rows:
        for found in row.found.values():
            print("\n" + told(row, found, said.seed))
    failures, total = sum(row.failures for row in rows), sum(row.tally.inputs for row in rows)
    print(
        f"\n{total:,} inputs, {failures} failures, seed {said.seed}, {time.monotonic() - start:.0f} s"
    )
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
