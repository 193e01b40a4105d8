"""Hold a subject to all laws that apply, confirm what is found, and report it."""

from __future__ import annotations

import contextlib
import itertools
import time
from collections.abc import Callable, Sequence
from typing import Any

from ...errors import InputError, UnknownName, quote, suggest
from ...model.kinematics.pose_jacobian import FRAME_NAMES
from .grades import NO_RESULT, Grade
from .laws.arm_cases import ARM_LAWS
from .laws.group_cases import GROUP_LAWS
from .laws.law import Case, Law
from .laws.urdf_cases import URDF_LAWS
from .process.calls import LOST, UNANSWERED, Undeclared
from .process.child import isolated, obstacle
from .process.limits import Limits
from .report import Outcome, Report
from .search import Found, worst
from .subjects.subject import FUNCTIONS, ORDERS, Subject

LAWS: tuple[Law, ...] = (*GROUP_LAWS, *ARM_LAWS, *URDF_LAWS)
"""Every law there is, in the order of the report."""
SECONDS = 600.0
LIMITS = Limits()


def applicable(
    subject: Subject, names: Sequence[str] = (), leave_out: Sequence[str] = ()
) -> list[Law]:
    """The laws that a subject can be held to; with names, of these only, and without those to
    `leave_out`.

    Returns: a list of `law.Law`. Raises: UnknownName for a name that is no law; InputError where
    one of those named does not apply, or none is left.
    """
    for name in (*names, *leave_out):
        if name not in {law.name for law in LAWS}:
            raise UnknownName(
                f"there is no law {quote(name)}; {suggest(name, [law.name for law in LAWS])}"
            )
    every = [law for law in LAWS if not reason(law, subject)]
    those = f"those that do: {', '.join(law.name for law in every)}"
    for law in LAWS:
        if law.name in names and law not in every:
            raise InputError(
                f"{subject.title}: the law {law.name} does not apply: {reason(law, subject)}; {those}"
            )
    chosen = [
        law for law in every if (not names or law.name in names) and law.name not in leave_out
    ]
    if not chosen:
        raise InputError(f"{subject.title}: no law that applies is left; {those}")
    return chosen


def law_names(
    thing: Any, leave_out: Sequence[str] = (), limits: Limits | None = LIMITS
) -> list[str]:
    """The names of the laws that a subject can be held to: for `pytest.mark.parametrize`, a test
    each.

    Parameters: thing, leave_out, limits, as of `conform`. Returns: the names. Raises: as `conform`.
    """
    leave_out = [leave_out] if isinstance(leave_out, str) else leave_out
    with opened(thing, limits) as subject:
        return [law.name for law in applicable(subject, (), leave_out)]


def opened(thing: Any, limits: Limits | None) -> contextlib.AbstractContextManager[Subject]:
    """The subject in a process of its own where that can be, and was not declined, else in this
    one.
    """
    if limits is None:
        return contextlib.nullcontext(Subject(thing))
    limits.checked()
    return contextlib.nullcontext(Subject(thing)) if obstacle(thing) else isolated(thing, limits)


def reason(law: Law, subject: Subject) -> str:
    """Why a subject is not held to a law; "" where it is."""
    if law.needs not in subject.functions:
        return f"there is no {law.needs}"
    return "" if law.applies(subject) else law.unless


def remarks(subject: Subject, laws: Sequence[str], leave_out: Sequence[str]) -> list[str]:
    """What a subject is not held to, where nobody chose the laws, and which of its names are known
    to no law.
    """
    notes = [f"left out, as asked for: {', '.join(leave_out)}"] if leave_out else []
    notes += subject.misspelt
    if laws:
        return notes
    absent = [name for name in FUNCTIONS if name not in subject.functions]
    if absent:
        notes.append(f"no law of what is not there: {', '.join(absent)}")
    undeclared: dict[str, list[str]] = {}
    for law in LAWS:
        if law.needs in subject.functions and not law.applies(subject):
            undeclared.setdefault(law.unless, []).append(law.name)
    notes += [
        f"{why}, so there is no law of {', '.join(names)}" for why, names in undeclared.items()
    ]
    return notes


