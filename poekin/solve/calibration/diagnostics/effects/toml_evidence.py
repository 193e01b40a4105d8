"""Diagnosis of a calibration in its file: each test with its chance, to the last bit."""

from __future__ import annotations

from typing import Any, get_args

from .....formats.text.toml_text import Keys
from .columns import EffectKind
from .diagnosis import FitEvidence, ResidualDiagnosis, SavedEvidence
from .effect_test import EffectTest


def to_data(evidence: FitEvidence | SavedEvidence | None) -> dict[str, Any] | None:
    """Table of the points that were measured and of the diagnosis; None where there is none."""
    if evidence is None:
        return None
    diagnosis = evidence.diagnosis
    return {
        "points": evidence.points,
        "finding": [test._asdict() for test in diagnosis.findings],
        "test": [test._asdict() for test in diagnosis.tests],
    }


def from_keys(keys: Keys) -> SavedEvidence | None:
    """Evidence that `to_data` made a table of; None of a file without it. Raises: ModelError."""
    if "diagnosis" not in keys.data:
        return None
    own = keys.table("diagnosis", ("points", "finding", "test"))
    points = own.array("points", (None, 3))
    if not len(points):
        raise own.fault("points", "expected the points that were measured, got none")
    findings = map(_test, own.tables("finding", EffectTest._fields))
    tests = map(_test, own.tables("test", EffectTest._fields))
    return SavedEvidence(points, ResidualDiagnosis(tuple(findings), tuple(tests)))


def _test(keys: Keys) -> EffectTest:
    kind: Any = keys.text("kind", get_args(EffectKind))
    return EffectTest(
        kind,
        keys.text("whose"),
        keys.number("p"),
        keys.number("size"),
        keys.truth("against"),
    )
