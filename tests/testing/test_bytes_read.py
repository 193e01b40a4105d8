"""Bytes as numbers: what each of them means, and that strategies ask for as many as they read.

What is missing would be read as zeros, and be no choice at all.
"""

from __future__ import annotations

import math
import re
import runpy
import sys
from collections import defaultdict
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from poekin.errors import MissingExtra
from poekin.model.chain import Chain
from poekin.testing.strategies import (
    chain_strategies,
    configuration_strategies,
    group_strategies,
    near_strategies,
    robot_strategies,
)
from poekin.testing.strategies.decoding import arrays, bytes_reader, decoders
from tests.testing.drawing import drawn

ARM = Chain.from_space(
    [[0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [1, 0, 0, 0, 0, 0]],
    np.eye(4),
    limits=[[-1, 1], [2, 3], [-3, 0]],
)
STRATEGIES: dict[str, Callable[[], Any]] = {
    "magnitudes": group_strategies.magnitudes,
    "angles": group_strategies.angles,
    "axes": group_strategies.axes,
    "vectors": group_strategies.vectors,
    "rotation vectors": group_strategies.rotation_vectors,
    "twists": group_strategies.twists,
    "rotations": group_strategies.rotations,
    "noisy rotations": group_strategies.noisy_rotations,
    "poses": group_strategies.poses,
    "quaternions": group_strategies.quaternions_wxyz,
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

    class Counting(bytes_reader.BytesReader):
        def __init__(self, data: bytes):
            super().__init__(data)
            self.count = [len(data), 0]
            read.append(self.count)

        def byte(self) -> int:
            self.count[1] += 1
            return super().byte()

    monkeypatch.setattr(arrays, "BytesReader", Counting)
    drawn(STRATEGIES[name](), 150)
    most: dict[int, int] = defaultdict(int)
    for size, used in read:
        most[size] = max(most[size], used)
    spare = 4 if name == "robots" else 1  # what no draw, or hardly any, comes to read
    assert most, "nothing was read"
    assert all(size - spare <= used <= size for size, used in most.items()), dict(most)


def read(*values: int) -> bytes_reader.BytesReader:
    return bytes_reader.BytesReader(bytes(values))


def test_bytes_are_read_in_order_and_then_zeros():
    r = read(3, 255, 7)
    assert [r.byte() for _ in range(5)] == [3, 255, 7, 0, 0]


def test_each_option_is_picked_by_as_many_bytes():
    assert [read(k).pick("abc") for k in (0, 85, 86, 170, 171, 255)] == list("aabbcc")


@pytest.mark.parametrize(
    ("low", "high", "values"),
    [
        (
            -1.0,
            1.0,
            {
                (0, 0, 0): 0.0,
                (0, 255, 255): 1.0,
                (127, 1, 2): 258 / 65535,
                (128, 0, 0): -1.0,
                (255, 255, 255): 0,
            },
        ),
        (
            0.25,
            2.5,
            {
                (0, 0, 0): 0.25,
                (85, 255, 255): 1.0,
                (86, 0, 0): 1.0,
                (171, 0, 0): 2.0,
                (255, 255, 255): 2.5,
            },
        ),
        (2.0, 2.0, {(0, 0, 0): 2.0, (255, 255, 255): 2.0}),
        (3.0, 3.0, {(0, 0, 0): 3.0, (255, 255, 255): 3.0}),
        (-3.0, -2.0, {(0, 0, 0): -3.0, (255, 255, 255): -2.0, (9, 128, 0): -3 + 32768 / 65535}),
        (0.2, 0.4, {(0, 0, 0): 0.2, (255, 255, 255): 0.4}),
    ],
)
def test_fractions_are_even_between_whole_numbers_the_next_to_0_first(low, high, values):
    for bytes_, expected in values.items():
        assert read(*bytes_).fraction(low, high) == pytest.approx(expected, abs=1e-15)


def test_decimals_have_one_digit_or_three_and_stay_within():
    for bytes_, expected in (
        ((0, 0, 100, 0), 0.4), ((127, 0, 100, 0), 0.4), ((128, 0, 100, 0), 0.391), ((255, 255, 100, 0), -0.609)
    ):  # fmt: skip
        assert read(*bytes_).decimal(-1.0, 1.0) == expected
    assert read(0, 0, 255, 255).decimal(0.0, 0.26) == 0.26
    assert read(0, 0, 0, 0).decimal(0.24, 1.0) == 0.24


def test_magnitudes_are_0_or_have_an_even_logarithm():
    for first, expected in ((0, 0.0), (15, 0.0), (16, 1.0), (255, 1.0)):
        assert read(first, 0, 0, 0).magnitude(1e-3, 10.0) == expected
    assert read(255, 0, 255, 255).magnitude(1e-3, 10.0) == 10.0
    assert read(255, 64, 0, 0).magnitude(1e-3, 10.0) == pytest.approx(0.1, rel=1e-15)
    assert read(255, 255, 0, 0).magnitude(1e-3, 10.0) == 1e-3
    assert read(255, 255, 0, 0).magnitude(0.7, 0.9) == 0.7
    assert read(255, 0, 255, 255).magnitude(0.7, 0.9) == 0.9


def test_an_angle_is_of_one_of_five_kinds():
    def angle(kind: int, *rest: int, largest: float = 10.0, smallest: float = 1e-150) -> float:
        return decoders.angle(read(kind, *rest), largest, smallest)

    for kind in (0, 1, 2, 3, 4, 12, 16):
        assert angle(kind, 255, 255, 0, 0) == 1e-12
        assert angle(kind, 255, 0, 255, 255) == 10.0
        assert angle(kind, 255, 255, 0, 0, smallest=0.5) == 0.5
        assert angle(kind, 255, 0, 0, 0, largest=1e-13) == 1e-13
    assert angle(5, 255, 255, 0, 0) == 1e-150
    assert angle(5, 255, 0, 255, 255) == 1e-12
    assert angle(5, 255, 0, 255, 255, smallest=0.5) == 0.5
    marks = {angle(kind, k) for kind in (6, 7, 19) for k in range(256)}
    centres = (2e-140, 1.0, 2.0, math.pi / 2, math.pi, 2 * math.pi)
    assert marks == {x for c in centres for x in (c, math.nextafter(c, 0), math.nextafter(c, 9))}
    assert {angle(6, k, largest=2.0, smallest=1.0) for k in range(256)} == {
        1.0, math.nextafter(1, 2), math.pi / 2, math.nextafter(math.pi / 2, 0), math.nextafter(math.pi / 2, 2), 2.0,
        math.nextafter(2, 0),
    }  # fmt: skip
    for kind in (8, 9):
        assert angle(kind, 0, 0, 0) == pytest.approx(math.pi - 1, rel=1e-15)
        assert angle(kind, 0, 255, 255) == pytest.approx(math.pi - 0.1, rel=1e-15)
        assert math.pi - angle(kind, 255, 0, 0) == pytest.approx(1e-15, abs=3e-16)
        assert angle(kind, 255, 255, 255) <= math.pi
        assert angle(kind, 255, 0, 0, largest=math.pi) > 3
    for kind in (10, 11, 23):
        assert angle(kind, 0, 128, 0) == 32768 / 65535
        assert angle(kind, 255, 255, 255) == 10.0
    assert angle(8, 0, 255, 255, largest=3.0) == 1.0
    assert angle(6, 0, 255, 255, largest=0.3, smallest=0.2) == 0.3


def test_an_axis_is_of_one_of_three_kinds():
    def axis(kind: int, place: int, sign: int, *rest: int) -> list[float]:
        return decoders.axis(read(kind, place, sign, *rest)).tolist()

    for k in range(3):
        for sign, value in ((0, 1.0), (127, 1.0), (128, -1.0)):
            assert axis(0, k, sign) == axis(4, k + 3, sign) == np.roll([value, 0, 0], k).tolist()
            assert axis(0, k, sign, *[99] * 9) == axis(0, k, sign)
    assert axis(1, 0, 0, 0, 0, 0, 0, 255, 255) == pytest.approx(
        np.array([1, 0.1, -0.01]) / math.hypot(1, 0.1, 0.01)
    )
    assert axis(1, 1, 0, 255, 255, 255, 255, 0, 0) == pytest.approx(
        [-1e-16, 1, 1e-17], rel=1e-12, abs=0
    )
    for kind in (2, 3):
        assert axis(kind, 0, 0, 0, 255, 255, 128, 0, 0, 0, 0, 0) == pytest.approx(
            [math.sqrt(0.5), -math.sqrt(0.5), 0], rel=1e-15
        )
        assert axis(kind, 2, 200) == [0, 0, -1]  # what is shorter than 0.1 has no direction
        assert axis(kind, 0, 0, 0, 25, 0, *[0] * 6) == [1, 0, 0]
        assert axis(kind, 0, 200, 0, 28, 0, *[0] * 6) == [1, 0, 0]
        assert axis(kind, 0, 200, 0, 25, 0, *[0] * 6) == [-1, 0, 0]


def test_an_axis_in_four_is_of_the_frame_one_nearly_so_and_two_are_anywhere():
    rest = [200, 40, 0, 90, 80, 0, 200, 120, 0]
    others = [np.sort(np.abs(decoders.axis(read(k, 0, 0, *rest)))) for k in range(256)]
    assert sum(second == 0 for _, second, _ in others) == 64
    assert sum(0 < second < 0.1 for _, second, _ in others) == 64
    assert sum(second > 0.1 for _, second, _ in others) == 128


def test_vectors_and_rotations_are_an_axis_and_a_size():
    assert decoders.vector(read(255, 0, 255, 255, 0, 1, 0), (0.1, 4.0)).tolist() == [0, 4, 0]
    assert not decoders.vector(read(15, 0, 255, 255, 0, 1, 0), (0.1, 4.0)).any()
    n = np.array([2.0, 3.0, -6.0]) / 7
    R = decoders.turned(n, 2.5)
    N = np.array([[0, 6.0, 3.0], [-6.0, 0, -2.0], [-3.0, 2.0, 0]]) / 7
    assert pytest.approx(np.eye(3), abs=1e-15) == R @ R.T
    assert pytest.approx(n, abs=1e-15) == R @ n
    assert pytest.approx(math.sin(2.5) * N, abs=1e-15) == (R - R.T) / 2
    assert np.trace(R) == pytest.approx(1 + 2 * math.cos(2.5), abs=1e-15)
    turn = decoders.rotation(read(0, 1, 200, 10, 255, 255, 255))
    assert turn == pytest.approx(decoders.turned(np.array([0, -1.0, 0]), math.pi), abs=1e-15)
    assert pytest.approx(np.diag([-1, 1, -1]), abs=1e-15) == turn


def test_the_floats_beside_a_number():
    assert decoders.around(1.0) == (1.0, 1 - 2.0**-53, 1 + 2.0**-52)
    assert decoders.around(0.0) == (0.0, -5e-324, 5e-324)


def test_without_hypothesis_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "hypothesis", None)
    message = (
        "poekin.testing.strategies needs the package hypothesis: pip install 'poekin[testing]'"
    )
    with pytest.raises(MissingExtra, match=f"^{re.escape(message)}$"):
        runpy.run_path(arrays.__file__)
