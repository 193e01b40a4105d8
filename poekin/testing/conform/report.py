"""What came of holding a subject to the laws: law by law a grade, a counterexample, and whether it
was confirmed.
"""

from __future__ import annotations

from collections.abc import Mapping
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
        """How many numbers of the counterexample are not zero."""
        return 0 if self.case is None else int(np.count_nonzero(self.case.numbers))

    @property
    def word(self) -> str:
        """The grade as it is printed."""
        return "not judged" if self.unconfirmed else self.grade.word

    def as_dict(self) -> dict[str, Any]:
        """Plain data; an infinite error is None."""
        plain: dict[str, Any] = {
            "law": self.law, "says": self.says, "grade": self.word, "worst": self.worst, "of": self.what,
            "examples": self.examples, "time_ran_out": self.late,
            "precision": self.precision,
        }  # fmt: skip
        if self.unconfirmed:
            return plain | {"unconfirmed": self.unconfirmed}
        if self.finding:
            plain |= {"error": self.error, "error_of": self.error_of, "fault": self.fault}
            plain |= {"counterexample": self.words, "python": self.paste}
            plain |= {
                "numbers": [] if self.case is None else self.case.numbers,
                "expected": self.expected,
            }
            plain |= {"names": list(self.names), "hint": self.hint}
        return plain

    def __str__(self) -> str:
        return self.told()

    def told(self, before: Mapping[str, str] = MappingProxyType({})) -> str:
        """The outcome in a few lines; Python that another law printed `before`, as {Python: law},
        is not repeated.

        Returns: the text. Raises: nothing.
        """
        lines = [f"{self.says}", f"worst {self.worst:.2g} of {self.what}"]
        if not np.isfinite(self.worst):
            lines[1] = (
                "worst: no result"
                if self.what == NO_RESULT
                else f"worst: {self.what} is not 0, and must be"
            )
        lines[1] += f"; {self.examples} examples" + (
            " in float32" if self.precision == "float32" else ""
        )
        if self.unconfirmed:
            lines[1:] = [self.unconfirmed]
        elif not self.finding:
            lines[1] += ", which say little" if self.examples < FEW else ""
            lines[1] += "; the time ran out" if self.late else ""
        else:
            error = f"{self.error:.2g} of {self.error_of}"
            error = error if np.isfinite(self.error) else f"{self.error_of} is not 0, and must be"
            lines.append(f"{self.fault or error} at {self.words}")
            if self.paste in before:
                lines.append(f"# the Python is that of {before[self.paste]}, above")
            else:
                exact = [f"# names: {', '.join(self.names)}, or more"] if self.names else []
                exact += (
                    [] if self.expected is None else [f"# exact: {(self.expected + 0.0).tolist()}"]
                )
                lines += [self.paste, *exact]
            lines += [self.hint] if self.hint else []
        return f"{self.word:10} {self.law}: " + "\n           ".join(lines)


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
        lines, before = [escape_unprintable(self.subject, 200)], dict[str, str]()
        for outcome in self.outcomes:
            lines.append(escape_unprintable(outcome.told(before), keep="\n"))
            before.setdefault(outcome.paste, outcome.law)
        lines += [f"note: {escape_unprintable(note)}" for note in self.notes]
        return "\n".join(lines)
