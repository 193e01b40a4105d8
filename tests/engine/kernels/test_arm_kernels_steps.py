"""What leads an arm's code over configurations, as plain Python: memory, lanes, blocks, and refusals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from poekin.engine.kernels import arm_kernels as kernel
from poekin.engine.straight_line.sincos import MODERATE

M = 3  # coordinates
ANGLES = 5  # the coordinates, and twice the first two
# sines and cosines are right to a rounding
WITHIN = 2.0**-52


def angles_of(q: np.ndarray) -> np.ndarray:
    return np.concatenate([q, 2 * q[..., :2]], axis=-1)


def wanted(q: np.ndarray) -> np.ndarray:
    return np.concatenate([np.sin(angles_of(q)), np.cos(angles_of(q))], axis=-1)


class Code:
    """An arm's functions: they write sines and cosines as the first numbers of T and of J."""

    def __init__(self, monkeypatch, writes: str = "TJ", count: int = ANGLES):
        self.memory: list[int] = []
        self.writes = writes
        self.count = count
        self.arm: Any = (count, M, "angles", "one", "four")
        monkeypatch.setattr(kernel, "_header", lambda arm: arm)
        monkeypatch.setattr(kernel, "_angles", self._angles)
        monkeypatch.setattr(kernel, "_run", self._run)

    def _angles(self, code, q, row, sines, stride, lane):
        assert code == "angles"
        assert row >= 0
        of_row = angles_of(q.reshape(-1, M)[row])[: self.count]
        sines.reshape(-1)[lane : lane + stride * self.count : stride] = of_row

    def _run(self, code, sines, cosines, stride, lane, q, T, J, row):
        self.memory.append(sines.ctypes.data)
        count = {"one": 1, "four": 4}[code]
        assert row >= 0
        for i in range(count):
            part = slice(lane + i, lane + i + stride * (self.count - 1) + 1, stride)
            numbers = np.concatenate([a.reshape(-1)[part] for a in (sines, cosines)])
            for name, array, size in (("T", T, 16), ("J", J, 6 * M)):
                if name in self.writes:
                    array.reshape(-1, size)[row + i, : 2 * self.count] = numbers


def filled(*shape: int) -> np.ndarray:
    return np.full(shape, 7.0)


Q = np.array([0.3, -1.2, 2.5])


@pytest.mark.parametrize("room", [0, 15, 16, 40])
def test_one_configuration_takes_the_memory_that_is_given_where_it_has_room(room, monkeypatch):
    code, T, J, scratch = Code(monkeypatch), filled(4, 4), filled(6, M), filled(room)
    padding = []
    plain = kernel._sines_cosines

    def sines_cosines(sines, cosines, count):
        padding.append((sines[ANGLES:count].tolist(), len(sines), len(cosines)))
        plain(sines, cosines, count)

    monkeypatch.setattr(kernel, "_sines_cosines", sines_cosines)
    kernel.run_one(code.arm, Q, T, J, scratch)
    for array in (T, J):
        np.testing.assert_allclose(array.ravel()[:10], wanted(Q), rtol=0, atol=WITHIN)
        assert (array.ravel()[10:] == 7.0).all()
    # sines and cosines of two full lanes, of which three are of no angle
    assert padding == [([0.0] * 3, 8, max(room - 8, 8))]
    assert (code.memory == [scratch.ctypes.data]) == (room >= 16)
    assert (scratch[16:] == 7.0).all()
    assert (scratch == 7.0).all() == (room < 16)


@pytest.mark.parametrize(("count", "lanes"), [(1, 4), (3, 4), (4, 4), (5, 8)])
def test_sines_and_cosines_of_one_configuration_fill_whole_lanes(count, lanes, monkeypatch):
    code, sizes = Code(monkeypatch, count=count), []
    plain = kernel._sines_cosines

    def sines_cosines(sines, cosines, size):
        sizes.append((len(sines), size))
        plain(sines, cosines, size)

    monkeypatch.setattr(kernel, "_sines_cosines", sines_cosines)
    T = filled(4, 4)
    kernel.run_one(code.arm, Q, T, filled(6, M), filled(40))
    assert sizes == [(lanes, lanes)]
    angles = angles_of(Q)[:count]
    expected = [*np.sin(angles), *np.cos(angles)]
    np.testing.assert_allclose(T.ravel()[: 2 * count], expected, rtol=0, atol=WITHIN)


