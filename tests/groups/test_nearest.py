"""The nearest rotation and pose: closest of all, and what lies too far off is refused."""

from __future__ import annotations

import contextlib
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.errors import InputError, PoseError, ShapeError
from poekin.groups import se3, so3
from poekin.testing.strategies import group_strategies

R_0 = so3.exp([0.3, -1.2, 0.7])
T_0 = se3.exp([0.3, -1.2, 0.7, 1.5, 0.2, -0.7])
NOISE = st.tuples(group_strategies.magnitudes(1e-14, 1e-2), st.integers(0, 2**32 - 1))


def disturbed(R, noise):
    size, seed = noise
    return R + size * np.random.default_rng(seed).uniform(-1, 1, R.shape)


def asymmetry(M):
    return np.abs(M - M.T).max()


@given(group_strategies.rotations(), NOISE)
def test_it_is_a_rotation_that_differs_by_a_symmetric_factor(R, noise):
    M = disturbed(R, noise)
    found, moved = so3.nearest(M)
    assert np.abs(found @ found.T - np.eye(3)).max() <= 1e-14
    assert np.linalg.det(found) > 0
    stretch = found.T @ M  # the polar decomposition M = R P: P is symmetric and positive
    assert asymmetry(stretch) < 2e-14
    assert np.linalg.eigvalsh(stretch).min() > 0
    assert abs(moved - np.linalg.norm(found - M)) <= 1e-15 * moved


@given(group_strategies.rotations(), NOISE, group_strategies.rotation_vectors())
def test_no_other_rotation_is_closer(R, noise, w):
    M = disturbed(R, noise)
    found, moved = so3.nearest(M)
    assert np.linalg.norm(so3.exp(w) @ found - M) >= moved - 2e-14


@given(group_strategies.poses())
def test_a_pose_is_nearest_to_itself(T):
    found, moved = se3.nearest(T)
    assert moved < 2e-14
    assert np.abs(found[:3, :3] - T[:3, :3]).max() < 2e-14
    assert np.array_equal(found[:, 3], T[:, 3])


def test_a_rounded_pose_is_taken_afterwards_and_keeps_its_place():
    T = np.round(T_0, 2)
    with pytest.raises(
        PoseError, match=r"if it was rounded, pk.se3.nearest gives the nearest pose$"
    ):
        se3.log(T)
    found, moved = se3.nearest(T)
    assert np.array_equal(found[:3, 3], T[:3, 3])
    assert found[3].tolist() == [0.0, 0.0, 0.0, 1.0]
    assert 1e-4 < moved < 0.015
    assert np.abs(se3.log(found)[:3] - [0.3, -1.2, 0.7]).max() < 0.02


@pytest.mark.parametrize("shape", [(), (0,), (1,), (3, 1, 2)])
def test_a_batch_is_its_elements(shape):
    rng = np.random.default_rng(0)
    batch = se3.exp(rng.normal(size=(*shape, 6)))
    batch[..., :3, :3] += 1e-3 * rng.normal(size=(*shape, 3, 3))
    T, moved = se3.nearest(batch)
    R, also = so3.nearest(batch[..., :3, :3])
    assert T.shape == batch.shape
    assert moved.shape == also.shape == shape
    assert np.array_equal(T[..., :3, :3], R)
    assert np.array_equal(moved, also)
    for index in np.ndindex(shape):
        assert np.array_equal(se3.nearest(batch[index]).T, T[index])
        assert abs(se3.nearest(batch[index]).moved - moved[index]) < 1e-15


def changed(M, index, value):
    M = np.stack([M, M])
    M[(1, *index)] = value
    return M


REFUSED = [
    (lambda: so3.nearest(changed(R_0, (0, 0), np.nan)), r"^M\[1\]: expected finite numbers$"),
    (lambda: so3.nearest(changed(R_0, (2, 1), np.inf)), r"^M\[1\]: expected finite numbers$"),
    (lambda: so3.nearest(-R_0), r"^M: near no rotation, its determinant is 0 or less$"),
    (lambda: so3.nearest(np.zeros((3, 3))), r"^M: near no rotation, its determinant is 0 or less$"),
    (lambda: so3.nearest(1e200 * R_0), r"^M: farther than 0.1 \(Frobenius norm\) from every rot"),
    (lambda: so3.nearest(1.06 * R_0), r"^M: farther than 0.1 \(Frobenius norm\) from every rot"),
    (lambda: so3.nearest(1.02 * R_0, max_moved=0.03), r"^M: farther than 0.03 \(Frobenius norm\)"),
    (lambda: se3.nearest(changed(T_0, (0, 3), np.inf)), r"^M\[1\]: expected finite numbers$"),
    (lambda: se3.nearest(changed(T_0, (0, 1), np.nan)), r"^M\[1\]: expected finite numbers$"),
    (lambda: se3.nearest(changed(T_0, (3, 0), 2e-5)), r"^M\[1\]: expected the last row \[0, 0, 0,"),
    (lambda: se3.nearest(changed(T_0, (3, 3), np.nan)), r"^M\[1\]: expected the last row \[0, 0,"),
]  # fmt: skip


