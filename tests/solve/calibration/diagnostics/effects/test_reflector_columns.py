"""Of several reflectors each is an effect of its own; of one there is none beside the tool."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.solve.calibration.diagnostics.effects import columns
from poekin.solve.calibration.measurements.points import Points

N = 4


@pytest.mark.parametrize("count", [1, 2, 3])
def test_each_of_two_or_more_reflectors_is_moved_alone(count, monkeypatch):
    points = Points(np.zeros((N, count, 3)), np.eye(3)[:count])
    size = 3 * count * N
    whole = np.arange(float(3 * count * size)).reshape(N, 3 * count, 3 * count)
    monkeypatch.setattr(columns, "point_shifts", lambda problem, p, k: whole)
    monkeypatch.setattr(columns, "parts", lambda problem: [slice(None)])
    problem: Any = SimpleNamespace(sets=[points], n_equations=size)
    fit: Any = SimpleNamespace(p=None, noise=SimpleNamespace(whitened=lambda k, values: values))
    found = list(columns._of_reflectors(problem, fit))
    names = [f"reflector {j + 1}" for j in range(count)]
    assert [(one.kind, one.whose) for one in found] == [
        ("reflector", name) for name in names if count > 1
    ]
    for j, one in enumerate(found):
        np.testing.assert_array_equal(one.columns, whole[..., 3 * j : 3 * j + 3].reshape(-1, 3))