@pytest.mark.parametrize("room", [0, 39, 40, 100])
def test_four_configurations_take_the_memory_that_is_given_where_it_has_room(room, monkeypatch):
    code, T, J, scratch = Code(monkeypatch), filled(4, 4, 4), filled(4, 6, M), filled(room)
    q = Q + 0.1 * np.arange(4)[:, None]
    kernel.run_four(code.arm, q, T, J, scratch)
    for array in (T, J):
        numbers = array.reshape(4, -1)
        np.testing.assert_allclose(numbers[:, :10], wanted(q), rtol=0, atol=WITHIN)
        assert (numbers[:, 10:] == 7.0).all()
    assert (code.memory == [scratch.ctypes.data]) == (room >= 40)
    assert (scratch[40:] == 7.0).all()
    assert (scratch == 7.0).all() == (room < 40)


def test_angles_are_moderate_up_to_the_border():
    sines = np.array([0.5, MODERATE, -MODERATE, np.nextafter(MODERATE, math.inf), 0.0])
    assert [bool(kernel._all_moderate(sines, k)) for k in range(6)] == [True] * 4 + [False] * 2
    assert not kernel._all_moderate(np.array([-2 * MODERATE]), 1)
    assert not kernel._all_moderate(np.array([0.0, math.nan]), 2)


@pytest.mark.parametrize("large", [0.7, 3 * MODERATE, 1e9 * MODERATE])
def test_angles_become_sines_in_place_and_cosines(large):
    angles = np.array([0.3, -2.5, large, 1.0])
    sines, cosines = angles.copy(), np.full(4, 7.0)
    kernel._sines_cosines(sines, cosines, 3)
    np.testing.assert_allclose(sines, [*np.sin(angles[:3]), 1.0], rtol=0, atol=WITHIN)
    np.testing.assert_allclose(cosines, [*np.cos(angles[:3]), 7.0], rtol=0, atol=WITHIN)


@pytest.mark.parametrize(("first", "second"), [(3, 5), (5, 3), (1, 1), (10, 9)])
def test_arrays_are_apart_where_neither_begins_in_the_other(first, second):
    memory = np.zeros(40)
    a = memory[10 : 10 + first]
    for start in range(30):
        b = memory[start : start + second]
        expected = start >= 10 + first or start + second <= 10
        assert kernel._apart(a, b) is expected
        assert kernel._apart(b, a) is expected


def one(name: str, code: Code, q: np.ndarray, T: np.ndarray, J: np.ndarray) -> int:
    arrays = {"pose_one": (T,), "jacobian_one": (J,), "pose_jacobian_one": (T, J)}[name]
    code.writes = {"pose_one": "T", "jacobian_one": "J"}.get(name, "TJ")
    return getattr(kernel, name).function(code.arm, q, *arrays)


ONE = {"pose_one": "qT", "jacobian_one": "qJ", "pose_jacobian_one": "qTJ"}


@pytest.mark.parametrize("name", ONE)
def test_one_configuration_is_run_where_shapes_are_right_and_memory_is_not_shared(
    name, monkeypatch
):
    code = Code(monkeypatch)
    T, J = filled(4, 4), filled(6, M)
    assert one(name, code, Q, T, J) == 1
    for array, letter in ((T, "T"), (J, "J")):
        if letter in ONE[name]:
            np.testing.assert_allclose(array.ravel()[:10], wanted(Q), rtol=0, atol=WITHIN)
        else:
            assert (array == 7.0).all()
    for letter, axis, change in (
        ("q", 0, -1), ("q", 0, 1), *((x, axis, change) for x in "TJ" for axis in (0, 1) for change in (-1, 1)),
    ):  # fmt: skip
        shapes = {"q": [M], "T": [4, 4], "J": [6, M]}
        shapes[letter][axis] += change
        arrays = [filled(*shape) for shape in shapes.values()]
        assert one(name, code, *arrays) == int(letter not in ONE[name])


