"""What strategies refuse, at the call: the argument is named, with what was expected and what
arrived.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.model.chain import Chain
from poekin.testing.strategies import (
    arguments,
    batch_strategies,
    chain_strategies,
    configuration_strategies,
    dh_strategies,
    group_strategies,
    near_strategies,
    robot_strategies,
    urdf_strategies,
)

# Whatever the types say.
S: Any = group_strategies
B: Any = batch_strategies
C: Any = chain_strategies
ARM = Chain.from_space([[0, 0, 1, 0, 0, 0]], np.eye(4))

REFUSED: dict[str, tuple[Callable[[], object], str]] = {
    "an angle of NaN": (
        lambda: S.angles(math.nan),
        "(|ω| in rad): expected finite numbers (smallest, largest), 0 < smallest <= largest, got",
    ),
    "a negative angle": (lambda: S.twists(-1.0), "got (1e-150, -1.0)"),
    "a text": (lambda: S.rotation_vectors("pi"), "got (1e-150, 'pi')"),
    "bounds the wrong way round": (
        lambda: S.magnitudes(1e3, 1e-3),
        "0 < smallest <= largest, got (1000.0,",
    ),
    "no logarithm of 0": (lambda: S.poses((0.0, 1.0)), "lengths: expected finite numbers"),
    "one length": (lambda: S.vectors(1.0), "lengths: expected finite numbers (smallest, largest)"),
    "an infinite length": (lambda: S.twists(lengths=(1.0, math.inf)), "got (1.0, inf)"),
    "noise of NaN": (lambda: S.noisy_rotations((math.nan, 1.0)), "noise: expected"),
    "a truth for a number": (lambda: S.magnitudes(True, 2.0), "got (True, 2.0)"),
    "a shape that is a number": (
        lambda: B.batches(S.twists(), 3),
        "shape: expected a tuple of whole numbers >= 0, such as () or (3, 1, 2), got 3",
    ),
    "a negative axis": (lambda: B.batches(S.twists(), (-1,)), "got (-1,)"),
    "elements that are an array": (
        lambda: B.batches(np.eye(3), (3,)),
        "elements: expected a strategy",
    ),
    "a kind of argument": (lambda: S.group_cases(("twst",), 6), "no 'twst'; did you mean 'twist'"),
    "a size": (lambda: S.group_cases(("twist",), 4), "expected 3 for SO(3) or 6 for SE(3), got 4"),
    "a neighbourhood of NaN": (
        lambda: near_strategies.near_angles(math.nan),
        "at (rad): expected a number from 0 to 1000, got",
    ),
    "a neighbourhood below 0": (
        lambda: near_strategies.near_twists(-0.1),
        "at (rad): expected a number from 0 to",
    ),
    "too wide a neighbourhood": (
        lambda: near_strategies.near_poses(1.0, widest=1000.5),
        "to 1000, got 1000.5",
    ),
    "a neighbourhood too far off": (
        lambda: near_strategies.near_rotations(1000.5),
        "from 0 to 1000, got 1000.5",
    ),
    "no width": (
        lambda: near_strategies.near_rotations(1.0, widest=0.0),
        "widest (rad): expected a number from 2",
    ),
    "a kind of joint": (lambda: C.screws(("revolut",)), "no 'revolut'; did you mean 'revolute'?"),
    "no kind of joint": (
        lambda: C.screws(()),
        "expected some of revolute, prismatic, helical, got ()",
    ),
    "a number for kinds of joints": (
        lambda: C.screws(5),  # type: ignore[arg-type]
        "expected some of revolute, prismatic, helical, got 5",
    ),
    "a negative number": (
        lambda: C.chains(-1, 3),
        "0 <= min_joints <= max_joints, got min_joints = -1",
    ),
    "more at least than at most": (lambda: C.chains(5, 3), "got min_joints = 5, max_joints = 3"),
    "half a joint": (lambda: C.chains(1.5, 3), "expected whole numbers with 0 <= min_joints"),
    "no chain": (
        lambda: C.coordinates("arm"),
        "expected a chain or a robot, with `dof` and `limits`, got 'arm'",
    ),
    "a shape below 0": (lambda: C.coordinates(ARM, (-1,)), "shape: expected a tuple"),
    "no limits": (lambda: configuration_strategies.at_limits(None), "`dof` and `limits`, got None"),
    "one joint for two": (
        lambda: configuration_strategies.singular_cases(1, 1),
        "2 <= min_joints <= max_joints",
    ),
    "a convention": (
        lambda: dh_strategies.tables(conventions=("craig",)),  # type: ignore[arg-type]
        "no 'craig'; available: 'standard'",
    ),
    "rows": (lambda: dh_strategies.tables(3, 1), "got min_joints = 3, max_joints = 1"),
    "a kind of robot": (
        lambda: robot_strategies.robots(("hinge",)),
        "kinds: there is no 'hinge'; available:",
    ),
    "joints of a robot": (
        lambda: robot_strategies.robots(max_joints=-1),
        "got min_joints = 0, max_joints = -1",
    ),
}


@pytest.mark.parametrize(("call", "message"), REFUSED.values(), ids=REFUSED)
def test_what_is_no_argument_is_refused_at_the_call(call, message):
    with pytest.raises(InputError, match=re.escape(message)):
        call()


def test_an_infinite_bound_is_refused_whoever_made_it():
    for infinite in (float("inf"), np.float64("inf"), np.inf):
        with pytest.raises(InputError, match="finite numbers"):
            arguments.magnitudes("lengths", (1.0, infinite))


@pytest.mark.parametrize(
    ("strategy", "fewest", "most"),
    [
        (chain_strategies.chains, 0, 12),
        (configuration_strategies.singular_cases, 2, 7),
        (dh_strategies.tables, 1, 10),
        (robot_strategies.robots, 0, 7),
        (urdf_strategies.odd_urdfs, None, 4),
    ],
)
def test_so_many_joints_are_drawn_unless_others_are_asked_for(strategy, fewest, most):
    parameters = inspect.signature(strategy).parameters
    assert parameters["max_joints"].default == most
    assert fewest is None or parameters["min_joints"].default == fewest


def test_numpy_numbers_lists_and_single_words_are_taken():
    assert arguments.magnitudes("lengths", [np.float32(1), np.int64(2)]) == (1.0, 2.0)
    assert arguments.shape([np.int64(3), 1]) == (3, 1)
    assert arguments.counts(np.int64(1), 2) == (1, 2)
    assert arguments.some("kinds", "revolute", ("revolute", "fixed")) == ("revolute",)
    assert arguments.number("at", np.float64(1.0), 0.0, 2.0) == 1.0
    assert C.screws(["revolute"]) is C.screws("revolute")
