"""What cells keep of every measure, against single configurations in NumPy."""

from __future__ import annotations

from typing import Any, get_args

import mpmath
import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels.sweep import measures as kinds
from poekin.errors import InputError, ShapeError
from poekin.sweep import (
    Cells,
    InverseCondition,
    JointTravel,
    LimitMargin,
    PoseUncertainty,
    Random,
    SmallestSingularValue,
    Sweep,
    run,
)
from poekin.sweep.measures.dexterity import PoseManipulability
from poekin.sweep.measures.measure import Reach
from poekin.sweep.measures.names import LABELS, MeasureName, measure_of
from poekin.sweep.sweep import Keep
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be
from tests.sweep.arms import slide, two_links
from tests.sweep.measures.first_order import effects

ARMS = {
    "7R": pk.load("panda").chain(tip="panda_hand"),
    "6R": pk.load("ur5e").chain(tip="tool0"),
    "2R": two_links(),
    "PR": slide(),
}
TOLERANCES: dict[str, Any] = {
    "tilt": 1e-3,
    "shift": 2e-4,
    "offset": 1e-4,
    "home_rotation": 1e-3,
    "home_position": 1e-4,
}
CELLS = Cells.box([-2.0] * 3, [2.0] * 3, 0.5)


def error(chain, part: Any = "position", bound=False):
    return PoseUncertainty.by_tolerances(chain, **TOLERANCES, part=part, bound=bound)


def travel(chain):
    speeds = tuple(range(1, chain.dof + 1))
    return JointTravel((0.1,) * chain.dof, speeds)


def dexterity(chain, q, length):
    return pk.manipulability(chain, q, length=length).pose


def margins(chain, q):
    lower, upper = chain.limits.T
    return (2 * np.minimum(q - lower, upper - q) / (upper - lower)).min(axis=1)


def errors(chain, q, part):
    return np.sqrt(np.square(effects(chain, q, error(chain), part)).sum(axis=1))


CASES = {
    "manipulability": (
        lambda c: PoseManipulability(),
        lambda c, q: dexterity(c, q, 1.0).yoshikawa,
    ),
    "inverse_condition": (
        lambda c: InverseCondition(0.4),
        lambda c, q: 1 / dexterity(c, q, 0.4).condition,
    ),
    "smallest": (
        lambda c: SmallestSingularValue(0.4),
        lambda c, q: dexterity(c, q, 0.4).smallest,
    ),
    "limit_margin": (lambda c: LimitMargin(), margins),
    "travel_time": (travel, lambda c, q: (np.abs(q - 0.1) / np.arange(1, c.dof + 1)).max(axis=1)),
    "position": (error, lambda c, q: errors(c, q, "position")),
    "orientation": (
        lambda c: error(c, "orientation"),
        lambda c, q: errors(c, q, "orientation"),
    ),
    "bound": (
        lambda c: error(c, bound=True),
        lambda c, q: effects(c, q, error(c), "position").sum(axis=1),
    ),
    "bound of offsets": (  # two of them, of an arm of two joints
        lambda c: PoseUncertainty.by_tolerances(c, offset=0.01, bound=True),
        lambda c, q: effects(c, q, PoseUncertainty.by_tolerances(c, offset=0.01), "position").sum(
            axis=1
        ),
    ),
}


@pytest.mark.parametrize("arm", ARMS)
@pytest.mark.parametrize("case", CASES)
def test_a_cell_keeps_the_best_the_worst_and_the_mean_of_its_configurations(arm, case):
    chain = ARMS[arm]
    make, judge = CASES[case]
    measure = make(chain)
    samples = Random.of(chain, 2000, seed=8)
    q = samples.configurations(np.arange(2000))
    own = judge(chain, q)
    index = CELLS.find(chain.fk(q))
    # roots of squares within rounding of the product of the rows' squared lengths, below 2^6;
    # all others within some ten roundings of numbers below 10
    tolerance = 1e-6 if case == "manipulability" else 1e-13
    ends = {1: (np.max, np.min), -1: (np.min, np.max)}[measure.sign]
    for keep, reduce in zip(get_args(Keep), (*ends, np.mean), strict=True):
        found = run(Sweep(chain, samples, CELLS, measure, keep), chunk=700, workers=2)
        kept = np.asarray(found.best).reshape(-1)
        for cell in np.unique(index):
            expected = reduce(own[index == cell])
            # a mean is of units of 2^-40
            assert abs(kept[cell] - expected) <= tolerance + (keep == "mean") * 2.0**-40
        assert np.isnan(kept[found.counts.reshape(-1) == 0]).all()
        if keep == "mean":
            assert found.attained is None
            continue
        numbers = np.asarray(found.attained).reshape(-1)[np.unique(index)]
        assert (index[numbers] == np.unique(index)).all()
        assert np.abs(own[numbers] - kept[np.unique(index)]).max() <= tolerance


def test_at_a_singularity_there_is_no_distance_to_it_and_no_exception():
    chain = ARMS["6R"]
    q = np.array([0.3, -1.0, 1.2, -1.0, 0.0, 0.4])  # two axes of the wrist in line
    samples = Random(q, q, 5)
    for measure in (InverseCondition(), SmallestSingularValue(), PoseManipulability()):
        best = np.asarray(run(Sweep(chain, samples, CELLS, measure)).best)
        # the square of a manipulability is within rounding of 0
        assert 0 <= np.nanmax(best) <= 1e-7


