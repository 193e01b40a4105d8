"""What was found cannot be changed by accident, and two results of arrays are not compared number by number."""

from __future__ import annotations

import pytest

from tests import findings

FOUND = [
    *findings.dataclasses_of("poekin.solve", "all_solutions followed ik_all_search solution starts task"),
    *findings.dataclasses_of("poekin.solve.motion", "timing"),
]


@pytest.mark.parametrize("kind", FOUND, ids=lambda kind: kind.__name__)
def test_a_result_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert findings.frozen_and_equal_only_where_its_parts_can_be(kind)