@pytest.mark.parametrize("name", ONE)
@pytest.mark.parametrize("pair", ["qT", "qJ", "TJ"])
def test_memory_that_two_share_is_refused(name, pair, monkeypatch):
    code, memory = Code(monkeypatch), filled(200)
    places = {"q": 0, "T": 20, "J": 60}
    sizes = {"q": M, "T": 16, "J": 6 * M}
    a, b = pair
    places[b] = places[a] + sizes[a] - 1
    q, T, J = (memory[places[x] : places[x] + sizes[x]] for x in "qTJ")
    shared = set(pair) <= set(ONE[name])
    assert one(name, code, q, T.reshape(4, 4), J.reshape(6, M)) == int(not shared)
    assert (memory == 7.0).all() == shared


@pytest.mark.parametrize("rows", [0, 1, 3, 4, 5, 63, 64, 65, 131])
def test_batches_are_run_in_blocks_four_at_once_and_the_rest_one_by_one(rows, monkeypatch):
    code = Code(monkeypatch)
    q = np.random.default_rng(0).uniform(-3, 3, (rows, M))
    T, J = filled(rows, 4, 4), filled(rows, 6, M)
    kernel.pose_jacobian_many.function(code.arm, q, T, J)
    for array in (T, J):
        numbers = array.reshape(rows, -1 if rows else 16)
        np.testing.assert_allclose(numbers[:, :10], wanted(q), rtol=0, atol=WITHIN)
        assert (numbers[:, 10:] == 7.0).all()
    blocks = [min(64, rows - start) for start in range(0, rows, 64)]
    assert len(code.memory) == sum(size // 4 + size % 4 for size in blocks)
    for name, letter, array in (("pose_many", "T", T), ("jacobian_many", "J", J)):
        array[:], code.writes = 7.0, letter
        getattr(kernel, name).function(code.arm, q, array)
        numbers = array.reshape(rows, -1 if rows else 16)
        np.testing.assert_allclose(numbers[:, :10], wanted(q), rtol=0, atol=WITHIN)


def test_a_block_of_columns_is_run_from_four_to_four(monkeypatch):
    arm: Any = (ANGLES, M, "angles", "columns", "-")
    q, sines, cosines = filled(M, kernel.BLOCK), filled(ANGLES, 64), filled(ANGLES, 64)
    R_p, J = filled(12, kernel.BLOCK), filled(6 * M, 4)
    calls: list[Any] = []

    def place(array: np.ndarray, base: np.ndarray) -> float:
        return (array.ctypes.data - base.ctypes.data) / 8

    def angles(code, of, row, into, stride, lane):
        calls.append((code, place(of, q), row, into is sines, stride, lane))

    def run(code, s, c, stride, lane, of, T, into, row):
        given = (s is sines, c is cosines, into is J)
        calls.append((code, *given, stride, lane, place(of, q), place(T, R_p), row))

    monkeypatch.setattr(kernel, "_header", lambda arm: arm)
    monkeypatch.setattr(kernel, "_angles", angles)
    monkeypatch.setattr(kernel, "_run", run)
    assert kernel.sines_room(arm) == ANGLES
    kernel.sines_of_block(arm, q, sines, cosines)
    assert calls == [("angles", k, 0, True, 64, k) for k in range(0, 64, 4)]
    np.testing.assert_allclose(sines, math.sin(7.0), rtol=0, atol=WITHIN)
    np.testing.assert_allclose(cosines, math.cos(7.0), rtol=0, atol=WITHIN)
    calls.clear()
    kernel.run_columns(arm, sines, cosines, 8, q, R_p, J)
    assert calls == [("columns", True, True, True, 64, 8, 8, 8, 0)]


def test_calls_of_one_configuration_keep_the_lock():
    assert all(getattr(kernel, name).quick for name in ONE)
