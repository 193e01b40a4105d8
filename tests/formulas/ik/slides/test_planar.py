"""Three joints in a plane between revolute ones, against the motion that matrix exponentials make."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from poekin.formulas.ik import three_parallel
from poekin.formulas.ik.slides import planar
from poekin.formulas.ik.slides.position import across

SEEDS = st.integers(0, 2**32 - 1)
ORDERS = {
    "".join("P" if slide else "R" for slide in order): order
    for order in [(False, False, True), (False, True, False), (True, False, False),
                  (False, True, True), (True, False, True), (True, True, False)]
}  # fmt: skip


def arm(seed, slides):
    rng = np.random.default_rng(seed)
    h = rng.normal(size=(6, 3))
    n = h[1] / np.linalg.norm(h[1])
    for i, slide in enumerate(slides, 1):
        h[i] = np.cross(n, rng.normal(size=3)) if slide else rng.choice([-1.0, 1.0]) * n
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    return h, n, rng.uniform(-1, 1, (6, 3)), rng.uniform(-2, 2, 6)


def motion(slides, h, P, x):
    """Rotation, and the sixth axis' place from the first."""
    T = np.eye(4)
    for i in range(6):
        A = np.zeros((4, 4))
        if 1 <= i <= 3 and slides[i - 1]:
            A[:3, 3] = h[i]
        else:
            a, b, c = h[i]
            A[:3, :3] = [[0, -c, b], [c, 0, -a], [-b, a, 0]]
        T = T @ expm(x[i] * A)
        if i < 5:
            T[:3, 3] += T[:3, :3] @ P[i + 1]
    return T[:3, :3], T[:3, 3]


def rows_of(slides, h, n, P, R, p):
    h = tuple(map(tuple, h.tolist()))
    P = tuple(map(tuple, P.tolist()))
    n = tuple(n.tolist())
    R = tuple(R.ravel().tolist())
    p = tuple(p.tolist())
    rows = []
    for root in three_parallel.outer((h[0], n, n, n, h[4], h[5]), P, R, p):
        rows += planar.with_outer(slides, h, P, n, across(n), R, p, root)
    return np.array(rows)


@pytest.mark.parametrize("slides", ORDERS.values(), ids=ORDERS)
@given(SEEDS)
def test_every_row_with_a_margin_makes_the_motion_and_one_is_that_it_was_made_of(slides, seed):
    h, n, P, q = arm(seed, slides)
    R, p = motion(slides, h, P, q)
    rows = rows_of(slides, h, n, P, R, p)
    rows = rows[rows[:, 12] > 1e-3]
    away = []
    for row in rows:
        x = np.arctan2(row[1:12:2], row[0:12:2])
        for i in range(3):
            if slides[i]:
                x[i + 1] = row[2 * i + 2]
        found = motion(slides, h, P, x)
        # some 100 roundings over the square of margins above 1e-3, whose square root is a slope
        size = 10 + np.abs(x).max()
        assert np.abs(found[0] - R).max() <= 1e-9
        assert np.abs(found[1] - p).max() <= 1e-9 * size
        off = x - q
        turns = [i for i in range(6) if not (1 <= i <= 3 and slides[i - 1])]
        off[turns] = np.remainder(off[turns] + np.pi, 2 * np.pi) - np.pi
        away.append(np.abs(off).max())
    # where q itself is nearly a double root its margin is below
    every = rows_of(slides, h, n, P, R, p)
    if (np.abs(every[:, 12]) > 1e-2).all():
        assert min(away) <= 1e-7


ROOT = (1.0, 0.0, 1.0, 0.0, 1.0)
X, Y, Z = np.eye(3)


def straight(slides, directions):
    """Axes at right angles, a joint that slides along its direction; the motion of all joints at 0."""
    h = np.array([X, Z, Z, Z, X, Y])
    for i in range(3):
        if slides[i]:
            h[i + 1] = directions[i]
    P = np.array([Y, 2 * X, X, Y, X, Z])
    axes, offsets = (tuple(map(tuple, a.tolist())) for a in (h, P))
    R = tuple(np.eye(3).ravel().tolist())
    return axes, offsets, tuple(Z), tuple(X), R, tuple(P[1:].sum(0).tolist())


@pytest.mark.parametrize("slides", ORDERS.values(), ids=ORDERS)
def test_at_rest_every_joint_is_at_0(slides):
    rows = planar.with_outer(slides, *straight(slides, (X + Y, X, X + 2 * Y)), ROOT)
    rest = [
        value for i in range(6) for value in ((0, 0) if 1 <= i <= 3 and slides[i - 1] else (1, 0))
    ]
    away = [np.abs(np.subtract(row[:12], rest)).max() for row in rows]
    assert min(away) <= 1e-15  # whole numbers but for one square root
    assert all(0.0 < row[12] <= 1.0 for row in rows)


@pytest.mark.parametrize("slides", list(ORDERS.values())[3:], ids=list(ORDERS)[3:])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_parallel_slides_have_no_margin_and_share_the_way_along_them(slides, size):
    """Any share of it serves, so the margin is that of a double root; across there is no way."""
    axes, P, n, across, R, p = straight(slides, (X, X, X))
    P = tuple(tuple(size * x for x in step) for step in P)
    nearly = (0, 1e-16, 0)  # which is rounding, though all that is left
    for off, margin in (((0, 0, 0), 0.0), (nearly, 0.0), ((0.5, 0, 0), 0.0), ((0, 0.5, 0), -1.0)):
        place = tuple(size * (x + d) for x, d in zip(p, off, strict=True))
        for row in planar.with_outer(slides, axes, P, n, across, R, place, ROOT):
            assert row[12] == margin
            assert np.isfinite(row).all()
            ways = [row[2 + 2 * i] for i in range(3) if slides[i]]
            if margin == 0.0:
                assert sum(ways) == pytest.approx(size * off[0], abs=1e-15 * size)


@pytest.mark.parametrize("slides", list(ORDERS.values())[:3], ids=list(ORDERS)[:3])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("noise", [(0.0, 0.0), (1e-16, 0.0), (-1e-16, 1e-16), (1e-16, 2e-16)])
def test_a_point_on_the_axis_that_should_turn_it_has_no_margin(slides, size, noise):
    """Any angle serves, whatever rounding makes of the point's distance from the axis."""
    axes, P, n, across, R, _ = straight(slides, (X, X, X))
    P = np.array(P)
    P[2:4] = 0.0
    off = np.array([*noise, 0.0])
    place = size * (P[1:].sum(axis=0) + off)
    steps = tuple(map(tuple, (size * P).tolist()))
    for row in planar.with_outer(slides, axes, steps, n, across, R, tuple(place.tolist()), ROOT):
        assert row[12] == 0.0
        assert np.isfinite(row).all()
