"""Hunt for a draw that breaks a derived bound: `python -m tools.hunt [NAME ...]`.

A test draws a hundred cases, and its bound has to hold for a million. Prints the draws and the
worst error ÷ bound of each entry of `bounds.BOUNDS`; ends with status 1 where one exceeds 1, with
the case.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from typing import Any

# Two threads for small matrices wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from hypothesis import HealthCheck, Phase, given, seed, settings

from tools.hunt.bounds import BOUNDS, Bound

ROUND = settings(
    max_examples=200,
    database=None,
    deadline=None,
    phases=(Phase.generate,),
    suppress_health_check=[
        HealthCheck.too_slow,
        HealthCheck.filter_too_much,
        HealthCheck.data_too_large,
    ],
)
"""Hypothesis remembers all cases of one run, so they come in rounds."""


def hunt(bound: Bound, draws: int, seconds: float, first: int) -> tuple[int, float, bool]:
    """Draws made, the worst error ÷ bound, and whether all of them hold."""
    made, worst, end = 0, 0.0, time.monotonic() + seconds

    def one(case: tuple[Any, ...]) -> None:
        nonlocal made, worst
        if made >= draws or time.monotonic() >= end:
            return
        found = np.ravel(bound.ratios(*case))
        made += found.size
        worst = max(worst, float(np.max(found, initial=0.0)))
        assert (found <= 1).all(), f"error ÷ bound = {np.max(found):.3g}"

    while made < draws and time.monotonic() < end:
        try:
            seed(first)(ROUND(given(bound.cases)(one)))()
        except AssertionError as broken:
            print(broken, *getattr(broken, "__notes__", ()), sep="\n")
            return made, worst, False
        first += 1
    return made, worst, True


def main(arguments: list[str] | None = None) -> int:
    """Hunt, print a line a bound, and say by the status whether all hold."""
    parser = argparse.ArgumentParser(
        prog="python -m tools.hunt", description="Hunt for a draw that breaks a derived bound."
    )
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"of {', '.join(BOUNDS)}; all by default"
    )
    parser.add_argument("--draws", type=int, default=1_000_000, help="at least so many of each")
    parser.add_argument("--seconds", type=float, default=600, help="or what so long a time gives")
    parser.add_argument("--seed", type=int, default=1)
    given_by_user = parser.parse_args(arguments)
    unknown = set(given_by_user.names) - set(BOUNDS)
    if unknown:
        parser.error(
            f"no bound called {', '.join(map(repr, sorted(unknown)))}; there are {', '.join(BOUNDS)}"
        )
    held = True
    for name in given_by_user.names or BOUNDS:
        start = time.monotonic()
        made, worst, holds = hunt(
            BOUNDS[name], given_by_user.draws, given_by_user.seconds, given_by_user.seed
        )
        print(
            f"{name:24} {made:9} draws  worst {worst:.3f}  {time.monotonic() - start:5.0f} s",
            flush=True,
        )
        held &= holds
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
