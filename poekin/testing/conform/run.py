"""Hold a subject to all laws that apply, confirm what is found, and report it."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Sequence
from typing import Any

from ...errors import InputError, UnknownName, closest, shown
from ...model.evaluation import FRAME_NAMES
from .arm_cases import ARM_LAWS
from .grades import Grade
from .group_cases import GROUP_LAWS
from .law import Case, Law
from .report import Outcome, Report
from .search import Found, worst
from .subject import ORDERS, Subject
from .urdf_cases import URDF_LAWS

LAWS: tuple[Law, ...] = (*GROUP_LAWS, *ARM_LAWS, *URDF_LAWS)
"""Every law there is, in the order of the report."""
EXAMPLES, SECONDS = 1000, 50.0


def applicable(subject: Subject, names: Sequence[str] = ()) -> list[Law]:
    """The laws that a subject can be held to; with names, of these only. Returns: a list of `law.Law`.

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

    Parameters: thing, a class or object of functions, or "MODULE:NAME" of one; laws, names, or one name, all that apply
    by default; examples of each law at most; seconds for all of them together, shrinking (half a minute a finding at
    most) and confirming not counted; say(done, total, law), of progress. Returns: Report. The same cases in every run,
    as many as there is time for, and ten of each law at least.
    Every finding was confirmed by the second oracle (`confirm`).
    Raises: InputError for a subject that cannot be used or does not declare what is needed; UnknownName for a law that
    does not exist.
    """
    if examples < 1 or not seconds > 0:
        raise InputError(f"examples ≥ 1 and seconds > 0 expected, got {examples} and {seconds}")
    subject = Subject(thing)
    chosen = applicable(subject, [laws] if isinstance(laws, str) else laws)
    left, outcomes = float(seconds), []
    for done, law in enumerate(chosen):
        say(done, len(chosen), law.name)
        start = time.monotonic()
        found = worst(law, subject, examples, left / (len(chosen) - done))
        left = max(left - (time.monotonic() - start), 0.1)
        outcomes.append(outcome(law, subject, found))
    return Report(subject.label, tuple(outcomes))


def outcome(law: Law, subject: Subject, found: Found) -> Outcome:
    """What is reported of a hunt: a finding only where the two oracles agree on what is exact."""
    verdict, case = found.verdict, found.shrunk
    if case is None:
        return Outcome(law.name, law.says, verdict.grade, verdict.size, verdict.what, found.examples)
    again = law.check(subject, case)
    steady = again.grade >= verdict.grade
    fault, hint = again.fault, ""
    if not law.about(case):
        hint = "nothing that this law is about is in it: what is wrong is something else"
    elif steady and again.grade is Grade.BROKEN:
        hint = _declared_otherwise(law, subject, found.case, case)
    if not steady:
        fault = f"another result from one call to the next: {verdict.grade.word} once, then {again.grade.word}"
    display = law.show(subject, case)
    worst = max(verdict, again, key=lambda v: v.size)
    return Outcome(
        law.name, law.says, max(verdict.grade, again.grade), worst.size, worst.what, found.examples,
        again.size, again.what, fault, case, display.words, display.paste, display.expected, hint,
        "" if law.confirm(subject, case) else "the two oracles do not agree on the exact result",
    )  # fmt: skip


def _declared_otherwise(law: Law, subject: Subject, worst: Case, small: Case) -> str:
    """With which declarations what is broken would hold: said, and never assumed."""
    order, frame = subject.linear_first, subject.frame
    found = ""
    for other in itertools.product((order, not order), (frame, *(f for f in FRAME_NAMES if frame and f != frame))):
        subject.linear_first, subject.frame = other
        if not found and all(law.check(subject, case).grade < Grade.BROKEN for case in (worst, small)):
            declared = [f'twist_order = "{ORDERS[other[0]]}"'] if other[0] != order else []
            declared += [f'jacobian_frame = "{other[1]}"'] if other[1] != frame else []
            found = f"with {' and '.join(declared)} it would hold"
    subject.linear_first, subject.frame = order, frame
    return found
