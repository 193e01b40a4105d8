"""Each function of the groups at one generic element, against NumPy's matrices; and what a refusal
says.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm, inv

from poekin.errors import BranchError, InputError, PoseError, ShapeError
from poekin.groups import objects, rpy, se3, so3
from poekin.groups.arrays import ROUNDOFF, TOLERANCE, first_place, numbers, poses, shaped

W, V = np.array([0.3, -1.2, 0.7]), np.array([1.5, 0.2, -0.7])
XI = np.r_[W, V]
HAT = np.array([[0, -0.7, -1.2], [0.7, 0, -0.3], [1.2, 0.3, 0]])
R = expm(HAT)
X = np.block([[HAT, V[:, None]], [np.zeros((1, 4))]])
T = expm(X)
P_HAT = np.cross(np.eye(3), T[:3, 3])
AD = np.block([[R, np.zeros((3, 3))], [P_HAT @ R, R]])
V_HAT = np.cross(np.eye(3), V)
SMALL_AD = np.block([[HAT, np.zeros((3, 3))], [V_HAT, HAT]])


def integral(M):
    """Of exp(M s) over s in 0..1: the left Jacobian, by Lemma 5."""
    n = len(M)
    return expm(np.block([[M, np.eye(n)], [np.zeros((n, 2 * n))]]))[:n, n:]


CASES = {
    "hat": (lambda: so3.hat(W), HAT),
    "vee": (
        lambda: so3.vee(HAT + np.diag([1, 2, 3]) + 0.5 * np.ones((3, 3))),
        W,
    ),  # the skew-symmetric part counts
    "exp": (lambda: so3.exp(W), R),
    "log": (lambda: so3.log(R), W),
    "log near": (lambda: so3.log(R, near=W * 4), W + 2 * np.pi * W / np.linalg.norm(W)),
    "inverse": (lambda: so3.inverse(R), R.T),
    "adjoint": (lambda: so3.adjoint(R), R),
    "ad": (lambda: so3.ad(W), HAT),
    "left": (lambda: so3.left_jacobian(W), integral(HAT)),
    "right": (lambda: so3.right_jacobian(W), integral(-HAT)),
    "left inverse": (lambda: so3.left_jacobian_inverse(W), inv(integral(HAT))),
    "right inverse": (lambda: so3.right_jacobian_inverse(W), inv(integral(-HAT))),
    "se3 hat": (lambda: se3.hat(XI), X),
    "se3 vee": (lambda: se3.vee(X + 0.5), XI + np.repeat([0, 0.5], 3)),
    "se3 exp": (lambda: se3.exp(XI), T),
    "se3 log": (lambda: se3.log(T), XI),
    "se3 inverse": (lambda: se3.inverse(T), inv(T)),
    "se3 adjoint": (lambda: se3.adjoint(T), AD),
    "se3 ad": (lambda: se3.ad(XI), SMALL_AD),
    "se3 left": (lambda: se3.left_jacobian(XI), integral(SMALL_AD)),
    "se3 right": (lambda: se3.right_jacobian(XI), integral(-SMALL_AD)),
    "se3 left inverse": (lambda: se3.left_jacobian_inverse(XI), inv(integral(SMALL_AD))),
    "se3 right inverse": (lambda: se3.right_jacobian_inverse(XI), inv(integral(-SMALL_AD))),
    "linear first": (lambda: se3.linear_first(XI), np.r_[V, W]),
    "linear first, rows": (lambda: se3.linear_first(AD, axis=-2), np.r_[AD[3:], AD[:3]]),
    "linear first, rows again": (lambda: se3.linear_first(AD, axis=0), np.r_[AD[3:], AD[:3]]),
}


@pytest.mark.parametrize("case", CASES)
def test_a_function_is_the_one_of_matrices(case):
    function, expected = CASES[case]
    got = function()
    assert got.shape == expected.shape
    np.testing.assert_allclose(
        got, expected, rtol=0, atol=1e-14
    )  # SciPy's exponential of matrices of norm 3


def test_a_batch_of_poses_and_one_of_references_broadcast():
    assert se3.log(np.tile(T, (2, 1, 1, 1)), near=np.tile(XI, (3, 1))).shape == (2, 3, 6)
    assert so3.log(np.tile(R, (3, 1, 1)), near=W).shape == (3, 3)
    assert so3.log(R, near=np.tile(W, (5, 1))).shape == (5, 3)
    with pytest.raises(
        ShapeError, match=r"near: shape \(3, 3\) does not broadcast against \(2, 3, 3\)"
    ):
        so3.log(np.tile(R, (2, 1, 1)), near=np.tile(W, (3, 1)))


def test_roll_pitch_and_yaw_are_turns_about_fixed_axes():
    def turn(axis: list[int], angle: float) -> Any:
        return expm(np.cross(np.eye(3), axis) * angle)

    for angles in ((0.4, -0.9, 2.1), (-2.8, 1.2, -0.3), (3.0, 0.1, -3.0)):
        roll, pitch, yaw = angles
        M: Any = turn([0, 0, 1], yaw) @ turn([0, 1, 0], pitch) @ turn([1, 0, 0], roll)
        np.testing.assert_allclose(rpy.angles(M), angles, rtol=0, atol=1e-14)
        np.testing.assert_allclose(
            rpy.angles(np.stack([M, np.eye(3)])), [angles, (0, 0, 0)], rtol=0, atol=1e-14
        )
    assert not np.signbit(rpy.angles(np.eye(3))).any()


def with_entry(row, column, value, count=(2, 3)):
    batch = np.tile(np.eye(4), (*count, 1, 1))
    batch[1, 2, row, column] += value
    return batch


def test_a_defect_up_to_the_tolerance_is_taken_and_one_above_it_refused():
    assert TOLERANCE == 1e-5
    for entry in ((0, 1), (3, 0), (3, 1), (3, 2), (3, 3)):
        for sign in (1.0, -1.0):
            assert poses(with_entry(*entry, sign * 0.99e-5)).shape == (2, 3, 4, 4)
            with pytest.raises(
                PoseError, match=r"T\[1, 2\] is no pose: its (last row is|rotation misses)"
            ):
                poses(with_entry(*entry, sign * 1.01e-5))


def test_the_last_row_adds_up_and_is_printed():
    wrong = np.eye(4)
    wrong[3, :3] = 0.5e-5
    with pytest.raises(
        PoseError, match=r"^T is no pose: its last row is \[5e-06, 5e-06, 5e-06, 1.0\], exp"
    ):
        poses(wrong)


def test_a_transposed_pose_is_recognised():
    with pytest.raises(PoseError, match=r"expected \[0, 0, 0, 1\]; its transpose is one$"):
        se3.log(np.stack([T, T.T]))
    with pytest.raises(PoseError, match=r"expected \[0, 0, 0, 1\]$"):
        se3.log(np.ones((4, 4)))


def test_only_what_may_have_been_rounded_is_sent_to_nearest():
    off = np.diag([1.009, 1.0, 1.0])  # 0.018 in R R^T, what two decimals can make
    with pytest.raises(
        PoseError, match=r"; if it was rounded, pk.so3.nearest gives the nearest rot"
    ):
        so3.log(off)
    with pytest.raises(PoseError, match=r"accepted up to 1e-05$"):
        so3.log(off * 1.002)
    # a reflection that misses R R^T = I by little, and its determinant -1 by more
    for reflection in (-off, np.diag([-0.999, 1.0, 1.0])):
        with pytest.raises(PoseError, match=r"accepted up to 1e-05$"):
            so3.log(reflection)


def test_of_a_batch_the_first_that_is_refused_is_named():
    bad = np.zeros((2, 3), dtype=bool)
    bad[[0, 1, 1], [2, 0, 2]] = True
    assert first_place(bad, "R") == "R[0, 2]"


def test_the_roundoff_is_half_of_what_parts_1_from_the_next_float():
    assert 0.5 * np.spacing(1.0) == ROUNDOFF


def test_rounding_beside_larger_numbers_is_printed_as_0():
    wrong = np.eye(4)
    wrong[3] = [2.7e-49, 0.25, -1e-17, 0.1234567]
    with pytest.raises(PoseError, match=r"its last row is \[0.0, 0.25, 0.0, 0.123457\], exp"):
        poses(wrong)


def test_a_defect_is_told_by_its_size_and_a_reflection_by_its_determinant():
    with pytest.raises(
        PoseError, match=r"^T is no pose: .* max abs\(R R\^T - I\) = 0.21, accepted up to 1e-05"
    ):
        se3.log(np.diag([1.1, 1, 1, 1]))
    with pytest.raises(
        PoseError, match=r"^R is no rotation: its rotation is a reflection, det R = -1, expected 1"
    ):
        so3.log(np.diag([1.0, -1, 1]))
    with pytest.raises(PoseError, match=r"^R\[1\] is no rotation"):
        so3.log(np.stack([np.eye(3), -np.eye(3)]))


@pytest.mark.parametrize("row", range(4))
def test_nan_in_the_last_row_of_a_pose_spares_the_others_and_the_argument(row):
    batch = np.tile(T, (3, 1, 1))
    batch[1, 3, row] = np.nan
    before = batch.copy()
    found = poses(batch)
    assert np.isnan(found[1]).all()
    assert np.array_equal(found[[0, 2]], before[[0, 2]])
    assert np.array_equal(batch, before, equal_nan=True)


def test_nan_in_the_last_row_is_found_in_a_batch_of_any_axes():
    for shape in ((), (1,), (2, 3), (3, 1, 2)):
        batch = np.tile(T, (*shape, 1, 1))
        batch.reshape(-1, 4, 4)[-1, 3, 1] = np.nan
        found = poses(batch).reshape(-1, 4, 4)
        assert np.isnan(found[-1]).all()
        assert np.isfinite(found[:-1]).all()


def test_a_sound_array_is_taken_as_it_is():
    batch = np.tile(T, (3, 1, 1))
    assert poses(batch) is batch
    assert numbers(batch, "x") is batch


@pytest.mark.parametrize(
    "call, error, message",
    [
        (
            lambda: numbers([[1.0], [1.0, 2.0]], "x"),
            ShapeError,
            r"x: expected an array of numbers, got rows of diff",
        ),
        (lambda: numbers("abc", "x"), InputError, r"x: expected real numbers, got text \(str\)"),
        (
            lambda: numbers([1j], "x"),
            InputError,
            r"x: expected real numbers, got complex128 \(list\)",
        ),
        (lambda: numbers([True], "x"), InputError, r"x: expected real numbers, got bool"),
        (
            lambda: shaped(np.zeros(5), (6,), "x"),
            ShapeError,
            r"x: expected shape \(\.\.\., 6\), got \(5,\)",
        ),
        (lambda: shaped(1.0, (6,), "x"), ShapeError, r"x: expected shape \(\.\.\., 6\), got \(\)"),
        (
            lambda: shaped(np.zeros(4), (4, 4), "x"),
            ShapeError,
            r"x: expected shape \(\.\.\., 4, 4\), got \(4,\)",
        ),
        (
            lambda: se3.log(T[:3]),
            ShapeError,
            r"got \(3, 4\): to three rows of a pose, add the row 0 0 0 1$",
        ),
        (
            lambda: so3.log([T[:3], T[:3]]),
            ShapeError,
            r"got \(2, 3, 4\): of three rows of a pose, the rotation is T\[..., :3, :3\]$",
        ),
        (
            lambda: so3.log(np.ones((2, 4))),
            ShapeError,
            r"got \(2, 4\): of a quaternion, SciPy's Rotation.from_quat makes what is taken here$",
        ),
        (lambda: shaped(np.zeros((3, 4)), (6,), "x"), ShapeError, r"got \(3, 4\)$"),
        (
            lambda: se3.exp(np.zeros((5, 4, 4))),
            ShapeError,
            r"got \(5, 4, 4\): pk.se3.log of a pose is its twist, pk.se3.vee of a matrix \[xi\] is xi$",
        ),
        (
            lambda: se3.log(R),
            ShapeError,
            r"got \(3, 3\): pk.se3.pose\(R, p\) makes a pose of a rotation and a translation$",
        ),
        (
            lambda: se3.log(XI[3:]),
            ShapeError,
            r"got \(3,\): pk.se3.pose\(np.eye\(3\), p\) makes a pose of a position$",
        ),
        (lambda: se3.log(XI), ShapeError, r"got \(6,\): pk.se3.exp of a twist is a pose$"),
        (
            lambda: so3.log(T),
            ShapeError,
            r"got \(4, 4\): the rotation of a pose is T\[..., :3, :3\]$",
        ),
        (
            lambda: so3.log([1, 0, 0, 0]),
            ShapeError,
            r"got \(4,\): of a quaternion, SciPy's Rotation.from_quat makes what is taken here$",
        ),
        (lambda: so3.log(W), ShapeError, r"got \(3,\): pk.so3.exp of a rotation vector is a rota"),
        (lambda: so3.exp(np.zeros(4)), ShapeError, r"got \(4,\)$"),
        (
            lambda: se3.linear_first(XI, axis=1),
            ShapeError,
            r"x: expected length 6 along axis 1, got shape \(6,\)",
        ),
        (lambda: se3.linear_first(XI, axis=3), ShapeError, r"x: expected length 6 along axis 3"),
        (lambda: se3.linear_first(XI, axis=-2), ShapeError, r"x: expected length 6 along axis -2"),
        (
            lambda: se3.linear_first(1.0),
            ShapeError,
            r"x: expected length 6 along axis -1, got shape \(\)",
        ),
        (lambda: se3.linear_first(np.zeros((6, 7))), ShapeError, r"got shape \(6, 7\)"),
    ],
    ids=lambda x: None if callable(x) else str(x)[:40],
)
def test_what_does_not_fit_is_said(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_a_whole_turn_without_its_translation_is_refused_with_its_place():
    T = np.eye(4)
    T[:3, 3] = [1.0, 2.0, 0.0]
    near = [0, 0, 6.0, 0, 0, 0]
    with pytest.raises(
        BranchError,
        match=r"^T has no logarithm near omega = \[0.0, 0.0, 6.0\]: .* p = \[1.0, 2.0, 0",
    ):
        se3.log(T, near=near)
    with pytest.raises(
        BranchError, match=r"^T\[1\] has no logarithm near omega = \[0.0, 0.0, 6.0\]"
    ):
        se3.log(np.stack([np.eye(4), T, T]), near=near)
    lost = np.stack([np.eye(4), T])
    lost[1, 0, 3] = np.nan  # no number, and no error either
    assert np.isnan(se3.log(lost, near=near)[1]).any()


class Several:
    """What holds one or several matrices and says so, as spatialmath's classes do."""

    def __init__(self, A, N, shape, count):
        self.A, self.N, self.shape, self._count = A, N, shape, count

    def __len__(self):
        return self._count


