"""First-order errors of six arms against arms that are drawn, and what the second order adds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import PoseUncertainty, monte_carlo
from tests.findings import (
    dataclasses_of,
    defaults_are_those_of_the_docstring,
    frozen_and_equal_only_where_its_parts_can_be,
)
from tests.sweep.arms import slide, two_links
from tests.sweep.measures.first_order import effects

ARMS = {
    "ur5e": "tool0",
    "panda": "panda_hand",
    "iiwa14": None,
    "kr5": None,
    "puma560": None,
    "stanford": None,
}
TOLERANCES: dict[str, Any] = {
    "tilt": 1e-3,
    "shift": 2e-4,
    "offset": 5e-4,
    "home_rotation": 1e-3,
    "home_position": 2e-4,
}
PARTS = ("position", "orientation")


@pytest.mark.parametrize("draws", [50_000, pytest.param(1_000_000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ARMS)
def test_the_first_order_is_within_two_percent_of_arms_that_are_drawn(name, draws):
    chain = pk.load(name).chain(tip=ARMS[name])
    q = chain.random(4, 2)
    error = PoseUncertainty.by_tolerances(chain, **TOLERANCES)
    drawn = monte_carlo(chain, q, error, draws=draws)
    for part, found in zip(PARTS, (drawn.position, drawn.orientation), strict=True):
        first = np.sqrt(np.square(effects(chain, q, error, part)).sum(axis=1))
        assert np.abs(found / first - 1).max() <= 0.02
    # the mean is off by the second order, the squares of some ten errors times some metres
    assert (np.linalg.norm(drawn.position_bias, axis=1) <= 100 * 1e-3**2).all()


def test_the_bias_of_a_turn_about_one_axis_is_that_of_a_cosine():
    # a turn by δ moves the tip at (r, 0) to r (cos δ, sin δ), whose mean is r (exp(-σ²/2), 0)
    chain = two_links()
    error = PoseUncertainty.by_tolerances(chain, offset=[0.2, 0.0])
    drawn = monte_carlo(chain, [0.0, 0.0], error, draws=100_000, seed=3)
    r = 0.8
    expected = r * (np.exp(-(0.2**2) / 2) - 1)
    # standard deviation of cos δ, σ² / √2; six of them over the root of the pairs
    assert abs(drawn.position_bias[0] - expected) < 6 * r * 0.2**2 / np.sqrt(2 * 50_000)
    # sin δ is the opposite for the other one of a pair
    assert abs(drawn.position_bias[1]) < 1e-14
    assert drawn.orientation == pytest.approx(0.2, rel=6 / np.sqrt(1e5))


def test_arms_are_drawn_with_the_offsets_of_their_coordinates():
    arm = two_links()
    error = PoseUncertainty.by_tolerances(arm, offset=1e-3)
    plain = monte_carlo(arm, [0.4, 0.5], error, draws=200)
    shifted = monte_carlo(arm.replace(offset=[0.3, -0.4]), [0.1, 0.9], error, draws=200)
    assert shifted.position == pytest.approx(plain.position, rel=1e-9)
    assert shifted.orientation == pytest.approx(plain.orientation, rel=1e-9)


def test_the_bias_of_the_orientation_is_in_base_axes():
    """An axis tilted by δ a about x at half a turn, and the home pose then by δ b about -y: a turn of
    e^{2 δ a x} e^{-δ b y} in base axes, whose logarithm is -δ² a b z in the mean.
    """
    arm = two_links()
    home = pk.se3.exp([0.5 * np.pi, 0, 0, 0.8, 0, 0])
    a, b = 0.02, 0.03
    own = home[:3, :3].T @ [0, b, 0]
    source = ((0.0,) * 6, (a, *(0.0,) * 5), (*own.tolist(), 0.0, 0.0, 0.0))
    drawn = monte_carlo(
        arm.replace(home=home), [0.0, np.pi], PoseUncertainty((source,)), draws=20_000
    )
    # the standard deviation of δ² is √2; six of them over the root of the pairs
    assert drawn.orientation_bias[2] == pytest.approx(-a * b, rel=6 * np.sqrt(2 / 10_000))
    np.testing.assert_allclose(drawn.orientation_bias[:2], 0.0, atol=1e-3 * a * b)


def test_one_configuration_a_batch_and_a_dict_are_alike():
    chain = slide()
    error = PoseUncertainty.by_tolerances(chain, tilt=1e-3)
    q = np.array([[0.1, 0.3], [0.2, -0.4]])
    batch = monte_carlo(chain, q, error, draws=30_000, seed=1)
    assert batch.position.shape == (2,)
    assert batch.orientation_bias.shape == (2, 3)
    one = monte_carlo(
        chain, dict(zip(chain.q_names, q[1], strict=True)), error, draws=30_000, seed=1
    )
    assert one.position == batch.position[1]
    assert one.draws == 30_000
    assert monte_carlo(chain, q[1], error, draws=3).draws == 4
    biases = [
        np.linalg.norm(b, axis=1).max() for b in (batch.position_bias, batch.orientation_bias)
    ]
    assert batch.summary() == (
        f"30000 arms, standard deviations: position {1e3 * batch.position.max():.4g} mm,"
        f" bias {1e3 * biases[0]:.2g} mm; orientation {1e3 * batch.orientation.max():.4g} mrad,"
        f" bias {1e3 * biases[1]:.2g} mrad"
    )
    assert monte_carlo(chain, q[:0], error).summary() == "no configuration"
    other = monte_carlo(chain, q[1], error, draws=30_000, seed=2)
    assert other.position != one.position


@pytest.mark.parametrize(
    ("options", "words"),
    [({"draws": 1}, "draws: expected a whole number from 2"), ({"seed": -1}, "seed")],
)
def test_what_cannot_be_drawn_is_refused(options, words):
    error = PoseUncertainty.by_tolerances(slide(), tilt=1e-3)
    with pytest.raises(InputError, match=words):
        monte_carlo(slide(), [0.1, 0.3], error, **options)
    with pytest.raises(InputError, match="it is of an arm of 2 joints"):
        monte_carlo(pk.load("ur5e").chain(), np.zeros(6), error)


@pytest.mark.parametrize(
    "kind", dataclasses_of("poekin.sweep.measures", "monte_carlo pose_uncertainty")
)
def test_an_error_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)


def test_arms_are_drawn_in_pairs_10000_at_a_time_and_10000_where_nobody_says_how_many(monkeypatch):
    asked = []

    def errors(chain, q, moves):
        asked.append(len(moves))
        return np.tile([1.0, 2.0, 2.0, 3.0, 4.0, 0.0], (len(moves), 1))

    chain = slide()
    error = PoseUncertainty.by_tolerances(chain, tilt=1e-3)
    assert defaults_are_those_of_the_docstring(monte_carlo)
    assert monte_carlo(chain, np.empty((0, 2)), error).draws == 10_000
    monkeypatch.setattr("poekin.sweep.measures.monte_carlo._errors", errors)
    found = monte_carlo(chain, [0.1, 0.3], error, draws=20_003)
    assert asked == [20_000, 4]
    assert found.draws == 20_004
    # what is always the same is a bias and has no deviation
    assert found.orientation_bias.tolist() == [1.0, 2.0, 2.0]
    assert found.position_bias.tolist() == [3.0, 4.0, 0.0]
    assert (found.position, found.orientation) == (0.0, 0.0)
    assert found.summary() == (
        "20004 arms, standard deviations: position 0 mm, bias 5e+03 mm; orientation 0 mrad, bias 3e+03 mrad"
    )
