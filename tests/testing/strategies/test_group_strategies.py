"""The strategies: what they draw on purpose, that angle and length are independent, that they
shrink.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import find
from hypothesis import strategies as st

from poekin.errors import InputError
from poekin.formulas.lie import coefficients
from poekin.testing.strategies import batch_strategies, group_strategies
from poekin.testing.strategies.decoding import decoders
from poekin.testing.strategies.decoding.bytes_reader import BytesReader
from tests.testing.drawing import QUICK, drawn
from tests.versions import SHRINKS, needs


def test_the_switches_are_those_of_the_formulas():
    assert math.sqrt(coefficients.SWITCH) in decoders.SWITCHES
    assert 1.0 in decoders.SWITCHES


@pytest.mark.parametrize(
    "angle",
    [0.0, *decoders.around(1.0), *decoders.around(2.0), *decoders.around(math.pi)[:2], 2e-140],
)
def test_the_special_angles_are_drawn(angle):
    assert find(group_strategies.angles(), lambda x: x == angle, settings=QUICK) == angle


@pytest.fixture(scope="module")
def angles() -> np.ndarray:
    return np.array(drawn(group_strategies.angles(), 1000))


def test_angles_come_as_close_to_pi_as_floats_do(angles):
    gaps = math.pi - angles
    assert {int(k) for k in np.log10(gaps[gaps > 0])} >= set(range(-15, 1))


def test_one_angle_in_24_lies_within_1e_12_of_pi_and_one_in_12_at_a_switch(angles):
    # 1000 draws scatter by 0.01.
    assert np.mean(math.pi - angles <= 1e-12) > 1 / 24
    marks = [x for s in decoders.SWITCHES for x in decoders.around(s)]
    assert 1 / 14 < np.mean(np.isin(angles, marks)) < 1 / 6


def test_no_angle_exceeds_the_largest(angles):
    assert max(angles) <= math.pi
    assert 9 < max(drawn(group_strategies.angles(10.0))) <= 10


def test_angle_and_length_are_independent_and_log_uniform():
    pairs = np.array(
        [(np.linalg.norm(x[:3]), np.linalg.norm(x[3:])) for x in drawn(group_strategies.twists())]
    )
    pairs = np.log10(pairs[(pairs > 0).all(axis=1)])
    assert abs(np.corrcoef(pairs.T)[0, 1]) < 0.25
    for column, low, high in ((0, -100, 0), (1, -9, 2)):
        assert pairs[:, column].min() < low
        assert pairs[:, column].max() > high
    small_turn_long_shift = (pairs[:, 0] < -6) & (pairs[:, 1] > 0)
    assert small_turn_long_shift.sum() > 10


@pytest.mark.parametrize(
    "strategy",
    [group_strategies.twists(), group_strategies.poses(), group_strategies.noisy_rotations()],
)
def test_arrays_are_read_only_float64(strategy):
    (case,) = drawn(strategy, 1)
    assert case.dtype == np.float64
    assert not case.flags.writeable


def test_twists_shrink_to_round_numbers():
    needs("hypothesis", SHRINKS)
    xi = find(
        group_strategies.twists(),
        lambda x: math.hypot(*x[:3]) > 1e-3 and math.hypot(*x[3:]) > 1e-3,
        settings=QUICK,
    )
    assert np.count_nonzero(xi) == 2, xi
    assert {float(x) for x in xi if x} <= {10.0**k for k in range(-3, 4)} | {2.0, math.pi}, xi


def test_axes_are_unit_vectors_among_them_nearly_aligned_ones():
    axes = np.array(drawn(group_strategies.axes()))
    assert np.abs(np.linalg.norm(axes, axis=1) - 1).max() < 3e-16
    second = np.sort(np.abs(axes), axis=1)[:, 1]
    assert ((second > 0) & (second < 1e-6)).any()
    # One time in four each, of 600.
    assert 0.2 < np.mean(second == 0) < 0.35
    assert 0.15 < np.mean((second > 0) & (second < 0.1)) < 0.35
    assert (second > 0.1).any()


def test_rotations_are_rotations_and_noise_is_as_large_as_said():
    for R in drawn(group_strategies.rotations(), 200):
        assert np.abs(R @ R.T - np.eye(3)).max() < 3e-15
    noise = [
        np.abs(R @ R.T - np.eye(3)).max() for R in drawn(group_strategies.noisy_rotations(), 300)
    ]
    assert 1e-9 < max(noise) < 5e-8
    assert min(noise) < 1e-15


@pytest.mark.parametrize("shape", [(), (0,), (1,), (3, 1, 2)])
def test_batches_have_their_shape(shape):
    (batch,) = drawn(batch_strategies.batches(group_strategies.twists(), shape), 1)
    assert batch.shape == (*shape, 6)
    assert shape in drawn(batch_strategies.batch_shapes(), 50)


def test_parts_are_read_off_in_turn_each_by_itself(monkeypatch):
    monkeypatch.setattr(group_strategies, "read", lambda size, decode: decode)
    monkeypatch.setattr(group_strategies, "frozen", np.array)
    data = bytes([0, 200, 9, 70, 80, 2, 5, 99, *range(90, 190, 2)])

    def read(strategy: Any) -> tuple[np.ndarray, BytesReader]:
        return strategy(BytesReader(data)), BytesReader(data)

    w, r = read(group_strategies.rotation_vectors(2.0, 1e-9))
    assert np.array_equal(w, decoders.angle(r, 2.0, 1e-9) * decoders.axis(r))
    xi, r = read(group_strategies.twists(2.0, (0.5, 4.0), 1e-9))
    assert np.array_equal(xi[:3], decoders.angle(r, 2.0, 1e-9) * decoders.axis(r))
    assert np.array_equal(xi[3:], decoders.vector(r, (0.5, 4.0)))
    T, r = read(group_strategies.poses((0.5, 4.0)))
    assert np.array_equal(T[:3, :3], decoders.rotation(r))
    assert np.array_equal(T[:3, 3], decoders.vector(r, (0.5, 4.0)))
    N, r = read(group_strategies.noisy_rotations((1e-3, 1e-2)))
    R, size = decoders.rotation(r), r.magnitude(1e-3, 1e-2)
    assert size > 0
    assert np.array_equal(
        N, R + size * np.array([[r.fraction(-1, 1) for _ in range(3)] for _ in range(3)])
    )
    q, r = read(group_strategies.quaternions_wxyz.__wrapped__())
    n, half = decoders.axis(r), decoders.angle(r, math.pi, group_strategies.SMALLEST) / 2
    sign = 1.0 if r.byte() < 128 else -1.0
    assert q == pytest.approx(sign * np.array([math.cos(half), *(math.sin(half) * n)]), rel=1e-15)
    for byte, sign in ((127, 1), (128, -1)):
        simple: Any = group_strategies.quaternions_wxyz.__wrapped__()
        assert simple(BytesReader(bytes([*[0] * 3, *[0] * 5, byte])))[0] == sign


def test_lengths_and_far_angles_are_as_large_as_said(monkeypatch):
    asked: list[Any] = []
    monkeypatch.setattr(
        group_strategies.arguments,
        "magnitudes",
        lambda what, bounds: asked.append(bounds) or bounds,
    )
    group_strategies.magnitudes()
    assert asked == [(1e-150, 1e3)]
    assert group_strategies.LENGTHS == (1e-12, 1e3)
    for size, name in ((3, "rotation_vectors"), (6, "twists")):
        seen: list[float] = []

        def twists(largest: float = math.pi, seen: list[float] = seen) -> st.SearchStrategy[float]:
            seen.append(largest)
            return st.just(largest)

        monkeypatch.setattr(group_strategies, name, twists)
        cases = group_strategies.group_cases(("far_twist", "twist"), size)
        assert drawn(cases, 1) == [(10.0, math.pi)]


@pytest.mark.parametrize("size", [2, 4, 7])
def test_only_so3_and_se3_have_cases(size):
    with pytest.raises(
        InputError, match=f"expected 3 for SO\\(3\\) or 6 for SE\\(3\\), got {size}"
    ):
        group_strategies.group_cases(("twist",), size)


def gaussian_twists() -> st.SearchStrategy[np.ndarray]:
    """What peers draw: angle and length scaled together."""
    return st.builds(
        lambda seed, size: size * np.random.default_rng(seed).normal(size=6),
        st.integers(0, 2**32 - 1),
        st.sampled_from([1.0, 1e-7]),
    )


def exp_with_v_as_r(xi: np.ndarray) -> np.ndarray:
    """The translation of exp as two peers compute it: V := R below θ² = 1e-10."""
    w, v = xi[:3], xi[3:]
    t = math.hypot(*w)
    if t * t >= 1e-10:
        return (
            v
            + 2 * (math.sin(t / 2) / t) ** 2 * np.cross(w, v)
            + (t - math.sin(t)) / t**3 * np.cross(w, np.cross(w, v))
        )
    return v + np.cross(w, v)


def is_wrong(xi: np.ndarray) -> bool:
    w, v = xi[:3], xi[3:]
    return (
        math.hypot(*w) < 1e-4 and np.abs(exp_with_v_as_r(xi) - v - np.cross(w, v) / 2).max() > 1e-9
    )


def test_independent_magnitudes_find_what_gaussian_samples_miss():
    assert not any(map(is_wrong, drawn(gaussian_twists(), 200)))
    assert any(map(is_wrong, drawn(group_strategies.twists(), 200)))


def test_quaternions_are_those_of_rotations_with_either_sign():
    every = drawn(group_strategies.quaternions_wxyz(), 300)
    for q in every:
        assert abs(np.linalg.norm(q) - 1) < 4e-16
        w, v = q[0], q[1:]
        V = np.cross(np.eye(3), -v)
        R = np.eye(3) + 2 * w * V + 2 * V @ V
        np.testing.assert_allclose(R @ R.T, np.eye(3), rtol=0, atol=4e-15)
    assert {bool(q[0] < 0) for q in every} == {True, False}
    assert min(abs(q[0]) for q in every) < 1e-8
    assert 0 < min(np.linalg.norm(q[1:]) for q in every if q[1:].any()) < 1e-8
    simplest = find(group_strategies.quaternions_wxyz(), lambda q: True, settings=QUICK)
    np.testing.assert_array_equal(simplest, [1, 0, 0, 0])


@pytest.mark.parametrize(
    ("largest", "smallest"), [(3.0, 1.0), (math.pi, 3.0), (4.0, 2.5), (1e-3, 1e-9)]
)
def test_no_angle_but_0_is_below_the_smallest(largest, smallest):
    found = np.array(drawn(group_strategies.angles(largest, smallest), 2000))
    beside = found[found > 0]
    assert len(beside) > 100
    assert smallest <= beside.min()
    assert beside.max() <= largest