def test_an_object_of_another_library_is_what_it_holds():
    one, two = Several(T, 3, (4, 4), 1), Several([T, T @ T], 3, (4, 4), 2)
    assert objects.plain(one, "x") is T
    assert np.array_equal(objects.plain(two, "x"), np.stack([T, T @ T]))
    assert objects.plain(Several([], 3, (3, 3), 0), "x").shape == (0, 3, 3)
    assert objects.plain(Several(W, 3, (3,), 2), "x") is W  # several, but of no shape of a pose
    assert objects.plain(SimpleNamespace(homogeneous=T), "x") is T
    assert objects.plain(SimpleNamespace(as_matrix=lambda: R), "x") is R
    assert objects.plain([SimpleNamespace(homogeneous=T), T], "x")[0] is T
    untouched = SimpleNamespace(as_matrix=R)  # an attribute that is no method says nothing
    assert objects.plain(untouched, "x") is untouched
    for numbers_alone in ([1.0, 2.0], (), [], [np.float64(1)]):
        assert objects.plain(numbers_alone, "x") is numbers_alone


def test_what_only_looks_like_a_pose_is_refused():
    order = r"^x: expected an array, got a \w+, whose order is \(v; omega\)"
    for twist in (Several(XI, 3, (6,), 1), SimpleNamespace(linear=V, angular=W)):
        with pytest.raises(InputError, match=order):
            objects.plain(twist, "x")
    for half in (SimpleNamespace(linear=V), SimpleNamespace(angular=W)):
        assert objects.plain(half, "x") is half
    for N in (2, 4):
        with pytest.raises(
            InputError, match=r"^x: expected something of space, got the planar Several"
        ):
            objects.plain(Several(R, N, (3, 3), 1), "x")
