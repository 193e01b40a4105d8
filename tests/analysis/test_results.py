"""What an analysis found cannot be changed by accident, and findings of arrays are not compared number by number."""

from __future__ import annotations

import pytest

from tests import findings

FOUND = findings.dataclasses_of(
    "poekin.analysis", "axes comparison count count_methods count_table lines reading shapes singularity validate"
)


@pytest.mark.parametrize("kind", FOUND, ids=lambda kind: kind.__name__)
def test_a_finding_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert findings.frozen_and_equal_only_where_its_parts_can_be(kind)
