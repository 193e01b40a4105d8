"""The command line: run mutants, all or a seeded sample, and say what the suite caught.

Outcomes are kept in build/mutants/results.jsonl; a run that is begun again goes on where it ended,
and tries again those that survived. A mutant's key holds the text of its module: after an edit
there its mutants are new. An edit elsewhere makes none new: what was caught by a test that has been
weakened or removed since still counts as caught, and so does what was caught while another module
was as it was. The run says how many outcomes are of earlier runs; a figure to be relied upon is of
one run with --afresh, which runs all the chosen ones again.
A sample holds of each room in proportion; `sample.py` says when it fails. With --seconds mutants are
run in an order drawn by the seed, so that those which the time is enough for are a sample too; the
last fifth of it is kept for what the tests near a module let through.
"""

from __future__ import annotations

import argparse
import functools
import importlib.util
import math
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

if importlib.util.find_spec("cosmic_ray") is None:
    sys.exit(
        "mutation testing needs the package cosmic-ray: pip install -e '.[dev]', or make mutate, installs it"
    )

from . import equivalent, sample
from .campaign import BrokenSuite, Campaign, Outcome, kept
from .mutants import Mutant, mutants_of, paths, room
from .report import counted, kind, table, told

ROOT = Path(__file__).resolve().parents[2]
MODULES_TOLD = 12  # up to here the table is by module too


def main(arguments: list[str] | None = None) -> int:
    """Exit code 0 where the bars are held, 1 where they are not, 2 where the suite fails by itself."""
    parser = argparse.ArgumentParser(prog="python -m tools.mutate", description=__doc__)
    parser.add_argument("--sample", type=int, help="this many, drawn from all by the seed")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--module", action="append", help="only modules whose path holds this (may be repeated)"
    )
    parser.add_argument(
        "--room", action="append", help="only this room of the package (may be repeated)"
    )
    parser.add_argument("--operator", help="only operators whose name holds this, as messages/")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument(
        "--seconds",
        type=float,
        default=math.inf,
        help="begin no further mutant so many seconds after the first could begin",
    )
    parser.add_argument(
        "--afresh", action="store_true", help="run again what earlier runs have tried"
    )
    parser.add_argument(
        "--quick", action="store_true", help="try survivors on the tests beside their module only"
    )
    parser.add_argument("--report", action="store_true", help="run nothing: say what is known")
    parser.add_argument("--count", action="store_true", help="run nothing: count the mutants")
    said = parser.parse_args(arguments)

    rooms = {room(path) for path in paths(ROOT)}
    if unknown := sorted(set(said.room or ()) - rooms):
        parser.error(f"no room called {unknown[0]!r}; there are {', '.join(sorted(rooms))}")
    asked = set(said.room or rooms)
    sources = {
        path: (ROOT / path).read_text(encoding="utf-8")
        for path in paths(ROOT)
        if room(path) in asked
    }
    with ProcessPoolExecutor(said.workers) as pool:
        of_modules = pool.map(mutants_of, sources, sources.values(), chunksize=8)
        every = [mutant for found in of_modules for mutant in found]
    entries = [entry for entry in equivalent.entries() if room(entry.path) in asked]
    listed, stale = equivalent.listed(every, entries)
    chosen = [m for m in every if not said.module or any(part in m.path for part in said.module)]
    chosen = [m for m in chosen if not said.operator or said.operator in m.operator]
    if said.sample is not None:
        chosen = sample.drawn(chosen, said.sample, said.seed)

    mutants = Counter(mutant.room for mutant in every)
    file = ROOT / "build" / "mutants" / "results.jsonl"
    file.parent.mkdir(parents=True, exist_ok=True)
    outcomes = kept(file)
    if said.afresh:  # a sample's own: the others stay what they are, as they have taken hours
        for mutant in chosen:
            outcomes.pop(mutant.key, None)
    earlier = sum(m.key in outcomes and outcomes[m.key]["outcome"] != "passed" for m in chosen)
    if not (said.report or said.count):
        waiting = [
            m for m in chosen if m.key not in outcomes or outcomes[m.key]["outcome"] == "passed"
        ]
        if said.seconds < math.inf:
            random.Random(said.seed).shuffle(waiting)
        run = functools.partial(
            _run, sources=sources, listed=set(listed), file=file, outcomes=outcomes, said=said
        )
        sampled = said.sample is not None and len(chosen) == said.sample
        try:
            share = 0.8 if sampled and not said.quick else 1.0
            run(waiting, quick=said.quick or sampled, seconds=share * said.seconds)
            if sampled and not said.quick and _faults(counted(chosen, outcomes, listed), mutants):
                print(
                    "too many are let through by the tests near their modules: all tests are tried on those"
                )
                survivors = [m for m in chosen if kind(m, outcomes, listed) == "survived"]
                run(survivors, quick=False, seconds=(1 - share) * said.seconds)
        except BrokenSuite as fault:
            print(
                f"the tests do not hold by themselves, so they prove nothing: {fault}",
                file=sys.stderr,
            )
            return 2
        if waiting and not any(m.key in outcomes for m in chosen):
            print("FAILED: there was no time for any mutant")
            return 1
    if said.count:
        outcomes = {}
    elif earlier:
        print(
            f"{earlier} of {len(chosen)} were caught in earlier runs, by the tests of then; --afresh runs them again"
        )
    return _judged(chosen, every, outcomes, listed, stale)