def conform(
    thing: Any,
    laws: Sequence[str] = (),
    examples: int | None = None,
    seconds: float = SECONDS,
    say: Callable[[int, int, str], object] = lambda done, total, name: None,
    *,
    leave_out: Sequence[str] = (),
    at_most: Grade = Grade.GOOD,
    limits: Limits | None = LIMITS,
) -> Report:
    """Hold a subject (`subject`) to the laws, and report each with a grade (`grades`).

    Parameters: thing, a class or object of functions, or "MODULE:NAME" of one; laws, names, or one
    name, all that apply by default; examples of each law, by default as many as are its own, so
    that a grade does not depend on the
    machine; seconds for all laws together, shrinking (half a minute a finding at most) and
    confirming not counted: a law for which they do not suffice is graded by ten examples at least,
    and the report says so; say(done, total,
    law), of progress; leave_out, names of laws that it is not held to; at_most, the worst `Grade`
    that conforms; limits, of each call in a process of its own (`limits.Limits`), or None for calls
    in this one.
    Returns: Report, of the same cases in every run.
    Every finding was confirmed by the second oracle (`confirm`).
    Raises: InputError for a subject that cannot be used or does not declare what is needed, and for
    laws that do not apply; UnknownName for a law that does not exist.
    """
    if (examples is not None and examples < 1) or not seconds > 0:
        raise InputError(f"examples ≥ 1 and seconds > 0 expected, got {examples} and {seconds}")
    laws, leave_out = ([names] if isinstance(names, str) else names for names in (laws, leave_out))
    here = obstacle(thing) if limits else ""
    with opened(thing, limits) as subject:
        chosen = applicable(subject, laws, leave_out)
        left, outcomes = float(seconds), []
        for done, law in enumerate(chosen):
            say(done, len(chosen), law.name)
            start = time.monotonic()
            try:
                found = worst(
                    law, subject, examples or law.examples, left / (len(chosen) - done), at_most
                )
            except Undeclared as error:
                outcomes.append(
                    Outcome(
                        law.name, law.says, Grade.EXACT, 0.0, NO_RESULT, 0, unconfirmed=str(error)
                    )
                )
                continue
            left = max(left - (time.monotonic() - start), 0.1)
            outcomes.append(outcome(law, subject, found))
    notes = remarks(subject, laws, leave_out)
    late = [outcome.law for outcome in outcomes if outcome.late]
    if late:
        notes.append(f"the time ran out: fewer examples than there should be of {', '.join(late)}")
    if here:
        notes.append(
            f"run in this process, with no limit on its calls: {here}; MODULE:CLASS is run in its own"
        )
    return Report(subject.label, tuple(outcomes), tuple(notes), at_most)


def outcome(law: Law, subject: Subject, found: Found) -> Outcome:
    """What is reported of a hunt: a finding only where the two oracles agree on what is exact."""
    verdict, case = found.verdict, found.shrunk
    precision = subject.precision(law.needs).name
    if case is None:
        return Outcome(law.name, law.says, verdict.grade, verdict.size, verdict.what, found.examples, late=found.late,
                       precision=precision)  # fmt: skip
    # Who did not answer was asked again while it was shrunk.
    again = verdict if verdict.fault.startswith(UNANSWERED) else law.check(subject, case)
    again = verdict if again.fault.startswith(LOST) else again
    steady = again.grade >= verdict.grade
    fault, hint = again.fault, ""
    if again.fault.startswith(ModuleNotFoundError.__name__):
        hint = "a package that the subject imports is not installed: nothing was judged"
    elif not law.about(case):
        hint = "nothing that this law is about is in it: what is wrong is something else"
    elif steady and again.grade is Grade.BROKEN and not again.ended:
        hint = _declared_otherwise(law, subject, found.case, case)
    if not steady:
        fault = f"another result from one call to the next: {verdict.grade.word} once, then {again.grade.word}"
    display = law.show(subject, case)
    worst = max(verdict, again, key=lambda v: v.size)
    return Outcome(
        law.name, law.says, max(verdict.grade, again.grade), worst.size, worst.what, found.examples,
        again.size, again.what, fault, case, display.words, display.paste, display.expected, hint,
        "" if law.confirm(subject, case) else "the two oracles do not agree on the exact result", found.late,
        display.names, precision,
    )  # fmt: skip


def _declared_otherwise(law: Law, subject: Subject, worst: Case, small: Case) -> str:
    """With which declarations what is broken would hold: said, and never assumed."""
    order, frame = subject.linear_first, subject.frame
    found = ""
    for other in itertools.product(
        (order, not order), (frame, *(f for f in FRAME_NAMES if frame and f != frame))
    ):
        subject.linear_first, subject.frame = other
        if not found and all(
            law.check(subject, case).grade < Grade.BROKEN for case in (worst, small)
        ):
            declared = [f'twist_order = "{ORDERS[other[0]]}"'] if other[0] != order else []
            declared += [f'jacobian_frame = "{other[1]}"'] if other[1] != frame else []
            found = f"with {' and '.join(declared)} it would hold"
    subject.linear_first, subject.frame = order, frame
    return found
