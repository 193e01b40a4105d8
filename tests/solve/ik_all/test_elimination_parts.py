"""Solutions of two tables of one arm are put together, each once."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.formulas.ik.elimination import circle_roots
from poekin.model import screw
from poekin.model.chain import Chain
from poekin.solve.ik_all.elimination import EliminatedRows, Elimination, _join, _table


def rows(*solutions: tuple[float, float]) -> EliminatedRows:
    """Of one target with room for four: angles alike of all six joints, and a margin; -1 for none."""
    branches = np.zeros((1, 4, 7))
    branches[:, :, -1] = -1.0
    for k, (angle, margin) in enumerate(solutions):
        branches[0, k, :-1], branches[0, k, -1] = angle, margin
    return EliminatedRows(branches, np.zeros(1, bool))


def test_what_another_table_finds_is_added_where_there_is_room():
    found = rows((0.5, 0.3))
    _join(found, np.array([0]), rows((0.5, 0.2), (1.0, 0.0), (2.0, 0.4)), np.ones(1, bool))
    assert found.branches[0, :3, 0].tolist() == [0.5, 1.0, 2.0]
    assert found.branches[0, :, -1].tolist() == [0.3, 0.0, 0.4, -1.0]
    full = rows((0.5, 0.3), (1.0, 0.1), (2.0, 0.0), (3.0, 0.2))
    _join(full, np.array([0]), rows((1.5, 0.2)), np.ones(1, bool))
    assert full.branches[0, :, 0].tolist() == [0.5, 1.0, 2.0, 3.0]


def test_of_a_target_that_is_sure_what_is_to_be_tried_is_added_where_it_is_near_to_no_solution():
    near = rows((0.5 + 0.09, 0.0), (1.0, 0.0), (2.0, 0.1), (2.05, 0.2))
    for sure, angles in ((True, [0.5, 1.0, 2.0]), (False, [0.5, 1.0, 2.0, 2.05])):
        found = rows((0.5, 0.3))
        found.sure[:] = sure
        _join(found, np.array([0]), near, np.ones(1, bool))
        known = found.margin[0] >= 0
        assert found.branches[0, known, 0].tolist() == angles
        assert found.sure[0] == sure


def test_there_is_room_for_the_sixteen_solutions_that_six_revolute_joints_have_at_most():
    assert Elimination.most == 16 <= circle_roots.ROOM


@pytest.mark.parametrize(("scale", "size"), [(0.0, 1.0), (1.0, 3.0), (0.5, 1.5)])
def test_the_size_of_a_table_is_the_widest_range_of_its_points_and_1_where_they_are_one(
    scale, size
):
    ways = np.eye(3)[[2, 1, 2, 0, 2, 1]]
    places = scale * np.diag([0.2, 3.0, 0.5])[[0, 1, 2, 0, 1, 2]]
    screws = [screw.revolute(way, place) for way, place in zip(ways, places, strict=True)]
    form = Chain.from_space(screws, np.eye(4)).to_hp()
    assert _table(form, 1, 2)[8, :3].tolist() == [size, 1, 2]
