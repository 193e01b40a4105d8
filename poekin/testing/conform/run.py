"""Hold a subject to all laws that apply, confirm what is found, and report it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

from ...errors import InputError, UnknownName, closest, shown
from .arm_cases import ARM_LAWS
from .calls import Attempt
from .grades import Grade
from .group_cases import GROUP_LAWS
from .law import Law
from .report import Outcome, Report
from .search import Found, worst
from .subject import Subject
from .urdf_cases import URDF_LAWS

LAWS: tuple[Law, ...] = (*GROUP_LAWS, *ARM_LAWS, *URDF_LAWS)
"""Every law there is, in the order of the report."""
EXAMPLES, SECONDS = 1000, 50.0


def applicable(subject: Subject, names: Sequence[str] = ()) -> list[Law]:
    """The laws that a subject can be held to; with names, of these only.

    Raises: UnknownName for a name that is no law; InputError where none of those named applies.
    """
    for name in names:
        if name not in {law.name for law in LAWS}:
            raise UnknownName(f"there is no law {shown(name)}; {closest(name, [law.name for law in LAWS])}")
    every = [law for law in LAWS if law.needs in subject.functions and law.applies(subject)]
    chosen = [law for law in every if not names or law.name in names]
    if not chosen:
        raise InputError(
            f"{subject.title}: none of these laws applies; those that do: {', '.join(x.name for x in every)}"
        )
    return chosen


def conform(
    thing: Any,
    laws: Sequence[str] = (),
    examples: int = EXAMPLES,
    seconds: float = SECONDS,
    say: Callable[[int, int, str], object] = lambda done, total, name: None,
) -> Report:
    """Hold a subject (`subject`) to the laws, and report each with a grade (`grades`).

    Parameters: thing, a class or object of functions; laws, names, all that apply by default; examples of each law at
    most; seconds for all of them together, shrinking (half a minute a finding at most) and confirming not counted;
    say(done, total, law), of progress. Returns: Report. The same cases in every run, as many as there is time for, and
    ten of each law at least.
    Every finding was confirmed by the second oracle (`confirm`) and is one that the subject repeats.
    Raises: InputError for a subject that does not declare what is needed; UnknownName for a law that does not exist.
    """
    if examples < 1 or not seconds > 0:
        raise InputError(f"examples ≥ 1 and seconds > 0 expected, got {examples} and {seconds}")
    subject = Subject(thing)
    chosen = applicable(subject, laws)
    left, outcomes = float(seconds), []
    for done, law in enumerate(chosen):
        say(done, len(chosen), law.name)
        start = time.monotonic()
        found = worst(law, subject, examples, left / (len(chosen) - done))
        left = max(left - (time.monotonic() - start), 0.1)
        outcomes.append(outcome(law, subject, found))
    return Report(subject.label, tuple(outcomes))


def outcome(law: Law, subject: Subject, found: Found) -> Outcome:
    """What is reported of a hunt: a finding only where it is confirmed, and comes again."""
    verdict = found.verdict
    if found.shrunk is None or found.shrunk_verdict is None:
        return Outcome(law.name, law.says, verdict.grade, verdict.size, verdict.what, found.examples)
    small = found.shrunk_verdict
    again = law.check(subject, found.shrunk)
    doubt = ""
    if again.grade is not small.grade:
        doubt = f"the subject did not do it again: {small.grade.word}, then {again.grade.word}"
    elif not law.confirm(subject, found.shrunk):
        doubt = "the two oracles do not agree on the exact result"
    display = law.show(subject, found.shrunk)
    return Outcome(
        law.name, law.says, small.grade, max(verdict.size, small.size), small.what, found.examples, small.size,
        small.fault, found.shrunk, display.words, display.paste, display.expected, _hint(law, subject, found), doubt,
    )  # fmt: skip


def _hint(law: Law, subject: Subject, found: Found) -> str:
    """Whether what is broken holds in the other twist order: said, and never assumed."""
    if found.verdict.grade is not Grade.BROKEN:
        return ""
    before, after = subject.linear_first, Grade.BROKEN
    with Attempt():
        subject.linear_first = not before
        after = law.check(subject, found.case).grade
    subject.linear_first = before
    if after is Grade.BROKEN:
        return ""
    return f'with twist_order = "{"angular" if before else "linear"} first" this case would hold'
