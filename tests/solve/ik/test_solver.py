"""A batch of targets is solved in parts as it is in one."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.ik import solver
from poekin.solve.ik.ik_problem import Settings, make_problem

ARM = pk.load("ur5").chain().compile()
GIVEN = Settings("pose", None, True, 1e-9, 2e-9, None, None, 7, 30, 3, False)


@pytest.mark.parametrize("aim", [None, "middle"])
@pytest.mark.parametrize("near", [None, [0.1, -1.0, 1.2, 0.4, 0.9, -0.3]])
def test_targets_in_parts_are_solved_as_all_together(near, aim, monkeypatch):
    T = ARM.fk(ARM.chain.random(0, 20))
    made, told = make_problem(ARM, GIVEN._replace(task="position")), []
    whole = solver.solve(made, T, nearest_to=near, objective=aim)
    monkeypatch.setattr(solver, "AT_ONCE", 7)
    parts = solver.solve(
        made,
        T,
        nearest_to=near,
        objective=aim,
        progress=lambda done, count: told.append((done, count)),
    )
    assert told == [(7, 20), (14, 20), (20, 20)]
    np.testing.assert_array_equal(parts.success, whole.success)
    if near is None:  # random starts of the others depend on how many there are in a part
        np.testing.assert_allclose(parts.q, whole.q, rtol=0, atol=1e-12)
        np.testing.assert_array_equal(parts.iterations, whole.iterations)


def test_of_a_single_target_progress_is_told_too():
    made, told = make_problem(ARM, GIVEN), []
    T = ARM.fk([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])
    found = solver.solve(made, T, progress=lambda done, count: told.append((done, count)))
    assert told == [(1, 1)]
    assert found.success.shape == ()
    assert found.success
