"""What an exact geometry costs, by sums made by hand, and when a chain is as exact as floats can
say.
"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.groups import so3
from poekin.groups.arrays import ROUNDOFF
from poekin.model import screw
from poekin.model.chain import Chain
from poekin.model.geometry.axis_walk import Walk
from poekin.model.geometry.idealise import Idealised, _bounds, _nearest, _settled, _way
from poekin.model.geometry.normals import digits, exact, frame_on_line

OFF, TOL = 1e-6, 1e-5
Z = [0, 0, 1]
TILTED = [0, math.sin(OFF), math.cos(OFF)]


def bounds(*screws, home=(0, 0, 0), **options):
    T = np.eye(4)
    T[:3, 3] = home
    result = Chain.from_space(screws, T, **options).idealised(TOL)
    return result.position_bound / OFF, result.rotation_bound / OFF


@pytest.mark.parametrize("limits, C, c, most", [
    ([-1, 3], 1.0, 0.0, 3.0), ([-3, 1], 1.0, 0.0, 3.0), ([-1, 3], 2.0, -0.5, 5.5), ([-1, 3], -2.0, -0.5, 6.5),
    ([-np.inf, np.inf], 1.0, 0.25, 1.25), ([2, np.inf], 1.0, 0.0, 4.0),
])  # fmt: skip
def test_a_slide_that_is_turned_moves_the_tip_by_as_far_as_it_goes(limits, C, c, most):
    position, rotation = bounds(
        screw.prismatic(TILTED), limits=[limits], coupling=[[C]], offset=[c], q_names=["q"]
    )
    assert position == pytest.approx(most, rel=1e-6)
    # Turned back behind the slide, the tool points as before.
    assert rotation == pytest.approx(2, rel=1e-6)


def test_a_joint_that_follows_two_coordinates_slides_by_both():
    position, _ = bounds(
        screw.prismatic(TILTED),
        limits=[[-1, 2], [1, 3]],
        coupling=[[2.0, -1.0]],
        q_names=["a", "b"],
    )
    assert position == pytest.approx(5, rel=1e-6)  # from -2 - 3 to 4 - 1


def test_a_helical_joint_slides_by_its_pitch():
    position, _ = bounds(screw.helical(TILTED, [0, 0, 0], -0.5), limits=[[-8, 2]])
    assert position == pytest.approx(4, rel=1e-6)


def test_what_is_behind_a_turn_counts_with_all_its_lengths_and_slides():
    rows = [
        screw.revolute(TILTED, [0, 0, 0]),
        screw.prismatic([1, 0, 0]),
        screw.revolute(Z, [0, 2, 0]),
    ]
    position, _ = bounds(*rows, home=[0, 5, 0], limits=[[-9, 9], [-3, 1], [-9, 9]])
    # Behind the first turn are 3 m of slide and links of 2 and 3 m; it is turned back about the
    # slide's axis.
    assert position == pytest.approx((3 + 2 + 3) + (2 + 3), rel=1e-6)


def test_without_a_change_the_bound_is_the_rounding_of_the_lines():
    chain = Chain.from_space([screw.revolute(Z, [0, 2, 0])], np.eye(4))
    frames = [frame(Z, o) for o in ((0, 0, 0), (0, 3, 0), (0, 8, 0))]
    with digits():
        position, rotation = _bounds(chain, frames, frames)
    assert rotation == 3 * 8 * ROUNDOFF
    assert position == (3 + 5) * rotation  # the links' lengths, which are more than the reach


def frame(z, o):
    return frame_on_line(exact((1, 0, 0)), exact(z), exact(o))


def test_frames_slide_along_their_lines_to_be_nearest_to_the_one_before():
    rows = [screw.revolute(Z, [1, 0, 0]), screw.prismatic(Z), screw.revolute([0, 1, 0], [3, 0, 5])]
    chain = Chain.from_space(rows, np.eye(4))
    frames = [frame(Z, (0, 0, 2)), frame(Z, (1, 0, 7)), frame(Z, (5, 5, 5)), frame((0, 1, 0), (3, 4, 5)),
              frame(Z, (9, 9, 9))]  # fmt: skip
    with digits():
        slid = _nearest(chain, frames)
    assert [tuple(map(float, f.o)) for f in slid] == [
        (0, 0, 2),
        (1, 0, 2),
        (1, 0, 2),
        (3, 0, 5),
        (9, 9, 9),
    ]
    assert [f.z for f in slid] == [f.z for f in frames]


@pytest.mark.parametrize("metres", [20.0, 0.1])
def test_a_chain_is_settled_where_last_digits_differ_alone(metres):
    rows = [
        screw.revolute([0.6, 0, 0.8], [0.03, 0, 0]),
        screw.revolute([0, 0.6, 0.8], [0.05, 0, 0]),
    ]
    T = np.eye(4)
    T[:3, :3] = so3.exp([0.3, 0.4, 0.5])
    T[:3, 3] = 0.03, 0.07, metres
    chain = Chain.from_space(rows, T)
    assert max(1.0, metres) <= chain.reach < max(1.0, metres) + 0.2
    size = 16 * ROUNDOFF * chain.reach

    def settled(change, where):
        screws, home = chain.screws.copy(), chain.home.copy()
        (screws if where[0] == "S" else home)[where[1:]] += change
        return _settled(chain, screws, home)

    for where in (("S", 0, 0), ("S", 1, 4), ("T", 0, 3), ("T", 2, 3)):
        assert [settled(share * size, where) for share in (0.0, 0.9, -0.9, 1.5, -1.5)] == [
            True
        ] * 3 + [False] * 2


@pytest.mark.parametrize("number", [0.0, 1.0, -1.0])
def test_a_chain_is_not_settled_where_a_zero_is_missed_by_its_last_digit_and_no_place_is_a_one(
    number,
):
    S = screw.revolute([0.6, 0, 0.8], [0, 0, 0])
    T = np.eye(4)
    for off in (2**-52, -(2**-52)):
        T[0, 3] = number + off
        other = T.copy()
        other[0, 3] = number
        chain = Chain.from_space([S], T)
        assert _settled(chain, chain.screws, T)
        assert _settled(chain, chain.screws, other) == (number != 0.0)
    S = screw.prismatic([0.6, 0, 0.8])
    assert Chain.from_space([S], np.eye(4)).idealised(TOL).chain.screws[0].tolist() == S.tolist()


def test_a_chain_is_not_settled_where_a_direction_s_one_is_missed_by_its_last_digit():
    one = 1 - 2**-53
    chain = Chain.from_space([screw.revolute([0, 0, 1], [0, -1, 0])], np.eye(4))
    slide = Chain.from_space([screw.prismatic([0, -1, 0])], np.eye(4))
    for arm, k, settled in ((chain, 2, False), (chain, 3, True), (slide, 4, False)):
        screws = arm.screws.copy()
        screws[0, k] *= one
        given: Any = SimpleNamespace(screws=screws, home=arm.home, reach=1.0)
        assert _settled(given, arm.screws, arm.home) == settled
    home = np.eye(4)
    home[1, 1] = one
    given = SimpleNamespace(screws=chain.screws, home=home, reach=1.0)
    assert not _settled(given, chain.screws, np.eye(4))


def test_a_chain_is_not_settled_where_axes_are_not_parallel_to_the_last_bit():
    old = [screw.revolute([0.6, 0, 0.8], [0, 0, 0]), screw.revolute([-0.6, 0, -0.8], [1, 0, 0])]
    chain = Chain.from_space(old, np.eye(4))
    assert _settled(chain, chain.screws, chain.home)
    for bit in (2**-52, -(2**-52)):
        apart = Chain.from_space([old[0], old[1] + [0, 0, bit, 0, 0, 0]], np.eye(4))
        assert not _settled(apart, chain.screws, chain.home)
        assert _settled(
            chain, apart.screws, chain.home
        )  # it is the new ones that are to be parallel


@pytest.mark.parametrize("way", [(0, 0, 1), (0, -1, 0), (0.6, 0, -0.8), (-0.6, 0.8, 0)], ids=str)
def test_a_way_is_the_same_the_other_way_round_and_of_a_slide(way):
    S = np.array([*way, 0.5, -0.2, 0.1])
    slide = np.array([0, 0, 0, *way])
    assert _way(S) == _way(-S) == _way(slide) == _way(-slide)


def test_a_chain_in_which_nothing_is_put_right_stays_the_very_same():
    # Its direction is a digit short of 1, which is more than the exact walk leaves: that is no
    # reason to change it.
    S = np.array([1e-9, 0, 1 - 2**-53, 0, 0, 0])
    chain = Chain.from_space([S], np.eye(4))
    assert chain.idealised(1e-12).chain is chain
    with digits():
        assert not Walk(chain, 1e-12).snapped
        assert Walk(chain, 1e-8).snapped


@pytest.mark.parametrize(
    "tol",
    [0, 0.05, np.float64(0.05), np.float32(0.01), np.int64(0)],
    ids=lambda x: f"{type(x).__name__} {x}",
)
def test_a_tolerance_up_to_the_largest_is_taken(tol):
    assert Chain.from_space([screw.revolute(Z, [0, 0, 0])], np.eye(4)).idealised(tol).changes == ()


def test_a_result_says_its_bounds_in_mm_and_degrees_and_keeps_si_in_numbers():
    leaning = screw.revolute([0, 1e-3, 1], [0, 0, 0])
    result = Chain.from_space([leaning], np.eye(4)).idealised(0.01)
    bounds, *changes = result.summary().splitlines()
    assert bounds == (
        f"within {1e3 * result.position_bound:.3g} mm and {np.degrees(result.rotation_bound):.3g}°"
    )
    assert tuple(changes) == result.changes != ()
    assert str(result) == result.summary()
    assert result.to_dict() == {
        "position_bound": result.position_bound,
        "rotation_bound": result.rotation_bound,
        "changes": list(result.changes),
    }
    assert Idealised(result.chain, 1e-6, np.pi / 180, ()).summary().endswith("0.001 mm and 1°")
    exact = Chain.from_space([screw.revolute(Z, [0, 0, 0])], np.eye(4)).idealised(0.01)
    assert exact.summary() == "nothing was changed but rounding: within 0 mm and 0°"


def test_what_is_made_exact_keeps_its_masses():
    masses = [[2.0, 0.1, 0.0, 0.3]]
    chain = Chain.from_space([screw.revolute(TILTED, [0, 0, 0])], np.eye(4), masses=masses)
    exact_chain = chain.idealised(TOL).chain
    assert exact_chain.screws[0].tolist() == [0, 0, 1, 0, 0, 0]
    assert exact_chain.masses is not None
    assert exact_chain.masses.tolist() == masses
