"""What was found cannot be changed by accident, and two results of arrays are not compared number by number."""

from __future__ import annotations

import dataclasses

import pytest

from poekin.solve import all_solutions, followed, ik_all_search, solution, starts, task
from poekin.solve.calibration import calibration, choice, identification, points, poses, residuals, simulated
from poekin.solve.motion import timing

MODULES = (
    all_solutions, calibration, choice, followed, identification, ik_all_search, points, poses, residuals, simulated,
    solution, starts, task, timing,
)  # fmt: skip
FOUND = [
    kind for module in MODULES for kind in vars(module).values()
    if dataclasses.is_dataclass(kind) and isinstance(kind, type) and kind.__module__ == module.__name__
]  # fmt: skip


@pytest.mark.parametrize("kind", FOUND, ids=lambda kind: kind.__name__)
def test_a_result_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    parameters = kind.__dataclass_params__
    words = [str(part.type) for part in dataclasses.fields(kind)]
    arrays = any(word in said for said in words for word in ("Array", "ndarray", "Any"))
    assert (parameters.frozen, parameters.eq) == (True, not arrays)
