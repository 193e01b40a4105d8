"""Neighbourhoods: how close to an angle they come, how often, on which side, and what they shrink
to.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import find, settings

from poekin.testing.strategies import near_strategies
from poekin.testing.strategies.decoding import decoders
from poekin.testing.strategies.decoding.bytes_reader import BytesReader
from tests.testing.drawing import QUICK, drawn

PI = math.pi
QUICK = settings(QUICK, max_examples=50)


@pytest.fixture(scope="module")
def gaps() -> np.ndarray:
    """How far below π angles lie."""
    return PI - np.array(drawn(near_strategies.near_angles()))


def test_one_angle_in_four_is_pi_or_one_of_the_8_floats_below_it(gaps):
    gaps = gaps / math.ulp(PI)
    assert set(range(9)) <= set(gaps[gaps <= 8])
    # 600 draws scatter by 0.02.
    assert 0.2 < np.mean(gaps <= 8) < 0.4


def test_the_bytes_of_a_float_nearby_reach_from_the_centre_to_the_eighth():
    floats = [
        near_strategies._angle(BytesReader(bytes([0, 255, byte])), PI, 1e-3, True)
        for byte in range(256)
    ]
    assert sorted(set(floats)) == [PI + k * math.ulp(PI) for k in range(9)]


def test_every_decade_below_pi_is_drawn_and_nothing_beyond(gaps):
    assert {int(k) for k in np.log10(gaps[gaps > 0])} >= set(range(-15, -2))
    assert 0 <= gaps.min() <= gaps.max() <= near_strategies.WIDEST + math.ulp(PI)


def test_one_angle_in_three_lies_within_1e_12_of_pi(gaps):
    assert np.mean(gaps <= 1e-12) > 1 / 3


def test_angles_beyond_are_drawn_as_often_as_below_where_they_are_asked_for():
    gaps = np.array(drawn(near_strategies.near_angles(1.0, beyond=True), 200)) - 1.0
    assert 0.3 < np.mean(gaps > 0) < 0.6
    assert 0.3 < np.mean(gaps < 0) < 0.6


def test_near_0_there_are_0_the_decades_below_1e_3_and_now_and_then_those_below_1e_12():
    angles = np.array(drawn(near_strategies.near_angles(0.0), 300))
    decades = {int(k) for k in np.log10(angles[angles > 0])}
    assert (angles == 0).any()
    assert decades >= set(range(-11, -2))
    assert 0.1 < np.mean((angles > 0) & (angles < 1e-12)) < 0.3
    assert min(decades) < -100
    assert angles.max() <= 1e-3


def test_angle_and_length_are_independent():
    xi = np.array(drawn(near_strategies.near_twists(0.0), 300))
    sizes = np.log10(
        [(np.linalg.norm(x[:3]), np.linalg.norm(x[3:])) for x in xi if x[:3].any() and x[3:].any()]
    )
    assert abs(np.corrcoef(sizes.T)[0, 1]) < 0.2
    assert ((sizes[:, 0] < -6) & (sizes[:, 1] > 0)).sum() > 10


def test_rotations_near_pi_are_rotations_by_that_angle():
    for R in drawn(near_strategies.near_rotations(), 50):
        assert np.abs(R @ R.T - np.eye(3)).max() < 3e-15
        assert -1 - 1e-15 <= (np.trace(R) - 1) / 2 < -1 + 1e-6
    T = np.array(drawn(near_strategies.near_poses(0.0, widest=1e-6, lengths=(0.5, 2.0)), 50))
    assert np.abs(T[:, :3, :3] - np.eye(3)).max() < 2e-6
    lengths = np.linalg.norm(T[:, :3, 3], axis=1)
    assert np.all((lengths == 0) | (lengths > 0.49) & (lengths < 2.01))


@pytest.mark.parametrize(
    "name", ["near_angles", "near_rotation_vectors", "near_rotations", "near_twists", "near_poses"]
)
def test_an_angle_an_axis_and_a_vector_are_read_in_turn_and_none_beyond(name, monkeypatch):
    monkeypatch.setattr(near_strategies, "read", lambda size, decode: decode)
    data = bytes(
        [200, 200, 255, 0, 99, 7, 2, 5, 9, *range(40, 70)]
    )  # above, where that is asked for
    for beyond in ((), (True,)):
        r = BytesReader(data)
        angle = near_strategies._angle(r, 1.0, 1e-3, bool(beyond))
        assert (angle > 1) == bool(beyond)
        strategy = getattr(near_strategies, name)
        found = strategy(1.0, **({"beyond": True} if beyond else {}))(BytesReader(data))
        if name == "near_angles":
            assert found == angle
            continue
        n = decoders.axis(r)
        if name in ("near_rotation_vectors", "near_twists"):
            assert np.array_equal(found[:3], angle * n)
        else:
            assert np.array_equal(found[:3, :3], decoders.turned(n, angle))
        if name in ("near_twists", "near_poses"):
            v = found[3:] if name == "near_twists" else found[:3, 3]
            assert np.array_equal(v, decoders.vector(r, near_strategies.LENGTHS))


def test_they_shrink_to_the_angle_itself_about_x():
    w = find(near_strategies.near_rotation_vectors(), lambda w: True, settings=QUICK)
    np.testing.assert_array_equal(w, [PI, 0, 0])
    xi = find(near_strategies.near_twists(0.0), lambda xi: xi[:3].any(), settings=QUICK)
    np.testing.assert_array_equal(xi, [1e-4, 0, 0, 0, 0, 0])
