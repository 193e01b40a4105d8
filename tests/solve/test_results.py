"""What was found cannot be changed by accident, and two results of arrays are not compared number by number."""

from __future__ import annotations

import pytest

from poekin.solve import all_solutions, followed, ik_all_search, solution, starts, task
from poekin.solve.motion import timing
from tests import findings

OWN = (all_solutions, followed, ik_all_search, solution, starts, task, timing)
FOUND = [
    *(kind for module in OWN for kind in findings.dataclasses_of(*module.__name__.rsplit(".", 1))),
]


@pytest.mark.parametrize("kind", FOUND, ids=lambda kind: kind.__name__)
def test_a_result_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert findings.frozen_and_equal_only_where_its_parts_can_be(kind)
