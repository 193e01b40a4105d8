"""What measures of Jacobians are by themselves: their length, their numbers, whom they refuse."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import InverseCondition, PoseUncertainty, SmallestSingularValue
from poekin.sweep.measures.dexterity import PoseManipulability
from poekin.sweep.measures.measure import Measure, Reach
from poekin.sweep.measures.names import measure_of
from tests.findings import defaults_are_those_of_the_docstring
from tests.messages import says
from tests.sweep.arms import two_links

PANDA = pk.load("panda").chain(tip="panda_hand")


@pytest.mark.parametrize("kind", [InverseCondition, SmallestSingularValue])
def test_lengths_divide_by_a_metre_where_nobody_says_by_what(kind):
    assert defaults_are_those_of_the_docstring(kind)
    assert kind().numbers(PANDA).tolist() == [1.0]
    assert kind(0.25).numbers(PANDA).tolist() == [4.0]
    assert kind(0.25).describe() == {"length": 0.25}
    assert kind().sign == 1


@pytest.mark.parametrize(
    ("measure", "chain", "numbers"),
    [
        # which, its sign, outputs behind the pose, rows and columns of the matrix
        (PoseManipulability(), PANDA, [1, 1, 1, 6, 7]),
        (InverseCondition(), PANDA, [3, 1, 42, 6, 7]),
        (SmallestSingularValue(), two_links(), [2, 1, 12, 2, 6]),
        (measure_of("limit_margin"), two_links(), [5, 1, 0, 2, 6]),
        (measure_of("travel"), PANDA, [4, 1, 0, 6, 7]),
        (measure_of("solutions"), PANDA, [6, 1, 0, 6, 7]),
    ],
)
def test_a_measure_tells_the_kernel_its_kind_its_sign_and_the_size_of_its_matrix(
    measure, chain, numbers
):
    assert measure.whole_numbers(chain, 1).tolist() == numbers
    assert measure.whole_numbers(chain, -1)[1] == -1


def test_better_is_larger_unless_it_is_an_error_or_a_travel():
    error = PoseUncertainty.by_tolerances(PANDA, tilt=1.0)
    assert (Measure.sign, Reach.sign, measure_of("travel").sign, error.sign) == (1, 1, -1, -1)
    assert (Measure.of_poses, measure_of("solutions").of_poses) == (False, True)
    assert error.outputs(PANDA) == 1
    assert PoseUncertainty.by_tolerances(PANDA, tilt=1.0, bound=True).outputs(PANDA) == 14
    assert [error.describe()["sources"], len(str(error.describe()["sha256"]))] == [14, 64]
    assert defaults_are_those_of_the_docstring(PoseUncertainty.by_tolerances)
    with pytest.raises(InputError) as caught:
        error.check(two_links())
    assert says(caught.value, f"error: it is of an arm of 7 joints, {two_links()!r} is another")


def test_an_arm_that_is_singular_everywhere_is_refused_with_the_ways_it_should_have():
    eight = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in range(8)]
    three = [pk.screw.prismatic([1, 0, 0])] * 3
    for screws, most in ((eight, 6), (three, 3)):
        chain = pk.Chain(np.array(screws), np.eye(4), frame="space", limits=[[-1, 1]] * len(screws))
        with pytest.raises(InputError) as caught:
            PoseManipulability().check(chain)
        assert says(
            caught.value,
            f"sweep: measure 'manipulability': the tool of {chain!r} moves in fewer than {most} ways "
            "at a time, so that it is 0 everywhere",
        )
    InverseCondition().check(PANDA)
