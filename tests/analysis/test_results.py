"""What an analysis found cannot be changed by accident, and findings of arrays are not compared
number by number.
"""

from __future__ import annotations

import json

import numpy as np
import pytest

from benchmarks.planted_changes import random_arm
from poekin.analysis.axes import axes
from poekin.analysis.compare.compare import compare
from poekin.analysis.dexterity.singularity import singularity
from poekin.analysis.validate import Validation
from tests import findings

FOUND = [
    *findings.dataclasses_of("poekin.analysis", "axes shapes validate"),
    *findings.dataclasses_of(
        "poekin.analysis.compare", "comparison alignment.lines alignment.hypotheses"
    ),
    *findings.dataclasses_of("poekin.analysis.counting", "count count_methods count_table"),
    *findings.dataclasses_of("poekin.analysis.dexterity", "singularity"),
]


@pytest.mark.parametrize("kind", FOUND, ids=lambda kind: kind.__name__)
def test_a_finding_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert findings.frozen_and_equal_only_where_its_parts_can_be(kind)


ARM = random_arm(1, ("revolute",) * 3)
RESULTS = [
    axes(ARM),
    compare(ARM, ARM, samples=1),
    singularity(ARM, np.zeros(3)),
    Validation("r", "s", (), 1.0, 0, 0, "v"),
]


@pytest.mark.parametrize("found", RESULTS, ids=lambda found: type(found).__name__)
def test_json_is_the_dict_with_two_blanks_a_level(found):
    assert found.to_json() == json.dumps(found.to_dict(), indent=2)


def test_a_validation_moves_nothing_unless_that_is_said():
    nothing = Validation("r", "s", (), 1.0, 0, 0, "v")
    assert (nothing.moving, nothing.worst, nothing.error, nothing.passed) == (0, None, 0, False)
