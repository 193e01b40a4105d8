"""How many configurations are tried, where boxes of poses come from, and what is left out."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.errors import InputError, ShapeError
from poekin.model.chain import Chain
from poekin.sweep import Cells, Grid, PoseGrid, PoseSamples, Random, Sobol
from poekin.sweep.pose_samples import reached_box, read_samples, samples_of
from poekin.sweep.samples import samples_from
from tests.findings import defaults_are_those_of_the_docstring
from tests.messages import says
from tests.sweep.arms import slide, two_links

ARM = two_links()


def test_limits_of_joints_are_tried_at_4096_configurations(monkeypatch):
    asked = []

    def beyond(chain, q):
        asked.append(q)
        return np.zeros((len(q), 2), bool)

    monkeypatch.setattr("poekin.sweep.samples.beyond_own_limits", beyond)
    Random.of(slide(), 5)
    (q,) = asked
    assert q.shape == (4096, 2)
    lower, upper = slide().limits.T
    assert ((q >= lower) & (q <= upper)).all()
    # of each coordinate the gap to an end is 1 / 4096 of the range in the mean
    assert (np.minimum(q.min(axis=0) - lower, upper - q.max(axis=0)) < (upper - lower) / 100).all()


@pytest.mark.parametrize(
    "function",
    [Random.of, Sobol.of, PoseSamples.random, PoseSamples.sobol, PoseSamples.of, PoseGrid.of],
    ids=lambda made: made.__qualname__,
)
def test_seeds_and_turns_left_out_are_those_of_the_docstring(function):
    assert defaults_are_those_of_the_docstring(function)


def test_samples_made_by_hand_have_the_seed_0_and_the_same_numbers_as_those_of_an_arm():
    lower, upper = ARM.limits.T
    for made, of_arm in (
        (Random(lower, upper, 9), Random.of(ARM, 9)),
        (Sobol(lower, upper, 9), Sobol.of(ARM, 9)),
        (Grid(lower, upper, 6, (2, 3)), Grid.of(ARM, [2, 3])),
    ):
        assert made.describe() == of_arm.describe()
        assert made.numbers().tolist() == of_arm.numbers().tolist()
        again = samples_from(made.describe())
        assert (type(again), again.count) == (type(made), made.count)
        assert again.configurations([5]).tolist() == made.configurations([5]).tolist()
    assert Grid.of(ARM, [2, 3]).numbers().tolist() == [0, 0, 2, 3]
    assert Random.of(ARM, 9, 7).numbers().tolist() == [1, 7]
    assert Sobol.of(ARM, 9, None).numbers()[:3].tolist() == [2, 0, 0]


def test_no_numbers_have_no_configurations_and_the_first_and_the_last_have_one():
    samples = Random.of(ARM, 10)
    assert samples.configurations(np.empty(0, int)).shape == (0, 2)
    assert samples.configurations([0, 9]).shape == (2, 2)
    with pytest.raises(InputError) as caught:
        samples.configurations([3, 12, -2])
    assert says(caught.value, "numbers: expected 0 ... 9, got -2 ... 12")
    with pytest.raises(ShapeError, match=r"numbers \(N,\), got rows of different lengths$"):
        samples.configurations([[1, 2], [3]])  # pyright: ignore[reportArgumentType] - refused


def test_a_box_is_that_of_the_first_100_000_places_rounded_to_a_nanometre():
    many = Random.of(ARM, 10**6, 2)
    lower, upper = reached_box(ARM, many)
    p = ARM.fk(many.configurations(np.arange(100_000)))[:, :3, 3]
    np.testing.assert_allclose(lower, p.min(axis=0), rtol=0, atol=0.6e-9)
    np.testing.assert_allclose(upper, p.max(axis=0), rtol=0, atol=0.6e-9)
    few = Random.of(ARM, 7, 2)
    ends = np.concatenate(reached_box(ARM, few))
    q = few.configurations(np.arange(7))
    p = ARM.fk(q)[:, :3, 3]
    np.testing.assert_allclose(ends, [*p.min(axis=0), *p.max(axis=0)], rtol=0, atol=0.6e-9)
    # whole numbers of 1e-9, not all of them of 1e-8; a float of 0.8 is within 1e-16
    units = ends * 1e9
    np.testing.assert_allclose(units, units.round(), rtol=0, atol=1e-6)
    assert (np.abs(units / 10 - (units / 10).round()) > 0.05).any()


def test_a_number_of_samples_is_one_of_random_configurations():
    assert samples_of(ARM, 12).describe() == Random.of(ARM, 12).describe()
    poses = PoseSamples.random([0] * 3, [1] * 3, 4)
    assert samples_of(ARM, poses) is poses
    grid = Grid.of(ARM, 3)
    assert samples_of(ARM, grid) is grid
    with pytest.raises(ValueError, match="samples"):
        read_samples({"poses": grid.describe()})


def test_there_are_fewer_than_2_to_the_56_samples():
    cells = Cells((0.0, 0.0, 0.0), 1.0, (4, 2, 1), 0)
    assert PoseGrid.of(cells, 2**53 - 1).count == 2**56 - 8
    assert PoseSamples.random([0] * 3, [1] * 3, 2**56 - 1).count == 2**56 - 1
    assert PoseSamples.sobol([0] * 3, [1] * 3, 2**56 - 1, 2**62 - 1).drawn.seed == 2**62 - 1
    assert Sobol.of(ARM, 2**56 - 1, 2**62 - 1).seed == 2**62 - 1
    for make in (
        lambda: PoseGrid.of(cells, 2**53),
        lambda: PoseSamples.random([0] * 3, [1] * 3, 2**56),
        lambda: Sobol.of(ARM, 2**56),
        lambda: PoseSamples.random([0] * 3, [1] * 3, 1, 2**62),
        lambda: Sobol.of(ARM, 1, 2**62),
        lambda: Random.of(ARM, 1, 2**62),
    ):
        with pytest.raises(InputError, match="expected a whole number from"):
            make()


def test_a_pose_of_a_grid_is_the_middle_of_its_cube_and_the_last_cube_changes_first():
    cells = Cells((1.0, -2.0, 0.5), 0.5, (2, 3, 4), 0)
    T = PoseGrid.of(cells, 2).poses([2 * (1 * 12 + 2 * 4 + 3), 1])
    assert T[0].tolist() == [[1, 0, 0, 1.75], [0, 1, 0, -0.75], [0, 0, 1, 2.25], [0, 0, 0, 1]]
    assert T[1, :3, 3].tolist() == [1.25, -1.75, 0.75]
    np.testing.assert_allclose(np.diag(T[1]), [-1, -1, 1, 1], atol=1e-15)


def test_an_arm_has_up_to_32_coordinates_for_sobol_s_sequence():
    def of(count):
        screws = [[0.0, 0, 1, 0, -x, 0] for x in range(count)]
        return Chain(screws, np.eye(4), frame="space", limits=[[-1, 1]] * count)

    assert Sobol.of(of(32), 8).configurations([3]).shape == (1, 32)
    for count in (33, 34):
        with pytest.raises(InputError) as caught:
            Sobol.of(of(count), 8)
        assert says(caught.value, f"sobol: expected at most 32 coordinates, got {count}")
