"""Hold a subject to all laws that apply, confirm what is found, and report it."""

from __future__ import annotations

import contextlib
import itertools
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from ...errors import InputError, UnknownName, quote, suggest
from ...model.kinematics.pose_jacobian import FRAME_NAMES
from .grades import NO_RESULT, Grade, Verdict
from .laws.arm_cases import ARM_LAWS
from .laws.group_cases import GROUP_LAWS
from .laws.law import Case, SubjectLaw
from .laws.urdf_cases import URDF_LAWS
from .process.calls import LOST, UNANSWERED, Undeclared
from .process.child import isolated, obstacle
from .process.limits import Limits
from .report import Outcome, Report
from .search import SearchResult, worst
from .subjects.subject import FUNCTIONS, ORDERS, Subject

LAWS: tuple[SubjectLaw, ...] = (*GROUP_LAWS, *ARM_LAWS, *URDF_LAWS)
"""Every law there is, in the order of the report."""
SECONDS = 600.0
LIMITS = Limits()


def _say_nothing(*_: object) -> None:
    """Without a report of progress."""


def applicable(
    subject: Subject,
    names: Sequence[str] = (),
    leave_out: Sequence[str] = (),
) -> list[SubjectLaw]:
    """Laws that a subject can be held to.

    Parameters
    ----------
    subject : Subject
        The subject.
    names : sequence of str, optional
        Names of the laws; by default all that apply.
    leave_out : sequence of str, optional
        Names of laws that it is not held to.

    Returns
    -------
    laws : list of SubjectLaw
        The laws, in the order of the report.

    Raises
    ------
    InputError
        If the subject cannot be used or does not declare what is needed, or a law does not apply.
    UnknownName
        For a name that is no law.
    """
    known = [law.name for law in LAWS]
    for name in (*names, *leave_out):
        if name not in known:
            raise UnknownName(f"there is no law {quote(name)}; {suggest(name, known)}")
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
    thing: Any,
    leave_out: Sequence[str] = (),
    limits: Limits | None = LIMITS,
) -> list[str]:
    """Names of the laws that a subject can be held to, for `pytest.mark.parametrize`.

    Parameters
    ----------
    thing : type, object or str
        Class or object of functions, as `Subject` takes it, or "MODULE:NAME" of one.
    leave_out : sequence of str, optional
        Names of laws that it is not held to.
    limits : Limits, optional
        Limits of each call in a process of its own, or None for calls in this one.

    Returns
    -------
    names : list of str
        The names, in the order of the report.

    Raises
    ------
    InputError
        If the subject cannot be used or does not declare what is needed, or a law does not apply.
    UnknownName
        For a name that is no law.
    """
    with opened(thing, limits) as subject:
        return [law.name for law in applicable(subject, (), _listed(leave_out))]


def _listed(names: Sequence[str]) -> Sequence[str]:
    """Names of laws, of which a single one need not stand in a list."""
    if isinstance(names, str):
        return [names]
    return names


def opened(thing: Any, limits: Limits | None) -> contextlib.AbstractContextManager[Subject]:
    """The subject in a process of its own where that can be, and was not declined, else in this
    one.
    """
    if limits is not None:
        limits.checked()
        if not obstacle(thing):
            return isolated(thing, limits)
    return contextlib.nullcontext(Subject(thing))


def reason(law: SubjectLaw, subject: Subject) -> str:
    """Why a subject is not held to a law; "" where it is."""
    if law.needs not in subject.functions:
        return f"there is no {law.needs}"
    if law.applies(subject):
        return ""
    return law.unless


