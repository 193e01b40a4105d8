"""Report on a subject held to the laws: law by law a grade, a counterexample, and whether it was
confirmed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ...errors import escape_unprintable
from ...results import Result, plain
from .grades import NO_RESULT, Grade
from .laws.law import Case
from .subjects.precision import PrecisionName

FEW = 100
"""Fewer examples than these say little of a law that seems to hold."""


@dataclass(frozen=True)
class Outcome(Result):
    """Outcome of one law and one subject.

    Attributes
    ----------
    law : str
        Name of the law.
    says : str
        Claim of the law in words.
    grade : Grade
        Worst grade of all examples.
    worst : float
        Largest size of an error met, of `what`; inf where there was no result.
    what : str
        Quantity in error.
    examples : int
        Number of examples tried.
    error : float
        Error of the counterexample of a finding, of `error_of`.
    error_of : str
        Quantity in error in the counterexample.
    fault : str
        Fault of the counterexample, where there was no result.
    case : Case or None
        Counterexample, shrunk, of a finding: poor or broken, or worse than was asked for.
    words : str
        Counterexample in words.
    paste : str
        Counterexample as Python to paste.
    expected : (...) ndarray or None
        Exact result of the counterexample.
    hint : str
        Hint on the cause.
    unconfirmed : str
        Reason why it is no finding, where its truth did not stand against the second oracle; the grade
        says nothing then.
    late : bool
        Whether there was no time for all examples.
    names : tuple of str
        Coordinates that a URDF has to be read with.
    precision : {"float64", "float32"}
        Floats that the subject computes in.
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
    precision: PrecisionName = "float64"

    @property
    def finding(self) -> bool:
        """Whether the outcome is to be printed with its counterexample."""
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

    def to_dict(self) -> dict[str, object]:
        """Outcome as plain data.

        Returns
        -------
        document : dict
            Lists, strings and numbers; an infinite error is None.
        """
        found: dict[str, object] = {
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
            found["unconfirmed"] = self.unconfirmed
        elif self.case is not None:
            found |= {
                "error": self.error,
                "error_of": self.error_of,
                "fault": self.fault,
                "counterexample": self.words,
                "python": self.paste,
                "numbers": self.case.numbers,
                "expected": self.expected,
                "names": self.names,
                "hint": self.hint,
            }
        return {key: plain(value) for key, value in found.items()}

    def summary(
        self,
        before: Mapping[str, str] = MappingProxyType({}),
    ) -> str:
        """Outcome in a few lines of text. Raises: nothing.

        Parameters
        ----------
        before : Mapping, optional
            Python that other laws printed before, with their names; it is not repeated.

        Returns
        -------
        text : str
            The lines.
        """
        if self.unconfirmed:
            lines = [self.unconfirmed]
        elif self.finding:
            lines = [self._tried(), *self._counterexample(before)]
        else:
            tried = self._tried()
            if self.examples < FEW:
                tried += ", which say little"
            if self.late:
                tried += "; the time ran out"
            lines = [tried]
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
class Report(Result):
    """Report on a subject: all outcomes, and what else is to be known of them.

    Attributes
    ----------
    subject : str
        Name and version of the subject.
    outcomes : tuple of Outcome
        Outcome of each law.
    notes : tuple of str
        Laws that it was not held to, names that are none of a subject's, and the like.
    at_most : Grade
        Worst grade that conforms.
    """

    subject: str
    outcomes: tuple[Outcome, ...]
    notes: tuple[str, ...] = ()
    at_most: Grade = Grade.GOOD

    @property
    def findings(self) -> tuple[Outcome, ...]:
        """Outcomes with a confirmed counterexample: poor, broken, or worse than `at_most`."""
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

    def to_dict(self) -> dict[str, object]:
        """Report as plain data, as `poekin conform --json` prints it.

        Returns
        -------
        document : dict
            Dicts, lists, strings and numbers; an infinite error is None.
        """
        return {
            "subject": self.subject,
            "conforms": self.conforms,
            "laws": plain(self.outcomes),
            "notes": plain(self.notes),
        }

    def summary(self) -> str:
        """Text of all outcomes and notes."""
        lines = [escape_unprintable(self.subject, 200)]
        before = dict[str, str]()
        for outcome in self.outcomes:
            lines.append(escape_unprintable(outcome.summary(before), keep="\n"))
            before.setdefault(outcome.paste, outcome.law)
        lines += [f"note: {escape_unprintable(note)}" for note in self.notes]
        return "\n".join(lines)
