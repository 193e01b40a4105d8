"""Strategies ask for as many bytes as they read: what is missing would be read as zeros, and be no choice at all."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from poekin.model.chain import Chain
from poekin.testing import (
    chain_strategies,
    configuration_strategies,
    near_strategies,
    reader,
    robot_strategies,
    strategies,
)
from tests.testing.drawing import drawn

ARM = Chain([[0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [1, 0, 0, 0, 0, 0]], np.eye(4), limits=[[-1, 1], [2, 3], [-3, 0]])
STRATEGIES: dict[str, Callable[[], Any]] = {
    "magnitudes": strategies.magnitudes,
    "angles": strategies.angles,
    "axes": strategies.axes,
    "vectors": strategies.vectors,
    "rotation vectors": strategies.rotation_vectors,
    "twists": strategies.twists,
    "rotations": strategies.rotations,
    "noisy rotations": strategies.noisy_rotations,
    "poses": strategies.poses,
    "quaternions": strategies.quaternions_wxyz,
    "near angles": lambda: near_strategies.near_angles(0.0),
    "near rotation vectors": lambda: near_strategies.near_rotation_vectors(1.0),
    "near rotations": lambda: near_strategies.near_rotations(1.0),
    "near twists": lambda: near_strategies.near_twists(1.0),
    "near poses": lambda: near_strategies.near_poses(1.0),
    "screws": chain_strategies.screws,
    "coupled chains": lambda: chain_strategies.chains(2, 3, coupled=True, limits=True),
    "chains": lambda: chain_strategies.chains(2, 3, coupled=False, limits=True),
    "coordinates": lambda: chain_strategies.coordinates(ARM, (2,)),
    "within limits": lambda: configuration_strategies.within_limits(ARM),
    "at limits": lambda: configuration_strategies.at_limits(ARM),
    "robots": robot_strategies.robots,
}


@pytest.mark.parametrize("name", STRATEGIES)
def test_a_strategy_asks_for_as_many_bytes_as_it_reads(name, monkeypatch):
    read: list[list[int]] = []

    class Counting(reader.Reader):
        def __init__(self, data: bytes):
            super().__init__(data)
            self.count = [len(data), 0]
            read.append(self.count)

        def byte(self) -> int:
            self.count[1] += 1
            return super().byte()

    monkeypatch.setattr(strategies, "Reader", Counting)
    drawn(STRATEGIES[name](), 150)
    most: dict[int, int] = defaultdict(int)
    for size, used in read:
        most[size] = max(most[size], used)
    spare = 4 if name == "robots" else 1  # what no draw, or hardly any, comes to read
    assert all(size - spare <= used <= size for size, used in most.items()), dict(most)
