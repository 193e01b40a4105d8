"""Hold any library to the laws: its exp, log, Jacobians of exp, kinematics, or URDF reader, as a small class.

    from poekin.testing.conform import conform

    class Mine:
        twist_order = "angular first"

        def exp(self, xi):
            return ...  # (4, 4)

    report = conform(Mine)              # or conform("my_module:Mine"), or `poekin conform my_module:Mine`
    print(report)

    subject    what a subject may have, and what it must declare
    named      a subject by its name
    limits, child, worker   the process that it runs in
    precision  float64 and float32: what errors are held to
    grades     exact, good, poor, broken: how errors are graded
    of_groups, of_arms, of_urdf   the laws as plain functions, for anybody's own tests
    group_cases, arm_cases, urdf_cases   what each law is tried on
    confirm    the second oracle, which every finding must stand against
    plugin     pytest's fixture `conform`

Every truth has 80 digits, and shares no code with the subject. Cases draw angles and lengths independently, and
log-uniformly. Needs the extra `testing`.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .grades import Grade, Part, Verdict
    from .law import Case, Law
    from .limits import Limits
    from .named import loaded
    from .precision import DOUBLE, SINGLE
    from .report import Outcome, Report
    from .run import LAWS, applicable, conform, law_names
    from .subject import FUNCTIONS, Subject

__all__ = ["DOUBLE", "FUNCTIONS", "LAWS", "SINGLE", "Case", "Grade", "Law", "Limits", "Outcome", "Part", "Report",
           "Subject", "Verdict", "applicable", "conform", "law_names", "loaded"]  # fmt: skip
_HOMES = {
    "grades": ("Grade", "Part", "Verdict"),
    "law": ("Case", "Law"),
    "limits": ("Limits",),
    "named": ("loaded",),
    "report": ("Outcome", "Report"),
    "run": ("LAWS", "applicable", "conform", "law_names"),
    "precision": ("DOUBLE", "SINGLE"),
    "subject": ("FUNCTIONS", "Subject"),
}


def __getattr__(name: str) -> Any:
    # Imported when asked for: the process that a subject runs in has no use for laws and oracles.
    for home, names in _HOMES.items():
        if name in names:
            return getattr(importlib.import_module(f"{__name__}.{home}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
