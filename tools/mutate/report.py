"""What came of the mutants: a table by room or by module, and each survivor as the change that
nobody saw.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence

from .campaign import Outcome
from .mutants import Mutant

HEAD = ("mutants", "run", "caught", "by time", "equivalent", "survived", "caught of the rest")


def kind(mutant: Mutant, outcomes: Mapping[str, Outcome], listed: Mapping[str, str]) -> str:
    """`caught`, `timeout` (caught too), `equivalent`, `survived`, `not run`; `wrong`: listed, yet a
    test caught it.
    """
    outcome = outcomes.get(mutant.key)
    if outcome is None:
        return "not run"
    if outcome["outcome"] == "passed":
        return "equivalent" if mutant.key in listed else "survived"
    return "wrong" if mutant.key in listed else str(outcome["outcome"])


def counted(
    mutants: Sequence[Mutant],
    outcomes: Mapping[str, Outcome],
    listed: Mapping[str, str],
    group: Callable[[Mutant], str] = lambda mutant: mutant.room,
) -> dict[str, Counter[str]]:
    """How many of each kind there are, by room or by another group."""
    counts: dict[str, Counter[str]] = {}
    for mutant in mutants:
        counts.setdefault(group(mutant), Counter())[kind(mutant, outcomes, listed)] += 1
    return dict(sorted(counts.items()))


def table(counts: Mapping[str, Counter[str]], title: str = "room") -> str:
    """One line a room and one for all."""
    lines = [(title, *HEAD), *(_line(name, count) for name, count in counts.items())]
    lines.append(_line("all", sum(counts.values(), Counter())))
    widths = [max(len(line[k]) for line in lines) for k in range(len(lines[0]))]
    return "\n".join(
        "  ".join(
            cell.rjust(w) if k else cell.ljust(w)
            for k, (cell, w) in enumerate(zip(line, widths, strict=True))
        )
        for line in lines
    )


def _line(name: str, count: Counter[str]) -> tuple[str, ...]:
    run, caught = count.total() - count["not run"], caught_of(count)
    share = (
        f"{100 * caught / (run - count['equivalent']):.2f} %" if run > count["equivalent"] else ""
    )
    numbers = (count.total(), run, caught, count["timeout"], count["equivalent"], count["survived"])
    return (name, *map(str, numbers), share)


def caught_of(count: Counter[str]) -> int:
    """How many were caught, those that were ended for their time among them."""
    return count["caught"] + count["timeout"] + count["wrong"]


def told(mutant: Mutant) -> str:
    """A mutant as a change of one line."""
    return f"{mutant.path}:{mutant.line}: in {mutant.definition or 'the module'}\n  - {mutant.old}\n  + {mutant.new}"