@pytest.mark.parametrize("call, message", REFUSED, ids=range(len(REFUSED)))
def test_what_is_near_nothing_is_refused_with_its_place(call, message):
    with pytest.raises(PoseError, match=message):
        call()


def test_the_distance_that_is_accepted_can_be_set():
    R, moved = so3.nearest(2.0 * R_0, max_moved=2.0)
    assert np.abs(R - R_0).max() < 1e-15
    assert abs(moved - np.sqrt(3)) < 1e-14
    assert so3.nearest(1.05 * R_0).moved < 0.1
    T = T_0.copy()
    T[:3, :3] *= 1.5
    assert np.abs(se3.nearest(T, max_moved=1.0).T - T_0).max() < 1e-15
    assert se3.nearest(changed(T_0, (3, 0), 0.9e-5)).moved.shape == (2,)


@pytest.mark.parametrize("each, taken", [(0.33e-5, True), (0.34e-5, False)])
def test_a_last_row_may_be_off_by_as_much_as_that_of_a_pose_all_together(each, taken):
    M = T_0.copy()
    M[3, :3] = each  # three of them: 0.99e-5 or 1.02e-5, of 1e-5
    for function in (se3.nearest, se3.inverse):
        with contextlib.nullcontext() if taken else pytest.raises(PoseError, match=r"last row"):
            function(M)


@pytest.mark.parametrize("most", [np.nan, -1e-9, -np.inf, True, "a", None, [0.1], np.array(0.1)])
def test_the_distance_that_is_accepted_is_a_number_from_0_up(most):
    message = rf"^max_moved: expected a number from 0 up, got {re.escape(repr(most))}$"
    for call in (
        lambda: so3.nearest(R_0, max_moved=most),
        lambda: se3.nearest(T_0, max_moved=most),
    ):
        with pytest.raises(InputError, match=message):
            call()


@pytest.mark.parametrize("most", [0, 0.0, 1, np.inf, np.float32(0.5), np.int64(2)])
def test_a_distance_of_0_accepts_what_is_exact_and_an_infinite_one_everything(most):
    assert np.array_equal(so3.nearest(np.eye(3), max_moved=most).R, np.eye(3))
    assert np.array_equal(se3.nearest(np.eye(4), max_moved=most).T, np.eye(4))
    if most == np.inf:
        assert np.abs(so3.nearest(1e3 * R_0, max_moved=most).R - R_0).max() < 1e-14


def test_what_has_another_shape_or_holds_no_numbers_is_refused():
    with pytest.raises(ShapeError, match=r"M: expected shape \(..., 3, 3\), got \(3, 4\)"):
        so3.nearest(np.zeros((3, 4)))
    with pytest.raises(ShapeError, match=r"M: expected shape \(..., 4, 4\), got \(3, 3\)"):
        se3.nearest(R_0)
    with pytest.raises(InputError, match=r"M: expected real numbers"):
        se3.nearest("pose")


def test_the_argument_is_left_alone():
    M = np.round(T_0, 3)
    M.flags.writeable = False
    T, _ = se3.nearest(M)
    T[...] = 0.0
    assert np.array_equal(M, np.round(T_0, 3))


def test_another_rotation_in_its_place_is_seen():
    M = disturbed(R_0, (1e-3, 0))
    Q, upper = np.linalg.qr(M)
    by_columns = Q * np.sign(np.diag(upper))  # a rotation, and not the nearest
    assert np.abs(by_columns @ by_columns.T - np.eye(3)).max() < 1e-15
    assert asymmetry(by_columns.T @ M) > 1e-4
    assert np.linalg.norm(by_columns - M) > so3.nearest(M).moved + 1e-5


@pytest.mark.parametrize("size", [0.999, 1.001])
def test_what_was_rounded_up_or_down_is_told_of_the_nearest_and_a_reflection_is_not(size):
    R = so3.exp([0.3, -0.2, 0.5])
    told = "; if it was rounded, pk.so3.nearest gives the nearest rotation"
    with pytest.raises(PoseError, match="misses orthonormality") as caught:
        so3.log(size * R)
    assert str(caught.value).endswith(told)
    with pytest.raises(PoseError, match="misses orthonormality") as caught:
        so3.log(-size * R)
    assert told not in str(caught.value)