def remarks(
    subject: Subject,
    laws: Sequence[str],
    leave_out: Sequence[str],
) -> list[str]:
    """Remarks on laws that a subject is not held to, where nobody chose the laws, and on names that
    no law knows.
    """
    notes = list(subject.misspelt)
    if leave_out:
        notes.insert(0, f"left out, as asked for: {', '.join(leave_out)}")
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
    say: Callable[[int, int, str], object] = _say_nothing,
    *,
    leave_out: Sequence[str] = (),
    at_most: Grade = Grade.GOOD,
    limits: Limits | None = LIMITS,
) -> Report:
    """Hold a subject to the laws, and report each with a grade.

    Cases are the same in every run. Every finding was confirmed by the second oracle (`confirm`).

    Parameters
    ----------
    thing : type, object or str
        Class or object of functions, as `Subject` takes it, or "MODULE:NAME" of one.
    laws : sequence of str, optional
        Names of the laws, or one name; by default all that apply.
    examples : int, optional
        Cases of each law; by default as many as are its own, so that a grade does not depend on the
        machine.
    seconds : float, default 600.0
        Time for all laws together, s; shrinking (half a minute a finding at most) and confirming is not
        counted. A law for which it does not suffice is graded by ten examples at least, and the report
        says so.
    say : callable, optional
        Function say(done, total, law), which is told of progress.
    leave_out : sequence of str, optional
        Names of laws that it is not held to.
    at_most : Grade, optional
        Worst grade that conforms.
    limits : Limits, optional
        Limits of each call in a process of its own, or None for calls in this one.

    Returns
    -------
    report : Report
        Outcome of each law, with counterexamples.

    Raises
    ------
    InputError
        If the subject cannot be used or does not declare what is needed, or a law does not apply.
    UnknownName
        For a name that is no law.

    Examples
    --------
    >>> import poekin as pk
    >>> from poekin.testing.conform import conform
    >>> class Mine:
    ...     def so3_exp(self, w):
    ...         return pk.so3.exp(w)  # or code of one's own
    >>> report = conform(Mine, examples=20, limits=None)
    >>> report["so3_exp"].grade.word
    'exact'
    """
    if (examples is not None and examples < 1) or not seconds > 0:
        raise InputError(f"examples ≥ 1 and seconds > 0 expected, got {examples} and {seconds}")
    laws = _listed(laws)
    leave_out = _listed(leave_out)
    here = obstacle(thing)
    with opened(thing, limits) as subject:
        chosen = applicable(subject, laws, leave_out)
        left = float(seconds)
        outcomes = []
        for done, law in enumerate(chosen):
            say(done, len(chosen), law.name)
            start = time.monotonic()
            try:
                found = worst(
                    law,
                    subject,
                    examples or law.examples,
                    left / (len(chosen) - done),
                    at_most,
                )
            except Undeclared as error:
                unjudged = Outcome(law.name, law.says, Grade.EXACT, 0.0, NO_RESULT, 0)
                outcomes.append(replace(unjudged, unconfirmed=str(error)))
                continue
            left = max(left - (time.monotonic() - start), 0.1)
            outcomes.append(outcome(law, subject, found))
    notes = remarks(subject, laws, leave_out)
    late = [outcome.law for outcome in outcomes if outcome.late]
    if late:
        notes.append(f"the time ran out: fewer examples than there should be of {', '.join(late)}")
    if limits and here:
        notes.append(
            f"run in this process, with no limit on its calls: {here}; MODULE:CLASS is run in its own"
        )
    return Report(subject.label, tuple(outcomes), tuple(notes), at_most)


def outcome(
    law: SubjectLaw,
    subject: Subject,
    found: SearchResult,
) -> Outcome:
    """Outcome of a hunt: a finding only where the two oracles agree on the exact result."""
    verdict = found.verdict
    case = found.shrunk
    plain = Outcome(
        law=law.name,
        says=law.says,
        grade=verdict.grade,
        worst=verdict.size,
        what=verdict.what,
        examples=found.examples,
        late=found.late,
        precision=subject.precision(law.needs).name,
    )
    if case is None:
        return plain
    again = _repeated(law, subject, verdict, case)
    fault = again.fault
    if again.grade < verdict.grade:
        then = f"{verdict.grade.word} once, then {again.grade.word}"
        fault = f"another result from one call to the next: {then}"
    hint = _hint(law, subject, found, again)
    display = law.show(subject, case)
    worst = max(verdict, again, key=lambda v: v.size)
    if not law.confirm(subject, case):
        plain = replace(plain, unconfirmed="the two oracles do not agree on the exact result")
    return replace(
        plain,
        grade=max(verdict.grade, again.grade),
        worst=worst.size,
        what=worst.what,
        error=again.size,
        error_of=again.what,
        fault=fault,
        case=case,
        hint=hint,
        **display._asdict(),
    )


def _repeated(
    law: SubjectLaw,
    subject: Subject,
    verdict: Verdict,
    case: Case,
) -> Verdict:
    """The verdict on a case that is tried again, where the subject can be asked again."""
    if verdict.fault.startswith(UNANSWERED):  # asked again already, while it was shrunk
        return verdict
    again = law.check(subject, case)
    if again.fault.startswith(LOST):
        return verdict
    return again


def _hint(
    law: SubjectLaw,
    subject: Subject,
    found: SearchResult,
    again: Verdict,
) -> str:
    """A hint on the cause of a finding; "" where there is none."""
    case = found.shrunk or found.case
    if again.fault.startswith(ModuleNotFoundError.__name__):
        return "a package that the subject imports is not installed: nothing was judged"
    if not law.about(case):
        return "nothing that this law is about is in it: what is wrong is something else"
    if again.grade is Grade.BROKEN and not again.ended:
        return _declared_otherwise(law, subject, found.case, case)
    return ""


def _declared_otherwise(
    law: SubjectLaw,
    subject: Subject,
    worst: Case,
    small: Case,
) -> str:
    """With which declarations what is broken would hold: said, and never assumed."""
    order = subject.linear_first
    frame = subject.frame
    found = ""
    for other in itertools.product(
        (order, not order),
        (frame, *(f for f in FRAME_NAMES if frame and f != frame)),
    ):
        subject.linear_first, subject.frame = other
        if not found and all(
            law.check(subject, case).grade < Grade.BROKEN for case in (worst, small)
        ):
            declared = []
            if other[0] != order:
                declared.append(f'twist_order = "{ORDERS[other[0]]}"')
            if other[1] != frame:
                declared.append(f'jacobian_frame = "{other[1]}"')
            found = f"with {' and '.join(declared)} it would hold"
    subject.linear_first = order
    subject.frame = frame
    return found
