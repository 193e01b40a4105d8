"""WorkspaceBox and ViewCone: where the tool is, and what a camera sees."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.solve.calibration import ViewCone, WorkspaceBox
from tests.messages import says

RNG = np.random.default_rng(3)
T = pk.se3.exp(RNG.normal(size=(200, 6)))
Q = np.zeros((200, 1))
POINT = np.array([0.1, -0.2, 0.3])


def angle(a, b):  # type: ignore[no-untyped-def]
    """Angles between vectors (N, 3) and (3,) or (N, 3), by the half-angle formula of Kahan."""
    a = a / np.linalg.norm(a, axis=1)[:, None]
    b = b / np.linalg.norm(b, axis=-1, keepdims=True)
    return 2 * np.arctan2(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1))


def test_a_point_of_the_tool_is_in_the_box_up_to_its_sides():
    p = T[:, :3, :3] @ POINT + T[:, :3, 3]
    lower, upper = np.sort(p[[4, 9]], axis=0)
    inside = WorkspaceBox(lower, upper, point=POINT)(Q, T)
    expected = np.all((p >= lower) & (p <= upper), axis=1)
    assert inside.tolist() == expected.tolist()
    eye = np.eye(4)[None]
    for corner in ([0, 0, 0], [1, 1, 1]):  # the sides themselves
        eye[0, :3, 3] = corner
        assert WorkspaceBox([0, 0, 0], [1, 1, 1])(Q[:1], eye).tolist() == [True]
    for axis in range(3):
        for off in (-1e-9, 1 + 1e-9):
            eye[0, :3, 3] = np.where(np.arange(3) == axis, off, 0.5)
            assert WorkspaceBox([0, 0, 0], [1, 1, 1])(Q[:1], eye).tolist() == [False]


@pytest.mark.parametrize("on", ["base", "tip"])
@pytest.mark.parametrize("half", [0.4, np.pi / 2, 2.5])
def test_the_target_is_within_the_half_angle_of_the_axis_and_between_near_and_far(on, half):
    apex, axis = np.array([0.5, -0.3, 0.2]), np.array([-1.0, 2.0, 0.5])
    cone = ViewCone(apex, axis, half, target=POINT, on=on, near=0.6, far=2.0)
    seen = np.linalg.inv(T) if on == "tip" else T
    sight = seen[:, :3, :3] @ POINT + seen[:, :3, 3] - apex
    away = np.linalg.norm(sight, axis=1)
    expected = (angle(sight, axis) <= half) & (away >= 0.6) & (away <= 2.0)
    assert cone(Q, T).tolist() == expected.tolist()
    assert 0 < expected.sum() < len(T)


def test_near_and_far_are_distances_at_which_it_sees():
    eye = np.eye(4)[None]
    for near, far, seen in ((1, 1, True), (0, 1 - 1e-9, False), (1 + 1e-9, 2, False)):
        cone = ViewCone([0, 0, -1], [0, 0, 1], 0.1, near=near, far=far)
        assert cone(Q[:1], eye).tolist() == [seen]


def test_a_target_that_faces_away_is_not_seen():
    apex = np.array([2.0, 0.0, 0.0])
    cone = ViewCone(apex, [-1, 0, 0], np.pi, normal=[0, 0, 5], acceptance=0.9)
    back = apex - T[:, :3, 3]
    expected = angle(back, T[:, :3, 2]) <= 0.9
    assert cone(Q, T).tolist() == expected.tolist()
    assert 0 < expected.sum() < len(T)
    sixty = ViewCone(apex, [-1, 0, 0], np.pi, normal=[0, 0, 1])
    assert sixty(Q, T).tolist() == (angle(back, T[:, :3, 2]) <= np.pi / 3).tolist()


def test_without_limits_everything_in_front_is_seen_from_nought_to_any_distance():
    assert ViewCone([0, 0, 0], [0, 0, 1], np.pi)(Q, T).all()
    assert ViewCone(T[7, :3, 3], [0, 0, 1], 0.0)(Q[:1], T[7:8]).all()  # the target at the apex


REFUSED = {
    "corner": (
        lambda: WorkspaceBox([0, 0], [1, 1, 1]),
        ShapeError,
        "lower: expected three numbers, got ",
    ),
    "none": (
        lambda: WorkspaceBox([0, 0, 0], None),
        InputError,
        "upper: expected real numbers, got object",
    ),
    "empty": (
        lambda: WorkspaceBox([0, 2, 0], [1, 1, 1]),
        InputError,
        "upper[1]: expected at least lower[1] = 2, got 1",
    ),
    "point": (
        lambda: WorkspaceBox([0, 0, 0], [1, 1, 1], [0]),
        ShapeError,
        "point: expected three numbers",
    ),
    "axis": (
        lambda: ViewCone([0, 0, 0], [0, 0, 0], 1),
        InputError,
        "axis: expected a direction, got [0, 0, 0]",
    ),
    "normal": (
        lambda: ViewCone([0, 0, 0], [0, 0, 1], 1, normal=[0, 0, 0]),
        InputError,
        "normal: expected a direction, got [0, 0, 0]",
    ),
    "degrees": (
        lambda: ViewCone([0, 0, 0], [0, 0, 1], 30),
        InputError,
        "half_angle: expected a number from 0 to 3.14159, got 30",
    ),
    "acceptance": (
        lambda: ViewCone([0, 0, 0], [0, 0, 1], 1, acceptance=-1),
        InputError,
        "acceptance: expected a number from 0 to 3.14159, got -1",
    ),
    "near": (
        lambda: ViewCone([0, 0, 0], [0, 0, 1], 1, near=-1),
        InputError,
        "near: expected a number from 0 to inf, got -1",
    ),
    "far": (
        lambda: ViewCone([0, 0, 0], [0, 0, 1], 1, near=2, far=1),
        InputError,
        "far: expected a number from 2 to inf, got 1",
    ),
    "on": (
        lambda: ViewCone([0, 0, 0], [0, 0, 1], 1, on="hand"),  # type: ignore[arg-type]
        InputError,
        "on: expected 'base' or 'tip', got 'hand'",
    ),
    "apex": (lambda: ViewCone([0, 0], [0, 0, 1], 1), ShapeError, "apex: expected three numbers"),
    "target": (
        lambda: ViewCone([0, 0, 0], [0, 0, 1], 1, target=[1]),
        ShapeError,
        "target: expected three numbers",
    ),
}


@pytest.mark.parametrize(("make", "error", "message"), REFUSED.values(), ids=REFUSED)
def test_what_is_no_box_and_no_cone_is_refused(make, error, message):
    with pytest.raises(error) as caught:
        make()
    assert says(caught.value, message) or str(caught.value).startswith(message)
