"""A tree's program: what the formula of its links gives on numbers, and what it costs."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from poekin.algebra import IDENTITY
from poekin.engine.straight_line.interpret import evaluate
from poekin.engine.straight_line.tree import TracedTree, tree_program
from poekin.formulas.kinematics import forward
from poekin.groups import se3

TURN = (0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
SLIDE = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0)
STILL = (0.0,) * 6
UP = (*IDENTITY[:11], 0.5)


def tilted(seed: int) -> tuple[float, ...]:
    T = se3.exp(np.random.default_rng(seed).normal(size=6))
    return (*T[:3, :3].ravel().tolist(), *T[:3, 3].tolist())


def test_a_tree_stays_as_it_was_made():
    tree = TracedTree([], [], [], [], [])
    with pytest.raises(FrozenInstanceError):
        tree.parents = [0]  # type: ignore[misc]


def test_poses_are_the_formulas_on_numbers():
    s = math.sqrt(0.5)
    tree = TracedTree(
        parents=[0, 1, 1, 3, 2],
        origins=[tilted(1), UP, tilted(2), tilted(3), UP],
        screws=[TURN, SLIDE, (s, 0, s, 0.1, 0.2, 0.3), STILL, TURN],
        factors=[[1.0, 0, 0], [0.5, -2.0, 0], [0, 1.0, 1.0], [0, 0, 0], [0, 0, 0]],
        shifts=[0.0, 0.25, math.pi / 2, 0.0, 0.75],
    )
    q = np.random.default_rng(4).uniform(-2, 2, (6, 3))
    links = [3, 0, 5, 4]
    found = evaluate(tree_program(tree, links), q).reshape(6, 4, 12)
    for row, poses in zip(q.tolist(), found, strict=True):
        wanted = [IDENTITY]
        for j, parent in enumerate(tree.parents):
            x = (
                sum(factor * x for factor, x in zip(tree.factors[j], row, strict=True))
                + tree.shifts[j]
            )
            origin, screw = tree.origins[j], tree.screws[j]
            moved = forward.child(wanted[parent], origin, screw, x, math.sin(x), math.cos(x))
            wanted.append(moved)
        # three products of poses, entries up to 5, angles up to 6 rad: 2^-53 (3 x 8 x 5 + 4 x 6)
        np.testing.assert_allclose(
            poses, [wanted[link] for link in links], rtol=0, atol=150 * 2.0**-53
        )


def test_what_is_fixed_or_about_an_axis_of_the_frame_costs_nothing_of_its_own():
    def count(*screws):
        joints = range(len(screws))
        factors = np.eye(len(screws)).tolist()
        zeros = [0.0] * len(screws)
        tree = TracedTree(joints, [UP] * len(screws), screws, factors, zeros)
        made = tree_program(tree, [len(screws)]).count
        return made.multiplications, made.additions, made.sines

    assert count(STILL, STILL) == (0, 0, 0)
    assert count(TURN) == (0, 0, 1)
    assert count(SLIDE, STILL) == (0, 0, 0)
    assert count(TURN, SLIDE) == (2, 0, 1)
    assert count(TURN, TURN) == (4, 2, 2)  # no angle is the sum of two in a tree
