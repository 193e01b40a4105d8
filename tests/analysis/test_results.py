"""What an analysis found cannot be changed by accident, and findings of arrays are not compared number by number."""

from __future__ import annotations

import dataclasses

import pytest

from poekin.analysis import axes, comparison, count, count_methods, count_table, lines, reading, shapes
from poekin.analysis import singularity as singularities
from poekin.analysis import validate as validation

MODULES = axes, comparison, count, count_methods, count_table, lines, reading, shapes, singularities, validation
FOUND = [
    kind for module in MODULES for kind in vars(module).values()
    if dataclasses.is_dataclass(kind) and isinstance(kind, type) and kind.__module__ == module.__name__
]  # fmt: skip


@pytest.mark.parametrize("kind", FOUND, ids=lambda kind: kind.__name__)
def test_a_finding_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    parameters = kind.__dataclass_params__
    arrays = any("Array" in str(part.type) or "Marks" in str(part.type) for part in dataclasses.fields(kind))
    assert (parameters.frozen, parameters.eq) == (True, not arrays)
