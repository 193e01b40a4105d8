"""What was found cannot be changed by accident, and two results of arrays are not compared number
by number.
"""

from __future__ import annotations

import pytest

from poekin.solve.ik import joint_domain, solution, task
from poekin.solve.ik_all import all_solutions, ik_all_search, structure
from poekin.solve.ik_all.nearest import constrained_arm, nearest_arm
from poekin.solve.ik_all.solution_sets import evidence, found
from poekin.solve.ik_structure import result
from poekin.solve.motion import timing
from poekin.solve.path import path_interval, path_result
from tests import findings

OWN = (
    all_solutions,
    path_interval,
    path_result,
    ik_all_search,
    structure,
    constrained_arm,
    nearest_arm,
    result,
    evidence,
    found,
    solution,
    joint_domain,
    task,
    timing,
)
FOUND = [
    *(kind for module in OWN for kind in findings.dataclasses_of(*module.__name__.rsplit(".", 1))),
]


@pytest.mark.parametrize("kind", FOUND, ids=lambda kind: kind.__name__)
def test_a_result_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert findings.frozen_and_equal_only_where_its_parts_can_be(kind)