@pytest.mark.parametrize("near", [1e-5, 1e-7, 1e-8, 1e-9, 1e-11])
def test_singular_values_that_nearly_meet_are_told_to_rounding(near):
    directions = np.eye(3) + near * np.random.default_rng(1).normal(size=(3, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    arm = pk.Chain.from_space([pk.screw.prismatic(v) for v in directions], np.eye(4))
    J = arm.jacobian([0.0] * 3, frame="hybrid")[3:]
    with mpmath.workdps(40):
        largest, _, smallest = map(float, mpmath.svd_r(mpmath.matrix(J.tolist()), compute_uv=False))
    for measure, expected in (
        (InverseCondition(), smallest / largest),
        (SmallestSingularValue(), smallest),
    ):
        found = run(Sweep(arm, Random(np.zeros(3), np.zeros(3), 5), CELLS, measure)).best
        # 64 u of either value
        assert np.nanmax(np.asarray(found)) == pytest.approx(expected, abs=2 * 64 * 2.0**-53)


def test_the_kinds_are_those_of_the_kernel():
    assert Reach.kind == kinds.NONE
    assert PoseManipulability.kind == PoseUncertainty.kind == kinds.ROOT
    assert SmallestSingularValue.kind == kinds.SMALLEST
    assert InverseCondition.kind == kinds.INVERSE_CONDITION
    assert JointTravel.kind == kinds.TRAVEL
    assert LimitMargin.kind == kinds.MARGIN


def test_every_name_has_a_measure_and_words():
    for name in get_args(MeasureName)[1:]:
        assert measure_of(name).name == name
    chain = ARMS["7R"]
    made = [make(chain) for make, _ in CASES.values()]
    made += [measure_of(name) for name in get_args(MeasureName)[1:]]
    made += [error(chain, "orientation", True)]
    assert {measure.name for measure in made} == LABELS.keys()
    assert all(LABELS[measure.name].sign == measure.sign for measure in made)


def test_travel_begins_at_zero_or_at_the_limit_nearest_to_it():
    chain = ARMS["7R"]
    numbers = JointTravel().numbers(chain)
    np.testing.assert_array_equal(numbers[:7], np.clip(0.0, *chain.limits.T))
    assert (numbers[7:] == 1).all()


def test_a_coordinate_without_limits_has_no_margin():
    free = pk.Chain(
        two_links().screws, np.eye(4), frame="space", limits=[[-1, 1], [-np.inf, np.inf]]
    )
    samples = Random.of(free, 500)
    q = samples.configurations(np.arange(500))
    one = Cells.box([-9] * 3, [9] * 3, 18)
    found = run(Sweep(free, samples, one, "limit_margin", "worst"))
    assert np.nanmin(np.asarray(found.best)) == pytest.approx(1 - np.abs(q[:, 0]).max(), abs=1e-15)
    bare = pk.Chain(two_links().screws, np.eye(4), frame="space")
    with pytest.raises(
        InputError, match=r"^sweep: measure 'limit_margin': no coordinate of <Chain .*> has limits$"
    ):
        Sweep(bare, Random.of(bare, 5), CELLS, "limit_margin")


def parallel_axes():
    screws = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in range(4)]
    return pk.Chain(np.array(screws), np.eye(4), frame="space", limits=[[-1, 1]] * 4)


@pytest.mark.parametrize(
    ("make", "kind", "words"),
    [
        (lambda: InverseCondition(0.0), InputError, "length: expected a positive number"),
        (
            lambda: Sweep(
                parallel_axes(), Random.of(parallel_axes(), 5), CELLS, InverseCondition()
            ),
            InputError,
            "'inverse_condition': the tool of .* moves in fewer than 4 ways",
        ),
        (
            lambda: Sweep(two_links(), Random.of(two_links(), 5), CELLS, JointTravel((0.0,))),
            ShapeError,
            r"reference: expected 2 numbers, got \(1,\)",
        ),
        (
            lambda: Sweep(two_links(), Random.of(two_links(), 5), CELLS, JointTravel(None, (1, 0))),
            InputError,
            "speeds above 0",
        ),
        (
            lambda: Sweep(two_links(), Random.of(two_links(), 5), CELLS, error(slide_of_three())),
            InputError,
            "of an arm of 3 joints",
        ),
        (
            lambda: Sweep(two_links(), Random.of(two_links(), 5), CELLS, "speed"),  # type: ignore[arg-type]
            InputError,
            "measure: expected 'reach'.*; or one of poekin.sweep, such as PoseUncertainty",
        ),
        (
            lambda: Sweep(two_links(), Random.of(two_links(), 5), CELLS, "travel", "all"),  # type: ignore[arg-type]
            InputError,
            "keep: expected 'best', 'worst' or 'mean', got 'all'",
        ),
    ],
)
def test_what_cannot_be_measured_is_refused(make, kind, words):
    with pytest.raises(kind, match=words):
        make()


def slide_of_three():
    screws = [pk.screw.prismatic(axis) for axis in np.eye(3)]
    return pk.Chain(np.array(screws), np.eye(4), frame="space")


@pytest.mark.parametrize(
    "kind", dataclasses_of("poekin.sweep.measures", "joints dexterity measure")
)
def test_a_measure_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)