def _run(
    waiting: list[Mutant],
    sources: dict[str, str],
    listed: set[str],
    file: Path,
    outcomes: dict[str, Outcome],
    said: argparse.Namespace,
    quick: bool,
    seconds: float,
) -> None:
    start = last = time.monotonic()
    done = 0

    def finished(mutant: Mutant, outcome: Outcome) -> None:
        nonlocal done, last
        done += 1
        outcomes[mutant.key] = outcome
        if outcome["outcome"] == "passed" and mutant.key not in listed:
            print(f"survived: {told(mutant)}", flush=True)
        if time.monotonic() - last > 60:
            last = time.monotonic()
            print(f"{done} of {len(waiting)} in {last - start:.0f} s", flush=True)

    with tempfile.TemporaryDirectory(prefix="mutants-") as place:
        campaign = Campaign(ROOT, Path(place), sources, listed, file, quick, seconds)
        campaign.run(waiting, max(1, min(said.workers, len(waiting))) if waiting else 0, finished)
    each = f", {campaign.processor / done:.1f} s of a processor each" if done else ""
    took = f"{time.monotonic() - start:.0f} s, {said.workers} at a time{each}"
    if done < len(waiting):
        print(f"{done} of {len(waiting)} mutants in {took}; there was no time for the others")
    else:
        print(f"{done} mutants in {took}")


def _judged(
    chosen: list[Mutant],
    every: list[Mutant],
    outcomes: dict[str, Outcome],
    listed: dict[str, str],
    stale: list[equivalent.Entry],
) -> int:
    for mutant in chosen:
        found = kind(mutant, outcomes, listed)
        if found == "survived":
            print(told(mutant))
        if found == "wrong":
            print(
                f"listed as equivalent, but {outcomes[mutant.key]['by']} catches it: {told(mutant)}"
            )
    for entry in stale:
        print(
            f"listed as equivalent, but no mutant: {entry.path}: {entry.definition}: {entry.old} -> {entry.new}"
        )
    counts, mutants = counted(chosen, outcomes, listed), Counter(m.room for m in every)
    if len({m.path for m in chosen}) <= MODULES_TOLD:
        print(table(counted(chosen, outcomes, listed, lambda m: m.path), "module"))
    print(table(counts))
    faults = _faults(counts, mutants)
    for name, number in Counter(m.room for m in every if m.key in listed).items():
        if number > sample.MOST_EQUIVALENT * mutants[name]:
            faults.append(
                f"{name}: {number} of {mutants[name]} mutants are listed as equivalent (at most 3 %)"
            )
    wrong = sum(count["wrong"] for count in counts.values())
    print(
        f"listed as equivalent: {len(listed)} of {len(every)}, {100 * len(listed) / len(every):.2f} %"
    )
    for fault in faults:
        print(f"FAILED: {fault}")
    return 1 if faults or stale or wrong else 0


def _faults(counts: dict[str, Counter[str]], mutants: Mapping[str, int]) -> list[str]:
    """What the outcomes say against the bars; mutants, how many each room has."""
    faults, sizes, survivors = [], {}, 0
    for name, count in counts.items():
        survived = count["survived"]
        size = count.total() - count["not run"] - count["equivalent"]
        whole = count.total() == mutants[name] and not count["not run"]
        if not sample.room_is_sound(name, survived, size, whole):
            allowed = (
                "" if whole else f", where a sample of {size} may have {sample.most(name, size)}"
            )
            faults.append(
                f"{name}: {survived} of {size} survived (caught at least {100 * sample.bar(name):g} %{allowed})"
            )
        if not whole:
            sizes[name] = size
            survivors += survived
    if (likely := sample.chance(survivors, sizes)) < sample.RARE:
        faults.append(
            f"all: {survivors} of {sum(sizes.values())} survived; with each room at its bar that many would be seen in"
            f" {100 * likely:.2g} % of the samples (at least {100 * sample.RARE:g} %)"
        )
    return faults


if __name__ == "__main__":
    sys.exit(main())
