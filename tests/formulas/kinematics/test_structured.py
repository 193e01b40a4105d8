"""Walks of planar rotations against products of matrices: axes, origins and points as each joint
sees them.

Five joints, in every pattern of parallel axes that a walk treats differently, and walks that begin
inside a run.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from poekin import algebra
from poekin.formulas.kinematics import structured

N = 5
rng = np.random.default_rng(21)
THETA, ALONG = rng.normal(size=N), rng.normal(size=N)
ALPHA, A, B = rng.normal(size=(3, N))
FEW = 2e-14  # five turns and sums of lengths up to 10
PATTERNS = pytest.mark.parametrize(
    "parallel", [(0, 0, 0, 0, 0), (0, 1, 1, 0, 1), (0, 0, 1, 1, 1), (0, 1, 0, 1, 0)], ids=str
)
BEGINS = pytest.mark.parametrize("begin", range(N))


def moved(axis: str, angle: Any = 0.0, shift: Any = (0.0, 0.0, 0.0)):
    c, s = np.cos(angle), np.sin(angle)
    T = np.eye(4)
    T[:3, :3] = (
        [[1, 0, 0], [0, c, -s], [0, s, c]] if axis == "x" else [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    )
    T[:3, 3] = shift
    return T


def constant(i, parallel):
    """Tx(a) Ty(b) Rx(alpha), alpha = 0 between parallel axes."""
    return moved("x", shift=(A[i], B[i], 0)) @ moved("x", 0.0 if parallel[i] else ALPHA[i])


def motion(i):
    return moved("z", THETA[i], (0, 0, ALONG[i]))


def links(parallel):
    angles = np.where(parallel, 0.0, ALPHA)
    return list(zip(np.sin(angles), np.cos(angles), A, B, strict=True))


def outward_sums(parallel, begin):
    """Angles summed from where an outward walk from `begin` enters the run of joint i."""
    sums = np.full(N, np.nan)
    for i in range(begin, N):
        sums[i] = THETA[i] + (sums[i - 1] if i > begin and parallel[i] else 0.0)
    return sums


def inward_sums(parallel, begin):
    sums = np.full(N, np.nan)
    for i in range(begin, -1, -1):
        sums[i] = THETA[i] + (sums[i + 1] if i < begin and parallel[i + 1] else 0.0)
    return sums


def same(got, expected):
    np.testing.assert_allclose(got, expected, rtol=0, atol=FEW)


def same_frame(frame, T):
    same(np.transpose(frame), T[:3])


START = moved("x", 0.4, (0.2, -0.5, 0.9)) @ moved("z", -1.1)


def rows_seen(parallel, begin, outward):
    """Axes of the run (X, Y), axis and a point of it for each joint of a walk, and the frame where
    the walk ends.
    """
    rows, T = {}, START
    run = T
    if outward:
        for i in range(begin, N):
            T = T @ constant(i, parallel)
            if not parallel[i]:
                run = T
            rows[i] = np.r_[run[:3, 0], run[:3, 1], T[:3, 2], T[:3, 3]]
            T = T @ motion(i)
        return rows, T
    for i in range(begin, -1, -1):
        rows[i] = np.r_[run[:3, 0], run[:3, 1], T[:3, 2], T[:3, 3]]
        T = T @ np.linalg.inv(motion(i)) @ np.linalg.inv(constant(i, parallel))
        if not parallel[i]:
            run = T
    return rows, T


@PATTERNS
@BEGINS
def test_an_outward_walk_meets_each_joint_s_axis(parallel, begin):
    sums, rows = outward_sums(parallel, begin), np.full((N, 12), np.nan)
    frame = algebra.axes((*START[:3, :3].ravel(), *START[:3, 3]))
    same_frame(frame, START)
    end = structured.outward(
        frame, links(parallel), ALONG, parallel, np.sin(sums), np.cos(sums), begin, rows
    )
    expected, T = rows_seen(parallel, begin, True)
    same_frame(end, T)
    same(algebra.from_axes(*end), (*T[:3, :3].ravel(), *T[:3, 3]))
    for i in range(begin, N):
        same(rows[i], expected[i])
    assert np.isnan(rows[:begin]).all()


@PATTERNS
@BEGINS
def test_an_inward_walk_meets_each_joint_s_axis(parallel, begin):
    sums, rows = inward_sums(parallel, begin), np.full((N, 12), np.nan)
    frame = algebra.axes((*START[:3, :3].ravel(), *START[:3, 3]))
    end = structured.inward(
        frame, links(parallel), ALONG, parallel, np.sin(sums), np.cos(sums), begin, rows
    )
    expected, T = rows_seen(parallel, begin, False)
    same_frame(end, T)
    for i in range(begin + 1):
        same(rows[i], expected[i])
    assert np.isnan(rows[begin + 1 :]).all()


POINT = np.array([0.7, -0.3, 1.2])


def seen(rows, p):
    """x and y of the point p in the axes of each row, from its origin."""
    return {i: np.array([row[:3], row[3:6]]) @ (p - row[9:]) for i, row in rows.items()}


def world(T, p):
    return T[:3, :3] @ p + T[:3, 3]


def local(T, p):
    return T[:3, :3].T @ (p - T[:3, 3])


@PATTERNS
@BEGINS
def test_a_point_of_the_frame_behind_is_seen_by_every_joint_outward(parallel, begin):
    sums, points = outward_sums(parallel, begin), np.full((N, 2), np.nan)
    walk = (links(parallel), ALONG, parallel, np.sin(sums), np.cos(sums))
    end = structured.seen_outward(POINT, *walk, begin, points)
    rows, T = rows_seen(parallel, begin, True)
    p = world(START, POINT)
    for i, xy in seen(rows, p).items():
        same(points[i], xy)
    same(end, local(T, p))


@PATTERNS
@BEGINS
def test_a_point_of_the_frame_before_is_seen_by_every_joint_inward(parallel, begin):
    sums, points = inward_sums(parallel, begin), np.full((N, 2), np.nan)
    walk = (links(parallel), ALONG, parallel, np.sin(sums), np.cos(sums))
    end = structured.seen_inward(POINT, *walk, begin, points)
    rows, T = rows_seen(parallel, begin, False)
    p = world(START, POINT)
    for i, xy in seen(rows, p).items():
        same(points[i], xy)
    same(end, local(T, p))


@PATTERNS
@pytest.mark.parametrize("count", range(1, N + 1))
def test_the_tool_is_seen_by_every_joint_of_an_outward_walk(parallel, count):
    sums, points = outward_sums(parallel, 0), np.full((N, 2), np.nan)
    walk = (links(parallel), ALONG, parallel, np.sin(sums), np.cos(sums))
    begin = structured.tip_seen(POINT, *walk, count, points)
    rows, T = rows_seen(parallel, 0, True)
    for i in range(count, N):
        rows.pop(i)
    for i in range(N - 1, count - 1, -1):
        T = T @ np.linalg.inv(motion(i)) @ np.linalg.inv(constant(i, parallel))
    p = world(T, POINT)
    for i, xy in seen(rows, p).items():
        same(points[i], xy)
    same(begin, local(START, p))


def test_a_column_is_the_velocity_of_the_point_that_the_joint_sees():
    rotates, slides = rng.normal(size=(2, N))
    rows, _ = rows_seen((0, 1, 0, 1, 0), 0, True)
    table = np.array([rows[i] for i in range(N)])
    p = np.array([0.3, 1.4, -0.8])
    points = np.array([seen(rows, p)[i] for i in range(N)])
    J = np.full((6, N), np.nan)
    structured.columns_of_axes(table, points, rotates, slides, 1, N - 1, J)
    Z, o = table[:, 6:9], table[:, 9:]
    v = rotates[:, None] * np.cross(Z, p - o) + slides[:, None] * Z
    same(J[:, 1:-1], np.concatenate([(rotates[:, None] * Z).T, v.T])[:, 1:-1])
    assert np.isnan(J[:, [0, -1]]).all()
