"""Report on a subject held to the laws: law by law a grade, a counterexample, and whether it was
confirmed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from ...errors import escape_unprintable
from .grades import NO_RESULT, Grade
from .laws.law import Case

FEW = 100
"""Fewer examples than these say little of a law that seems to hold."""


@dataclass(frozen=True)
class Outcome:
    """One law and one subject.

    grade; worst: the largest size of an error met (inf: no result), of `what`; examples: how many
    were tried; late: whether there was no time for all of them. Of a finding (poor or broken, or
    worse than was asked for) also the shrunk case with its numbers; its error, `error_of` what, or
    its fault (a text) where there was no result; the case in words, as Python to paste (`paste`),
    and what ought to come of it (`expected`, any shape; `names`, those that a URDF has to be read
    with); a hint; precision, the floats that the subject computes in.
    unconfirmed: why it is no finding, where its truth did not stand against the second oracle; the
    grade says nothing then.
    """

    law: str
    says: str
    grade: Grade
    worst: float
    what: str
    examples: int
    error: float = 0.0
    error_of: str = ""
    fault: str = ""
    case: Case | None = None
    words: str = ""
    paste: str = ""
    expected: np.ndarray | None = None
    hint: str = ""
    unconfirmed: str = ""
    late: bool = False
    names: tuple[str, ...] = ()
    precision: str = "float64"

    @property
    def finding(self) -> bool:
        """Whether it is to be printed with its counterexample."""
        return self.case is not None and not self.unconfirmed

    @property
    def numbers(self) -> int:
        """Number of nonzero numbers in the counterexample."""
        if self.case is None:
            return 0
        return int(np.count_nonzero(self.case.numbers))

    @property
    def word(self) -> str:
        """The grade as it is printed."""
        if self.unconfirmed:
            return "not judged"
        return self.grade.word

    def as_dict(self) -> dict[str, Any]:
        """Plain data; an infinite error is None."""
        plain: dict[str, Any] = {
            "law": self.law,
            "says": self.says,
            "grade": self.word,
            "worst": self.worst,
            "of": self.what,
            "examples": self.examples,
            "time_ran_out": self.late,
            "precision": self.precision,
        }
        if self.unconfirmed:
            return plain | {"unconfirmed": self.unconfirmed}
        if self.case is not None:
            plain |= {
                "error": self.error,
                "error_of": self.error_of,
                "fault": self.fault,
                "counterexample": self.words,
                "python": self.paste,
                "numbers": self.case.numbers,
                "expected": self.expected,
                "names": list(self.names),
                "hint": self.hint,
            }
        return plain

    def __str__(self) -> str:
        return self.told()

    def told(self, before: Mapping[str, str] = MappingProxyType({})) -> str:
        """The outcome in a few lines; Python that another law printed `before`, as {Python: law},
        is not repeated.

        Returns: the text. Raises: nothing.
        """
        if self.unconfirmed:
            lines = [self.unconfirmed]
        elif self.finding:
            lines = [self._tried(), *self._counterexample(before)]
        else:
            lines = [self._tried()]
            if self.examples < FEW:
                lines[0] += ", which say little"
            if self.late:
                lines[0] += "; the time ran out"
        return f"{self.word:10} {self.law}: " + "\n           ".join([self.says, *lines])

    def _tried(self) -> str:
        """The worst error of all examples."""
        worst = f"worst {_sized(self.worst, self.what)}"
        if not np.isfinite(self.worst):
            worst = f"worst: {_sized(self.worst, self.what)}"
        if self.precision == "float32":
            return f"{worst}; {self.examples} examples in float32"
        return f"{worst}; {self.examples} examples"

    def _counterexample(self, before: Mapping[str, str]) -> Iterator[str]:
        """Lines of a finding."""
        error = self.fault or _sized(self.error, self.error_of)
        yield f"{error} at {self.words}"
        if self.paste in before:
            yield f"# the Python is that of {before[self.paste]}, above"
        else:
            yield self.paste
            if self.names:
                yield f"# names: {', '.join(self.names)}, or more"
            if self.expected is not None:
                yield f"# exact: {(self.expected + 0.0).tolist()}"
        if self.hint:
            yield self.hint


def _sized(error: float, of: str) -> str:
    """The size of an error of a quantity, as it is printed."""
    if np.isfinite(error):
        return f"{error:.2g} of {of}"
    if of == NO_RESULT:
        return of
    return f"{of} is not 0, and must be"


@dataclass(frozen=True)
class Report:
    """All outcomes of one subject, and what else is to be known of them.

    notes: laws that it was not held to, names that are none of a subject's, and the like; at_most:
    the worst grade that conforms.
    """

    subject: str
    outcomes: tuple[Outcome, ...]
    notes: tuple[str, ...] = ()
    at_most: Grade = Grade.GOOD

    @property
    def findings(self) -> tuple[Outcome, ...]:
        """The outcomes with a counterexample, which was confirmed: poor, broken, or worse than
        `at_most`.
        """
        return tuple(outcome for outcome in self.outcomes if outcome.finding)

    @property
    def conforms(self) -> bool:
        """Whether nothing that was confirmed is worse than `at_most`."""
        return all(
            outcome.grade <= self.at_most or outcome.unconfirmed for outcome in self.outcomes
        )

    def __getitem__(self, law: str) -> Outcome:
        for outcome in self.outcomes:
            if outcome.law == law:
                return outcome
        raise KeyError(law)

    def as_dict(self) -> dict[str, Any]:
        """Plain data, as `poekin conform --json` prints it."""
        laws = [outcome.as_dict() for outcome in self.outcomes]
        return {
            "subject": self.subject,
            "conforms": self.conforms,
            "laws": laws,
            "notes": list(self.notes),
        }

    def __str__(self) -> str:
        lines = [escape_unprintable(self.subject, 200)]
        before = dict[str, str]()
        for outcome in self.outcomes:
            lines.append(escape_unprintable(outcome.told(before), keep="\n"))
            before.setdefault(outcome.paste, outcome.law)
        lines += [f"note: {escape_unprintable(note)}" for note in self.notes]
        return "\n".join(lines)
