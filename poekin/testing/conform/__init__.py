"""Hold any library to the laws: its exp, log, Jacobians of exp, kinematics, or URDF reader, as a
small class.

    from poekin.testing.conform import conform

    class Mine:
        twist_order = "angular first"

        def exp(self, xi):
            return ...  # (4, 4)

    report = conform(Mine)              # or conform("my_module:Mine"), or `poekin conform
    my_module:Mine`
    print(report)

    subjects.subject     what a subject may have, and what it must declare
    subjects.named       a subject by its name
    subjects.precision   float64 and float32: what errors are held to
    process    the process that a subject runs in, and its limits
    laws.of_groups, laws.of_arms, laws.of_urdf   the laws as plain functions, for anybody's own
    tests
    laws.group_cases, laws.arm_cases, laws.urdf_cases   what each law is tried on
    grades     exact, good, poor, broken: how errors are graded
    confirm    the second oracle, which every finding must stand against
    plugin     pytest's fixture `conform`

Every truth has 80 digits, and shares no code with the subject. Cases draw angles and lengths
independently, and log-uniformly. Needs the extra `testing`.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .grades import ErrorPart, Grade, Verdict
    from .laws.law import Case, SubjectLaw
    from .process.limits import Limits
    from .report import Outcome, Report
    from .run import LAWS, applicable, conform, law_names
    from .subjects.named import loaded
    from .subjects.precision import DOUBLE, SINGLE
    from .subjects.subject import FUNCTIONS, Subject

__all__ = [
    "DOUBLE",
    "FUNCTIONS",
    "LAWS",
    "SINGLE",
    "Case",
    "ErrorPart",
    "Grade",
    "Limits",
    "Outcome",
    "Report",
    "Subject",
    "SubjectLaw",
    "Verdict",
    "applicable",
    "conform",
    "law_names",
    "loaded",
]
_HOMES = {
    "grades": ("Grade", "ErrorPart", "Verdict"),
    "laws.law": ("Case", "SubjectLaw"),
    "process.limits": ("Limits",),
    "subjects.named": ("loaded",),
    "report": ("Outcome", "Report"),
    "run": ("LAWS", "applicable", "conform", "law_names"),
    "subjects.precision": ("DOUBLE", "SINGLE"),
    "subjects.subject": ("FUNCTIONS", "Subject"),
}


def __getattr__(name: str) -> Any:
    # Imported when asked for: the process that a subject runs in has no use for laws and oracles.
    for home, names in _HOMES.items():
        if name in names:
            return getattr(importlib.import_module(f"{__name__}.{home}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
