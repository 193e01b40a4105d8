"""Chains, screws and configurations as they are drawn."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import find, settings

from poekin.model.chain import Chain
from poekin.testing.strategies import chain_strategies
from poekin.testing.strategies.decoding.bytes_reader import BytesReader
from tests.testing.drawing import QUICK, drawn
from tests.versions import SHRINKS, needs

QUICK = settings(QUICK, max_examples=500)


@pytest.fixture(scope="module")
def chains() -> list:
    return drawn(chain_strategies.chains(), 200)


def test_chains_have_0_to_12_joints_of_every_kind(chains):
    assert {len(chain.screws) for chain in chains} >= {0, 1, 12}
    assert {kind for chain in chains for kind in chain.kinds} == set(chain_strategies.KINDS)


def test_some_chains_are_coupled_and_some_joints_stand_still(chains):
    coupled = [chain for chain in chains if chain.dof < len(chain.screws)]
    assert 20 < len(coupled) < 180
    assert any((~chain.coupling.any(axis=1)).any() for chain in coupled)
    offsets = np.concatenate([chain.offset for chain in coupled])
    assert -1 <= offsets.min() < -0.9 < 0.9 < offsets.max() <= 1
    assert all(chain.coupling.any(axis=0).all() for chain in chains), (
        "every coordinate moves a joint"
    )


def test_coupled_joints_follow_as_they_are_half_twice_against_and_not_at_all():
    assert sorted(chain_strategies.RATIOS) == [-2, -1, 0, 0.5, 1]


def test_limits_are_read_off_their_bytes():
    lowest, least, most = [0, 255, 0, 0], [0, 0, 0, 0], [0, 255, 255, 255]
    for kind, width, expected in (
        (0, least, (-math.inf, math.inf)),
        (40, least, (-3.0, -2.9)),
        (145, most, (-3.0, 0.0)),
        (150, most, (-3.0, -3.0)),
        (190, least, (-3.0, math.inf)),
        (255, most, (-math.inf, 0.0)),
    ):
        assert chain_strategies._limits(BytesReader(bytes([kind, *lowest, *width]))) == expected
    assert chain_strategies._limits(BytesReader(bytes([40, 0, 210, 255, 255, *most]))) == (3.0, 6.0)


@pytest.mark.parametrize("shape", [(), (2,), (2, 3)])
def test_coordinates_are_read_off_their_bytes(shape, monkeypatch):
    chain, count = (
        Chain.from_space([[0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0]], np.eye(4)),
        2 * math.prod(shape),
    )
    monkeypatch.setattr(chain_strategies, "read", lambda size, decode: (size, decode))
    asked: Any = chain_strategies.coordinates(chain, shape)
    size, decode = asked
    assert size == 4 * count
    for data, value in (([63, 64], math.pi / 2), ([63, 255], math.pi), ([64, 240, 0, 0], -math.pi)):
        found = decode(BytesReader(bytes(data * count)))
        assert found.shape == (*shape, 2)
        assert np.all(found == value)


@pytest.mark.parametrize(
    ("kind", "sign", "pitch"),
    [("helical", 0, 1.0), ("helical", 255, -1.0), ("revolute", 0, 0.0), ("prismatic", 0, None)],
)
def test_a_screw_has_its_axis_point_and_pitch(kind, sign, pitch, monkeypatch):
    axis, point = np.array([0.6, 0, 0.8]), np.array([1.0, 2.0, 3.0])
    decoded: list[float] = []

    def builds(screw: Any, *_: Any) -> Any:
        return screw(kind, axis, point, decoded[0])

    def read(size: int, decode: Any) -> None:
        decoded.append(decode(BytesReader(bytes([sign, 255, 0, 255, 255]))))

    monkeypatch.setattr(chain_strategies, "read", read)
    monkeypatch.setattr(chain_strategies.st, "builds", builds)
    S: Any = chain_strategies._screws.__wrapped__((kind,))
    assert decoded[0] == (-1.0 if sign else 1.0)
    expected = (
        [0, 0, 0, *axis] if pitch is None else [*axis, *(np.cross(point, axis) + pitch * axis)]
    )
    assert S.tolist() == pytest.approx(expected, abs=1e-15)


def test_what_is_asked_for_is_drawn():
    for chain in drawn(
        chain_strategies.chains(3, 5, ("prismatic",), coupled=True, offsets=False), 30
    ):
        assert 3 <= len(chain.screws) <= 5
        assert set(chain.kinds) == {"prismatic"}
        assert not chain.offset.any()


def test_a_chain_shrinks_to_no_joint_and_no_displacement():
    needs("hypothesis", SHRINKS)
    chain = find(chain_strategies.chains(), lambda chain: True, settings=QUICK)
    assert len(chain.screws) == 0
    assert np.array_equal(chain.home[:3, 3], [0, 0, 0])


def test_a_failing_chain_shrinks_to_the_joints_that_matter():
    needs("hypothesis", SHRINKS)
    chain = find(
        chain_strategies.chains(max_joints=4),
        lambda chain: "helical" in chain.kinds,
        settings=QUICK,
    )
    assert chain.kinds == ("helical",)
    assert np.array_equal(chain.screws, [[1, 0, 0, 0.001, 0, 0]])


def test_points_of_an_arm_are_at_the_origin_or_from_a_millimetre_to_three_metres_off():
    lengths = np.array([np.linalg.norm(p) for p in drawn(chain_strategies.points())])
    assert (lengths == 0).any()
    off = lengths[lengths > 0]
    assert 1e-3 <= off.min() * (1 + 1e-15) < 2e-3  # the length of a rounded vector
    assert 2 < off.max() <= 3 * (1 + 1e-15)


def test_axis_and_point_of_a_screw_are_independent():
    screws = np.array(drawn(chain_strategies.screws(("revolute",)), 300))
    assert np.abs(np.linalg.norm(screws[:, :3], axis=1) - 1).max() < 1e-9
    assert np.abs(np.sum(screws[:, :3] * screws[:, 3:], axis=1)).max() < 1e-14
    arms = np.linalg.norm(screws[:, 3:], axis=1)
    assert (arms == 0).any()
    assert 0 < arms[arms > 1e-9].min() < 0.1 < 1 < arms.max() <= 3.1


def test_coordinates_hold_zeros_quarter_turns_and_all_between():
    chain = Chain.from_space([[0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0]], np.eye(4))
    q = np.concatenate(drawn(chain_strategies.coordinates(chain, (3,)), 100))
    assert q.shape == (300, 2)
    assert np.abs(q).max() <= math.pi
    assert set(chain_strategies.QUARTERS) <= set(q.ravel())
    assert np.cos(chain_strategies.QUARTERS) == pytest.approx([1, 0, 0, -1], abs=1e-15)
    assert np.sin(chain_strategies.QUARTERS) == pytest.approx([0, 1, -1, 0], abs=1e-15)
    assert (
        0.2 < np.isin(q, chain_strategies.QUARTERS).mean() < 0.4
    )  # one in four, and zeros of simpler draws
    assert np.histogram(q, bins=8)[0].min() > 20


def test_chains_have_limits_of_every_kind_where_they_are_asked_for():
    every = drawn(chain_strategies.chains(max_joints=5, limits=True), 120)
    lower, upper = np.concatenate([chain.limits for chain in every]).T
    assert np.all(lower <= upper)
    kinds = {
        "equal" if a == b else (bool(np.isfinite(a)), bool(np.isfinite(b)))
        for a, b in zip(lower, upper, strict=True)
    }
    assert kinds == {"equal", (False, False), (True, True), (True, False), (False, True)}
    assert any(np.any(chain.coupling != np.eye(*chain.coupling.shape)) for chain in every)
    assert np.all(
        np.isinf(np.concatenate([chain.limits for chain in drawn(chain_strategies.chains(), 20)]))
    )
